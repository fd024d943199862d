//! Figure 4 of the paper: dCPA over own velocities from (50, 50) m, and the velocity obstacle in
//! white, for the polytope and the ellipsoid.
//!
//! ```text
//! cargo run --release --no-default-features --example figure4 [FILE.svg|FILE.png]
//! ```

mod shared;

use searoom::frame::Vector;
use searoom::geometry::Window;
use searoom::report::figure::{Figure, FigureError, VelocityWindow, dcpa_panel};

fn main() -> Result<(), FigureError> {
    let shown = VelocityWindow {
        window: Window::new(Vector::new(-2.0, -2.0), Vector::new(3.0, 2.0)),
        own: None,
    };
    let from = Vector::new(50.0, 50.0);
    let panel = |title: &str, target| dcpa_panel(title, &[target], from, f64::INFINITY, &shown);
    let panels = vec![
        panel("dCPA, polytope", shared::figure_1()),
        panel("dCPA, ellipsoid", shared::figure_2()),
    ];
    shared::write(Figure::new(2, panels), "figure4.svg")
}
