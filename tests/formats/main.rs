//! Tests of imported formats: real files, mutated files, and targets that follow their declared
//! tracks.

mod common_ocean;

use std::path::Path;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::frame::{Vector, direction, heading_of, wrap};
use searoom::obstacle::SpaceTimeObstacle;
use searoom::pipeline::{self, RelaxationLevel, Run};
use searoom::scenario::import::{Assumed, Assumption, Contents, Format, Imported, Situation};
use searoom::scenario::{Compliance, Scenario};
use searoom::simulation::{Placement, random_traffic};
use searoom::target::Target;
use serde_json::{Value, json};

fn benchmark(name: &str) -> Vec<Situation> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenarios")
        .join(name);
    situations(Contents::read(&file, &Assumed::default().with_variants(true)).expect("readable"))
}

fn situations(contents: Contents) -> Vec<Situation> {
    let Contents::Situations { situations, .. } = contents else {
        panic!("situations");
    };
    let good = |s: Result<Situation, _>| s.expect("no faults");
    situations.into_iter().map(good).collect()
}

fn dnv_files() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/dnv");
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> = entries
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .to_string_lossy()
                .into()
        })
        .filter(|name: &String| name.ends_with(".json"))
        .map(|name| format!("dnv/{name}"))
        .collect();
    names.sort();
    names
}

fn imported(situation: &Situation) -> Imported {
    situation.scenario(&Assumed::default()).expect("no faults")
}

fn paths(text: &str, assumed: &Assumed) -> Vec<String> {
    let faults = match Contents::parse(text, assumed) {
        Ok(Contents::Situations { situations, .. }) => {
            let mut faults = Vec::new();
            for situation in situations {
                match situation.map(|s| s.scenario(assumed)) {
                    Ok(Ok(_)) => {}
                    Ok(Err(more)) | Err(more) => faults.extend(more),
                }
            }
            faults
        }
        Ok(_) => panic!("situations"),
        Err(faults) => faults,
    };
    assert!(
        faults
            .iter()
            .all(|f| !f.found.is_empty() && !f.allowed.is_empty())
    );
    faults.into_iter().map(|fault| fault.path).collect()
}

#[test]
fn every_case_of_imazu_meets_where_it_is_said_to() {
    let cases = benchmark("imazu/imazu.json");
    assert_eq!(cases.len(), 25);
    let ships: usize = cases[..22].iter().map(Situation::others).sum();
    assert_eq!(ships, 50);
    for case in &cases {
        let Imported {
            scenario, notes, ..
        } = imported(case);
        assert_eq!(notes.len(), 1, "{notes:?}");
        let own = &scenario.own_ship;
        assert_eq!((own.hull.length, own.hull.beam), (100.0, 20.0));
        assert_eq!((own.turning_radius, own.safety_margin), (250.0, 100.0));
        assert!(
            (scenario.horizon - 2.0 * 3600.0).abs() < 0.1,
            "{}",
            scenario.horizon
        );
        let meeting = Vector::new(0.0, 11_112.0);
        assert!((scenario.desired.position_at(1800.0) - meeting).norm() < 0.2);
        for target in &scenario.targets {
            assert!(
                (target.position_at(1800.0) - meeting).norm() < 0.2,
                "{}",
                case.name()
            );
            let ship = target.ship().expect("a ship");
            assert_eq!(ship.speed_spread, 0.5);
            assert!((ship.course_spread - 5.0_f64.to_radians()).abs() < 1e-15);
        }
    }
}

/// Tests that every target of DNV's files is on a collision course: its nominal motion passes
/// within 30 m of own ship.
#[test]
fn every_target_of_dnv_meets_own_ship() {
    let files = dnv_files();
    assert_eq!(files.len(), 28);
    let mut targets = 0;
    for file in files {
        let situation = benchmark(&file).remove(0);
        let scenario = imported(&situation).scenario;
        assert_eq!(scenario.targets.len(), situation.others());
        assert_eq!(situation.name().split(", ").count(), situation.others());
        let own = &scenario.own_ship;
        assert_eq!((own.hull.length, own.hull.beam), (122.0, 20.0));
        assert!((own.speed - 10.0 * 1852.0 / 3600.0).abs() < 1e-12);
        for target in &scenario.targets {
            targets += 1;
            let least = (0..1800)
                .map(|t| {
                    let t = f64::from(t);
                    (target.position_at(t) - scenario.desired.position_at(t)).norm()
                })
                .fold(f64::INFINITY, f64::min);
            assert!(least < 35.0, "{file}: {}: {least}", target.name);
        }
    }
    assert_eq!(targets, 71);
}

