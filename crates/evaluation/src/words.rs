//! Text for an outcome, a risk, and whether a plan is verified and safe.

use super::Safety;

/// Defines outcomes that begin with those of a plan.
#[doc(hidden)]
#[macro_export]
macro_rules! outcomes {
    (
        $(#[doc = $about:literal])+
        $kind:ident $(from $plan:ident)? $(default $default:ident)? {
            $($(#[doc = $doc:literal])+ $value:ident => $word:literal,)*
        }
    ) => {
        searoom_geometry::words! {
            $(#[doc = $about])+
            pub enum $kind {
                /// A plan that satisfies the whole request.
                Solved => "solved",
                /// A plan that gives up a requirement.
                Relaxed => "relaxed",
                /// No plan.
                Infeasible => "infeasible",
                /// The time budget ran out, with a plan or without.
                Deadline => "deadline",
                $($(#[doc = $doc])+ $value => $word,)*
            }
        }

        $(impl From<$plan> for $kind {
            fn from(outcome: $plan) -> Self {
                match outcome {
                    $plan::Solved => Self::Solved,
                    $plan::Relaxed => Self::Relaxed,
                    $plan::Infeasible => Self::Infeasible,
                    $plan::Deadline => Self::Deadline,
                }
            }
        })?

        $(impl Default for $kind {
            fn default() -> Self {
                Self::$default
            }
        })?
    };
}

outcomes! {
    /// How a run ended.
    PlanOutcome {}
}

outcomes! {
    /// How a run ended, or what a baseline without a planner does.
    CandidateOutcome from PlanOutcome {
        /// A baseline that enters no set.
        Clear => "clear",
        /// A baseline that enters a set.
        Collides => "collides",
    }
}

/// Returns the displayed word for an outcome, according to the safety of the motion.
///
/// `safety` is that of the motion (`None` without a motion), and `risk` the largest risk taken.
pub fn outcome_word(
    outcome: impl Into<CandidateOutcome>,
    safety: Option<Safety>,
    risk: f64,
) -> String {
    let outcome = outcome.into();
    let word = match safety {
        // Sets larger than the hard sets are entered, at a risk above the accepted one.
        Some(Safety::Safe) if outcome == CandidateOutcome::Collides => {
            PlanOutcome::Relaxed.to_string()
        }
        Some(Safety::Collides) => "COLLIDES".to_owned(),
        Some(Safety::Unsafe) => "NOT SAFE".to_owned(),
        Some(Safety::AtRisk) => at_risk(risk),
        Some(Safety::Safe) if risk > 0.0 => at_risk(risk),
        Some(Safety::Safe) | None => return outcome.to_string(),
    };
    match outcome {
        CandidateOutcome::Deadline => format!("{word}, {outcome}"),
        _ => word,
    }
}

/// A waypoint that is passed at more turning radii than this is called skipped. A corner is rounded
/// at less.
const SKIPPED_FROM_RADII: f64 = 2.0;

/// The waypoints that are passed at more than two turning radii, in words; empty if there are none.
/// `distances` are [`super::Evaluation::waypoint_distances`].
pub fn skipped_waypoints(distances: &[f64], turning_radius: f64) -> String {
    let far = SKIPPED_FROM_RADII * turning_radius;
    let skipped = distances.iter().enumerate().filter(|(_, d)| **d > far);
    // the mission's first waypoint is the start
    let words = skipped.map(|(k, distance)| format!("waypoint {} by {distance:.0} m", k + 2));
    words.collect::<Vec<_>>().join(", ")
}

/// The displayed word of a safe plan that gives up the rules.
pub const NOT_BY_THE_RULES: &str = "not by the rules";

/// The displayed word of a plan that may have given up the rules. Only `"relaxed"` says so little
/// that it is replaced.
pub fn without_rules(word: String, gives_up_rules: bool) -> String {
    if gives_up_rules && word == PlanOutcome::Relaxed.word() {
        NOT_BY_THE_RULES.to_owned()
    } else {
        word
    }
}

const AT_RISK: &str = "at risk ";

fn at_risk(risk: f64) -> String {
    format!("{AT_RISK}{}", risk_figure(risk))
}

/// The risk in the displayed word of an outcome, if it has one.
pub fn said_risk(word: &str) -> Option<f64> {
    let figure = word.strip_prefix(AT_RISK)?.split(',').next()?;
    figure.parse().ok()
}

/// Formats a risk with two decimals, rounded up. A positive risk is at least 0.01, and rounding
/// down is limited to 1e-6.
pub fn risk_figure(risk: f64) -> String {
    let hundredths = if risk > 0.0 {
        (risk * 100.0 - 1e-4).ceil().max(1.0)
    } else {
        0.0
    };
    format!("{:.2}", hundredths / 100.0)
}

/// Returns the two properties of a plan, verified and safe, as one text.
pub fn facts(verified: bool, safe: bool) -> &'static str {
    match (verified, safe) {
        (true, true) => "verified, safe",
        (true, false) => "verified, not safe",
        (false, _) => "FAILED ITS VERIFICATION, not safe",
    }
}

#[test]
fn the_word_of_an_outcome_says_the_worst_first() {
    use PlanOutcome::{Deadline, Relaxed};
    for (outcome, safety, risk, word) in [
        (Relaxed, Some(Safety::Collides), 1.0, "COLLIDES"),
        (Relaxed, Some(Safety::AtRisk), 0.2, "at risk 0.20"),
        (Relaxed, Some(Safety::Safe), 0.0, "relaxed"),
        (Deadline, Some(Safety::Unsafe), 1.0, "NOT SAFE, deadline"),
        (Deadline, None, 0.0, "deadline"),
    ] {
        assert_eq!(outcome_word(outcome, safety, risk), word);
    }
}
