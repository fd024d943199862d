//! What own ship aims at: moving vertices of a body, where her line only just touches it.
//!
//! Along a line at speed `u` in direction `d` the distance from a face with normal `n` grows by
//! `u n.d - h_V(n)` m/s. The line only just touches a moving vertex when of the two faces there one is not
//! left and the other not approached. The distance from a face is constant along two directions,
//! `n.d = h_V(n) / u`; between those of neighbouring faces a line touches the vertex they share, if it
//! touches. So the signs of the constant distances at the two ends tell whether one does, before any root
//! is sought.

use std::f64::consts::{PI, TAU};

use super::hazard::Hazard;
use super::interception::{Chase, Interception, Limits};
use super::part::Window;
use crate::frame::{Side, Vector, direction, heading_of, to_port, wrap};
use crate::obstacle::{HalfSpace, MovingVertex, PolytopeObstacle};
use crate::planner::NodeKind;

/// Metres. A distance this small has no sign.
const NO_SIGN_M: f64 = 1e-6;

/// Gaps between the two levels of a face beside one that is faster than own ship.
const FAN: usize = 4;

/// Radians. A turn is found to this.
const TURN_RAD: f64 = 1e-13;

/// A moving vertex with the faces that meet there.
#[derive(Debug)]
struct Corner {
    vertex: MovingVertex,
    faces: Vec<HalfSpace>,
    /// False where no way leads past it.
    open: bool,
}

impl Corner {
    /// True when a line in this direction at this speed touches the corner and stays outside.
    fn grazed(&self, ahead: Vector, speed: f64) -> bool {
        let rate = |f: &HalfSpace| speed * f.normal.dot(&ahead) - f.velocity_support;
        self.faces.iter().any(|f| rate(f) <= 1e-9) && self.faces.iter().any(|f| rate(f) >= -1e-9)
    }
}

/// A direction along which the distance from a face is constant, or from another plane that touches the
/// body in one corner.
#[derive(Debug, Clone, Copy)]
struct Level {
    ahead: Vector,
    heading: f64,
    plane: HalfSpace,
}

/// Directions between two [`Level`]s, in which a corner is touched.
#[derive(Debug, Clone, Copy)]
struct Gap {
    corner: usize,
    levels: [usize; 2],
}

/// What does not depend on where own ship is, for one speed.
#[derive(Debug)]
struct Pace {
    speed: f64,
    levels: Vec<Level>,
    gaps: Vec<Gap>,
    /// Corners of sets without an interior: their meetings are sought one by one.
    others: Vec<usize>,
}

/// The corners of one body.
#[derive(Debug)]
pub(crate) struct Aims {
    obstacle: usize,
    window: Option<Window>,
    corners: Vec<Corner>,
    paces: Vec<Pace>,
}

/// A way to a corner.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Aim {
    pub kind: NodeKind,
    pub side: Side,
    pub speed: f64,
    pub meeting: Interception,
}

impl Aims {
    /// `body` is that of the hazard, or stands for it.
    pub(crate) fn new(
        hazard: &Hazard,
        body: &PolytopeObstacle,
        speeds: impl Iterator<Item = f64>,
    ) -> Self {
        Self::past(hazard, body, speeds, |_| true)
    }

    /// The same of those corners alone that are `open` where they are at t = 0.
    pub(crate) fn past(
        hazard: &Hazard,
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
        let paces = speeds.map(|u| Pace::new(faces, &corners, u)).collect();
        Self {
            obstacle: hazard.obstacle,
            window: hazard.window,
            corners,
            paces,
        }
    }

    /// When the clock of these corners starts, and how long they are in force, seconds.
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

