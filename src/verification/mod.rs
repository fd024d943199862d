//! Checks a plan document alone: without the scenario, the map or the planner that it came from.
//!
//! A document holds the motion, own ship and her limits, the mission, the targets as they are
//! known, the sets that were kept out of, and the pieces of land within reach. From these
//! [`verify`] proves anew
//!
//! - that the motion starts where own ship is, has no gap, keeps her turning radius, speeds or
//!   paths (or, under forces, her dynamics and her forces), and arrives in time;
//! - that it keeps out of every set, of every hull that a target may have, and of the land, in
//!   continuous time, with certified distances ([`crate::evaluation`]);
//! - that the sets are not too small: each contains the target's hull, the margin and the
//!   uncertainty, and every velocity that she may take;
//! - that it says of the motion what is true of it: whether it is safe, costs, risks, samples,
//!   encounters, path-time profile, the hold and the escape of a ship that stands on.
//!
//! No planner, obstacle or contact test is used here; the document is read by a mirror of its own.
//! Shared with them are geometry, segments, and the hull and the velocity sets of a tracked ship
//! (`target`).

mod claim;
mod coverage;
mod encounters;
mod escape;
mod figures;
mod file;
mod motion;
mod outcome;
mod reached;
mod risk;
mod samples;
mod sets;
mod undisturbed;

pub use claim::{ClaimError, ClaimFault};

use claim::{Claim, ClaimedMotion};

use crate::evaluation::{
    Evaluation, Freedom, Request, Steering, Violation, evaluate, evaluate_steered,
};
use crate::trajectory::Segment;

/// The name of the format that can be checked.
pub const FORMAT: &str = "searoom-plan/1";

/// What became of a plan document.
///
/// ```
/// use searoom::pipeline;
/// use searoom::document::PlanDocument;
/// use searoom::scenario::Scenario;
/// use searoom::verification::{ClaimError, Verification, verify};
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref()).expect("no faults");
/// let document = PlanDocument::of(&pipeline::run(scenario));
/// let document = serde_json::to_string_pretty(&document).expect("JSON");
/// let found: Verification = verify(&document)?;
/// assert!(found.verified() && found.safe());
/// // a figure that the motion does not bear out
/// let mut altered: serde_json::Value = serde_json::from_str(&document).expect("JSON");
/// altered["cost"]["length_m"] = 1600.0.into();
/// assert!(!verify(&altered.to_string())?.verified());
/// assert!(verify("{}").is_err());
/// # Ok::<(), ClaimError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Verification {
    /// Title of the scenario.
    pub scenario: String,
    /// Who planned.
    pub planner: String,
    /// What the document says came out.
    pub outcome: String,
    /// The risk that the plan was allowed, in `[0, 1)`.
    pub max_risk: f64,
    /// The largest risk that the document says is taken; 0 without a plan.
    pub risk_taken: f64,
    /// Names of the targets, in the document's order: that of the passages.
    pub targets: Vec<String>,
    /// Seconds, per target in the same order: of her set nothing is claimed before; 0 where all is.
    pub claimed_from: Vec<f64>,
    /// The judgement of the motion; `None` for a document without one.
    pub evaluation: Option<Evaluation>,
    /// Segments, or intervals between nodes.
    pub pieces: usize,
    /// Sets that were checked, and pieces of land.
    pub sets: usize,
    /// Convex pieces.
    pub land: usize,
    /// Everything that is wrong, in order of time.
    pub violations: Vec<Violation>,
}

impl Verification {
    /// True for a plan in which nothing was found wrong; false without a plan.
    pub fn verified(&self) -> bool {
        self.evaluation.is_some() && self.violations.is_empty()
    }

    /// True for a verified plan that enters no hard set, hull or land from start to arrival.
    pub fn safe(&self) -> bool {
        self.verified() && self.evaluation.as_ref().is_some_and(Evaluation::safe)
    }
}

/// Checks the text of a plan document. The error is for what is no plan document at all: it names
/// the field, what was found and what is allowed. Some milliseconds; O(segments (vertices of sets +
/// edges of land)) and probes near the least distances.
///
/// ```
/// use searoom::verification::verify;
/// let error = verify("{\"format\": \"searoom-plan/1\"}").expect_err("nothing in it");
/// assert!(error.to_string().contains("scenario"));
/// ```
pub fn verify(text: &str) -> Result<Verification, ClaimError> {
    let claim = Claim::read(text)?;
    let mut violations = claim.faults.clone();
    let request = request(&claim);
    let evaluation = claim.motion.as_ref().map(|motion| match motion {
        ClaimedMotion::Segments(_) => evaluate(&request),
        ClaimedMotion::Steered {
            motion,
            vessel,
            force_limits,
            ..
        } => evaluate_steered(
            &request,
            &Steering {
                motion,
                vessel: vessel.exact(claim.own.hull.length).as_ref(),
                force_limits: *force_limits,
            },
        ),
    });
    violations.extend(coverage::check(&claim));
    violations.extend(outcome::releases(&claim));
    violations.extend(outcome::check(&claim));
    violations.extend(outcome::safety(&claim, evaluation.as_ref()));
    if let (Some(evaluation), Some(motion)) = (&evaluation, &claim.motion) {
        violations.extend(evaluation.violations.iter().cloned());
        if motion.is_sound() {
            violations.extend(figures::check(&claim, evaluation));
            violations.extend(risk::check(&claim, &request));
            violations.extend(escape::check(&claim, evaluation, &request));
            violations.extend(samples::check(&claim, motion));
            violations.extend(encounters::check(&claim, motion, evaluation));
        }
        violations.extend(undisturbed::check(&claim));
    }
    let claimed_from = |name: &str| {
        let own = claim.sets.iter().filter(|set| set.name == name);
        own.map(|set| set.from).fold(0.0, f64::max)
    };
    // a NaN has no place in time and goes last
    violations.sort_by(|a, b| a.time.total_cmp(&b.time));
    Ok(Verification {
        scenario: claim.file.scenario.clone(),
        planner: claim.file.planner.clone(),
        outcome: claim.file.outcome.clone(),
        max_risk: claim.file.max_risk,
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
        evaluation,
        violations,
    })
}

fn request(claim: &Claim) -> Request<'_> {
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
            None => Freedom::Limits,
        },
        desired: &claim.desired,
        targets: &claim.targets,
        sets: &claim.sets,
        land: &claim.land,
        land_margin: claim.file.own_ship.land_margin_m,
        horizon: claim.file.horizon_s,
        arrival_hold: claim.arrival_hold(),
        time_weight: claim.file.time_weight_m2_per_s2,
        max_risk: claim.file.max_risk,
    }
}

/// Notes what a document says wrongly: the quantity, what was found and what is so.
fn untrue(what: &str, said: impl std::fmt::Display, so: impl std::fmt::Display) -> Violation {
    Violation {
        what: format!("{what}: the document says {said}, it is {so}"),
        time: 0.0,
    }
}
