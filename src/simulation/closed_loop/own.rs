//! Own ship: where it is, and how it moves along its plan.

use super::forces::ForcedShip;
use super::guidance::follow;
use super::stream::{Purpose, normal, stream};
use super::vessel::{Vessel, VesselState};
use crate::colregs::SteadyShip;
use crate::frame::{Pose, Vector, heading_of};
use crate::scenario::{Current, Scenario, VesselModel};
use crate::trajectory::{GroundSegment, Segment, Trajectory};
use crate::vessel::StateVector;
use rand_chacha::ChaCha8Rng;

/// m/s. A slower ship has no course over ground.
pub(super) const NO_WAY: f64 = 1e-3;

/// Seconds. Longest arc of a ship that is steered.
const ARC_S: f64 = 0.5;

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

    /// Speed of the current, m/s.
    pub fn current_speed(&self) -> f64 {
        (self.current.mean + self.current_noise).norm()
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

    /// Moves own ship for `step` seconds along its plan; the motion counts from 0. A ship that is
    /// steered moves on lines and arcs of at most [`ARC_S`].
    pub fn advance(&mut self, plan: &Trajectory, time: f64, step: f64) -> Vec<GroundSegment> {
        if let (Some(ship), Some(plan)) = (&mut self.forced, plan.steered()) {
            return arcs(ship.pose(), step, |begun, part| {
                ship.advance(plan, time + begun, part);
                ship.pose()
            });
        }
        let Some(state) = &mut self.state else {
            let parts = plan.segments().iter();
            let parts = parts.filter(|s| s.end_time() > time && s.start_time < time + step);
            let parts = parts.map(|s| GroundSegment::from(s.part(time, time + step, time)));
            return parts.collect();
        };
        let current = self.current.mean + self.current_noise;
        let known = if self.current.known {
            current
        } else {
            Vector::zeros()
        };
        let order = follow(plan, time, &self.vessel, state, self.max_speed, known);
        let motion = arcs(state.pose, step, |_, part| {
            self.vessel.advance(state, &order, current, part);
            state.pose
        });
        // exact for a Gauss-Markov process
        let kept = (-step / self.current.time).exp();
        let new = Vector::new(normal(&mut self.rng), normal(&mut self.rng));
        self.current_noise =
            self.current_noise * kept + new * (self.current.std * (1.0 - kept * kept).sqrt());
        motion
    }
}

/// The arcs of a step from a pose, each to where `advance` ends. That is given the seconds since the
/// step began, and those of the arc.
fn arcs(from: Pose, step: f64, mut advance: impl FnMut(f64, f64) -> Pose) -> Vec<GroundSegment> {
    let count = (step / ARC_S).ceil().max(1.0);
    let part = step / count;
    let mut from = from;
    let arc = |k: u32| {
        let begun = part * f64::from(k);
        let to = advance(begun, part);
        GroundSegment::through([std::mem::replace(&mut from, to), to], begun, part)
    };
    (0..count as u32).map(arc).collect()
}

/// Adds the motion of a step that begins at `time` to the motion so far.
pub(super) fn join(sailed: &mut Vec<GroundSegment>, motion: &[GroundSegment], time: f64) {
    for part in motion {
        let mut part = *part;
        part.track.start_time += time;
        match sailed.last_mut().filter(|last| last.is_continued_by(&part)) {
            Some(last) => last.track.duration = part.track.end_time() - last.track.start_time,
            None => sailed.push(part),
        }
    }
}
