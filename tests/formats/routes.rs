//! Tests of targets with declared routes: they stay in the sets that are made of them.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::colregs::Role;
use searoom::frame::{Vector, direction, heading_of, wrap};
use searoom::geometry::outer_disc;
use searoom::scenario::import::{Assumed, Contents, Imported};
use searoom::target::{Motion, Target, Uncertainty};
use serde_json::{Value, json};

use super::{dnv_01, imported, situations};

/// Target with a route: metres east and north of its start, speeds in knots, turn radii in metres.
struct Declared {
    points: Vec<Vector>,
    knots: Vec<f64>,
    radii: Vec<Option<f64>>,
    delay: f64,
}

impl Declared {
    fn random(rng: &mut ChaCha8Rng) -> Self {
        // so many that changes are omitted
        let many = rng.random_bool(0.2);
        let legs = if many { 30 } else { rng.random_range(2..6) };
        let lengths = if many { 400.0..900.0 } else { 1500.0..4000.0 };
        let mut points = vec![Vector::new(rng.random_range(-5e3..5e3), 4000.0)];
        let mut course = rng.random_range(-3.0..3.0);
        for _ in 0..legs {
            let last = points[points.len() - 1];
            points.push(last + direction(course) * rng.random_range(lengths.clone()));
            course += rng.random_range(-2.0..2.0);
        }
        let radius = |rng: &mut ChaCha8Rng| match rng.random_range(0..3) {
            0 => None,
            1 => Some(0.0),
            _ if many => None,
            _ => Some(rng.random_range(50.0..300.0)),
        };
        Self {
            knots: (0..legs).map(|_| rng.random_range(4.0..20.0)).collect(),
            radii: (0..=legs).map(|_| radius(rng)).collect(),
            delay: match rng.random_bool(0.3) {
                true => rng.random_range(1.0..600.0),
                false => 0.0,
            },
            points,
        }
    }

    /// Converts to a DNV file; the inverse projection gives degrees.
    fn document(&self) -> String {
        let mut document = dnv_01();
        let origin = searoom::frame::Geographic::new(58.763449, 10.490654);
        let earth = searoom::frame::Georeference::new(origin).expect("on earth");
        let waypoints: Vec<Value> = self
            .points
            .iter()
            .enumerate()
            .map(|(index, point)| {
                let place = earth.to_geographic(*point);
                let position = json!({ "lat": place.lat_deg, "lon": place.lon_deg });
                let mut waypoint = json!({ "position": position });
                let is_corner = index > 0 && index < self.knots.len();
                if let (true, Some(radius)) = (is_corner, self.radii[index]) {
                    waypoint["turnRadius"] = json!(radius / 1852.0);
                }
                if index > 0 {
                    waypoint["leg"] = json!({ "sog": self.knots[index - 1] });
                }
                waypoint
            })
            .collect();
        let ship = document.pointer_mut("/targetShips/0").expect("there");
        ship["waypoints"] = Value::Array(waypoints);
        ship["initial"] = json!({});
        ship["static"]["initDelay"] = json!(self.delay);
        document.to_string()
    }

    /// Pieces of the declared route: length, heading as a function of the distance on the piece,
    /// and its leg or two legs.
    fn pieces(&self, rounded: bool) -> Vec<Piece> {
        let mut pieces = Vec::new();
        let mut begun = 0.0;
        for leg in 0..self.knots.len() {
            let way = self.points[leg + 1] - self.points[leg];
            let heading = heading_of(way);
            let mut ends = 0.0;
            let mut arc = None;
            if leg + 1 < self.knots.len() {
                let turn = wrap(heading_of(self.points[leg + 2] - self.points[leg + 1]) - heading);
                // 125 m is assumed for a hull of 50 × 10 m
                let radius = self.radii[leg + 1].unwrap_or(if rounded { 125.0 } else { 0.0 });
                ends = radius * (0.5 * turn.abs()).tan();
                arc = Some(Piece {
                    length: radius * turn.abs(),
                    heading,
                    turn,
                    legs: [leg, leg + 1],
                });
            }
            pieces.push(Piece {
                length: way.norm() - begun - ends,
                heading,
                turn: 0.0,
                legs: [leg, leg],
            });
            pieces.extend(arc);
            begun = ends;
        }
        pieces
    }
}

