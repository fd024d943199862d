//! Draws the images of docs/guide/figures.md into a folder.
//!
//! ```text
//! cargo gallery [FOLDER]
//! ```

use std::path::Path;

use searoom::document::PlanDocument;
use searoom::pipeline;
use searoom::planner::SearchKind;
use searoom::report::figure::{
    Figure, FigureOptions, comparison_figure, explored_panel, plan_figure, simulation_figure,
};
use searoom::scenario::Scenario;
use searoom::simulation::Simulation;
use searoom::study::compare::compare;

/// Output folder.
const FOLDER: &str = "docs/gallery";

/// Folder of the scenarios.
const SCENARIOS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios");

/// Scenario files below `scenarios/` whose plans are drawn.
const PLANS: [&str; 5] = [
    "colregs/head-on",
    "colregs/give-way",
    "harbour/munkholmen",
    "harbour/ferry-crossing",
    "paper/figure_9",
];

/// Scenario that is sailed in the closed loop.
const SAILED: &str = "closed-loop/harbour-ferries";

/// Scenario whose searches are drawn side by side.
const SEARCHED: &str = "colregs/give-way";

/// Scenario of the comparison, and its accepted risks.
const COMPARED: (&str, [f64; 4]) = ("colregs/give-way", [0.0, 0.1, 0.2, 0.4]);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| FOLDER.to_owned());
    if folder.starts_with('-') {
        return Err("usage: cargo gallery [FOLDER]".into());
    }
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder)?;
    let read = |name: &str| {
        let file = format!("{SCENARIOS}/{name}.toml");
        Scenario::read(Path::new(&file))
    };
    let picture = |name: &str, end: &str| {
        let stem = name.rsplit('/').next().unwrap_or(name);
        folder.join(format!("{stem}{end}.svg"))
    };
    let natural = FigureOptions::default();
    for name in PLANS {
        let run = pipeline::run(read(name)?);
        plan_figure(&run, &PlanDocument::of(&run), &natural)?.write(&picture(name, ""))?;
    }
    let scenario = read(SAILED)?;
    let mut simulation =
        Simulation::new(scenario.clone(), false).map_err(|faults| faults[0].to_string())?;
    while !simulation.finished() {
        simulation.step();
    }
    simulation_figure(&scenario, &simulation.record(), &natural)?.write(&picture(SAILED, ""))?;
    let panels = [SearchKind::AStar, SearchKind::Dijkstra].map(|search| {
        let run = pipeline::run(Scenario {
            search,
            ..read(SEARCHED)?
        });
        let nodes = run.planned.stats.map_or(0, |stats| stats.expanded);
        let title = format!("{}: {nodes} nodes expanded", search.label());
        Ok(explored_panel(&title, &run))
    });
    let panels = panels
        .into_iter()
        .collect::<Result<_, Box<dyn std::error::Error>>>()?;
    Figure::new(2, panels).write(&picture(SEARCHED, "-searched"))?;
    let (name, risks) = COMPARED;
    let scenario = read(name)?;
    let entries = compare(&scenario, &risks);
    comparison_figure(&[(&scenario, &entries)], &natural)?.write(&picture(name, "-compared"))?;
    Ok(())
}