#[test]
fn what_is_imported_reads_as_what_is_run() {
    let mut assumed = Assumed::default().with(Assumption::SafetyMargin, 500.0);
    for situation in benchmark("imazu/imazu.json") {
        let imported = situation.scenario(&assumed).expect("no faults");
        assert_eq!(
            Scenario::parse(&imported.text).expect("no faults"),
            imported.scenario
        );
        assert_eq!(imported.scenario.own_ship.safety_margin, 500.0);
    }
    assumed = assumed.with(Assumption::CourseSpread, 0.0);
    for file in dnv_files() {
        let imported = benchmark(&file)[0].scenario(&assumed).expect("no faults");
        assert_eq!(
            Scenario::parse(&imported.text).expect("no faults"),
            imported.scenario
        );
        let ship = imported.scenario.targets[0].ship().expect("a ship");
        assert_eq!(ship.course_spread, 0.0);
    }
}

#[test]
fn an_assumption_out_of_range_changes_nothing() {
    let usual = Assumed::default();
    for (what, value) in [
        (Assumption::SpeedSpread, -0.1),
        (Assumption::CourseSpread, 181.0),
        (Assumption::SafetyMargin, f64::NAN),
        (Assumption::Length, 0.0),
        (Assumption::Beam, f64::INFINITY),
    ] {
        assert!(!what.allows(value));
        assert_eq!(usual.clone().with(what, value), usual);
    }
}

fn dnv_01() -> Value {
    serde_json::from_str(include_str!(
        "../../scenarios/dnv/traffic_situation_01.json"
    ))
    .expect("JSON")
}

/// Returns the document with one value replaced or removed.
fn with(pointer: &str, value: Option<Value>) -> String {
    let mut document = dnv_01();
    let (parent, key) = pointer.rsplit_once('/').expect("a path");
    let parent = document.pointer_mut(parent).expect("there");
    match (parent, value) {
        (Value::Object(map), Some(value)) => {
            map.insert(key.to_owned(), value);
        }
        (Value::Object(map), None) => {
            map.remove(key).expect("there");
        }
        (Value::Array(list), value) => {
            let index: usize = key.parse().expect("an index");
            match value {
                Some(value) => list[index] = value,
                None => {
                    list.remove(index);
                }
            }
        }
        _ => panic!("{pointer}"),
    }
    document.to_string()
}

