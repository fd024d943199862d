//! Replanning: what a plan leaves to the next one. Own ship's motion so far, the targets' tracks and
//! sets, roles, and the plan that own ship follows.

use crate::colregs::compliance::{ComplianceReport, OwnSamples, roles};
use crate::colregs::{Risk, Situation, SteadyShip, TargetMemory, Thresholds};
use crate::frame::{Pose, deg_from_radians, radians_from_deg, wrap};
use crate::pipeline::Run;
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

/// The plan that own ship follows, and what was known when it was made: all that the next plan
/// continues from.
///
/// [`Self::of`] makes one from a run, and `PreviousPlan::try_from` from a plan document that was read
/// from a file. A document has its courses in degrees, so the two differ by rounding.
#[derive(Debug, Clone, PartialEq)]
pub struct PreviousPlan {
    /// Title of the scenario.
    pub(crate) scenario: String,
    /// The present then, on the clock of the scenario, seconds. All other times count from it.
    pub(crate) time: f64,
    pub(crate) horizon: f64,
    /// Own ship's motion before the plan, in order of time; its times are negative.
    pub(crate) sailed: Vec<Segment>,
    /// The valid lines and arcs of the plan, at least one.
    pub(crate) segments: Vec<Segment>,
    pub(crate) manoeuvres: Vec<PlannedManoeuvre>,
    pub(crate) escape: Option<Escape>,
    pub(crate) targets: Vec<PreviousTarget>,
}

/// A target as a plan assumed it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PreviousTarget {
    pub name: String,
    /// `None` for explicit sets.
    pub ship: Option<ShipTrack>,
    /// Memory from before the plan.
    pub memory: TargetMemory,
}

impl PreviousPlan {
    /// The plan of a run; `None` without one, and for a plan under forces, which is remembered as a
    /// [`WarmStart`](crate::planner::WarmStart).
    pub fn of(run: &Run) -> Option<Self> {
        let (scenario, plan) = (&run.scenario, run.planned.outcome.plan()?);
        let segments = plan.trajectory.segments();
        let targets = scenario.targets.iter().enumerate();
        (!segments.is_empty()).then(|| Self {
            scenario: scenario.title.clone(),
            time: scenario.time,
            horizon: scenario.horizon,
            sailed: scenario.memory.sailed.clone(),
            segments: segments.to_vec(),
            manoeuvres: run.planned.manoeuvres.clone(),
            escape: run.planned.escape,
            targets: targets
                .map(|(index, target)| PreviousTarget {
                    name: target.name.clone(),
                    ship: target.ship().cloned(),
                    memory: scenario.memory.target(index).cloned().unwrap_or_default(),
                })
                .collect(),
        })
    }

    /// Gives a target the name that it has now.
    pub(crate) fn rename(&mut self, from: &str, to: &str) {
        for target in self.targets.iter_mut().filter(|target| target.name == from) {
            to.clone_into(&mut target.name);
        }
    }

    /// True for a target that was planned for.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.target(name).is_some()
    }

    fn target(&self, name: &str) -> Option<&PreviousTarget> {
        self.targets.iter().find(|target| target.name == name)
    }

    /// A tracked target, as it was then.
    fn ship(&self, name: &str) -> Option<&ShipTrack> {
        self.target(name)?.ship.as_ref()
    }

    /// The manoeuvres that own ship has not finished `elapsed` seconds later.
    fn manoeuvres(&self, elapsed: f64) -> Vec<PlannedManoeuvre> {
        (self.manoeuvres.iter())
            .map(|m| m.after(elapsed))
            .filter(|m| m.joins > 0.0)
            .collect()
    }
}

/// Adds to a scenario what a plan of an earlier time leaves to it.
///
/// Roles last until the target is past and clear; a role that has begun since is found on the
/// motion so far. A target whose course has changed by more than 20 degrees gives own ship the role
/// of the present where that is a risk, but an overtaking ship stays one (Rule 13(d)). A target
/// that does not turn keeps to the places and velocities of both plans; one that has left them is
/// named, and its set begins anew. Own ship within its tracking margin of the plan is put on it:
/// the next plan goes on from there.
///
/// The fault says why the plan is not one that own ship follows; the scenario is then as it was.
/// O(seconds sailed × targets).
pub fn remember(previous: &PreviousPlan, scenario: &mut Scenario) -> Result<(), Fault> {
    let elapsed = scenario.time - previous.time;
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
    let has_altered = previous.manoeuvres(elapsed).iter().any(has_begun);
    for target in &mut scenario.targets {
        if let (Motion::Ship(ship), true) = (&mut target.motion, has_altered) {
            let then = previous.ship(&target.name);
            ship.risk_distance = then.map_or(0.0, |then| then.risk_distance);
        }
    }
    let mut memory = memory_after(previous, scenario, plan.remainder);
    if scenario.stay.is_some() {
        // a stay is planned anew, because more is known of who comes
        let to_stay = before_stay(&scenario.desired, &memory.remainder).len();
        memory.remainder.truncate(to_stay);
    }
    if !is_on {
        memory.off_plan = off;
    }
    for target in &mut scenario.targets {
        let then = previous.ship(&target.name);
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
fn keep_sets(ship: &mut ShipTrack, then: &ShipTrack, elapsed: f64) {
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
                ..then.clone()
            }
            .outer_velocity_set(),
        });
    }
}

