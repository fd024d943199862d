//! Input of others that no plan uses: it is named in notes, and beside the verdict where it bears on
//! safety.

use std::fs;

use super::program::{Folder, document, json, list, number, rows, run, searoom, stderr, stdout};
use serde_json::Value;

const KNOT: f64 = 1852.0 / 3600.0;

/// A file of `tests/faults`, what its verdict says that it ignores, and a part of its notes.
const CAUTIONS: &str = "
corridor.toml | cross-track limits | not kept, of 1 leg; the least are 93 m to port and 37 m
isle-point.toml | 1 point of the map | skipped, as if it were water there
pier-line.toml | 1 line of the map | point_radius_m
dnv-not-under-command-from-port.json | Rule 18 | not applied to 'nuc', not under command by its status
speed-limit.toml | speedMax | not kept: the plan makes 11.7 kn where a leg of the route allows 7.0 kn
dnv-wide-turns.json | rules for 'target_ship_1' | not applied: explicit sets, which have no role
commonocean-max-lateral-deviation.xml | maxLateralDeviation | allows 50 m to the side
";

#[test]
fn ignored_input_on_safety_is_beside_the_verdict() {
    for [file, subject, note] in rows(CAUTIONS) {
        let assert = run(&format!("plan tests/faults/{file}"));
        let said = stdout(&assert);
        let verdict = said.lines().next().expect("a verdict").to_owned();
        assert!(verdict.contains(&format!("ignores {subject}")), "{verdict}");
        assert!(said.contains(&note), "{file}: {said}");
        let plan = json(&format!("plan tests/faults/{file} --json"));
        let cautions = list(&plan["cautions"]);
        assert_eq!(cautions.len(), 1, "{cautions:?}");
        let caution = cautions[0].as_str().expect("a text");
        assert!(
            caution.starts_with(&subject) && caution.contains(&note),
            "{caution}"
        );
        let checked = stderr(&run(&format!("check tests/faults/{file}")).success());
        assert!(checked.replace("\n", " ").contains(&subject), "{checked}");
    }
}

/// A caution remains with a scenario that is written by `import`.
#[test]
fn a_caution_remains_with_an_imported_scenario() {
    let folder = Folder::new();
    let file = "tests/faults/dnv-not-under-command-from-port.json";
    run(&format!("import {file} --out {folder}")).success();
    let again = folder.at("dnv-not-under-command-from-port.toml");
    let [plan, again] = [file, &again].map(|file| json(&format!("plan {file} --json")));
    assert_eq!(plan["cautions"], again["cautions"]);
    assert_eq!(plan["trajectory"], again["trajectory"]);
    // a usual status is no remark
    let text = fs::read_to_string(file).expect("there");
    let usual = text.replace("Not under command", "Under way using engine");
    let usual = folder.write("usual.json", usual);
    assert!(json(&format!("plan {usual} --json"))["cautions"].is_null());
}

/// A plan within the limit says nothing, and a leg without one has none.
#[test]
fn a_plan_within_the_speed_limits_of_its_route_is_not_cautioned() {
    let folder = Folder::new();
    let text = fs::read_to_string("tests/faults/speed-limit.toml").expect("there");
    let route = fs::read_to_string("tests/faults/speed-limit.rtz").expect("there");
    let (alone, _) = text.split_once("[[targets]]").expect("targets");
    let off = text.replace("lat_deg = 60.035", "lat_deg = 60.045");
    let off = off.replace(
        "lon_deg = 10.0 }\ncourse_deg = 180.0",
        "lon_deg = 10.2 }\ncourse_deg = 180.0",
    );
    for (scenario, limit, is_cautioned) in [
        (alone, "7", false),
        (&*off, "7", false),
        (&*text, "7", true),
        (&*text, "11", true),
        (&*text, "12", false),
    ] {
        let of_leg = format!("speedMax=\"{limit}\"");
        folder.write("speed-limit.rtz", route.replace("speedMax=\"7\"", &of_leg));
        let file = folder.write("a.toml", scenario);
        let plan = json(&format!("plan {file} --json"));
        assert_eq!(
            !plan["cautions"].is_null(),
            is_cautioned,
            "{limit}: {}",
            plan["cautions"]
        );
    }
}

