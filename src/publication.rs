//! The plan document of a run, with what the verification finds in it.

use crate::document::{PlanDocument, ViolationDocument, unverified};
use crate::evaluation::{Safety, Violation, outcome_word};
use crate::pipeline::Run;
use crate::verification::verify_evaluated;

impl From<&Run> for PlanDocument {
    /// Builds the document of a run. `verified` and `violations` are what the checks of `verify` find
    /// in this document, with the evaluation of the run. A plan that fails is not safe.
    fn from(run: &Run) -> Self {
        let mut document = unverified(run);
        let (Some(evaluation), Some(safety)) = (&run.evaluation, run.safety()) else {
            return document;
        };
        let found = match verify_evaluated(&document, evaluation) {
            Ok(found) => found.violations,
            Err(error) => vec![Violation::new(error.to_string(), 0.0)],
        };
        document.verified = found.is_empty();
        if !document.verified {
            let (safety, risk) = (safety.max(Safety::Unsafe), run.greatest_risk());
            document.verdict = outcome_word(document.outcome, Some(safety), risk);
            document.safe = Some(false);
        }
        document.violations = ViolationDocument::all(&found);
        document
    }
}
