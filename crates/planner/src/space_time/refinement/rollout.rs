//! Rollout of a manoeuvre: its segments, their segment variables, and how they move with the
//! lengths.

use crate::Problem;
use crate::space_time::manoeuvre::ending::Ending;
use crate::space_time::refinement::gauss_newton::Twist;
use crate::space_time::refinement::quadratic::{MAX_VARIABLES, Row};
use searoom_geometry::frame::{Vector, cross, to_port};
use searoom_model::trajectory::Segment;

/// Origin of a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SegmentOrigin {
    /// Part of segment variable `index`. It grows with the variable, or is a part of the route before
    /// the one that does.
    SegmentVariable { index: usize, grows: bool },
    /// The route followed after the manoeuvre.
    ReturnSegments { index: usize },
}

impl SegmentOrigin {
    /// The part of segment variable `index` that grows with it.
    pub(crate) fn growing(index: usize) -> Self {
        let grows = true;
        Self::SegmentVariable { index, grows }
    }
}

/// Segment with its origin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Leg {
    pub segment: Segment,
    /// Unit vector ahead at its start.
    pub ahead: Vector,
    pub owner: SegmentOrigin,
}

impl Leg {
    /// Position and unit vector ahead at a fraction.
    pub(crate) fn along(&self, fraction: f64) -> (Vector, Vector) {
        let s = &self.segment;
        let length = s.speed * s.duration * fraction;
        if s.is_arc() {
            turned(s.start.position, self.ahead, length, s.turn_rate / s.speed)
        } else {
            (s.start.position + self.ahead * length, self.ahead)
        }
    }
}

/// Position and unit vector ahead after an arc; `1 - cos` is computed without cancellation.
pub(crate) fn turned(from: Vector, ahead: Vector, length: f64, curvature: f64) -> (Vector, Vector) {
    let (sin, cos) = (curvature * length).sin_cos();
    let versine = if cos > 0.0 {
        sin * sin / (1.0 + cos)
    } else {
        1.0 - cos
    };
    let port = to_port(ahead);
    let end = from + (ahead * sin + port * versine) / curvature;
    (end, ahead * cos + port * sin)
}

/// Rigid motion of everything after a segment variable, per metre of its length.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RigidMotion {
    /// End of the segment variable, direction there, and curvature.
    pub end: Vector,
    pub ahead: Vector,
    pub curvature: f64,
    pub slowness: f64,
}

impl RigidMotion {
    pub(crate) fn velocity_of(&self, point: Vector) -> Vector {
        self.ahead + to_port(point - self.end) * self.curvature
    }
}

/// Manoeuvre with given lengths.
#[derive(Debug, Clone)]
pub(crate) struct Rollout {
    /// Segments in order of time, including those of zero length.
    pub legs: Vec<Leg>,
    /// Index in `legs` of the first return segment.
    pub return_segments: usize,
    /// Distance along the route and time at which the return segments begin.
    pub joined: (f64, f64),
    /// Remaining length of the leg after a return, metres.
    pub room: Option<f64>,
    /// Lengths of the dependent segment variables.
    pub solved: [f64; 2],
    /// Rates of the dependent segment variables with each free one.
    pub solved_rates: [Row; 2],
    /// Number of initial segment variables that follow the route.
    pub runs: usize,
    pub rigid_motions: Vec<RigidMotion>,
}

/// Point of a manoeuvre that belongs to a segment variable.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub position: Vector,
    pub ahead: Vector,
    pub time: f64,
    /// Seconds per metre there.
    pub slowness: f64,
    /// Segment variable, and the metres by which the point moves ahead per metre of it.
    pub variable: usize,
    pub share: f64,
}

impl Rollout {
    /// Midpoint of each segment's ends. No point of the segment is farther from it than half the
    /// segment's length.
    pub(crate) fn middles(&self) -> Vec<Vector> {
        let ends = self.legs.iter().skip(1).map(|l| l.segment.start.position);
        let last = self.legs.last().map(|l| l.along(1.0).0);
        let pairs = self.legs.iter().zip(ends.chain(last));
        pairs
            .map(|(l, end)| l.segment.start.position.lerp(&end, 0.5))
            .collect()
    }

    /// Point at `fraction` of a segment; `None` on the return segments.
    pub(crate) fn place(&self, leg: usize, fraction: f64) -> Option<Place> {
        let l = &self.legs[leg];
        let SegmentOrigin::SegmentVariable { index, grows } = l.owner else {
            return None;
        };
        let (position, ahead) = l.along(fraction);
        Some(Place {
            position,
            ahead,
            time: l.segment.start_time + l.segment.duration * fraction,
            slowness: 1.0 / l.segment.speed,
            variable: index,
            share: if grows { fraction } else { 0.0 },
        })
    }

