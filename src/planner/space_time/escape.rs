//! Out of the sets that own ship starts in, as soon as may be, then on to the end of the path.
//!
//! A turn to either side and a straight line, at each speed: of these the one that is out of all sets at the earliest, for good,
//! and meets no other meanwhile. From there on the planner is asked anew.

use super::hazard::{Hazard, TOUCH_M, within_reach};
use super::part::parts;
use super::route::Route;
use crate::frame::{Pose, Side};
use crate::obstacle::Obstacle;
use crate::planner::clock::Clock;
use crate::planner::{Plan, Problem};
use crate::trajectory::Segment;
use crate::vessel::OwnShip;

/// Radians between two turns that are tried, and how many to either side: to half a circle.
const TURN_RAD: f64 = std::f64::consts::PI / 36.0;
const TURNS: u32 = 36;

/// Seconds between two looks at whether she is out.
const LOOK_S: f64 = 1.0;

/// Halvings of that within which the instant is found: to a microsecond.
const HALVINGS: usize = 20;

/// Ways out from which plans are sought, soonest first.
const MOST_WAYS: usize = 4;

/// Seconds for which a way out is held before the planner takes over: at the very edge of a growing set every turn leads
/// back into it.
const HOLDS_S: [f64; 5] = [0.0, 10.0, 30.0, 60.0, 120.0];

/// A motion from own ship's start to the last waypoint before the horizon that leaves the sets that she starts in at the
/// earliest, as far as turns in steps of five degrees go, and is clear of every set from then on. Where no such plan is found, one
/// that leaves them so and then follows the path, or that follows the path at once. `None` where the path itself, as own ship can sail it, is
/// too long for the horizon or leads ashore. The caller finds out from when on it is clear of what. Some milliseconds, and up to twenty plans.
pub fn escape(problem: &Problem) -> Option<Plan> {
    let clock = Clock::new(problem.deadline);
    let parts = parts(problem.obstacles, problem.horizon);
    let hazards = within_reach(problem, &parts);
    let ways = ways_out(problem, &hazards, clock);
    for way in ways.iter().take(MOST_WAYS) {
        for hold in HOLDS_S {
            if clock.is_up() {
                break;
            }
            let away = cut(&way.motion, way.out + hold);
            let found = onward(problem, &away, planned);
            if found.is_some() {
                return found;
            }
        }
    }
    let away = ways.first().map(|way| cut(&way.motion, way.out));
    let out = away.and_then(|away| onward(problem, &away, afloat));
    out.or_else(|| onward(problem, &[], afloat))
}

/// Along the path, where that is clear of land.
fn afloat(problem: &Problem) -> Option<Vec<Segment>> {
    let motion = undisturbed(problem)?;
    (!super::ashore::meets(problem.coast, &motion)).then_some(motion)
}

/// The motion along the path as if nobody else were there; `None` where it is not at the end before the horizon.
pub fn undisturbed(problem: &Problem) -> Option<Vec<Segment>> {
    let route = Route::new(problem)?;
    let mut motion = Vec::new();
    route.follow(0.0, 0.0, &mut motion);
    let arrival = motion.last()?.end_time();
    (arrival <= problem.horizon).then_some(motion)
}

/// A plan that holds a motion until a time, and is clear of every set from then on.
pub fn after_holding(problem: &Problem, motion: &[Segment], until: f64) -> Option<Plan> {
    onward(problem, &cut(motion, until), planned)
}

/// Asks the planner.
fn planned(problem: &Problem) -> Option<Vec<Segment>> {
    let planned = super::plan(problem);
    let plan = planned.outcome.plan()?;
    Some(plan.trajectory.segments().to_vec())
}

/// A motion that is out of the sets at a time, for as long as it is held.
struct WayOut {
    motion: Vec<Segment>,
    out: f64,
    turn: f64,
}

