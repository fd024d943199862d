//! Escape from the sets that own ship starts in, then a motion to the end of the path.
//!
//! ```text
//! turns x speeds ─► outside the sets? ─► least harm first ─► plan from there, else along the path
//! ```
//!
//! An exit is one turn and a straight line at one speed. The exit with the least [`Harm`] is taken.
//! Where every exit meets a nominal hull, or none exists, the sets of the nominal tracks are used
//! instead. Where such a motion still does more harm than one that stops, or slows down, on the
//! route, own ship does not go on to its end.

use std::cell::Cell;

use crate::clock::Clock;
use crate::space_time::fallback::harm::{Harm, NominalHulls, depth_step};
use crate::space_time::fallback::waiting::{Way, beside, nearest_speed, unfinished};
use crate::space_time::land;
use crate::space_time::manoeuvre::motion::{part, pose_at, shifted, until};
use crate::space_time::piece::pieces as parts_of;
use crate::space_time::proxy::{Proxy, within_reach};
use crate::space_time::route::Route;
use crate::space_time::{has_arrived, plan};
use crate::{NominalTarget, Outcome, Plan, PlanMethod, Planned, Problem};
use searoom_geometry::frame::{Pose, Side, Vector};
use searoom_geometry::numerics::bisected;
use searoom_geometry::tolerance::{self, TOUCH_M};
use searoom_model::trajectory::{DesiredTrajectory, Segment};
use searoom_model::vessel::OwnShip;
use searoom_sets::Obstacle;

/// Radians between two candidate turns, up to a half circle. Coarse turns are tried first, each
/// turn once.
const TURN_RAD: f64 = std::f64::consts::PI / 36.0;
const STEPS: [u32; 4] = [18, 9, 3, 1];
const TURNS: u32 = 36;

/// Largest number of candidate speeds: the least, the greatest and some between.
const MOST_SPEEDS: usize = 4;

/// Least interval in seconds between two samples of the exit test, and largest number of samples.
const SAMPLE_S: f64 = 1.0;
const MAX_SAMPLES: usize = 400;

/// Bisection steps for the exit time: to a microsecond.
const HALVINGS: usize = 20;

/// Seconds for which an exit from a set is held before the planner takes over. At the very edge of
/// a growing set every turn leads back into it.
const EXIT_HOLDS_S: [f64; 5] = [0.0, 10.0, 30.0, 60.0, 120.0];

/// Seconds for which a turn is held where own ship is in no set and there is no plan.
const EVASIVE_HOLDS_S: [f64; 3] = [30.0, 60.0, 120.0];

/// Exits from which plans are sought, least harm first, and as many of the soonest ones.
const MAX_EXITS: usize = 4;

/// Motions that are compared even after the deadline.
const MIN_COMPARED: usize = 12;

