//! Prints docs/reference/benchmarks.md: the space-time planner on imported and random encounters.
//!
//! ```text
//! cargo leaderboard > docs/reference/benchmarks.md
//! ```
//!
//! Only the times depend on the machine. `--quick` plans few random encounters, once each.

#[path = "../../../../tests/campaigns/encounter_generator.rs"]
mod encounter_generator;
mod growth;
#[path = "../../../../benches/shared/new_york.rs"]
mod new_york;

use std::error::Error;
use std::path::{Path, PathBuf};

use searoom::colregs::{Thresholds, compliance::ComplianceReport};
use searoom::pipeline::{self, Run};
use searoom::planner::{Outcome, SearchKind};
use searoom::scenario::import::{Assumed, Assumption, Contents};
use searoom::scenario::{Compliance, Scenario};

use encounter_generator::{EncounterKind, Placement, random_encounter};

/// Random encounters of each kind, seeds from 0.
const RANDOM: u64 = 250;

/// Plans of each scene. Their median time is reported, because a shared machine has delays.
const RUNS: usize = 5;

/// Safety margin in metres of Imazu's cases, which have none.
const IMAZU_MARGIN: f64 = 500.0;

/// [`RANDOM`], [`RUNS`] and scenes of each size with `--quick`.
const QUICK: (u64, usize, u64) = (4, 1, 2);

/// Deadline in seconds, so long that outcomes do not depend on the clock.
const DEADLINE: f64 = 60.0;

fn main() -> Result<(), Box<dyn Error>> {
    let thresholds = Thresholds::standard();
    let (random, runs, growth) = match std::env::args().nth(1).as_deref() {
        None => (RANDOM, RUNS, growth::SCENES),
        Some("--quick") => QUICK,
        Some(other) => return Err(format!("{other}: nothing, or --quick").into()),
    };
    let assumed = Assumed::default();
    let wide = assumed.clone().with(Assumption::SafetyMargin, IMAZU_MARGIN);
    let mut suites = vec![
        ("Imazu, margin 500 m".to_owned(), imported("imazu", &wide)?),
        ("DNV, margin 122 m".to_owned(), imported("dnv", &assumed)?),
        (
            "CommonOcean samples".to_owned(),
            imported("commonocean", &assumed)?,
        ),
    ];
    suites.push(("New York, 195 targets".to_owned(), new_york::scenes()?));
    for kind in EncounterKind::ALL {
        let drawn = (0..random).map(|seed| random_encounter(kind, seed, Placement::Origin));
        let scenes: Option<Vec<_>> = drawn.map(|d| Some(d?.scenario)).collect();
        let scenes = scenes.ok_or("no encounter")?;
        suites.push((
            format!("random, {}, seeds 0 to {}", kind.name(), random - 1),
            scenes,
        ));
    }
    let version = env!("CARGO_PKG_VERSION");
    println!(
        "# Benchmarks

This page shows how the space-time planner of Searoom {version} performs on imported and random
encounters. Targets of imported files have spreads of ±0.5 m/s and ±5°. This command prints the
page; `--quick` runs a small sample:

```text
cargo leaderboard > docs/reference/benchmarks.md
```

| column | meaning |
| --- | --- |
| clear | scenes with a verified plan that enters no hard set |
| relaxed | of those, plans with a relaxed ship domain or not by the rules |
| judged | of those, plans along which own ship is at risk and so has a role toward a target |
| complies | of the clear plans, those without rule violations or violated monitors ([rules.md](rules.md)), by the profile `searoom` |
| score | mean over targets of their least score |
| ms | planning time: the median of {runs} plans for a scene, then statistics over scenes |

Only the times depend on the machine. [measured.md](measured.md) measures plans by the rules on more
random encounters, and what is sailed.
"
    );
    println!(
        "| suite | `compliance` | scenes | clear | relaxed | judged | complies | score | J, median, m² | ms, median | ms, 99 % | ms, worst |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for (name, scenes) in suites {
        let several = scenes.iter().any(|scene| scene.targets.len() > 1);
        let thorough = several.then_some((Compliance::Shape, SearchKind::Thorough));
        let quick = [Compliance::Shape, Compliance::Rules].map(|c| (c, SearchKind::AStar));
        for how in quick.into_iter().chain(thorough) {
            let search = match how.1 {
                SearchKind::AStar => "",
                _ => ", thorough search",
            };
            println!(
                "| {name} | `{}`{search} | {} |",
                how.0.word(),
                row(&scenes, how, thresholds, runs)
            );
        }
    }
    growth::print(growth)
}

