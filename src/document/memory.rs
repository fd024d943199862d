//! Memory that a plan leaves to the next one.

use searoom_document::{
    KnownRoleDocument, MemoryDocument, PlannedManoeuvreDocument, SegmentDocument, StateDocument,
    TargetMemoryDocument,
};

use crate::frame::{
    clockwise_deg, course_deg_from_heading, heading_from_course_deg, radians_from_deg,
};
use crate::pipeline::Run;
use crate::planner::PlannedManoeuvre;

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
pub(crate) fn planned_manoeuvre(document: &PlannedManoeuvreDocument) -> PlannedManoeuvre {
    PlannedManoeuvre {
        begins: document.begins_s,
        returns: document.returns_s,
        joins: document.joins_s,
        first_heading: heading_from_course_deg(document.first_course_deg),
        turn: -radians_from_deg(document.turn_deg),
    }
}
