//! Figure 6 of the paper: three ships with different uncertainty, and the time-optimal profiles at
//! three maximum speeds.
//!
//! ```text
//! cargo run --release --no-default-features --example figure6 [FILE.svg|FILE.png]
//! ```

mod shared;

use std::path::Path;

use searoom::pipeline::{self, Run};
use searoom::report::figure::{
    Figure, FigureError, ProfileLine, Stroke, chart_panel, path_time_panel,
};
use searoom::scenario::Scenario;

/// Scenarios in order of decreasing maximum speed.
const SCENARIOS: [&str; 3] = ["figure_6", "figure_6_slower", "figure_6_slowest"];

const STROKES: [(&str, bool); 3] = [("#000000", false), ("#000000", true), ("#777777", false)];

fn main() -> Result<(), FigureError> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/paper");
    let runs: Vec<Run> = SCENARIOS
        .iter()
        .map(|name| folder.join(format!("{name}.toml")))
        .map(|file| pipeline::run(Scenario::read(&file).expect("no faults")))
        .collect();
    let names: Vec<&str> = (runs[0].scenario.targets.iter())
        .map(|t| t.name.as_str())
        .collect();
    let lines: Vec<ProfileLine> = runs
        .iter()
        .zip(STROKES)
        .map(|(run, (colour, dashed))| ProfileLine {
            label: format!("at most {} m/s", run.scenario.own_ship.max_speed()),
            diagram: run.planned.path_time.as_deref().expect("a diagram"),
            stroke: Stroke {
                colour,
                width: 2.4,
                dashed,
            },
        })
        .collect();
    let panels = vec![
        chart_panel("Chart, the fastest", &runs[0]),
        path_time_panel("Path-time diagram", &names, &lines),
    ];
    shared::write(Figure::new(2, panels), "figure6.svg")
}
