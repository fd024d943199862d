//! Roles of two ships that meet: docs/colregs.md 1.3.

use crate::frame::{Pose, Vector, relative_bearing};

/// By what numbers roles are told apart.
///
/// # Examples
///
/// ```
/// use std::f64::consts::{FRAC_PI_2, PI};
/// use searoom::colregs::{Role, Sectors, SteadyShip, role_within};
/// use searoom::frame::{Pose, Vector};
///
/// let north = SteadyShip { pose: Pose::new(Vector::zeros(), FRAC_PI_2), speed: 5.0 };
/// // on the opposite course but for 8 degrees
/// let south = SteadyShip { pose: Pose::new(Vector::new(0.0, 1000.0), -FRAC_PI_2 - 0.14), speed: 5.0 };
/// let narrow = Sectors { head_on: PI / 36.0, ..Sectors::default() };
/// assert_eq!(role_within(&north, &south, &Sectors::default()), Some(Role::HeadOn));
/// assert_ne!(role_within(&north, &south, &narrow), Some(Role::HeadOn));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sectors {
    /// Radians. Both relative bearings within this of ahead: head-on.
    pub head_on: f64,
    /// Radians. More than this from ahead is the sector of the sternlight, Rule 13(b).
    pub abaft_the_beam: f64,
    /// m/s. A slower ship is at rest: she has no course to judge.
    pub at_rest: f64,
    /// m/s. Overtaking needs the distance to shrink at least this fast.
    pub closing: f64,
}

impl Default for Sectors {
    /// 10°, 112.5°, 0.2 m/s and 0.1 m/s: what planners use.
    fn default() -> Self {
        Self {
            head_on: std::f64::consts::PI / 18.0,
            abaft_the_beam: std::f64::consts::PI * 0.625,
            at_rest: 0.2,
            closing: 0.1,
        }
    }
}

/// Radians. A bearing this close to dead ahead or astern has no side of its own.
const SIDE: f64 = 1e-9;

/// What own ship is to a target.
///
/// # Examples
///
/// ```
/// use std::f64::consts::{FRAC_PI_2, PI};
/// use searoom::colregs::{Role, SteadyShip, raw_role};
/// use searoom::frame::{Pose, Vector};
///
/// let own = SteadyShip { pose: Pose::new(Vector::zeros(), FRAC_PI_2), speed: 5.0 };
/// // westwards from starboard
/// let other = SteadyShip { pose: Pose::new(Vector::new(750.0, 750.0), PI), speed: 5.0 };
/// assert_eq!(raw_role(&own, &other), Some(Role::GiveWay));
/// assert_eq!(raw_role(&other, &own), Some(Role::StandOn));
/// assert_eq!((Role::GiveWay.name(), Role::GiveWay.rule()), ("give-way", Some(15)));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Role {
    /// Rule 14.
    HeadOn,
    /// Rule 15, the other on own starboard side.
    GiveWay,
    /// Rule 17.
    StandOn,
    /// Rule 13, own ship overtakes.
    Overtaking,
    /// Rule 13, own ship is overtaken.
    Overtaken,
    /// Each on the other's starboard side: both keep clear.
    BothGiveWay,
    /// Each on the other's port side: treated like head-on.
    PortToPort,
    /// The target does not move: no role.
    Static,
    /// No risk of collision.
    None,
}

impl Role {
    /// The role as tables, documents and recordings name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::HeadOn => "head-on",
            Self::GiveWay => "give-way",
            Self::StandOn => "stand-on",
            Self::Overtaking => "overtaking",
            Self::Overtaken => "overtaken",
            Self::BothGiveWay => "both-give-way",
            Self::PortToPort => "port-to-port",
            Self::Static => "static",
            Self::None => "none",
        }
    }

    /// The number of the rule that tells own ship what to do; `None` without a role.
    pub fn rule(self) -> Option<u8> {
        match self {
            Self::Overtaking | Self::Overtaken => Some(13),
            // port to port is kept as head-on is
            Self::HeadOn | Self::PortToPort => Some(14),
            Self::GiveWay | Self::BothGiveWay => Some(15),
            Self::StandOn => Some(17),
            Self::Static | Self::None => None,
        }
    }
}

/// A ship on a steady course: the sectors of the rules are taken on the heading, and there is no drift.
///
/// # Examples
///
/// ```
/// use std::f64::consts::FRAC_PI_2;
/// use searoom::colregs::SteadyShip;
/// use searoom::frame::{Pose, Vector};
///
/// let north = SteadyShip { pose: Pose::new(Vector::zeros(), FRAC_PI_2), speed: 5.0 };
/// assert!((north.velocity() - Vector::new(0.0, 5.0)).norm() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteadyShip {
    /// Hull centre and heading.
    pub pose: Pose,
    /// m/s, ahead.
    pub speed: f64,
}

