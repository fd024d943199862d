#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

#[cfg(test)]
#[path = "../../geometry/src/geometry_fixtures.rs"]
mod geometry_fixtures;

mod claim;
mod comparison;
mod coverage;
mod cycles;
mod document;
mod figures;
mod motion;
mod out_of_reach;
mod outcome;
mod reached;
mod risk;
mod samples;
mod sets;
mod simulation;

pub use claim::ClaimError;
pub use simulation::{SimulationVerification, is_simulation, verify_simulations};

use claim::{Claim, ClaimedMotion};

use searoom_document::{PlanDocument, PlanOutcome};
use searoom_evaluation::{
    Evaluation, Freedom, Request, Steering, Violation, evaluate, evaluate_steered,
};
use searoom_input::text::short_numbers;
use searoom_model::trajectory::Segment;

/// Result of the verification of a plan document.
#[derive(Debug, Clone, PartialEq)]
pub struct Verification {
    /// Title of the scenario.
    pub scenario: String,
    /// Name of the planner.
    pub planner: String,
    /// Outcome that the document reports.
    pub outcome: PlanOutcome,
    /// Accepted risk, in `[0, 1)`.
    pub max_risk: f64,
    /// Own ship's turning radius, metres.
    pub turning_radius: f64,
    /// Largest risk taken according to the document; 0 without a plan.
    pub risk_taken: f64,
    /// Names of the targets, in the document's order, which is that of the encounters.
    pub targets: Vec<String>,
    /// Time from which each target's set is valid, seconds, in the order of `targets`; 0 without a
    /// release.
    pub claimed_from: Vec<f64>,
    /// Evaluation of the motion; `None` for a document without one.
    pub evaluation: Option<Evaluation>,
    /// Number of segments, or of intervals between nodes.
    pub pieces: usize,
    /// Number of sets checked.
    pub sets: usize,
    /// Number of land polygons.
    pub land: usize,
    /// Number of targets that the plan does not consider.
    pub out_of_reach: usize,
    /// All violations, in order of time.
    pub violations: Vec<Violation>,
}

impl Verification {
    /// Returns true for a plan without violations; false without a plan.
    pub fn verified(&self) -> bool {
        self.evaluation.is_some() && self.violations.is_empty()
    }

    /// Returns true for a verified plan that enters no hard set, hull or land from start to
    /// arrival.
    pub fn safe(&self) -> bool {
        self.verified() && self.evaluation.as_ref().is_some_and(Evaluation::safe)
    }
}

/// Verifies the text of a plan document.
///
/// Takes some milliseconds: O(segments (vertices of sets + edges of land)), and probes near the
/// least distances. The error is for a text that is no valid plan document: it names the field, the
/// value found and the allowed values.
///
/// ```
/// use searoom_verification::{ClaimError, Verification, verify};
///
/// let document = include_str!("../examples/head-on.json");
/// let found: Verification = verify(document)?;
/// assert!(found.verified() && found.safe());
/// // a figure that contradicts the motion
/// let mut altered: serde_json::Value = serde_json::from_str(document).expect("JSON");
/// altered["cost"]["length_m"] = 1600.0.into();
/// assert!(!verify(&altered.to_string())?.verified());
/// assert!(verify("{}").is_err());
/// # Ok::<(), ClaimError>(())
/// ```
///
/// ```
/// use searoom_verification::verify;
/// let error = verify("{\"format\": \"searoom-plan/1\"}").expect_err("nothing in it");
/// assert!(error.to_string().contains("scenario"));
/// ```
pub fn verify(text: &str) -> Result<Verification, ClaimError> {
    verify_document(&claim::parse(text)?)
}

/// Verifies a plan document that is not a text, as [`verify`] does after parsing.
pub fn verify_document(file: &PlanDocument) -> Result<Verification, ClaimError> {
    let claim = Claim::of(file)?;
    let evaluation = evaluation(&claim);
    let mut found = verified(&claim, evaluation);
    if found.violations.is_empty() {
        found.violations = outcome::earlier(&claim, found.verified());
    }
    Ok(found)
}

/// Verifies a plan document whose motion has been evaluated already, as [`evaluate`] does with the
/// request of the document. All other checks are those of [`verify`], except that `verified` and
/// `violations` of the document are ignored, because they are to be filled with this result.
///
/// For the program that made the document, and has the evaluation: to evaluate the motion again
/// would take a quarter of the time of a plan. The evaluation is trusted, so use [`verify`] for
/// documents of others.
pub fn verify_evaluated(
    file: &PlanDocument,
    evaluation: &Evaluation,
) -> Result<Verification, ClaimError> {
    Ok(verified(&Claim::of(file)?, Some(evaluation.clone())))
}

