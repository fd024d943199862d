//! What is minimised over the graph.

use super::due::Due;
use super::nodes::{Mark, Node, Place};
use super::recovery::Recovery;
use super::scene::Scene;
use crate::frame::{Pose, heading_of};
use crate::obstacle::PathTime;
use crate::planner::cost::space_time_error;
use crate::planner::{Objective, Problem, SearchKind};
use crate::tolerance;
use crate::trajectory::Segment;

/// Metres per second. Of ways of one length the earliest is the best: a thousand seconds weigh a
/// millimetre.
const METRES_PER_SECOND: f64 = 1e-6;

/// Of the horizon. Arrivals at a place on a network so soon after another are not followed.
const ALIKE: f64 = 2e-3;

/// See the head of the file.
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

    /// The cost of a line: seconds, metres or m².
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
                let segment = Segment {
                    start: Pose::new(start, heading),
                    start_time: from.time,
                    duration: time,
                    speed: way / time,
                    turn_rate: 0.0,
                };
                space_time_error(self.problem.desired, &segment, self.problem.time_weight)
            }
        }
    }

    /// At most the cost of the way to the end, of which so many metres are left at a time.
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

    /// True when to arrive at a place before another way does, and wait, is never worse.
    pub(crate) fn waits_are_free(&self) -> bool {
        match self.problem.objective {
            Objective::Time | Objective::Length | Objective::LengthRisk { .. } => true,
            Objective::SpaceTimeError => false,
        }
    }

    /// Seconds within which to arrive at a place after another way did, which costs less so far, is
    /// taken for worse. Of the space-time error that is so where own ship could wait meanwhile, but
    /// for what the wait costs; on a network the ways would be too many without it.
    pub(crate) fn as_good_within(&self) -> f64 {
        if self.waits_are_free() {
            f64::INFINITY
        } else if self.problem.alternatives.is_empty() {
            0.0
        } else {
            ALIKE * self.problem.horizon
        }
    }

    /// True when a line between two nodes of a leg may be part of a best profile: of least time or
    /// length any may; of least space-time error those at an extreme speed, on schedule, along an
    /// edge, and those that end at a corner.
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

    /// Where the way to a corner that keeps nearest to the schedule bends: at full speed first
    /// while behind it, at rest first while ahead. `None` where that would cross the schedule, or
    /// nothing is won.
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
        // negated on purpose: a NaN is no time
        if !(sailing > tolerance::TIME_S && idle > tolerance::TIME_S) {
            return None;
        }
        let behind = due.lag(from) >= 0.0 && due.lag(at) >= 0.0;
        let via = if behind {
            PathTime {
                distance: at.distance,
                time: from.time + sailing,
            }
        } else {
            PathTime {
                distance: from.distance,
                time: from.time + idle,
            }
        };
        let lag = due.lag(via);
        let ahead = due.lag(from) <= 0.0 && due.lag(at) <= 0.0;
        ((behind && lag >= 0.0) || (ahead && lag <= 0.0)).then_some(via)
    }
}
