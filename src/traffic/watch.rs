//! Own ship in live traffic: once a cycle the risk of collision with each ship, and where there is any, a plan
//! that goes on from the last one.
//!
//! ```text
//! Picture at a time ─► targets ┐
//! scenario file, own ship now ─┴► Scenario ─► sets ─► dangerous ships ─► plan ─► WatchDocument
//!                                    ▲ PreviousPlan ─────────────────────┘
//! ```

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use searoom_traffic::{Identity, Note, Picture, Reach, Ship, Taken};

use super::situation::{Own, Surroundings, surroundings};
use crate::colregs::Role;
use crate::document::{
    DangerousShipDocument, OwnNowDocument, PlanDocument, WatchDocument, WatchLegDocument,
    WatchPlanDocument, planned_legs,
};
use crate::document::{verdict_line, warnings};
use crate::frame::{Georeference, Pose, course_deg_from_heading, direction, heading_of};
use crate::obstacle::SpaceTimeObstacle;
use crate::pipeline::{self, Run, TargetSets};
use crate::planner::Minimises;
use crate::replanning::{PreviousPlan, remember};
use crate::scenario::{Compliance, Fault, OwnNow, Scenario, unix_time};
use crate::target::{Motion, ShipTrack};
use crate::tolerance::TOUCH_M;
use crate::trajectory::{DesiredTrajectory, Segment};

/// Own ship may be this far from where its mission has it, turning radii, before the mission begins anew from
/// the place nearest to it.
const OFF_MISSION_RADII: f64 = 4.0;

/// Share of a mission after which it begins anew: a route goes on beyond the part that the horizon holds.
const SAILED_SHARE: f64 = 0.5;

/// Metres beside own ship's way that hulls, margins and domains reach.
const BESIDE_M: f64 = 5000.0;

/// Own ship is slower than its mission may ask for: so much more may be sailed in a horizon.
const FASTER: f64 = 1.2;

/// Share of the weight of time with which the nearest place of a mission is sought.
const NEAREST_TIME: f64 = 0.01;

/// Seconds after which a plan is made anew though nothing has happened.
const REPLAN_S: f64 = 10.0;

/// What a watch knows from one cycle to the next.
#[derive(Debug)]
pub struct Watch {
    text: String,
    folder: PathBuf,
    compliance: Option<Compliance>,
    plane: Georeference,
    horizon: f64,
    /// Own ship's largest speed, m/s, and half of its hull's diagonal, metres.
    fastest: f64,
    own_reach: f64,
    mission: Option<Mission>,
    previous: Option<PreviousPlan>,
    last: Option<LastPlan>,
    /// True where own ship did not follow the last plan.
    is_off_plan: bool,
    names: HashMap<(Identity, u32), String>,
    /// Positions of own ship that contradict the one that is taken, so far.
    elsewhere: u64,
}

/// The mission from where own ship was when it began.
#[derive(Debug)]
struct Mission {
    /// Without tracked ships, from the place nearest to where own ship was.
    scenario: Scenario,
    /// As the file has it, and the seconds of it that were sailed then.
    whole: DesiredTrajectory,
    sailed: f64,
    /// Seconds of Unix time.
    began: f64,
}

/// The plan that is shown until the next one is due.
#[derive(Debug)]
struct LastPlan {
    /// Seconds of Unix time.
    made: f64,
    document: WatchPlanDocument,
    /// Names of the targets that it is for, and how many others it is clear of.
    targets: HashSet<String>,
    clear: usize,
}

impl LastPlan {
    /// What is left of it.
    fn after(&self, elapsed: f64) -> WatchPlanDocument {
        let legs = self.document.legs.iter();
        let left = legs.filter(|leg| leg.until_s > elapsed);
        WatchPlanDocument {
            made_s_ago: elapsed,
            ends_s: (self.document.ends_s - elapsed).max(0.0),
            legs: left
                .map(|leg| WatchLegDocument {
                    from_s: (leg.from_s - elapsed).max(0.0),
                    until_s: leg.until_s - elapsed,
                    ..leg.clone()
                })
                .collect(),
            ..self.document.clone()
        }
    }
}

