//! Tangent edges: turns and lines that touch the moving vertices of an obstacle.
//!
//! Along a line at speed `u` in direction `d` the distance from a face with normal `n` grows by
//! `u n.d - h_V(n)` m/s. The line is tangent to a moving vertex when it does not recede from one of
//! the two faces there and does not approach the other. The distance from a face is constant along
//! two directions, `n.d = h_V(n) / u`. Between such directions of neighbouring faces a tangent line
//! touches the shared vertex. So the signs of the constant distances at the two ends tell whether a
//! tangent exists, before any root is sought.

use std::f64::consts::{PI, TAU};

use crate::frame::{Side, Vector, direction, heading_of, to_port};
use crate::obstacle::{HalfSpace, MovingVertex, PolytopeObstacle};
use crate::planner::NodeKind;
use crate::planner::space_time::graph::intercept::{Chase, Interception, Limits};
use crate::planner::space_time::piece::Window;
use crate::planner::space_time::proxy::Proxy;

/// Metres. A distance this small has no sign.
const NO_SIGN_M: f64 = 1e-6;

/// Number of sectors between the two tangent directions of a face next to one that moves faster
/// than own ship.
const FAN: usize = 4;

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
    fn grazed(&self, ahead: Vector, speed: f64) -> bool {
        let rate = |f: &HalfSpace| speed * f.normal.dot(&ahead) - f.velocity_support;
        self.faces.iter().any(|f| rate(f) <= 1e-9) && self.faces.iter().any(|f| rate(f) >= -1e-9)
    }
}

/// Direction along which the distance from a face is constant, or from another plane that touches
/// the obstacle in one corner.
#[derive(Debug, Clone, Copy)]
struct Level {
    ahead: Vector,
    heading: f64,
    plane: HalfSpace,
    /// Component of the plane's normal to port of the direction.
    across: f64,
}

/// Sector between two [`TangentDirection`]s, in which tangents touch one corner.
#[derive(Debug, Clone, Copy)]
struct Gap {
    corner: usize,
    levels: [usize; 2],
    /// The moment of the corner's position about the relative velocity, divided by the distance
    /// from the plane of each direction, m/s. The relative velocity points along that plane.
    moments: [f64; 2],
}

/// Sectors for one speed; they do not depend on own ship's position.
#[derive(Debug)]
struct Pace {
    speed: f64,
    levels: Vec<Level>,
    gaps: Vec<Gap>,
    /// Corners of sets without an interior: their interceptions are computed one by one.
    others: Vec<usize>,
}

/// Corners of one obstacle with their sectors for every speed.
#[derive(Debug)]
pub(crate) struct TangentEdges {
    obstacle: usize,
    window: Option<Window>,
    corners: Vec<Corner>,
    speed_table: Vec<Pace>,
}

