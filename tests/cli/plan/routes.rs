//! Waypoints and legs: unusual missions, routes that are written, and routes that are read.

use std::fs;

use crate::program::{Folder, HEAD_ON, json, list, number, searoom, text};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};

/// HEAD_ON with another first position and the given waypoints, without its target's motion in the
/// way.
fn with_waypoints(own: &str, waypoints: &str) -> String {
    let at = HEAD_ON.find("waypoints").expect("a mission");
    let line = &HEAD_ON[at..at + HEAD_ON[at..].find('\n').expect("a line")];
    HEAD_ON
        .replacen("position = { east_m = 0.0, north_m = 0.0 }", own, 1)
        .replacen(line, waypoints, 1)
        .replacen("horizon_s = 400.0", "horizon_s = 900.0", 1)
}

#[test]
fn a_ship_at_the_last_waypoint_has_arrived() {
    let folder = Folder::new();
    let own = "position = { east_m = 700.0, north_m = 900.0 }";
    let waypoints = "waypoints = [{ east_m = 0, north_m = 900 }, { east_m = 700, north_m = 900 }]";
    let file = folder.write("there.toml", with_waypoints(own, waypoints));
    let document = json(&format!("plan {file} --json"));
    assert_eq!(document["outcome"], "solved");
    assert_eq!(document["cost"]["duration_s"], 0.0);
}

#[test]
fn legs_shorter_than_a_turn_are_cut_short_and_too_many_are_refused() {
    let folder = Folder::new();
    let own = "position = { east_m = 0.0, north_m = 900.0 }";
    let zigzag = |count: usize| {
        let points: Vec<String> = (0..count)
            .map(|i| format!("{{ east_m = {}, north_m = {} }}", 15 * i, 900 + 5 * (i % 2)))
            .collect();
        with_waypoints(own, &format!("waypoints = [{}]", points.join(", ")))
    };
    let file = folder.write("zigzag.toml", zigzag(99));
    let document = json(&format!("plan {file} --json"));
    assert_eq!(document["verified"], true);
    assert!(number(&document["cost"]["length_m"]) < 1600.0);
    let file = folder.write("many.toml", zigzag(200));
    let refused = searoom(&["check", &file]).code(2);
    refused.stderr(contains("mission.waypoints: found 200 positions"));
}

#[test]
fn sets_of_one_point_block_too() {
    let folder = Folder::new();
    let alone = HEAD_ON.split("[[targets]]").next().expect("a part");
    let text = alone.to_owned()
        + "[[targets]]\nname = \"buoy\"\ninitial_set = { vertices_m = [[700.0, 0.0]] }\n\
           velocity_set = { vertices_mps = [[-1.0, 0.0]] }\n";
    let file = folder.write("point.toml", text);
    let document = json(&format!("plan {file} --json"));
    assert_eq!(document["verified"], true);
    assert!(document["cost"]["space_time_error_m2"].as_f64() > Some(0.0));
}

/// Head-on with its route cut into so many legs of one line.
fn in_legs(count: u32) -> String {
    let east = |i: u32| 1500.0 * f64::from(i) / f64::from(count);
    let places: Vec<String> = (0..=count)
        .map(|i| format!("{{ east_m = {:?}, north_m = 0.0 }}", east(i)))
        .collect();
    let line = HEAD_ON
        .lines()
        .find(|l| l.starts_with("waypoints"))
        .expect("a route");
    HEAD_ON.replace(line, &format!("waypoints = [{}]", places.join(", ")))
}

#[test]
fn waypoints_on_a_line_change_nothing() {
    let folder = Folder::new();
    let mut costs = Vec::new();
    for count in [1, 2, 99] {
        let file = folder.write("legs.toml", in_legs(count));
        let plan = json(&format!("plan {file} --json"));
        // the document has the route as it was given
        assert_eq!(
            list(&plan["mission"]["waypoints"]).len(),
            count as usize + 1
        );
        let cost = &plan["cost"];
        costs.push((
            number(&cost["objective"]),
            number(&cost["space_time_error_m2"]),
        ));
    }
    for (found, judged) in &costs {
        assert!((found - costs[0].0).abs() < 1e-6, "{costs:?}");
        assert!((judged - costs[0].0).abs() < 1e-6, "{costs:?}");
    }
}

/// One metre of way, a turning radius of 1,000 km: the plan ended 0.04 mm short and failed its own
/// verification.
#[test]
fn a_short_way_of_a_ship_that_hardly_turns_is_planned() {
    let folder = Folder::new();
    let scenario = HEAD_ON
        .replace("turning_radius_m = 100.0", "turning_radius_m = 1e6")
        .replace("1500.0, north_m = 0.0 }]", "1.0, north_m = 0.0 }]");
    let file = folder.write("short.toml", scenario);
    let planned = searoom(&["plan", &file]).success();
    planned.stdout(contains("verified"));
}

