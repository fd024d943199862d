//! Manoeuvre structure: a chain of segment variables with free lengths.
//!
//! Kinds, sides and speeds are fixed; the lengths in metres are the variables of the refinement.
//! Lengthening a segment variable moves everything after it as a rigid body: along a line, or about
//! the centre of its circle. That gives every derivative in closed form. Up to two last segment
//! variables are dependent: they are solved so that the chain ends on the desired path or at its
//! end.

use crate::Problem;
use crate::space_time::manoeuvre::ending::Ending;
use crate::space_time::manoeuvre::interceptor::Interceptor;
use crate::space_time::refinement::quadratic::{MAX_VARIABLES, Row};
use crate::space_time::refinement::rollout::{Leg, RigidMotion, Rollout, SegmentOrigin, turned};
use crate::space_time::route::{Route, StraightStretch};
use searoom_geometry::frame::{Pose, Side, Vector, cross, heading_of, to_port, wrap};
use searoom_model::trajectory::Segment;

/// Smallest return angle that can be solved, radians.
pub(crate) const FLATTEST_RETURN: f64 = 0.01;

/// Segment variable: kind, side and speed of a part of a manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SegmentVariable {
    /// Follows the route at the ordered speed of each of its parts; where the manoeuvre begins that is
    /// `speed`.
    Ordered { speed: f64 },
    /// Follows the route at one speed.
    Run { speed: f64 },
    /// Turns with the turning radius.
    Arc { side: Side, speed: f64 },
    /// Straight line.
    Line { speed: f64 },
}

impl SegmentVariable {
    pub(crate) fn speed(&self) -> f64 {
        match *self {
            Self::Ordered { speed } | Self::Run { speed } => speed,
            Self::Arc { speed, .. } | Self::Line { speed } => speed,
        }
    }

    /// True for a part of the route.
    pub(crate) fn is_on_route(&self) -> bool {
        matches!(self, Self::Ordered { .. } | Self::Run { .. })
    }

    /// This segment variable at another speed.
    pub(crate) fn at_speed(self, speed: f64) -> Self {
        match self {
            Self::Ordered { speed: ordered } if speed == ordered => self,
            Self::Ordered { .. } | Self::Run { .. } => Self::Run { speed },
            Self::Arc { side, .. } => Self::Arc { side, speed },
            Self::Line { .. } => Self::Line { speed },
        }
    }
}

/// Segment variables and ending: the fixed part of a manoeuvre.
#[derive(Debug, Clone)]
pub(crate) struct Structure {
    pub variables: Vec<SegmentVariable>,
    pub ending: Ending,
}

impl Structure {
    /// Number of free variables.
    pub(crate) fn free(&self) -> usize {
        self.variables.len()
    }

    /// Number of all segment variables, including the dependent ones.
    pub(crate) fn all(&self) -> usize {
        self.variables.len() + self.ending.dependents()
    }

