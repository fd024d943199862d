//! The differences of two recordings.

use std::path::Path;

use searoom::recording::Recorded;
use serde::Serialize;
use serde_json::Value;

use super::super::args::InspectArgs;
use super::super::output::Output;
use super::super::output::status::Status;
use super::read;

/// Differences of two plan documents that are listed; the rest is counted.
const LISTED: usize = 20;

/// Entities that are not compared row by row: the title, and the documents, which are compared
/// field by field without the time that planning took.
const APART: [&str; 3] = ["/__properties", "/plan_document", "/comparison_document"];

/// The differences of two recordings.
#[derive(Debug, Default, Serialize)]
struct Difference {
    files: Vec<String>,
    equal: bool,
    /// Fields in which the plan documents differ, timing aside.
    plan: Vec<PlanDifference>,
    /// In the first alone.
    only_first: Vec<String>,
    /// In the second alone.
    only_second: Vec<String>,
    /// In both, with other rows.
    changed: Vec<String>,
    /// In both, alike.
    same: usize,
}

#[derive(Debug, Serialize)]
struct PlanDifference {
    field: String,
    first: Value,
    second: Value,
}

/// Compares plan documents, the time of planning aside, and the contents of every entity.
pub fn two(args: &InspectArgs, other: &Path, output: &Output) -> anyhow::Result<Status> {
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
    // as programs that compare do
    let status = if found.equal {
        Status::Good
    } else {
        Status::NoPlan
    };
    Ok(shown.max(status))
}

/// Leaves out the time that planning took, wherever it stands.
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

/// Where two documents differ, field by field; lists of different lengths at once.
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
