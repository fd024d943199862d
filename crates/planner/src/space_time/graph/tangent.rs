//! Tangent edges: turns and lines that touch the moving vertices of an obstacle.
//!
//! Along a line at speed `u` in direction `d` the distance from a face with normal `n` grows by
//! `u n.d - h_V(n)` m/s. The line is tangent to a moving vertex when it does not recede from one of
//! the two faces there and does not approach the other. The distance from a face is constant along
//! two directions, `n.d = h_V(n) / u`. Between such directions of neighbouring faces a tangent line
//! touches the shared vertex. So the signs of the constant distances at the two ends tell whether a
//! tangent exists, before any root is sought.

use std::f64::consts::{PI, TAU};

use crate::NodeKind;
use crate::space_time::manoeuvre::interceptor::{Interception, Interceptor, Limits};
use crate::space_time::proxy::Proxy;
use searoom_geometry::frame::{Side, Vector, direction, heading_of, to_port};
use searoom_sets::contact::Interval;
use searoom_sets::{HalfSpace, MovingVertex, PolytopeObstacle};

/// Metres. A distance this small has no sign.
const NO_SIGN_M: f64 = 1e-6;

/// Number of sectors between the two tangent directions of a face next to one that moves faster
/// than own ship.
const SUBDIVISIONS: usize = 4;

/// Accuracy of a turn, radians.
const TURN_RAD: f64 = 1e-13;

/// Moving vertex with the faces that meet there.
#[derive(Debug)]
struct Corner {
    vertex: MovingVertex,
    faces: Vec<HalfSpace>,
    /// False where no trajectory can pass it.
    open: bool,
}

impl Corner {
    /// True when a line in this direction at this speed touches the corner and stays outside.
    fn is_tangent(&self, ahead: Vector, speed: f64) -> bool {
        let rate = |f: &HalfSpace| speed * f.normal.dot(&ahead) - f.velocity_support;
        self.faces.iter().any(|f| rate(f) <= 1e-9) && self.faces.iter().any(|f| rate(f) >= -1e-9)
    }
}

/// Direction along which the distance from a face is constant, or from another plane that touches
/// the obstacle in one corner.
#[derive(Debug, Clone, Copy)]
struct TangentDirection {
    ahead: Vector,
    heading: f64,
    plane: HalfSpace,
    /// Component of the plane's normal to port of the direction.
    across: f64,
}

/// Sector between two [`TangentDirection`]s, in which tangents touch one corner.
#[derive(Debug, Clone, Copy)]
struct Sector {
    corner: usize,
    directions: [usize; 2],
    /// The moment of the corner's position about the relative velocity, divided by the distance
    /// from the plane of each direction, m/s. The relative velocity points along that plane.
    moments: [f64; 2],
}

/// Sectors for one speed; they do not depend on own ship's position.
#[derive(Debug)]
struct SpeedSectors {
    speed: f64,
    directions: Vec<TangentDirection>,
    sectors: Vec<Sector>,
    /// Corners of sets without an interior: their interceptions are computed one by one.
    degenerate: Vec<usize>,
}

/// Corners of one obstacle with their sectors for every speed.
#[derive(Debug)]
pub(crate) struct TangentEdges {
    obstacle: usize,
    window: Option<Interval>,
    corners: Vec<Corner>,
    sectors_by_speed: Vec<SpeedSectors>,
}

/// [`TangentDirection`] relative to own ship.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RelativeDirection {
    /// Turn to it, radians, to port positive.
    turn: f64,
    /// Distance from its plane now, metres, and the increase after a turn to it to port; a turn to
    /// starboard decreases it.
    straight: f64,
    turned: f64,
}

/// Tangent edge: turn and line to a corner.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TangentEdge {
    pub kind: NodeKind,
    pub side: Side,
    pub speed: f64,
    pub meeting: Interception,
}

