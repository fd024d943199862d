//! Is a plan that enters a set said to be one?
//!
//! Of such a set nothing is claimed until the plan has left it. That is for a plan at the worst
//! alone: it has to say so, and to be in the set before.

use super::claim::{Claim, ClaimedMotion};
use super::untrue;
use crate::evaluation::Violation;
use crate::tolerance;

/// What of an answer that enters sets may be a plan's.
const OUTCOMES: [&str; 2] = ["relaxed", "deadline"];
const KIND: &str = "risk";

/// Every release of a set that is not owned up to, or not needed.
pub(super) fn check(claim: &Claim) -> Vec<Violation> {
    let mut found = Vec::new();
    let released = claim.file.relaxations.iter();
    for (given_up, until) in released.filter_map(|r| Some((r, r.until_s?))) {
        let of = |key: &str| format!("relaxation of '{}', {key}", given_up.target);
        if !OUTCOMES.contains(&claim.file.outcome.as_str()) {
            found.push(untrue(
                "outcome",
                &claim.file.outcome,
                OUTCOMES.join(" or "),
            ));
        }
        if given_up.kind != KIND {
            found.push(untrue(&of("kind"), &given_up.kind, KIND));
        }
        if claim.file.max_risk > 0.0 {
            found.push(untrue("max_risk", claim.file.max_risk, 0.0));
        }
        // own ship may begin on its very edge
        if !(given_up.amount >= 0.0 && given_up.amount <= 1.0) {
            found.push(untrue(&of("amount"), given_up.amount, "from 0 to 1"));
        }
        let end = match &claim.motion {
            Some(ClaimedMotion::Segments(segments)) => segments.last().map(|s| s.end_time()),
            Some(ClaimedMotion::Steered { .. }) | None => None,
        };
        let end = end.unwrap_or(0.0).min(claim.file.horizon_s);
        // of a ship that has arrived nothing is claimed at all
        let end = if end > 0.0 { end } else { claim.file.horizon_s };
        // negated on purpose: a NaN is never
        if !(until > 0.0 && until <= end + tolerance::TIME_S * (1.0 + end)) {
            found.push(untrue(
                &of("until_s"),
                until,
                format!("above 0, at most {end}"),
            ));
        }
    }
    found
}
