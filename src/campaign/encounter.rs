//! Random encounters of a chosen kind.

use std::f64::consts::PI;

use rand::Rng;

use crate::colregs::{Role, Sectors};
use crate::frame::{Pose, Vector, direction, heading_of, relative_bearing, to_port, wrap};
use crate::geometry::outer_disc;
use crate::target::{DomainKind, ShipTrack};
use crate::tolerance::SIGMAS;
use crate::vessel::{Hull, OwnShip};

/// Radians: bearings within which two ships meet head-on, and beyond which one overtakes.
const HEAD_ON: f64 = Sectors::STANDARD.head_on;
const ABAFT: f64 = Sectors::STANDARD.abaft_the_beam;
/// Radians, 20° and 15°: bearing and course of a ship ahead that is overtaken.
const OVERTAKEN_BEARING: f64 = PI / 9.0;
const OVERTAKEN_COURSE: f64 = PI / 12.0;

/// Seconds before the start at which the encounter already is of its kind.
const EARLIER: f64 = 30.0;

/// Draws of one target before the generator gives up on its kind.
const MAX_DRAWS: usize = 10_000;

/// Kind of encounter: own ship's role toward the target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum EncounterKind {
    /// Nearly reciprocal courses.
    HeadOn,
    /// The target crosses from starboard.
    GiveWay,
    /// The target crosses from port.
    StandOn,
    /// Own ship comes up from astern.
    Overtaking,
    /// The target comes up from astern.
    Overtaken,
}

impl EncounterKind {
    /// Every kind.
    pub const ALL: [Self; 5] = [
        Self::HeadOn,
        Self::GiveWay,
        Self::StandOn,
        Self::Overtaking,
        Self::Overtaken,
    ];

    /// Every kind with every seed.
    pub fn with_seeds(seeds: std::ops::Range<u64>) -> impl Iterator<Item = (Self, u64)> {
        let each = move |kind| seeds.clone().map(move |seed| (kind, seed));
        Self::ALL.into_iter().flat_map(each)
    }

    /// Own ship's role toward the target.
    pub fn role(self) -> Role {
        match self {
            Self::HeadOn => Role::HeadOn,
            Self::GiveWay => Role::GiveWay,
            Self::StandOn => Role::StandOn,
            Self::Overtaking => Role::Overtaking,
            Self::Overtaken => Role::Overtaken,
        }
    }

    /// Name of the role.
    pub fn name(self) -> &'static str {
        self.role().word()
    }

    /// Relative bearings (clockwise, radians) at which the target is first seen.
    fn bearings(self) -> Distribution {
        let (from, to) = match self {
            Self::HeadOn => (-HEAD_ON, HEAD_ON),
            Self::GiveWay => (HEAD_ON, ABAFT),
            Self::StandOn => (-ABAFT, -HEAD_ON),
            Self::Overtaking => (-OVERTAKEN_BEARING, OVERTAKEN_BEARING),
            Self::Overtaken => (PI - OVERTAKEN_BEARING, PI + OVERTAKEN_BEARING),
        };
        Distribution::Uniform(from, to)
    }

    /// Target speeds, m/s, for an own speed: half to one and a half of it; 0.36 to 0.7 of it when
    /// overtaking, and 1.3 to 1.64 of it when overtaken.
    fn speeds(self, own: f64) -> Distribution {
        let (from, to) = match self {
            Self::HeadOn | Self::GiveWay | Self::StandOn => (0.5 * own, 1.5 * own),
            Self::Overtaking => (own - 0.64 * own, own - 0.3 * own),
            Self::Overtaken => (own + 0.3 * own, own + 0.64 * own),
        };
        Distribution::Uniform(from, to)
    }

    /// True for an encounter of this kind by the sectors of docs/reference/colregs.md, section 1.3,
    /// Rule 13 first.
    fn describes(self, own: &Pose, target: &Pose) -> bool {
        let bearing = relative_bearing(own, target.position);
        let aspect = relative_bearing(target, own.position);
        let along = wrap(target.heading - own.heading).abs() <= OVERTAKEN_COURSE;
        match (bearing.abs() > ABAFT, aspect.abs() > ABAFT) {
            (true, true) => return false,
            (true, false) => return self == Self::Overtaken && along,
            (false, true) => return self == Self::Overtaking && along,
            (false, false) => {}
        }
        let head_on = bearing.abs().max(aspect.abs()) <= HEAD_ON;
        match self {
            Self::HeadOn => head_on,
            Self::GiveWay => !head_on && bearing > 0.0 && aspect < 0.0,
            Self::StandOn => !head_on && bearing < 0.0 && aspect > 0.0,
            Self::Overtaking | Self::Overtaken => false,
        }
    }
}

/// Distribution of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distribution {
    /// One value.
    Fixed(f64),
    /// Uniform between two values, both included.
    Uniform(f64, f64),
}

impl Distribution {
    /// One value; a fixed one takes no random number.
    pub fn draw(self, rng: &mut impl Rng) -> f64 {
        match self {
            Self::Fixed(value) => value,
            Self::Uniform(from, to) => rng.random_range(from..=to),
        }
    }

