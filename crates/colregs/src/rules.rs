//! The collision regulations as a table: the duties of own ship in each role, and toward all
//! targets.

use super::compliance::Monitor;
use super::role::{Role, SteadyShip};
use super::thresholds::{MonitorLimits, ScoreLimits};
use searoom_geometry::frame::Side;
use searoom_model::vessel::Hull;

/// Radians, 30°: a smaller alteration of course is not readily apparent, Rule 8(b)
/// (docs/reference/colregs.md 2.2).
pub const APPARENT_TURN: f64 = ScoreLimits::STANDARD.apparent;

/// Fraction of the speed before: a reduction to this or less is readily apparent, Rule 8(b).
pub const APPARENT_SPEED: f64 = 0.5;

/// Least seconds at reduced speed, so that it is seen. A choice of ours: at half of 5 m/s a ship
/// makes good 75 m less in this time.
pub const APPARENT_TIME: f64 = 30.0;

/// Radians, 2°: a heading this near to a course is on it.
pub const ON_COURSE: f64 = ScoreLimits::STANDARD.steady;

/// Radians, 20°: more than [`MOST_SMALL_TURNS`] smaller turns are a succession of small
/// alterations, Rule 8(b).
pub const SMALL_TURN: f64 = MonitorLimits::STANDARD.turn;

/// See [`SMALL_TURN`].
pub const MOST_SMALL_TURNS: usize = ScoreLimits::STANDARD.small_turns;

/// Duties of own ship toward one target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RoleDuties {
    /// Number of the rule.
    pub rule: Option<u8>,
    /// Paragraph that a forbidden heading, passing side or crossing ahead violates.
    pub paragraph: Option<Paragraph>,
    /// How the two ships meet.
    pub situation: Option<Situation>,
    /// Keeps clear by a readily apparent alteration: Rules 13 to 16.
    pub keeps_clear: bool,
    /// Keeps course and speed: Rule 17, and the overtaken ship.
    pub stands_on: bool,
    /// When a ship that stands on may act, Rule 17(a)(ii).
    pub may_act: MayAct,
    /// Side of the first turn of a new plan: Rules 14, 15 and 19(d)(i).
    pub first_turn_to: Option<Side>,
    /// May go faster than ordered, to pass sooner.
    pub may_speed_up: bool,
    /// Side to which own ship does not alter course: Rules 14(a), 15, 17(c) and 19(d).
    pub no_turn_to: Option<Side>,
    /// Side of its course to which own ship does not head before the target has passed.
    pub no_heading_to: Option<Side>,
    /// Passes port to port.
    pub port_to_port: bool,
    /// Crossing ahead of the target.
    pub crossing_ahead: CrossingAhead,
    /// The scores count crossing ahead of the target at less than a safe distance.
    pub crossing_ahead_counts: bool,
    /// Side of the target to which its domain is swept, because own ship must not pass there.
    pub closed_side: ClosedSide,
    /// Monitor that asks for an alteration.
    pub alteration_monitor: Option<Monitor>,
}

searoom_geometry::words! {
    /// A paragraph of the rules that own ship may violate.
    pub enum Paragraph {
        /// Overtaking.
        Rule13 => "13",
        /// Head-on: both alter to starboard.
        Rule14A => "14(a)",
        /// Crossing: own ship does not cross ahead of a ship on its starboard side.
        Rule15 => "15",
        /// The stand-on ship keeps course and speed.
        Rule17AI => "17(a)(i)",
        /// In extremis the stand-on ship acts too.
        Rule17B => "17(b)",
        /// The stand-on ship does not alter to port for a ship on its port side.
        Rule17C => "17(c)",
        /// In restricted visibility, no alteration to port for a ship forward of the beam.
        Rule19DI => "19(d)(i)",
        /// In restricted visibility, no alteration toward a ship abeam or abaft the beam.
        Rule19DII => "19(d)(ii)",
        /// Alterations are large enough to be readily apparent.
        Rule8B => "8(b)",
        /// The ships pass at a safe distance.
        Rule8D => "8(d)",
    }
}

/// How two ships meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Situation {
    /// Rule 14, and ships that are already port to port.
    HeadOn,
    /// Rules 15 and 17.
    Crossing,
    /// Rule 13. It lasts until past and clear, whatever the target does: Rule 13(d).
    Overtaking,
    /// Rule 19.
    NotInSight,
}

/// When a ship that stands on may act, Rule 17(a)(ii). In extremis it always may.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MayAct {
    /// From stage 3 on: within [`ScoreLimits::stage_3_lengths`] of the target.
    WithinRange,
    /// From the time in which it makes good [`ScoreLimits::overtaken_lengths`] before the closest
    /// approach.
    BeforeClosestApproach,
}

/// Whether own ship may cross the course line of a target ahead of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrossingAhead {
    /// At any distance.
    Allowed,
    /// Only at a safe distance: Krasowski and Althoff 2021, docs/reference/colregs.md 2.3.
    Far,
    /// Never.
    Forbidden,
}

