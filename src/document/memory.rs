//! What a plan leaves to the next one, in its document and read back from it.

use searoom_document::{
    KnownRoleDocument, MemoryDocument, PlanDocument, PlannedManoeuvreDocument, SegmentDocument,
    StateDocument, TargetMemoryDocument,
};

use crate::colregs::TargetMemory;
use crate::frame::{
    clockwise_deg, course_deg_from_heading, heading_from_course_deg, radians_from_deg,
};
use crate::pipeline::Run;
use crate::planner::{Escape, PlannedManoeuvre};
use crate::replanning::{PreviousPlan, PreviousTarget};
use crate::scenario::Fault;
use crate::tolerance;
use crate::trajectory::Segment;

/// The memory of a run; `None` where nothing was known.
pub(super) fn memory(run: &Run) -> Option<MemoryDocument> {
    let memory = &run.scenario.memory;
    let known = !memory.sailed.is_empty() || !memory.targets.is_empty();
    let targets = run.scenario.targets.iter().zip(&memory.targets);
    known.then(|| MemoryDocument {
        keeps_plan: run.planned.is_remainder(),
        off_plan_m: memory.off_plan,
        outside_velocities: memory.outside_velocities.clone(),
        outside_places: memory.outside_places.clone(),
        missing: memory.missing.clone(),
        sailed: memory.sailed.iter().map(SegmentDocument::of).collect(),
        targets: targets
            .map(|(target, known)| TargetMemoryDocument {
                name: target.name.clone(),
                role: known.role.as_ref().map(|risk| KnownRoleDocument {
                    role: risk.role,
                    own_ship: StateDocument::of(risk.time, &risk.own),
                    target: StateDocument::of(risk.time, &risk.target),
                }),
                passed: known.passed,
                track: (known.track.iter())
                    .map(|(time, ship)| StateDocument::of(*time, ship))
                    .collect(),
            })
            .collect(),
    })
}

/// The document of a manoeuvre by the rules.
pub(crate) fn planned_manoeuvre_document(manoeuvre: &PlannedManoeuvre) -> PlannedManoeuvreDocument {
    PlannedManoeuvreDocument {
        begins_s: manoeuvre.begins,
        returns_s: manoeuvre.returns,
        joins_s: manoeuvre.joins,
        first_course_deg: course_deg_from_heading(manoeuvre.first_heading),
        turn_deg: clockwise_deg(manoeuvre.turn),
    }
}

/// The manoeuvre by the rules of a document.
fn planned_manoeuvre(document: &PlannedManoeuvreDocument) -> PlannedManoeuvre {
    PlannedManoeuvre {
        begins: document.begins_s,
        returns: document.returns_s,
        joins: document.joins_s,
        first_heading: heading_from_course_deg(document.first_course_deg),
        turn: -radians_from_deg(document.turn_deg),
    }
}

impl TryFrom<&PlanDocument> for PreviousPlan {
    type Error = Fault;

    /// Reads back what a plan leaves to the next one.
    ///
    /// The fault names a plan without valid lines and arcs, or a memory that is not from before it.
    fn try_from(plan: &PlanDocument) -> Result<Self, Fault> {
        let documents = plan.trajectory.iter().flat_map(|t| &t.segments).flatten();
        let segments: Vec<Segment> = documents.map(SegmentDocument::segment).collect();
        if segments.is_empty() || !segments.iter().all(Segment::is_valid) {
            let found = match &plan.trajectory {
                None => format!("no trajectory: the outcome is {}", plan.outcome),
                Some(_) => "no lines and arcs: a plan under forces".to_owned(),
            };
            return Err(Fault::new(
                "trajectory.segments",
                found,
                "lines and arcs: a plan of the space-time or path-time planner",
            ));
        }
        let (sailed, targets) = before(plan).ok_or_else(|| {
            Fault::new(
                "memory",
                "a motion, a track or a role that is not before the plan",
                "times that increase up to 0, and a known role",
            )
        })?;
        Ok(Self {
            scenario: plan.scenario.clone(),
            time: plan.time_s,
            horizon: plan.horizon_s,
            sailed,
            segments,
            manoeuvres: plan.manoeuvres.iter().map(planned_manoeuvre).collect(),
            escape: plan.escape.as_ref().map(|escape| Escape {
                held_until: escape.held_until_s,
                turn: -radians_from_deg(escape.turn_deg),
                speed: escape.speed_mps,
            }),
            targets,
        })
    }
}

