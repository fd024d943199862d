//! Stand-on policy (Rule 17): hold course and speed until the latest time at which a certified
//! escape exists.
//!
//! `E(t)` holds the nominal motion until `t`. Then it turns to starboard by 30° or more, or slows
//! down to half the speed or less, and returns to the route. The plan is the `E(t)` of the latest
//! `t` that is clear of every set until its arrival, by the exact contact test. So at every instant
//! before `t` own ship has an escape that is known to be clear, whatever the other ship does.

use crate::colregs::{APPARENT_TIME, APPARENT_TURN};
use crate::frame::{Side, heading_of, wrap};
use crate::planner::clock::Clock;
use crate::planner::space_time::chain::Chain;
use crate::planner::space_time::graph::departure::until;
use crate::planner::space_time::graph::return_to_line::motion_back;
use crate::planner::space_time::proxy::first_met;
use crate::planner::space_time::refinement::trial::Context;
use crate::planner::space_time::rules::compliance::{apparent_slow_speed, complies};
use crate::planner::space_time::settings::{ESCAPE_HOLDS_S, ESCAPE_RETURN_ANGLES};
use crate::planner::{Escape, NoPlan, Outcome, Plan, Planned, Problem};
use crate::tolerance::{self, TOUCH_M};
use crate::trajectory::Segment;

/// Turns of an escape, as multiples of the least readily apparent turn.
const TURNS: [f64; 6] = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0];

/// Sampled instants before the first contact, latest first, and bisection steps after that.
const SAMPLES: usize = 40;
const HALVINGS: usize = 7;

/// Sampled instants for an escape that need not be the latest.
const FEW_SAMPLES: usize = 10;

/// Motion that holds and then escapes.
#[derive(Debug, Clone)]
pub(crate) struct StandOnPlan {
    pub motion: Vec<Segment>,
    /// Cost, m².
    pub cost: f64,
    pub escape: Escape,
}

impl StandOnPlan {
    pub(crate) fn planned(self, problem: &Problem) -> Planned {
        let plan = Plan::measured(problem, self.motion, None);
        let outcome = plan.map_or(Outcome::Infeasible(NoPlan::NoRoute), Outcome::Solved);
        Planned {
            escape: Some(self.escape),
            ..Planned::of(outcome)
        }
    }
}

/// Motion that holds longest, where the nominal motion meets an obstacle after `contact` seconds.
/// `None` without any escape to starboard or by reduced speed, or after the deadline.
pub(crate) fn hold(
    context: &Context,
    nominal_motion: &[Segment],
    contact: f64,
    clock: Clock,
) -> Option<StandOnPlan> {
    if hurries(context.problem, nominal_motion) {
        return None;
    }
    let search = Escapes {
        context,
        nominal_motion,
        sides: &[Side::Starboard],
    };
    let step = contact / SAMPLES as f64;
    let scanned = (0..=SAMPLES).rev().map(|k| step * k as f64);
    let mut latest = scanned
        .take_while(|_| !clock.is_up())
        .find(|t| search.from(*t).next().is_some())?;
    let mut too_late = latest + step;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (latest + too_late);
        if clock.is_up() {
            break;
        }
        if search.from(middle).next().is_some() {
            latest = middle;
        } else {
            too_late = middle;
        }
    }
    search.from(latest).min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// True where own ship starts on the path and could keep the desired speed, but the nominal motion
/// does not, because the horizon requires an earlier arrival: that is no hold.
fn hurries(problem: &Problem, nominal_motion: &[Segment]) -> bool {
    let (own, leg) = (problem.own, &problem.desired.legs()[0]);
    let off = (own.pose.position - leg.start).norm();
    let turn = wrap(own.pose.heading - heading_of(leg.direction)).abs();
    let desired = |speed: f64| (speed - leg.speed).abs() <= tolerance::FIGURE * leg.speed;
    off <= tolerance::JOINT_M
        && turn <= tolerance::joint_rad(own.turning_radius)
        && own.speeds.iter().any(|speed| desired(*speed))
        && !nominal_motion.first().is_some_and(|s| desired(s.speed))
}

/// Cheapest such motion from a few instants on, to any side that complies with the rules. Used
/// where the graph and its refinement find none.
pub(crate) fn cheapest(
    context: &Context,
    nominal_motion: &[Segment],
    contact: f64,
    clock: Clock,
) -> Option<Vec<Segment>> {
    let search = Escapes {
        context,
        nominal_motion,
        sides: context.problem.duty().sides(),
    };
    let step = contact / FEW_SAMPLES as f64;
    let times = (0..=FEW_SAMPLES).map(|k| step * k as f64);
    let found = times
        .take_while(|_| !clock.is_up())
        .filter_map(|t| search.from(t).min_by(|a, b| a.cost.total_cmp(&b.cost)));
    let best = found.min_by(|a, b| a.cost.total_cmp(&b.cost));
    best.map(|held| held.motion)
}

