//! Traffic through the program: a scenario of a moment, and a watch from moment to moment.

use serde_json::Value;

use super::program::{Folder, command, document, json, list, run, stderr, stdout};
use super::schemas::Schema;

/// Own ship heads east, `ALFA` comes toward it, and `BRAVO` lies far off.
fn deltas() -> String {
    let line = |context: &str, second: u32, place: [f64; 2], motion: [f64; 2], more: &str| {
        let ([lat, lon], [speed, course]) = (place, motion);
        format!(
            "{{\"context\":\"vessels.{context}\",\"updates\":[{{\"timestamp\":\"2026-05-01T12:00:{second:02}.000Z\",\
             \"$source\":\"a\",\"values\":[{more}\
             {{\"path\":\"navigation.speedOverGround\",\"value\":{speed}}},\
             {{\"path\":\"navigation.courseOverGroundTrue\",\"value\":{course}}},\
             {{\"path\":\"navigation.position\",\"value\":{{\"latitude\":{lat},\"longitude\":{lon}}}}}]}}]}}\n"
        )
    };
    let named = |name: &str| {
        format!(
            "{{\"path\":\"\",\"value\":{{\"name\":\"{name}\"}}}},\
             {{\"path\":\"design.length\",\"value\":{{\"overall\":80}}}},{{\"path\":\"design.beam\",\"value\":14}},"
        )
    };
    let half_pi = 0.5 * std::f64::consts::PI;
    let mut text =
        "{\"self\":\"vessels.urn:mrn:imo:mmsi:257000001\",\"version\":\"2.0.0\"}\n".to_owned();
    for second in 0..20 {
        let metres = f64::from(second) / 59_900.0;
        text += &line(
            "self",
            second,
            [57.5, 11.0 + 7.0 * metres],
            [7.0, half_pi],
            "",
        );
        let at = [57.5, 11.1 - 6.0 * metres];
        text += &line(
            "urn:mrn:imo:mmsi:257000002",
            second,
            at,
            [6.0, 3.0 * half_pi],
            &named("ALFA"),
        );
        let at = [57.52, 11.0];
        text += &line(
            "urn:mrn:imo:mmsi:257000003",
            second,
            at,
            [0.0, 1.0],
            &named("BRAVO"),
        );
    }
    text
}

const OWN: &str = "title = \"East\"\nhorizon_s = 900.0\norigin = { lat_deg = 57.5, lon_deg = 11.0 }\n\
    [own_ship]\nposition = { east_m = 0, north_m = 0 }\ncourse_deg = 90.0\nspeed_mps = 7.0\n\
    length_m = 90.0\nbeam_m = 15.0\nturning_radius_m = 250.0\nspeeds_mps = [3.5, 7.0]\n\
    [mission]\nwaypoints = [{ east_m = 0, north_m = 0 }, { east_m = 6000, north_m = 0 }]\nspeed_mps = 7.0\n";

const ROUTE: &str = "<route version=\"1.0\"><waypoints>\
    <waypoint id=\"1\"><position lat=\"57.5\" lon=\"10.98\"/></waypoint>\
    <waypoint id=\"2\"><position lat=\"57.5\" lon=\"11.08\"/></waypoint></waypoints></route>";

/// Moments of a replay, without the times that they took.
fn moments(words: &str) -> Vec<Value> {
    let assert = run(words).success();
    let lines = stdout(&assert);
    let mut moments: Vec<Value> = (lines.lines())
        .map(|line| serde_json::from_str(line).expect("a document on each line"))
        .collect();
    for moment in &mut moments {
        moment["took_s"] = 0.0.into();
    }
    moments
}

