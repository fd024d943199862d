//! The words that people see for how something ended, and for the two facts of a plan.

use super::Safety;

/// What a word says: good, bad or neither.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tone {
    Plain,
    Good,
    Fair,
    Bad,
}

/// The word that people see for how something ended, by what happens to hulls: `ended` is the word of the documents (of a baseline also
/// `"clear"`, or `"collides"` where it enters a set), `safety` what is entered, `None` without a motion, `risk` the largest that is taken.
///
/// # Examples
///
/// ```
/// use searoom::evaluation::Safety;
/// use searoom::evaluation::outcome_word;
///
/// assert_eq!(outcome_word("relaxed", Some(Safety::Collides), 1.0), "COLLIDES");
/// assert_eq!(outcome_word("relaxed", Some(Safety::AtRisk), 0.2), "at risk 0.20");
/// assert_eq!(outcome_word("relaxed", Some(Safety::Safe), 0.0), "relaxed");
/// assert_eq!(outcome_word("deadline", Some(Safety::Unsafe), 1.0), "NOT SAFE, deadline");
/// assert_eq!(outcome_word("deadline", None, 0.0), "deadline");
/// ```
pub fn outcome_word(ended: &str, safety: Option<Safety>, risk: f64) -> String {
    outcome(ended, safety, risk).0
}

/// [`outcome_word`], and what it says.
pub(crate) fn outcome(ended: &str, safety: Option<Safety>, risk: f64) -> (String, Tone) {
    let (word, tone) = match safety {
        // more than the hard sets is entered, at a risk that nobody accepted
        Some(Safety::Safe) if ended == "collides" => ("relaxed".to_owned(), Tone::Fair),
        Some(Safety::Collides) => ("COLLIDES".to_owned(), Tone::Bad),
        Some(Safety::Unsafe) => ("NOT SAFE".to_owned(), Tone::Bad),
        Some(Safety::AtRisk) => (at_risk(risk), Tone::Fair),
        Some(Safety::Safe) if risk > 0.0 => (at_risk(risk), Tone::Fair),
        Some(Safety::Safe) | None => {
            let tone = match ended {
                "solved" | "clear" => Tone::Good,
                "relaxed" => Tone::Fair,
                "not-applicable" => Tone::Plain,
                _ => Tone::Bad,
            };
            return (ended.replace('-', " "), tone);
        }
    };
    match ended {
        "deadline" => (format!("{word}, {ended}"), Tone::Bad),
        _ => (word, tone),
    }
}

fn at_risk(risk: f64) -> String {
    format!("at risk {}", risk_figure(risk))
}

/// With two decimals. What is more than none is at least a hundredth, and none is rounded down by more than rounding.
pub(crate) fn risk_figure(risk: f64) -> String {
    let hundredths = if risk > 0.0 {
        (risk * 100.0 - 1e-4).ceil().max(1.0)
    } else {
        0.0
    };
    format!("{:.2}", hundredths / 100.0)
}

/// The two facts of a plan, in one breath.
///
/// # Examples
///
/// ```
/// assert_eq!(searoom::evaluation::facts(true, false), "verified, not safe");
/// ```
pub fn facts(verified: bool, safe: bool) -> &'static str {
    match (verified, safe) {
        (true, true) => "verified, safe",
        (true, false) => "verified, not safe",
        (false, _) => "FAILED ITS VERIFICATION, not safe",
    }
}
