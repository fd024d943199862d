//! Sets that a motion enters: until when.

use super::ladder::TOUCH_M;
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::planner::{Outcome, Planned, PlannerKind, Problem, path_time, space_time};
use crate::trajectory::{Segment, Trajectory};

/// Seconds between two looks at whether a set has been left, and halvings of that within which the instant is found.
const LOOK_S: f64 = 1.0;
const HALVINGS: usize = 30;

/// A motion that need not be clear of anything: off the path to its end, clear from as early on as was found; along paths the
/// one that does least harm. `None` where there is none within the horizon.
pub(super) fn motion(kind: PlannerKind, problem: &Problem) -> Option<Planned> {
    match kind {
        PlannerKind::SpaceTime => {
            let plan = space_time::escape(problem)?;
            Some(Planned::of(Outcome::Solved(plan)))
        }
        PlannerKind::PathTime => path_time::least_harm(problem),
        PlannerKind::OptimalControl => None,
    }
}

/// Seconds from which on a motion is clear of a set; `None` where it is so all along, its end where it never is. Errs to
/// the late side, by some nanoseconds.
pub(super) fn left_for_good(set: &Obstacle, trajectory: &Trajectory) -> Option<f64> {
    let end = trajectory.end_time();
    // what has no interior is not to be touched, not even crossed
    let set = set.outer_where_flat();
    let contact = |from: f64| {
        let later = trajectory.segments().iter().filter(|s| s.end_time() > from);
        let mut later = later.map(|s: &Segment| s.between(from, s.end_time()));
        later.find_map(|s| set.first_contact(&s, TOUCH_M))
    };
    let inside = |time: f64| {
        let at = trajectory.pose_at(time).position;
        // negated on purpose: a NaN is inside
        !(set.signed_distance(at, time).distance >= 0.0)
    };
    let mut from = trajectory.start_time();
    let mut met = contact(from)?;
    loop {
        let mut last = met.max(from);
        let mut next = last + LOOK_S;
        while next < end && inside(next) {
            (last, next) = (next, next + LOOK_S);
        }
        if next >= end {
            return Some(end);
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (last + next);
            if inside(middle) {
                last = middle;
            } else {
                next = middle;
            }
        }
        from = next;
        match contact(from) {
            Some(again) => met = again,
            None => return Some(from),
        }
    }
}
