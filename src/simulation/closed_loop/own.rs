//! Own ship: where it is, and how it moves along its plan.

use super::contact::OwnMotion;
use super::forces::ForcedShip;
use super::guidance::follow;
use super::stream::{Purpose, normal, stream};
use super::vessel::{Vessel, VesselState};
use crate::colregs::SteadyShip;
use crate::frame::{Pose, Vector, heading_of};
use crate::scenario::{Current, Scenario, VesselModel};
use crate::trajectory::{Segment, Trajectory};
use crate::vessel::StateVector;
use rand_chacha::ChaCha8Rng;

/// m/s. A slower ship has no course over ground.
pub(super) const NO_WAY: f64 = 1e-3;

/// Own ship, which follows its plan exactly or is steered.
#[derive(Debug, Clone)]
pub(super) struct Own {
    vessel: Vessel,
    /// `None` for a ship that follows its plan exactly, and for one under forces.
    state: Option<VesselState>,
    /// A ship that the forces of its plan drive.
    forced: Option<ForcedShip>,
    max_speed: f64,
    current: Current,
    /// The random part of the current, m/s.
    current_noise: Vector,
    rng: ChaCha8Rng,
}

impl Own {
    pub fn new(scenario: &Scenario) -> Self {
        let (settings, own) = (&scenario.simulation, &scenario.own_ship);
        let model = settings.vessel.unwrap_or(VesselModel::Kinematic);
        let forced = super::is_under_forces(scenario)
            .then(|| ForcedShip::new(scenario.settings.optimal_control, own));
        let perfect =
            forced.is_some() || model == VesselModel::Kinematic && settings.current.is_none();
        let mut rng = stream(settings.seed, Purpose::Current, "current");
        let current_noise = Vector::new(normal(&mut rng), normal(&mut rng)) * settings.current.std;
        Self {
            vessel: Vessel::new(model, own),
            forced,
            state: (!perfect).then_some(VesselState {
                pose: own.pose,
                speed: own.speed,
                turn_rate: 0.0,
                rudder: 0.0,
            }),
            max_speed: own.max_speed(),
            current: settings.current,
            current_noise,
            rng,
        }
    }

    /// Draws anew how the current goes on.
    pub fn reseed(&mut self, seed: u64) {
        self.rng = stream(seed, Purpose::Current, "current");
    }

    /// Own ship's pose, `time` seconds after the start of its plan.
    pub fn pose(&self, plan: &Trajectory, time: f64) -> Pose {
        let forced = self.forced.map(|ship| ship.pose());
        forced
            .or(self.state.map(|state| state.pose))
            .unwrap_or_else(|| plan.pose_at(time))
    }

    /// Own ship on its course at its speed for `duration` seconds.
    pub fn held(&self, scenario: &Scenario, duration: f64) -> Trajectory {
        let (pose, speed) = (scenario.own_ship.pose, scenario.own_ship.speed);
        let forced = self.forced.and_then(|ship| ship.held(duration));
        forced.map_or_else(
            || Trajectory::from(Segment::straight(pose, 0.0, duration, speed)),
            Trajectory::from,
        )
    }

    /// Own ship's state under the forces of a plan, `ahead` seconds after `time` of the plan.
    pub fn forced_state(&self, plan: &Trajectory, time: f64, ahead: f64) -> Option<StateVector> {
        let mut ship = self.forced?;
        if let Some(plan) = plan.steered() {
            ship.advance(plan, time, ahead);
        }
        Some(ship.state)
    }

    /// Own ship's place, course and speed over ground.
    pub fn steady(&self, plan: &Trajectory, time: f64) -> SteadyShip {
        if let Some(ship) = &self.forced {
            return ship.steady();
        }
        let Some(state) = &self.state else {
            return SteadyShip {
                pose: plan.pose_at(time),
                speed: plan.speed_at(time),
            };
        };
        let velocity = state.pose.ahead() * state.speed + self.current.mean + self.current_noise;
        let mut pose = state.pose;
        if velocity.norm() > NO_WAY {
            pose.heading = heading_of(velocity);
        }
        SteadyShip {
            pose,
            speed: velocity.norm(),
        }
    }

    /// Moves own ship for `step` seconds along its plan; the motion counts from 0.
    pub fn advance(&mut self, plan: &Trajectory, time: f64, step: f64) -> OwnMotion {
        if let (Some(ship), Some(plan)) = (&mut self.forced, plan.steered()) {
            return OwnMotion::Cubic(ship.advance(plan, time, step));
        }
        let Some(state) = &mut self.state else {
            let parts = plan.segments().iter();
            let parts = parts.filter(|s| s.end_time() > time && s.start_time < time + step);
            let parts = parts.map(|s| {
                let part = s.between(time, time + step);
                Segment {
                    start_time: part.start_time - time,
                    ..part
                }
            });
            return OwnMotion::Segments(parts.collect());
        };
        let current = self.current.mean + self.current_noise;
        let known = if self.current.known {
            current
        } else {
            Vector::zeros()
        };
        let order = follow(plan, time, &self.vessel, state, self.max_speed, known);
        let cubic = self.vessel.advance(state, &order, current, step);
        // exact for a Gauss-Markov process
        let kept = (-step / self.current.time).exp();
        let new = Vector::new(normal(&mut self.rng), normal(&mut self.rng));
        self.current_noise =
            self.current_noise * kept + new * (self.current.std * (1.0 - kept * kept).sqrt());
        OwnMotion::Cubic(cubic)
    }
}

/// Adds the motion of a step that begins at `time` to the motion so far. A cubic becomes a line or
/// an arc of its mean speed and turn rate.
pub(super) fn join(sailed: &mut Vec<Segment>, motion: &OwnMotion, time: f64) {
    let parts = match motion {
        OwnMotion::Segments(segments) => segments.clone(),
        OwnMotion::Cubic(cubic) => {
            let way = cubic.positions[1] - cubic.positions[0];
            let turn = cubic.headings[1] - cubic.headings[0];
            vec![Segment {
                start: Pose::new(cubic.positions[0], cubic.headings[0]),
                start_time: 0.0,
                duration: cubic.duration,
                speed: way.norm() / cubic.duration,
                turn_rate: turn / cubic.duration,
            }]
        }
    };
    for part in parts {
        let part = Segment {
            start_time: part.start_time + time,
            ..part
        };
        match sailed.last_mut().filter(|last| last.is_continued_by(&part)) {
            Some(last) => last.duration = part.end_time() - last.start_time,
            None => sailed.push(part),
        }
    }
}
