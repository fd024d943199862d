//! Replanning: what a plan leaves to the next one. Own ship's motion so far, the targets' tracks and
//! sets, roles, and the plan that own ship follows.

use crate::colregs::compliance::{ComplianceReport, OwnSamples, roles};
use crate::colregs::{Risk, Situation, SteadyShip, TargetMemory, Thresholds};
use crate::document::{MemoryDocument, PlanDocument, SegmentDocument, planned_manoeuvre};
use crate::frame::{Pose, deg_from_radians, radians_from_deg, wrap};
use crate::planner::{Escape, PlannedManoeuvre, UnderWay};
use crate::scenario::{Fault, Memory, Scenario};
use crate::target::{Motion, ShipTrack, Uncertainty};
use crate::text::rounded;
use crate::tolerance::{self, SIGMAS};
use crate::trajectory::{Segment, before_stay};
use crate::vessel::OwnShip;

/// Own ship may be this far from where the previous plan has it: own lengths, and degrees. Farther
/// off, the manoeuvre under way is not the one that own ship carries out.
const OFF_PLAN_LENGTHS: f64 = 1.0;
const OFF_PLAN_DEG: f64 = 20.0;

/// Degrees. A target whose course has changed by more may give own ship another role: a smaller
/// alteration is not seen as one, [`crate::colregs::SMALL_TURN`].
const NEW_COURSE_DEG: f64 = 20.0;

/// Metres per second, and metres: rounding of a target's state in a file.
const ASSUMED: f64 = 1e-6;

/// A target may have been faster than assumed by this factor, and still be the same ship.
const FASTEST: f64 = 1.5;

/// Where the velocities of all plans have more vertices, those of the last plan alone are used.
const MOST_VERTICES: usize = 40;

/// Seconds of motion that are kept before the first role: two samples, which begin a role.
const BEFORE_S: f64 = 2.0;

/// Adds to a scenario what a plan of an earlier time leaves to it.
///
/// Roles last until the target is past and clear; a role that has begun since is found on the
/// motion so far. A target whose course has changed by more than 20 degrees gives own ship the role
/// of the present where that is a risk, but an overtaking ship stays one (Rule 13(d)). A target
/// that does not turn keeps to the places and velocities of both plans; one that has left them is
/// named, and its set begins anew. Own ship within its tracking margin of the plan is put on it:
/// the next plan goes on from there. The fault says why the plan is not one that own ship follows.
/// O(seconds sailed × targets).
pub fn remember(previous: &PlanDocument, scenario: &mut Scenario) -> Result<(), Fault> {
    let elapsed = scenario.time - previous.time_s;
    let plan = remaining_plan(previous, scenario, elapsed)?;
    let own = &mut scenario.own_ship;
    let off = (plan.now.position - own.pose.position).norm();
    let turned = wrap(plan.now.heading - own.pose.heading).abs();
    let is_on = off <= tolerance::JOINT_M && turned <= tolerance::joint_rad(own.turning_radius);
    let is_near = own.tracking_margin > 0.0 && off <= own.tracking_margin;
    if is_on || is_near {
        own.pose = plan.now;
    }
    // own ship has altered for a ship: that is a risk until own ship is on its route again
    let has_altered = manoeuvres(previous, elapsed).iter().any(has_begun);
    for target in &mut scenario.targets {
        if let (Motion::Ship(ship), true) = (&mut target.motion, has_altered) {
            let then = ship_then(previous, &target.name);
            ship.risk_distance = then.map_or(0.0, |then| then.risk_distance);
        }
    }
    let mut memory = memory_after(previous, scenario, plan)?;
    if scenario.stay.is_some() {
        // a stay is planned anew, because more is known of who comes
        let to_stay = before_stay(&scenario.desired, &memory.remainder).len();
        memory.remainder.truncate(to_stay);
    }
    if !is_on {
        memory.off_plan = off;
    }
    for target in &mut scenario.targets {
        let then = ship_then(previous, &target.name);
        if let (Motion::Ship(ship), Some(then)) = (&mut target.motion, then)
            && then.turn_rate == 0.0
            && ship.turn_rate == 0.0
            && then.route.is_empty()
            && ship.route.is_empty()
            && !memory.is_outside(&target.name)
        {
            keep_sets(ship, then, elapsed);
        }
    }
    scenario.memory = memory;
    Ok(())
}

