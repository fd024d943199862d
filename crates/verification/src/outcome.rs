//! Checks that the outcome, the verdict and the releases of a document agree with its content.

use super::claim::{Claim, ClaimedMotion};
use super::comparison::{Rounding, differences};
use super::mismatch;
use searoom_document::{AmountUnit, PlanMethod, PlanOutcome, RelaxationDocument, RelaxationKind};
use searoom_evaluation::{Evaluation, Violation, outcome_word, without_rules};
use searoom_geometry::tolerance;
use searoom_model::{Compliance, ObjectiveKind, PlannerKind, SearchKind};
use serde::Serialize;

/// The statements of a document on its plan as a whole.
#[derive(Serialize)]
struct Verdict {
    safe: Option<bool>,
    verdict: String,
}

/// Checks the reported safety and verdict against the evaluation.
pub(super) fn safety(claim: &Claim, evaluation: Option<&Evaluation>) -> Vec<Violation> {
    let file = claim.file;
    let risk = file.cost.as_ref().map_or(0.0, |cost| cost.max_risk);
    let word = outcome_word(file.outcome, evaluation.map(|e| e.safety), risk);
    let gives_up_rules = claim.gives_up(RelaxationKind::Compliance);
    let claimed = Verdict {
        safe: file.safe,
        verdict: file.verdict.clone(),
    };
    let proven = Verdict {
        safe: Some(evaluation.is_some_and(Evaluation::safe)),
        verdict: without_rules(word, gives_up_rules),
    };
    differences(&claimed, &proven, &Rounding::new())
}

/// Checks what the document says of its own verification against this one, where this one finds no
/// violation; another document is rejected whatever it says. `verified` is false without a plan.
pub(super) fn earlier(claim: &Claim, verified: bool) -> Vec<Violation> {
    let file = claim.file;
    let mut wrong = Vec::new();
    if file.verified != verified {
        wrong.push(mismatch("verified", file.verified, verified));
    }
    if let Some(first) = file.violations.first() {
        let said = format!("{} of them, first '{}'", file.violations.len(), first.what);
        wrong.push(mismatch("violations", said, "none"));
    }
    wrong
}

/// Outcomes of an answer with a plan or without, by whether it gives up nothing.
pub(super) fn outcomes(has_plan: bool, gives_up_nothing: bool) -> [PlanOutcome; 2] {
    let in_time = match (has_plan, gives_up_nothing) {
        (false, _) => PlanOutcome::Infeasible,
        (true, true) => PlanOutcome::Solved,
        (true, false) => PlanOutcome::Relaxed,
    };
    [in_time, PlanOutcome::Deadline]
}

fn either(words: &[impl ToString]) -> String {
    let words: Vec<String> = words.iter().map(ToString::to_string).collect();
    words.join(" or ")
}

/// Checks outcome, planner and relaxations against the content.
///
/// The outcome must fit the presence of a motion and of relaxations. The planner must fit the parts
/// that only its plans have. Each relaxation occurs at most once, and only where its requirement
/// applies.
pub(super) fn check(claim: &Claim) -> Vec<Violation> {
    let mut found = Vec::new();
    let file = &claim.file;
    let allowed = outcomes(claim.motion.is_some(), file.relaxations.is_empty());
    if !allowed.contains(&file.outcome) {
        found.push(mismatch("outcome", file.outcome, either(&allowed)));
    }
    let mut planner = |wrong: bool, so: &str| {
        if wrong {
            found.push(mismatch("planner", &file.planner, so));
        }
    };
    let forces = claim.planner == PlannerKind::OptimalControl;
    let has_control = file.optimal_control.is_some();
    planner(
        has_control && !forces,
        "that of a document with optimal_control",
    );
    let on_paths = claim.planner == PlannerKind::PathTime;
    let has_diagram = file.path_time.is_some();
    planner(
        has_diagram && !on_paths,
        "that of a document with path_time",
    );
    let of_segments = matches!(claim.motion, Some(ClaimedMotion::Segments(_)));
    planner(forces && of_segments, "that of a plan of segments");
    let objectives: &[ObjectiveKind] = match claim.planner {
        PlannerKind::OptimalControl => &[ObjectiveKind::StageCost],
        PlannerKind::PathTime => &[
            ObjectiveKind::SpaceTimeError,
            ObjectiveKind::Time,
            ObjectiveKind::Length,
            ObjectiveKind::LengthRisk,
        ],
        PlannerKind::SpaceTime => &[ObjectiveKind::SpaceTimeError],
    };
    if !objectives.contains(&file.objective) {
        found.push(mismatch("objective", file.objective, either(objectives)));
    }
    for (index, relaxation) in file.relaxations.iter().enumerate() {
        let what = format!("relaxation of '{}'", relaxation.target);
        let asked = match relaxation.kind {
            RelaxationKind::Compliance => file.compliance == Compliance::Rules,
            RelaxationKind::Domain => file.compliance != Compliance::None,
            RelaxationKind::Arrival => !forces,
            RelaxationKind::Risk => true,
        };
        if !asked {
            let so = format!(
                "not possible with compliance '{}' and planner '{}'",
                file.compliance, file.planner
            );
            found.push(mismatch(&what, relaxation.kind, so));
        }
        let unit = relaxation.kind.unit();
        if relaxation.unit != Some(unit) {
            let said = relaxation.unit.map_or("nothing", AmountUnit::word);
            let so = format!("'{unit}' for '{}'", relaxation.kind);
            found.push(mismatch(&format!("{what}, unit"), said, so));
        }
        if relaxation.kind == RelaxationKind::Domain && relaxation.amount == 0.0 {
            found.push(mismatch(&what, "a domain reduced by 0", "nothing given up"));
        }
        let again =
            |r: &&RelaxationDocument| r.kind == relaxation.kind && r.target == relaxation.target;
        if file.relaxations[..index].iter().any(|r| again(&r)) {
            found.push(mismatch(
                &what,
                format!("'{}' twice", relaxation.kind),
                "given up once",
            ));
        }
    }
    found
}

