//! Random encounters of a chosen kind, with uncertain targets.
#![allow(dead_code, reason = "every test, bench and example uses a part")]

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use searoom::colregs::{Role, Sectors, Thresholds};
use searoom::frame::{Pose, Vector, direction, heading_of, relative_bearing, to_port, wrap};
use searoom::geometry::outer_disc;
use searoom::planner::{DEFAULT_PLANNER, Objective, PlannerSettings, SearchKind};
use searoom::scenario::{Compliance, Memory, Scenario, SimulationSettings};
use searoom::target::{DomainKind, Motion, Representation, ShipTrack, Target};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::{Hull, OwnShip};

/// m/s, own ship's desired speed.
const OWN_SPEED: f64 = 5.0;
/// m/s, own ship's finite set of speeds.
const OWN_SPEEDS: [f64; 3] = [2.5, 5.0, 6.0];
/// Metres, smallest turning radius.
const TURNING_RADIUS: f64 = 100.0;
/// Own hull.
const OWN_HULL: Hull = Hull::new(30.0, 8.0);
/// Metres between hulls.
const SAFETY_MARGIN: f64 = 20.0;
/// m²/s².
const TIME_WEIGHT: f64 = 25.0;
/// Wall-clock seconds of one plan, far more than needed: outcomes must not depend on it.
const DEADLINE: f64 = 60.0;

/// Metres.
const TARGET_LENGTH: RangeInclusive<f64> = 30.0..=100.0;
/// Length over beam.
const SLENDERNESS: RangeInclusive<f64> = 4.0..=7.0;
/// Miss distance of the centres on nominal tracks, as a fraction of the target's length.
const MISS: RangeInclusive<f64> = -0.5..=0.5;
/// m/s.
const SPEED_SPREAD: RangeInclusive<f64> = 0.1..=0.6;
/// Radians: 1° to 8°.
const COURSE_SPREAD: RangeInclusive<f64> = PI / 180.0..=8.0 * PI / 180.0;
/// Metres.
const POSITION_STD: RangeInclusive<f64> = 0.0..=5.0;

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

/// When the ships of random encounters meet.
#[derive(Debug, Clone, PartialEq)]
pub struct Meeting {
    /// Seconds from the start to the closest approach on nominal tracks.
    pub time: RangeInclusive<f64>,
    /// Metres: length of the straight desired path, on which the slowest overtaking ends.
    pub path_length: f64,
    /// Seconds.
    pub horizon: f64,
}

impl Meeting {
    /// The risk exists when the scene begins: 100 to 220 s before the closest approach.
    pub const NEAR: Self = Self {
        time: 100.0..=220.0,
        path_length: 2500.0,
        horizon: 1000.0,
    };

    /// The scene begins 300 to 900 s before the closest approach; the risk mostly arises later.
    pub const FAR: Self = Self {
        time: 300.0..=900.0,
        path_length: 7500.0,
        horizon: 3000.0,
    };
}

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

    /// The kinds of random traffic.
    const TRAFFIC: [Self; 4] = [Self::HeadOn, Self::GiveWay, Self::StandOn, Self::Overtaking];

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
    fn bearings(self) -> RangeInclusive<f64> {
        match self {
            Self::HeadOn => -HEAD_ON..=HEAD_ON,
            Self::GiveWay => HEAD_ON..=ABAFT,
            Self::StandOn => -ABAFT..=-HEAD_ON,
            Self::Overtaking => -OVERTAKEN_BEARING..=OVERTAKEN_BEARING,
            Self::Overtaken => PI - OVERTAKEN_BEARING..=PI + OVERTAKEN_BEARING,
        }
    }

    /// Target speeds, m/s: half to one and a half of own speed; 1.5–3.2 m/s less
    /// when overtaken, and more when overtaking.
    fn speeds(self) -> RangeInclusive<f64> {
        match self {
            Self::HeadOn | Self::GiveWay | Self::StandOn => 0.5 * OWN_SPEED..=1.5 * OWN_SPEED,
            Self::Overtaking => OWN_SPEED - 3.2..=OWN_SPEED - 1.5,
            Self::Overtaken => OWN_SPEED + 1.5..=OWN_SPEED + 3.2,
        }
    }

    /// True for an encounter of this kind by the sectors of docs/colregs.md, section 1.3, Rule 13
    /// first.
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

/// Place of the scene in the plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Placement {
    /// Own ship starts at the origin and steers east.
    Origin,
    /// Turned by any angle and moved by up to 10 km each way: the answer must not change.
    Random,
}

/// A random scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct RandomEncounter {
    /// Ready to be planned.
    pub scenario: Scenario,
    /// Kind of encounter with each target, in the scenario's order.
    pub kinds: Vec<EncounterKind>,
    /// Draws that were not of the intended kind or began inside a hard set, and were replaced.
    pub rejected: usize,
}

/// Own ship and one target. Its bearing is uniform in the kind's sector, its speed in the kind's
/// range. It starts where it would reach own ship's track at the meeting time, moved sideways by
/// the miss distance (docs/colregs.md 4.3). Equal arguments give equal scenes. `None` where every
/// draw was of another kind.
pub fn random_encounter(
    kind: EncounterKind,
    seed: u64,
    placement: Placement,
) -> Option<RandomEncounter> {
    random_meeting(kind, seed, placement, &Meeting::NEAR)
}

/// [`random_encounter`] with another time of meeting.
pub fn random_meeting(
    kind: EncounterKind,
    seed: u64,
    placement: Placement,
    meeting: &Meeting,
) -> Option<RandomEncounter> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(kind as u64);
    let title = format!("{} {seed}", kind.name());
    scene(title, vec![kind], placement, meeting, &mut rng)
}

