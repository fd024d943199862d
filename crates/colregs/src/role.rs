//! Roles of two ships that meet: docs/reference/colregs.md, section 1.3.

use searoom_geometry::frame::{Pose, Vector, radians_from_deg, relative_bearing};
use searoom_model::target::ShipTrack;
use std::f64::consts::FRAC_PI_2;

/// Limits that separate the roles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sectors {
    /// Radians from ahead: head-on if both relative bearings are within it.
    pub head_on: f64,
    /// Radians from ahead: the sector of the sternlight begins here, Rule 13(b).
    pub abaft_the_beam: f64,
    /// m/s: a slower ship is at rest and has no course to judge.
    pub at_rest: f64,
    /// m/s: overtaking requires that the distance shrinks at least this fast.
    pub closing: f64,
    /// False in restricted visibility: Rule 19 in place of Rules 13 to 17.
    pub in_sight: bool,
}

impl Sectors {
    /// 10°, 112.5°, 0.2 m/s and 0.1 m/s: the sectors of the planner and the encounter generator.
    pub const STANDARD: Self = Self {
        head_on: radians_from_deg(10.0),
        abaft_the_beam: radians_from_deg(112.5),
        at_rest: 0.2,
        closing: 0.1,
        in_sight: true,
    };
}

/// Radians: a bearing this close to dead ahead or astern has no side.
const SIDE: f64 = 1e-9;

searoom_geometry::words! {
    /// Role of own ship toward a target.
    pub enum Role {
        /// Rule 14.
        HeadOn => "head-on",
        /// Rule 15, the target on own starboard side.
        GiveWay => "give-way",
        /// Rule 17.
        StandOn => "stand-on",
        /// Rule 13, own ship overtakes.
        Overtaking => "overtaking",
        /// Rule 13, own ship is overtaken.
        Overtaken => "overtaken",
        /// Each on the other's starboard side: both keep clear.
        BothGiveWay => "both-give-way",
        /// Each on the other's port side: treated like head-on.
        PortToPort => "port-to-port",
        /// Rule 19(d)(i): in restricted visibility, the target forward of own beam.
        Rule19Forward => "rule-19-forward",
        /// Rule 19(d)(ii): in restricted visibility, the target abeam or abaft the beam to starboard.
        Rule19Starboard => "rule-19-starboard",
        /// Rule 19(d)(ii): as before, to port.
        Rule19Port => "rule-19-port",
        /// The target does not move: no role.
        Static => "static",
        /// No risk of collision.
        None => "none",
    }
}

impl Role {
    /// The roles that own ship has while there is risk of collision, with their words.
    pub fn with_rule() -> impl Iterator<Item = (&'static str, Self)> {
        let all = Self::WORDS.iter().copied();
        all.filter(|(_, role)| role.rule().is_some())
    }
}

/// A ship on a steady course without drift: the sectors of the rules are relative to its heading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteadyShip {
    /// Hull centre and heading.
    pub pose: Pose,
    /// m/s, ahead.
    pub speed: f64,
}

impl SteadyShip {
    /// A ship at a pose with a speed, m/s.
    #[inline]
    pub const fn new(pose: Pose, speed: f64) -> Self {
        Self { pose, speed }
    }

    /// A target on its nominal track at a time, seconds.
    pub fn on_track(track: &ShipTrack, time: f64) -> Self {
        let (pose, speed) = track.nominal_at(time);
        Self::new(pose, speed)
    }

    /// The ship `time` seconds later, on the same course at the same speed.
    #[inline]
    pub fn moved(&self, time: f64) -> Self {
        let place = self.pose.position + self.velocity() * time;
        Self::new(Pose::new(place, self.pose.heading), self.speed)
    }

    /// m/s.
    #[inline]
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

/// Role of `own` toward `target` by geometry alone, whether or not there is risk: `raw(own, obs)`
/// of docs/reference/colregs.md, section 1.3.
///
/// It is an ordered list, so every state has one role and the two ships agree: head-on/head-on,
/// give-way/stand-on, overtaking/overtaken, both-give-way twice, port-to-port twice, and none twice
/// in line without closing. A mirrored state has the mirrored role.
///
/// `None` if a number is not finite or the centres coincide: the caller must claim nothing. An own
/// ship at rest has no duty of Rules 13 to 17: [`Role::None`].
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
    if !sectors.in_sight {
        return Some(match bearing {
            // forward of the beam, other than one that own ship overtakes
            b if b.abs() < FRAC_PI_2 && overtaking => Role::Overtaking,
            b if b.abs() < FRAC_PI_2 => Role::Rule19Forward,
            b if b > 0.0 => Role::Rule19Starboard,
            _ => Role::Rule19Port,
        });
    }
    let overtaken = closing && bearing.abs() > sectors.abaft_the_beam;
    // two ships astern of each other open; the tie is decided all the same, so that the list is
    // total
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
    use super::Role::{GiveWay, HeadOn, Overtaken, Overtaking, StandOn};
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use searoom_geometry::frame::{direction, heading_of};
    use std::cmp::Ordering::{Greater, Less};
    use std::f64::consts::{FRAC_PI_2, PI};

    pub fn ship(x: f64, y: f64, heading: f64, speed: f64) -> SteadyShip {
        SteadyShip::new(Pose::new(Vector::new(x, y), heading), speed)
    }