/// Every way out, or one when the clock is up, the soonest first; of equal ones the least turn, and to starboard.
fn ways_out(problem: &Problem, hazards: &[Hazard], clock: Clock) -> Vec<WayOut> {
    let own = problem.own;
    let inside = |h: &&Hazard| {
        h.slack(own.pose.position, 0.0)
            // negated on purpose: a NaN is inside
            .is_some_and(|slack| !(slack >= -TOUCH_M))
    };
    let held: Vec<usize> = hazards.iter().filter(inside).map(|h| h.obstacle).collect();
    if held.is_empty() {
        return Vec::new();
    }
    let is_held = |h: &Hazard| held.contains(&h.obstacle);
    let clear_at = |pose: &Pose, time: f64| {
        let mut here = hazards.iter().filter(|h| is_held(h));
        here.all(|h| {
            h.slack(pose.position, time)
                .is_none_or(|slack| slack >= -TOUCH_M)
        })
    };
    let mut ways = Vec::new();
    // the greatest speed first: it is out soonest as a rule
    for speed in own.speeds.iter().rev().copied().filter(|u| *u > 0.0) {
        for step in 0..=TURNS {
            for side in [Side::Starboard, Side::Port] {
                // out of time: the first way out is the one
                if step == 0 && side == Side::Port || clock.is_up() && !ways.is_empty() {
                    continue;
                }
                let turn = side.turn_sign() * TURN_RAD * f64::from(step);
                let motion = turned(own, speed, turn, problem.horizon);
                let Some(out) = out_at(&motion, problem.horizon, clear_at) else {
                    continue;
                };
                let before = cut(&motion, out);
                let met = hazards
                    .iter()
                    .filter(|h| !is_held(h))
                    .any(|h| before.iter().any(|s| h.first_contact(s).is_some()));
                if met || before.iter().any(|s| problem.coast.meets(s, TOUCH_M)) {
                    continue;
                }
                // she may come back into one that grows: then she is not out for good
                let after = after(&motion, out);
                let held: Vec<&Hazard> = hazards.iter().filter(|h| is_held(h)).collect();
                let again = after
                    .iter()
                    .any(|s| held.iter().any(|h| h.first_contact(s).is_some()));
                if !again {
                    ways.push(WayOut { motion, out, turn });
                }
            }
        }
    }
    ways.sort_by(|a, b| {
        a.out
            .total_cmp(&b.out)
            .then(a.turn.abs().total_cmp(&b.turn.abs()))
    });
    ways
}

/// An arc and a line until the horizon.
fn turned(own: &OwnShip, speed: f64, turn: f64, horizon: f64) -> Vec<Segment> {
    let arc = Segment {
        start: own.pose,
        start_time: 0.0,
        duration: turn.abs() * own.turning_radius / speed,
        speed,
        turn_rate: turn.signum() * speed / own.turning_radius,
    };
    let line = Segment {
        start: arc.end(),
        start_time: arc.end_time(),
        duration: (horizon - arc.end_time()).max(0.0),
        speed,
        turn_rate: 0.0,
    };
    if turn == 0.0 {
        vec![line]
    } else {
        vec![arc, line]
    }
}

/// The first instant from which a motion is clear.
fn out_at(motion: &[Segment], horizon: f64, clear_at: impl Fn(&Pose, f64) -> bool) -> Option<f64> {
    let at = |time: f64| {
        let segment = motion.iter().find(|s| time <= s.end_time());
        segment.or(motion.last()).map(|s| s.pose_at(time))
    };
    let clear = |time: f64| at(time).is_some_and(|pose| clear_at(&pose, time));
    let mut inside = 0.0;
    loop {
        let time = inside + LOOK_S;
        if time > horizon {
            return None;
        }
        if clear(time) {
            break;
        }
        inside = time;
    }
    let (mut low, mut high) = (inside, inside + LOOK_S);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if clear(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(high)
}

/// Until a time.
fn cut(motion: &[Segment], until: f64) -> Vec<Segment> {
    let sailed = motion.iter().filter(|s| s.start_time < until);
    sailed.map(|s| s.between(s.start_time, until)).collect()
}

/// From a time on.
fn after(motion: &[Segment], from: f64) -> Vec<Segment> {
    let later = motion.iter().filter(|s| s.end_time() > from);
    later.map(|s| s.between(from, s.end_time())).collect()
}

/// A motion, and what follows from its end on by a clock that starts there.
fn onward(
    problem: &Problem,
    away: &[Segment],
    follow: impl Fn(&Problem) -> Option<Vec<Segment>>,
) -> Option<Plan> {
    let begun = away.last().map_or(0.0, Segment::end_time);
    let own = OwnShip {
        pose: away.last().map_or(problem.own.pose, Segment::end),
        ..problem.own.clone()
    };
    let desired = problem.desired.remaining(begun);
    let later: Vec<Obstacle> = (problem.obstacles.iter())
        .map(|set| set.remainder(begun))
        .collect();
    let rest = Problem {
        own: &own,
        desired: &desired,
        obstacles: &later,
        horizon: problem.horizon - begun,
        ..problem.clone()
    };
    let mut motion = away.to_vec();
    motion.extend(follow(&rest)?.into_iter().map(|s| Segment {
        start_time: s.start_time + begun,
        ..s
    }));
    Plan::measured(problem, motion, None)
}