    /// The largest value.
    pub fn largest(self) -> f64 {
        match self {
            Self::Fixed(value) | Self::Uniform(_, value) => value,
        }
    }

    /// The smallest value.
    pub fn smallest(self) -> f64 {
        match self {
            Self::Fixed(value) | Self::Uniform(value, _) => value,
        }
    }

    /// The distribution of the values in another unit.
    #[must_use]
    pub fn map(self, change: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Fixed(value) => Self::Fixed(change(value)),
            Self::Uniform(from, to) => Self::Uniform(change(from), change(to)),
        }
    }
}

/// Distance of the centres at the closest approach on nominal tracks, positive to port of the
/// relative motion of own ship.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Miss {
    /// Metres.
    Metres(Distribution),
    /// Lengths of the target.
    Lengths(Distribution),
}

/// Distributions of an encounter with one target; seconds, metres, m/s, radians.
#[derive(Debug, Clone, PartialEq)]
pub struct Encounter {
    /// Own ship's role toward the target.
    pub kind: EncounterKind,
    /// Time from the start to the closest approach on nominal tracks.
    pub tcpa: Distribution,
    /// Distance then.
    pub miss: Miss,
    /// Relative bearing of the target at the start, clockwise.
    pub bearing: Distribution,
    /// Speed of the target.
    pub speed: Distribution,
    /// Length of the target.
    pub length: Distribution,
    /// Its length over its beam.
    pub slenderness: Distribution,
    /// Standard deviation of its position.
    pub position_std: Distribution,
    /// Half-width of its speed.
    pub speed_spread: Distribution,
    /// Half-width of its course.
    pub course_spread: Distribution,
}

impl Encounter {
    /// The standard encounter of a kind for an own speed: the risk exists at the start, 100 to
    /// 220 s before the closest approach.
    pub fn of(kind: EncounterKind, own_speed: f64) -> Self {
        use Distribution::Uniform;
        Self {
            kind,
            tcpa: Uniform(100.0, 220.0),
            miss: Miss::Lengths(Uniform(-0.5, 0.5)),
            bearing: kind.bearings(),
            speed: kind.speeds(own_speed),
            length: Uniform(30.0, 100.0),
            slenderness: Uniform(4.0, 7.0),
            position_std: Uniform(0.0, 5.0),
            speed_spread: Uniform(0.1, 0.6),
            course_spread: Uniform(PI / 180.0, 8.0 * PI / 180.0),
        }
    }

    /// The first draw of the kind, in the frame of own ship's pose, and how many were not and were
    /// replaced; `None` where none of 10,000 is.
    pub fn draw(&self, own: &OwnShip, rng: &mut impl Rng) -> Option<(ShipTrack, usize)> {
        (0..MAX_DRAWS).find_map(|rejected| Some((self.draw_once(own, rng)?, rejected)))
    }

    /// One target, where it would reach own ship's track at the meeting time, moved sideways by the
    /// miss distance (docs/reference/colregs.md 4.3). `None` if the draw is not of the kind, now
    /// and 30 s ago, or begins inside the hard set.
    pub(super) fn draw_once(&self, own: &OwnShip, rng: &mut impl Rng) -> Option<ShipTrack> {
        let meeting_time = self.tcpa.draw(rng);
        let bearing = self.bearing.draw(rng);
        let speed = self.speed.draw(rng);
        let length = self.length.draw(rng);
        let hull = Hull::new(length, length / self.slenderness.draw(rng));
        let miss = match self.miss {
            Miss::Metres(metres) => metres.draw(rng),
            Miss::Lengths(lengths) => lengths.draw(rng) * length,
        };
        let position_std = self.position_std.draw(rng);
        let speed_spread = self.speed_spread.draw(rng);
        let course_spread = self.course_spread.draw(rng);
        let farther = rng.random_bool(0.5);

        // the range from which the target reaches the meeting point in time
        let meeting_point = Vector::new(own.speed * meeting_time, 0.0);
        let sight = direction(-bearing);
        let half = sight.dot(&meeting_point);
        let root =
            (half * half - meeting_point.norm_squared() + (speed * meeting_time).powi(2)).sqrt();
        let range = if farther { half + root } else { half - root };
        // negated on purpose: no real root is no draw
        if !(range > 0.0) {
            return None;
        }
        let velocity = (meeting_point - sight * range) / meeting_time;
        let relative = Vector::new(own.speed, 0.0) - velocity;
        let position = sight * range + to_port(relative.normalize()) * miss;
        let ship = ShipTrack {
            position_std,
            speed_spread,
            course_spread,
            domain: DomainKind::Colregs,
            ..ShipTrack::exact(Pose::new(position, heading_of(velocity)), speed, hull)
        };
        let own_at = |time: f64| Pose::new(Vector::new(own.speed * time, 0.0), 0.0);
        let intended = [-EARLIER, 0.0]
            .iter()
            .all(|&t| self.kind.describes(&own_at(t), &ship.pose_at(t)));
        let reach = own.hull.half_diagonal() + own.safety_margin + SIGMAS * position_std;
        let clear =
            ship.outer_hull(0.0).signed_distance(Vector::zeros()) > outer_disc(reach, 0.0).reach();
        (intended && clear).then_some(ship)
    }
}