/// Motion from own ship's start to the last waypoint within the horizon that leaves the sets it
/// starts in.
///
/// The motion leaves the sets with the least harm by one turn at one speed. A plan that is clear of
/// every set follows. Where none is found, the path follows at one speed, or a path beside it. Where
/// all this meets a nominal hull, or own ship is in no set, it may also slow down or stop on its
/// route until the horizon. `None` where the sailable path is too long for the horizon or leads onto
/// land. The caller determines from when on the motion is clear of which sets.
///
/// Cost: some milliseconds and up to forty plans. A few motions are compared even after the
/// deadline.
pub(crate) fn escape(problem: &Problem, nominal: &[NominalTarget]) -> Option<Planned> {
    let clock = Clock::new(problem.deadline);
    if has_arrived(problem) {
        return Some(Planned::of(Outcome::Solved(Plan::staying(problem)?)));
    }
    let pieces = parts_of(problem.obstacles, problem.horizon);
    let proxies = within_reach(problem, &pieces);
    let mut near: Vec<usize> = proxies.iter().map(|h| h.obstacle).collect();
    near.dedup();
    let targets = near.iter().map(|index| &nominal[*index]);
    let (hulls, own): (Vec<_>, Vec<_>) = targets.clone().map(|t| (t.hull.clone(), t.own)).unzip();
    let sets: Vec<Obstacle> = targets.map(|t| t.set.clone()).collect();
    let hulls = parts_of(&hulls, problem.horizon);
    let nominal_hulls = NominalHulls::new(&hulls, &own, clock);
    let nominal = Problem {
        obstacles: &sets,
        ..problem.clone()
    };
    let mut leaving = (problem, exits(problem, &proxies, &nominal_hulls, clock));
    if !leaving.1.first().is_some_and(|exit| exit.harm.is_clear()) {
        let pieces = parts_of(&sets, problem.horizon);
        let exits = exits(
            &nominal,
            &pieces.iter().map(Proxy::new).collect::<Vec<_>>(),
            &nominal_hulls,
            clock,
        );
        if leaving.1.is_empty() || exits.first().is_some_and(|exit| exit.harm.is_clear()) {
            leaving = (&nominal, exits);
        }
    }
    let (leaving, mut exits) = leaving;
    let last_resort = LastResort {
        problem,
        proxies: &proxies,
        nominal_hulls: &nominal_hulls,
        clock,
    };
    match exits.first().map(|exit| exit.harm) {
        // a plan that follows is not worth a hull
        Some(harm) if harm.is_clear() => exits.retain(|exit| exit.harm.is_clear()),
        Some(harm) => {
            if let Some(slowed) = last_resort.slowed(harm) {
                let plan = unfinished(problem, slowed, PlanMethod::LeastHarm)?;
                return Some(Planned::of(Outcome::Solved(plan)));
            }
        }
        None => {}
    }
    let mut exit_motions = exit_motions(&exits);
    let measured = |motion| Plan::measured(problem, motion, PlanMethod::LeastHarm);
    for beginning in &exit_motions {
        if clock.is_up() {
            break;
        }
        let stats = Cell::new(None);
        let motion = append(leaving, beginning, |rest| {
            let planned = planned(rest, clock);
            stats.set(planned.stats);
            Some(planned.outcome.plan()?.trajectory.segments().to_vec())
        });
        if let Some(plan) = motion.and_then(measured) {
            return Some(Planned {
                stats: stats.get(),
                ..Planned::of(Outcome::Solved(plan))
            });
        }
    }
    if !exits.is_empty() {
        // used where every exit is too long for the horizon
        exit_motions.push(Vec::new());
    }
    let motion = last_resort.motion(&exit_motions, exits.is_empty())?;
    let plan = unfinished(problem, motion, PlanMethod::LeastHarm)?;
    Some(Planned::of(Outcome::Solved(plan)))
}

/// Motions that are compared by their harm where no plan follows.
struct LastResort<'a> {
    problem: &'a Problem<'a>,
    proxies: &'a [Proxy<'a>],
    nominal_hulls: &'a NominalHulls<'a>,
    clock: Clock,
}

