//! The parts of a plan document, or of an entry of a comparison, in words.

use searoom::report::printable;
use serde_json::Value;

/// The word that people see, of a plan document or of an entry of a comparison; of one without it the outcome, and that nothing is
/// said of its safety.
pub fn verdict(document: &Value) -> String {
    match (document["verdict"].as_str(), document["outcome"].as_str()) {
        (Some(verdict), _) => printable(verdict),
        (None, Some(outcome)) => format!("{} (safe or not is not said)", printable(outcome)),
        (None, None) => "unknown".to_owned(),
    }
}

/// What follows a hold.
pub fn manoeuvre(escape: &Value) -> String {
    let number = |key: &str| escape[key].as_f64().unwrap_or(0.0);
    let (turn, speed) = (number("turn_deg"), number("speed_mps"));
    if turn == 0.0 {
        return format!("{speed:.2} m/s");
    }
    let side = if turn > 0.0 { "starboard" } else { "port" };
    format!("{:.0}° to {side} at {speed:.2} m/s", turn.abs())
}

/// Roles over time, scores and every broken rule with its moment, of one encounter; nothing where none is judged.
pub fn conduct(encounter: &Value) -> Vec<String> {
    let list = |key: &str| encounter[key].as_array().map_or(&[][..], Vec::as_slice);
    let word = |value: &Value| printable(value.as_str().unwrap_or("unknown"));
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let spell = |role: &Value| {
        let (from, until) = (number(&role["from_s"]), number(&role["until_s"]));
        format!("{} {from:.0} to {until:.0} s", word(&role["role"]))
    };
    let roles: Vec<String> = list("roles").iter().map(spell).collect();
    let mut lines = Vec::new();
    if roles.is_empty() {
        return lines;
    }
    lines.push(format!("    roles      {}", roles.join(", ")));
    let scores = encounter["scores"].as_object().into_iter().flatten();
    let scores: Vec<String> = scores
        .map(|(rule, score)| format!("{} {:.2}", rule.replace('_', " "), number(score)))
        .collect();
    lines.push(format!("    scores     {}", scores.join(", ")));
    lines.extend(list("breaches").iter().map(|breach| {
        let (rule, what) = (word(&breach["rule"]), word(&breach["what"]));
        format!(
            "    breaks     {rule} at {:.0} s: {what}",
            number(&breach["t_s"])
        )
    }));
    let broken = |finding: &&Value| finding["verdict"] == "violated";
    lines.extend(list("monitors").iter().filter(broken).map(|finding| {
        format!(
            "    monitor    {} violated at {:.0} s, by {:.1} {}",
            word(&finding["monitor"]),
            number(&finding["t_s"]),
            -number(&finding["robustness"]),
            word(&finding["unit"])
        )
    }));
    lines
}

/// The costs of a document in words; empty without any.
pub fn costs(cost: &Value) -> String {
    let mut costs = Vec::new();
    for (key, name, unit) in [
        ("space_time_error_m2", "J", "m²"),
        ("duration_s", "duration", "s"),
        ("delay_s", "delay", "s"),
        ("length_m", "length", "m"),
        ("min_clearance_m", "clearance", "m"),
        ("max_risk", "largest risk", ""),
    ] {
        if let Some(value) = cost[key].as_f64() {
            let value = format!("{name} {:.1} {unit}", tenths(value));
            costs.push(value.trim_end().to_owned());
        }
    }
    costs.join(", ")
}

/// Rounded to one decimal; what rounds to zero has no sign.
pub fn tenths(value: f64) -> f64 {
    (value * 10.0).round() / 10.0 + 0.0
}
