//! Random scenes through the whole program: text, scenario, plan, document, verification.
//!
//! Counts panics, faults, rejected documents and late plans. Scenes that the program refuses are
//! not counted.

mod anything;
mod scene;

use std::collections::BTreeMap;
use std::panic::catch_unwind;
use std::path::Path;
use std::time::{Duration, Instant};

use searoom::document::PlanDocument;
use searoom::pipeline;
use searoom::scenario::Scenario;
use searoom::verification::verify;

use super::{Report, documents};
pub use anything::{PLANNERS, anything};

/// Faults in the order of the summary.
const FAULTS: [&str; 6] = [
    "panic",
    "status 3",
    "rejected by verify",
    "not proven",
    "plan late",
    "program late",
];

/// Index of the first timing fault. Timing depends on the machine and is no bound.
const LATENESS: usize = 4;

/// Permitted excess over the time budget, of a plan and of the program.
const LATE: [Duration; 2] = [Duration::from_millis(5), Duration::from_millis(50)];

/// A scene is late if it is late in all these attempts; a shared machine has occasional delays.
const TRIES: usize = 4;

/// Minimum fraction of scenes with a plan, of those that the deadline did not end.
const PLANNED: f64 = 0.7;

/// Result of a scene.
#[derive(Default)]
struct Found {
    outcome: String,
    /// Indices into [`FAULTS`] with their details.
    faults: BTreeMap<usize, String>,
    /// Times in seconds of planning, the program, and verification.
    times: [f64; 3],
}

/// Runs `count` accepted scenes from the seed `first` on, of one planner or of all. Writes scenes
/// with a fault to the folder `keep`.
pub fn run(first: u64, count: u64, planner: Option<&str>, keep: Option<&Path>) -> Report {
    let maps = documents::repository().join("maps");
    let maps = maps.display().to_string();
    let mut report = Report::default();
    let mut outcomes: BTreeMap<(&str, String), u64> = BTreeMap::new();
    let (mut counts, mut slowest) = ([0_u64; FAULTS.len()], [(0.0, 0); 3]);
    let (mut scenes, mut seed) = (0, first);
    for (name, _) in searoom::planner::planner_words() {
        report.require(PLANNERS.contains(&name), || {
            format!("no scenes of the {name} planner")
        });
    }
    while scenes < count {
        let text = anything(seed, planner, &maps);
        if let Some(found) = best_of_tries(&text) {
            scenes += 1;
            let kind = |p: &&&str| text.contains(&format!("kind = \"{p}\""));
            let planner = PLANNERS.iter().find(kind).expect("a planner");
            *outcomes.entry((planner, found.outcome)).or_default() += 1;
            for (slowest, time) in slowest.iter_mut().zip(found.times) {
                if time > slowest.0 {
                    *slowest = (time, seed);
                }
            }
            for (fault, what) in &found.faults {
                counts[*fault] += 1;
                let line = format!("seed {seed}, {planner}: {}: {what}", FAULTS[*fault]);
                println!("{line}");
                report.require(*fault >= LATENESS, || line);
            }
            if let (Some(folder), Some((fault, _))) = (keep, found.faults.first_key_value()) {
                let name = format!("{}-{planner}-{seed}.toml", FAULTS[*fault].replace(' ', "-"));
                let made = std::fs::create_dir_all(folder);
                let written = made.and_then(|()| std::fs::write(folder.join(name), &text));
                report.require(written.is_ok(), || {
                    format!("{}: {written:?}", folder.display())
                });
            }
        }
        seed += 1;
    }
    let refused = seed - first - scenes;
    println!(
        "{scenes} scenes, seeds {first} to {}; {refused} more were refused",
        seed - 1
    );
    for ((planner, outcome), count) in &outcomes {
        println!("{planner:>16} {outcome:<12} {count:>6}");
    }
    for (name, (time, seed)) in ["plan", "program", "verification"].iter().zip(slowest) {
        println!("slowest {name}: {time:.3} s, seed {seed}");
    }
    for (fault, count) in FAULTS.iter().zip(counts) {
        println!("{fault:>20} {count:>6}");
    }
    let ended = |words: &[&str]| -> u64 {
        let with = outcomes.iter().filter(|o| words.contains(&o.0.1.as_str()));
        with.map(|o| o.1).sum()
    };
    let (planned, in_time) = (ended(&["solved", "relaxed"]), scenes - ended(&["deadline"]));
    report.require(planned as f64 >= PLANNED * in_time as f64, || {
        format!("{planned} of {in_time} scenes that ended in time have a plan")
    });
    report
}

/// Runs a scene; `None` if the program refuses it. A late scene is repeated.
fn best_of_tries(text: &str) -> Option<Found> {
    let is_late = |found: &Found| found.faults.keys().any(|k| *k >= LATENESS);
    let mut best = caught(text)?;
    for _ in 1..TRIES {
        if !is_late(&best) {
            break;
        }
        match caught(text) {
            Some(again) if again.faults.len() < best.faults.len() => best = again,
            _ => {}
        }
    }
    Some(best)
}

fn caught(text: &str) -> Option<Found> {
    catch_unwind(|| planned_and_verified(text)).unwrap_or_else(|panic| {
        let what = panic.downcast_ref::<String>().cloned();
        let what = what.or(panic.downcast_ref::<&str>().map(|s| (*s).to_owned()));
        Some(Found {
            outcome: "panic".to_owned(),
            faults: BTreeMap::from([(0, what.unwrap_or_default())]),
            ..Found::default()
        })
    })
}

fn planned_and_verified(text: &str) -> Option<Found> {
    let begun = Instant::now();
    let scenario = Scenario::parse(text).ok()?;
    let deadline = Duration::from_secs_f64(scenario.deadline);
    let run = pipeline::run(scenario);
    let document = PlanDocument::of(&run);
    let json = serde_json::to_string_pretty(&document).unwrap_or_default();
    let whole = begun.elapsed();
    let mut faults = BTreeMap::new();
    let late = |time: Duration| format!("{time:.1?} at a budget of {deadline:?}");
    for (which, time) in [run.plan_time, whole].into_iter().enumerate() {
        if time > deadline + LATE[which] {
            faults.insert(LATENESS + which, late(time));
        }
    }
    let mut wrong = Vec::new();
    if run.planned.outcome.plan().is_some() {
        let violations = run.evaluation.as_ref().map(|e| e.violations.as_slice());
        match violations {
            Some([]) => {}
            Some(violations) => {
                let what = violations.iter().map(|v| v.what.clone());
                wrong.extend(what.map(|what| (1, what)));
            }
            None => wrong.push((1, "a plan that was not judged".to_owned())),
        }
    }
    let begun = Instant::now();
    match verify(&json) {
        // a document without a motion needs no verification, but may be wrong
        Ok(found) => wrong.extend(found.violations.into_iter().map(|v| (2, v.what))),
        Err(error) => wrong.push((2, error.to_string())),
    }
    let verification = begun.elapsed();
    for (fault, what) in wrong {
        if what.contains("not proven") || what.contains("ran out") {
            faults.entry(3).or_insert(what.clone());
        }
        faults.entry(fault).or_insert(what);
    }
    Some(Found {
        outcome: document.outcome.to_string(),
        faults,
        times: [run.plan_time, whole, verification].map(|time| time.as_secs_f64()),
    })
}