    /// Rates of a point with its own segment variable: (east, north, clock) per metre.
    pub(crate) fn own_rate(&self, place: &Place, index: usize) -> [f64; 3] {
        let (share, slowness) = match index == place.variable {
            true => (place.share, place.slowness),
            false => (1.0, self.rigid_motions[index].slowness),
        };
        [
            share * place.ahead.x,
            share * place.ahead.y,
            share * slowness,
        ]
    }

    /// Rates of `of . (east, north, clock)` per metre of each segment variable up to the point's
    /// own.
    pub(crate) fn rates(&self, place: &Place, of: [f64; 3]) -> Row {
        let mut row = [0.0; MAX_VARIABLES];
        let on_route = place.variable < self.runs;
        let all = row.iter_mut().zip(&self.rigid_motions).enumerate();
        for (i, (rate, rigid_motions)) in all.take(place.variable + 1) {
            *rate = if on_route || i == place.variable {
                let own = self.own_rate(place, i);
                of[0] * own[0] + of[1] * own[1] + of[2] * own[2]
            } else {
                let moved = rigid_motions.velocity_of(place.position);
                of[0] * moved.x + of[1] * moved.y + of[2] * rigid_motions.slowness
            };
        }
        row
    }

    /// Twist of each segment variable about `origin`.
    pub(crate) fn twists(&self, origin: Vector) -> Vec<Twist> {
        let twist = |r: &RigidMotion| {
            let end = r.end - origin;
            [
                r.ahead.x + r.curvature * end.y,
                r.ahead.y - r.curvature * end.x,
                r.slowness,
                r.curvature,
            ]
        };
        self.rigid_motions.iter().map(twist).collect()
    }

    /// Rates of the dependent segment variables with any change given as a twist about `origin`, as
    /// linear forms.
    pub(crate) fn solved_by(
        &self,
        ending: Ending,
        problem: &Problem,
        origin: Vector,
    ) -> [Twist; 2] {
        let [.., line_or_arc, last] = &self.rigid_motions[..] else {
            return [[0.0; 4]; 2];
        };
        match ending {
            Ending::Follow => [[0.0; 4]; 2],
            Ending::Return { leg, .. } => {
                let normal = to_port(problem.desired.legs()[leg].direction);
                let across = normal.dot(&line_or_arc.ahead);
                let by_place = along(normal / -across, last.end - origin);
                [by_place, [0.0, 0.0, 0.0, -1.0 / last.curvature]]
            }
            Ending::Goal { .. } => {
                let goal = problem.desired.end();
                let (by_arc, by_line) = (line_or_arc.velocity_of(goal), last.ahead);
                let determinant = cross(by_arc, by_line);
                let at = goal - origin;
                [
                    along(to_port(by_line) / determinant, at),
                    along(to_port(by_arc) / -determinant, at),
                ]
            }
        }
    }

    /// Rate of the joining position along the route, as a linear form of a twist about `origin`.
    pub(crate) fn joined_by(&self, origin: Vector) -> Twist {
        self.rigid_motions
            .last()
            .map_or([0.0; 4], |last| along(last.ahead, last.end - origin))
    }

    /// Rates of the joining position and time: metres along the route and seconds per metre of each
    /// segment variable.
    pub(crate) fn joining_rates(&self) -> (Row, Row) {
        let mut distance = [0.0; MAX_VARIABLES];
        let mut clock = [0.0; MAX_VARIABLES];
        let Some(last) = self.rigid_motions.last() else {
            return (distance, clock);
        };
        let runs_only = self.runs == self.rigid_motions.len();
        for (i, r) in self.rigid_motions.iter().enumerate() {
            distance[i] = if runs_only {
                1.0
            } else {
                last.ahead.dot(&r.velocity_of(last.end))
            };
            clock[i] = r.slowness;
        }
        (distance, clock)
    }

    /// Segments of non-zero length in order, with equal neighbours merged.
    pub(crate) fn motion(&self) -> Vec<Segment> {
        let mut motion: Vec<Segment> = Vec::with_capacity(self.legs.len());
        for segment in self.legs.iter().map(|l| l.segment) {
            let has_length =
                segment.length() > searoom_geometry::tolerance::LENGTH_M || segment.speed == 0.0;
            if !(segment.duration > 0.0 && has_length) {
                continue;
            }
            match motion.last_mut() {
                Some(last)
                    if last.speed == segment.speed && last.turn_rate == segment.turn_rate =>
                {
                    last.duration = segment.end_time() - last.start_time;
                }
                _ => motion.push(segment),
            }
        }
        motion
    }
}

/// `direction . (velocity of the point under a twist)`, as a linear form of the twist.
fn along(direction: Vector, point: Vector) -> Twist {
    [direction.x, direction.y, 0.0, cross(point, direction)]
}