/// A part of a route that is within reach is as long as to leave time to give way, wherever the route
/// leaves the reach.
#[test]
fn a_route_that_begins_beyond_reach_is_cut_to_half_of_the_horizon() {
    let plan = json("plan tests/faults/far-start.toml --json");
    assert_eq!(plan["outcome"], "solved");
    let note = "route: the mission is its next 7.5 km, which take no more than half of horizon_s";
    assert!(notes(&plan).contains(note), "{}", notes(&plan));
    let ends = number(&plan["cost"]["duration_s"]);
    assert!((ends - 1500.0).abs() < 0.1, "{ends}");
}

fn leg_knots(plan: &Value) -> Vec<f64> {
    let legs = list(&plan["mission"]["leg_speeds_mps"]).iter();
    legs.map(|speed| number(speed) / KNOT).collect()
}

fn own_speeds(plan: &Value) -> Vec<f64> {
    list(&plan["own_ship"]["speeds_mps"])
        .iter()
        .map(number)
        .collect()
}

fn notes(plan: &Value) -> String {
    let notes = plan["notes"].as_array().into_iter().flatten();
    notes
        .filter_map(Value::as_str)
        .collect::<Vec<_>>()
        .join("\n")
}

/// A route file, the knots of its legs, the greatest number of segments of its plan, and a note.
const ROUTES: &str = "
leg-speed | 9.719 6 | 5 | radii of turns: not used, up to 556 m
ten-knots | 9.719 | 2 | speedMax: limits the mission alone, on a leg to 10.0 kn
timetable-only | 6.0167 | 2 |
no-zone | 6 | 2 | times without a zone: not used, no offset from UTC: etd \"2026-05-01T06:00:00\"
two-speeds | 7 | 2 | manual schedule: speed of waypoint \"2\" not used, of which the calculated schedule says otherwise
two-schedules | 12 | 5 | schedule \"fast\": the first of 2 is used; `schedule` in [mission] names another
";

#[test]
fn speeds_of_a_route_are_sailed_and_the_rest_is_noted() {
    for [name, knots, segments, note] in rows(ROUTES) {
        let plan = json(&format!("plan tests/faults/{name}.toml --json"));
        let legs = leg_knots(&plan);
        let wanted: Vec<f64> = knots
            .split(' ')
            .map(|k| k.parse().expect("a number"))
            .collect();
        assert_eq!(legs.len(), wanted.len(), "{name}: {legs:?}");
        for (found, wanted) in legs.iter().zip(&wanted) {
            assert!((found - wanted).abs() < 2e-3, "{name}: {legs:?}");
        }
        assert!(notes(&plan).contains(&note), "{name}: {}", notes(&plan));
        let sailed = list(&plan["trajectory"]["segments"]).len();
        assert!(
            sailed <= segments.parse::<usize>().expect("a number"),
            "{name}: {sailed} segments"
        );
        // each speed within the largest is one of own ship's
        let own = own_speeds(&plan);
        for speed in wanted
            .iter()
            .map(|knots| knots * KNOT)
            .filter(|speed| *speed <= 6.0)
        {
            assert!(
                own.iter().any(|own| (own - speed).abs() < 2e-3),
                "{name}: {own:?}"
            );
        }
        assert_eq!(own.iter().copied().fold(0.0, f64::max), 6.0);
    }
    // the mission of a time-table takes the time that it says
    let plan = json("plan tests/faults/timetable-only.toml --json");
    let duration = number(&plan["cost"]["duration_s"]);
    assert!((duration - 1800.0).abs() < 0.1, "{duration}");
    let plan = json("plan tests/faults/two-schedules.toml --json");
    assert!(notes(&plan).contains("speeds of 1 leg: up to 12.0 kn, and own ship falls behind"));
}

#[test]
fn a_schedule_and_a_waypoint_may_be_chosen() {
    let folder = Folder::new();
    let with = |file: &str, keys: &str| {
        for ending in ["toml", "rtz"] {
            let text = fs::read_to_string(format!("tests/faults/{file}.{ending}")).expect("there");
            folder.write(&format!("{file}.{ending}"), text.replace("[mission]", keys));
        }
        folder.at(&format!("{file}.toml"))
    };
    for named in ["slow", "2"] {
        let file = with(
            "two-schedules",
            &format!("[mission]\nschedule = \"{named}\""),
        );
        let plan = json(&format!("plan {file} --json"));
        assert!((leg_knots(&plan)[0] - 6.0).abs() < 1e-6);
        assert!(plan["notes"].is_null(), "{}", plan["notes"]);
    }
    let file = with("two-schedules", "[mission]\nschedule = \"none\"");
    let said = stderr(&searoom(&["check", &file]).code(2));
    assert!(
        said.contains("no schedule \"none\"") && said.contains("\"fast\", \"slow\""),
        "{said}"
    );
    let file = with("leg-speed", "[mission]\nfrom_waypoint = 2");
    let plan = document(&run(&format!("plan {file} --json")));
    assert!((leg_knots(&plan)[0] - 6.0).abs() < 1e-6 && leg_knots(&plan).len() == 1);
    assert!(notes(&plan).contains("begins at waypoint 2 and ends at waypoint 3"));
    let file = with("leg-speed", "[mission]\nfrom_waypoint = 3");
    let said = stderr(&searoom(&["check", &file]).code(2));
    assert!(
        said.contains("from_waypoint = 3 for a route of 3 waypoints"),
        "{said}"
    );
}

