//! Path following in space and time: line of sight on the planned path, speed by its schedule.

use super::vessel::{Order, Vessel, VesselState};
use crate::frame::{Vector, direction, heading_of, wrap};
use crate::trajectory::Trajectory;

/// Distance ahead on the path at which own ship aims, lengths. A ship that is a quarter of its
/// length off the path then corrects by 2°, the least that the judges count as an alteration.
const LOOKAHEAD_LENGTHS: f64 = 8.0;

/// Seconds in which a delay on the schedule is to be made up. Twice the default time constant of
/// the speed, 5 s: the damping ratio is then `0.5 sqrt(10 / 5)` = 0.7.
const CATCH_UP_S: f64 = 10.0;

/// Own ship may order this factor of its largest planned speed to catch up. Without a reserve a
/// delay at that speed would remain; a tenth is an ordinary reserve of an engine.
const MOST_SPEED: f64 = 1.1;

/// The nearest point of the path is within this time of the schedule, seconds. A path that comes
/// back near itself does so later: a circle of the smallest radius takes two minutes at 5 m/s and
/// 100 m.
const WINDOW_S: f64 = 60.0;

/// Steps of the projection onto the path. One is exact on a line. On an arc each leaves the
/// fraction `distance / radius` of the error: at a tenth, five leave 1e-5.
const PROJECTIONS: usize = 5;

/// Seconds over which the turn rate of the path is taken: the default step, which is shorter than
/// the time constants of ships, so that turns begin and end in time.
const RATE_S: f64 = 0.5;

/// m/s. A slower stretch of the path has no progress along it: a division by its speed is unstable.
const NO_WAY: f64 = 0.05;

/// Orders that bring own ship to where the plan has it at `time` of the plan. A `current` (m/s) is
/// the one that own ship knows of. O(log segments).
pub(super) fn follow(
    plan: &Trajectory,
    time: f64,
    vessel: &Vessel,
    state: &VesselState,
    max_speed: f64,
    current: Vector,
) -> Order {
    let nearest = nearest_time(plan, time, state);
    let path = plan.pose_at(nearest);
    let aside = path.body_coordinates(state.pose.position).y;
    // the ship answers late, so a turn is ordered early
    let early = nearest + vessel.lag(state.speed);
    let turned = plan.pose_at(early + RATE_S).heading - plan.pose_at(early).heading;
    let course = path.heading - (aside / (LOOKAHEAD_LENGTHS * vessel.length)).atan();
    // so is a change of speed
    let planned = plan.speed_at((time + vessel.speed_lag()).min(plan.end_time()));
    let behind = planned.max(plan.speed_at(nearest)) * (time - nearest);
    let most = MOST_SPEED * max_speed;
    let speed = (planned + behind / CATCH_UP_S).clamp(0.0, most);
    let water = direction(course) * speed - current;
    let (course, speed) = if water.norm() > NO_WAY && current != Vector::zeros() {
        (heading_of(water), water.norm().min(most))
    } else {
        (course, speed)
    };
    Order {
        heading: course,
        turn_rate: wrap(turned) / RATE_S,
        speed,
    }
}

/// Time of the plan at which its path is nearest to own ship, near the scheduled time.
fn nearest_time(plan: &Trajectory, time: f64, state: &VesselState) -> f64 {
    let from = (time - WINDOW_S).max(plan.start_time());
    let until = (time + WINDOW_S).min(plan.end_time()).max(from);
    let mut nearest = time.clamp(from, until);
    for _ in 0..PROJECTIONS {
        let ahead = plan
            .pose_at(nearest)
            .body_coordinates(state.pose.position)
            .x;
        let speed = plan.speed_at(nearest);
        if speed > NO_WAY {
            nearest = (nearest + ahead / speed).clamp(from, until);
        }
    }
    nearest
}