/// One moment of a watch.
#[derive(Debug)]
pub struct Moment {
    /// For programs.
    pub document: WatchDocument,
    /// The plan, where there is one.
    pub run: Option<Box<Run>>,
}

impl Watch {
    /// Own ship, its mission and settings are those of a scenario file in a folder, which has to have an
    /// `origin`. The feed gives own ship's position, and the ships: tracked targets of the file are left out.
    ///
    /// The faults are those of the file.
    pub fn new(
        text: &str,
        folder: &Path,
        compliance: Option<Compliance>,
    ) -> Result<Self, Vec<Fault>> {
        let scenario = Scenario::parse_beside(text, folder)?;
        let Some(plane) = scenario.earth else {
            let allowed = "{ lat_deg, lon_deg }, because the feed has positions on the earth";
            return Err(vec![Fault::new("origin", "nothing", allowed)]);
        };
        if matches!(scenario.planner.facts().minimises, Minimises::Own(_)) {
            let found = format!("{:?}", scenario.planner.facts().name);
            let allowed = "\"space-time\" or \"path-time\": a watch has no forces of own ship";
            return Err(vec![Fault::new("planner.kind", found, allowed)]);
        }
        Ok(Self {
            own_reach: scenario.own_ship.hull.half_diagonal(),
            text: text.to_owned(),
            folder: folder.to_owned(),
            compliance,
            plane,
            horizon: scenario.horizon,
            fastest: scenario.own_ship.max_speed(),
            mission: None,
            previous: None,
            last: None,
            is_off_plan: false,
            names: HashMap::new(),
            elsewhere: 0,
        })
    }

    /// How far own ship's middle may be from an antenna whose place is not known, metres: for
    /// [`PictureSettings::own_reach_m`](searoom_traffic::PictureSettings::own_reach_m).
    pub fn own_reach(&self) -> f64 {
        self.own_reach
    }

    /// The risk at a time in seconds of Unix time, and a plan where there is any.
    pub fn at(&mut self, picture: &Picture, time: f64) -> Moment {
        let reach = Reach {
            own_m: FASTER * self.fastest * self.horizon + BESIDE_M,
            within_s: self.horizon,
        };
        let mut around = surroundings(picture, time, &self.plane, reach);
        let mut events = Vec::new();
        let elsewhere = picture.taken(Taken::OwnElsewhere);
        if elsewhere > self.elsewhere {
            self.elsewhere = elsewhere;
            events.push(
                "own ship is also reported where it cannot be; the first place is taken".to_owned(),
            );
        }
        let own = around.own.take();
        let mut document = WatchDocument {
            time: utc(time),
            time_s: time,
            own: own.as_ref().map(|own| self.own_document(own)),
            ships: around.ships.len(),
            clear: 0,
            beyond: around.beyond,
            in_no_set: (around.remarks.cautions.iter())
                .map(|caution| caution.trim_start_matches("in no set: ").to_owned())
                .collect(),
            risk_computed: own.is_some(),
            dangerous: Vec::new(),
            plan: None,
            events: Vec::new(),
            took_s: 0.0,
        };
        let Some(own) = own else {
            events.push(nowhere(picture, &self.plane, time));
            // what own ship does unseen is no plan
            (self.mission, self.previous, self.last) = (None, None, None);
            return Moment {
                document: WatchDocument { events, ..document },
                run: None,
            };
        };
        let run = match self.scenario(&own, &around, time, &mut events) {
            Ok(scenario) => self.judged(scenario, &own, &around, &mut document, &mut events),
            Err(faults) => {
                document.risk_computed = false;
                events.extend(
                    faults
                        .iter()
                        .map(|fault| format!("no risk is computed: {fault}")),
                );
                None
            }
        };
        document.events = events;
        Moment {
            document,
            run: run.map(Box::new),
        }
    }

