//! Figure 8 of the paper: overtaking, head-on, stand-on and give-way, around the paper's shape.
//!
//! ```text
//! cargo run --release --no-default-features --example figure8 [FILE.svg|FILE.png]
//! ```

mod shared;

use searoom::pipeline;
use searoom::report::figure::{Figure, FigureError, chart_panel};
use searoom::scenario::Scenario;

const SCENES: [(&str, &str); 4] = [
    (
        "Overtaking",
        include_str!("../scenarios/paper/figure_8_overtaking.toml"),
    ),
    (
        "Head-on",
        include_str!("../scenarios/paper/figure_8_head_on.toml"),
    ),
    (
        "Stand-on",
        include_str!("../scenarios/paper/figure_8_stand_on.toml"),
    ),
    (
        "Give-way",
        include_str!("../scenarios/paper/figure_8_give_way.toml"),
    ),
];

fn main() -> Result<(), FigureError> {
    let panel = |(title, text): (&str, &str)| {
        let scenario = Scenario::parse(text).expect("a sound scenario");
        chart_panel(title, &pipeline::run(scenario))
    };
    let panels = SCENES.map(panel).into();
    shared::write(Figure::new(2, panels), "figure8.svg")
}