/// Scenarios of a folder below `scenarios/`, in order of file names.
fn imported(folder: &str, assumed: &Assumed) -> Result<Vec<Scenario>, Box<dyn Error>> {
    let scenarios = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios"));
    let folder = scenarios.join(folder);
    let entries = std::fs::read_dir(folder)?.map(|entry| entry.map(|e| e.path()));
    let mut files: Vec<PathBuf> = entries.collect::<Result<_, _>>()?;
    files.retain(|f| f.extension().is_some_and(|e| e == "json" || e == "xml"));
    files.sort();
    let mut scenes = Vec::new();
    for file in files {
        let Contents::Situations(situations) = Contents::read(&file, assumed)? else {
            return Err(format!("{}: no encounters", file.display()).into());
        };
        for situation in situations {
            let fault = |faults| format!("{}: {faults:?}", file.display());
            scenes.push(
                situation
                    .map_err(fault)?
                    .scenario(assumed)
                    .map_err(fault)?
                    .scenario,
            );
        }
    }
    Ok(scenes)
}

/// Cells of one row after the first.
fn row(
    scenes: &[Scenario],
    (compliance, search): (Compliance, SearchKind),
    thresholds: &Thresholds,
    runs: usize,
) -> String {
    let (mut clear, mut relaxed, mut judged, mut complies) = (0, 0, 0, 0);
    let (mut scores, mut costs, mut times) = (Vec::new(), Vec::new(), Vec::new());
    for scene in scenes {
        let scene = Scenario {
            compliance,
            search,
            deadline: DEADLINE,
            ..scene.clone()
        };
        let run = pipeline::run(scene.clone());
        let others = (1..runs).map(|_| pipeline::run(scene.clone()).plan_time);
        let mut of_this: Vec<f64> = (others.chain([run.plan_time]))
            .map(|time| time.as_secs_f64() * 1e3)
            .collect();
        times.push(quantile(&mut of_this, 0.5));
        let conduct: Vec<ComplianceReport> =
            run.compliance(thresholds).into_iter().flatten().collect();
        scores.extend(conduct.iter().map(|c| c.scores.least()));
        if is_clear(&run) {
            clear += 1;
            relaxed += usize::from(!run.relaxations.is_empty());
            judged += usize::from(conduct.iter().any(|c| !c.roles.is_empty()));
            complies += usize::from(conduct.iter().all(ComplianceReport::complies));
            costs.extend(run.planned.outcome.plan().map(|plan| plan.cost));
        }
    }
    let mean = scores.iter().sum::<f64>() / scores.len().max(1) as f64;
    format!(
        "{} | {clear} | {relaxed} | {judged} | {complies} | {mean:.2} | {:.0} | {:.1} | {:.1} | {:.1}",
        scenes.len(),
        quantile(&mut costs, 0.5),
        quantile(&mut times, 0.5),
        quantile(&mut times, 0.99),
        quantile(&mut times, 1.0)
    )
}

fn is_clear(run: &Run) -> bool {
    matches!(run.planned.outcome, Outcome::Solved(_))
        && run.max_risk == 0.0
        && !run.enters()
        && run.evaluation.as_ref().is_some_and(|e| e.verified())
}

/// Quantile; NaN for an empty slice.
fn quantile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1) as f64;
    values
        .get((last * share).round() as usize)
        .copied()
        .unwrap_or(f64::NAN)
}