    fn own_document(&self, own: &Own) -> OwnNowDocument {
        let place = self.plane.to_geographic(own.pose.position);
        OwnNowDocument {
            lat_deg: place.lat_deg,
            lon_deg: place.lon_deg,
            course_deg: course_deg_from_heading(own.pose.heading),
            speed_mps: own.speed,
            radius_m: own.radius_m,
            age_s: own.age_s.max(0.0),
        }
    }

    /// The scenario of a moment.
    fn scenario(
        &mut self,
        own: &Own,
        around: &Surroundings,
        time: f64,
        events: &mut Vec<String>,
    ) -> Result<Scenario, Vec<Fault>> {
        self.renew_mission(own, time, events)?;
        let Some(mission) = &self.mission else {
            return Err(vec![Fault::new("mission", "none", "a mission")]);
        };
        let elapsed = time - mission.began;
        let mut scenario = mission.scenario.clone();
        scenario.time += elapsed;
        scenario.desired = scenario.desired.remaining(elapsed);
        scenario.stay = scenario.stay.map(|until| (until - elapsed).max(0.0));
        scenario.own_ship.pose = own.pose;
        scenario.own_ship.speed = own.speed;
        scenario.targets.extend(around.targets());
        scenario
            .remarks
            .cautions
            .extend_from_slice(&around.remarks.cautions);
        Ok(scenario)
    }

    /// Begins the mission anew where there is none, where own ship is far from it, and where half of it is
    /// sailed. Not in a manoeuvre, which returns to it.
    fn renew_mission(
        &mut self,
        own: &Own,
        time: f64,
        events: &mut Vec<String>,
    ) -> Result<(), Vec<Fault>> {
        if let Some(mission) = &self.mission {
            let (elapsed, desired) = (time - mission.began, &mission.scenario.desired);
            let off = (desired.position_at(elapsed) - own.pose.position).norm();
            let most = OFF_MISSION_RADII * mission.scenario.own_ship.turning_radius;
            let is_sailed = elapsed > SAILED_SHARE * desired.duration();
            let follows = self.previous.is_some() && !self.is_off_plan;
            if follows || elapsed >= 0.0 && off <= most && !is_sailed {
                return Ok(());
            }
            if off > most {
                events.push(format!(
                    "own ship is {off:.0} m from its mission, which begins anew here"
                ));
            }
        }
        let now = OwnNow {
            place: self.plane.to_geographic(own.pose.position),
            heading: own.pose.heading,
            speed: own.speed,
        };
        let mut scenario = Scenario::parse_at(&self.text, &self.folder, &now)?;
        if let Some(compliance) = self.compliance {
            scenario.compliance = compliance;
        }
        let before = scenario.targets.len();
        scenario.targets.retain(|target| target.sets().is_some());
        let left_out = before - scenario.targets.len();
        if left_out > 0 && self.mission.is_none() {
            events.push(format!(
                "{left_out} ships of the file left out: the feed gives the ships"
            ));
        }
        scenario.memory = crate::scenario::Memory::default();
        let whole = scenario.desired.clone();
        // a way back may lead by the same places, so the part that is due is preferred
        let (due, weight) = match &self.mission {
            Some(before) if before.whole == whole => (
                before.sailed + (time - before.began),
                NEAREST_TIME * scenario.time_weight,
            ),
            _ => (0.0, 0.0),
        };
        let nearest = whole.nearest(own.pose.position, due, weight);
        let leg = &whole.legs()[nearest.leg];
        let sailed = leg.start_time + (nearest.distance - leg.start_distance) / leg.speed;
        scenario.desired = whole.remaining(sailed);
        // its times count from the mission before
        (self.previous, self.last) = (None, None);
        self.mission = Some(Mission {
            scenario,
            whole,
            sailed,
            began: time,
        });
        Ok(())
    }

