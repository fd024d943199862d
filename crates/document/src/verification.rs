//! Results of checking plan documents.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parts::ViolationDocument;
use searoom_evaluation::PlanOutcome;

searoom_evaluation::outcomes! {
    /// Outcome of a checked plan or simulation, or why there is none.
    VerifiedOutcome from PlanOutcome default Unreadable {
        /// A simulation in which hulls met.
        Contact => "contact",
        /// A simulation without a contact, where every plan was safe and in time.
        Safe => "no contact, safe",
        /// A simulation without a contact, with a plan that was not safe or late.
        NotSafe => "no contact, not safe",
        /// A file that is no document.
        Unreadable => "unreadable",
        /// A document whose check exceeded the time limit.
        Unproven => "unproven",
    }
}

/// All requested documents, in order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VerificationDocument {
    pub plans: Vec<VerifiedPlanDocument>,
    pub verified: usize,
    pub safe: usize,
}

/// One document. Unknown values of an unreadable or unproven one are null.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VerifiedPlanDocument {
    pub file: String,
    pub scenario: Option<String>,
    pub planner: Option<String>,
    pub outcome: VerifiedOutcome,
    pub error: Option<String>,
    pub verified: bool,
    pub safe: bool,
    pub violations: Vec<ViolationDocument>,
    pub targets: Vec<MarginDocument>,
    /// Number of targets that the plan does not consider.
    #[serde(default, skip_serializing_if = "is_zero_count")]
    pub out_of_reach: usize,
    pub min_land_distance_m: Option<f64>,
    pub min_land_distance_t_s: Option<f64>,
}

fn is_zero_count(count: &usize) -> bool {
    *count == 0
}

/// Margins to one target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MarginDocument {
    pub target: String,
    pub claimed_from_s: f64,
    pub min_margin_m: Option<f64>,
    pub min_margin_t_s: Option<f64>,
    pub min_clearance_m: Option<f64>,
    pub dcpa_m: Option<f64>,
    pub tcpa_s: Option<f64>,
}

impl VerificationDocument {
    /// Builds the document with its summary.
    pub fn of(plans: Vec<VerifiedPlanDocument>) -> Self {
        let verified = plans.iter().filter(|plan| plan.verified).count();
        let safe = plans.iter().filter(|plan| plan.safe).count();
        Self {
            plans,
            verified,
            safe,
        }
    }
}

impl std::fmt::Display for VerificationDocument {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (documents, verified, safe) = (self.plans.len(), self.verified, self.safe);
        write!(f, "{documents} documents: {verified} verified, {safe} safe")?;
        let unread = self.plans.iter().filter(|plan| plan.error.is_some());
        let unread = unread.count();
        for (count, name) in [
            (documents - verified - unread, "rejected"),
            (unread, "unreadable or not proven"),
        ] {
            if count > 0 {
                write!(f, ", {count} {name}")?;
            }
        }
        Ok(())
    }
}

impl VerifiedPlanDocument {
    /// The entry of a checked plan document: `checked` is the verification of it.
    pub fn of(file: String, checked: impl Into<Self>) -> Self {
        Self {
            file,
            ..checked.into()
        }
    }

    /// The entry of a checked simulation.
    pub fn of_simulation(file: String, checked: impl Into<Self>) -> Self {
        Self::of(file, checked)
    }

    /// Builds the entry of a file whose check exceeded its time limit.
    pub fn unproven(file: String, error: String) -> Self {
        Self {
            outcome: VerifiedOutcome::Unproven,
            ..Self::unreadable(file, error)
        }
    }

    /// Builds the entry of a file that is not a plan document.
    pub fn unreadable(file: String, error: String) -> Self {
        Self {
            file,
            outcome: VerifiedOutcome::Unreadable,
            error: Some(error),
            ..Self::default()
        }
    }
}
