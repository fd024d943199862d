//! Roles over time with hysteresis: a role begins with risk and lasts until the risk is over
//! (docs/colregs.md 1.3, Rule 13(d)).

use super::samples::{EncounterSample, EncounterSamples};
use crate::colregs::{Role, Thresholds, role_within};

/// A role and the time interval in which own ship has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoleInterval {
    /// Never [`Role::None`] and never [`Role::Static`].
    pub role: Role,
    /// Seconds.
    pub from: f64,
    /// Seconds.
    pub until: f64,
}

/// Rule 7: the range shrinks, and two ships that hold course and speed will soon be near.
fn at_risk(sample: &EncounterSample, length: f64, t: &Thresholds) -> bool {
    let ahead = sample.ahead();
    sample.opening() < 0.0
        && ahead.time >= 0.0
        && ahead.time <= t.risk.time
        && ahead.distance <= t.risk.lengths * length
}

/// The range grows, or holding course and speed leads well clear.
fn is_over(sample: &EncounterSample, length: f64, t: &Thresholds) -> bool {
    past_and_clear(sample, length, t)
        || sample.ahead().time < 0.0
        || sample.ahead().distance > t.risk.lengths * t.risk.release_factor * length
}

fn past_and_clear(sample: &EncounterSample, length: f64, t: &Thresholds) -> bool {
    sample.opening() > t.sectors.closing && sample.apart > t.score.least_lengths * length
}

/// Roles of own ship toward the target, in order of time. A role begins with the first of
/// `evaluations` consecutive samples at risk (at once at the very first sample), and ends with the
/// first of as many at which the risk is over. If the risk returns before the target is past and
/// clear, so does the role: no later change of bearing turns an overtaking ship into a crossing
/// one.
pub fn roles(encounter: &EncounterSamples, t: &Thresholds) -> Vec<RoleInterval> {
    let length = encounter.length();
    let mut intervals: Vec<RoleInterval> = Vec::new();
    let mut active = false;
    let mut held: Option<Role> = None;
    // number of consecutive samples that ask for a change, and the time of the first
    let (mut asking, mut since) = (0, 0.0);
    for (index, sample) in encounter.samples().iter().enumerate() {
        if !active && past_and_clear(sample, length, t) {
            held = None;
        }
        let change = if active {
            is_over(sample, length, t)
        } else {
            at_risk(sample, length, t)
        };
        if !change {
            asking = 0;
        } else {
            if asking == 0 {
                since = sample.time;
            }
            asking += 1;
            if asking >= t.risk.evaluations || index == 0 {
                asking = 0;
                if active {
                    active = false;
                    if let Some(interval) = intervals.last_mut() {
                        interval.until = since;
                    }
                    continue;
                }
                let raw = role_within(&sample.own, &sample.target, &t.sectors);
                let role = held.or(raw);
                if let Some(role) = role.filter(|r| !matches!(r, Role::None | Role::Static)) {
                    active = true;
                    held = Some(role);
                    intervals.push(RoleInterval {
                        role,
                        from: since,
                        until: since,
                    });
                }
            }
        }
        if active && let Some(interval) = intervals.last_mut() {
            interval.until = sample.time;
        }
    }
    intervals
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::super::tests::{planned, standard, steady};
    use super::*;

    fn of(own: &crate::trajectory::Trajectory, x: f64, y: f64, heading: f64, u: f64) -> Vec<Role> {
        let encounter = steady(own, x, y, heading, u);
        let intervals = roles(&encounter, standard());
        for s in &intervals {
            assert!(s.from <= s.until);
        }
        intervals.iter().map(|s| s.role).collect()
    }

    /// docs/colregs.md 0.1: each fixture has its role all the time, on a straight course and on one
    /// that bears away.
    #[test]
    fn a_role_is_kept_while_own_ship_manoeuvres() {
        let straight = planned(&[(0.0, 240.0)], 6.0);
        let away = planned(&[(0.0, 20.0), (-0.7, 60.0), (0.9, 60.0), (-0.2, 60.0)], 6.0);
        for own in [&straight, &away] {
            assert_eq!(of(own, 1440.0, 0.0, PI, 6.0), [Role::HeadOn]);
            assert_eq!(of(own, 720.0, -720.0, FRAC_PI_2, 6.0), [Role::GiveWay]);
            assert_eq!(of(own, 720.0, 720.0, -FRAC_PI_2, 6.0), [Role::StandOn]);
        }
        assert_eq!(of(&straight, 432.0, 0.0, 0.0, 2.4), [Role::Overtaking]);
        assert_eq!(of(&straight, -432.0, 0.0, 0.0, 9.6), [Role::Overtaken]);
        // well clear, and at rest: no role
        assert!(of(&straight, 1440.0, 900.0, PI, 6.0).is_empty());
        assert!(of(&straight, 700.0, 0.0, PI, 0.0).is_empty());
    }

    /// An overtaking ship that steers across the other's course from its quarter is still
    /// overtaking it.
    #[test]
    fn bearing_that_changes_later_makes_no_crossing_ship() {
        let weaving = [
            (0.0, 30.0),
            (0.5, 25.0),
            (-1.0, 30.0),
            (0.5, 60.0),
            (0.4, 30.0),
            (-0.8, 90.0),
        ];
        let own = planned(&weaving, 6.0);
        let roles = of(&own, 432.0, 0.0, 0.0, 2.4);
        assert!(
            !roles.is_empty() && roles.iter().all(|r| *r == Role::Overtaking),
            "{roles:?}"
        );
    }
}