impl SteadyShip {
    /// m/s.
    pub fn velocity(&self) -> Vector {
        self.pose.ahead() * self.speed
    }

    fn is_finite(&self) -> bool {
        let Pose { position, heading } = self.pose;
        [position.x, position.y, heading, self.speed]
            .iter()
            .all(|v| v.is_finite())
    }
}

/// The role that the geometry alone gives `own` toward `target`, whether or not there is risk:
/// `raw(own, obs)` of docs/colregs.md 1.3, an ordered list, so that every state has one role and the two
/// ships agree: head-on/head-on, give-way/stand-on, overtaking/overtaken, both-give-way twice,
/// port-to-port twice, and none twice in line where they do not close. Of a mirrored state it is the mirrored role.
///
/// `None` when a number is not finite or the two centres coincide (no bearing): the caller must claim
/// nothing. An own ship at rest has no duty of Rules 13-17: [`Role::None`].
pub fn raw_role(own: &SteadyShip, target: &SteadyShip) -> Option<Role> {
    role_within(own, target, &Sectors::default())
}

/// The same by other numbers.
pub fn role_within(own: &SteadyShip, target: &SteadyShip, sectors: &Sectors) -> Option<Role> {
    let offset = target.pose.position - own.pose.position;
    let range = offset.norm();
    if !(own.is_finite() && target.is_finite() && range > 0.0 && range.is_finite()) {
        return None;
    }
    if target.speed < sectors.at_rest {
        return Some(Role::Static);
    }
    if own.speed < sectors.at_rest {
        return Some(Role::None);
    }
    let bearing = relative_bearing(&own.pose, target.pose.position);
    let aspect = relative_bearing(&target.pose, own.pose.position);
    let closing = offset.dot(&(own.velocity() - target.velocity())) / range > sectors.closing;
    let overtaking = closing && aspect.abs() > sectors.abaft_the_beam;
    let overtaken = closing && bearing.abs() > sectors.abaft_the_beam;
    // two ships astern of each other open; the tie is decided all the same, so that the list is total
    let lead = own
        .speed
        .total_cmp(&target.speed)
        .then(aspect.abs().total_cmp(&bearing.abs()));
    match (overtaking, overtaken, lead) {
        (true, true, std::cmp::Ordering::Equal) => return Some(Role::None),
        (true, true, std::cmp::Ordering::Less) | (false, true, _) => return Some(Role::Overtaken),
        (true, ..) => return Some(Role::Overtaking),
        (false, false, _) => {}
    }
    if bearing.abs().max(aspect.abs()) <= sectors.head_on {
        return Some(Role::HeadOn);
    }
    let has_side = |angle: f64| angle.abs() > SIDE && std::f64::consts::PI - angle.abs() > SIDE;
    // in line, and not closing: neither is on a side of the other
    if !has_side(bearing) && !has_side(aspect) {
        return Some(Role::None);
    }
    // dead ahead or astern: the other's view decides
    let to_starboard = |angle: f64, other: f64| {
        if has_side(angle) {
            angle > 0.0
        } else {
            other < 0.0
        }
    };
    Some(
        match (to_starboard(bearing, aspect), to_starboard(aspect, bearing)) {
            (true, false) => Role::GiveWay,
            (false, true) => Role::StandOn,
            (true, true) => Role::BothGiveWay,
            (false, false) => Role::PortToPort,
        },
    )
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::frame::{direction, heading_of};
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::cmp::Ordering::{Greater, Less};
    use std::f64::consts::{FRAC_PI_2, PI};

    pub fn ship(x: f64, y: f64, heading: f64, speed: f64) -> SteadyShip {
        SteadyShip {
            pose: Pose::new(Vector::new(x, y), heading),
            speed,
        }
    }

    fn mirrored(s: &SteadyShip) -> SteadyShip {
        ship(
            s.pose.position.x,
            -s.pose.position.y,
            -s.pose.heading,
            s.speed,
        )
    }

    /// docs/colregs.md 0.1.
    pub fn fixtures() -> [(SteadyShip, Role, Role); 5] {
        [
            (ship(1440.0, 0.0, PI, 6.0), Role::HeadOn, Role::HeadOn),
            (
                ship(720.0, -720.0, FRAC_PI_2, 6.0),
                Role::GiveWay,
                Role::StandOn,
            ),
            (
                ship(720.0, 720.0, -FRAC_PI_2, 6.0),
                Role::StandOn,
                Role::GiveWay,
            ),
            (
                ship(432.0, 0.0, 0.0, 2.4),
                Role::Overtaking,
                Role::Overtaking,
            ),
            (
                ship(-432.0, 0.0, 0.0, 9.6),
                Role::Overtaken,
                Role::Overtaken,
            ),
        ]
    }

    #[test]
    fn the_fixtures_and_their_mirrors_have_their_roles() {
        let own = ship(0.0, 0.0, 0.0, 6.0);
        for (other, role, in_the_mirror) in fixtures() {
            assert_eq!(raw_role(&own, &other), Some(role));
            assert_eq!(raw_role(&own, &mirrored(&other)), Some(in_the_mirror));
        }
    }

    #[test]
    fn the_fixtures_have_their_roles_wherever_they_lie() {
        let mut rng = ChaCha8Rng::seed_from_u64(17);
        let own = ship(0.0, 0.0, 0.0, 6.0);
        for (other, role, in_the_mirror) in fixtures() {
            for _ in 0..1_000 {
                let turn = rng.random_range(-PI..PI);
                let far = Vector::new(rng.random_range(-1e6..1e6), rng.random_range(-1e6..1e6));
                let moved = |s: &SteadyShip| {
                    let p = direction(turn) * s.pose.position.x
                        + crate::frame::to_port(direction(turn)) * s.pose.position.y;
                    ship(p.x + far.x, p.y + far.y, s.pose.heading + turn, s.speed)
                };
                let mirror = mirrored(&other);
                assert_eq!(raw_role(&moved(&own), &moved(&other)), Some(role));
                assert_eq!(raw_role(&moved(&own), &moved(&mirror)), Some(in_the_mirror));
            }
        }
    }

    fn every_role() -> [Role; 9] {
        [
            Role::HeadOn,
            Role::GiveWay,
            Role::StandOn,
            Role::Overtaking,
            Role::Overtaken,
            Role::BothGiveWay,
            Role::PortToPort,
            Role::Static,
            Role::None,
        ]
    }

    /// Each role by a condition of its own, in no order: docs/colregs.md 1.3 once more, from angles found another way.
    fn is(role: Role, own: &SteadyShip, other: &SteadyShip) -> bool {
        let seen = |from: &SteadyShip, of: &SteadyShip| {
            let p = of.pose.position - from.pose.position;
            let (ahead, abeam) = (
                from.pose.ahead(),
                crate::frame::to_starboard(from.pose.ahead()),
            );
            abeam.dot(&p).atan2(ahead.dot(&p))
        };
        let (beta, alpha) = (seen(own, other), seen(other, own));
        let offset = other.pose.position - own.pose.position;
        let closes = (own.velocity() - other.velocity()).dot(&offset) > 0.1 * offset.norm();
        let (rests, idle) = (other.speed < 0.2, own.speed < 0.2);
        let abaft = 112.5_f64.to_radians();
        let from_astern = closes && alpha.abs() > abaft;
        let to_ahead = closes && beta.abs() > abaft;
        let lead = (own.speed, alpha.abs()).partial_cmp(&(other.speed, beta.abs()));
        let (faster, slower) = (lead == Some(Greater), lead == Some(Less));
        let moves = !rests && !idle;
        let meets = moves && !from_astern && !to_ahead;
        let ahead = beta.abs() <= 10.0_f64.to_radians() && alpha.abs() <= 10.0_f64.to_radians();
        let sideless = |angle: f64| angle.sin().abs() <= SIDE;
        let starboard = |angle: f64, else_by: f64| match sideless(angle) {
            true => else_by.sin() < 0.0,
            false => angle.sin() > 0.0,
        };
        let (b, a) = (starboard(beta, alpha), starboard(alpha, beta));
        let in_line = meets && !ahead && sideless(beta) && sideless(alpha);
        let meets = meets && !in_line;
        match role {
            Role::Static => rests,
            Role::None => {
                !rests && (idle || in_line || from_astern && to_ahead && !faster && !slower)
            }
            Role::Overtaking => moves && from_astern && (!to_ahead || faster),
            Role::Overtaken => moves && to_ahead && (!from_astern || slower),
            Role::HeadOn => meets && ahead,
            Role::GiveWay => meets && !ahead && b && !a,
            Role::StandOn => meets && !ahead && !b && a,
            Role::BothGiveWay => meets && !ahead && b && a,
            Role::PortToPort => meets && !ahead && !b && !a,
        }
    }

    #[test]
    fn every_state_has_one_role_and_both_ships_agree() {
        let mut rng = ChaCha8Rng::seed_from_u64(13);
        let mut seen = std::collections::BTreeSet::new();
        let mut in_line = 0;
        for i in 0..1_000_000 {
            let grid = i % 2 == 0;
            let mut angle = || {
                let a: f64 = rng.random_range(-PI..PI);
                if grid {
                    (a * 6.0 / PI).round() * PI / 6.0
                } else {
                    a
                }
            };
            let (bearing, own_heading, heading) = (angle(), angle(), angle());
            let p = direction(bearing) * rng.random_range(1.0..5000.0);
            let own = ship(0.0, 0.0, own_heading, rng.random_range(0.0..12.0));
            let other = ship(p.x, p.y, heading, rng.random_range(0.0..12.0));
            let here = raw_role(&own, &other).expect("finite");
            let there = raw_role(&other, &own).expect("finite");
            seen.insert(here);
            let pair = if here <= there {
                (here, there)
            } else {
                (there, here)
            };
            let consistent = matches!(
                pair,
                (Role::HeadOn, Role::HeadOn)
                    | (Role::GiveWay, Role::StandOn)
                    | (Role::Overtaking, Role::Overtaken)
                    | (Role::BothGiveWay, Role::BothGiveWay)
                    | (Role::PortToPort, Role::PortToPort)
                    | (Role::None, Role::None)
            );
            // a ship at rest has no role, and the other sees one at rest
            let resting = matches!(pair, (Role::Static, Role::Static | Role::None));
            let sectors = Sectors::default();
            let at_rest = own.speed < sectors.at_rest || other.speed < sectors.at_rest;
            assert!(
                if at_rest { resting } else { consistent },
                "{own:?} {other:?}: {pair:?}"
            );
            let mirror = raw_role(&mirrored(&own), &mirrored(&other)).expect("finite");
            let expected = match here {
                Role::GiveWay => Role::StandOn,
                Role::StandOn => Role::GiveWay,
                Role::BothGiveWay => Role::PortToPort,
                Role::PortToPort => Role::BothGiveWay,
                same => same,
            };
            let described = every_role().into_iter().filter(|r| is(*r, &own, &other));
            assert_eq!(described.collect::<Vec<_>>(), [here], "{own:?} {other:?}");
            assert_eq!(mirror, expected, "{own:?} {other:?}");
            in_line += usize::from(here == Role::None && !at_rest);
        }
        assert!(in_line > 1_000, "{in_line}");
        assert_eq!(seen.len(), 9, "{seen:?}");
    }

    #[test]
    fn the_sectors_end_where_the_rules_say() {
        let own = ship(0.0, 0.0, 0.0, 6.0);
        // own on the target's quarter: 112.5° and a hair on either side
        for (beyond, role) in [(1e-9, Role::Overtaking), (-1e-9, Role::GiveWay)] {
            // bearing 45° to starboard, own on the port side of the target
            let p = direction(-PI / 4.0) * 500.0;
            let heading = heading_of(-p) - (Sectors::default().abaft_the_beam + beyond);
            let other = ship(p.x, p.y, heading, 2.0);
            assert_eq!(raw_role(&own, &other), Some(role));
        }
        for (beyond, role) in [(-1e-9, Role::HeadOn), (1e-9, Role::StandOn)] {
            let p = direction(Sectors::default().head_on + beyond) * 500.0;
            assert_eq!(
                raw_role(&own, &ship(p.x, p.y, heading_of(-p), 6.0)),
                Some(role)
            );
        }
        // dead ahead, crossing: the other's view decides
        assert_eq!(
            raw_role(&own, &ship(500.0, 0.0, FRAC_PI_2, 3.0)),
            Some(Role::GiveWay)
        );
        assert_eq!(
            raw_role(&own, &ship(500.0, 0.0, -FRAC_PI_2, 3.0)),
            Some(Role::StandOn)
        );
        assert_eq!(
            raw_role(&own, &ship(500.0, 0.0, PI, 0.19)),
            Some(Role::Static)
        );
        assert_eq!(
            raw_role(&ship(0.0, 0.0, 0.0, 0.19), &ship(500.0, 0.0, PI, 5.0)),
            Some(Role::None)
        );
    }

    #[test]
    fn what_is_not_a_number_has_no_role() {
        let own = ship(0.0, 0.0, 0.0, 6.0);
        for bad in [f64::NAN, f64::INFINITY] {
            for other in [
                ship(bad, 0.0, 0.0, 1.0),
                ship(9.0, bad, 0.0, 1.0),
                ship(9.0, 0.0, bad, 1.0),
                ship(9.0, 0.0, 0.0, bad),
            ] {
                assert_eq!(raw_role(&own, &other), None);
                assert_eq!(raw_role(&other, &own), None);
            }
        }
        assert_eq!(raw_role(&own, &own), None);
    }
}