/// Restricts a ship to the places and the velocities that the previous plan assumed.
fn keep_sets(ship: &mut ShipTrack, then: ShipTrack, elapsed: f64) {
    let velocities = then.outer_velocity_set();
    let moved = then.outer_positions();
    let moved = moved.minkowski_sum(&velocities.scaled(elapsed));
    let moved = moved.translated(then.pose.position - ship.pose.position);
    let measured = ship.outer_positions();
    let both = measured.outer_intersection(&moved);
    ship.kept_positions =
        both.filter(|both| *both != measured && both.vertices().len() <= MOST_VERTICES);
    // a wider spread, or a turn to another side, says that the ship may do more; a less accurate
    // measurement does not
    let beside = match ship.starboard_turn == then.starboard_turn {
        true => 0.0,
        false => wrap(ship.middle_course() - then.middle_course()).abs(),
    };
    if ship.kept_velocities.is_none()
        && ship.speed_spread <= then.speed_spread * (1.0 + ASSUMED)
        && ship.course_freedom() + beside <= then.course_freedom() * (1.0 + ASSUMED)
    {
        ship.kept_velocities = Some(match velocities.vertices().len() <= MOST_VERTICES {
            true => velocities,
            false => ShipTrack {
                kept_velocities: None,
                ..then
            }
            .outer_velocity_set(),
        });
    }
}

/// Remainder of the previous plan at the scenario's time.
struct RemainingPlan {
    /// The whole plan. Its times count from the previous plan.
    planned: Vec<Segment>,
    /// The remainder. Its times count from the scenario.
    remainder: Vec<Segment>,
    /// Where it has own ship.
    now: Pose,
}

fn remaining_plan(
    previous: &PlanDocument,
    scenario: &Scenario,
    elapsed: f64,
) -> Result<RemainingPlan, Fault> {
    if previous.scenario != scenario.title {
        let found = format_args!("a plan of \"{}\"", previous.scenario);
        let allowed = format_args!("a plan of \"{}\"", scenario.title);
        return Err(Fault::new("scenario", found, allowed));
    }
    let documents = previous
        .trajectory
        .as_ref()
        .and_then(|t| t.segments.as_ref());
    let planned: Vec<Segment> = (documents.into_iter().flatten())
        .map(SegmentDocument::segment)
        .collect();
    let (Some(last), true) = (planned.last(), planned.iter().all(Segment::is_valid)) else {
        return Err(Fault::new(
            "trajectory.segments",
            "nothing",
            "lines and arcs: a plan of the space-time or path-time planner",
        ));
    };
    if !(elapsed >= 0.0 && elapsed <= last.end_time()) {
        let until = rounded(previous.time_s + last.end_time());
        return Err(Fault::new(
            "time_s",
            format_args!("a plan from {} s to {until} s", previous.time_s),
            format_args!(
                "a plan that covers {} s, the scenario's time",
                scenario.time
            ),
        ));
    }
    let remainder: Vec<Segment> = (planned.iter())
        .filter(|s| s.end_time() > elapsed)
        .map(|s| shifted(s.between(elapsed, s.end_time()), elapsed))
        .collect();
    let own = &scenario.own_ship;
    let now = remainder.first().map_or(last.end(), |s| s.start);
    let metres = (now.position - own.pose.position).norm();
    let degrees = deg_from_radians(wrap(now.heading - own.pose.heading).abs());
    let most = OFF_PLAN_LENGTHS * own.hull.length;
    if !(metres <= most && degrees <= OFF_PLAN_DEG) {
        return Err(Fault::new(
            "trajectory.segments",
            format_args!(
                "own ship {metres:.1} m and {degrees:.1} degrees from where the plan has it"
            ),
            format_args!("at most {most} m, own length, and {OFF_PLAN_DEG} degrees"),
        ));
    }
    Ok(RemainingPlan {
        planned,
        remainder,
        now,
    })
}

