//! The tables of a scenario that a campaign shares: own ship on a straight way, planner and loop.

use super::check::{bare, own_ship};
use super::plane::Plane;
use super::planner::{PlannerTable, planner};
use super::simulation::{SimulatedTarget, simulated, simulation};
use super::{Scenario, SimulationSettings, limits};
use searoom_geometry::frame::{Pose, Vector};
use searoom_input::Table;
use searoom_model::trajectory::DesiredTrajectory;

/// Own ship steering east from the origin, from the keys `horizon_s` and `path_length_m` and the
/// tables `own_ship` and `planner`. Plans have `deadline` seconds, which the table cannot change.
pub fn open_water(root: &mut Table, title: &str, deadline: f64) -> Option<Scenario> {
    let horizon = root.required_number("horizon_s", limits::DURATION);
    let path_length = root.required_distance("path_length", limits::LENGTH);
    let start = Pose::new(Vector::zeros(), 0.0);
    let own = root.required_table("own_ship").map(|mut table| {
        for key in ["position", "course_deg", "land_margin_m"] {
            table.forbid(key, "nothing: own ship starts at the origin, in open water");
        }
        own_ship(table, |_| Some(start))
    })?;
    let (own, acceleration) = (own.ship, own.acceleration);
    let length = own.as_ref().map_or(1.0, |own| own.hull.length);
    let planner: PlannerTable = root
        .take("planner")
        .and_then(|field| field.table("a table"))
        .map(|mut table| {
            table.forbid(
                "deadline_s",
                "nothing: no row depends on the clock; `late` counts plans that take longer than \
                 delay_s",
            );
            planner(table, length)
        })
        .unwrap_or_default();
    let (own, horizon) = (own?, horizon?);
    if !limits::WAY.contains(own.speed) {
        // notes the fault
        let mut table = root.required_table("own_ship")?;
        table.required_speed("speed", limits::WAY)?;
    }
    let way = [Vector::zeros(), Vector::new(path_length?, 0.0)];
    let desired = DesiredTrajectory::new(&way, &[own.speed]).ok()?;
    Some(Scenario {
        acceleration,
        deadline,
        ..bare(title, horizon, own, desired, planner, true)
    })
}

/// The table `simulation`, without the motions of targets.
pub fn simulation_of(root: &mut Table) -> SimulationSettings {
    simulation(root, Vec::new())
}

/// The keys of a target that only the simulation uses.
pub fn true_motion(target: &mut Table) -> SimulatedTarget {
    simulated(target, &Plane::in_metres())
}