/// A route beyond the reach of the plane is followed as far as half of the horizon takes.
#[test]
fn the_part_of_a_long_route_within_reach_is_the_mission() {
    for (name, end, km) in [
        ("ocean", "on leg 2", 7.5),
        ("route-beyond-100-km", "on leg 3", 12.2),
    ] {
        let plan = json(&format!("plan tests/faults/{name}.toml --json"));
        assert_eq!(
            (&plan["verdict"], &plan["safe"]),
            (&"solved".into(), &true.into()),
            "{name}"
        );
        let said = notes(&plan);
        assert!(
            said.contains(&format!("begins at waypoint 1 and ends {end}")),
            "{said}"
        );
        assert!(
            said.contains(&format!("the mission is its next {km} km")),
            "{said}"
        );
    }
    // from own position on, on the second leg
    let folder = Folder::new();
    for ending in ["toml", "rtz"] {
        let text = fs::read_to_string(format!("tests/faults/ocean.{ending}")).expect("there");
        let text = text.replace(
            "lat_deg = 60.0, lon_deg = 10.0",
            "lat_deg = 59.0, lon_deg = 6.4",
        );
        folder.write(
            &format!("ocean.{ending}"),
            text.replace("course_deg = 0.0", "course_deg = 240.0"),
        );
    }
    let plan = json(&format!("plan {} --json", folder.at("ocean.toml")));
    assert!(
        notes(&plan).contains("begins beside own ship on leg 2"),
        "{}",
        notes(&plan)
    );
    let first = &plan["mission"]["waypoints"][0];
    let off = number(&first["east_m"]).hypot(number(&first["north_m"]));
    assert!(off < 5_000.0, "{off}");
    assert_eq!(plan["safe"], true);
}

/// The program reads the wait that it wrote: the leg before it takes as long as leg and wait.
#[test]
fn a_route_with_a_wait_keeps_its_times() {
    let plan = json("plan tests/faults/rtz-with-a-wait.toml --json");
    let speeds = list(&plan["mission"]["leg_speeds_mps"]);
    assert_eq!(speeds.len(), 3);
    let took = 231.1 / number(&speeds[0]);
    assert!(
        (took - (231.1 / (5.0 * KNOT) + 111.0)).abs() < 1.0,
        "{took}"
    );
    assert!((number(&speeds[1]) / KNOT - 3.1434).abs() < 1e-3);
    assert!(
        notes(&plan).contains("stay of 111 s: taken as a slower leg 1"),
        "{}",
        notes(&plan)
    );
    let folder = Folder::new();
    let zip = folder.write("x.rtzp", b"PK\x03\x04\x00\xff");
    assert!(zip.ends_with("x.rtzp"));
    let text = fs::read_to_string("tests/faults/corridor.toml").expect("there");
    let file = folder.write("x.toml", text.replace("corridor.rtz", "x.rtzp"));
    let said = stderr(&searoom(&["check", &file]).code(2)).replace("\n", " ");
    assert!(
        said.contains("a zip archive") && said.contains("unzip it"),
        "{said}"
    );
}