/// Escapes from the nominal motion.
struct Escapes<'s, 'a> {
    context: &'s Context<'a>,
    nominal_motion: &'s [Segment],
    /// Permitted sides of the first turn.
    sides: &'static [Side],
}

/// Position and time at which own ship leaves the route.
struct Start {
    before: Vec<Segment>,
    time: f64,
}

impl<'s> Escapes<'s, '_> {
    fn problem(&self) -> &'s Problem<'s> {
        self.context.problem
    }

    /// Escapes from a time on that are clear until their arrival.
    fn from(&self, time: f64) -> impl Iterator<Item = StandOnPlan> + '_ {
        let start = std::rc::Rc::new(Start {
            before: until(self.nominal_motion, time),
            time,
        });
        let again = std::rc::Rc::clone(&start);
        let speeds = || self.problem().own.moving_speeds();
        let turning = TURNS
            .into_iter()
            .flat_map(move |turn| speeds().map(move |u| (turn * APPARENT_TURN, u)))
            .flat_map(move |turn| self.sides.iter().map(move |side| (*side, turn)))
            .flat_map(move |(side, (turn, speed))| self.by_turn(&start, side, turn, speed));
        let slower = speeds()
            .filter(|u| *u <= apparent_slow_speed(self.problem()))
            .flat_map(move |speed| self.by_speed(&again, speed));
        turning.chain(slower)
    }

    fn by_turn(&self, start: &Start, side: Side, turn: f64, speed: f64) -> Vec<StandOnPlan> {
        let problem = self.problem();
        let radius = problem.own.turning_radius;
        let pose = start.before.last().map_or(problem.own.pose, Segment::end);
        let mut out = Chain::new(pose, start.time, speed, radius);
        let turn = turn * side.turn_sign();
        out.arc(turn * radius);
        let mut found = Vec::new();
        let mut held = 0.0;
        for hold in ESCAPE_HOLDS_S {
            out.line(speed * (hold - held));
            held = hold;
            if !self.is_clear(&out.segments) {
                break;
            }
            found.extend(self.returns(start, &out, turn));
        }
        found
    }

    /// Returns onto the legs ahead, at the greatest speed.
    fn returns(&self, start: &Start, out: &Chain, turn: f64) -> Vec<StandOnPlan> {
        let (problem, route) = (self.problem(), self.context.route);
        let near = problem.desired.nearest(out.pose.position, out.time, 0.0);
        let legs = near.leg..problem.desired.legs().len().min(near.leg + 2);
        let returns = legs.flat_map(|leg| ESCAPE_RETURN_ANGLES.map(|angle| (leg, angle)));
        let held = returns.filter_map(|(leg, angle)| {
            let mut escape = out.segments.clone();
            escape.extend(motion_back(
                problem,
                route,
                (&out.pose, out.time),
                leg,
                angle,
            )?);
            let speed = out.segments.first().map_or(0.0, |s| s.speed);
            self.held(start, escape, turn, speed)
        });
        held.collect()
    }

    fn by_speed(&self, start: &Start, speed: f64) -> Vec<StandOnPlan> {
        let route = self.context.route;
        let along: f64 = start.before.iter().map(Segment::length).sum();
        let durations = ESCAPE_HOLDS_S.into_iter().filter(|s| *s >= APPARENT_TIME);
        let held = durations.filter_map(|duration| {
            let mut escape = Vec::new();
            let at = route.run(along, start.time, speed * duration, speed, &mut escape);
            let time = escape.last().map_or(start.time, Segment::end_time);
            escape.extend(route.follow(at, time));
            self.held(start, escape, 0.0, speed)
        });
        held.collect()
    }

    /// The complete motion, where it is clear, in time and complies with the rules.
    fn held(
        &self,
        start: &Start,
        escape: Vec<Segment>,
        turn: f64,
        speed: f64,
    ) -> Option<StandOnPlan> {
        let problem = self.problem();
        let in_time = escape
            .last()
            .is_some_and(|s| s.end_time() <= problem.horizon);
        if !(in_time && self.is_clear(&escape)) {
            return None;
        }
        let mut motion = start.before.clone();
        motion.extend(escape);
        if !complies(self.context, self.nominal_motion, &motion) {
            return None;
        }
        Some(StandOnPlan {
            cost: problem.error_of(&motion),
            escape: Escape {
                latest: start.time,
                turn,
                speed,
            },
            motion,
        })
    }

    fn is_clear(&self, motion: &[Segment]) -> bool {
        first_met(self.context.proxies, motion).is_none()
            && !motion
                .iter()
                .any(|s| self.context.problem.land_obstacle.meets(s, TOUCH_M))
    }
}