/// Side of a target on which own ship must not pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClosedSide {
    /// No side.
    None,
    /// Ahead.
    Ahead,
    /// The target's starboard side.
    Starboard,
    /// The side away from own ship, seen from the target's wake.
    AcrossWake,
}

/// No duty.
const NONE: RoleDuties = RoleDuties {
    rule: None,
    paragraph: None,
    situation: None,
    keeps_clear: false,
    stands_on: false,
    may_act: MayAct::WithinRange,
    first_turn_to: None,
    may_speed_up: false,
    no_turn_to: None,
    no_heading_to: None,
    port_to_port: false,
    crossing_ahead: CrossingAhead::Allowed,
    crossing_ahead_counts: false,
    closed_side: ClosedSide::None,
    alteration_monitor: None,
};

/// Rules 14(a) and (c): head-on, or already port to port.
const RULE_14: RoleDuties = RoleDuties {
    rule: Some(14),
    paragraph: Some(Paragraph::Rule14A),
    situation: Some(Situation::HeadOn),
    keeps_clear: true,
    no_turn_to: Some(Side::Port),
    no_heading_to: Some(Side::Port),
    port_to_port: true,
    closed_side: ClosedSide::Starboard,
    ..NONE
};

/// Rule 15: keeps out of the way of a crossing ship.
const RULE_15: RoleDuties = RoleDuties {
    rule: Some(15),
    paragraph: Some(Paragraph::Rule15),
    situation: Some(Situation::Crossing),
    keeps_clear: true,
    crossing_ahead_counts: true,
    ..NONE
};

/// Rule 19(d): the sides follow from the bearing.
const RULE_19: RoleDuties = RoleDuties {
    rule: Some(19),
    situation: Some(Situation::NotInSight),
    keeps_clear: true,
    alteration_monitor: Some(Monitor::Overtaking),
    ..NONE
};

impl Role {
    /// The duties of this role.
    pub const fn duties(self) -> RoleDuties {
        match self {
            Self::HeadOn => RoleDuties {
                first_turn_to: Some(Side::Starboard),
                alteration_monitor: Some(Monitor::HeadOn),
                ..RULE_14
            },
            Self::PortToPort => RULE_14,
            Self::GiveWay => RoleDuties {
                first_turn_to: Some(Side::Starboard),
                no_turn_to: Some(Side::Port),
                crossing_ahead: CrossingAhead::Forbidden,
                closed_side: ClosedSide::Ahead,
                alteration_monitor: Some(Monitor::Crossing),
                ..RULE_15
            },
            Self::BothGiveWay => RULE_15,
            Self::Overtaking => RoleDuties {
                rule: Some(13),
                paragraph: Some(Paragraph::Rule13),
                situation: Some(Situation::Overtaking),
                keeps_clear: true,
                may_speed_up: true,
                crossing_ahead: CrossingAhead::Far,
                crossing_ahead_counts: true,
                closed_side: ClosedSide::AcrossWake,
                alteration_monitor: Some(Monitor::Overtaking),
                ..NONE
            },
            Self::Overtaken => RoleDuties {
                rule: Some(13),
                situation: Some(Situation::Overtaking),
                stands_on: true,
                may_act: MayAct::BeforeClosestApproach,
                ..NONE
            },
            Self::StandOn => RoleDuties {
                rule: Some(17),
                paragraph: Some(Paragraph::Rule17C),
                situation: Some(Situation::Crossing),
                stands_on: true,
                no_turn_to: Some(Side::Port),
                no_heading_to: Some(Side::Port),
                ..NONE
            },
            Self::Rule19Forward => RoleDuties {
                paragraph: Some(Paragraph::Rule19DI),
                first_turn_to: Some(Side::Starboard),
                no_turn_to: Some(Side::Port),
                no_heading_to: Some(Side::Port),
                ..RULE_19
            },
            Self::Rule19Starboard => RoleDuties {
                paragraph: Some(Paragraph::Rule19DII),
                no_turn_to: Some(Side::Starboard),
                no_heading_to: Some(Side::Starboard),
                ..RULE_19
            },
            Self::Rule19Port => RoleDuties {
                paragraph: Some(Paragraph::Rule19DII),
                no_turn_to: Some(Side::Port),
                no_heading_to: Some(Side::Port),
                ..RULE_19
            },
            Self::Static | Self::None => NONE,
        }
    }

    /// The number of the rule that tells own ship what to do; `None` without a role.
    pub fn rule(self) -> Option<u8> {
        self.duties().rule
    }
}