    /// Rolls the manoeuvre out with the given lengths; `None` when its ending does not fit.
    pub(crate) fn roll_out(
        &self,
        problem: &Problem,
        route: &Route,
        lengths: &Row,
    ) -> Option<Rollout> {
        let radius = problem.own.turning_radius;
        let mut rollout = Rollout {
            legs: Vec::with_capacity(2 * self.all() + 8),
            return_segments: 0,
            joined: (0.0, 0.0),
            room: None,
            solved: [0.0; 2],
            solved_rates: [[0.0; MAX_VARIABLES]; 2],
            runs: 0,
            rigid_motions: Vec::with_capacity(self.all()),
        };
        let mut at = Cursor {
            pose: problem.own.pose,
            ahead: problem.own.pose.ahead(),
            time: 0.0,
            route: 0.0,
            radius,
        };
        let mut runs = 0;
        for (index, variable) in self.variables.iter().enumerate() {
            if variable.is_on_route() {
                at.run(route, *variable, index, lengths[index], &mut rollout);
                runs = index + 1;
            } else {
                at.roll_out(*variable, index, lengths[index], &mut rollout);
            }
        }
        // runs move what follows along the route at the end of the last run
        rollout.runs = runs;
        if runs > 0 {
            let (pose, curvature) = route.pose_at(lengths[..runs].iter().sum());
            for r in &mut rollout.rigid_motions[..runs] {
                (r.end, r.ahead, r.curvature) = (pose.position, pose.ahead(), curvature);
            }
        }
        match self.ending {
            Ending::Follow => rollout.joined = (at.route, at.time),
            Ending::Return { leg, speed } => {
                let stretch = route.stretch(leg, problem.desired)?;
                self.return_to(problem, leg, stretch, speed, &mut at, &mut rollout)?;
            }
            Ending::Goal { side, speed } => {
                self.approach(problem, side, speed, &mut at, &mut rollout)?
            }
        }
        rollout.return_segments = rollout.legs.len();
        if !matches!(self.ending, Ending::Goal { .. }) {
            let return_segments = route.follow(rollout.joined.0, rollout.joined.1);
            for (index, segment) in return_segments.into_iter().enumerate() {
                let owner = SegmentOrigin::ReturnSegments { index };
                at.follow(segment, owner, &mut rollout);
            }
        }
        let end = rollout
            .legs
            .last()
            .map_or(at.time, |l| l.segment.end_time());
        // negated on purpose: a NaN does not fit
        if !(end <= problem.horizon) {
            return None;
        }
        Some(rollout)
    }

    /// Solves the line and arc back onto a leg.
    fn return_to(
        &self,
        problem: &Problem,
        leg: usize,
        stretch: StraightStretch,
        speed: f64,
        at: &mut Cursor,
        rollout: &mut Rollout,
    ) -> Option<()> {
        let l = &problem.desired.legs()[leg];
        let radius = at.radius;
        let relative = wrap(at.pose.heading - heading_of(l.direction));
        if !(relative.abs() >= FLATTEST_RETURN && relative.abs() < 2.5) {
            return None;
        }
        let side = if relative > 0.0 {
            Side::Starboard
        } else {
            Side::Port
        };
        let offset = cross(l.direction, at.pose.position - l.start);
        let gain = side.turn_sign() * radius * (relative.cos() - 1.0);
        let line = -(offset + gain) / relative.sin();
        if !(line >= 0.0) {
            return None;
        }
        rollout.solved = [line, radius * relative.abs()];
        let n = self.variables.len();
        let [line, arc] = rollout.solved;
        at.roll_out(SegmentVariable::Line { speed }, n, line, rollout);
        at.roll_out(SegmentVariable::Arc { side, speed }, n + 1, arc, rollout);
        let along = l.direction.dot(&(at.pose.position - l.start));
        if !(along >= stretch.from && along <= stretch.to) {
            return None;
        }
        rollout.joined = (stretch.distance + along - stretch.from, at.time);
        rollout.room = Some(stretch.to - along);
        let normal = to_port(l.direction);
        let end = at.pose.position;
        let across = normal.dot(&rollout.rigid_motions[n].ahead);
        let curvature = rollout.rigid_motions[n + 1].curvature;
        for i in 0..n {
            let r = &rollout.rigid_motions[i];
            rollout.solved_rates[0][i] = -normal.dot(&r.velocity_of(end)) / across;
            rollout.solved_rates[1][i] = -r.curvature / curvature;
        }
        Some(())
    }