impl LastResort<'_> {
    /// The motion with the least harm of those that go on from the beginnings along the path, or
    /// straight to its end, and of those that slow down. Of motions with the same harm the first.
    ///
    /// Where own ship `is_outside`, paths beside the desired one are tried as well, and turns where
    /// all of them meet a nominal hull. Else the first motion that meets none is taken.
    fn motion(&self, beginnings: &[Vec<Segment>], is_outside: bool) -> Option<Vec<Segment>> {
        let (clock, own) = (self.clock, self.problem.own);
        let alone = &Problem {
            obstacles: &[],
            ..self.problem.clone()
        };
        let continued = |beginning: &Vec<Segment>| {
            [false, true]
                .map(|straight| append(alone, beginning, |rest| path_motion(rest, straight, clock)))
        };
        let mut best = None;
        let on = beginnings.iter().flat_map(continued).flatten();
        self.improve(&mut best, on, !is_outside);
        if is_outside {
            let aside = beside(self.problem, clock).filter_map(|desired| {
                let along = Problem {
                    desired: &desired,
                    ..alone.clone()
                };
                path_motion(&along, false, clock)
            });
            self.improve(&mut best, aside, false);
            let turns = evasive_turns(own, self.problem.horizon);
            self.improve(&mut best, turns.iter().flat_map(continued).flatten(), true);
        }
        let (harm, motion) = best?;
        match is_outside || !harm.is_clear() {
            true => self.slowed(harm).or(Some(motion)),
            false => Some(motion),
        }
    }

    /// Replaces the best motion by each that does less harm; the first that meets no hull is the
    /// last where that `is_enough`.
    fn improve(
        &self,
        best: &mut Option<(Harm, Vec<Segment>)>,
        motions: impl Iterator<Item = Vec<Segment>>,
        is_enough: bool,
    ) {
        let is_over = |best: &Option<(Harm, Vec<Segment>)>| {
            is_enough && best.as_ref().is_some_and(|(harm, _)| harm.is_clear())
        };
        if is_over(best) {
            return;
        }
        for (compared, motion) in motions.enumerate() {
            let harm = self.harm(&motion);
            let is_less = |least: &Harm| harm.depth_cmp(least).is_lt();
            if best.as_ref().is_none_or(|(least, _)| is_less(least)) {
                *best = Some((harm, motion));
            }
            if is_over(best) || self.clock.is_up() && compared + 1 >= MIN_COMPARED {
                break;
            }
        }
    }

    /// The motion with the least harm that slows down or stops on the route, if that is less than
    /// `most`. Once the time is up, only the one that slows at once is compared.
    fn slowed(&self, most: Harm) -> Option<Vec<Segment>> {
        let way = Way::of(self.problem, self.problem.desired, self.clock)?;
        let (mut least, mut best) = (most, None);
        for motion in way.slowing() {
            let harm = self.harm(&motion);
            if harm.depth_cmp(&least).is_lt() {
                (least, best) = (harm, Some(motion));
            }
            if self.clock.is_up() {
                break;
            }
        }
        best
    }

    /// Harm of a whole motion.
    fn harm(&self, motion: &[Segment]) -> Harm {
        let depth = |pose: &Pose, time: f64| {
            let slacks = self.proxies.iter();
            let slacks = slacks.filter_map(|h| h.slack(pose.position, time));
            0.0 - slacks.fold(0.0, f64::min)
        };
        let end = motion.last().map_or(0.0, Segment::end_time);
        Harm::of(self.problem.own, self.nominal_hulls, motion, end, depth)
    }
}

/// Motion along the path, or straight to its end, at one speed: the speed nearest to the desired
/// one, or the greatest where the horizon requires it. `None` where it meets land.
fn path_motion(problem: &Problem, straight: bool, clock: Clock) -> Option<Vec<Segment>> {
    let (own, desired) = (problem.own, problem.desired);
    let nearest = nearest_speed(problem)?;
    let direct = [own.pose.position, desired.end()];
    let direct = DesiredTrajectory::new(&direct, &[nearest]).ok();
    let desired = if straight { direct.as_ref()? } else { desired };
    let route = Route::new(
        &Problem {
            desired,
            ..problem.clone()
        },
        clock,
    )?;
    let arrives = |speed: f64| {
        let mut motion = Vec::new();
        route.run(0.0, 0.0, route.length(), speed, &mut motion);
        (motion.last()?.end_time() <= problem.horizon).then_some(motion)
    };
    let motion = arrives(nearest).or_else(|| arrives(own.max_speed()))?;
    (!land::meets(problem.land_obstacle, &motion)).then_some(motion)
}

/// Motion along the path that ignores other ships; `None` where it does not arrive within the
/// horizon.
pub fn nominal_motion(problem: &Problem) -> Option<Vec<Segment>> {
    let route = Route::new(problem, Clock::new(problem.deadline))?;
    let motion = route.follow(0.0, 0.0);
    let arrival = motion.last()?.end_time();
    (arrival <= problem.horizon).then_some(motion)
}