/// A target on a straight nominal track, and own ship's role toward it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encountered {
    /// Own ship's role.
    pub role: Role,
    /// The target at t = 0.
    pub ship: SteadyShip,
    /// Hull of the target.
    pub hull: Hull,
    /// Metres: [`ShipTrack::risk_distance`](searoom_model::target::ShipTrack::risk_distance).
    pub risk_distance: f64,
    /// Own ship when the risk began: its first course and speed.
    pub own: SteadyShip,
    /// Seconds at which the risk began.
    pub risk_since: f64,
    /// Seconds at which the centres are closest if both ships hold course and speed.
    pub tcpa: f64,
}

impl Encountered {
    /// Metres ahead of the target within which own ship must not cross its course line.
    pub fn bow_room(&self) -> f64 {
        match self.role.duties().crossing_ahead {
            CrossingAhead::Forbidden => f64::INFINITY,
            CrossingAhead::Far => {
                ScoreLimits::STANDARD.room_ahead(self.hull.length, self.ship.speed)
            }
            CrossingAhead::Allowed => 0.0,
        }
    }
}

/// Duty of own ship toward all targets together: requirements on the first alteration of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Duty {
    /// It must be readily apparent: a turn of [`APPARENT_TURN`], or [`APPARENT_SPEED`] for
    /// [`APPARENT_TIME`].
    pub keeps_clear: bool,
    /// It must not be to port.
    pub no_port_turn: bool,
    /// It must not be to starboard.
    pub no_starboard_turn: bool,
    /// Less speed may replace a turn: no target comes head-on.
    pub may_slow: bool,
    /// Course and speed are kept while that is safe: some target gives way, and own ship to none.
    pub stands_on: bool,
}

impl Duty {
    /// From own ship's roles. A ship that keeps clear of one target cannot stand on for another.
    pub fn of(roles: impl Iterator<Item = Role> + Clone) -> Self {
        let any = |duty: fn(RoleDuties) -> bool| roles.clone().any(|role| duty(role.duties()));
        let keeps_clear = any(|d| d.keeps_clear);
        Self {
            keeps_clear,
            no_port_turn: any(|d| d.no_turn_to == Some(Side::Port)),
            no_starboard_turn: any(|d| d.no_turn_to == Some(Side::Starboard)),
            may_slow: !any(|d| d.port_to_port),
            stands_on: !keeps_clear && any(|d| d.stands_on),
        }
    }

    /// True without any requirement.
    pub fn is_none(self) -> bool {
        !(self.keeps_clear || self.no_port_turn || self.no_starboard_turn || self.stands_on)
    }

    /// Allowed sides of the first alteration.
    pub fn sides(self) -> &'static [Side] {
        match (self.no_port_turn, self.no_starboard_turn) {
            (true, true) => &[],
            (true, false) => &[Side::Starboard],
            (false, true) => &[Side::Port],
            (false, false) => &Side::BOTH,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_complete() {
        for (word, role) in Role::with_rule() {
            let d = role.duties();
            assert!(d.situation.is_some(), "{word}");
            assert_ne!(d.keeps_clear, d.stands_on, "{word}");
            let forbids = d.no_heading_to.is_some() || d.port_to_port || d.crossing_ahead_counts;
            assert!(d.paragraph.is_some() || !forbids, "{word}");
            // own ship does not begin with a turn that it must not make
            assert!(
                d.first_turn_to
                    .is_none_or(|side| d.no_turn_to != Some(side)),
                "{word}"
            );
        }
    }

    #[test]
    fn the_strictest_role_decides() {
        let of = |roles: &[Role]| {
            let d = Duty::of(roles.iter().copied());
            (d.keeps_clear, d.no_port_turn, d.stands_on)
        };
        assert_eq!(of(&[]), (false, false, false));
        assert_eq!(of(&[Role::None, Role::Static]), (false, false, false));
        assert_eq!(of(&[Role::HeadOn]), (true, true, false));
        assert_eq!(of(&[Role::PortToPort]), (true, true, false));
        assert_eq!(of(&[Role::GiveWay]), (true, true, false));
        assert_eq!(of(&[Role::BothGiveWay]), (true, false, false));
        assert_eq!(of(&[Role::Overtaking]), (true, false, false));
        assert_eq!(of(&[Role::StandOn]), (false, true, true));
        assert_eq!(of(&[Role::Overtaken]), (false, false, true));
        // it keeps clear of one target, and turns to starboard because of the other
        assert_eq!(of(&[Role::Overtaking, Role::StandOn]), (true, true, false));
        let one = |role: Role| Duty::of(std::iter::once(role));
        assert_eq!(one(Role::StandOn).sides(), [Side::Starboard]);
        assert_eq!(one(Role::Rule19Forward).sides(), [Side::Starboard]);
        assert_eq!(one(Role::Rule19Starboard).sides(), [Side::Port]);
        let both = [Role::Rule19Starboard, Role::Rule19Port];
        assert!(Duty::of(both.iter().copied()).sides().is_empty());
        assert_eq!(one(Role::Overtaking).sides(), Side::BOTH);
        assert!(one(Role::GiveWay).may_slow && !one(Role::HeadOn).may_slow);
        assert!(one(Role::None).is_none());
    }
}