struct Piece {
    length: f64,
    heading: f64,
    turn: f64,
    legs: [usize; 2],
}

/// Deviations of speed and course as fractions of their spreads.
const EXTREMES: [(f64, f64); 5] = [
    (1.0, 0.0),
    (-1.0, 0.0),
    (1.0, 1.0),
    (-1.0, -1.0),
    (-1.0, 1.0),
];

/// Offset in seconds of the sampled instants within a step, to exclude rounding.
const INSIDE: f64 = 1e-4;

/// Tests targets that follow their routes within the spread: fast and slow, with deviations to
/// either side, on sharp corners and on arcs. At every instant their velocity and position are in
/// the declared set, with the clearance that hulls and margin require.
#[test]
fn a_target_that_follows_her_route_is_in_her_set_at_all_times() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let (speed_spread, course_spread) = (0.5, 5.0_f64.to_radians());
    let (mut deepest, mut followed, mut known) = (f64::NEG_INFINITY, 0, 0);
    for _ in 0..60 {
        let declared = Declared::random(&mut rng);
        let situation =
            match Contents::parse(&declared.document(), &Assumed::default()).expect("JSON") {
                Contents::Situations(mut situations) => match situations.remove(0) {
                    Ok(situation) => situation,
                    // a turn that does not fit is refused
                    Err(faults) => {
                        assert!(faults[0].found.contains("turnRadius"), "{faults:?}");
                        continue;
                    }
                },
                other => panic!("{other:?}"),
            };
        let Imported {
            scenario, notes, ..
        } = imported(&situation);
        let mut target = scenario.targets[0].clone();
        if let Some(ship) = target.ship() {
            known += 1;
            assert_eq!(ship.route.len(), declared.knots.len());
            let velocities = ship.outer_velocity_sets(0.0, scenario.horizon);
            let own = &scenario.own_ship;
            let hulls = ship.hull.half_diagonal() + own.hull.half_diagonal();
            let around = outer_disc(hulls + own.safety_margin, 0.0);
            let initial = around.translated(ship.pose.position);
            target.motion = Motion::Sets(Uncertainty::new(initial, velocities));
        }
        let target = &target;
        let sets = &target.sets().expect("sets").velocities;
        assert!(sets.len() > 1 && sets.len() <= 50, "{}", sets.len());
        let late = notes.iter().any(|n| n.contains("appears after"));
        assert_eq!(late, declared.delay > 0.0);
        let own = &scenario.own_ship;
        let hull = |length: f64, beam: f64| 0.5 * length.hypot(beam);
        let clearance = hull(50.0, 10.0) + hull(own.hull.length, own.hull.beam) + own.safety_margin;
        // checking the position is expensive for many sets
        let many = declared.knots.len() > 6;
        let (runs, every) = if many { (6, 40) } else { (20, 1) };
        let mut steps = 0;
        for run in 0..runs {
            // constant extremes first, then arbitrary values
            let extreme = EXTREMES.get(run).copied();
            let pieces = declared.pieces(run % 2 == 0);
            if pieces.iter().any(|p| p.length < 0.0) {
                continue;
            }
            followed += 1;
            let mut at = declared.points[0];
            let mut time = declared.delay;
            let worst = check(target, at, 0.5 * time, clearance);
            assert!(worst <= 1e-6, "{worst}");
            'way: for piece in &pieces {
                let mut made = 0.0;
                while made < piece.length {
                    let (fast, stray) = extreme.unwrap_or_else(|| {
                        (rng.random_range(-1.0..=1.0), rng.random_range(-1.0..=1.0))
                    });
                    let knots = declared.knots[piece.legs[usize::from(2.0 * made > piece.length)]];
                    let speed = knots * 1852.0 / 3600.0 + fast * speed_spread;
                    let error: f64 = stray * course_spread;
                    let heading = piece.heading + piece.turn * made / piece.length;
                    let rate = speed * error.cos();
                    let step = 10.0_f64
                        .min((piece.length - made) / rate)
                        .min(piece.length / 8.0 / rate);
                    let velocity = direction(heading + error) * speed;
                    // skip steps produced by rounding
                    let ends = [time + INSIDE, time + step - INSIDE];
                    for moment in ends.into_iter().filter(|_| step > 2.0 * INSIDE) {
                        let mut later = sets.iter().filter(|s| moment <= s.until);
                        let now = later.next().expect("a last one");
                        let now = now.velocities.as_polygon().expect("a polygon");
                        let out = now.signed_distance(velocity);
                        assert!(out <= 1e-9, "{out} m/s outside at {moment} s");
                    }
                    at += velocity * step;
                    made += rate * step;
                    time += step;
                    if time > scenario.horizon {
                        break 'way;
                    }
                    steps += 1;
                    if steps % every == 0 {
                        let worst = check(target, at, time, clearance);
                        deepest = deepest.max(worst);
                        assert!(worst <= 1e-3, "{worst} m outside at {time} s");
                    }
                }
            }
        }
    }
    assert!(followed > 500 && known >= 3, "{followed} {known}");
    // the sets are not so large that the test cannot fail
    assert!(deepest > -400.0, "{deepest}");
}

