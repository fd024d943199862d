//! Measures the excess of the outer ellipse over the sum that it contains: the table in
//! `docs/reference/sets.md`.
//!
//! `cargo test --no-default-features --test sets outer_excess -- --nocapture` prints it.

use nalgebra::Matrix2;
use searoom::frame::Vector;
use searoom::geometry::{ConvexPolygon, Ellipse};
use searoom::obstacle::{EllipsoidObstacle, PolytopeObstacle};

/// Ratios of the time to `d = sqrt(trace Q_o / trace Q_v)`.
const SHARES: [f64; 7] = [0.0, 0.1, 0.5, 1.0, 2.0, 10.0, 100.0];

fn ellipse(along: f64, across: f64) -> Ellipse {
    let shape = Matrix2::new(along * along, 0.0, 0.0, across * across);
    Ellipse::new(Vector::zeros(), shape).expect("a shape")
}

fn row(name: &str, of: impl Fn(f64) -> f64) -> String {
    let cells: Vec<String> = SHARES
        .iter()
        .map(|s| format!("{:.1}", (100.0 * of(*s)).max(0.0)))
        .collect();
    format!("| {name} | {} |", cells.join(" | "))
}

fn ellipses(name: &str, initial: Ellipse, velocity: Ellipse) -> String {
    let trace = |e: &Ellipse| e.shape().trace().sqrt();
    let d = trace(&initial) / trace(&velocity);
    let o = EllipsoidObstacle::new(name, initial, velocity);
    // tangents of the exact sum, a ten-millionth larger
    let sum = |t: f64| {
        let [initial, velocity] = [o.initial(), o.velocity()].map(|e| e.outer_polygon(4096));
        initial.minkowski_sum(&velocity.scaled(t)).area()
    };
    row(name, |share| {
        let (sum, outer) = (sum(share * d), o.outer_section(share * d).area());
        if sum > 0.0 { outer / sum - 1.0 } else { 0.0 }
    })
}

fn rectangle(along: f64, across: f64) -> ConvexPolygon {
    ConvexPolygon::rectangle(Vector::zeros(), along, across)
}

/// Compares the smallest ellipses around two rectangles with the polytope of the rectangles.
fn polytope(name: &str, initial: ConvexPolygon, velocity: ConvexPolygon) -> String {
    let inner = PolytopeObstacle::new(name, initial, velocity);
    let outer = EllipsoidObstacle::outer_of(&inner);
    let trace = |e: &Ellipse| e.shape().trace().sqrt();
    let d = trace(outer.initial()) / trace(outer.velocity());
    row(name, |share| {
        let t = share * d;
        outer.outer_section(t).area() / inner.section(t).area() - 1.0
    })
}

#[test]
fn the_table_in_the_documents_is_what_the_sets_give() {
    let rows = [
        ellipses(
            "paper, figure 2: 10 × 5 m, 0.2 × 0.25 m/s",
            ellipse(10.0, 5.0),
            ellipse(0.2, 0.25),
        ),
        ellipses(
            "similar shapes: 10 × 5 m, 0.4 × 0.2 m/s",
            ellipse(10.0, 5.0),
            ellipse(0.4, 0.2),
        ),
        ellipses(
            "circle and needle: 10 × 10 m, 0.05 × 0.5 m/s",
            ellipse(10.0, 10.0),
            ellipse(0.05, 0.5),
        ),
        ellipses(
            "crossed: 50 × 10 m, 0.1 × 0.5 m/s",
            ellipse(50.0, 10.0),
            ellipse(0.1, 0.5),
        ),
        ellipses(
            "crossed segments: 50 m, 0.5 m/s",
            ellipse(50.0, 0.0),
            ellipse(0.0, 0.5),
        ),
        polytope(
            "ellipses around rectangles: 50 × 10 m, 0.1 × 0.5 m/s",
            rectangle(50.0, 10.0),
            rectangle(0.1, 0.5),
        ),
    ];
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/reference/sets.md");
    let text = std::fs::read_to_string(path).expect("docs/reference/sets.md");
    for row in rows {
        assert!(text.contains(&row), "not in docs/reference/sets.md: {row}");
    }
}
