//! Figures of the scenarios in `scenarios/paper`.

use std::error::Error;

use searoom::document::PlanDocument;
use searoom::pipeline::{self, Run};
use searoom::report::figure::{
    Figure, FigureOptions, ProfileLine, Stroke, chart_panel, explored_panel, path_time_panel,
    plan_figure,
};
use searoom::scenario::Scenario;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Scenarios of figure 6 in order of decreasing maximum speed.
const SPEEDS: [&str; 3] = ["figure_6", "figure_6_slower", "figure_6_slowest"];

/// Colours of the speeds, and whether the line is dashed.
const STROKES: [(&str, bool); 3] = [("#000000", false), ("#000000", true), ("#777777", false)];

/// Titles and scenarios of figure 8.
const ENCOUNTERS: [(&str, &str); 4] = [
    ("Overtaking", "figure_8_overtaking"),
    ("Head-on", "figure_8_head_on"),
    ("Stand-on", "figure_8_stand_on"),
    ("Give-way", "figure_8_give_way"),
];

/// Figure 6: three ships with different uncertainty, and the time-optimal profiles at three maximum
/// speeds.
pub fn speeds_along_a_path() -> Result<Figure> {
    let runs: Vec<Run> = SPEEDS.into_iter().map(planned).collect::<Result<_>>()?;
    let targets = runs[0].scenario.targets.iter();
    let names: Vec<&str> = targets.map(|target| target.name.as_str()).collect();
    let mut lines = Vec::new();
    for (run, (colour, dashed)) in runs.iter().zip(STROKES) {
        let diagram = run.planned.path_time.as_deref();
        lines.push(ProfileLine {
            label: format!("at most {} m/s", run.scenario.own_ship.max_speed()),
            diagram: diagram.ok_or("no path-time diagram")?,
            stroke: Stroke {
                colour,
                width: 2.4,
                dashed,
            },
        });
    }
    let panels = vec![
        chart_panel("Chart, the fastest", &runs[0]),
        path_time_panel("Path-time diagram", &names, &lines),
    ];
    Ok(Figure::new(2, panels))
}

/// Figure 7: the collision-free motions found by a search, and the plan.
pub fn explored_motions() -> Result<Figure> {
    let panel = explored_panel("Motions found while planning", &planned("figure_7")?);
    Ok(Figure::new(1, vec![panel]))
}

/// Figure 8: overtaking, head-on, stand-on and give-way, around the paper's ship domain.
pub fn encounters() -> Result<Figure> {
    let panel = |(title, name)| Ok(chart_panel(title, &planned(name)?));
    let panels: Result<_> = ENCOUNTERS.into_iter().map(panel).collect();
    Ok(Figure::new(2, panels?))
}

/// Figure 9: the optimal trajectory of CyberShip II among three ellipsoids, with its velocities and
/// forces.
pub fn optimal_control() -> Result<Figure> {
    let run = planned("figure_9")?;
    let options = FigureOptions::default();
    Ok(plan_figure(&run, &PlanDocument::of(&run), &options)?)
}

/// Plans a scenario of the paper.
fn planned(name: &str) -> Result<Run> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/paper");
    let scenario = Scenario::read(format!("{folder}/{name}.toml").as_ref())?;
    Ok(pipeline::run(scenario))
}