impl TangentEdges {
    /// Corners of `body`, the polytope of the proxy or its substitute, that are `open` at their
    /// position at t = 0.
    pub(crate) fn new(
        proxy: &Proxy,
        body: &PolytopeObstacle,
        speeds: impl Iterator<Item = f64>,
        open: impl Fn(Vector) -> bool,
    ) -> Self {
        let faces = body.faces();
        let corners: Vec<Corner> = body
            .moving_vertices()
            .iter()
            .map(|&vertex| {
                let meets = |f: &&HalfSpace| {
                    let initial = f.initial_support - f.normal.dot(&vertex.origin);
                    let velocity = f.velocity_support - f.normal.dot(&vertex.velocity);
                    initial <= 1e-9 * (1.0 + vertex.origin.norm())
                        && velocity <= 1e-9 * (1.0 + vertex.velocity.norm())
                };
                let faces = faces.iter().filter(meets).copied().collect();
                let open = open(vertex.origin);
                Corner {
                    vertex,
                    faces,
                    open,
                }
            })
            .collect();
        let sectors_by_speed = speeds
            .map(|u| SpeedSectors::new(faces, &corners, u))
            .collect();
        Self {
            obstacle: proxy.obstacle,
            window: proxy.window,
            corners,
            sectors_by_speed,
        }
    }

    /// Start of the clock of these corners, and how long they exist, seconds.
    pub(crate) fn window(&self) -> (f64, f64) {
        self.window
            .map_or((0.0, f64::INFINITY), |w| (w.start, w.end - w.start))
    }

    fn kind(&self, corner: usize) -> NodeKind {
        let (initial, velocity) = self.corners[corner].vertex.indices;
        NodeKind::Vertex {
            obstacle: self.obstacle,
            initial,
            velocity,
        }
    }

    /// Finds every turn and line at one of the speeds that is tangent to a corner. `interceptors`
    /// turn to the sides of [`Side::BOTH`]; their speed is ignored.
    pub(crate) fn for_each_edge(
        &self,
        interceptors: &[Interceptor; 2],
        limits: Limits,
        relative: &mut Vec<RelativeDirection>,
        mut found: impl FnMut(TangentEdge),
    ) {
        for speed_sectors in &self.sectors_by_speed {
            let interceptors = interceptors.map(|c| c.at_speed(speed_sectors.speed));
            relative.clear();
            relative.extend(speed_sectors.directions.iter().map(|tangent_direction| {
                let turn = wrap_difference(tangent_direction.heading - interceptors[0].heading());
                let [straight, turned] = interceptors[0].slacks(
                    &tangent_direction.plane,
                    tangent_direction.across,
                    turn,
                );
                RelativeDirection {
                    turn,
                    straight,
                    turned,
                }
            }));
            let mut emit = |corner: usize, side: Side, meeting: Interception| {
                found(TangentEdge {
                    kind: self.kind(corner),
                    side,
                    speed: speed_sectors.speed,
                    meeting,
                });
            };
            for sector in &speed_sectors.sectors {
                let ends = sector.directions.map(|l| &relative[l]);
                let wraps = (ends[0].turn - ends[1].turn).abs() > PI;
                for (side, interceptor) in Side::BOTH.into_iter().zip(&interceptors) {
                    let sign = side.turn_sign();
                    let [a, b] = ends.map(|e| sign * e.turn);
                    let [from, to] = ends.map(|e| e.straight + sign * e.turned);
                    let touches = (from <= NO_SIGN_M) | (to <= NO_SIGN_M);
                    let touches = touches & ((from >= -NO_SIGN_M) | (to >= -NO_SIGN_M));
                    let ahead = ((a >= -TURN_RAD) | (b >= -TURN_RAD))
                        & ((a <= limits.turn) | (b <= limits.turn));
                    // one well-predicted branch
                    if !(wraps | (touches & ahead)) {
                        continue;
                    }
                    if wraps {
                        if a.max(b) <= limits.turn {
                            self.intercept_corner(sector.corner, interceptor, limits, |m| {
                                emit(sector.corner, side, m)
                            });
                        }
                        continue;
                    }
                    let corner = &self.corners[sector.corner];
                    let moments = [sector.moments[0] * from, sector.moments[1] * to];
                    let meeting =
                        interceptor.intercept_tangentially(&corner.vertex, [a, b], moments, limits);
                    if let Some(meeting) = meeting
                        && corner.is_tangent(interceptor.after(meeting.turn), speed_sectors.speed)
                    {
                        emit(sector.corner, side, meeting);
                    }
                }
            }
            for &corner in &speed_sectors.degenerate {
                for (side, interceptor) in Side::BOTH.into_iter().zip(&interceptors) {
                    self.intercept_corner(corner, interceptor, limits, |m| emit(corner, side, m));
                }
            }
        }
    }

