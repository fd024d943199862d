//! Figure 5 of the paper: a space-time polytope projected along a path, and the path-time diagram.
//!
//! ```text
//! cargo run --release --no-default-features --example figure5 [FILE.svg|FILE.png]
//! ```

mod shared;

use searoom::frame::{Pose, Vector};
use searoom::planner::{Objective, Problem, path_time};
use searoom::report::figure::{
    Figure, FigureError, ProfileLine, Stroke, path_panel, path_time_panel,
};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::{Hull, OwnShip};

fn main() -> Result<(), FigureError> {
    let path = [(20.0, 60.0), (90.0, -60.0)].map(|(x, y)| Vector::new(x, y));
    let way = path[1] - path[0];
    let own = OwnShip {
        pose: Pose::new(path[0], way.y.atan2(way.x)),
        speed: 1.5,
        hull: Hull::new(0.0, 0.0),
        turning_radius: 1.0,
        speeds: vec![1.5],
        safety_margin: 0.0,
        tracking_margin: 0.0,
    };
    let desired = DesiredTrajectory::new(&path, &[1.5]).expect("a leg");
    let obstacles = [shared::figure_1()];
    let planned = path_time::plan(&Problem {
        objective: Objective::Time,
        ..Problem::new(&own, &desired, &obstacles, 200.0)
    });
    let diagram = planned.path_time.expect("a diagram");
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
    shared::write(Figure::new(2, panels), "figure5.svg")
}
