//! The size at which a problem is planned.
//!
//! Lengths and times of the graph and the refinement suit encounters in a harbour. Other problems are made alike first, and the plan
//! is made larger or smaller again. Both scales are powers of two: no digit changes but those of angles' products.

use super::hazard::Hazard;
use crate::frame::{Pose, Vector};
use crate::geometry::{ConvexPolygon, Ellipse};
use crate::obstacle::{
    EllipsoidObstacle, Obstacle, PolytopeObstacle, SlabObstacle, SpaceTimeObstacle,
};
use crate::planner::{ExploredGraph, NoPlan, Outcome, Plan, Planned, Problem};
use crate::target::VelocitySpell;
use crate::trajectory::{DesiredTrajectory, Segment, Trajectory};
use crate::vessel::{Hull, OwnShip};

/// Metres. A set whose radius, when it is met, is between these is planned for as it is.
const SMALLEST_M: f64 = 30.0;
const LARGEST_M: f64 = 640.0;

/// Metres. What other radii are brought to, within a factor of the root of two.
const USUAL_M: f64 = 130.0;

/// Metres. The desired way is made no longer than this, lest a speck on it asks for more instants than there is memory.
const LONGEST_M: f64 = 5e5;

/// m/s. What speeds are brought to where lengths are scaled, likewise.
const USUAL_MPS: f64 = 5.0;

/// Doublings or halvings at most.
const MOST_DOUBLINGS: f64 = 40.0;

/// Instants at which the desired trajectory is looked at.
const LOOKS: usize = 64;

/// Metres and seconds of the problem per metre and second of the one that is planned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    length: f64,
    time: f64,
}

/// A problem at another size.
pub(crate) struct Scaled {
    own: OwnShip,
    desired: DesiredTrajectory,
    obstacles: Vec<Obstacle>,
    horizon: f64,
    time_weight: f64,
}

impl Scale {
    /// Of a problem: from the set that own ship, on schedule, meets first, as large as it is then. `None` where that is of a
    /// usual size, and where there is land or a rule to comply with: those are not scaled.
    pub(crate) fn of(problem: &Problem, hazards: &[Hazard]) -> Option<Self> {
        if !problem.coast.is_empty() || !problem.encountered.is_empty() {
            return None;
        }
        let radius = Self::radius_met(problem.desired, hazards)?;
        if !(radius.is_finite() && radius > 0.0) || (SMALLEST_M..=LARGEST_M).contains(&radius) {
            return None;
        }
        let power = |ratio: f64| {
            ratio
                .log2()
                .round()
                .clamp(-MOST_DOUBLINGS, MOST_DOUBLINGS)
                .exp2()
        };
        let least = power(problem.desired.length() / LONGEST_M).min(1.0);
        let length = power(radius / USUAL_M).max(least);
        let speed = problem.desired.length() / problem.desired.duration();
        let time = length * power(USUAL_MPS / speed);
        Some(Self { length, time })
    }

    /// Metres: the radius of the disc around the section that contains own ship on schedule first.
    fn radius_met(desired: &DesiredTrajectory, hazards: &[Hazard]) -> Option<f64> {
        (0..=LOOKS).find_map(|look| {
            let time = desired.duration() * look as f64 / LOOKS as f64;
            let place = desired.position_at(time);
            let met = hazards.iter().filter_map(|h| {
                let (centre, radius) = h.disc_at(time)?;
                ((place - centre).norm() <= radius).then_some(radius)
            });
            met.max_by(f64::total_cmp)
        })
    }

    fn speed(&self) -> f64 {
        self.length / self.time
    }

    fn place(&self, place: Vector) -> Vector {
        place / self.length
    }

    /// A problem at this size; `None` where it leaves no digits.
    pub(crate) fn shrink(&self, problem: &Problem) -> Option<Scaled> {
        let (own, speed) = (problem.own, self.speed());
        let waypoints: Vec<Vector> = problem
            .desired
            .waypoints()
            .into_iter()
            .map(|w| self.place(w))
            .collect();
        let speeds: Vec<f64> = problem
            .desired
            .legs()
            .iter()
            .map(|l| l.speed / speed)
            .collect();
        Some(Scaled {
            own: OwnShip {
                pose: Pose::new(self.place(own.pose.position), own.pose.heading),
                speed: own.speed / speed,
                hull: Hull {
                    length: own.hull.length / self.length,
                    beam: own.hull.beam / self.length,
                },
                turning_radius: own.turning_radius / self.length,
                speeds: own.speeds.iter().map(|u| u / speed).collect(),
                safety_margin: own.safety_margin / self.length,
            },
            desired: DesiredTrajectory::new(&waypoints, &speeds).ok()?,
            obstacles: problem
                .obstacles
                .iter()
                .map(|o| self.obstacle(o))
                .collect::<Option<_>>()?,
            horizon: problem.horizon / self.time,
            time_weight: problem.time_weight / (speed * speed),
        })
    }

