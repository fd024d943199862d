//! Figure 7 of the paper: the collision-free motions found by a search, and the plan.
//!
//! ```text
//! cargo run --release --no-default-features --example figure7 [FILE.svg|FILE.png]
//! ```

mod shared;

use searoom::pipeline;
use searoom::report::figure::{Figure, FigureError, explored_panel};
use searoom::scenario::Scenario;

fn main() -> Result<(), FigureError> {
    let text = include_str!("../scenarios/paper/figure_7.toml");
    let run = pipeline::run(Scenario::parse(text).expect("a sound scenario"));
    let panel = explored_panel("Motions found while planning", &run);
    shared::write(Figure::new(1, vec![panel]), "figure7.svg")
}
