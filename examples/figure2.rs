//! Figure 2 of the paper: an ellipsoid, its two sets (20) and (21) and its sections over time, in
//! top view and side view.
//!
//! ```text
//! cargo run --release --no-default-features --example figure2 [FILE.svg|FILE.png]
//! ```

mod shared;

use searoom::report::figure::FigureError;

fn main() -> Result<(), FigureError> {
    let figure = shared::sets_figure(&shared::figure_2(), &shared::figure_2_velocities());
    shared::write(figure, "figure2.svg")
}