/// Plan that holds a motion until a time and is clear of every set from then on.
pub fn after_holding(problem: &Problem, motion: &[Segment], time: f64) -> Option<Plan> {
    let clock = Clock::new(problem.deadline);
    let method = Cell::new(PlanMethod::Stay);
    let motion = append(problem, &until(motion, time), |rest| {
        let plan = planned(rest, clock).outcome.into_plan()?;
        method.set(plan.method);
        Some(plan.trajectory.segments().to_vec())
    })?;
    Plan::measured(problem, motion, method.get())
}

/// Runs the planner in the remaining time.
fn planned(problem: &Problem, clock: Clock) -> Planned {
    plan(&Problem {
        deadline: clock.left(),
        ..problem.clone()
    })
}

/// Motion that is outside the sets from a time on, for as long as it is held.
#[derive(Clone)]
struct Exit {
    motion: Vec<Segment>,
    out: f64,
    /// When it meets another set, seconds; infinite if it meets none.
    clear_until: f64,
    harm: Harm,
}

/// Exits from the sets that own ship starts in, least harm first. After the deadline only coarse
/// turns are tried.
fn exits(
    problem: &Problem,
    proxies: &[Proxy],
    nominal_hulls: &NominalHulls,
    clock: Clock,
) -> Vec<Exit> {
    let own = problem.own;
    let inside = |h: &&Proxy| {
        h.slack(own.pose.position, 0.0)
            // negated on purpose: a NaN is inside
            .is_some_and(|slack| !(slack >= -TOUCH_M))
    };
    let held: Vec<usize> = proxies.iter().filter(inside).map(|h| h.obstacle).collect();
    if held.is_empty() {
        return Vec::new();
    }
    let (held, others): (Vec<&Proxy>, Vec<&Proxy>) =
        proxies.iter().partition(|h| held.contains(&h.obstacle));
    let depth = |pose: &Pose, time: f64| {
        let slacks = held.iter().filter_map(|h| h.slack(pose.position, time));
        -slacks.fold(f64::INFINITY, f64::min)
    };
    let fastest = held.iter().map(|h| h.speed()).fold(0.0, f64::max);
    let met = |any: &[&Proxy], motion: &[Segment]| {
        let pairs = any.iter().flat_map(|h| motion.iter().map(move |s| (h, s)));
        let times = pairs.filter_map(|(h, s)| h.first_contact(s));
        times.fold(f64::INFINITY, f64::min)
    };
    let mut exits = Vec::new();
    for (turn, is_coarse) in turns() {
        for speed in own.some_speeds(MOST_SPEEDS) {
            if clock.is_up() && !is_coarse || speed == 0.0 && turn != 0.0 {
                continue;
            }
            let motion = turned(own, speed, turn, problem.horizon);
            let Some(out) = exit_time(&motion, problem.horizon, speed + fastest, depth) else {
                continue;
            };
            let clear_until = met(&others, &motion);
            // own ship may enter a growing set again: then it has not left for good
            if clear_until <= out
                || met(&held, &part(&motion, out, f64::INFINITY)).is_finite()
                || land::meets(problem.land_obstacle, &until(&motion, out))
            {
                continue;
            }
            exits.push(Exit {
                harm: Harm::of(own, nominal_hulls, &motion, out, depth),
                motion,
                out,
                clear_until,
            });
        }
    }
    candidates(own, nominal_hulls, exits)
}

/// Exits from which plans are sought: the [`MAX_EXITS`] with the least harm, then the soonest, as
/// there may be a plan from these alone. A slower exit counts as about as soon as the soonest only
/// where it comes hardly nearer to a nominal hull.
fn candidates(own: &OwnShip, nominal_hulls: &NominalHulls, mut exits: Vec<Exit>) -> Vec<Exit> {
    exits.sort_by(|a, b| a.harm.depth_cmp(&b.harm).then(a.out.total_cmp(&b.out)));
    let Some(first) = exits.first() else {
        return exits;
    };
    let soonest = first.out;
    let nearest = nominal_hulls.nearest(own, &first.motion, soonest, f64::INFINITY);
    let nearest = nearest.apart - depth_step(own);
    let soonest_exits: Vec<Exit> = exits.iter().take(MAX_EXITS).cloned().collect();
    for exit in &mut exits {
        exit.harm = exit.harm.with_delay(own, exit.out, soonest);
    }
    exits.sort_by(|a, b| a.harm.total_cmp(&b.harm));
    let keeps_off = |exit: &Exit| {
        !exit.harm.is_soon()
            || nominal_hulls
                .nearest(own, &exit.motion, exit.out, nearest)
                .apart
                >= nearest
    };
    let least_harm = exits.into_iter().filter(keeps_off).take(MAX_EXITS);
    let mut found: Vec<Exit> = least_harm.collect();
    for exit in soonest_exits {
        if found.iter().all(|other| other.motion != exit.motion) {
            found.push(exit);
        }
    }
    found
}

