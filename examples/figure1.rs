//! Figure 1 of the paper: a polytope, its two sets (10) and (11) and its sections over time, in top
//! view and side view.
//!
//! ```text
//! cargo run --release --no-default-features --example figure1 [FILE.svg|FILE.png]
//! ```

mod shared;

use searoom::report::figure::FigureError;

fn main() -> Result<(), FigureError> {
    let figure = shared::sets_figure(&shared::figure_1(), &shared::figure_1_velocities());
    shared::write(figure, "figure1.svg")
}