    fn obstacle(&self, obstacle: &Obstacle) -> Option<Obstacle> {
        let initial = |p: &ConvexPolygon| p.scaled(1.0 / self.length);
        let velocity = |p: &ConvexPolygon| p.scaled(1.0 / self.speed());
        let ellipse = |e: &Ellipse, unit: f64| {
            Ellipse::from_axes(e.center() / unit, e.semi_axes().map(|a| a / unit))
        };
        Some(match obstacle {
            Obstacle::Polytope(o) => {
                PolytopeObstacle::new(o.name(), initial(o.initial()), velocity(o.velocity())).into()
            }
            Obstacle::Ellipsoid(o) => EllipsoidObstacle::new(
                o.name(),
                ellipse(o.initial(), self.length),
                ellipse(o.velocity(), self.speed()),
            )
            .into(),
            Obstacle::Slabs(o) => {
                let spells = o.spells().iter().map(|s| VelocitySpell {
                    until: s.until / self.time,
                    velocities: velocity(&s.velocities),
                });
                SlabObstacle::new(o.name(), initial(o.initial()), spells.collect())
                    .ok()?
                    .into()
            }
        })
    }

    /// A motion of the problem at this size.
    pub(crate) fn shrink_motion(&self, motion: &[Segment]) -> Vec<Segment> {
        let inverse = Self {
            length: 1.0 / self.length,
            time: 1.0 / self.time,
        };
        motion.iter().map(|s| inverse.segment(s)).collect()
    }

    /// What was planned, at the problem's own size.
    pub(crate) fn restored(&self, planned: Planned) -> Planned {
        let outcome = match planned.outcome {
            Outcome::Solved(plan) => self
                .plan(plan)
                .map_or(Outcome::Infeasible(NoPlan::NoTrajectory), Outcome::Solved),
            Outcome::Deadline(plan) => Outcome::Deadline(plan.and_then(|p| self.plan(p))),
            Outcome::Infeasible(reason) => Outcome::Infeasible(self.reason(reason)),
        };
        Planned {
            outcome,
            explored: self.explored(planned.explored),
            ..planned
        }
    }

    fn cost(&self, cost: f64) -> f64 {
        cost * (self.length * self.length)
    }

    fn pose(&self, pose: Pose) -> Pose {
        Pose::new(pose.position * self.length, pose.heading)
    }

    fn segment(&self, s: &Segment) -> Segment {
        Segment {
            start: self.pose(s.start),
            start_time: s.start_time * self.time,
            duration: s.duration * self.time,
            speed: s.speed * self.speed(),
            turn_rate: s.turn_rate / self.time,
        }
    }

    fn plan(&self, plan: Plan) -> Option<Plan> {
        let segments = plan.trajectory.segments().iter();
        Some(Plan {
            trajectory: Trajectory::new(segments.map(|s| self.segment(s)).collect()).ok()?,
            cost: self.cost(plan.cost),
            graph_cost: plan.graph_cost.map(|c| self.cost(c)),
            to_go: plan.to_go,
        })
    }

    fn explored(&self, mut explored: ExploredGraph) -> ExploredGraph {
        for node in explored.node_weights_mut() {
            node.pose = self.pose(node.pose);
            node.time *= self.time;
            node.cost = self.cost(node.cost);
        }
        for edge in explored.edge_weights_mut() {
            edge.cost = self.cost(edge.cost);
            for segment in &mut edge.segments {
                *segment = self.segment(segment);
            }
        }
        explored
    }

    fn reason(&self, reason: NoPlan) -> NoPlan {
        match reason {
            NoPlan::StartInside { target, depth } => NoPlan::StartInside {
                target,
                depth: depth * self.length,
            },
            NoPlan::HorizonTooShort { earliest, horizon } => NoPlan::HorizonTooShort {
                earliest: earliest * self.time,
                horizon: horizon * self.time,
            },
            NoPlan::NoCandidate { target, time } => NoPlan::NoCandidate {
                target,
                time: time * self.time,
            },
            // of land or rules, which are not scaled, of other planners, or without a number
            other => other,
        }
    }
}

impl Scaled {
    /// As a problem; what has no size is that of the original.
    pub(crate) fn problem<'a>(&'a self, of: &Problem<'a>) -> Problem<'a> {
        Problem {
            own: &self.own,
            desired: &self.desired,
            obstacles: &self.obstacles,
            horizon: self.horizon,
            time_weight: self.time_weight,
            ..*of
        }
    }
}