/// Remainder of the previous plan at the scenario's time.
struct RemainingPlan {
    /// Its times count from the scenario.
    remainder: Vec<Segment>,
    /// Where it has own ship.
    now: Pose,
}

fn remaining_plan(
    previous: &PreviousPlan,
    scenario: &Scenario,
    elapsed: f64,
) -> Result<RemainingPlan, Fault> {
    if previous.scenario != scenario.title {
        let found = format_args!("a plan of \"{}\"", previous.scenario);
        let allowed = format_args!("a plan of \"{}\"", scenario.title);
        return Err(Fault::new("scenario", found, allowed));
    }
    let last = previous.segments.last();
    let end = last.map_or(0.0, Segment::end_time);
    if !(elapsed >= 0.0 && elapsed <= end) {
        let until = rounded(previous.time + end);
        return Err(Fault::new(
            "time_s",
            format_args!("a plan from {} s to {until} s", previous.time),
            format_args!(
                "a plan that covers {} s, the scenario's time",
                scenario.time
            ),
        ));
    }
    let remainder: Vec<Segment> = (previous.segments.iter())
        .filter(|s| s.end_time() > elapsed)
        .map(|s| shifted(s.between(elapsed, s.end_time()), elapsed))
        .collect();
    let own = &scenario.own_ship;
    let now = remainder.first().map(|s| s.start);
    let now = now.or(last.map(Segment::end)).unwrap_or(own.pose);
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
    Ok(RemainingPlan { remainder, now })
}

/// A segment with times that count from `elapsed` seconds later.
fn shifted(s: Segment, elapsed: f64) -> Segment {
    Segment {
        start_time: s.start_time - elapsed,
        ..s
    }
}

fn memory_after(previous: &PreviousPlan, scenario: &Scenario, remainder: Vec<Segment>) -> Memory {
    let (elapsed, own) = (scenario.time - previous.time, &scenario.own_ship);
    let before = previous.sailed.iter();
    let mut sailed: Vec<Segment> = before.map(|s| shifted(*s, elapsed)).collect();
    let begun = previous.segments.iter();
    for s in begun.filter(|s| s.start_time < elapsed) {
        let s = shifted(s.between(s.start_time, elapsed), elapsed);
        match sailed.last_mut().filter(|last| last.is_continued_by(&s)) {
            Some(last) => last.duration += s.duration,
            None => sailed.push(s),
        }
    }
    let now = SteadyShip::new(own.pose, remainder.first().map_or(own.speed, |s| s.speed));
    let manoeuvres = previous.manoeuvres(elapsed);
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
    Memory {
        warm_start: None,
        under_way: under_way.map(|(manoeuvre, steered)| UnderWay {
            begins: manoeuvre.begins,
            first_heading: manoeuvre.first_heading,
            turn: manoeuvre.turn,
            heading: steered.end().heading,
            speed: nearest_speed(own, steered.speed),
            is_returning: manoeuvre.returns <= 0.0,
        }),
        escape: (previous.escape)
            .filter(|escape| escape.held_until > elapsed)
            .map(|escape| Escape {
                held_until: escape.held_until - elapsed,
                ..escape
            }),
        outside_velocities,
        outside_places,
        missing: missing.collect(),
        sailed,
        remainder,
        off_plan: 0.0,
        manoeuvres,
        targets,
    }
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
fn assumed(previous: &PreviousPlan, name: &str, ship: &ShipTrack, elapsed: f64) -> Option<Assumed> {
    let then = previous.ship(name)?;
    let velocities = then.outer_velocity_sets(then.turn_rate, previous.horizon);
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

/// Memory of a target at the scenario's time, with its state in the previous plan.
fn target_memory(previous: &PreviousPlan, name: &str, elapsed: f64) -> TargetMemory {
    let Some(before) = previous.target(name) else {
        return TargetMemory::default();
    };
    let role = before.memory.role;
    let track = before.memory.track.iter();
    let mut memory = TargetMemory {
        role: role.map(|risk| Risk {
            time: risk.time - elapsed,
            ..risk
        }),
        passed: before.memory.passed,
        track: track.map(|(time, ship)| (time - elapsed, *ship)).collect(),
    };
    if let Some(ship) = before.ship.as_ref() {
        let ship = SteadyShip::on_track(ship, 0.0);
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