#[test]
fn a_replay_has_a_document_of_each_moment_and_a_plan_that_verifies() {
    let folder = Folder::new();
    let (own, feed) = (
        folder.write("own.toml", OWN),
        folder.write("feed.jsonl", deltas()),
    );
    let plan = folder.at("now.json");
    let words = format!("watch {own} --listen {feed} --speed max --json --plan {plan}");
    let first = moments(&words);
    assert_eq!(first, moments(&words));
    assert!(first.len() >= 18, "{}", first.len());
    let schema = Schema::of("watch");
    for moment in &first {
        schema.assert_holds(moment, "moment");
    }
    let last = first.last().expect("a moment");
    let dangerous = list(&last["dangerous"]);
    assert_eq!(dangerous.len(), 1, "{last}");
    assert_eq!(dangerous[0]["name"], "ALFA");
    assert_eq!(dangerous[0]["role"], "head-on");
    assert_eq!(last["ships"], 2);
    let shown = &last["plan"];
    assert_eq!(shown["safe"], true, "{shown}");
    // the second moment shows what is left of the first plan
    let age = |moment: &Value| moment["plan"]["made_s_ago"].as_f64();
    assert!(first.iter().filter_map(age).any(|age| age > 5.0));
    run(&format!("verify {plan}")).success();
}

/// A mission that own ship has half sailed goes on from where it is, not from its first waypoint: 2.5 km of
/// 6 km are left, six minutes.
#[test]
fn a_mission_goes_on_from_where_own_ship_is() {
    let folder = Folder::new();
    let own = OWN.replace(
        "{ east_m = 0, north_m = 0 }, { east_m = 6000",
        "{ east_m = -3500, north_m = 0 }, { east_m = 2500",
    );
    let (own, feed) = (
        folder.write("own.toml", own),
        folder.write("feed.jsonl", deltas()),
    );
    let all = moments(&format!("watch {own} --listen {feed} --speed max --json"));
    let plans = all
        .iter()
        .filter_map(|moment| moment["plan"]["ends_s"].as_f64());
    let ends: Vec<f64> = plans.collect();
    assert!(
        ends.len() > 10 && ends.iter().all(|ends| *ends < 500.0),
        "{ends:?}"
    );
    assert!(
        all.iter()
            .all(|moment| !moment["events"].to_string().contains("from its mission"))
    );
}

/// Where nothing is known of own ship there is no word on risk.
#[test]
fn without_own_ship_no_risk_is_computed() {
    let folder = Folder::new();
    let others: String = deltas()
        .lines()
        .filter(|line| !line.contains("self"))
        .map(|l| format!("{l}\n"))
        .collect();
    let (own, feed) = (
        folder.write("own.toml", OWN),
        folder.write("feed.jsonl", others),
    );
    let words = format!("watch {own} --listen {feed} --speed max");
    let text = stdout(&run(&words).success());
    assert!(
        text.contains("own ship's place is not known") && !text.contains("no risk of collision"),
        "{text}"
    );
    for moment in moments(&format!("{words} --json")) {
        assert_eq!(moment["risk_computed"], false);
        assert_eq!(moment.get("own"), None);
    }
    // and on standard input, where the times are those of this machine
    let piped = command(&["watch", &own, "--listen", "-", "--json"])
        .write_stdin("")
        .assert()
        .success();
    assert_eq!(stdout(&piped).lines().count(), 1);
}