/// [`TangentDirection`] relative to own ship.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bearing {
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
    /// Corners of `body`, the polytope of the proxy or its substitute.
    pub(crate) fn new(
        proxy: &Proxy,
        body: &PolytopeObstacle,
        speeds: impl Iterator<Item = f64>,
    ) -> Self {
        Self::past(proxy, body, speeds, |_| true)
    }

    /// Corners that are `open` at their position at t = 0.
    pub(crate) fn past(
        proxy: &Proxy,
        body: &PolytopeObstacle,
        speeds: impl Iterator<Item = f64>,
        open: impl Fn(Vector) -> bool,
    ) -> Self {
        let faces = body.faces();
        let corners: Vec<Corner> = body
            .moving_vertices()
            .into_iter()
            .map(|vertex| {
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
        let speed_table = speeds.map(|u| Pace::new(faces, &corners, u)).collect();
        Self {
            obstacle: proxy.obstacle,
            window: proxy.window,
            corners,
            speed_table,
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
    pub(crate) fn touched(
        &self,
        chases: &[Chase; 2],
        limits: Limits,
        bearings: &mut Vec<Bearing>,
        mut found: impl FnMut(TangentEdge),
    ) {
        for pace in &self.speed_table {
            let chases = chases.map(|c| c.at_speed(pace.speed));
            bearings.clear();
            bearings.extend(pace.levels.iter().map(|level| {
                let turn = nearer(level.heading - chases[0].heading());
                let [straight, turned] = chases[0].slacks(&level.plane, level.across, turn);
                Bearing {
                    turn,
                    straight,
                    turned,
                }
            }));
            let mut offer = |corner: usize, side: Side, meeting: Interception| {
                found(TangentEdge {
                    kind: self.kind(corner),
                    side,
                    speed: pace.speed,
                    meeting,
                });
            };
            for gap in &pace.gaps {
                let ends = gap.levels.map(|l| &bearings[l]);
                let wraps = (ends[0].turn - ends[1].turn).abs() > PI;
                for (side, chase) in Side::BOTH.into_iter().zip(&chases) {
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
                            self.seek(gap.corner, chase, limits, |m| offer(gap.corner, side, m));
                        }
                        continue;
                    }
                    let corner = &self.corners[gap.corner];
                    let moments = [gap.moments[0] * from, gap.moments[1] * to];
                    let meeting = chase.touch(&corner.vertex, [a, b], moments, limits);
                    if let Some(meeting) = meeting
                        && corner.grazed(chase.after(meeting.turn), pace.speed)
                    {
                        offer(gap.corner, side, meeting);
                    }
                }
            }
            for &corner in &pace.others {
                for (side, chase) in Side::BOTH.into_iter().zip(&chases) {
                    self.seek(corner, chase, limits, |m| offer(corner, side, m));
                }
            }
        }
    }

    fn seek(&self, corner: usize, chase: &Chase, limits: Limits, offer: impl FnOnce(Interception)) {
        let c = &self.corners[corner];
        let meeting = chase.intercept(c.vertex.origin, c.vertex.velocity, limits);
        if let Some(meeting) = meeting
            && c.grazed(chase.after(meeting.turn), chase.speed())
        {
            offer(meeting);
        }
    }
}

impl Pace {
    fn new(faces: &[HalfSpace], corners: &[Corner], speed: f64) -> Self {
        let mut pace = Self {
            speed,
            levels: Vec::new(),
            gaps: Vec::new(),
            others: Vec::new(),
        };
        // directions `k` and `k + 1` belong to a face that has any
        let mut first = vec![None; faces.len()];
        for (first, f) in first.iter_mut().zip(faces) {
            let cosine = f.velocity_support / speed;
            if cosine.abs() < 1.0 {
                *first = Some(pace.levels.len());
                let sine = (1.0 - cosine * cosine).sqrt();
                for sign in [1.0, -1.0] {
                    let ahead = f.normal * cosine + to_port(f.normal) * (sign * sine);
                    pace.level(ahead, *f);
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
                        pace.gap(index, corner, [a, b]);
                        pace.gap(index, corner, [a + 1, b + 1]);
                    }
                    (Some(first), None) => pace.fan(index, corner, first, &faces[b]),
                    (None, Some(first)) => pace.fan(index, corner, first, &faces[a]),
                    (None, None) => pace.others.push(index),
                },
                _ => pace.others.push(index),
            }
        }
        pace
    }

    fn level(&mut self, ahead: Vector, plane: HalfSpace) {
        self.levels.push(Level {
            ahead,
            heading: heading_of(ahead),
            plane,
            across: plane.normal.dot(&to_port(ahead)),
        });
    }

    fn gap(&mut self, index: usize, corner: &Corner, levels: [usize; 2]) {
        let moments = levels.map(|l| {
            let level = &self.levels[l];
            let velocity = level.ahead * self.speed - corner.vertex.velocity;
            -velocity.dot(&to_port(level.plane.normal))
        });
        self.gaps.push(Gap {
            corner: index,
            levels,
            moments,
        });
    }

    /// Sectors from one tangent direction of a face to the other: around its normal where own ship
    /// always approaches the other face, around the opposite where it always recedes.
    fn fan(&mut self, index: usize, corner: &Corner, first: usize, other: &HalfSpace) {
        let own = self.levels[first].plane;
        let from = heading_of(self.levels[first].ahead);
        let half = (own.velocity_support / self.speed).acos();
        let width = if other.velocity_support > 0.0 {
            -2.0 * half
        } else {
            TAU - 2.0 * half
        };
        let mut before = first;
        for k in 1..FAN {
            let ahead = direction(from + width * k as f64 / FAN as f64);
            let across = to_port(ahead * self.speed - corner.vertex.velocity).normalize();
            let outward = across.dot(&(own.normal + other.normal)).signum();
            let normal = across * outward;
            let plane = HalfSpace {
                normal,
                velocity_support: normal.dot(&corner.vertex.velocity),
                initial_support: normal.dot(&corner.vertex.origin),
            };
            let next = self.levels.len();
            self.level(ahead, plane);
            self.gap(index, corner, [before, next]);
            before = next;
        }
        self.gap(index, corner, [before, first + 1]);
    }
}