    /// Fills in the dangerous ships, and plans where there are any.
    fn judged(
        &mut self,
        mut scenario: Scenario,
        own: &Own,
        around: &Surroundings,
        document: &mut WatchDocument,
        events: &mut Vec<String>,
    ) -> Option<Run> {
        self.rename(around);
        self.is_off_plan = false;
        if let Some(previous) = &self.previous
            && let Err(fault) = remember(previous, &mut scenario)
        {
            events.push(format!("the last plan is not followed: {}", fault.found));
            self.is_off_plan = true;
        }
        // a ship that was not heard since the last plan may be anywhere in its set, which has grown
        for (target, ship) in scenario
            .targets
            .iter_mut()
            .rev()
            .zip(around.ships.iter().rev())
        {
            if let (Motion::Ship(track), Some(seen)) = (&mut target.motion, ship.track()) {
                (track.kept_positions, track.kept_velocities) =
                    (seen.kept_positions.clone(), seen.kept_velocities.clone());
            }
        }
        let left = [
            (
                &scenario.memory.outside_velocities,
                "has left the velocities that the last plan assumes",
            ),
            (
                &scenario.memory.outside_places,
                "is at a place that it could not reach",
            ),
        ];
        for (names, what) in left {
            events.extend(names.iter().map(|name| format!("'{name}' {what}")));
        }
        let sets = pipeline::sets(&scenario);
        let first = scenario.targets.len() - around.ships.len();
        let mut dangers: Vec<DangerousShipDocument> = (around.ships.iter().zip(&sets[first..]))
            .filter_map(|(ship, sets)| dangerous(&scenario, own, ship, sets))
            .collect();
        let closest_at = |ship: &DangerousShipDocument| ship.tcpa_s.unwrap_or(0.0);
        let urgency = |ship: &DangerousShipDocument| ship.enters_set_s.unwrap_or(f64::INFINITY);
        dangers.sort_by(|a, b| {
            (urgency(a).total_cmp(&urgency(b)))
                .then(closest_at(a).total_cmp(&closest_at(b)))
                .then(a.identity.cmp(&b.identity))
        });
        document.dangerous = dangers;
        let nominal = nominal(&scenario);
        let is_met = |sets: &TargetSets| sets.with_domain.is_entered(&nominal, TOUCH_M);
        let is_dangerous = |name: &str| document.dangerous.iter().any(|ship| ship.name == name);
        let is_known = |name: &str| self.previous.as_ref().is_some_and(|p| p.has(name));
        let wanted: Vec<bool> = (scenario.targets.iter().zip(&sets))
            .map(|(target, sets)| {
                let name = target.name.as_str();
                target.sets().is_some() || is_dangerous(name) || is_known(name) || is_met(sets)
            })
            .collect();
        // a manoeuvre is finished, though the ship that it is for is gone
        if !wanted.contains(&true) && self.previous.is_none() {
            self.last = None;
            return None;
        }
        let elapsed = |last: &LastPlan| document.time_s - last.made;
        if let Some(last) = &self.last
            && !self.is_off_plan
            && elapsed(last) < REPLAN_S
            && goes_on(last, &scenario, &sets, &wanted)
        {
            document.clear = last.clear;
            document.plan = Some(last.after(elapsed(last)));
            return None;
        }
        let (run, is_planned_for) = planned(&scenario, &sets, wanted);
        let planned_for = is_planned_for.iter().filter(|is| **is).count();
        document.clear = scenario.targets.len() - planned_for;
        let has_manoeuvre = !run.planned.manoeuvres.is_empty();
        self.previous =
            PreviousPlan::of(&run).filter(|_| has_manoeuvre || !document.dangerous.is_empty());
        self.last = None;
        if run.planned.outcome.plan().is_none() {
            let why = run.reason().unwrap_or_else(|| run.word());
            events.push(format!("no plan: {why}"));
            return Some(run);
        }
        let plan = PlanDocument::of(&run);
        let legs = planned_legs(&plan).into_iter().map(|leg| WatchLegDocument {
            from_s: leg.motion.start_time,
            until_s: leg.motion.end_time(),
            course_deg: leg.course_deg(),
            speed_mps: leg.motion.speed,
            because_of: leg.because_of,
            events: leg.events,
        });
        let shown = WatchPlanDocument {
            verdict: verdict_line(&plan),
            safe: plan.is_safe(),
            arrives: run.arrives(),
            ends_s: plan
                .motions()
                .last()
                .map_or(0.0, |last| last.motion.end_time()),
            warnings: warnings(&plan),
            planned_for: (scenario.targets.iter().zip(&is_planned_for))
                .filter(|(_, is)| **is)
                .map(|(target, _)| target.name.clone())
                .collect(),
            keeps_plan: run.planned.is_remainder(),
            made_s_ago: 0.0,
            legs: legs.collect(),
        };
        document.plan = Some(shown.clone());
        let shown_for = shown.planned_for.iter().cloned().collect();
        self.last = Some(LastPlan {
            made: document.time_s,
            document: shown,
            targets: shown_for,
            clear: document.clear,
        });
        Some(run)
    }

