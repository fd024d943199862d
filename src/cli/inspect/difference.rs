//! Differences between two recordings.

use std::path::Path;

use searoom::recording::Recorded;
use serde::Serialize;
use serde_json::Value;

use super::super::args::InspectArgs;
use super::super::output::Output;
use super::super::output::status::ExitStatus;
use super::read;

/// Maximum number of plan document differences listed; the rest is counted.
const LISTED: usize = 40;

/// Entities excluded from the row-by-row comparison: the title and the documents. Documents are
/// compared field by field, without the planning time.
const APART: [&str; 3] = ["/__properties", "/plan_document", "/comparison_document"];

/// Differences between two recordings.
#[derive(Debug, Default, Serialize)]
struct Difference {
    files: Vec<String>,
    equal: bool,
    /// Fields in which the plan documents differ, except timing.
    plan: Vec<PlanDifference>,
    /// Entities only in the first recording.
    only_first: Vec<String>,
    /// Entities only in the second recording.
    only_second: Vec<String>,
    /// Entities in both recordings with different rows.
    changed: Vec<String>,
    /// Number of equal entities.
    same: usize,
}

#[derive(Debug, Serialize)]
struct PlanDifference {
    field: String,
    first: Value,
    second: Value,
}

/// Compares the plan documents, except the planning time, and the contents of every entity.
pub fn two(args: &InspectArgs, other: &Path, output: &Output) -> anyhow::Result<ExitStatus> {
    let (first, second) = (read(&args.recording)?, read(other)?);
    let mut found = Difference {
        files: [args.recording.as_path(), other]
            .map(|f| f.display().to_string())
            .to_vec(),
        ..Difference::default()
    };
    let document = |r: &Recorded| -> Value {
        let text = r.document().or_else(|| r.comparison());
        let mut value: Value = text
            .and_then(|t| serde_json::from_str(&t).ok())
            .unwrap_or_default();
        forget_times(&mut value);
        value
    };
    differences(&document(&first), &document(&second), "", &mut found.plan);
    let paths = |r: &Recorded| -> Vec<String> {
        let all = r.entities().into_iter().map(|e| e.path);
        all.filter(|path| !APART.contains(&path.as_str())).collect()
    };
    let (in_first, in_second) = (paths(&first), paths(&second));
    for path in &in_first {
        if !in_second.contains(path) {
            found.only_first.push(path.clone());
        } else if first.table(path) == second.table(path) {
            found.same += 1;
        } else {
            found.changed.push(path.clone());
        }
    }
    let is_new = |path: &&String| !in_first.contains(path);
    found.only_second = in_second.iter().filter(is_new).cloned().collect();
    let lists = [&found.only_first, &found.only_second, &found.changed];
    found.equal = found.plan.is_empty() && lists.iter().all(|l| l.is_empty());
    let shown = if args.json {
        output.document(&found)
    } else {
        output.result(&found.text())
    };
    // exit status as in other comparison tools
    let status = if found.equal {
        ExitStatus::Good
    } else {
        ExitStatus::NoPlan
    };
    Ok(shown.max(status))
}

/// Removes the planning times at any depth.
fn forget_times(value: &mut Value) {
    match value {
        Value::Object(fields) => {
            fields.remove("timing");
            fields.values_mut().for_each(forget_times);
        }
        Value::Array(list) => list.iter_mut().for_each(forget_times),
        _ => {}
    }
}

/// Lists the fields in which two documents differ. Lists of different lengths differ as a whole.
fn differences(first: &Value, second: &Value, at: &str, found: &mut Vec<PlanDifference>) {
    match (first, second) {
        (Value::Object(a), Value::Object(b)) => {
            let more = b.keys().filter(|key| !a.contains_key(*key));
            for key in a.keys().chain(more) {
                let at = if at.is_empty() {
                    key.clone()
                } else {
                    format!("{at}.{key}")
                };
                let of = |map: &serde_json::Map<String, Value>| {
                    map.get(key).cloned().unwrap_or_default()
                };
                differences(&of(a), &of(b), &at, found);
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (i, (a, b)) in a.iter().zip(b).enumerate() {
                differences(a, b, &format!("{at}[{i}]"), found);
            }
        }
        (a, b) if a != b => found.push(PlanDifference {
            field: at.to_owned(),
            first: a.clone(),
            second: b.clone(),
        }),
        _ => {}
    }
}

impl Difference {
    fn text(&self) -> String {
        let mut lines = vec![self.files.join(" against ")];
        if self.equal {
            lines.push(format!(
                "the same, but for the time that planning took: {} entities",
                self.same
            ));
            return lines.join("\n");
        }
        if !self.plan.is_empty() {
            lines.push(format!("Documents: {} fields differ", self.plan.len()));
        }
        for d in self.plan.iter().take(LISTED) {
            lines.push(format!(
                "  {}: {} | {}",
                d.field,
                brief(&d.first),
                brief(&d.second)
            ));
        }
        if self.plan.len() > LISTED {
            lines.push(format!("  and {} more", self.plan.len() - LISTED));
        }
        for (name, paths) in [
            ("only in the first", &self.only_first),
            ("only in the second", &self.only_second),
            ("with other contents", &self.changed),
        ] {
            if !paths.is_empty() {
                lines.push(format!("Entities {name}: {}", paths.join(", ")));
            }
        }
        lines.push(format!("Entities alike: {}", self.same));
        lines.join("\n")
    }
}

fn brief(value: &Value) -> String {
    match value {
        Value::Array(list) => format!("{} entries", list.len()),
        Value::Object(fields) => format!("{} fields", fields.len()),
        other => other.to_string(),
    }
}
