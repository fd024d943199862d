//! Random encounters of a chosen kind, with uncertain targets.
#![allow(dead_code, reason = "every test, bench and example uses a part")]

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

pub use searoom::campaign::EncounterKind;
use searoom::campaign::{Distribution, Encounter};
use searoom::colregs::Thresholds;
use searoom::frame::{Pose, Vector, wrap};
use searoom::planner::{
    DEFAULT_PLANNER, Objective, PlannerSettings, SearchKind, SpaceTimeSettings,
};
use searoom::scenario::{Compliance, Memory, Remarks, Scenario, SimulationSettings};
use searoom::target::{Motion, Representation, ShipTrack, Target};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::{Hull, OwnShip};

/// Settings of the space-time planner that scenes are planned with.
pub static SETTINGS: std::sync::OnceLock<SpaceTimeSettings> = std::sync::OnceLock::new();

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

/// The kinds of random traffic.
const TRAFFIC: [EncounterKind; 4] = [
    EncounterKind::HeadOn,
    EncounterKind::GiveWay,
    EncounterKind::StandOn,
    EncounterKind::Overtaking,
];

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
/// the miss distance (docs/reference/colregs.md 4.3). Equal arguments give equal scenes. `None`
/// where every draw was of another kind.
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
    let kinds = TRAFFIC;
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

/// When each of up to three ships is met that are passed one after another, seconds from the start to the
/// closest approach.
const ONE_AFTER_ANOTHER: [RangeInclusive<f64>; 3] = [120.0..=200.0, 520.0..=640.0, 950.0..=1050.0];

/// Own ship and up to three targets of random kinds on a path of 7 km, the closest approaches some
/// 400 s apart. Equal arguments give equal scenes. `None` for more targets.
pub fn random_sequence(count: usize, seed: u64, placement: Placement) -> Option<RandomEncounter> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream((2 * TRAFFIC.len() + count) as u64);
    let kinds: Vec<EncounterKind> = (0..count)
        .map(|_| TRAFFIC[rng.random_range(0..TRAFFIC.len())])
        .collect();
    let meeting = Meeting {
        path_length: 7_000.0,
        horizon: 3_000.0,
        ..Meeting::NEAR
    };
    let title = format!("{count} targets one after another {seed}");
    let times = ONE_AFTER_ANOTHER.get(..count)?.iter().cloned();
    scene_at(title, kinds, times, placement, &meeting, &mut rng)
}

fn scene(
    title: String,
    kinds: Vec<EncounterKind>,
    placement: Placement,
    meeting: &Meeting,
    rng: &mut ChaCha8Rng,
) -> Option<RandomEncounter> {
    let times = std::iter::repeat(meeting.time.clone());
    scene_at(title, kinds, times, placement, meeting, rng)
}

/// A scene with a target of each kind, met at these times.
fn scene_at(
    title: String,
    kinds: Vec<EncounterKind>,
    times: impl Iterator<Item = RangeInclusive<f64>>,
    placement: Placement,
    meeting: &Meeting,
    rng: &mut ChaCha8Rng,
) -> Option<RandomEncounter> {
    let own_ship = OwnShip {
        pose: Pose::new(Vector::zeros(), 0.0),
        speed: OWN_SPEED,
        hull: OWN_HULL,
        turning_radius: TURNING_RADIUS,
        speeds: OWN_SPEEDS.to_vec(),
        safety_margin: SAFETY_MARGIN,
        tracking_margin: 0.0,
    };
    let mut rejected = 0;
    let mut ships = Vec::with_capacity(kinds.len());
    for (&kind, time) in kinds.iter().zip(times) {
        let encounter = Encounter {
            tcpa: Distribution::Uniform(*time.start(), *time.end()),
            ..Encounter::of(kind, OWN_SPEED)
        };
        let (ship, replaced) = encounter.draw(&own_ship, rng)?;
        rejected += replaced;
        ships.push(ship);
    }
    let origin = match placement {
        Placement::Origin => own_ship.pose,
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
        status: None,
    });
    let waypoints = [Vector::zeros(), Vector::new(meeting.path_length, 0.0)];
    let waypoints = waypoints.map(|w| origin.world_coordinates(w));
    Some(RandomEncounter {
        scenario: Scenario {
            title,
            time: 0.0,
            start: None,
            horizon: meeting.horizon,
            acceleration: None,
            own_ship: OwnShip {
                pose: origin,
                ..own_ship
            },
            desired: DesiredTrajectory::new(&waypoints, &[OWN_SPEED]).ok()?,
            speed_limits: Vec::new(),
            alternatives: Vec::new(),
            targets: targets.collect(),
            out_of_reach: std::sync::Arc::default(),
            planner: DEFAULT_PLANNER,
            objective: Objective::SpaceTimeError,
            settings: PlannerSettings {
                space_time: SETTINGS.get_or_init(SpaceTimeSettings::default),
                ..PlannerSettings::at_length(OWN_HULL.length)
            },
            search: SearchKind::AStar,
            compliance: Compliance::Shape,
            time_weight: TIME_WEIGHT,
            arrival_hold: 60.0,
            stay: None,
            max_risk: 0.0,
            deadline: DEADLINE,
            limits: std::sync::Arc::new(Thresholds::STANDARD),
            thresholds: None,
            earth: None,
            land: None,
            memory: Memory::default(),
            simulation: SimulationSettings::default(),
            remarks: Remarks::default(),
        },
        kinds,
        rejected,
    })
}