    fn mirrored(s: &SteadyShip) -> SteadyShip {
        let at = s.pose.position;
        ship(at.x, -at.y, -s.pose.heading, s.speed)
    }

    /// docs/reference/colregs.md 0.1.
    pub fn fixtures() -> [(SteadyShip, Role); 5] {
        [
            (ship(1440.0, 0.0, PI, 6.0), HeadOn),
            (ship(720.0, -720.0, FRAC_PI_2, 6.0), GiveWay),
            (ship(720.0, 720.0, -FRAC_PI_2, 6.0), StandOn),
            (ship(432.0, 0.0, 0.0, 2.4), Overtaking),
            (ship(-432.0, 0.0, 0.0, 9.6), Overtaken),
        ]
    }

    fn raw_role(own: &SteadyShip, target: &SteadyShip) -> Option<Role> {
        role_within(own, target, &Sectors::STANDARD)
    }

    /// Each role by its own condition, in no order: a second reading of docs/reference/colregs.md,
    /// section 1.3, from angles that are found another way.
    fn is(role: Role, own: &SteadyShip, other: &SteadyShip) -> bool {
        let seen = |from: &SteadyShip, of: &SteadyShip| {
            let p = of.pose.position - from.pose.position;
            let ahead = from.pose.ahead();
            let abeam = searoom_geometry::frame::to_starboard(ahead);
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
            Role::Rule19Forward | Role::Rule19Starboard | Role::Rule19Port => false,
        }
    }

    /// In restricted visibility the bearing alone decides, but for a ship that is overtaken.
    #[test]
    fn in_restricted_visibility_the_bearing_decides() {
        let own = ship(0.0, 0.0, 0.0, 6.0);
        let sectors = Sectors {
            in_sight: false,
            ..Sectors::STANDARD
        };
        let role = |x, y, heading, speed| role_within(&own, &ship(x, y, heading, speed), &sectors);
        assert_eq!(role(500.0, 0.0, PI, 6.0), Some(Role::Rule19Forward));
        assert_eq!(role(300.0, 400.0, -1.0, 6.0), Some(Role::Rule19Forward));
        assert_eq!(role(500.0, 0.0, 0.0, 2.0), Some(Role::Overtaking));
        assert_eq!(role(0.0, -400.0, 1.0, 9.0), Some(Role::Rule19Starboard));
        assert_eq!(role(-300.0, -400.0, 1.0, 9.0), Some(Role::Rule19Starboard));
        assert_eq!(role(-300.0, 400.0, -1.0, 9.0), Some(Role::Rule19Port));
        assert_eq!(role(500.0, 0.0, 0.0, 0.1), Some(Role::Static));
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
                let rounded = (a * 6.0 / PI).round() * PI / 6.0;
                if grid { rounded } else { a }
            };
            let (bearing, own_heading, heading) = (angle(), angle(), angle());
            let p = direction(bearing) * rng.random_range(1.0..5000.0);
            let own = ship(0.0, 0.0, own_heading, rng.random_range(0.0..12.0));
            let other = ship(p.x, p.y, heading, rng.random_range(0.0..12.0));
            let here = raw_role(&own, &other).expect("finite");
            let there = raw_role(&other, &own).expect("finite");
            seen.insert(here);
            let pair = (here.min(there), here.max(there));
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
            let sectors = Sectors::STANDARD;
            let at_rest = own.speed < sectors.at_rest || other.speed < sectors.at_rest;
            let agrees = if at_rest { resting } else { consistent };
            assert!(agrees, "{own:?} {other:?}: {pair:?}");
            let mirror = raw_role(&mirrored(&own), &mirrored(&other)).expect("finite");
            let expected = match here {
                Role::GiveWay => Role::StandOn,
                Role::StandOn => Role::GiveWay,
                Role::BothGiveWay => Role::PortToPort,
                Role::PortToPort => Role::BothGiveWay,
                same => same,
            };
            let roles = Role::WORDS.iter().map(|(_, role)| *role);
            let described = roles.filter(|r| is(*r, &own, &other));
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
            let heading = heading_of(-p) - (Sectors::STANDARD.abaft_the_beam + beyond);
            let other = ship(p.x, p.y, heading, 2.0);
            assert_eq!(raw_role(&own, &other), Some(role));
        }
        for (beyond, role) in [(-1e-9, Role::HeadOn), (1e-9, Role::StandOn)] {
            let p = direction(Sectors::STANDARD.head_on + beyond) * 500.0;
            let other = ship(p.x, p.y, heading_of(-p), 6.0);
            assert_eq!(raw_role(&own, &other), Some(role));
        }
        // dead ahead, crossing: the other's view decides
        let seen = |heading: f64, speed: f64| raw_role(&own, &ship(500.0, 0.0, heading, speed));
        assert_eq!(seen(FRAC_PI_2, 3.0), Some(GiveWay));
        assert_eq!(seen(-FRAC_PI_2, 3.0), Some(StandOn));
        assert_eq!(seen(PI, 0.19), Some(Role::Static));
        let at_rest = ship(0.0, 0.0, 0.0, 0.19);
        let role = raw_role(&at_rest, &ship(500.0, 0.0, PI, 5.0));
        assert_eq!(role, Some(Role::None));
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
