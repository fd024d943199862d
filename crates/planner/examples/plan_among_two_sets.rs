//! What is a cheap motion among two ships whose velocities are sets, and how large a graph was
//! searched for it? A* and Dijkstra's algorithm search the same graph.
//!
//! ```text
//! cargo run -p searoom-planner --example plan_among_two_sets
//! ```

use searoom_geometry::frame::{Pose, Vector, clockwise_deg};
use searoom_geometry::{ConvexPolygon, outer_disc};
use searoom_model::trajectory::DesiredTrajectory;
use searoom_model::vessel::{Hull, OwnShip};
use searoom_planner::{Problem, SearchKind, Tidiness, space_time};
use searoom_sets::{Obstacle, PolytopeObstacle};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let own = OwnShip {
        pose: Pose::new(Vector::zeros(), 0.0),
        speed: 5.0,
        hull: Hull::new(30.0, 8.0),
        turning_radius: 100.0,
        speeds: vec![2.5, 5.0, 6.0],
        safety_margin: 30.0,
        tracking_margin: 0.0,
    };
    let desired = DesiredTrajectory::new(&[Vector::zeros(), Vector::new(2000.0, 0.0)], &[5.0])?;
    // discs of 120 m that contain own hull and its margin; velocities within 0.5 m/s
    let set = |name: &str, place, velocity| -> Obstacle {
        let initial = outer_disc(120.0, 0.0).translated(place);
        let velocities = ConvexPolygon::rectangle(velocity, 0.5, 0.5);
        PolytopeObstacle::new(name, initial, velocities).into()
    };
    let sets = [
        set("ferry", Vector::new(900.0, 800.0), Vector::new(0.0, -4.0)),
        set(
            "coaster",
            Vector::new(1900.0, 100.0),
            Vector::new(-3.0, 0.0),
        ),
    ];
    for search in [SearchKind::AStar, SearchKind::Dijkstra] {
        let planned = space_time::plan(&Problem {
            search,
            tidy: Some(Tidiness::at_length(own.hull.length)),
            ..Problem::new(&own, &desired, &sets, 800.0)
        });
        let plan = planned.outcome.plan().ok_or("no plan")?;
        let (nodes, tested) = (planned.explored.node_count(), planned.explored.edge_count());
        println!(
            "{}: {nodes} nodes, {tested} edges tested, J {:.0} m²",
            search.label(),
            plan.cost
        );
        for part in plan.trajectory.segments() {
            let turn = clockwise_deg(part.turn_rate * part.duration);
            println!(
                "  {:4.0} s {turn:+4.0}° at {:.1} m/s",
                part.start_time, part.speed
            );
        }
    }
    Ok(())
}
