//! The stay at the last waypoint, in words.

use super::PlanDocument;
use crate::document::SampleDocument;
use crate::frame::Vector;
use crate::text::{Times, tenths};
use crate::tolerance;

/// How own ship lies at the last waypoint after her arrival.
pub(crate) struct Stay {
    /// Seconds.
    until: f64,
    /// Seconds at which she clears her place and is back, and metres to the farthest sample; the
    /// second is the end of a motion that does not return.
    away: Option<[f64; 3]>,
}

impl PlanDocument {
    /// The stay of the mission and what the motion makes of it; `None` where none is asked for.
    pub(crate) fn stay(&self) -> Option<Stay> {
        let until = self.mission.stay_until_s?;
        let place = self.mission.waypoints.last()?.point();
        let samples = &self.trajectory.as_ref()?.samples;
        let off =
            |sample: &SampleDocument| (Vector::new(sample.east_m, sample.north_m) - place).norm();
        let off: Vec<f64> = samples.iter().map(off).collect();
        let is_off = |off: &f64| *off > tolerance::ARRIVAL_M;
        let arrived = off.iter().position(|off| !is_off(off));
        let away = arrived.and_then(|arrived| {
            let leaves = arrived + off[arrived..].iter().position(is_off)?;
            let last = off.iter().rposition(is_off)?;
            let back = samples.get(last + 1).unwrap_or(&samples[last]);
            let farthest = off[leaves..].iter().copied().fold(0.0, f64::max);
            Some([samples[leaves - 1].t_s, back.t_s, farthest])
        });
        Some(Stay { until, away })
    }
}

impl Stay {
    pub(crate) fn words(&self, times: Times) -> String {
        let until = times.at(self.until, 0);
        match self.away {
            None => format!("at the last waypoint until {until}"),
            Some([leaves, back, farthest]) => format!(
                "at the last waypoint until {until}, but off it from {} to {}, at most {} m",
                times.at(leaves, 0),
                times.at(back, 0),
                tenths(farthest)
            ),
        }
    }
}