    /// Solves the arc and line to the last waypoint.
    fn approach(
        &self,
        problem: &Problem,
        side: Side,
        speed: f64,
        at: &mut Cursor,
        rollout: &mut Rollout,
    ) -> Option<()> {
        let radius = at.radius;
        let goal = problem.desired.end();
        let interceptor = Interceptor::new(&at.pose, at.time, speed, radius, side);
        let (turn, line) = interceptor.path_to(goal)?;
        if !(turn < 2.5) {
            return None;
        }
        rollout.solved = [turn * radius, line];
        let n = self.variables.len();
        let [arc, line] = rollout.solved;
        at.roll_out(SegmentVariable::Arc { side, speed }, n, arc, rollout);
        at.roll_out(SegmentVariable::Line { speed }, n + 1, line, rollout);
        let (by_arc, by_line) = (
            rollout.rigid_motions[n].velocity_of(goal),
            rollout.rigid_motions[n + 1].ahead,
        );
        let determinant = cross(by_arc, by_line);
        if determinant.abs() < 1e-9 {
            return None;
        }
        for i in 0..n {
            let moved = rollout.rigid_motions[i].velocity_of(goal);
            rollout.solved_rates[0][i] = -cross(moved, by_line) / determinant;
            rollout.solved_rates[1][i] = -cross(by_arc, moved) / determinant;
        }
        Some(())
    }
}

/// Position, time and distance along the route during a rollout.
struct Cursor {
    pose: Pose,
    ahead: Vector,
    time: f64,
    route: f64,
    radius: f64,
}

impl Cursor {
    /// Appends a segment of the route and advances to its end.
    fn follow(&mut self, segment: Segment, owner: SegmentOrigin, rollout: &mut Rollout) {
        let ahead = if segment.start.heading == self.pose.heading {
            self.ahead
        } else {
            segment.start.ahead()
        };
        rollout.legs.push(Leg {
            segment,
            ahead,
            owner,
        });
        (self.pose, self.time) = (segment.end(), segment.end_time());
        self.ahead = if segment.is_arc() {
            self.pose.ahead()
        } else {
            ahead
        };
    }

    fn run(
        &mut self,
        route: &Route,
        variable: SegmentVariable,
        index: usize,
        length: f64,
        rollout: &mut Rollout,
    ) {
        let mut motions = Vec::new();
        let (before, time) = (self.route, self.time);
        self.route = match variable {
            SegmentVariable::Ordered { .. } => {
                route.run_ordered(before, time, length, &mut motions)
            }
            _ => route.run(before, time, length, variable.speed(), &mut motions),
        };
        let speed = match (motions.last(), variable) {
            (Some(last), _) => last.speed,
            (None, SegmentVariable::Ordered { .. }) => route.ordered_speed(before),
            (None, _) => variable.speed(),
        };
        let last = motions.pop();
        for segment in motions {
            let grows = false;
            let owner = SegmentOrigin::SegmentVariable { index, grows };
            self.follow(segment, owner, rollout);
        }
        let owner = SegmentOrigin::growing(index);
        match last {
            Some(segment) => self.follow(segment, owner, rollout),
            None => rollout.legs.push(Leg {
                segment: Segment::straight(self.pose, self.time, 0.0, speed),
                ahead: self.ahead,
                owner,
            }),
        }
        rollout.rigid_motions.push(RigidMotion {
            end: self.pose.position,
            ahead: self.ahead,
            curvature: 0.0,
            slowness: 1.0 / speed,
        });
    }

    fn roll_out(
        &mut self,
        variable: SegmentVariable,
        index: usize,
        length: f64,
        rollout: &mut Rollout,
    ) {
        let curvature = match variable {
            SegmentVariable::Arc { side, .. } => side.turn_sign() / self.radius,
            _ => 0.0,
        };
        let speed = variable.speed();
        let segment = Segment::new(
            self.pose,
            self.time,
            length / speed,
            speed,
            curvature * speed,
        );
        rollout.legs.push(Leg {
            segment,
            ahead: self.ahead,
            owner: SegmentOrigin::growing(index),
        });
        if length > 0.0 {
            let (position, ahead) = if curvature == 0.0 {
                (self.pose.position + self.ahead * length, self.ahead)
            } else {
                turned(self.pose.position, self.ahead, length, curvature)
            };
            self.pose = Pose::new(position, self.pose.heading + curvature * length);
            (self.ahead, self.time) = (ahead, segment.end_time());
        }
        rollout.rigid_motions.push(RigidMotion {
            end: self.pose.position,
            ahead: self.ahead,
            curvature,
            slowness: 1.0 / speed,
        });
    }
}