/// Checks what the document says made its plan against its planner, its search, its statistics and
/// its memory.
pub(super) fn method(claim: &Claim) -> Vec<Violation> {
    let file = &claim.file;
    let mut found = Vec::new();
    let Some(method) = file.method else {
        if claim.motion.is_some() {
            found.push(mismatch("method", "nothing", "that of a plan"));
        }
        return found;
    };
    let mut check = |is_so: bool, so: &str| {
        if !is_so {
            found.push(mismatch("method", method.word(), so));
        }
    };
    check(claim.motion.is_some(), "none without a plan");
    let made_by = match method {
        PlanMethod::OptimalControl => claim.planner == PlannerKind::OptimalControl,
        PlanMethod::PathTimeGraph => claim.planner == PlannerKind::PathTime,
        PlanMethod::LeastHarm | PlanMethod::Remainder => {
            claim.planner != PlannerKind::OptimalControl
        }
        // the planners of this project have methods of their own
        PlanMethod::Other => match claim.planner {
            PlannerKind::SpaceTime | PlannerKind::PathTime | PlannerKind::OptimalControl => false,
        },
        _ => claim.planner == PlannerKind::SpaceTime,
    };
    check(made_by, &format!("another with planner '{}'", file.planner));
    let searches: &[SearchKind] = match method {
        PlanMethod::AStar => &[SearchKind::AStar, SearchKind::Thorough],
        PlanMethod::Dijkstra => &[SearchKind::Dijkstra],
        PlanMethod::Thorough => &[SearchKind::Thorough],
        _ => &[],
    };
    let asked = searches.is_empty() || searches.contains(&file.search);
    check(asked, &format!("another with search '{}'", file.search));
    if let Some(searched) = method.has_statistics() {
        let so = match searched {
            true => "another without search_stats",
            false => "another with search_stats",
        };
        check(file.search_stats.expanded.is_some() == searched, so);
    }
    if method == PlanMethod::Rules {
        let gives_up = claim.gives_up(RelaxationKind::Compliance);
        let by_rules = file.compliance == Compliance::Rules && !gives_up;
        check(
            by_rules,
            "another where the rules are not asked or given up",
        );
    }
    if let Some(memory) = &file.memory {
        let is_kept = method == PlanMethod::Remainder;
        let so = format!("another with memory.keeps_plan {}", memory.keeps_plan);
        check(is_kept == memory.keeps_plan, &so);
    }
    found
}

/// Outcomes of a plan that may enter a set.
const OUTCOMES: [PlanOutcome; 2] = [PlanOutcome::Relaxed, PlanOutcome::Deadline];

/// Returns released sets that the document does not report correctly: outcome, kind, amount and
/// time.
pub(super) fn releases(claim: &Claim) -> Vec<Violation> {
    let mut found = Vec::new();
    let released = claim.file.relaxations.iter();
    for (relaxation, until) in released.filter_map(|r| Some((r, r.until_s?))) {
        let of = |key: &str| format!("relaxation of '{}', {key}", relaxation.target);
        if !OUTCOMES.contains(&claim.file.outcome) {
            let so = either(&OUTCOMES);
            found.push(mismatch("outcome", claim.file.outcome, so));
        }
        if relaxation.kind != RelaxationKind::Risk {
            let so = RelaxationKind::Risk;
            found.push(mismatch(&of("kind"), relaxation.kind, so));
        }
        if claim.file.max_risk > 0.0 {
            found.push(mismatch("max_risk", claim.file.max_risk, 0.0));
        }
        // Own ship may start on the edge of the set.
        if !(relaxation.amount >= 0.0 && relaxation.amount <= 1.0) {
            found.push(mismatch(&of("amount"), relaxation.amount, "from 0 to 1"));
        }
        let end = match &claim.motion {
            Some(ClaimedMotion::Segments(segments)) => segments.last().map(|s| s.end_time()),
            Some(ClaimedMotion::Steered { .. }) | None => None,
        };
        let end = end.unwrap_or(0.0).min(claim.file.horizon_s);
        // The document makes no claim about a ship that has arrived.
        let end = if end > 0.0 { end } else { claim.file.horizon_s };
        // Negated on purpose: a NaN fails.
        if !(until > 0.0 && until <= end + tolerance::TIME_S * (1.0 + end)) {
            let so = format!("above 0, at most {end}");
            found.push(mismatch(&of("until_s"), until, so));
        }
    }
    found
}
