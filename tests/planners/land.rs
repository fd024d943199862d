//! Tests of land from the scenario file: positions in degrees, maps, and objects that must not be
//! on land.

use std::path::Path;

use searoom::frame::{Geographic, Georeference, Vector};
use searoom::pipeline;
use searoom::planner::DEFAULT_PLANNER;
use searoom::planner::path_time::PathTimePlanner;
use searoom::scenario::{Compliance, Scenario, ScenarioError};

use crate::campaigns::documents::{scenario, unhurried};

/// Scenario south-west of Munkholmen, in the middle of the fjord, in metres and on the map.
const SCENARIO: &str = r#"
title = "past Munkholmen"
horizon_s = 600
origin = { lat_deg = 63.44, lon_deg = 10.399 }
map = "harbour.geojson"

[own_ship]
position = { lat_deg = 63.4470, lon_deg = 10.3700 }
course_deg = 90
speed_mps = 5
length_m = 30
beam_m = 8
turning_radius_m = 80
land_margin_m = 10

[mission]
waypoints = [
    { lat_deg = 63.4470, lon_deg = 10.3700 },
    { east_m = 0, north_m = 780 },
    { lat_deg = 63.4530, lon_deg = 10.4050 },
]

[[targets]]
name = "boat"
position = { lat_deg = 63.4480, lon_deg = 10.4100 }
course_deg = 250
speed_kn = 8
length_m = 12
beam_m = 4
"#;

fn maps() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("maps")
}

/// Folder with the scenario and the harbour.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let map = maps().join("trondheim-harbour.geojson");
    std::fs::copy(map, folder.path().join("harbour.geojson")).expect("a copy");
    folder
}

fn read(folder: &Path, text: &str) -> Result<Scenario, ScenarioError> {
    let file = folder.join("scenario.toml");
    std::fs::write(&file, text).expect("written");
    Scenario::read(&file).map(unhurried)
}

/// Formats every fault as `path: found; allowed`.
fn faults(folder: &Path, text: &str) -> Vec<String> {
    match read(folder, text) {
        Err(ScenarioError::Faults { faults, .. }) => faults.iter().map(|f| f.to_string()).collect(),
        other => panic!("{other:?}"),
    }
}

fn assert_one_fault(folder: &Path, text: &str, expected: &str) {
    let found = faults(folder, text);
    assert!(found.len() == 1 && found[0].contains(expected), "{found:?}");
}

#[test]
fn degrees_and_metres_are_one_plane_and_the_map_lies_on_it() {
    let folder = folder();
    let scenario = read(folder.path(), SCENARIO).expect("valid");
    let origin = Geographic::new(63.44, 10.399);
    let earth = Georeference::new(origin).expect("valid");
    assert_eq!(scenario.earth, Some(earth));
    let at = |lat_deg, lon_deg| earth.to_plane(Geographic { lat_deg, lon_deg });
    assert_eq!(scenario.own_ship.pose.position, at(63.4470, 10.3700));
    let waypoints = scenario.desired.waypoints();
    assert!((waypoints[1] - Vector::new(0.0, 780.0)).norm() < 1e-9);
    assert!((waypoints[2] - at(63.4530, 10.4050)).norm() < 1e-9);
    let boat = scenario.targets[0].position_at(0.0);
    assert!((boat - at(63.4480, 10.4100)).norm() < 1e-9);
    let land = scenario.land.expect("land");
    assert_eq!((land.margin, land.map.polygons().len()), (10.0, 27));
    assert!(land.map.contains(at(63.4512, 10.3833)), "Munkholmen");
    // without a map there is no land, and positions in degrees are also valid
    let bare = read(folder.path(), &SCENARIO.replace("map =", "# map ="));
    assert!(bare.expect("valid").land.is_none());
}