/// A segment with times that count from `elapsed` seconds later.
fn shifted(s: Segment, elapsed: f64) -> Segment {
    Segment {
        start_time: s.start_time - elapsed,
        ..s
    }
}

/// True where all that is remembered lies before the plan, in order of time.
fn is_past(memory: &MemoryDocument) -> bool {
    let sailed: Vec<Segment> = memory.sailed.iter().map(SegmentDocument::segment).collect();
    let times = sailed.iter().flat_map(|s| [s.start_time, s.end_time()]);
    let in_order = |times: &[f64]| {
        let before = |time: &f64| *time <= tolerance::TIME_S && time.is_finite();
        let order = times.windows(2).all(|t| t[0] <= t[1] + tolerance::TIME_S);
        order && times.iter().all(before)
    };
    let targets = memory.targets.iter().all(|target| {
        let track: Vec<f64> = target.track.iter().map(|state| state.at.t_s).collect();
        let role = target.role.as_ref();
        let role =
            role.is_none_or(|role| role.risk(0.0).is_some() && in_order(&[role.own_ship.at.t_s]));
        in_order(&track) && role
    });
    targets && sailed.iter().all(Segment::is_valid) && in_order(&times.collect::<Vec<_>>())
}

fn memory_after(
    previous: &PlanDocument,
    scenario: &Scenario,
    plan: RemainingPlan,
) -> Result<Memory, Fault> {
    let (elapsed, own) = (scenario.time - previous.time_s, &scenario.own_ship);
    let RemainingPlan {
        planned, remainder, ..
    } = plan;
    if !previous.memory.iter().all(is_past) {
        return Err(Fault::new(
            "memory",
            "a motion, a track or a role that is not before the plan",
            "times that increase up to 0, and a known role",
        ));
    }
    let before = previous.memory.iter().flat_map(|memory| &memory.sailed);
    let mut sailed: Vec<Segment> = before.map(|s| shifted(s.segment(), elapsed)).collect();
    for s in planned.iter().filter(|s| s.start_time < elapsed) {
        let s = shifted(s.between(s.start_time, elapsed), elapsed);
        match sailed.last_mut().filter(|last| last.is_continued_by(&s)) {
            Some(last) => last.duration += s.duration,
            None => sailed.push(s),
        }
    }
    let now = SteadyShip::new(own.pose, remainder.first().map_or(own.speed, |s| s.speed));
    let manoeuvres = manoeuvres(previous, elapsed);
    let is_off_route = manoeuvres.iter().any(has_begun);
    let samples = OwnSamples::of_past(&sailed, now, own);
    let (mut outside_velocities, mut outside_places) = (Vec::new(), Vec::new());
    let limits = &scenario.limits;
    let known = scenario.targets.iter().enumerate().map(|(index, target)| {
        let Some(ship) = target.ship() else {
            return TargetMemory::default();
        };
        let mut memory = target_memory(previous, &target.name, elapsed);
        match assumed(previous, &target.name, ship, elapsed) {
            None | Some(Assumed::Inside) => {}
            Some(Assumed::OutsideVelocities) => outside_velocities.push(target.name.clone()),
            Some(Assumed::OutsidePlaces) => {
                outside_places.push(target.name.clone());
                memory = TargetMemory::default();
            }
        }
        // the domain stays as it is until own ship is on its route again
        let lasting = memory.role.filter(|_| is_off_route);
        let given = scenario.memory.target(index).and_then(|known| known.role);
        let role = lasting.or_else(|| role_now(&samples, (own, now), ship, &memory, limits));
        // the same role goes on, with the course at its beginning
        let same = |given: Risk| role.filter(|role| role.role == given.role).unwrap_or(given);
        let role = given.map(same).or(role);
        memory.passed = role.is_none() && (memory.passed || memory.role.is_some());
        memory.role = role;
        memory
    });
    let mut targets: Vec<TargetMemory> = known.collect();
    forget(&mut sailed, &mut targets);
    let missing = (previous.targets.iter().map(|then| then.name.clone()))
        .filter(|name| scenario.targets.iter().all(|target| target.name != *name));
    let under_way = (manoeuvres.iter().find(|m| has_begun(m))).zip(remainder.first());
    Ok(Memory {
        warm_start: None,
        under_way: under_way.map(|(manoeuvre, steered)| UnderWay {
            begins: manoeuvre.begins,
            first_heading: manoeuvre.first_heading,
            turn: manoeuvre.turn,
            heading: steered.end().heading,
            speed: nearest_speed(own, steered.speed),
            is_returning: manoeuvre.returns <= 0.0,
        }),
        escape: (previous.escape.as_ref())
            .filter(|escape| escape.held_until_s > elapsed)
            .map(|escape| Escape {
                held_until: escape.held_until_s - elapsed,
                turn: -radians_from_deg(escape.turn_deg),
                speed: escape.speed_mps,
            }),
        outside_velocities,
        outside_places,
        missing: missing.collect(),
        sailed,
        remainder,
        off_plan: 0.0,
        manoeuvres,
        targets,
    })
}