#[test]
fn one_mistake_in_a_dnv_file_is_one_fault_with_its_place() {
    let target = "/targetShips/0";
    for (pointer, value, path) in [
        ("/ownShip", None, "ownShip"),
        ("/ownShip", Some(json!([])), "ownShip"),
        ("/ownShip/waypoints", None, "ownShip.waypoints"),
        ("/ownShip/waypoints/1", None, "ownShip.waypoints"),
        (
            "/ownShip/waypoints/0/position/lat",
            Some(json!(4_000_000)),
            "ownShip.waypoints[0].position.lat",
        ),
        (
            "/ownShip/waypoints/1/position/lat",
            Some(json!(10.0)),
            "ownShip.waypoints[1].position",
        ),
        (
            "/ownShip/waypoints/1/leg/sog",
            Some(json!("ten")),
            "ownShip.waypoints[1].leg.sog",
        ),
        (
            "/ownShip/waypoints/1/leg/sog",
            Some(json!(514.4)),
            "ownShip.waypoints[1].leg.sog",
        ),
        (
            "/ownShip/waypoints/1/leg/sog",
            Some(json!(0)),
            "ownShip.waypoints[1].leg.sog",
        ),
        ("/ownShip/waypoints/1/leg", None, "ownShip.waypoints[1]"),
        (
            "/ownShip/initial/heading",
            Some(json!(361)),
            "ownShip.initial.heading",
        ),
        (
            "/ownShip/initial/navStatus",
            Some(json!("Adrift")),
            "ownShip.initial.navStatus",
        ),
        (
            "/ownShip/initial/navStatus",
            Some(json!(16)),
            "ownShip.initial.navStatus",
        ),
        (
            "/ownShip/static/shipType",
            Some(json!("Kayak")),
            "ownShip.static.shipType",
        ),
        (
            "/ownShip/static/pathType",
            Some(json!("bezier")),
            "ownShip.static.pathType",
        ),
        ("/ownShip/static/initDelay", Some(json!(10)), "ownShip"),
        (
            "/ownShip/static/dimensions",
            None,
            "ownShip.static.dimensions",
        ),
        (
            "/ownShip/static/dimensions/width",
            Some(json!(null)),
            "ownShip.static.dimensions",
        ),
        (
            "/ownShip/static/dimensions/length",
            Some(json!(400)),
            "ownShip.static.dimensions",
        ),
        (
            "/ownShip/static/dimensions/a",
            Some(json!(-1)),
            "ownShip.static.dimensions.a",
        ),
        ("/targetShips", Some(json!({})), "targetShips"),
        (
            "/targetShips/0/waypoints",
            Some(json!([])),
            "targetShips[0].waypoints",
        ),
        (
            "/targetShips/0/static/dimensions",
            None,
            "targetShips[0].static.dimensions",
        ),
        (
            "/targetShips/0/waypoints/0/position/lon",
            Some(json!("10")),
            "targetShips[0].waypoints[0].position.lon",
        ),
        ("/title", Some(json!("two\nlines")), "title"),
    ] {
        let mut text = with(pointer, value);
        if path.ends_with("dimensions") && pointer.ends_with("width") {
            // neither the whole document nor its parts
            let mut document: Value = serde_json::from_str(&text).expect("JSON");
            let dimensions = document
                .pointer_mut("/ownShip/static/dimensions")
                .expect("there");
            *dimensions = json!({ "length": 122.0 });
            text = document.to_string();
            assert_eq!(
                paths(&text, &Assumed::default()),
                ["ownShip.static.dimensions.width"]
            );
            continue;
        }
        assert_eq!(paths(&text, &Assumed::default()), [path], "{pointer}");
    }
    // a ship without dimensions has the size given by the user
    let sized = Assumed::default()
        .with(Assumption::Length, 80.0)
        .with(Assumption::Beam, 14.0);
    let text = with(&format!("{target}/static/dimensions"), None);
    assert_eq!(paths(&text, &sized), Vec::<String>::new());
    let scenario = situations(Contents::parse(&text, &sized).expect("good"))[0]
        .scenario(&sized)
        .expect("no faults");
    assert_eq!(
        scenario.scenario.targets[0]
            .ship()
            .expect("a ship")
            .hull
            .length,
        80.0
    );
    assert!(
        scenario.notes.iter().any(|n| n.contains("80 × 14 m")),
        "{:?}",
        scenario.notes
    );
}

#[test]
fn every_fault_of_a_file_is_named_at_once() {
    let mut document = dnv_01();
    *document
        .pointer_mut("/ownShip/initial/navStatus")
        .expect("there") = json!("Adrift");
    *document
        .pointer_mut("/ownShip/waypoints/1/leg/sog")
        .expect("there") = json!(-1);
    *document
        .pointer_mut("/targetShips/0/initial/heading")
        .expect("there") = json!(true);
    assert_eq!(
        paths(&document.to_string(), &Assumed::default()),
        [
            "ownShip.initial.navStatus",
            "ownShip.waypoints[1].leg.sog",
            "targetShips[0].initial.heading",
        ]
    );
}

#[test]
fn a_broken_case_of_imazu_costs_itself_alone() {
    let text = include_str!("../../scenarios/imazu/imazu.json");
    let broken = text.replacen("\"course_deg\": 270.0", "\"course_deg\": \"west\"", 1);
    let Ok(Contents::Situations { format, situations }) =
        Contents::parse(&broken, &Assumed::default())
    else {
        panic!("situations");
    };
    assert_eq!(format, Format::Imazu);
    assert_eq!(situations.len(), 22);
    let bad: Vec<_> = situations.iter().filter_map(|s| s.as_ref().err()).collect();
    assert_eq!(bad.len(), 1);
    assert_eq!(bad[0][0].path, "cases[1].targets[0].course_deg");
    let own = text.replacen("\"goal_north_m\": 22224.0", "\"goal_north_m\": 1e99", 1);
    assert_eq!(paths(&own, &Assumed::default()), ["own_ship.goal_north_m"]);
}

#[test]
fn keys_that_are_there_twice_and_json_that_is_none_are_refused() {
    let text = include_str!("../../scenarios/dnv/traffic_situation_01.json");
    let twice = text.replacen(
        "\"title\": \"HO\",",
        "\"title\": \"HO\", \"title\": \"OT\",",
        1,
    );
    for text in [
        twice.as_str(),
        &text[..text.len() / 2],
        "{}",
        "{\"a\": 1}",
        &"{\"a\":".repeat(10_000),
    ] {
        assert_eq!(paths(text, &Assumed::default()), [""], "{text:.60}");
    }
    for text in [
        "{\"format\": \"searoom-plan/1\"}",
        "{\"type\": \"FeatureCollection\"}",
    ] {
        assert!(matches!(
            Contents::parse(text, &Assumed::default()),
            Ok(Contents::Other(_))
        ));
    }
    for text in ["", "title = 'x'", "[own_ship]"] {
        assert!(matches!(
            Contents::parse(text, &Assumed::default()),
            Ok(Contents::Scenario)
        ));
    }
}