/// A text of the scenario, what replaces it, and the fault.
const MISTAKES: &str = "
63.44, | 89.5, | origin.lat_deg: found 89.5
10.399 } | 190 } | origin.lon_deg: found 190
east_m = 0, | lat_deg = 63.45, east_m = 0, | mission.waypoints[1]: found east_m or north_m beside lat_deg or lon_deg; allowed: one of the two pairs
63.4530, | 60.39, | mission.waypoints[2]: found lat 60.390000°, lon 10.405000°, 340 km from the origin; allowed: a place within 100 km
{ lat_deg = 63.4480, lon | { lat = 63.4480, lon | targets[0].position.lat: found an unknown key, perhaps for 'lat_deg'; allowed: one of
";

#[test]
fn what_needs_an_origin_asks_for_it_once() {
    let folder = folder();
    let without = SCENARIO.replace("origin = {", "# origin = {");
    let table = "origin: found nothing; allowed: a table { lat_deg, lon_deg }";
    assert_one_fault(folder.path(), &without, table);
    for line in MISTAKES.lines().filter(|line| !line.is_empty()) {
        let cells: Vec<&str> = line.split(" | ").collect();
        let [from, to, expected] = cells[..] else {
            panic!("{line}");
        };
        assert!(SCENARIO.contains(from), "{from}");
        assert_one_fault(folder.path(), &SCENARIO.replacen(from, to, 1), expected);
    }
}

#[test]
fn a_bad_map_is_named_with_its_file_its_feature_and_what_is_allowed() {
    let folder = folder();
    let map = std::fs::read_to_string(maps().join("trondheim-harbour.geojson")).expect("a map");
    let write =
        |text: &str| std::fs::write(folder.path().join("bad.geojson"), text).expect("written");
    let text = SCENARIO.replace("harbour.geojson", "bad.geojson");
    let missing = faults(folder.path(), &text);
    assert!(missing[0].contains("map: found "), "{missing:?}");
    assert!(missing[0].contains("bad.geojson, which cannot be read"));
    write(&map.replacen(r#""type":"Polygon""#, r#""type":"MultiLineString""#, 1));
    let read = Scenario::parse_beside(&text, folder.path()).expect("a map without one polygon");
    let caution = &read.remarks.cautions[0];
    assert!(caution.contains("of the map: skipped"), "{caution}");
    write(r#"{"type":"FeatureCollection","features":[]}"#);
    let none = "bad.geojson: no polygon; allowed: at least one feature that is a Polygon";
    assert_one_fault(folder.path(), &text, none);
    write(r#"{"type":"Point","coordinates":[10.4,63.44]}"#);
    let points = "bad.geojson: points and lines but no polygon; allowed: at least one feature that \
                  is a Polygon or a MultiPolygon; points and lines where the map has a \
                  point_radius_m, as map = { file = …, point_radius_m = … } in the scenario";
    assert_one_fault(folder.path(), &text, points);
    // the origin in another town: every feature is far
    let oslo = SCENARIO
        .replace("63.44,", "59.91,")
        .replace("10.399", "10.75");
    let found = faults(folder.path(), &oslo);
    let is_far = |f: &String| f.contains("features[0]") && f.contains("km from the origin");
    assert!(found.iter().any(is_far));
    assert!(found[0].contains("and so in 26 more polygons"), "{found:?}");
    // positions are also far: all faults at once
    let mut faults = found.iter();
    assert!(faults.any(|f| f.contains("own_ship.position")), "{found:?}");
}

/// Tests a hull that is clear on both legs, but whose bow would sweep to within a metre of an islet
/// during the turn between them.
#[test]
fn a_turn_on_the_spot_beside_an_islet_is_refused_and_judged() {
    let folder = folder();
    let origin = Geographic::new(63.44, 10.399);
    let earth = Georeference::new(origin).expect("valid");
    let ring = [(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)].map(|(x, y)| {
        let place = Vector::new(212.5 + f64::from(x), 12.5 + f64::from(y));
        let place = earth.to_geographic(place);
        format!("[{:.9}, {:.9}]", place.lon_deg, place.lat_deg)
    });
    let ring = ring.join(", ");
    let islet = format!(r#"{{ "type": "Polygon", "coordinates": [[{ring}]] }}"#);
    std::fs::write(folder.path().join("islet.geojson"), islet).expect("written");
    let text = |kind: &str, turn: &str| {
        format!(
            r#"
title = "round the corner"
horizon_s = 600
origin = {{ lat_deg = 63.44, lon_deg = 10.399 }}
map = "islet.geojson"
planner = {{ kind = "{kind}", objective = "space-time-error" }}
own_ship = {{ position = {{ east_m = 0, north_m = 0 }}, course_deg = 90, speed_mps = 5, length_m = 30, beam_m = 8, turning_radius_m = 40, land_margin_m = 2 }}
mission = {{ waypoints = [{{ east_m = 0, north_m = 0 }}, {{ east_m = 200, north_m = 0 }}, {turn}] }}
"#
        )
    };
    let north = "{ east_m = 200, north_m = 300 }";
    let expected = "mission.waypoints[1]: found a turn on the spot that takes own hull to 0.7 m from land; allowed: at least 2 m";
    assert_one_fault(folder.path(), &text("path-time", north), expected);
    // on the other side the bow sweeps over water, and so does the stern
    let south = "{ east_m = 200, north_m = -300 }";
    read(folder.path(), &text("path-time", south)).expect("valid");
    // back along the same leg: half a turn to either side
    let back = "{ east_m = 100, north_m = 0 }";
    let found = faults(folder.path(), &text("path-time", back));
    let expected = "waypoints[1]: found a turn on the spot";
    assert!(found[0].contains(expected), "{found:?}");
    // the space-time planner turns on an arc around the corner
    let mut scenario = read(folder.path(), &text("space-time", north)).expect("valid");
    // for a planner without this check, the independent checker finds it
    scenario.planner = &PathTimePlanner;
    let judged = pipeline::run(scenario).evaluation.expect("judged");
    let [wrong] = &judged.violations[..] else {
        panic!("{:?}", judged.violations);
    };
    let swept = wrong.what.contains("land: own hull at 7.39");
    assert!(swept && (wrong.time - 40.0).abs() < 1e-6, "{wrong:?}");
}

#[test]
fn a_start_and_a_path_on_land_are_named_together() {
    let folder = folder();
    // the middle waypoint moved behind Munkholmen, the start onto the quay
    let behind = "{ lat_deg = 63.4520, lon_deg = 10.3900 }";
    let quay = "position = { lat_deg = 63.4305, lon_deg = 10.395 }";
    let text = SCENARIO
        .replace("{ east_m = 0, north_m = 780 }", behind)
        .replace("position = { lat_deg = 63.4470, lon_deg = 10.3700 }", quay);
    let found = faults(folder.path(), &text);
    assert_eq!(found.len(), 2, "{found:?}");
    for (fault, part) in [
        (0, "own_ship.position: found own hull on land, "),
        (0, "at least 10 m of water around own hull"),
        (
            1,
            "mission.waypoints[1]: found leg 1, which crosses land from ",
        ),
        (1, "m are missing at east "),
        (1, "(lat 63.45"),
        (1, "at least 14.0 m from the leg to land"),
    ] {
        assert!(found[fault].contains(part), "{part}: {found:?}");
    }
    // near land, not on it
    let near = SCENARIO.replace("land_margin_m = 10", "land_margin_m = 500");
    let found = faults(folder.path(), &near);
    let near = |f: &String| f.contains("comes too near to land");
    assert!(found.iter().all(near), "{found:?}");
}

/// Tests a canal whose bends are tighter than own ship's turning radius: no motion along its path
/// is clear of land.
#[test]
fn a_path_that_cannot_be_sailed_clear_of_land_has_no_plan_rather_than_one_ashore() {
    let along = scenario("harbour/canal-transit.toml");
    for compliance in [Compliance::None, Compliance::Shape, Compliance::Rules] {
        let run = pipeline::run(Scenario {
            planner: DEFAULT_PLANNER,
            compliance,
            ..along.clone()
        });
        assert!(run.evaluation.is_none_or(|e| e.verified()));
        assert!(run.planned.outcome.plan().is_none());
    }
}