/// Own ship and `count` targets of random kinds, each on a collision course with own ship on its
/// desired trajectory. Equal arguments give equal scenes.
pub fn random_traffic(count: usize, seed: u64, placement: Placement) -> Option<RandomEncounter> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let kinds = EncounterKind::TRAFFIC;
    rng.set_stream((kinds.len() + count) as u64);
    let kinds = (0..count)
        .map(|_| kinds[rng.random_range(0..kinds.len())])
        .collect();
    scene(
        format!("{count} targets {seed}"),
        kinds,
        placement,
        &Meeting::NEAR,
        &mut rng,
    )
}

fn scene(
    title: String,
    kinds: Vec<EncounterKind>,
    placement: Placement,
    meeting: &Meeting,
    rng: &mut ChaCha8Rng,
) -> Option<RandomEncounter> {
    let mut rejected = 0;
    let mut ships = Vec::with_capacity(kinds.len());
    for &kind in &kinds {
        let (misses, ship) =
            (0..MAX_DRAWS).find_map(|misses| Some((misses, draw(kind, meeting, rng)?)))?;
        rejected += misses;
        ships.push(ship);
    }
    let origin = match placement {
        Placement::Origin => Pose::new(Vector::zeros(), 0.0),
        Placement::Random => {
            let mut far = || rng.random_range(-10_000.0..10_000.0);
            Pose::new(Vector::new(far(), far()), rng.random_range(-PI..PI))
        }
    };
    let targets = ships.into_iter().enumerate().map(|(i, ship)| Target {
        name: format!("target {}", i + 1),
        motion: Motion::Ship(ShipTrack {
            pose: Pose::new(
                origin.world_coordinates(ship.pose.position),
                wrap(origin.heading + ship.pose.heading),
            ),
            ..ship
        }),
        representation: Representation::Polytope,
    });
    let waypoints = [Vector::zeros(), Vector::new(meeting.path_length, 0.0)];
    let waypoints = waypoints.map(|w| origin.world_coordinates(w));
    Some(RandomEncounter {
        scenario: Scenario {
            title,
            time: 0.0,
            horizon: meeting.horizon,
            acceleration: None,
            own_ship: OwnShip {
                pose: origin,
                speed: OWN_SPEED,
                hull: OWN_HULL,
                turning_radius: TURNING_RADIUS,
                speeds: OWN_SPEEDS.to_vec(),
                safety_margin: SAFETY_MARGIN,
                tracking_margin: 0.0,
            },
            desired: DesiredTrajectory::new(&waypoints, &[OWN_SPEED]).ok()?,
            alternatives: Vec::new(),
            targets: targets.collect(),
            planner: DEFAULT_PLANNER,
            objective: Objective::SpaceTimeError,
            settings: PlannerSettings::at_length(OWN_HULL.length),
            search: SearchKind::AStar,
            compliance: Compliance::Shape,
            time_weight: TIME_WEIGHT,
            arrival_hold: 60.0,
            max_risk: 0.0,
            deadline: DEADLINE,
            limits: std::sync::Arc::new(Thresholds::STANDARD),
            thresholds: None,
            earth: None,
            land: None,
            memory: Memory::default(),
            simulation: SimulationSettings::default(),
        },
        kinds,
        rejected,
    })
}

/// One target in the frame of own ship's start. `None` if the draw is not of the kind, now and
/// [`EARLIER`], or begins inside the hard set.
fn draw(kind: EncounterKind, meeting: &Meeting, rng: &mut ChaCha8Rng) -> Option<ShipTrack> {
    let meeting_time = rng.random_range(meeting.time.clone());
    let bearing = rng.random_range(kind.bearings());
    let speed = rng.random_range(kind.speeds());
    let length = rng.random_range(TARGET_LENGTH);
    let hull = Hull::new(length, length / rng.random_range(SLENDERNESS));
    let miss = rng.random_range(MISS) * length;
    let position_std = rng.random_range(POSITION_STD);
    let speed_spread = rng.random_range(SPEED_SPREAD);
    let course_spread = rng.random_range(COURSE_SPREAD);
    let farther = rng.random_bool(0.5);

    // the range from which the target reaches the meeting point in time
    let meeting_point = Vector::new(OWN_SPEED * meeting_time, 0.0);
    let sight = direction(-bearing);
    let half = sight.dot(&meeting_point);
    let root = (half * half - meeting_point.norm_squared() + (speed * meeting_time).powi(2)).sqrt();
    let range = if farther { half + root } else { half - root };
    // negated on purpose: no real root is no draw
    if !(range > 0.0) {
        return None;
    }
    let velocity = (meeting_point - sight * range) / meeting_time;
    let heading = heading_of(velocity);
    let relative = Vector::new(OWN_SPEED, 0.0) - velocity;
    let position = sight * range + to_port(relative.normalize()) * miss;
    let ship = ShipTrack {
        position_std,
        speed_spread,
        course_spread,
        domain: DomainKind::Colregs,
        ..ShipTrack::exact(Pose::new(position, heading), speed, hull)
    };
    let own = |time: f64| Pose::new(Vector::new(OWN_SPEED * time, 0.0), 0.0);
    let intended = [-EARLIER, 0.0]
        .iter()
        .all(|&t| kind.describes(&own(t), &ship.pose_at(t)));
    let reach = OWN_HULL.half_diagonal() + SAFETY_MARGIN + 3.0 * position_std;
    let clear =
        ship.outer_hull(0.0).signed_distance(Vector::zeros()) > outer_disc(reach, 0.0).reach();
    (intended && clear).then_some(ship)
}