/// Own ship's motion before a plan, and the targets; `None` where a time is not before it.
fn before(plan: &PlanDocument) -> Option<(Vec<Segment>, Vec<PreviousTarget>)> {
    let sailed = plan.memory.iter().flat_map(|memory| &memory.sailed);
    let sailed: Vec<Segment> = sailed.map(SegmentDocument::segment).collect();
    let times = sailed.iter().flat_map(|s| [s.start_time, s.end_time()]);
    let is_past = sailed.iter().all(Segment::is_valid) && are_past(times);
    let targets = plan.targets.iter().map(|target| {
        let mut known = plan.memory.iter().flat_map(|memory| &memory.targets);
        let known = known.find(|known| known.name == target.name);
        Some(PreviousTarget {
            name: target.name.clone(),
            ship: target.ship.as_ref().and_then(|ship| ship.track().ok()),
            memory: known.map_or_else(|| Some(TargetMemory::default()), target_memory)?,
        })
    });
    let targets = targets.collect::<Option<_>>()?;
    is_past.then_some((sailed, targets))
}

/// Memory of a target; `None` where a time is not before the plan, or a role has no rule.
fn target_memory(known: &TargetMemoryDocument) -> Option<TargetMemory> {
    let role = match &known.role {
        Some(role) => Some(role.risk()?),
        None => None,
    };
    let track: Vec<_> = known.track.iter().map(StateDocument::steady).collect();
    let is_past = are_past(track.iter().map(|(time, _)| *time));
    (is_past && are_past(role.iter().map(|risk| risk.time))).then_some(TargetMemory {
        role,
        passed: known.passed,
        track,
    })
}

/// True for times that increase up to 0.
fn are_past(mut times: impl Iterator<Item = f64>) -> bool {
    let mut last = f64::NEG_INFINITY;
    times.all(|time| {
        let before = std::mem::replace(&mut last, time);
        time.is_finite() && time <= tolerance::TIME_S && before <= time + tolerance::TIME_S
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline;
    use crate::replanning::remember;
    use crate::scenario::Scenario;
    use crate::target::{DomainKind, Motion};

    /// What a document gives back, to nine digits: its courses are degrees.
    #[test]
    fn a_document_gives_back_what_its_run_leaves() {
        let file = "scenarios/colregs/stand-on.toml";
        let mut scenario = Scenario::read(file.as_ref()).expect("valid");
        let mut known = 0;
        for _ in 0..3 {
            let run = pipeline::run(scenario.clone());
            let previous = PreviousPlan::of(&run).expect("a plan");
            let mut expected = previous.clone();
            for ship in expected.targets.iter_mut().filter_map(|t| t.ship.as_mut()) {
                // a document has no ship domain
                ship.domain = DomainKind::Hull;
            }
            let found = PreviousPlan::try_from(&PlanDocument::of(&run)).expect("a plan");
            let digits = |plan| format!("{plan:.9?}").replace("-0.000000000", "0.000000000");
            assert_eq!(digits(found), digits(expected));
            known += previous.targets[0].memory.track.len();
            // 30 s later
            let plan = run.planned.outcome.plan().expect("a plan");
            scenario.time += 30.0;
            scenario.own_ship.pose = plan.trajectory.pose_at(30.0);
            scenario.desired = scenario.desired.remaining(30.0);
            if let Motion::Ship(ship) = &mut scenario.targets[0].motion {
                ship.pose = ship.pose_at(30.0);
            }
            remember(&previous, &mut scenario).expect("own ship is on its plan");
        }
        assert!(known > 0);
    }
}