    /// Every turn and line at one of the speeds that only just touches a corner. `chases` turn to the sides
    /// of [`Side::BOTH`], at any speed.
    pub(crate) fn touched(
        &self,
        chases: &[Chase; 2],
        limits: Limits,
        signed: &mut Vec<(f64, f64)>,
        mut found: impl FnMut(Aim),
    ) {
        for pace in &self.paces {
            for (side, chase) in Side::BOTH.into_iter().zip(chases) {
                let chase = chase.at_speed(pace.speed);
                let mut offer = |corner: usize, meeting: Interception| {
                    found(Aim {
                        kind: self.kind(corner),
                        side,
                        speed: pace.speed,
                        meeting,
                    });
                };
                signed.clear();
                signed.extend(pace.levels.iter().map(|level| {
                    let turn = wrap(level.heading - chase.heading()) * side.turn_sign();
                    let (position, time) = chase.turned(level.ahead, turn);
                    (turn, level.plane.slack(position, time))
                }));
                for gap in &pace.gaps {
                    let [(a, from), (b, to)] = gap.levels.map(|l| signed[l]);
                    let corner = &self.corners[gap.corner];
                    let touches = from.min(to) <= NO_SIGN_M && from.max(to) >= -NO_SIGN_M;
                    if (a - b).abs() > PI {
                        if a.max(b) <= limits.turn {
                            self.seek(gap.corner, &chase, limits, &mut offer);
                        }
                        continue;
                    }
                    if !touches || a.max(b) < -TURN_RAD || a.min(b) > limits.turn {
                        continue;
                    }
                    let meeting = chase.touch(&corner.vertex, [a, b], limits);
                    if let Some(meeting) = meeting
                        && corner.grazed(chase.after(meeting.turn), pace.speed)
                    {
                        offer(gap.corner, meeting);
                    }
                }
                for &corner in &pace.others {
                    self.seek(corner, &chase, limits, &mut offer);
                }
            }
        }
    }

    fn seek(
        &self,
        corner: usize,
        chase: &Chase,
        limits: Limits,
        offer: &mut impl FnMut(usize, Interception),
    ) {
        let c = &self.corners[corner];
        let meeting = chase.intercept(c.vertex.origin, c.vertex.velocity, limits);
        if let Some(meeting) = meeting
            && c.grazed(chase.after(meeting.turn), chase.speed())
        {
            offer(corner, meeting);
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
        // levels `k` and `k + 1` of a face that has any
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
                // always approached, or always left
                _ if all(1.0) || all(-1.0) => {}
                [a, b] => match (first[a], first[b]) {
                    (Some(a), Some(b)) => {
                        pace.gap(index, [a, b]);
                        pace.gap(index, [a + 1, b + 1]);
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
        });
    }

    fn gap(&mut self, corner: usize, levels: [usize; 2]) {
        self.gaps.push(Gap { corner, levels });
    }

    /// Gaps from one level of a face to its other one: about its normal where the other face is always
    /// approached, about the opposite where it is always left.
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
            self.gap(index, [before, next]);
            before = next;
        }
        self.gap(index, [before, first + 1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Pose;
    use crate::geometry::{ConvexPolygon, outer_disc};
    use crate::planner::space_time::part::{Body, Part};
    use rand::{Rng, SeedableRng};

    /// Every corner is sought one by one; what only just touches has to be among what is found.
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
            let part = Part {
                obstacle: 0,
                window: None,
                body: Body::Polytope(body.clone()),
            };
            let aims = Aims::new(&Hazard::new(&part), &body, speeds.into_iter());
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
            aims.touched(&chases, limits, &mut Vec::new(), |aim| touched.push(aim));
            for aim in &touched {
                let corner = aims.corners.iter().position(|c| {
                    let (initial, velocity) = c.vertex.indices;
                    aim.kind
                        == NodeKind::Vertex {
                            obstacle: 0,
                            initial,
                            velocity,
                        }
                });
                let vertex = &aims.corners[corner.expect("of this body")].vertex;
                let chase = chases[usize::from(aim.side == Side::BOTH[1])].at_speed(aim.speed);
                let ahead = chase.after(aim.meeting.turn);
                let (from, _) = chase.turned(ahead, aim.meeting.turn);
                let own = from + ahead * aim.meeting.line;
                let other = vertex.origin + vertex.velocity * aim.meeting.time;
                assert!((own - other).norm() < 1e-7, "{aim:?}");
            }
            for k in 0..aims.corners.len() {
                for speed in speeds {
                    for (side, chase) in Side::BOTH.into_iter().zip(&chases) {
                        let chase = chase.at_speed(speed);
                        aims.seek(k, &chase, limits, &mut |_, meeting: Interception| {
                            let same = touched.iter().any(|a| {
                                a.kind == aims.kind(k)
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
