//! How own ship behaves, in words.

use crate::colregs::compliance::{Measure, MonitorResult, Verdict};
use crate::frame::deg_from_radians;
use crate::pipeline::Run;

/// How own ship behaves toward every target that she has a role to: the least score of each, and every rule that is broken.
pub(super) fn lines(run: &Run) -> Vec<(&'static str, String)> {
    let mut lines = Vec::new();
    let conduct = run.judged_conduct();
    for (target, conduct) in run.scenario.targets.iter().zip(&conduct) {
        let Some(conduct) = conduct.as_ref().filter(|c| !c.roles.is_empty()) else {
            continue;
        };
        let scores = conduct.scores.by_name();
        let scores: Vec<String> = scores
            .into_iter()
            .map(|(name, score)| format!("{} {score:.2}", name.replace('_', " ")))
            .collect();
        lines.push(("rules", format!("'{}': {}", target.name, scores.join(", "))));
        for breach in &conduct.violations {
            let said = format!(
                "breaks {} at {:.0} s: {}",
                breach.rule, breach.time, breach.what
            );
            lines.push(("", said));
        }
        let broken = |f: &&MonitorResult| f.verdict == Verdict::Violated;
        for finding in conduct.monitors.iter().filter(broken) {
            let (worst, time) = (
                finding.robustness.unwrap_or(f64::NAN),
                finding.time.unwrap_or(f64::NAN),
            );
            let short = match finding.measure {
                // a difference has no negative zero
                Measure::Distance => format!("{:.1} m", 0.0 - worst),
                Measure::Angle => format!("{:.0}°", deg_from_radians(0.0 - worst)),
                Measure::Time => format!("{:.0} s", 0.0 - worst),
            };
            lines.push((
                "",
                format!(
                    "monitor {} is violated at {time:.0} s by {short}",
                    finding.monitor
                ),
            ));
        }
    }
    lines
}
