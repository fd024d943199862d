//! Runs random scenes through the whole program: text, scenario, plan, document, verification.
//!
//! ```text
//! cargo run --release --no-default-features --example fuzz \
//!     -- --scenes 10000 --seed 1 [--planner KIND] [--keep DIR]
//! ```
//!
//! Counts faults and exits with status 1 if any occurred, except lateness. Scenes with a fault are
//! written to DIR as scenario files; `--scenes 1 --seed N` repeats one of them. Scenes rejected by
//! the program are not counted.

#[path = "../tests/wild/mod.rs"]
mod wild;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::error::Error;
use std::panic::catch_unwind;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use searoom::document::PlanDocument;
use searoom::pipeline;
use searoom::scenario::Scenario;
use searoom::verification::verify;

/// Faults in the order of the summary.
const FAULTS: [&str; 6] = [
    "panic",
    "status 3",
    "rejected by verify",
    "not proven",
    "plan late",
    "program late",
];

/// Index of the first timing fault.
const LATENESS: usize = 4;

/// Permitted excess over the time budget, of a plan and of the program.
const LATE: [Duration; 2] = [Duration::from_millis(5), Duration::from_millis(50)];

/// A scene is late if it is late in all these attempts; a shared machine has occasional delays.
const TRIES: usize = 4;

thread_local! {
    static PANIC: RefCell<String> = RefCell::default();
}

struct Arguments {
    scenes: u64,
    seed: u64,
    planner: Option<String>,
    keep: Option<PathBuf>,
}

/// Result of a scene.
#[derive(Default)]
struct Found {
    outcome: String,
    /// Indices into [`FAULTS`] with their details.
    faults: BTreeMap<usize, String>,
    /// Times in seconds of planning, the program, and verification.
    times: [f64; 3],
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let arguments = arguments()?;
    if let Some(folder) = &arguments.keep {
        std::fs::create_dir_all(folder)?;
    }
    std::panic::set_hook(Box::new(|info| PANIC.set(info.to_string())));
    let maps = concat!(env!("CARGO_MANIFEST_DIR"), "/maps");
    let mut outcomes: BTreeMap<(String, String), u64> = BTreeMap::new();
    let (mut counts, mut slowest) = ([0_u64; FAULTS.len()], [(0.0, 0); 3]);
    let (mut scenes, mut refused, mut seed) = (0, 0, arguments.seed);
    while scenes < arguments.scenes {
        let text = wild::anything(seed, arguments.planner.as_deref(), maps);
        if let Some(found) = of(&text) {
            scenes += 1;
            let planner = wild::PLANNERS
                .iter()
                .find(|p| text.contains(&format!("kind = \"{p}\"")));
            let planner = planner.ok_or("a scene without a planner")?;
            *outcomes
                .entry((planner.to_string(), found.outcome))
                .or_default() += 1;
            for (slowest, time) in slowest.iter_mut().zip(found.times) {
                if time > slowest.0 {
                    *slowest = (time, seed);
                }
            }
            for (fault, what) in &found.faults {
                counts[*fault] += 1;
                println!("seed {seed}, {planner}: {}: {what}", FAULTS[*fault]);
            }
            if let (Some(folder), Some((fault, _))) =
                (&arguments.keep, found.faults.first_key_value())
            {
                let name = format!("{}-{planner}-{seed}.toml", FAULTS[*fault].replace(' ', "-"));
                std::fs::write(folder.join(name), &text)?;
            }
        } else {
            refused += 1;
        }
        seed += 1;
    }
    println!(
        "{scenes} scenes, seeds {} to {}; {refused} more were refused",
        arguments.seed,
        seed - 1
    );
    for ((planner, outcome), count) in outcomes {
        println!("{planner:>16} {outcome:<12} {count:>6}");
    }
    for (name, (time, seed)) in ["plan", "program", "verification"].iter().zip(slowest) {
        println!("slowest {name}: {time:.3} s, seed {seed}");
    }
    for (fault, count) in FAULTS.iter().zip(counts) {
        println!("{fault:>20} {count:>6}");
    }
    // timing faults depend on the machine: print only
    let wrong = counts[..LATENESS].iter().any(|n| *n > 0);
    Ok(ExitCode::from(u8::from(wrong)))
}

fn arguments() -> Result<Arguments, Box<dyn Error>> {
    let mut found = Arguments {
        scenes: 1000,
        seed: 1,
        planner: None,
        keep: None,
    };
    let mut words = std::env::args().skip(1);
    while let Some(option) = words.next() {
        let value = words.next().ok_or(format!("{option}: no value"))?;
        match option.as_str() {
            "--scenes" => found.scenes = value.parse()?,
            "--seed" => found.seed = value.parse()?,
            "--planner" if wild::PLANNERS.contains(&value.as_str()) => found.planner = Some(value),
            "--planner" => return Err(format!("{value}: one of {:?}", wild::PLANNERS).into()),
            "--keep" => found.keep = Some(value.into()),
            _ => return Err(format!("{option}: not known").into()),
        }
    }
    Ok(found)
}

/// Runs a scene; `None` if the program rejects it. A late scene is repeated.
fn of(text: &str) -> Option<Found> {
    let is_late = |found: &Found| found.faults.keys().any(|k| *k >= LATENESS);
    let mut best = run(text)?;
    for _ in 1..TRIES {
        if !is_late(&best) {
            break;
        }
        match run(text) {
            Some(again) if again.faults.len() < best.faults.len() => best = again,
            _ => {}
        }
    }
    Some(best)
}

fn run(text: &str) -> Option<Found> {
    let caught = catch_unwind(|| planned_and_verified(text));
    caught.unwrap_or_else(|_| {
        Some(Found {
            outcome: "panic".to_owned(),
            faults: BTreeMap::from([(0, PANIC.take())]),
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
            faults.insert(4 + which, late(time));
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
        outcome: document.outcome,
        faults,
        times: [run.plan_time, whole, verification].map(|time| time.as_secs_f64()),
    })
}