/// Candidate turns, radians, to port positive, each once, and whether it is one of the coarsest.
/// Starboard comes first among equal turns.
fn turns() -> impl Iterator<Item = (f64, bool)> {
    let levels = STEPS.iter().enumerate().flat_map(|(level, by)| {
        let is_new = move |k: &u32| {
            !STEPS[..level]
                .iter()
                .any(|coarser| k.is_multiple_of(*coarser))
        };
        (0..=TURNS)
            .step_by(*by as usize)
            .filter(is_new)
            .map(move |k| (k, level == 0))
    });
    levels.flat_map(|(k, is_coarse)| {
        let sides = [Side::Starboard, Side::Port].into_iter();
        sides
            .take(if k == 0 { 1 } else { 2 })
            .map(move |side| (side.turn_sign() * TURN_RAD * f64::from(k), is_coarse))
    })
}

/// Initial motions: every exit held for a while, those first that meet no other set meanwhile; none
/// where own ship is in no set.
fn exit_motions(exits: &[Exit]) -> Vec<Vec<Segment>> {
    if exits.is_empty() {
        return vec![Vec::new()];
    }
    let held = exits
        .iter()
        .flat_map(|exit| EXIT_HOLDS_S.map(|hold| (exit, exit.out + hold)));
    let (clear, others): (Vec<_>, Vec<_>) = held.partition(|(exit, end)| *end <= exit.clear_until);
    let motions = clear.into_iter().chain(others);
    motions
        .map(|(exit, end)| until(&exit.motion, end))
        .collect()
}

/// Turns to either side at a low and at the greatest speed, held for a while.
fn evasive_turns(own: &OwnShip, horizon: f64) -> Vec<Vec<Segment>> {
    let low = own.speeds.iter().copied().find(|u| *u > 0.0);
    let mut evasive_turns = Vec::new();
    for hold in EVASIVE_HOLDS_S {
        for turn in [-6.0, 6.0, -12.0, 12.0, -18.0, 18.0].map(|steps| steps * TURN_RAD) {
            for speed in low.into_iter().chain([own.max_speed()]) {
                evasive_turns.push(until(&turned(own, speed, turn, horizon), hold));
            }
        }
    }
    evasive_turns
}

/// Arc and line until the horizon; a wait where the speed is zero.
fn turned(own: &OwnShip, speed: f64, turn: f64, horizon: f64) -> Vec<Segment> {
    let line = |start, start_time: f64| {
        Segment::straight(start, start_time, (horizon - start_time).max(0.0), speed)
    };
    if turn == 0.0 || speed == 0.0 {
        return vec![line(own.pose, 0.0)];
    }
    let arc = Segment {
        duration: turn.abs() * own.turning_radius / speed,
        turn_rate: turn.signum() * speed / own.turning_radius,
        ..line(own.pose, 0.0)
    };
    vec![arc, line(arc.end(), arc.end_time())]
}

