//! A target that is run by this planner: its own closed loop, with the roles exchanged.

use super::Simulation;
use crate::colregs::SteadyShip;
use crate::frame::heading_of;
use crate::scenario::{Behaviour, Fault, Memory, Scenario, SimulationSettings};
use crate::target::{Motion, ShipTrack, Target};
use crate::trajectory::DesiredTrajectory;
use crate::vessel::OwnShip;

/// Speeds of the other ship, fractions of its own speed, as own ship has them by default.
const SPEEDS: [f64; 2] = [0.5, 1.0];

/// m/s. A slower ship has no mission.
pub(super) const NO_WAY: f64 = 0.1;

/// The closed loop of a target, whose only target is own ship.
#[derive(Debug, Clone)]
pub(super) struct MutualTarget(Box<Simulation>);

/// The loops of the targets that have one, in the scenario's order.
pub(super) fn mutual_targets(scenario: &Scenario) -> Result<Vec<Option<MutualTarget>>, Vec<Fault>> {
    let behaviours = scenario.simulation.behaviours.iter().map(Some);
    let behaviours = behaviours.chain(std::iter::repeat(None));
    let targets = scenario.targets.iter().zip(behaviours);
    let mutual_targets = targets.map(|(target, behaviour)| {
        let ship = target
            .ship()
            .filter(|_| behaviour == Some(&Behaviour::Mutual));
        let exchanged = ship.and_then(|ship| exchanged(scenario, target, ship));
        let simulation = exchanged.map(|exchanged| Simulation::new(exchanged, false));
        Ok(simulation
            .transpose()?
            .map(|loop_| MutualTarget(Box::new(loop_))))
    });
    mutual_targets.collect()
}

/// The scenario as the target plans in it: its mission is to keep course and speed, and its
/// estimate of own ship is as good as own ship's of it.
fn exchanged(scenario: &Scenario, target: &Target, ship: &ShipTrack) -> Option<Scenario> {
    let own = &scenario.own_ship;
    let way = ship.pose.ahead() * (ship.speed * scenario.horizon);
    let waypoints = [ship.pose.position, ship.pose.position + way];
    let larger = (ship.hull.length / own.hull.length).max(1.0);
    let own_track = ShipTrack {
        pose: own.pose,
        speed: own.speed,
        hull: own.hull,
        ..ship.clone()
    };
    Some(Scenario {
        title: target.name.clone(),
        horizon: 2.0 * scenario.horizon,
        own_ship: OwnShip {
            pose: ship.pose,
            speed: ship.speed,
            hull: ship.hull,
            turning_radius: larger * own.turning_radius,
            speeds: SPEEDS.map(|factor| factor * ship.speed).to_vec(),
            ..own.clone()
        },
        desired: DesiredTrajectory::new(&waypoints, &[ship.speed]).ok()?,
        time_weight: ship.speed * ship.speed,
        targets: vec![Target {
            name: "own ship".to_owned(),
            motion: Motion::Ship(own_track),
            representation: target.representation,
            status: None,
        }],
        memory: Memory::default(),
        // its mission is a line that may run across land
        land: None,
        // the sensor, the vessel and the current are own ship's
        simulation: SimulationSettings {
            step: scenario.simulation.step,
            replan: scenario.simulation.replan,
            replan_on_events: scenario.simulation.replan_on_events,
            delay: scenario.simulation.delay,
            seed: scenario.simulation.seed,
            ..SimulationSettings::default()
        },
        ..scenario.clone()
    })
}

impl MutualTarget {
    /// Draws anew what is random from now on.
    pub fn reseed(&mut self, seed: u64) {
        self.0.reseed(seed);
    }

    /// Sees own ship, plans where a plan is due, and sets course and speed of the target for a step
    /// so that it is on its plan at the end. At the end of its plan it keeps both. Returns why the
    /// clock cut a plan, if it did: then another run may differ.
    pub fn steer(&mut self, ship: &mut SteadyShip, own: &SteadyShip, step: f64) -> Option<String> {
        let simulation = &mut self.0;
        if simulation.finished() {
            return None;
        }
        for target in &mut simulation.targets {
            target.truth.now = *own;
        }
        simulation.observe_and_plan();
        simulation.advance(step);
        let out_of_time = simulation.out_of_time.take();
        if simulation.finished() {
            return out_of_time;
        }
        let plan = &simulation.active;
        let pose = simulation
            .own
            .pose(&plan.trajectory, simulation.time - plan.start);
        let way = pose.position - ship.pose.position;
        ship.speed = way.norm() / step;
        if ship.speed > NO_WAY {
            ship.pose.heading = heading_of(way);
        }
        out_of_time
    }
}
