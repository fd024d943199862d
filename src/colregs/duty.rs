//! What the rules ask of own ship toward all targets together.

use std::f64::consts::{FRAC_PI_6, PI};

use super::role::{Role, SteadyShip};
use crate::frame::Side;

/// Radians, 30°. A smaller alteration of course is not readily apparent to the other, Rule 8(b): the figure of Woerner and of
/// evaluators of the NTNU lineage (docs/colregs.md 2.2).
pub const APPARENT_TURN: f64 = FRAC_PI_6;

/// Share of the speed before: a reduction to this or less is readily apparent, Rule 8(b).
pub const APPARENT_SPEED: f64 = 0.5;

/// Seconds for which a reduced speed is kept at least, to be seen. A choice of ours: a ship of 100 m at 5 m/s makes good 75 m less in
/// this time at half her speed.
pub const APPARENT_TIME: f64 = 30.0;

/// Radians, 2°. A heading this near to a course is on it.
pub const ON_COURSE: f64 = PI / 90.0;

/// Radians, 20°. More than [`MOST_SMALL_TURNS`] smaller turns are a succession of small alterations, Rule 8(b).
pub const SMALL_TURN: f64 = PI / 9.0;

/// See [`SMALL_TURN`].
pub const MOST_SMALL_TURNS: usize = 2;

/// Lengths of the overtaken ship, and seconds of her way, ahead of her within which own ship does not cross her course line:
/// Krasowski and Althoff 2021; docs/colregs.md 2.3.
const BOW_LENGTHS: f64 = 3.0;
const BOW_TIME: f64 = 60.0;

impl Role {
    /// True where own ship has to keep clear by an alteration that is readily apparent: Rules 13 to 16.
    pub fn keeps_clear(self) -> bool {
        match self {
            Self::HeadOn
            | Self::PortToPort
            | Self::GiveWay
            | Self::BothGiveWay
            | Self::Overtaking => true,
            Self::StandOn | Self::Overtaken | Self::Static | Self::None => false,
        }
    }

    /// True where own ship is to keep her course and speed: Rule 17, and of the overtaken ship.
    pub fn stands_on(self) -> bool {
        matches!(self, Self::StandOn | Self::Overtaken)
    }

    /// True where no alteration may be to port: Rules 14(a), 15 and 17(c).
    pub fn bars_port(self) -> bool {
        match self {
            Self::HeadOn | Self::PortToPort | Self::GiveWay | Self::StandOn => true,
            Self::BothGiveWay | Self::Overtaking | Self::Overtaken | Self::Static | Self::None => {
                false
            }
        }
    }

    /// True where the ships are to pass port to port.
    pub fn passes_port_to_port(self) -> bool {
        matches!(self, Self::HeadOn | Self::PortToPort)
    }

    /// True where own ship is not to head to port of her course before the target has passed.
    pub fn bars_port_until_passed(self) -> bool {
        matches!(self, Self::HeadOn | Self::PortToPort | Self::StandOn)
    }
}

/// A target as the rules see her: on a nominal track that does not bend.
///
/// # Examples
///
/// ```
/// use std::f64::consts::{FRAC_PI_2, PI};
/// use searoom::colregs::{Encountered, Role, SteadyShip};
/// use searoom::frame::{Pose, Vector};
///
/// let own = SteadyShip { pose: Pose::new(Vector::zeros(), FRAC_PI_2), speed: 5.0 };
/// // westwards from starboard
/// let other = SteadyShip { pose: Pose::new(Vector::new(750.0, 750.0), PI), speed: 5.0 };
/// let ferry = Encountered { role: Role::GiveWay, ship: other, length: 60.0 };
/// assert!(ferry.bow_room() > 60.0, "metres ahead of her that are not to be crossed");
/// assert!(ferry.role.keeps_clear() && ferry.role.bars_port());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encountered {
    /// Own ship's role toward her.
    pub role: Role,
    /// Where she is at t = 0.
    pub ship: SteadyShip,
    /// Metres.
    pub length: f64,
}

impl Encountered {
    /// Metres ahead of her within which own ship must not cross her course line.
    pub fn bow_room(&self) -> f64 {
        match self.role {
            Role::GiveWay => f64::INFINITY,
            Role::Overtaking => (BOW_LENGTHS * self.length).max(BOW_TIME * self.ship.speed),
            _ => 0.0,
        }
    }
}

/// What is asked of the first alteration of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Duty {
    /// It has to be readily apparent: a turn of [`APPARENT_TURN`] or a speed of [`APPARENT_SPEED`], kept for [`APPARENT_TIME`].
    pub keeps_clear: bool,
    /// It must not be to port.
    pub starboard_alone: bool,
    /// Less speed will do instead of a turn: nobody comes head-on.
    pub may_slow: bool,
    /// Course and speed are to be kept as long as that is safe, since some target gives way and own ship to none.
    pub stands_on: bool,
}

impl Duty {
    /// By own ship's roles toward all targets. A ship that has to keep clear of one target cannot stand on for another.
    pub fn of(roles: impl Iterator<Item = Role> + Clone) -> Self {
        let keeps_clear = roles.clone().any(Role::keeps_clear);
        Self {
            keeps_clear,
            starboard_alone: roles.clone().any(Role::bars_port),
            may_slow: !roles.clone().any(Role::passes_port_to_port),
            stands_on: !keeps_clear && roles.clone().any(Role::stands_on),
        }
    }

    /// True where nothing is asked.
    pub fn is_none(self) -> bool {
        !(self.keeps_clear || self.starboard_alone || self.stands_on)
    }

    /// The sides to which the first alteration may be.
    pub fn sides(self) -> &'static [Side] {
        if self.starboard_alone {
            &[Side::Starboard]
        } else {
            &Side::BOTH
        }
    }

    /// Radians: the least first alteration of course.
    pub fn least_turn(self) -> f64 {
        if self.is_none() { 0.0 } else { APPARENT_TURN }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_strictest_role_decides() {
        let of = |roles: &[Role]| {
            let d = Duty::of(roles.iter().copied());
            (d.keeps_clear, d.starboard_alone, d.stands_on)
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
        // she keeps clear of one, and turns to starboard for the sake of the other
        assert_eq!(of(&[Role::Overtaking, Role::StandOn]), (true, true, false));
        let one = |role: Role| Duty::of(std::iter::once(role));
        assert_eq!(one(Role::StandOn).sides(), [Side::Starboard]);
        assert_eq!(one(Role::Overtaking).sides(), Side::BOTH);
        assert!(one(Role::GiveWay).may_slow && !one(Role::HeadOn).may_slow);
        assert!(one(Role::None).is_none());
        assert_eq!(one(Role::None).least_turn(), 0.0);
        assert_eq!(one(Role::GiveWay).least_turn(), APPARENT_TURN);
    }
}