fn evaluation(claim: &Claim) -> Option<Evaluation> {
    let request = request(claim);
    claim.motion.as_ref().map(|motion| match motion {
        ClaimedMotion::Segments(_) => evaluate(&request),
        ClaimedMotion::Steered {
            motion,
            vessel,
            force_limits,
            start_velocity,
            ..
        } => evaluate_steered(
            &request,
            &Steering {
                motion,
                vessel: vessel.exact(claim.own.hull.length).as_ref(),
                force_limits: *force_limits,
                start_velocity: *start_velocity,
            },
        ),
    })
}

fn verified(claim: &Claim, evaluation: Option<Evaluation>) -> Verification {
    let mut violations = claim.faults.clone();
    let request = request(claim);
    violations.extend(coverage::check(claim));
    violations.extend(out_of_reach::check(claim));
    violations.extend(outcome::releases(claim));
    violations.extend(outcome::check(claim));
    violations.extend(outcome::method(claim));
    violations.extend(outcome::safety(claim, evaluation.as_ref()));
    if let (Some(evaluation), Some(motion)) = (&evaluation, &claim.motion) {
        violations.extend(evaluation.violations.iter().cloned());
        if motion.is_sound() {
            violations.extend(figures::check(claim, evaluation));
            violations.extend(risk::check(claim, &request));
            violations.extend(samples::check(claim, motion));
        }
    }
    let claimed_from = |name: &str| {
        let own = claim.sets.iter().filter(|set| set.name == name);
        own.map(|set| set.from).fold(0.0, f64::max)
    };
    for violation in &mut violations {
        violation.what = short_numbers(&violation.what);
    }
    // A NaN time sorts last.
    violations.sort_by(|a, b| a.time.total_cmp(&b.time));
    Verification {
        scenario: claim.file.scenario.clone(),
        planner: claim.file.planner.clone(),
        outcome: claim.file.outcome,
        max_risk: claim.file.max_risk,
        turning_radius: claim.own.turning_radius,
        risk_taken: claim.file.cost.as_ref().map_or(0.0, |cost| cost.max_risk),
        targets: claim.targets.iter().map(|t| t.name.clone()).collect(),
        claimed_from: claim
            .targets
            .iter()
            .map(|t| claimed_from(&t.name))
            .collect(),
        pieces: claim.motion.as_ref().map_or(0, ClaimedMotion::pieces),
        sets: claim.sets.len(),
        land: claim.land.len(),
        out_of_reach: (claim.file.out_of_reach.as_ref()).map_or(0, |listed| listed.rows.len()),
        evaluation,
        violations,
    }
}

/// The plan of a document that verifies; otherwise why it is not one.
pub fn verified_plan(text: &str) -> Result<PlanDocument, String> {
    let words = |error: ClaimError| error.to_string();
    let file = claim::parse(text).map_err(words)?;
    match verify_document(&file).map_err(words)?.violations.first() {
        Some(violation) => Err(format!("not a plan that verifies: {}", violation.what)),
        None => Ok(file),
    }
}

fn request<'a>(claim: &'a Claim) -> Request<'a> {
    let segments: &[Segment] = match &claim.motion {
        Some(ClaimedMotion::Segments(segments)) => segments,
        Some(ClaimedMotion::Steered { .. }) | None => &[],
    };
    Request {
        segments,
        own: &claim.own,
        freedom: match &claim.paths {
            Some(paths) if claim.gives_up_arrival() => Freedom::PathsToHorizon(paths),
            Some(paths) => Freedom::Paths(paths),
            None if claim.gives_up_arrival() => Freedom::LimitsWithoutArrival,
            None => Freedom::Limits,
        },
        desired: &claim.desired,
        targets: &claim.targets,
        sets: &claim.sets,
        land: &claim.land,
        land_margin: claim.file.own_ship.land_margin_m,
        horizon: claim.file.horizon_s,
        arrival_hold: claim.arrival_hold(),
        stay: claim.file.mission.stay_until_s,
        time_weight: claim.file.time_weight_m2_per_s2,
        max_risk: claim.file.max_risk,
    }
}

/// Violation for a false statement in the document: the quantity, the reported value and the true
/// value.
fn mismatch(
    quantity: &str,
    reported: impl std::fmt::Display,
    actual: impl std::fmt::Display,
) -> Violation {
    Violation::new(
        format!("{quantity}: the document says {reported}, it is {actual}"),
        0.0,
    )
}
