//! Cost function of the graph search.

use super::due::Due;
use super::nodes::{Mark, Node, Place};
use super::recovery::Recovery;
use super::scene::Scene;
use crate::cost::{error_after_end, space_time_error};
use crate::{Objective, Problem, SearchKind};
use searoom_geometry::frame::{Pose, heading_of};
use searoom_geometry::tolerance;
use searoom_model::trajectory::Segment;
use searoom_sets::PathTime;

/// Tie-break in metres per second: of paths of equal length, the earliest wins. A thousand seconds
/// weigh one millimetre.
const METRES_PER_SECOND: f64 = 1e-6;

/// Fraction of the horizon. On a network, later arrivals at a position within this time are pruned.
const ALIKE: f64 = 2e-3;

/// Cost function and its lower bound.
#[derive(Debug, Clone)]
pub(crate) struct Measure<'a> {
    problem: &'a Problem<'a>,
    recovery: Option<Recovery<'a>>,
}

impl<'a> Measure<'a> {
    pub(crate) fn new(problem: &'a Problem<'a>) -> Self {
        let informed =
            problem.search == SearchKind::AStar && problem.objective == Objective::SpaceTimeError;
        Self {
            problem,
            recovery: informed.then(|| Recovery::new(problem)).flatten(),
        }
    }

    /// Returns the cost of a line in seconds, metres or m².
    pub(crate) fn of(&self, scene: &Scene, place: Place, from: PathTime, to: PathTime) -> f64 {
        let (way, time) = (to.distance - from.distance, to.time - from.time);
        match self.problem.objective {
            Objective::Time => time,
            Objective::Length | Objective::LengthRisk { .. } => way + METRES_PER_SECOND * time,
            Objective::SpaceTimeError => {
                let (start, heading) = match place {
                    Place::On { leg, .. } => {
                        let on_schedule = |due: &Due| {
                            [from, to].map(|p| due.lag(p).abs() <= tolerance::LENGTH_M) == [true; 2]
                        };
                        if scene.dues[leg].as_ref().is_some_and(on_schedule) {
                            return 0.0;
                        }
                        let track = &scene.tracks[leg];
                        (track.at(from.distance), heading_of(track.direction))
                    }
                    Place::At(point) => (scene.network.place(point), 0.0),
                };
                let segment =
                    Segment::straight(Pose::new(start, heading), from.time, time, way / time);
                space_time_error(self.problem.desired, &segment, self.problem.time_weight)
            }
        }
    }

    /// Cost of lying at the end of the path from `time` to the end of the desired trajectory, m².
    pub(crate) fn after_arrival(&self, time: f64) -> f64 {
        if self.waits_are_free() {
            return 0.0;
        }
        let desired = self.problem.desired;
        let end = Segment::straight(Pose::new(desired.end(), 0.0), time, 0.0, 0.0);
        error_after_end(desired, &end, self.problem.time_weight)
    }

    /// Lower bound of the cost to the end, given the remaining metres and the current time.
    pub(crate) fn bound(&self, scene: &Scene, to_go: f64, now: f64) -> f64 {
        let time = to_go / scene.max_speed;
        match self.problem.objective {
            Objective::Time => time,
            Objective::Length | Objective::LengthRisk { .. } => to_go + METRES_PER_SECOND * time,
            Objective::SpaceTimeError => {
                let recovery = self.recovery.as_ref();
                recovery.map_or(0.0, |recovery| recovery.bound(to_go, now))
            }
        }
    }

    /// True if an earlier arrival followed by a wait is never worse than a later arrival.
    pub(crate) fn waits_are_free(&self) -> bool {
        self.problem.objective != Objective::SpaceTimeError
    }

    /// Time in seconds within which a cheaper earlier arrival dominates a later one. For the
    /// space-time error, dominance holds if own ship could wait meanwhile, except for the cost of
    /// the wait. Without this pruning, a network would have too many paths.
    pub(crate) fn as_good_within(&self) -> f64 {
        if self.waits_are_free() {
            f64::INFINITY
        } else if self.problem.alternatives.is_empty() {
            0.0
        } else {
            ALIKE * self.problem.horizon
        }
    }

    /// True if a line between two nodes of a leg may belong to an optimal profile. For time and
    /// length, every line may. For the space-time error, only lines at an extreme speed, on
    /// schedule, along an edge, or ending at a corner may.
    pub(crate) fn joins(
        &self,
        scene: &Scene,
        ends: [&Node; 2],
        from: PathTime,
        to: PathTime,
    ) -> bool {
        if self.waits_are_free() {
            return true;
        }
        let [before, after] = ends;
        let (way, time) = (to.distance - from.distance, to.time - from.time);
        way <= tolerance::LENGTH_M
            || scene.max_speed * time - way <= tolerance::LENGTH_M
            || (before.due && after.due)
            || after.mark == Mark::Corner
            || (before.on_edge_of.is_some() && before.on_edge_of == after.on_edge_of)
    }

    /// Returns the bend of the line to a corner that stays closest to the schedule. The line starts
    /// with full speed while behind schedule, and with rest while ahead. `None` if it would cross
    /// the schedule or gain nothing.
    pub(crate) fn bend(
        &self,
        scene: &Scene,
        leg: usize,
        to: &Node,
        from: PathTime,
        at: PathTime,
    ) -> Option<PathTime> {
        if self.waits_are_free() || to.mark != Mark::Corner {
            return None;
        }
        let due = scene.dues[leg].as_ref()?;
        let sailing = (at.distance - from.distance) / scene.max_speed;
        let idle = at.time - from.time - sailing;
        // negated on purpose: rejects NaN
        if !(sailing > tolerance::TIME_S && idle > tolerance::TIME_S) {
            return None;
        }
        let behind = due.lag(from) >= 0.0 && due.lag(at) >= 0.0;
        let via = if behind {
            PathTime::new(at.distance, from.time + sailing)
        } else {
            PathTime::new(from.distance, from.time + idle)
        };
        let lag = due.lag(via);
        let ahead = due.lag(from) <= 0.0 && due.lag(at) <= 0.0;
        ((behind && lag >= 0.0) || (ahead && lag <= 0.0)).then_some(via)
    }
}
