//! Figure 9 of the paper: the optimal trajectory of CyberShip II among three ellipsoids, with its
//! velocities and forces.
//!
//! ```text
//! cargo run --release --no-default-features --example figure9 [FILE.svg|FILE.png]
//! ```

mod shared;

use searoom::document::PlanDocument;
use searoom::pipeline;
use searoom::report::figure::{FigureError, FigureOptions, plan_figure};
use searoom::scenario::Scenario;

fn main() -> Result<(), FigureError> {
    let text = include_str!("../scenarios/paper/figure_9.toml");
    let run = pipeline::run(Scenario::parse(text).expect("a sound scenario"));
    shared::write(
        plan_figure(&run, &PlanDocument::of(&run), &FigureOptions::default())?,
        "figure9.svg",
    )
}
