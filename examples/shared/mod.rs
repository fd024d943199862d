//! Obstacles of the paper's figures 1 and 2, and output of figures.
#![allow(dead_code, reason = "every figure uses a part")]

use std::path::PathBuf;

use nalgebra::Matrix2;
use searoom::frame::Vector;
use searoom::geometry::{ConvexPolygon, ConvexSet, Ellipse};
use searoom::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle};
use searoom::report::figure::{Figure, FigureError, extent_panel, sections_panel, set_panel};

fn polygon(vertices: [(f64, f64); 4]) -> ConvexPolygon {
    let vertices = vertices.map(|(east, north)| Vector::new(east, north));
    ConvexPolygon::from_vertices(&vertices).expect("convex")
}

fn ellipse(center: Vector, half_axes: [f64; 2]) -> Ellipse {
    let [a, b] = half_axes.map(|a| a * a);
    Ellipse::new(center, Matrix2::new(a, 0.0, 0.0, b)).expect("positive definite")
}

fn polytope() -> PolytopeObstacle {
    PolytopeObstacle::new(
        "figure 1",
        polygon([(-10.0, -5.0), (-10.0, 5.0), (10.0, 5.0), (10.0, -5.0)]),
        polygon([(0.8, 0.0), (1.0, -0.25), (1.2, 0.0), (1.0, 0.25)]),
    )
}

fn ellipsoid() -> EllipsoidObstacle {
    EllipsoidObstacle::new(
        "figure 2",
        ellipse(Vector::zeros(), [10.0, 5.0]),
        ellipse(Vector::new(1.0, 0.0), [0.2, 0.25]),
    )
}

/// Obstacle of paper eqs. (10) and (11).
pub fn figure_1() -> Obstacle {
    polytope().into()
}

/// Velocity set of eq. (11), m/s.
pub fn figure_1_velocities() -> ConvexSet {
    ConvexSet::Polygon(polytope().velocity().clone())
}

/// Obstacle of paper eqs. (20) and (21).
pub fn figure_2() -> Obstacle {
    ellipsoid().into()
}

/// Velocity set of eq. (21), m/s.
pub fn figure_2_velocities() -> ConvexSet {
    ConvexSet::Ellipse(*ellipsoid().velocity())
}

/// The two sets of an obstacle and its sections over time, in top view and side view.
pub fn sets_figure(target: &Obstacle, velocities: &ConvexSet) -> Figure {
    let times = [0.0, 20.0, 40.0, 60.0, 80.0, 100.0];
    let [place, speed] = [
        ["East [m]", "North [m]"],
        ["East velocity [m/s]", "North velocity [m/s]"],
    ];
    let panels = vec![
        set_panel("Obstacle set", place, &target.section(0.0)),
        set_panel("Velocity set", speed, velocities),
        sections_panel("Sections over time", std::slice::from_ref(target), &times),
        extent_panel("Space-time obstacle from the side", target, &times, 100.0),
    ];
    Figure::new(2, panels)
}

/// Writes to the file named by the first argument, or to `name` in the current folder.
pub fn write(figure: Figure, name: &str) -> Result<(), FigureError> {
    let file = std::env::args_os()
        .nth(1)
        .map_or_else(|| name.into(), PathBuf::from);
    figure.write(&file)
}