/// First instant from which a motion stays clear. `depth` is own ship's depth inside, metres; it
/// changes by at most `rate` metres per second.
fn exit_time(
    motion: &[Segment],
    horizon: f64,
    rate: f64,
    depth: impl Fn(&Pose, f64) -> f64,
) -> Option<f64> {
    // negated on purpose: a NaN is inside
    let is_in = |deep: f64| !(deep <= TOUCH_M);
    let depth = |time: f64| pose_at(motion, time).map_or(f64::NAN, |pose| depth(&pose, time));
    let (mut inside, mut deep) = (0.0, depth(0.0));
    let mut found = None;
    for _ in 0..MAX_SAMPLES {
        // not outside before
        let time: f64 = inside + (deep / rate).max(SAMPLE_S);
        if !(time <= horizon) {
            return None;
        }
        deep = depth(time);
        if !is_in(deep) {
            found = Some(time);
            break;
        }
        inside = time;
    }
    let [_, outside] = bisected([inside, found?], HALVINGS, |time| is_in(depth(time)));
    Some(outside)
}

fn is_at_end(desired: &DesiredTrajectory, place: Vector) -> bool {
    (desired.end() - place).norm() <= tolerance::ARRIVAL_M
}

/// Appends to a motion another one, whose clock starts at the first one's end.
fn append(
    problem: &Problem,
    beginning: &[Segment],
    follow: impl Fn(&Problem) -> Option<Vec<Segment>>,
) -> Option<Vec<Segment>> {
    if land::meets(problem.land_obstacle, beginning) {
        return None;
    }
    let start = beginning.last().map_or(0.0, Segment::end_time);
    let own = OwnShip {
        pose: beginning.last().map_or(problem.own.pose, Segment::end),
        ..problem.own.clone()
    };
    let here = own.pose.position;
    let mut desired = problem.desired.remaining(start);
    // where a round trip has begun in time alone, it is still to be sailed
    if problem.desired.comes_by(here) && !desired.comes_by(here) && is_at_end(&desired, here) {
        desired = problem.desired.clone();
    }
    let later: Vec<Obstacle> = (problem.obstacles.iter())
        .map(|set| set.remainder(start))
        .collect();
    let rest = Problem {
        own: &own,
        desired: &desired,
        obstacles: &later,
        horizon: problem.horizon - start,
        ..problem.clone()
    };
    let mut motion = beginning.to_vec();
    motion.extend(shifted(&follow(&rest)?, start));
    Some(motion)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship_fixtures::own_ship;

    #[test]
    fn every_turn_is_tried_once_and_few_after_the_deadline() {
        let mut all: Vec<(f64, bool)> = turns().collect();
        assert_eq!(all.len(), 73);
        assert_eq!(all.iter().filter(|(_, is_coarse)| *is_coarse).count(), 5);
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        for pair in all.windows(2) {
            assert!((pair[1].0 - pair[0].0 - TURN_RAD).abs() < 1e-9);
        }
        let many: Vec<f64> = (0..20).map(|k| 0.3 * f64::from(k)).collect();
        let tried: Vec<f64> = own_ship(&many).some_speeds(MOST_SPEEDS).collect();
        assert_eq!(tried.len(), MOST_SPEEDS);
        assert_eq!((tried[0], tried[MOST_SPEEDS - 1]), (many[0], many[19]));
        assert!(own_ship(&[5.0]).some_speeds(MOST_SPEEDS).eq([5.0]));
    }

    /// A horizon of a day in a set that grows faster than own ship sails costs as many samples as
    /// an hour.
    #[test]
    fn a_set_that_is_never_left_costs_few_samples() {
        let own = own_ship(&[5.0]);
        let (growing, samples) = (8.0, Cell::new(0));
        let depth = |pose: &Pose, time: f64| {
            samples.set(samples.get() + 1);
            60.0 + growing * time - pose.position.norm()
        };
        let motion = turned(&own, 5.0, 0.0, 86_400.0);
        assert_eq!(exit_time(&motion, 86_400.0, 5.0 + growing, depth), None);
        assert!(samples.get() < 100, "{}", samples.get());
        // a set that grows more slowly is left when own ship reaches its edge
        let depth = |pose: &Pose, time: f64| 60.0 + 3.0 * time - pose.position.norm();
        let out = exit_time(&motion, 86_400.0, 8.0, depth).expect("out");
        assert!((out - 30.0).abs() < 1e-3, "{out}");
    }
}
