//! Scenes from the traffic of New York harbour. Each vessel under way in turn is own ship; all
//! others are targets.

use searoom::frame::{
    Geographic, Georeference, KNOT_MPS, Pose, Vector, direction, heading_from_course_deg,
};
use searoom::scenario::Scenario;
use searoom::target::{DomainKind, Motion, Representation, ShipTrack, Target};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::{Hull, OwnShip};

use super::encounter_generator::{EncounterKind, Placement, random_encounter};

/// The vessels of one moment; benches/data/README.md has their source.
const TRAFFIC: &str = include_str!("../data/new-york-2022-01-03.csv");

/// Speed in knots below which a vessel is at rest.
const AT_REST_KN: f64 = 1.0;
/// Default length in metres, and default ratio of length to beam.
const LENGTH_M: f64 = 60.0;
const SLENDERNESS: f64 = 5.0;
/// Standard deviations of a vessel under way in m/s, radians and metres.
const SPEED_SPREAD: f64 = 0.5;
const COURSE_SPREAD: f64 = 5.0 * std::f64::consts::PI / 180.0;
const POSITION_STD: f64 = 5.0;
/// Safety margin between the hulls in metres.
const MARGIN_M: f64 = 20.0;
/// Time in seconds for which own ship intends to hold course and speed; the horizon is twice as
/// long.
const AHEAD_S: f64 = 600.0;
/// Minimum turning radius in lengths of own ship.
const RADIUS_LENGTHS: f64 = 4.0;

/// Distance in metres between copies of the traffic.
const FAR_AWAY_M: f64 = 100_000.0;

/// Builds one scene per vessel under way.
pub fn scenes() -> Result<Vec<Scenario>, Box<dyn std::error::Error>> {
    let origin = Geographic::new(40.65, -74.05);
    let georeference = Georeference::new(origin).ok_or("no origin")?;
    let mut ships = Vec::new();
    for row in csv::Reader::from_reader(TRAFFIC.as_bytes()).deserialize() {
        let (lat_deg, lon_deg, speed_kn, course, length, beam): Row = row?;
        let at_rest = speed_kn < AT_REST_KN || course >= 360.0;
        let length = length.unwrap_or(LENGTH_M);
        let position = georeference.to_plane(Geographic { lat_deg, lon_deg });
        let pose = Pose::new(position, heading_from_course_deg(course));
        let speed = if at_rest { 0.0 } else { speed_kn * KNOT_MPS };
        let hull = Hull::new(length, beam.unwrap_or(length / SLENDERNESS));
        ships.push(ShipTrack {
            position_std: POSITION_STD,
            speed_spread: if at_rest { 0.0 } else { SPEED_SPREAD },
            course_spread: if at_rest { 0.0 } else { COURSE_SPREAD },
            // a moored vessel needs no ship domain
            domain: if at_rest {
                DomainKind::Hull
            } else {
                DomainKind::Colregs
            },
            ..ShipTrack::exact(pose, speed, hull)
        });
    }
    // settings independent of the positions
    let settings = random_encounter(EncounterKind::HeadOn, 0, Placement::Origin);
    let settings = settings.ok_or("no encounter")?.scenario;
    let under_way = (0..ships.len()).filter(|i| ships[*i].speed > 0.0);
    under_way.map(|own| scene(&settings, &ships, own)).collect()
}

/// Adds nine times as many targets, so far away that they do not matter.
#[allow(dead_code, reason = "the leaderboard has no use for it")]
pub fn with_more_far_away(scenario: &Scenario) -> Scenario {
    let mut crowded = scenario.clone();
    for copy in 1..10 {
        let shift = Vector::new(FAR_AWAY_M * f64::from(copy), 0.0);
        crowded
            .targets
            .extend(scenario.targets.iter().map(|target| {
                let mut target = target.clone();
                if let Motion::Ship(ship) = &mut target.motion {
                    ship.pose.position += shift;
                }
                target.name = format!("{}, {copy} further", target.name);
                target
            }));
    }
    crowded
}

type Row = (f64, f64, f64, f64, Option<f64>, Option<f64>);

fn scene(
    settings: &Scenario,
    ships: &[ShipTrack],
    own: usize,
) -> Result<Scenario, Box<dyn std::error::Error>> {
    let ship = &ships[own];
    // relative to own ship: no precision is lost near the origin
    let place = |p: Vector| p - ship.pose.position;
    let pose = Pose::new(Vector::zeros(), ship.pose.heading);
    let end = direction(pose.heading) * (ship.speed * AHEAD_S);
    let others = ships.iter().enumerate().filter(|(i, _)| *i != own);
    let targets = others.map(|(i, track)| Target {
        name: format!("vessel {i}"),
        motion: Motion::Ship(ShipTrack {
            pose: Pose::new(place(track.pose.position), track.pose.heading),
            ..track.clone()
        }),
        representation: Representation::Polytope,
        status: None,
    });
    Ok(Scenario {
        title: format!("New York, vessel {own}"),
        own_ship: OwnShip {
            pose,
            speed: ship.speed,
            hull: ship.hull,
            turning_radius: RADIUS_LENGTHS * ship.hull.length,
            speeds: vec![0.5 * ship.speed, ship.speed, 1.2 * ship.speed],
            safety_margin: MARGIN_M,
            tracking_margin: 0.0,
        },
        desired: DesiredTrajectory::new(&[Vector::zeros(), end], &[ship.speed])?,
        targets: targets.collect(),
        horizon: 2.0 * AHEAD_S,
        ..settings.clone()
    })
}