    fn intercept_corner(
        &self,
        corner: usize,
        interceptor: &Interceptor,
        limits: Limits,
        emit: impl FnOnce(Interception),
    ) {
        let c = &self.corners[corner];
        let meeting = interceptor.intercept(c.vertex.origin, c.vertex.velocity, limits);
        if let Some(meeting) = meeting
            && c.is_tangent(interceptor.after(meeting.turn), interceptor.speed())
        {
            emit(meeting);
        }
    }
}

impl SpeedSectors {
    fn new(faces: &[HalfSpace], corners: &[Corner], speed: f64) -> Self {
        let mut speed_sectors = Self {
            speed,
            directions: Vec::new(),
            sectors: Vec::new(),
            degenerate: Vec::new(),
        };
        // directions `k` and `k + 1` belong to a face that has any
        let mut first = vec![None; faces.len()];
        for (first, f) in first.iter_mut().zip(faces) {
            let cosine = f.velocity_support / speed;
            if cosine.abs() < 1.0 {
                *first = Some(speed_sectors.directions.len());
                let sine = (1.0 - cosine * cosine).sqrt();
                for sign in [1.0, -1.0] {
                    let ahead = f.normal * cosine + to_port(f.normal) * (sign * sine);
                    speed_sectors.add_direction(ahead, *f);
                }
            }
        }
        for (index, corner) in corners.iter().enumerate().filter(|(_, c)| c.open) {
            let around: Vec<usize> = (0..faces.len())
                .filter(|k| corner.faces.contains(&faces[*k]))
                .collect();
            let all = |sign: f64| {
                let faster = |k: &usize| sign * faces[*k].velocity_support >= speed;
                around.iter().all(faster)
            };
            match around[..] {
                // own ship always approaches, or always recedes
                _ if all(1.0) || all(-1.0) => {}
                [a, b] => match (first[a], first[b]) {
                    (Some(a), Some(b)) => {
                        speed_sectors.add_sector(index, corner, [a, b]);
                        speed_sectors.add_sector(index, corner, [a + 1, b + 1]);
                    }
                    (Some(first), None) => speed_sectors.subdivide(index, corner, first, &faces[b]),
                    (None, Some(first)) => speed_sectors.subdivide(index, corner, first, &faces[a]),
                    (None, None) => speed_sectors.degenerate.push(index),
                },
                _ => speed_sectors.degenerate.push(index),
            }
        }
        speed_sectors
    }

    fn add_direction(&mut self, ahead: Vector, plane: HalfSpace) {
        self.directions.push(TangentDirection {
            ahead,
            heading: heading_of(ahead),
            plane,
            across: plane.normal.dot(&to_port(ahead)),
        });
    }

    fn add_sector(&mut self, index: usize, corner: &Corner, directions: [usize; 2]) {
        let moments = directions.map(|l| {
            let tangent_direction = &self.directions[l];
            let velocity = tangent_direction.ahead * self.speed - corner.vertex.velocity;
            -velocity.dot(&to_port(tangent_direction.plane.normal))
        });
        self.sectors.push(Sector {
            corner: index,
            directions,
            moments,
        });
    }

    /// Sectors from one tangent direction of a face to the other. They lie around its normal where
    /// own ship always approaches the other face, and around the opposite direction where it always
    /// recedes.
    fn subdivide(&mut self, index: usize, corner: &Corner, first: usize, other: &HalfSpace) {
        let own = self.directions[first].plane;
        let from = heading_of(self.directions[first].ahead);
        let half = (own.velocity_support / self.speed).acos();
        let width = if other.velocity_support > 0.0 {
            -2.0 * half
        } else {
            TAU - 2.0 * half
        };
        let mut before = first;
        for k in 1..SUBDIVISIONS {
            let ahead = direction(from + width * k as f64 / SUBDIVISIONS as f64);
            let across = to_port(ahead * self.speed - corner.vertex.velocity).normalize();
            let outward = across.dot(&(own.normal + other.normal)).signum();
            let normal = across * outward;
            let plane = HalfSpace {
                normal,
                velocity_support: normal.dot(&corner.vertex.velocity),
                initial_support: normal.dot(&corner.vertex.origin),
            };
            let next = self.directions.len();
            self.add_direction(ahead, plane);
            self.add_sector(index, corner, [before, next]);
            before = next;
        }
        self.add_sector(index, corner, [before, first + 1]);
    }
}

