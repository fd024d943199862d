//! Documents of the results.

use super::{SimulationVerification, Verification};
use searoom_document::{MarginDocument, VerifiedPlanDocument, ViolationDocument, finite};

impl From<&Verification> for VerifiedPlanDocument {
    /// The entry of a checked document, without its file.
    fn from(checked: &Verification) -> Self {
        let evaluation = checked.evaluation.as_ref();
        let passages = evaluation.map_or(&[][..], |e| &e.passages);
        let land = evaluation.filter(|e| e.min_land_distance.is_finite());
        Self {
            scenario: Some(checked.scenario.clone()),
            planner: Some(checked.planner.clone()),
            outcome: checked.outcome.into(),
            verified: checked.verified(),
            safe: checked.safe(),
            violations: ViolationDocument::all(&checked.violations),
            targets: (checked.targets.iter().zip(&checked.claimed_from))
                .zip(passages)
                .map(|((target, claimed_from), passage)| MarginDocument {
                    target: target.clone(),
                    claimed_from_s: *claimed_from,
                    min_margin_m: finite(passage.min_margin),
                    min_margin_t_s: finite(passage.min_margin_time),
                    min_clearance_m: finite(passage.min_clearance),
                    dcpa_m: finite(passage.dcpa),
                    tcpa_s: finite(passage.tcpa),
                })
                .collect(),
            out_of_reach: checked.out_of_reach,
            min_land_distance_m: land.map(|e| e.min_land_distance),
            min_land_distance_t_s: land.map(|e| e.min_land_distance_time),
            ..Self::default()
        }
    }
}

impl From<&SimulationVerification> for VerifiedPlanDocument {
    /// The entry of a checked simulation, without its file.
    fn from(checked: &SimulationVerification) -> Self {
        let verified = checked.violations.is_empty();
        Self {
            scenario: Some(checked.scenario.clone()),
            outcome: checked.outcome(),
            verified,
            safe: verified && checked.safe,
            violations: ViolationDocument::all(&checked.violations),
            ..Self::default()
        }
    }
}
