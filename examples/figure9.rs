//! Figure 9 of the paper: the optimal trajectory of CyberShip II among three ellipsoids, at the start and at the closest
//! approach to each of them; and her velocities and forces.
//!
//! ```text
//! cargo run --release --no-default-features --example figure9 [FILE.svg|FILE.png]
//! ```

mod shared;

use searoom::pipeline;
use searoom::report::figure::{FigureError, control_figure};
use searoom::scenario::Scenario;

fn main() -> Result<(), FigureError> {
    let text = include_str!("../scenarios/paper/figure_9.toml");
    let run = pipeline::run(Scenario::parse(text).expect("a sound scenario"));
    let figure = control_figure(&run).expect("a plan");
    shared::write(figure, "figure9.svg")
}