/// The manoeuvres of the previous plan that own ship has not finished.
fn manoeuvres(previous: &PlanDocument, elapsed: f64) -> Vec<PlannedManoeuvre> {
    let manoeuvres = previous.manoeuvres.iter();
    manoeuvres
        .map(|m| planned_manoeuvre(m).after(elapsed))
        .filter(|m| m.joins > 0.0)
        .collect()
}

fn has_begun(manoeuvre: &PlannedManoeuvre) -> bool {
    manoeuvre.begins < -tolerance::TIME_S
}

/// The nearest of own ship's speeds, which may have changed.
fn nearest_speed(own: &OwnShip, speed: f64) -> f64 {
    let off = |u: &f64| (u - speed).abs();
    if speed == 0.0 && own.speeds.contains(&0.0) {
        return 0.0;
    }
    let nearest = own.moving_speeds().min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.unwrap_or(speed)
}

/// Where a target is, as the previous plan assumed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Assumed {
    /// At a place that it could reach, with a velocity that it could have.
    Inside,
    /// With another velocity, now or since then.
    OutsideVelocities,
    /// At a place that no ship of its speed could reach: its role and its track are those of another
    /// ship.
    OutsidePlaces,
}

/// Where a target is; `None` for one that the previous plan does not have.
fn assumed(previous: &PlanDocument, name: &str, ship: &ShipTrack, elapsed: f64) -> Option<Assumed> {
    let then = ship_then(previous, name)?;
    let velocities = then.outer_velocity_sets(then.turn_rate, previous.horizon_s);
    let places = then.outer_positions().translated(then.pose.position);
    let set = Uncertainty::new(places, velocities);
    let mut sets = set.velocities.iter();
    let now = sets.find(|timed| timed.until > elapsed)?;
    let now = now.velocities.as_polygon()?;
    let reached = set.outer_section(elapsed);
    let known = SIGMAS * ship.position_std;
    let off = reached.signed_distance(ship.pose.position);
    // negated on purpose: a NaN is outside
    if !(off <= known + ASSUMED * (1.0 + elapsed)) {
        // a ship that has turned since is where none of the assumed velocities would have taken it
        let way = (ship.pose.position - then.pose.position).norm();
        let farthest = FASTEST * (then.greatest_speed() + then.speed_half_width()) * elapsed
            + SIGMAS * (then.position_std + ship.position_std);
        return Some(match way <= farthest {
            true => Assumed::OutsideVelocities,
            false => Assumed::OutsidePlaces,
        });
    }
    let error = SIGMAS * (ship.speed_std + ship.speed * ship.course_std);
    let inside = now.signed_distance(ship.velocity()) <= error + ASSUMED;
    Some(match inside {
        true => Assumed::Inside,
        false => Assumed::OutsideVelocities,
    })
}

