//! Roles over time: a role begins with risk of collision and lasts until the target is past and
//! clear (docs/reference/colregs.md, section 1.3, Rule 13(d)).

use super::samples::{EncounterSample, EncounterSamples};
use crate::{Role, SteadyShip, Thresholds, role_within};

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
fn at_risk(sample: &EncounterSample, encounter: &EncounterSamples, t: &Thresholds) -> bool {
    let ahead = sample.ahead();
    sample.opening() < 0.0
        && ahead.time >= 0.0
        && ahead.time <= t.risk_time(encounter.own_length())
        && ahead.distance <= encounter.risk_distance(t)
}

/// Seconds of the first sample at risk of meeting a ship at rest, toward which there is no role.
pub(super) fn meets_ship_at_rest(encounter: &EncounterSamples, t: &Thresholds) -> Option<f64> {
    let is_at_rest =
        |s: &EncounterSample| role_within(&s.own, &s.target, &t.sectors) == Some(Role::Static);
    let mut samples = encounter.samples().iter();
    let first = samples.find(|s| is_at_rest(s) && at_risk(s, encounter, t))?;
    Some(first.time)
}

/// The other ship is past and clear, Rule 13(d): the range opens, also on own ship's first course,
/// and is large enough. Slackening of speed alone does not let it pass.
fn past_and_clear(
    sample: &EncounterSample,
    first: &SteadyShip,
    length: f64,
    t: &Thresholds,
) -> bool {
    sample.opening() > t.sectors.closing
        && sample.is_past(first)
        && sample.apart >= t.risk.release_lengths * length
}

/// Roles of own ship toward the target, in order of time.
///
/// A role begins with the first of `evaluations` consecutive samples at risk, or at once at the very
/// first sample. The last of them decides which role. It lasts until the first of as many samples at
/// which the target is past and clear. Neither own ship's manoeuvre nor a later change of bearing
/// ends or changes it. A role that is known from before begins when it did.
pub fn roles(encounter: &EncounterSamples, t: &Thresholds) -> Vec<RoleInterval> {
    let length = encounter.length();
    let mut intervals: Vec<RoleInterval> = Vec::new();
    // own ship when the role began
    let mut active: Option<SteadyShip> = None;
    // number of consecutive samples that ask for a change, and the time of the first
    let (mut asking, mut since) = (0, 0.0);
    let mut known = encounter.known_role();
    for (index, sample) in encounter.samples().iter().enumerate() {
        // before a change of speed at the very beginning
        let sample = &match index {
            0 if sample.time >= 0.0 => sample.at_speed(encounter.ordered_speed()),
            _ => *sample,
        };
        if let Some(risk) = known {
            if sample.time < risk.time && index + 1 < encounter.samples().len() {
                continue;
            }
            known = None;
            active = Some(risk.own);
            intervals.push(RoleInterval {
                role: risk.role,
                from: risk.time,
                until: sample.time,
            });
        }
        let change = match &active {
            Some(first) => past_and_clear(sample, first, length, t),
            None => at_risk(sample, encounter, t),
        };
        if change {
            if asking == 0 {
                since = sample.time;
            }
            asking += 1;
        } else {
            asking = 0;
        }
        let begins_at_once = change && index == 0 && active.is_none();
        if asking >= t.risk.evaluations || begins_at_once {
            asking = 0;
            if active.take().is_some() {
                if let Some(interval) = intervals.last_mut() {
                    interval.until = since;
                }
            } else if let Some(role) = role_within(&sample.own, &sample.target, &t.sectors)
                .filter(|role| role.rule().is_some())
            {
                active = Some(sample.own);
                intervals.push(RoleInterval {
                    role,
                    from: since,
                    until: since,
                });
            }
        }
        if active.is_some()
            && let Some(interval) = intervals.last_mut()
        {
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

    fn of(
        own: &searoom_model::trajectory::Trajectory,
        x: f64,
        y: f64,
        heading: f64,
        u: f64,
    ) -> Vec<Role> {
        let encounter = steady(own, x, y, heading, u);
        let intervals = roles(&encounter, standard());
        for s in &intervals {
            assert!(s.from <= s.until);
        }
        intervals.iter().map(|s| s.role).collect()
    }

    /// docs/reference/colregs.md 0.1: each fixture has its role all the time, on a straight course
    /// and on one that bears away.
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
