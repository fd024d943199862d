//! Roles over time: taken when there is risk, kept until it is over (docs/colregs.md 1.3, Rule 13(d)).

use super::super::role::{Role, role_within};
use super::meeting::{Meeting, Sight};
use super::thresholds::Thresholds;

/// A role and when own ship has it.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::colregs::conduct::{RoleSpell, Thresholds};
///
/// let scenario = Scenario::read("scenarios/colregs/stand-on.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let thresholds = Thresholds::standard();
/// let toward_the_ferry = run.conduct(thresholds).remove(0).expect("a plan among ships");
/// let first: &RoleSpell = &toward_the_ferry.roles[0];
/// assert_eq!((first.role.name(), first.from), ("stand-on", 0.0));
/// assert!(first.until < 150.0, "seconds; then she is past");
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoleSpell {
    /// Never [`Role::None`] and never [`Role::Static`].
    pub role: Role,
    /// Seconds.
    pub from: f64,
    /// Seconds.
    pub until: f64,
}

/// Rule 7: the range shrinks, and two ships that held course and speed would soon be near.
fn at_risk(sight: &Sight, length: f64, t: &Thresholds) -> bool {
    let ahead = sight.ahead();
    sight.opening() < 0.0
        && ahead.time >= 0.0
        && ahead.time <= t.risk.time
        && ahead.distance <= t.risk.lengths * length
}

/// The range grows, or holding on leads well clear.
fn is_over(sight: &Sight, length: f64, t: &Thresholds) -> bool {
    past_and_clear(sight, length, t)
        || sight.ahead().time < 0.0
        || sight.ahead().distance > t.risk.lengths * t.risk.release_factor * length
}

fn past_and_clear(sight: &Sight, length: f64, t: &Thresholds) -> bool {
    sight.opening() > t.sectors.closing && sight.apart > t.score.least_lengths * length
}

/// The roles of own ship toward the target, in order of time. A role begins with the first of so many sights at risk one after
/// another, at the very first sight at once, and ends with the first of so many at which the risk is over. Risk that comes back
/// before the target is past and clear is that of the same role: no later change of bearing makes a crossing ship of an
/// overtaking one.
pub fn roles(meeting: &Meeting, t: &Thresholds) -> Vec<RoleSpell> {
    let length = meeting.length();
    let mut spells: Vec<RoleSpell> = Vec::new();
    let mut active = false;
    let mut latched: Option<Role> = None;
    // how many sights one after another ask for a change, and the first of them
    let (mut asking, mut since) = (0, 0.0);
    for (index, sight) in meeting.sights().iter().enumerate() {
        if !active && past_and_clear(sight, length, t) {
            latched = None;
        }
        let change = if active {
            is_over(sight, length, t)
        } else {
            at_risk(sight, length, t)
        };
        if !change {
            asking = 0;
        } else {
            if asking == 0 {
                since = sight.time;
            }
            asking += 1;
            if asking >= t.risk.evaluations || index == 0 {
                asking = 0;
                if active {
                    active = false;
                    if let Some(spell) = spells.last_mut() {
                        spell.until = since;
                    }
                    continue;
                }
                let raw = role_within(&sight.own, &sight.target, &t.sectors);
                let role = latched.or(raw);
                if let Some(role) = role.filter(|r| !matches!(r, Role::None | Role::Static)) {
                    active = true;
                    latched = Some(role);
                    spells.push(RoleSpell {
                        role,
                        from: since,
                        until: since,
                    });
                }
            }
        }
        if active && let Some(spell) = spells.last_mut() {
            spell.until = sight.time;
        }
    }
    spells
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::super::tests::{planned, standard, steady};
    use super::*;

    fn of(own: &crate::trajectory::Trajectory, x: f64, y: f64, heading: f64, u: f64) -> Vec<Role> {
        let meeting = steady(own, x, y, heading, u);
        let spells = roles(&meeting, standard());
        for s in &spells {
            assert!(s.from <= s.until);
        }
        spells.iter().map(|s| s.role).collect()
    }

    /// docs/colregs.md 0.1: each fixture has its role all along, on a straight course and on one that bears away.
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

    /// An overtaking ship that steers across the other's course from her quarter is still overtaking her.
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