/// Difference of two angles in `(-pi, pi]`, wrapped to the same range. Branch-free, unlike
/// [`crate::frame::wrap`].
fn nearer(apart: f64) -> f64 {
    let over = if apart > PI { TAU } else { 0.0 };
    let under = if apart <= -PI { TAU } else { 0.0 };
    apart - over + under
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Pose;
    use crate::geometry::{ConvexPolygon, outer_disc};
    use crate::planner::space_time::piece::{Body, Piece};
    use rand::{Rng, SeedableRng};

    /// Compares with the interceptions of every corner one by one.
    #[test]
    fn every_line_that_only_just_touches_is_found() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let speeds = [2.5, 5.0, 6.0];
        let (mut found, mut missed) = (0, 0);
        for _ in 0..400 {
            let drift = direction(rng.random_range(-3.1..3.1)) * rng.random_range(0.0..7.0);
            let centre = Vector::new(
                rng.random_range(-900.0..900.0),
                rng.random_range(-900.0..900.0),
            );
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
                body: Body::Polytope(body.clone()),
            };
            let tangent_edges = TangentEdges::new(&Proxy::new(&piece), &body, speeds.into_iter());
            let pose = Pose::new(Vector::new(0.0, 0.0), rng.random_range(-3.1..3.1));
            let time = rng.random_range(0.0..60.0);
            if body.contains(pose.position, time) {
                continue;
            }
            let limits = Limits {
                turn: 2.0,
                time: time + 240.0,
            };
            let chases = Side::BOTH.map(|side| Chase::new(&pose, time, 1.0, 100.0, side));
            let mut touched = Vec::new();
            tangent_edges.touched(&chases, limits, &mut Vec::new(), |aim| touched.push(aim));
            for aim in &touched {
                let corner = tangent_edges.corners.iter().position(|c| {
                    let (initial, velocity) = c.vertex.indices;
                    aim.kind
                        == NodeKind::Vertex {
                            obstacle: 0,
                            initial,
                            velocity,
                        }
                });
                let vertex = &tangent_edges.corners[corner.expect("of this body")].vertex;
                let chase = chases[usize::from(aim.side == Side::BOTH[1])].at_speed(aim.speed);
                let ahead = chase.after(aim.meeting.turn);
                let (from, _) = chase.turned(ahead, aim.meeting.turn);
                let own = from + ahead * aim.meeting.line;
                let other = vertex.origin + vertex.velocity * aim.meeting.time;
                assert!((own - other).norm() < 1e-7, "{aim:?}");
            }
            for k in 0..tangent_edges.corners.len() {
                for speed in speeds {
                    for (side, chase) in Side::BOTH.into_iter().zip(&chases) {
                        let chase = chase.at_speed(speed);
                        tangent_edges.seek(k, &chase, limits, |meeting| {
                            let same = touched.iter().any(|a| {
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
