//! The motion of own ship that is shown.

use crate::frame::{Pose, heading_of};
use crate::tolerance;
use crate::trajectory::{DesiredLeg, DesiredTrajectory, Trajectory};

#[derive(Debug, Clone, Copy)]
pub enum ShownMotion<'a> {
    Planned(&'a Trajectory),
    /// Without a plan: own ship as if it followed the desired trajectory. The views then show what
    /// is in its way.
    Nominal(&'a DesiredTrajectory),
}

impl ShownMotion<'_> {
    pub fn is_planned(&self) -> bool {
        matches!(self, Self::Planned(_))
    }

    /// The part of rising `times` until the plan has arrived: nothing is claimed after that.
    pub fn until_arrival<'t>(&self, times: &'t [f64]) -> &'t [f64] {
        match self {
            Self::Planned(plan) => {
                let end = plan.end_time() + tolerance::TIME_S;
                &times[..times.partition_point(|t| *t <= end)]
            }
            Self::Nominal(_) => times,
        }
    }

    /// Seconds.
    pub fn end(&self) -> f64 {
        match self {
            Self::Planned(trajectory) => trajectory.end_time(),
            Self::Nominal(desired) => desired.duration(),
        }
    }

    /// Seconds at which the speed may change, the start among them.
    pub fn speed_changes(&self) -> Vec<f64> {
        match self {
            Self::Planned(trajectory) => trajectory.joints(),
            Self::Nominal(desired) => desired.legs().iter().map(|l| l.start_time).collect(),
        }
    }

    pub fn pose_at(&self, time: f64) -> Pose {
        match self {
            Self::Planned(trajectory) => trajectory.pose_at(time),
            Self::Nominal(desired) => Pose::new(
                desired.position_at(time),
                heading_of(desired_leg(desired, time).direction),
            ),
        }
    }

    pub fn speed_at(&self, time: f64) -> f64 {
        match self {
            Self::Planned(trajectory) => trajectory.speed_at(time),
            Self::Nominal(desired) => desired_leg(desired, time).speed,
        }
    }
}

/// The leg that own ship should be on at `time`.
pub fn desired_leg(desired: &DesiredTrajectory, time: f64) -> &DesiredLeg {
    let legs = desired.legs();
    let index = legs.partition_point(|leg| leg.end_time() <= time);
    &legs[index.min(legs.len() - 1)]
}