    /// A ship whose name is heard now is the one that had another name in the last plan.
    fn rename(&mut self, around: &Surroundings) {
        let mut names = HashMap::new();
        for ship in &around.ships {
            let key = (ship.identity, ship.place);
            if let (Some(before), Some(previous)) = (self.names.get(&key), &mut self.previous)
                && *before != ship.target.name
            {
                previous.rename(before, &ship.target.name);
            }
            names.insert(key, ship.target.name.clone());
        }
        self.names = names;
    }
}

/// Why own ship is not known.
fn nowhere(picture: &Picture, plane: &Georeference, time: f64) -> String {
    let why = match picture.own_place() {
        None => "its position has not been heard".to_owned(),
        Some(place) if plane.to_near_plane(place).is_none() => {
            "it is more than 100 km from the origin of the scenario file".to_owned()
        }
        Some(_) => {
            let most = picture.settings().own_stale_s;
            format!(
                "its position, or its course and speed, are older than {most} s at {}",
                utc(time)
            )
        }
    };
    format!("no risk is computed, because own ship is not known: {why}")
}

/// The plan for the ships that are wanted, and for those whose sets with domain a plan without them would
/// enter: the others do not bear on it. Says which it is for, too.
fn planned(scenario: &Scenario, sets: &[TargetSets], mut wanted: Vec<bool>) -> (Run, Vec<bool>) {
    loop {
        let run = pipeline::run(only(scenario, &wanted));
        let segments = run
            .planned
            .outcome
            .plan()
            .map(|plan| plan.trajectory.segments());
        let mut is_whole = true;
        for (wanted, sets) in wanted.iter_mut().zip(sets) {
            // without a plan every ship may bear on it
            let is_met = segments.is_none_or(|plan| sets.with_domain.is_entered(plan, TOUCH_M));
            if !*wanted && is_met {
                (*wanted, is_whole) = (true, false);
            }
        }
        if is_whole {
            return (run, wanted);
        }
    }
}

/// True where the last plan is still one: every ship that bears on it was planned for and keeps to what it
/// assumes, and what is left of it enters no set that a ship is in now. A plan that was not safe is made anew.
fn goes_on(last: &LastPlan, scenario: &Scenario, sets: &[TargetSets], wanted: &[bool]) -> bool {
    let memory = &scenario.memory;
    let targets = scenario.targets.iter().zip(wanted);
    let mut new =
        targets.filter(|(target, wanted)| **wanted && !last.targets.contains(&target.name));
    let mut enters = sets
        .iter()
        .map(|sets| sets.hard.is_entered(&memory.remainder, TOUCH_M));
    last.document.safe
        && memory.outside_velocities.is_empty()
        && memory.outside_places.is_empty()
        && memory.missing.is_empty()
        && !memory.remainder.is_empty()
        && new.next().is_none()
        && !enters.any(|enters| enters)
        // the plan does not end in the meantime
        && memory.remainder.last().is_some_and(|last| last.end_time() > REPLAN_S)
}

