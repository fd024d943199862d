//! The stay at the last waypoint, in words.

use searoom_document::{PlanDocument, SampleDocument};

use crate::frame::Vector;
use crate::text::{Times, significant};
use crate::tolerance;
use crate::trajectory::DesiredTrajectory;

/// How own ship keeps a stay at the last waypoint.
pub(crate) struct Stay {
    /// Seconds.
    until: f64,
    kept: Kept,
}

enum Kept {
    /// The motion does not come to the place.
    Never,
    /// It comes there at a time, seconds, when the stay is over.
    TooLate(f64),
    /// It lies there from its arrival on.
    Always,
    /// It clears the place at a time, seconds, is up to about some metres away, and is back at
    /// another time, or not at all.
    Interrupted(f64, f64, Option<f64>),
}

/// The stay of the mission and what the motion makes of it; `None` where none is asked for.
pub(crate) fn stay(plan: &PlanDocument) -> Option<Stay> {
    let until = plan.mission.stay_until_s?;
    let points: Vec<Vector> = (plan.mission.waypoints.iter())
        .map(|point| point.point())
        .collect();
    let place = *points.last()?;
    let samples = &plan.trajectory.as_ref()?.samples;
    let at = |sample: &SampleDocument| Vector::new(sample.east_m, sample.north_m);
    let off = samples.iter().map(|sample| (at(sample) - place).norm());
    let off: Vec<f64> = off.collect();
    let is_off = |off: &f64| *off > tolerance::ARRIVAL_M;
    let desired = DesiredTrajectory::new(&points, &plan.mission.leg_speeds_mps).ok()?;
    // a round trip begins at its end
    let begins = match desired.comes_by(at(samples.first()?)) {
        true => off.iter().position(is_off).unwrap_or(off.len()),
        false => 0,
    };
    let arrived = off[begins..].iter().position(|off| !is_off(off));
    let kept = match arrived.map(|arrived| begins + arrived) {
        None => Kept::Never,
        Some(arrived) if samples[arrived].t_s > until => Kept::TooLate(samples[arrived].t_s),
        Some(arrived) => match off[arrived..].iter().position(is_off) {
            None => Kept::Always,
            Some(leaves) => {
                let leaves = arrived + leaves;
                let last = off.iter().rposition(is_off)?;
                let farthest = off[leaves..].iter().copied().fold(0.0, f64::max);
                let back = samples.get(last + 1).map(|sample| sample.t_s);
                Kept::Interrupted(samples[leaves - 1].t_s, farthest, back)
            }
        },
    };
    Some(Stay { until, kept })
}

impl Stay {
    /// True where the motion comes to the place.
    pub(crate) fn begins(&self) -> bool {
        !matches!(self.kept, Kept::Never)
    }

    pub(crate) fn words(&self, times: Times) -> String {
        let until = times.at(self.until, 0);
        match self.kept {
            Kept::Never => {
                format!("own ship does not come to the last waypoint, to stay until {until}")
            }
            Kept::TooLate(arrives) => {
                let arrives = times.at(arrives, 0);
                format!("over at {until}, before own ship arrives at {arrives}")
            }
            Kept::Always => format!("at the last waypoint until {until}"),
            Kept::Interrupted(leaves, farthest, back) => {
                let (leaves, farthest) = (times.at(leaves, 0), significant(farthest));
                let back = match back {
                    Some(back) => format!("to {}", times.at(back, 0)),
                    None => "on, without a return".to_owned(),
                };
                format!(
                    "at the last waypoint until {until}, but off it from {leaves} {back}, about \
                     {farthest} m at most"
                )
            }
        }
    }
}