/// A target of the previous plan, then.
fn ship_then(previous: &PlanDocument, name: &str) -> Option<ShipTrack> {
    let mut targets = previous.targets.iter();
    let then = targets.find(|target| target.name == name)?;
    then.ship.as_ref()?.track().ok()
}

/// Memory of a target in the previous plan.
fn target_memory(previous: &PlanDocument, name: &str, elapsed: f64) -> TargetMemory {
    let mut before = previous.memory.iter().flat_map(|memory| &memory.targets);
    let before = before.find(|target| target.name == name);
    let mut memory = TargetMemory::default();
    if let Some(before) = before {
        memory.role = before.role.as_ref().and_then(|known| known.risk(elapsed));
        memory.passed = before.passed;
        memory.track = (before.track.iter())
            .map(|state| state.steady(elapsed))
            .collect();
    }
    if let Some(ship) = ship_then(previous, name).map(|ship| SteadyShip::on_track(&ship, 0.0)) {
        // a target that keeps course and speed is where it was thought to be
        let thought = memory.at(-elapsed).filter(|_| elapsed > 0.0);
        let is_there = thought.is_some_and(|thought| {
            let off = (thought.pose.position - ship.pose.position).norm();
            off <= ASSUMED * (1.0 + elapsed)
                && (thought.velocity() - ship.velocity()).norm() <= ASSUMED
        });
        if !is_there {
            memory.track.push((-elapsed, ship));
        }
    }
    memory
}

/// The role that own ship has now.
fn role_now(
    samples: &OwnSamples,
    (own, now): (&OwnShip, SteadyShip),
    ship: &ShipTrack,
    memory: &TargetMemory,
    thresholds: &Thresholds,
) -> Option<Risk> {
    let encounter = ComplianceReport::samples(samples, ship, Some(memory), thresholds);
    let last = roles(&encounter, thresholds).into_iter().next_back();
    let lasting = last
        .filter(|interval| interval.until >= 0.0)
        .map(|interval| {
            let known = memory.role.filter(|risk| risk.time == interval.from);
            known.unwrap_or_else(|| {
                let begun = encounter.samples().iter().find(|s| s.time >= interval.from);
                let (own, target) = begun.map_or((now, SteadyShip::on_track(ship, 0.0)), |s| {
                    (s.own, s.target)
                });
                Risk {
                    role: interval.role,
                    time: interval.from,
                    own,
                    target,
                }
            })
        });
    let turned = |risk: &Risk| wrap(ship.pose.heading - risk.target.pose.heading).abs();
    match lasting {
        Some(risk)
            if turned(&risk) > radians_from_deg(NEW_COURSE_DEG)
                && risk.role.duties().situation != Some(Situation::Overtaking) =>
        {
            let present = OwnSamples::of_past(&[], now, own);
            let present = ComplianceReport::samples(&present, ship, None, thresholds);
            let role = roles(&present, thresholds)
                .first()
                .map(|interval| interval.role);
            Some(match role {
                Some(role) if role != risk.role => Risk {
                    role,
                    time: 0.0,
                    own: now,
                    target: SteadyShip::on_track(ship, 0.0),
                },
                _ => risk,
            })
        }
        other => other,
    }
}

/// Drops what lies before the first role that lasts.
fn forget(sailed: &mut Vec<Segment>, targets: &mut [TargetMemory]) {
    let begun = targets.iter().filter_map(|target| target.role);
    let from = begun.map(|risk| risk.time).fold(0.0, f64::min) - BEFORE_S;
    sailed.retain(|s| s.end_time() > from);
    if let Some(first) = sailed.first_mut() {
        *first = first.between(from, first.end_time());
    }
    for target in targets {
        let kept = target.track.partition_point(|(time, _)| *time <= from);
        target.track.drain(..kept.saturating_sub(1));
    }
}