/// With a radius the isle and the pier of the map are land, which the route then crosses.
#[test]
fn points_and_lines_of_a_map_are_land_with_a_radius() {
    let folder = Folder::new();
    for name in ["isle-point", "pier-line", "no-geometry", "depth-areas"] {
        let [map, text] = ["geojson", "toml"].map(|ending| {
            fs::read_to_string(format!("tests/faults/{name}.{ending}")).expect("there")
        });
        folder.write(&format!("{name}.geojson"), map);
        let plain = format!("map = \"{name}.geojson\"");
        let table = format!("map = {{ file = \"{name}.geojson\", point_radius_m = 40.0 }}");
        assert!(text.contains(&plain));
        folder.write(&format!("{name}.toml"), text.replace(&plain, &table));
    }
    for name in ["isle-point", "pier-line"] {
        let file = folder.at(&format!("{name}.toml"));
        let said = stderr(&searoom(&["check", &file]).code(2));
        assert!(said.contains("crosses land"), "{said}");
    }
    let plan = json(&format!("plan {} --json", folder.at("no-geometry.toml")));
    assert_eq!(notes(&plan), "map: 1 feature without a geometry skipped");
    assert!(plan["cautions"].is_null());
    let said = stderr(&searoom(&["check", &folder.at("depth-areas.toml")]).code(2));
    assert!(said.contains("crosses land"), "{said}");
}

#[test]
fn trafficgen_files_with_a_speed_at_the_first_waypoint_are_read() {
    let file = "tests/faults/trafficgen-speed-at-first-waypoint.json";
    let plan = json(&format!("plan {file} --json"));
    assert!((leg_knots(&plan)[0] - 10.0).abs() < 1e-9);
    let said = stderr(&run(&format!("check {file}")).success()).replace("\n", " ");
    assert!(said.contains("that of the first waypoint taken"), "{said}");
    // without any speed an option gives it
    let folder = Folder::new();
    let text = fs::read_to_string(file).expect("there");
    let bare = text.replacen(", \"leg\": {\"sog\": 10.0}", "", 1);
    assert_ne!(bare, text);
    let bare = folder.write("bare.json", bare);
    let said = stderr(&searoom(&["plan", &bare]).code(2)).replace("\n", " ");
    assert!(said.contains("--own-speed-mps"), "{said}");
    let plan = json(&format!("plan {bare} --own-speed-mps 4 --json"));
    assert_eq!(plan["mission"]["leg_speeds_mps"][0], 4.0);
    let old = "tests/faults/maritime-schema-0.0.7.json";
    let said = stderr(&searoom(&["plan", old]).code(2)).replace("\n", " ");
    assert!(
        said.contains("1 fault") && said.contains("as maritime-schema 0.0 has them"),
        "{said}"
    );
}

/// A late report is a gap, a size of 0 is unknown, and time begins with own ship.
#[test]
fn commonocean_scenarios_of_real_traffic_are_read() {
    let file = "tests/faults/commonocean-real-traffic.xml";
    let assert = searoom(&["plan", file, "--json"]);
    let plan = document(&assert);
    let said = stderr(&assert).replace("\n", " ");
    for part in [
        "1 of its steps are beyond 50 m/s, the first of 80 m at step 15",
        "size unknown, 0 in the file; 400 × 60 m taken",
        "time begins at own ship's step 12",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let late = &plan["targets"][0];
    assert_eq!(late["name"], "cargoship 21");
    // the step was 75 m longer than at 5 m/s, and the sets hold three standard deviations
    assert_eq!(late["ship"]["position_std_m"], 25.0);
    let large = &plan["targets"][1]["ship"];
    assert_eq!(
        (number(&large["length_m"]), number(&large["beam_m"])),
        (400.0, 60.0)
    );
    let sized = document(&run(&format!(
        "plan {file} --length-m 80 --beam-m 14 --json"
    )));
    assert_eq!(sized["targets"][1]["ship"]["length_m"], 80.0);
}

/// A box of 90 × 15 m that is 30 m ahead reaches 75 m from the ship's position there, and as far as
/// 37.5 m abeam where CommonOcean's library puts it.
#[test]
fn hulls_hold_both_readings_of_a_shape_off_its_centre() {
    for (name, length, beam) in [
        ("box-off-centre", 150.0, 75.0),
        ("pointed-hull", 93.0, 18.0),
    ] {
        let file = format!("tests/faults/commonocean-{name}.xml");
        let ship = &json(&format!("plan {file} --json"))["targets"][0]["ship"];
        let [found, wide] = ["length_m", "beam_m"].map(|key| number(&ship[key]));
        assert!(
            found >= length - 1e-9 && found < length + 15.0,
            "{name}: {found}"
        );
        assert!(wide >= beam - 1e-9 && wide < beam + 15.0, "{name}: {wide}");
        let said = stderr(&run(&format!("check {file}")).success()).replace("\n", " ");
        assert!(said.contains("m off its position"), "{said}");
    }
}
