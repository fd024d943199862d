//! Alterations of course: where own ship turned, and by how much.

use super::meeting::Sight;
use crate::frame::wrap;

/// A turn to one side without a break.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alteration {
    /// Seconds.
    pub from: f64,
    /// Seconds.
    pub until: f64,
    /// Radians, to port positive.
    pub turn: f64,
}

/// Every turn that is faster than `least_rate` (rad/s) and in all more than `least_turn` (radians), in order of time.
pub fn alterations(sights: &[Sight], least_rate: f64, least_turn: f64) -> Vec<Alteration> {
    let mut found: Vec<Alteration> = Vec::new();
    for pair in sights.windows(2) {
        let (from, until) = (pair[0].time, pair[1].time);
        let turn = wrap(pair[1].own.pose.heading - pair[0].own.pose.heading);
        if !(turn.abs() > least_rate * (until - from)) {
            continue;
        }
        match found.last_mut() {
            Some(last) if last.until == from && last.turn * turn > 0.0 => {
                last.until = until;
                last.turn += turn;
            }
            _ => found.push(Alteration { from, until, turn }),
        }
    }
    found.retain(|a| a.turn.abs() > least_turn);
    found
}

/// The first sight at which the speed has changed by more than a share of what it was at first, seconds.
pub fn speed_changed(sights: &[Sight], share: f64) -> Option<f64> {
    let first = sights.first()?.own.speed;
    let changed = |s: &&Sight| (s.own.speed - first).abs() > share * first;
    sights.iter().find(changed).map(|s| s.time)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{LENGTH, planned, steady};
    use super::*;

    #[test]
    fn a_turn_out_and_back_are_two_alterations_with_their_angles() {
        let own = planned(&[(0.0, 40.0), (-0.6, 30.0), (0.6, 60.0)], 6.0);
        let meeting = steady(&own, 1440.0, 0.0, std::f64::consts::PI, 6.0);
        let found = alterations(meeting.sights(), 0.005, 0.03);
        let turns: Vec<f64> = found.iter().map(|a| a.turn).collect();
        assert_eq!(turns.len(), 2, "{found:?}");
        assert!((turns[0] + 0.6).abs() < 1e-9 && (turns[1] - 0.6).abs() < 1e-9);
        assert!((found[0].from - 40.0).abs() < 1e-9);
        // an arc of 2.5 lengths
        let arc = 0.6 * 2.5 * LENGTH / 6.0;
        assert!((found[0].until - 40.0 - arc).abs() < 1e-9);
        assert!(alterations(meeting.sights(), 0.005, 0.7).is_empty());
        assert_eq!(speed_changed(meeting.sights(), 0.2), None);
    }
}