#[test]
fn a_moment_of_traffic_becomes_a_scenario() {
    let folder = Folder::new();
    let (feed, route) = (
        folder.write("feed.jsonl", deltas()),
        folder.write("east.rtz", ROUTE),
    );
    let out = folder.at("out");
    let at = "--at 2026-05-01T12:00:10Z";
    let told = run(&format!(
        "import {feed} {at} --route {route} --out {out} --length-m 90 --beam-m 15"
    ));
    let told = told.success();
    assert!(
        stderr(&told).contains("reports after the time that was asked for"),
        "{}",
        stderr(&told)
    );
    let file = folder.at("out/feed.toml");
    let plan = json(&format!("plan {file} --json"));
    assert_eq!(plan["safe"], true, "{}", plan["verdict"]);
    let names: Vec<&Value> = list(&plan["targets"])
        .iter()
        .map(|target| &target["name"])
        .collect();
    assert_eq!(names, ["ALFA", "BRAVO"]);
    let piped = command(&["verify", "-"])
        .write_stdin(plan.to_string())
        .assert()
        .success();
    assert!(stdout(&piped).contains("East") || stdout(&piped).contains("feed"));
    let others: String = deltas()
        .lines()
        .filter(|line| !line.contains("self"))
        .map(|line| format!("{line}\n"))
        .collect();
    let others = folder.write("others.jsonl", others);
    let refused = |words: &str, expected: &str| {
        let assert = run(words).code(2);
        assert!(stderr(&assert).contains(expected), "{}", stderr(&assert));
    };
    refused(
        &format!("import {others} {at} --own 1 --route {route} --out {out}"),
        "--own 1",
    );
    refused(
        &format!("import {route} {at} --route {route} --out {out}"),
        "found no report of a ship",
    );
    refused(
        &format!("import {feed} --at noon --route {route} --out {out}"),
        "such as 2026-05-01",
    );
    let table = folder.write(
        "rows.csv",
        "MMSI,BaseDateTime,LAT\n1,2026-05-01T12:00:00,57.5\n",
    );
    refused(
        &format!("import {table} {at} --route {route} --out {out}"),
        "rows.csv",
    );
    refused(
        &format!("watch {file} --listen {feed} --listen {feed}"),
        "a file beside another source",
    );
    refused(&format!("watch {file} --listen ftp://x"), "udp://");
    let bare = folder.write(
        "bare.toml",
        OWN.replace("origin = { lat_deg = 57.5, lon_deg = 11.0 }", ""),
    );
    refused(&format!("watch {bare} --listen {feed}"), "origin");
}

/// Every key that a traffic scenario has is read back as it was: the sets are those of the picture.
#[test]
fn status_and_sets_of_a_target_are_in_its_document() {
    let folder = Folder::new();
    let with = "position_set = { vertices_m = [[-20, -5], [20, -5], [0, 30]] }\nheading_spread_deg = 4\n\
                status = \"not under command\"\n";
    let target = "[[targets]]\nname = \"nuc\"\nposition = { east_m = 3000, north_m = 900 }\ncourse_deg = 180\n\
                  speed_mps = 2\nlength_m = 50\nbeam_m = 9\ncourse_spread_deg = 20\n";
    let file = folder.write("nuc.toml", format!("{OWN}{target}{with}"));
    let plan = document(&run(&format!("plan {file} --json")));
    let target = &plan["targets"][0];
    assert_eq!(target["status"], "not under command");
    let spread = target["ship"]["heading_spread_deg"]
        .as_f64()
        .expect("a spread");
    assert!((spread - 4.0).abs() < 1e-9);
    assert_eq!(
        target["ship"]["kept_positions"]["vertices_m"],
        serde_json::json!([[-20.0, -5.0], [20.0, -5.0], [0.0, 30.0]])
    );
    assert!(plan["cautions"].to_string().contains("not under command"));
    let verified = command(&["verify", "-"])
        .write_stdin(plan.to_string())
        .assert();
    verified.success();
    for (wrong, expected) in [
        (
            "position_set = { vertices_m = [[1, 0], [2, 0], [1, 1]] }",
            "[0, 0]",
        ),
        (
            "position_set = { vertices_m = [[0, 0]] }\nposition_std_m = 1",
            "position_std_m",
        ),
        ("status = \"asleep\"", "not under command"),
        ("heading_spread_deg = 181", "180"),
    ] {
        let text = format!(
            "{OWN}[[targets]]\nname = \"a\"\nposition = {{ east_m = 3000, north_m = 0 }}\n\
                            course_deg = 180\nspeed_mps = 2\nlength_m = 50\nbeam_m = 9\n{wrong}\n"
        );
        let assert = run(&format!("check {}", folder.write("wrong.toml", text))).code(2);
        let said = format!("{}{}", stdout(&assert), stderr(&assert));
        assert!(said.contains(expected), "{wrong}: {said}");
    }
}
