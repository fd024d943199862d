//! Figure 1 of the paper: a polytope, its two sets (10) and (11) and its sections over time, in top
//! view and side view.
//!
//! ```text
//! cargo run --release --no-default-features --example figure1 [FILE.svg|FILE.png]
//! ```

mod shared;

use searoom::report::figure::{Figure, FigureError, extent_panel, sections_panel, set_panel};

fn main() -> Result<(), FigureError> {
    let target = shared::figure_1();
    let times = [0.0, 20.0, 40.0, 60.0, 80.0, 100.0];
    let panels = vec![
        set_panel(
            "Obstacle set",
            ["East [m]", "North [m]"],
            &target.section(0.0),
        ),
        set_panel(
            "Velocity set",
            ["East velocity [m/s]", "North velocity [m/s]"],
            &shared::figure_1_velocities(),
        ),
        sections_panel("Sections over time", std::slice::from_ref(&target), &times),
        extent_panel("Space-time obstacle from the side", &target, &times, 100.0),
    ];
    shared::write(Figure::new(2, panels), "figure1.svg")
}