/// Tests every prefix, and every number replaced by a hostile one: no file content may cause a
/// panic.
#[test]
fn hostile_text_never_panics() {
    let try_all = |text: &str| {
        let _ = paths_or_good(text);
    };
    let text = dnv_01().to_string();
    for end in (0..text.len()).filter(|end| text.is_char_boundary(*end)) {
        try_all(&text[..end]);
    }
    for hostile in [
        "1e308", "-1e308", "5e-324", "-0.0", "[]", "{}", "\"\"", "true", "null", "180", "90",
    ] {
        for (at, _) in text.match_indices(char::is_numeric) {
            try_all(&format!("{}{hostile}{}", &text[..at], &text[at + 1..]));
        }
    }
}

fn paths_or_good(text: &str) -> usize {
    match Contents::parse(text, &Assumed::default()) {
        Ok(Contents::Situations { situations, .. }) => situations
            .into_iter()
            .filter(|s| {
                s.as_ref()
                    .is_ok_and(|s| s.scenario(&Assumed::default()).is_ok())
            })
            .count(),
        _ => 0,
    }
}

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
            delay: if rng.random_bool(0.3) {
                rng.random_range(1.0..600.0)
            } else {
                0.0
            },
            points,
        }
    }

    /// Converts to a DNV file; the inverse projection gives degrees.
    fn document(&self) -> String {
        let mut document = dnv_01();
        let origin = searoom::frame::Geographic {
            lat_deg: 58.763449,
            lon_deg: 10.490654,
        };
        let earth = searoom::frame::Georeference::new(origin).expect("on earth");
        let waypoints: Vec<Value> = self
            .points
            .iter()
            .enumerate()
            .map(|(index, point)| {
                let place = earth.to_geographic(*point);
                let mut waypoint =
                    json!({ "position": { "lat": place.lat_deg, "lon": place.lon_deg } });
                if let Some(radius) =
                    self.radii[index].filter(|_| index > 0 && index < self.knots.len())
                {
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

/// Offset in seconds of the sampled instants within a step, to exclude rounding.
const INSIDE: f64 = 1e-4;

/// Tests targets that follow their routes within the spread: fast and slow, with deviations to
/// either side, on sharp corners and on arcs. At every instant their velocity and position are in
/// the declared set, with the clearance that hulls and margin require.
#[test]
fn a_target_that_follows_her_route_is_in_her_set_at_all_times() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let (speed_spread, course_spread) = (0.5, 5.0_f64.to_radians());
    let (mut deepest, mut followed) = (f64::NEG_INFINITY, 0);
    for _ in 0..60 {
        let declared = Declared::random(&mut rng);
        let situation =
            match Contents::parse(&declared.document(), &Assumed::default()).expect("JSON") {
                Contents::Situations { mut situations, .. } => match situations.remove(0) {
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
        let target = &scenario.targets[0];
        let sets = &target.sets().expect("sets").velocities;
        assert!(sets.len() > 1 && sets.len() <= 50, "{}", sets.len());
        assert_eq!(
            notes.iter().any(|n| n.contains("appears after")),
            declared.delay > 0.0
        );
        let own = &scenario.own_ship;
        let hull = |length: f64, beam: f64| 0.5 * length.hypot(beam);
        let clearance = hull(50.0, 10.0) + hull(own.hull.length, own.hull.beam) + own.safety_margin;
        // checking the position is expensive for many sets
        let many = declared.knots.len() > 6;
        let (runs, every) = if many { (6, 40) } else { (20, 1) };
        let mut steps = 0;
        for run in 0..runs {
            // constant extremes first, then arbitrary values
            let extreme = [
                (1.0, 0.0),
                (-1.0, 0.0),
                (1.0, 1.0),
                (-1.0, -1.0),
                (-1.0, 1.0),
            ]
            .get(run)
            .copied();
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
    assert!(followed > 500, "{followed}");
    // the sets are not so large that the test cannot fail
    assert!(deepest > -400.0, "{deepest}");
}

/// Clearance deficit in metres: by how much a target at a position is too near to the edge of its
/// set.
fn check(target: &Target, at: Vector, time: f64, clearance: f64) -> f64 {
    let set = target.outer_set_at(time).expect("explicit sets");
    set.signed_distance(at) + clearance
}

#[test]
fn a_route_on_one_line_is_a_tracked_ship() {
    let mut document = dnv_01();
    let ship = document.pointer_mut("/targetShips/0").expect("there");
    let middle =
        json!({ "position": { "lat": 58.80500723, "lon": 10.4906874 }, "leg": { "sog": 12.1 } });
    ship["waypoints"]
        .as_array_mut()
        .expect("a list")
        .insert(1, middle);
    let scenario =
        situations(Contents::parse(&document.to_string(), &Assumed::default()).expect("good"))[0]
            .scenario(&Assumed::default())
            .expect("no faults")
            .scenario;
    let ship = scenario.targets[0].ship().expect("a ship");
    // widened by the deviation of the middle point
    assert!(
        ship.course_spread >= 5.0_f64.to_radians() && ship.course_spread < 6.0_f64.to_radians()
    );
}

/// Tests the encounters with half a metre per second and five degrees of uncertainty for every
/// target. Imazu's have 500 m between hulls of 100 × 20 m. Every encounter has a verified plan, no
/// target is left out, and no set is entered, even at a risk.
#[test]
fn every_encounter_has_a_plan_clear_of_all_it_declares() {
    let mut planned = 0;
    let imazu = Assumed::default().with(Assumption::SafetyMargin, 500.0);
    let mut scenes: Vec<(Situation, Assumed)> = benchmark("imazu/imazu.json")
        .into_iter()
        .take(22)
        .map(|case| (case, imazu.clone()))
        .collect();
    for file in dnv_files() {
        scenes.extend(
            benchmark(&file)
                .into_iter()
                .map(|s| (s, Assumed::default())),
        );
    }
    for (situation, assumed) in scenes {
        let mut scenario = situation.scenario(&assumed).expect("no faults").scenario;
        // outcomes must not depend on the clock
        scenario.deadline = 60.0;
        let run = pipeline::run(scenario);
        let name = situation.name();
        let plan = run.planned.outcome.plan().expect("a plan");
        assert_eq!(run.sets.len(), situation.others(), "{name}");
        assert_eq!(run.max_risk, 0.0, "{name}");
        assert!(run.released.iter().all(Option::is_none), "{name}");
        assert!(
            run.evaluation.as_ref().is_some_and(|e| e.verified()),
            "{name}"
        );
        for sets in &run.sets {
            for segment in plan.trajectory.segments() {
                assert_eq!(sets.hard.first_contact(segment, 1e-6), None, "{name}");
            }
        }
        planned += 1;
    }
    assert_eq!(planned, 50);
}

/// Tests each relaxation level by a result that only this level gives; another level, or none,
/// would also give a plan.
#[test]
fn every_relaxation_level_answers_some_encounter() {
    let answer = |mut scenario: Scenario, compliance| {
        scenario.compliance = compliance;
        scenario.deadline = 60.0;
        let run = pipeline::run(scenario);
        assert!(run.evaluation.as_ref().is_some_and(|e| e.verified()));
        run
    };
    let dnv = |number: &str| {
        let file = format!("dnv/traffic_situation_{number}.json");
        let situation = benchmark(&file).remove(0);
        let assumed = Assumed::default();
        situation.scenario(&assumed).expect("no faults").scenario
    };
    // head-on, and a ship that is overtaken or gives way
    let by_the_rules = answer(dnv("09"), Compliance::Rules);
    assert_eq!(by_the_rules.level, RelaxationLevel::Rules);
    let clear_of_shapes = answer(dnv("07"), Compliance::Rules);
    assert_eq!(clear_of_shapes.level, RelaxationLevel::Domains);
    let imazu = Assumed::default().with(Assumption::SafetyMargin, 500.0);
    let case = benchmark("imazu/imazu.json").remove(16);
    let case = case.scenario(&imazu).expect("no faults").scenario;
    let searched = |run: &Run| run.planned.stats.expanded > 0;
    let clear_of_hard_sets = answer(case, Compliance::Shape);
    assert!(
        clear_of_hard_sets.level == RelaxationLevel::ReducedDomains
            && searched(&clear_of_hard_sets)
    );
    // wide detours are not plans of the graph
    let around = answer(dnv("53"), Compliance::Shape);
    assert!(around.level == RelaxationLevel::ReducedDomains && !searched(&around));
    let crowd = random_traffic(10, 201, Placement::Origin).expect("drawn");
    let half = answer(crowd.scenario, Compliance::Shape);
    assert!(half.level == RelaxationLevel::ReducedDomains && half.max_risk == 0.0);
}