/// A scenario with some of its targets.
fn only(scenario: &Scenario, wanted: &[bool]) -> Scenario {
    let mut some = scenario.clone();
    let mut kept = wanted.iter();
    some.targets.retain(|_| kept.next() == Some(&true));
    // one per target in the same order, or none at all
    let mut kept = wanted.iter();
    some.memory.targets.retain(|_| kept.next() == Some(&true));
    some
}

/// The desired trajectory as lines.
fn nominal(scenario: &Scenario) -> Vec<Segment> {
    let legs = scenario.desired.legs().iter();
    let lines = legs.map(|leg| {
        let pose = Pose::new(leg.start, heading_of(leg.direction));
        Segment::straight(pose, leg.start_time, leg.length / leg.speed, leg.speed)
    });
    lines.collect()
}

/// A ship whose set own ship enters on its course, or toward which it has a role.
fn dangerous(
    scenario: &Scenario,
    own: &Own,
    ship: &Ship,
    sets: &TargetSets,
) -> Option<DangerousShipDocument> {
    let track = ship.track()?;
    let held = Segment::straight(own.pose, 0.0, scenario.horizon, own.speed);
    let enters_set_s = sets.hard.first_contact(&held, TOUCH_M);
    let role = sets.encounter.role;
    if enters_set_s.is_none() && role == Role::None {
        return None;
    }
    let between = track.pose.position - own.pose.position;
    // a ship that sends no speed, and does not lie, has none here
    let unsent = [Note::NoSpeed, Note::ZerosForUnknown];
    let is_unknown = !ship.is_lying && unsent.iter().any(|note| ship.notes.has(*note));
    let approach = (!is_unknown).then(|| closest(scenario, own, track));
    let notes = ship.notes.iter().filter(|note| *note != Note::Raim);
    Some(DangerousShipDocument {
        name: ship.target.name.clone(),
        identity: ship.identity.to_string(),
        status: ship.status,
        range_m: between.norm(),
        bearing_deg: course_deg_from_heading(heading_of(between)),
        course_deg: (!is_unknown).then(|| course_deg_from_heading(track.pose.heading)),
        speed_mps: (!is_unknown).then_some(track.speed),
        cpa_m: approach.map(|(metres, _)| metres),
        tcpa_s: approach.map(|(_, seconds)| seconds),
        enters_set_s,
        risk: match enters_set_s {
            Some(_) => sets.hard.peak_risk(&held).risk,
            None => 0.0,
        },
        role: role.to_string(),
        age_s: ship.age_s,
        notes: notes.map(|note| note.to_string()).collect(),
    })
}

/// Distance of the hulls when the middles are closest, metres, and when that is, seconds.
fn closest(scenario: &Scenario, own: &Own, track: &ShipTrack) -> (f64, f64) {
    let apart = track.pose.position - own.pose.position;
    let closing = track.velocity() - direction(own.pose.heading) * own.speed;
    let time = (-apart.dot(&closing) / closing.norm_squared()).clamp(0.0, scenario.horizon);
    // ships that do not move to each other are as near now as ever
    let time = if time.is_nan() { 0.0 } else { time };
    let moved = own.pose.position + direction(own.pose.heading) * (own.speed * time);
    let hull = scenario
        .own_ship
        .hull
        .polygon(&Pose::new(moved, own.pose.heading));
    let theirs = track.hull.polygon(&track.pose_at(time));
    (hull.separation(&theirs), time)
}

fn utc(time: f64) -> String {
    unix_time(time).map_or_else(String::new, |date| {
        date.format("%Y-%m-%dT%H:%M:%SZ").to_string()
    })
}
