//! Figure 3 of the paper: the risk of the polytope and of the ellipsoid at 0, 40 and 100 seconds.
//!
//! ```text
//! cargo run --release --no-default-features --example figure3 [FILE.svg|FILE.png]
//! ```

mod shared;

use searoom::frame::Vector;
use searoom::geometry::Window;
use searoom::report::figure::{Figure, FigureError, risk_panel};

fn main() -> Result<(), FigureError> {
    let window = Window::new(Vector::new(-20.0, -75.0), Vector::new(140.0, 75.0));
    let mut panels = Vec::new();
    for (kind, target) in [
        ("polytope", shared::figure_1()),
        ("ellipsoid", shared::figure_2()),
    ] {
        for time in [0.0, 40.0, 100.0] {
            let title = format!("Risk of the {kind} at {time} s");
            panels.push(risk_panel(
                &title,
                std::slice::from_ref(&target),
                time,
                window,
            ));
        }
    }
    shared::write(Figure::new(3, panels), "figure3.svg")
}
