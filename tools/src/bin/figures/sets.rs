//! Figures of one polytope and one ellipsoid: their sets, risk, closest approach and projection.

use std::error::Error;

use nalgebra::Matrix2;
use searoom::frame::{Pose, Vector, heading_of};
use searoom::geometry::{ConvexPolygon, ConvexSet, Ellipse, Window};
use searoom::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle};
use searoom::planner::{Objective, Problem, path_time};
use searoom::report::figure::{
    Figure, ProfileLine, Stroke, VelocityWindow, dcpa_panel, extent_panel, path_panel,
    path_time_panel, risk_panel, sections_panel, set_panel,
};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::{Hull, OwnShip};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Figure 1: a polytope, its two sets (10) and (11) and its sections over time, in top view and
/// side view.
pub fn polytope() -> Result<Figure> {
    let target = the_polytope()?;
    let velocities = ConvexSet::Polygon(target.velocity().clone());
    Ok(sets_figure(&target.into(), &velocities))
}

/// Figure 2: an ellipsoid, its two sets (20) and (21) and its sections over time, in top view and
/// side view.
pub fn ellipsoid() -> Result<Figure> {
    let target = the_ellipsoid()?;
    let velocities = ConvexSet::Ellipse(*target.velocity());
    Ok(sets_figure(&target.into(), &velocities))
}

/// Figure 3: the risk of the polytope and of the ellipsoid at 0, 40 and 100 seconds.
pub fn risk() -> Result<Figure> {
    let window = Window::new(Vector::new(-20.0, -75.0), Vector::new(140.0, 75.0));
    let mut panels = Vec::new();
    for (kind, target) in both()? {
        for time in [0.0, 40.0, 100.0] {
            let title = format!("Risk of the {kind} at {time} s");
            let targets = std::slice::from_ref(&target);
            panels.push(risk_panel(&title, targets, time, window));
        }
    }
    Ok(Figure::new(3, panels))
}

/// Figure 4: dCPA over own velocities from (50, 50) m, and the velocity obstacle in white, for the
/// polytope and the ellipsoid.
pub fn closest_approach() -> Result<Figure> {
    let shown = VelocityWindow {
        window: Window::new(Vector::new(-2.0, -2.0), Vector::new(3.0, 2.0)),
        own: None,
    };
    let from = Vector::new(50.0, 50.0);
    let panel = |(kind, target)| {
        dcpa_panel(
            &format!("dCPA, {kind}"),
            &[target],
            from,
            f64::INFINITY,
            &shown,
        )
    };
    Ok(Figure::new(2, both()?.map(panel).into()))
}

/// Figure 5: the polytope projected along a path, and the path-time diagram.
pub fn along_a_path() -> Result<Figure> {
    let path = [(20.0, 60.0), (90.0, -60.0)].map(|(x, y)| Vector::new(x, y));
    let own = OwnShip {
        pose: Pose::new(path[0], heading_of(path[1] - path[0])),
        speed: 1.5,
        hull: Hull::new(0.0, 0.0),
        turning_radius: 1.0,
        speeds: vec![1.5],
        safety_margin: 0.0,
        tracking_margin: 0.0,
    };
    let desired = DesiredTrajectory::new(&path, &[1.5])?;
    let obstacles = [the_polytope()?.into()];
    let planned = path_time::plan(&Problem {
        objective: Objective::Time,
        ..Problem::new(&own, &desired, &obstacles, 200.0)
    });
    let diagram = planned.path_time.ok_or("no path-time diagram")?;
    let line = ProfileLine {
        label: "at most 1.5 m/s".to_owned(),
        diagram: &diagram,
        stroke: Stroke::solid("#000000", 2.4),
    };
    let times = [0.0, 30.0, 60.0, 90.0];
    let panels = vec![
        path_panel("Space-time polytope and path", &obstacles, &times, &path),
        path_time_panel("Path-time diagram", &["polytope"], &[line]),
    ];
    Ok(Figure::new(2, panels))
}

/// Obstacle of paper eqs. (10) and (11), metres and m/s.
fn the_polytope() -> Result<PolytopeObstacle> {
    let polygon = |vertices: [(f64, f64); 4]| {
        ConvexPolygon::from_vertices(&vertices.map(|(east, north)| Vector::new(east, north)))
    };
    Ok(PolytopeObstacle::new(
        "figure 1",
        polygon([(-10.0, -5.0), (-10.0, 5.0), (10.0, 5.0), (10.0, -5.0)])?,
        polygon([(0.8, 0.0), (1.0, -0.25), (1.2, 0.0), (1.0, 0.25)])?,
    ))
}

/// Obstacle of paper eqs. (20) and (21), metres and m/s.
fn the_ellipsoid() -> Result<EllipsoidObstacle> {
    let ellipse =
        |center: Vector, a: f64, b: f64| Ellipse::new(center, Matrix2::new(a * a, 0.0, 0.0, b * b));
    Ok(EllipsoidObstacle::new(
        "figure 2",
        ellipse(Vector::zeros(), 10.0, 5.0)?,
        ellipse(Vector::new(1.0, 0.0), 0.2, 0.25)?,
    ))
}

/// Both obstacles with their names in titles.
fn both() -> Result<[(&'static str, Obstacle); 2]> {
    let (polytope, ellipsoid) = (the_polytope()?, the_ellipsoid()?);
    Ok([
        ("polytope", polytope.into()),
        ("ellipsoid", ellipsoid.into()),
    ])
}

/// The two sets of an obstacle and its sections over time, in top view and side view.
fn sets_figure(target: &Obstacle, velocities: &ConvexSet) -> Figure {
    let times = [0.0, 20.0, 40.0, 60.0, 80.0, 100.0];
    let place = ["East [m]", "North [m]"];
    let speed = ["East velocity [m/s]", "North velocity [m/s]"];
    let panels = vec![
        set_panel("Obstacle set", place, &target.section(0.0)),
        set_panel("Velocity set", speed, velocities),
        sections_panel("Sections over time", std::slice::from_ref(target), &times),
        extent_panel("Space-time obstacle from the side", target, &times, 100.0),
    ];
    Figure::new(2, panels)
}