/// Clearance deficit in metres: by how much a target at a position is too near to the edge of its
/// set.
fn check(target: &Target, at: Vector, time: f64, clearance: f64) -> f64 {
    let set = target.sets().expect("explicit sets").outer_section(time);
    set.signed_distance(at) + clearance
}

#[test]
fn a_route_on_one_line_is_a_tracked_ship() {
    let mut document = dnv_01();
    let ship = document.pointer_mut("/targetShips/0").expect("there");
    let middle =
        json!({ "position": { "lat": 58.80500723, "lon": 10.4906874 }, "leg": { "sog": 12.1 } });
    let waypoints = ship["waypoints"].as_array_mut();
    waypoints.expect("a list").insert(1, middle);
    let contents = Contents::parse(&document.to_string(), &Assumed::default()).expect("good");
    let scenario = imported(&situations(contents)[0]).scenario;
    let ship = scenario.targets[0].ship().expect("a ship");
    // widened by the deviation of the middle point
    let spread = ship.course_spread.to_degrees();
    assert!((5.0..6.0).contains(&spread), "{spread}");
}

/// A radius that a known route has. A larger one makes a set of the target, without a hull and a role.
#[test]
fn a_turn_radius_that_a_known_route_has_takes_no_role_away() {
    let with_radius = |miles: Option<f64>| {
        let mut document = dnv_01();
        let ship = document.pointer_mut("/targetShips/0").expect("there");
        let waypoints = ship["waypoints"].as_array_mut().expect("a list");
        waypoints
            .push(json!({ "position": { "lat": 58.70, "lon": 10.60 }, "leg": { "sog": 12.1 } }));
        if let Some(miles) = miles {
            waypoints[1]["turnRadius"] = json!(miles);
        }
        let contents = Contents::parse(&document.to_string(), &Assumed::default()).expect("good");
        let found = imported(&situations(contents)[0]);
        let role = searoom::pipeline::sets(&found.scenario)[0].encounter.role;
        let cautions = &found.scenario.remarks.cautions;
        let caution = cautions.iter().any(|text| text.starts_with("rules for '"));
        (role, caution)
    };
    let corner = with_radius(None);
    assert_eq!(corner, (Role::HeadOn, false));
    // 4.5 lengths of the ship are 0.121 miles
    assert_eq!(with_radius(Some(0.12)), corner);
    assert_eq!(with_radius(Some(0.13)), (Role::None, true));
}
