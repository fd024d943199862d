//! A scenario built in code, and a planner that is called every 20 s: each plan goes on from the
//! last one, and the target is measured anew. No document is made or read.
//!
//! ```text
//! cargo run --release --no-default-features --example replanning
//! ```

use searoom::frame::{Pose, Vector, heading_from_course_deg};
use searoom::pipeline;
use searoom::replanning::{PreviousPlan, remember};
use searoom::scenario::Scenario;
use searoom::target::{Motion, Representation, ShipTrack, Target};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::{Hull, OwnShip};

const PERIOD_S: f64 = 20.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let own_ship = OwnShip {
        pose: Pose::new(Vector::zeros(), heading_from_course_deg(90.0)),
        speed: 5.0,
        hull: Hull::new(30.0, 8.0),
        turning_radius: 100.0,
        speeds: vec![2.5, 5.0],
        safety_margin: 20.0,
        tracking_margin: 0.0,
    };
    let way = [Vector::zeros(), Vector::new(1500.0, 0.0)];
    let mission = DesiredTrajectory::new(&way, &[own_ship.speed])?;
    let mut scenario = Scenario::new(
        "Crossing",
        400.0,
        own_ship,
        mission.clone(),
        vec![measured(0.0)],
    );

    for cycle in 1..=8 {
        let run = pipeline::run(scenario.clone());
        let (Some(plan), Some(evaluation)) = (run.planned.outcome.plan(), &run.evaluation) else {
            println!("{:3} s  no plan: {}", scenario.time, run.word());
            break;
        };
        println!(
            "{:3} s  {}, arrives at {:.0} s, least clearance {:.0} m",
            scenario.time,
            run.word(),
            scenario.time + plan.trajectory.end_time(),
            evaluation.min_clearance,
        );
        // own ship sails its plan; the roles, the manoeuvre and the sets go on from it
        let now = f64::from(cycle) * PERIOD_S;
        scenario.time = now;
        scenario.own_ship.pose = plan.trajectory.pose_at(PERIOD_S);
        scenario.desired = mission.remaining(now);
        scenario.targets = vec![measured(now)];
        if let Some(previous) = PreviousPlan::of(&run) {
            remember(&previous, &mut scenario)?;
        }
    }
    Ok(())
}

/// What a sensor would say of a target that sails south at 5 m/s, within ±0.5 m/s and ±5°.
fn measured(time: f64) -> Target {
    let place = Vector::new(750.0, 750.0 - 5.0 * time);
    let pose = Pose::new(place, heading_from_course_deg(180.0));
    Target {
        name: "ferry".to_owned(),
        motion: Motion::Ship(ShipTrack {
            speed_spread: 0.5,
            course_spread: 5.0_f64.to_radians(),
            ..ShipTrack::exact(pose, 5.0, Hull::new(60.0, 12.0))
        }),
        representation: Representation::Polytope,
        status: None,
    }
}
