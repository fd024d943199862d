//! Motion that slows down on its route until other ships have passed, then continues.
//!
//! ```text
//! places x lower speeds x sidestep ─► have all passed? ─► clear until then? ─► plan from there
//! ```
//!
//! In narrow water one manoeuvre may not comply with the rules toward a ship and pass the next one
//! as well. Own ship then lets the first one pass (Rule 8(e)). Where the rules ask for a turn to a
//! side, it also tries a sidestep to that side before it slows down.

use crate::clock::Clock;
use crate::space_time::fallback::escape::after_holding;
use crate::space_time::fallback::waiting::{Way, nearest_speed};
use crate::space_time::land;
use crate::space_time::manoeuvre::motion::{pose_at, until};
use crate::space_time::piece::pieces;
use crate::space_time::proxy::{first_contact, first_met, within_reach};
use crate::{Plan, PlanMethod, Problem};
use searoom_colregs::Encountered;
use searoom_geometry::frame::Side;
use searoom_model::trajectory::{Segment, Trajectory};

/// Places at which own ship slows down, as fractions of the distance to the first set on the route.
/// The farthest place comes first, because it costs the least time.
const PLACES: [f64; 5] = [0.9, 0.75, 0.5, 0.25, 0.0];

/// Largest number of speeds, own ship's greatest included.
const MOST_SPEEDS: usize = 3;

/// Turn of the sidestep, radians (30°): readily apparent. The time from the beginning of the role to
/// the turn, seconds.
const SIDESTEP_RAD: f64 = std::f64::consts::PI / 6.0;
const SIDESTEP_AFTER_S: f64 = 20.0;

/// Interval in seconds between two times at which the ships may have passed.
const STEP_S: f64 = 5.0;

/// The plan that breaks the fewest rules by `broken`, fewer than `most`; the first among equal ones.
///
/// Own ship continues at a lower speed until all encountered ships are past and clear. A plan without
/// duties follows. Every part is clear of the sets and of land. Cost: up to twenty plans.
pub(crate) fn let_pass(
    problem: &Problem,
    broken: &dyn Fn(&Trajectory) -> usize,
    most: usize,
) -> Option<Plan> {
    let clock = Clock::new(problem.deadline);
    let way = Way::of(problem, &problem.desired.straightened(), clock)?;
    let speed = nearest_speed(problem)?;
    let pieces = pieces(problem.obstacles, problem.horizon);
    let proxies = within_reach(problem, &pieces);
    let (_, contact) = first_contact(&proxies, &way.slowed_after(0.0, [speed, speed]))?;
    let afterwards = Problem {
        first_turn: None,
        encountered: &[],
        under_way: None,
        ..problem.clone()
    };
    let lower = problem.own.some_speeds(MOST_SPEEDS);
    let mut lower: Vec<f64> = lower.filter(|u| *u < speed).collect();
    lower.reverse();
    let (way, lower) = (&way, &lower);
    let slowed = PLACES.iter().flat_map(|place| {
        let slows = contact * place;
        let slowed = lower.iter().flat_map(move |then| {
            let on_the_route = way.slowed_after(slows * speed, [speed, *then]);
            let aside = sidestepped(problem, &on_the_route, slows, *then);
            std::iter::once(on_the_route).chain(aside)
        });
        slowed.map(move |motion| (slows, motion))
    });
    let (mut best, mut fewest) = (None, most);
    for (slows, motion) in slowed {
        if fewest == 0 || clock.is_up() {
            break;
        }
        let Some(time) = passed(problem, &motion, slows, speed) else {
            continue;
        };
        let held = until(&motion, time);
        if first_met(&proxies, &held).is_some() || land::meets(problem.land_obstacle, &held) {
            continue;
        }
        let left = Problem {
            deadline: clock.left(),
            ..afterwards.clone()
        };
        let Some(plan) = after_holding(&left, &held, time) else {
            continue;
        };
        let breaks = broken(&plan.trajectory);
        if breaks < fewest {
            fewest = breaks;
            best = Some(Plan {
                method: PlanMethod::Waiting,
                ..plan
            });
        }
    }
    best
}

/// The motion with a turn and back to the side that the rules ask for, where there is time for both
/// before it `slows`. It continues straight from there, at a lower speed once it has slowed.
fn sidestepped(
    problem: &Problem,
    motion: &[Segment],
    slows: f64,
    then: f64,
) -> Option<Vec<Segment>> {
    let asks = |e: &&Encountered| e.role.duties().first_turn_to.is_some();
    let first = problem.encountered.iter().find(asks)?;
    let side = first
        .role
        .duties()
        .first_turn_to
        .map_or(0.0, Side::turn_sign);
    let begins = first.risk_since.max(0.0) + SIDESTEP_AFTER_S;
    let mut motion = until(motion, begins);
    let speed = motion.last()?.speed;
    let mut append = |duration: f64, speed: f64, turn_rate: f64| {
        let last = motion.last()?;
        let (pose, time) = (last.end(), last.end_time());
        motion.push(Segment::new(pose, time, duration, speed, turn_rate));
        Some(time + duration)
    };
    let duration = SIDESTEP_RAD * problem.own.turning_radius / speed;
    let turn_rate = side * speed / problem.own.turning_radius;
    append(duration, speed, turn_rate)?;
    let parallel = append(duration, speed, -turn_rate)?;
    // negated on purpose: a NaN leaves no time
    if !(parallel < slows) {
        return None;
    }
    append(slows - parallel, speed, 0.0)?;
    append(problem.horizon - slows, then, 0.0)?;
    Some(motion)
}

/// First time from `from` on at which every encountered ship is clear of own ship, and stays clear
/// if own ship goes straight on at a speed; `None` without such a ship, and where one does not pass
/// in time.
fn passed(problem: &Problem, held: &[Segment], from: f64, speed: f64) -> Option<f64> {
    if problem.encountered.is_empty() {
        return None;
    }
    let end = held.last()?.end_time();
    let times = (0..).map(|step| from + STEP_S * f64::from(step));
    let mut times = times.take_while(|time| *time < end);
    times.find(|time| {
        pose_at(held, *time).is_some_and(|own| {
            let is_clear = |e: &Encountered| {
                let ship = e.ship.moved(*time);
                let offset = ship.pose.position - own.position;
                let relative = own.ahead() * speed - ship.velocity();
                let tcpa = offset.dot(&relative) / relative.norm_squared();
                let nearest = offset - relative * tcpa.max(0.0);
                let lengths = problem.thresholds.risk.release_lengths;
                let length = e.hull.length.max(problem.own.hull.length);
                let hulls = e.hull.half_diagonal() + problem.own.hull.half_diagonal();
                nearest.norm() >= lengths * length + hulls
            };
            problem.encountered.iter().all(is_clear)
        })
    })
}
