//! Checks that the outcome, the verdict and the releases of a document agree with its content.

use super::claim::{ARRIVAL, Claim, ClaimedMotion, OPTIMAL_CONTROL, PATH_TIME, SPACE_TIME};
use super::mismatch;
use searoom_document::{PlanMethod, RelaxationDocument};
use searoom_evaluation::{Evaluation, Violation, outcome_word, without_rules};
use searoom_geometry::tolerance;

/// Checks the reported safety and verdict against the evaluation.
pub(super) fn safety(claim: &Claim, evaluation: Option<&Evaluation>) -> Vec<Violation> {
    let file = &claim.file;
    let mut found = Vec::new();
    let safe = evaluation.is_some_and(Evaluation::safe);
    if file.safe != Some(safe) {
        let said = file
            .safe
            .map_or("nothing".to_owned(), |said| said.to_string());
        found.push(mismatch("safe", said, safe));
    }
    let risk = file.cost.as_ref().map_or(0.0, |cost| cost.max_risk);
    let word = outcome_word(&file.outcome, evaluation.map(|e| e.safety), risk);
    let gives_up_rules = file.relaxations.iter().any(|r| r.kind == "compliance");
    let word = without_rules(word, gives_up_rules);
    if file.verdict != word {
        let said = match file.verdict.as_str() {
            "" => "nothing",
            said => said,
        };
        found.push(mismatch("verdict", said, word));
    }
    found
}

/// Outcomes of an answer with a plan or without, by whether it gives up nothing.
pub(super) fn outcomes(has_plan: bool, gives_up_nothing: bool) -> [&'static str; 2] {
    match (has_plan, gives_up_nothing) {
        (false, _) => ["infeasible", "deadline"],
        (true, true) => ["solved", "deadline"],
        (true, false) => ["relaxed", "deadline"],
    }
}

/// Checks outcome, planner and relaxations against the content.
///
/// The outcome must fit the presence of a motion and of relaxations. The planner must fit the parts
/// that only its plans have. Each relaxation occurs at most once, and only where its requirement
/// applies.
pub(super) fn check(claim: &Claim) -> Vec<Violation> {
    let mut found = Vec::new();
    let file = &claim.file;
    let outcome = file.outcome.as_str();
    let allowed = outcomes(claim.motion.is_some(), file.relaxations.is_empty());
    if !allowed.contains(&outcome) {
        found.push(mismatch("outcome", outcome, allowed.join(" or ")));
    }
    let mut planner = |wrong: bool, so: &str| {
        if wrong {
            found.push(mismatch("planner", &file.planner, so));
        }
    };
    let forces = file.planner == OPTIMAL_CONTROL;
    let has_control = file.optimal_control.is_some();
    planner(
        has_control && !forces,
        "that of a document with optimal_control",
    );
    let on_paths = file.planner == PATH_TIME;
    let has_diagram = file.path_time.is_some();
    planner(
        has_diagram && !on_paths,
        "that of a document with path_time",
    );
    let of_segments = matches!(claim.motion, Some(ClaimedMotion::Segments(_)));
    planner(forces && of_segments, "that of a plan of segments");
    let objectives: &[&str] = match file.planner.as_str() {
        OPTIMAL_CONTROL => &["stage-cost"],
        PATH_TIME => &["space-time-error", "time", "length", "length-risk"],
        _ => &["space-time-error"],
    };
    if !objectives.contains(&file.objective.as_str()) {
        let so = objectives.join(" or ");
        found.push(mismatch("objective", &file.objective, so));
    }
    for (index, relaxation) in file.relaxations.iter().enumerate() {
        let what = format!("relaxation of '{}'", relaxation.target);
        let asked = match relaxation.kind.as_str() {
            "compliance" => file.compliance == "rules",
            "domain" => file.compliance != "none",
            ARRIVAL => !forces,
            _ => true,
        };
        if !asked {
            let so = format!(
                "not possible with compliance '{}' and planner '{}'",
                file.compliance, file.planner
            );
            found.push(mismatch(&what, &relaxation.kind, so));
        }
        if relaxation.kind == "domain" && relaxation.amount == 0.0 {
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
/// its memory. An old document does not say it.
pub(super) fn method(claim: &Claim) -> Vec<Violation> {
    let file = &claim.file;
    let Some(method) = file.method else {
        return Vec::new();
    };
    let mut found = Vec::new();
    let mut check = |is_so: bool, so: &str| {
        if !is_so {
            found.push(mismatch("method", method.word(), so));
        }
    };
    check(claim.motion.is_some(), "none without a plan");
    let made_by = match method {
        PlanMethod::OptimalControl => file.planner == OPTIMAL_CONTROL,
        PlanMethod::PathTimeGraph => file.planner == PATH_TIME,
        PlanMethod::LeastHarm | PlanMethod::Remainder => file.planner != OPTIMAL_CONTROL,
        PlanMethod::Other => {
            ![OPTIMAL_CONTROL, PATH_TIME, SPACE_TIME].contains(&file.planner.as_str())
        }
        _ => ![OPTIMAL_CONTROL, PATH_TIME].contains(&file.planner.as_str()),
    };
    check(made_by, &format!("another with planner '{}'", file.planner));
    let searches: &[&str] = match method {
        PlanMethod::AStar => &["a-star", "thorough"],
        PlanMethod::Dijkstra => &["dijkstra"],
        PlanMethod::Thorough => &["thorough"],
        _ => &[],
    };
    let asked = searches.is_empty() || searches.contains(&file.search.as_str());
    check(asked, &format!("another with search '{}'", file.search));
    if let Some(searched) = method.has_statistics() {
        let so = match searched {
            true => "another without search_stats",
            false => "another with search_stats",
        };
        check(file.search_stats.expanded.is_some() == searched, so);
    }
    if method == PlanMethod::Rules {
        let gives_up = file.relaxations.iter().any(|r| r.kind == "compliance");
        let by_rules = file.compliance == "rules" && !gives_up;
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
const OUTCOMES: [&str; 2] = ["relaxed", "deadline"];
const RISK: &str = "risk";

/// Returns released sets that the document does not report correctly: outcome, kind, amount and
/// time.
pub(super) fn releases(claim: &Claim) -> Vec<Violation> {
    let mut found = Vec::new();
    let released = claim.file.relaxations.iter();
    for (relaxation, until) in released.filter_map(|r| Some((r, r.until_s?))) {
        let of = |key: &str| format!("relaxation of '{}', {key}", relaxation.target);
        if !OUTCOMES.contains(&claim.file.outcome.as_str()) {
            let so = OUTCOMES.join(" or ");
            found.push(mismatch("outcome", &claim.file.outcome, so));
        }
        if relaxation.kind != RISK {
            found.push(mismatch(&of("kind"), &relaxation.kind, RISK));
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