/// Difference of two angles in `(-pi, pi]`, wrapped to the same range. Branch-free, unlike
/// [`searoom_geometry::frame::wrap`].
fn wrap_difference(apart: f64) -> f64 {
    let over = if apart > PI { TAU } else { 0.0 };
    let under = if apart <= -PI { TAU } else { 0.0 };
    apart - over + under
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry_fixtures::random_vector;
    use crate::space_time::piece::Piece;
    use rand::{Rng, SeedableRng};
    use searoom_geometry::frame::Pose;
    use searoom_geometry::{ConvexPolygon, outer_disc};

    /// Compares with the interceptions of every corner one by one.
    #[test]
    fn every_tangent_line_is_found() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let speeds = [2.5, 5.0, 6.0];
        let (mut found, mut missed) = (0, 0);
        for _ in 0..400 {
            let drift = direction(rng.random_range(-3.1..3.1)) * rng.random_range(0.0..7.0);
            let centre = random_vector(&mut rng, 900.0);
            let spread: Vec<Vector> = (0..5)
                .map(|k| drift + direction(f64::from(k)) * rng.random_range(0.1..1.0))
                .collect();
            let body = PolytopeObstacle::new(
                "",
                outer_disc(rng.random_range(20.0..150.0), 0.3).translated(centre),
                ConvexPolygon::hull(&spread).expect("a set"),
            );
            let piece = Piece {
                obstacle: 0,
                window: None,
                body: body.clone(),
                ellipsoid: None,
            };
            let tangent_edges =
                TangentEdges::new(&Proxy::new(&piece), &body, speeds.into_iter(), |_| true);
            let pose = Pose::new(Vector::new(0.0, 0.0), rng.random_range(-3.1..3.1));
            let time = rng.random_range(0.0..60.0);
            if body.contains(pose.position, time) {
                continue;
            }
            let limits = Limits {
                turn: 2.0,
                time: time + 240.0,
            };
            let interceptors =
                Side::BOTH.map(|side| Interceptor::new(&pose, time, 1.0, 100.0, side));
            let mut edges = Vec::new();
            tangent_edges.for_each_edge(&interceptors, limits, &mut Vec::new(), |edge| {
                edges.push(edge)
            });
            for edge in &edges {
                let corner = tangent_edges.corners.iter().position(|c| {
                    let (initial, velocity) = c.vertex.indices;
                    edge.kind
                        == NodeKind::Vertex {
                            obstacle: 0,
                            initial,
                            velocity,
                        }
                });
                let vertex = &tangent_edges.corners[corner.expect("of this body")].vertex;
                let interceptor =
                    interceptors[usize::from(edge.side == Side::BOTH[1])].at_speed(edge.speed);
                let ahead = interceptor.after(edge.meeting.turn);
                let (from, _) = interceptor.turned(ahead, edge.meeting.turn);
                let own = from + ahead * edge.meeting.line;
                let other = vertex.origin + vertex.velocity * edge.meeting.time;
                assert!((own - other).norm() < 1e-7, "{edge:?}");
            }
            for k in 0..tangent_edges.corners.len() {
                for speed in speeds {
                    for (side, interceptor) in Side::BOTH.into_iter().zip(&interceptors) {
                        let interceptor = interceptor.at_speed(speed);
                        tangent_edges.intercept_corner(k, &interceptor, limits, |meeting| {
                            let same = edges.iter().any(|a| {
                                a.kind == tangent_edges.kind(k)
                                    && a.side == side
                                    && a.speed == speed
                                    && (a.meeting.time - meeting.time).abs() < 1e-6
                            });
                            found += usize::from(same);
                            missed += usize::from(!same);
                        });
                    }
                }
            }
        }
        assert!(found > 600 && missed <= 1, "{found} found, {missed} missed");
    }
}