#[test]
fn the_legs_of_a_plan_are_printed_and_written_as_a_route() {
    let folder = Folder::new();
    let file = folder.write("plan.toml", HEAD_ON);
    let placed = format!("origin = {{ lat_deg = 59.0, lon_deg = 10.5 }}\n{HEAD_ON}");
    let placed = folder.write("placed.toml", placed);
    let route = |name: &str| folder.path().join(name);
    let csv = route("route.csv");
    searoom(&["plan", &file, "--route", text(&csv)])
        .success()
        .stdout(contains("what happens").and(contains("closest to 'target'")));
    let rows = fs::read_to_string(&csv).expect("written");
    assert!(rows.starts_with("leg,from_s,to_s,from_east_m"), "{rows}");
    for name in ["route.geojson", "route.rtz"] {
        let written = route(name);
        searoom(&["plan", &file, "--route", text(&written)])
            .code(2)
            .stderr(contains("found a scenario without 'origin'"));
        assert!(!written.exists());
        searoom(&["plan", &placed, "--route", text(&written)]).success();
        let written = fs::read_to_string(written).expect("written");
        let turn = "turns for 'target'";
        assert!(written.contains(turn), "{written}");
    }
    // the tracking margin is the cross-track limit
    let limits = |name: &str| {
        let rtz = fs::read_to_string(route(name)).expect("written");
        rtz.matches(r#"<leg starboardXTD="0.005400" portsideXTD="0.005400" "#)
            .count()
    };
    assert_eq!(limits("route.rtz"), 0);
    let margin = "safety_margin_m = 20.0";
    assert!(HEAD_ON.contains(margin));
    let with = HEAD_ON.replace(margin, &format!("{margin}\ntracking_margin_m = 10.0"));
    let with = format!("origin = {{ lat_deg = 59.0, lon_deg = 10.5 }}\n{with}");
    let with = folder.write("margin.toml", with);
    searoom(&["plan", &with, "--route", text(&route("margin.rtz"))]).success();
    assert!(limits("margin.rtz") > 3);
    // a wait on the path is a stay
    let waits = "scenarios/dnv/traffic_situation_05.json";
    let written = route("waits.rtz");
    let asked = ["--planner", "path-time", "--compliance", "none"];
    searoom(&[&["plan", waits, "--route", text(&written)], &asked[..]].concat()).success();
    let rtz = fs::read_to_string(&written).expect("written");
    assert!(rtz.contains("stay=\"00:06:37\""), "{rtz}");
    let other = route("route.txt");
    searoom(&["plan", &file, "--route", text(&other)])
        .code(2)
        .stdout(is_empty())
        .stderr(contains(
            "allowed: a file that ends in .csv, .geojson or .rtz",
        ));
    let forces = [
        "plan",
        "scenarios/forces/give-way.toml",
        "--route",
        text(&csv),
    ];
    searoom(&forces)
        .code(2)
        .stderr(contains("there are no legs"));
}

/// A route that was written is the mission of the next scenario: its plan is as long, and its speeds
/// are those of the legs.
#[test]
fn a_route_is_a_mission() {
    let folder = Folder::new();
    let file = |name: &str| text(&folder.path().join(name)).to_owned();
    let origin = "origin = { lat_deg = 59.0, lon_deg = 10.5 }";
    let placed = folder.write("placed.toml", format!("{origin}\n{HEAD_ON}"));
    searoom(&["plan", &placed, "--route", &file("first.rtz")]).success();
    let first = json(&format!("plan {placed} --json"));
    let alone = HEAD_ON.split("[[targets]]").next().expect("a part");
    let from = alone.find("waypoints = ").expect("waypoints");
    let to = from + alone[from..].find('\n').expect("a line");
    let with = |mission: &str| format!("{origin}\n{}{mission}{}", &alone[..from], &alone[to..]);
    let routed = with("route = \"first.rtz\"");
    let routed = routed.replace("speed_mps = 5.0\n\n[planner]", "[planner]");
    let again = folder.write("again.toml", &routed);
    let plan = json(&format!("plan {again} --json"));
    let waypoints = list(&plan["mission"]["waypoints"]);
    let written = fs::read_to_string(file("first.rtz")).expect("written");
    assert_eq!(waypoints.len(), written.matches("<waypoint id").count());
    let speeds = written.split("speed=\"").skip(2);
    let speeds = speeds.map(|rest| rest.split('"').next().expect("an end"));
    let knots: Vec<f64> = speeds.map(|s| s.parse().expect("a number")).collect();
    let legs = list(&plan["mission"]["leg_speeds_mps"]);
    assert!(knots.len() == legs.len() && knots.iter().any(|k| *k != knots[0]));
    for (knots, mps) in knots.iter().zip(legs) {
        assert!((knots * 1852.0 / 3600.0 - number(mps)).abs() < 1e-9);
    }
    let [first, again] = [&first, &plan].map(|plan| number(&plan["cost"]["length_m"]));
    assert!((first - again).abs() < 0.02 * first, "{first} {again}");
    for (mission, found) in [
        ("route = \"none.rtz\"", "none.rtz, which cannot be read"),
        ("route = \"placed.toml\"", "placed.toml: line 1: "),
        ("route = 5", "mission.route: found 5"),
        (
            "route = \"first.rtz\"\nwaypoints = []",
            "nothing: the route has them",
        ),
    ] {
        let bad = folder.write("bad.toml", with(mission));
        searoom(&["plan", &bad]).code(2).stderr(contains(found));
    }
    let far = with("route = \"first.rtz\"").replace("lat_deg = 59.0", "lat_deg = 49.0");
    let far = folder.write("far.toml", far);
    searoom(&["plan", &far])
        .code(2)
        .stderr(contains("mission.route: found").and(contains("km from the origin")));
}

/// A date gives a route its times, of which one that is read gives the scenario its date.
#[test]
fn a_route_has_the_times_of_day_of_its_scenario() {
    let folder = Folder::new();
    let at = |name: &str| text(&folder.path().join(name)).to_owned();
    let origin = "origin = { lat_deg = 59.0, lon_deg = 10.5 }";
    let dated = |key: &str| folder.write("dated.toml", format!("{origin}\n{key}\n{HEAD_ON}"));
    let plan = |file: &str, route: &str| {
        searoom(&["plan", file, "--route", route])
            .success()
            .get_output()
            .stderr
            .clone()
    };
    let undated = plan(&dated(""), &at("undated.rtz"));
    let undated = String::from_utf8_lossy(&undated).into_owned();
    assert!(
        undated.contains("no times of arrival: 'start_utc'"),
        "{undated}"
    );
    let file = dated("start_utc = 2026-05-01T14:00:00+02:00\ntime_s = 60.0");
    assert!(!String::from_utf8_lossy(&plan(&file, &at("dated.rtz"))).contains("start_utc"));
    let route = fs::read_to_string(at("dated.rtz")).expect("written");
    let [without, first] = ["undated.rtz", "dated.rtz"].map(|name| {
        let route = fs::read_to_string(at(name)).expect("written");
        route.matches(" eta=").count()
    });
    assert!(without == 0 && first > 3, "{route}");
    assert!(
        route.contains("etd=\"2026-05-01T12:01:00.000Z\""),
        "{route}"
    );
    // the mission of the route begins at its departure
    let alone = HEAD_ON.split("[[targets]]").next().expect("a part");
    let from = alone.find("waypoints = ").expect("waypoints");
    let to = from + alone[from..].find('\n').expect("a line");
    let with = |head: &str| {
        let mission = "route = \"dated.rtz\"";
        let text = format!(
            "{origin}\n{head}\n{}{mission}{}",
            &alone[..from],
            &alone[to..]
        );
        folder.write("again.toml", text)
    };
    for (head, departs) in [
        ("", "2026-05-01T12:01:00.000Z"),
        (
            "start_utc = 2027-01-01T00:00:00Z",
            "2027-01-01T00:00:00.000Z",
        ),
    ] {
        plan(&with(head), &at("again.csv"));
        let rows = fs::read_to_string(at("again.csv")).expect("written");
        let row = rows.lines().nth(1).expect("a row");
        assert_eq!(row.split(',').nth(3), Some(departs), "{rows}");
    }
    for wrong in [
        "\"2026-05-01T12:00:00Z\"",
        "2026-05-01",
        "2026-05-01T12:00:00",
        "5",
    ] {
        searoom(&["check", &dated(&format!("start_utc = {wrong}"))])
            .code(2)
            .stderr(contains("start_utc: found").and(contains("offset from UTC, such as")));
    }
}

/// Own ship begins a little off its route: the turn of a moment is no leg of its own.
#[test]
fn a_turn_of_a_moment_is_part_of_the_next_leg() {
    let folder = Folder::new();
    let alone = HEAD_ON.split("[[targets]]").next().expect("a part");
    let file = folder.write(
        "off.toml",
        alone.replacen("course_deg = 90.0", "course_deg = 90.3", 1),
    );
    let route = folder.at("off.csv");
    searoom(&["plan", &file, "--route", &route]).success();
    let rows = fs::read_to_string(&route).expect("written");
    let mut from = 0.0;
    for row in rows.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let [start, end] = [cells[1], cells[2]].map(|cell| cell.parse::<f64>().expect("a time"));
        assert_eq!(start, from, "{rows}");
        assert!(end - start > 1.0, "{rows}");
        from = end;
    }
    let document = json(&format!("plan {file} --json"));
    let segments = list(&document["trajectory"]["segments"]);
    assert!(number(&segments[0]["duration_s"]) < 0.5, "{segments:?}");
}
