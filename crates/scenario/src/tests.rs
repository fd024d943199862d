//! Scenario files: defaults, every fault with its place, hostile texts.

use nalgebra::Matrix2;

use super::*;
use searoom_geometry::frame::{Pose, heading_of, mps_from_knots};
use searoom_geometry::{ConvexPolygon, ConvexSet, Ellipse};
use searoom_model::target::{DomainKind, Motion, Representation, Uncertainty};
use searoom_model::vessel::{ForceVector, StateVector, VesselKind};
use searoom_planner::ControlSettings;

const SCENARIO: &str = r#"
title = "least"
horizon_s = 400
[own_ship]
position = { east_m = 0, north_m = 0 }
course_deg = 90
speed_mps = 5
length_m = 30
beam_m = 8
turning_radius_m = 100
[mission]
waypoints = [{ east_m = 0, north_m = 0 }, { east_m = 1500, north_m = 0 }, { east_m = 1500, north_m = 400 }]
"#;

const SHIP: &str = r#"
[[targets]]
name = "ship"
position = { east_m = 1500, north_m = 0 }
course_deg = -90
speed_kn = 10
length_m = 60
beam_m = 12
"#;

fn paths(text: &str) -> Vec<String> {
    let faults = Scenario::parse(text).expect_err("faulty");
    faults.into_iter().map(|fault| fault.path).collect()
}

/// Rows of a test's table with `|` between the cells, without empty rows and comments.
pub(super) fn rows<const N: usize>(table: &'static str) -> impl Iterator<Item = [&'static str; N]> {
    let rows = table.lines().map(str::trim);
    let rows = rows.filter(|row| !row.is_empty() && !row.starts_with("//"));
    rows.map(|row| {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        cells.try_into().expect(row)
    })
}

#[test]
fn what_is_left_out_takes_its_default() {
    let scenario = Scenario::parse(&format!("{SCENARIO}{SHIP}")).expect("valid");
    let own = &scenario.own_ship;
    assert_eq!(own.speeds, [2.5, 5.0]);
    assert_eq!(own.safety_margin, 30.0);
    assert!(own.pose.heading.abs() < 1e-15);
    assert!(scenario.desired.legs().iter().all(|leg| leg.speed == 5.0));
    assert!((scenario.time_weight - 25.0).abs() < 1e-12);
    assert_eq!(scenario.deadline, 5.0);
    assert_eq!(scenario.search, SearchKind::AStar);
    assert_eq!(scenario.compliance, Compliance::Rules);
    let ship = scenario.targets[0].ship().expect("a ship");
    assert_eq!(ship.speed, mps_from_knots(10.0));
    assert!((ship.velocity() - Vector::new(-ship.speed, 0.0)).norm() < 1e-12);
    let spreads = [ship.position_std, ship.speed_spread, ship.course_spread];
    assert_eq!(spreads, [0.0; 3]);
    assert_eq!(ship.domain, DomainKind::Colregs);
}

#[test]
fn plans_are_tidy_under_the_rules_or_where_the_file_asks_for_it() {
    let speed_time = |planner: &str, length: &str| {
        let text = SCENARIO.replace("length_m = 30", &format!("length_m = {length}"));
        let scenario = Scenario::parse(&format!("{text}[planner]\n{planner}")).expect("valid");
        scenario.tidiness().map(|tidy| tidy.speed_time)
    };
    for (planner, length, expected) in [
        ("compliance = \"rules\"", "30", Some(30.0)),
        ("compliance = \"shape\"", "30", None),
        ("compliance = \"none\"\ntidy = true", "65", Some(45.0)),
        ("compliance = \"rules\"", "300", Some(60.0)),
        ("tidy = true\nmin_speed_time_s = 90", "30", Some(90.0)),
        ("compliance = \"rules\"\ntidy = false", "30", None),
    ] {
        assert_eq!(speed_time(planner, length), expected, "{planner}");
    }
}

/// Otherwise own ship would change between two speeds all the way.
#[test]
fn the_speeds_of_the_mission_are_own_ships_unless_it_has_others() {
    let speeds = |text: &str| Scenario::parse(text).expect("valid").own_ship.speeds;
    let text = SCENARIO.to_owned() + "leg_speeds_mps = [3, 5]";
    assert_eq!(speeds(&text), [2.5, 3.0, 5.0]);
    let text = text.replace("turning", "speeds_mps = [2, 6]\nturning");
    assert_eq!(speeds(&text), [2.0, 6.0]);
}

#[test]
fn knots_replace_lists_too() {
    let text =
        SCENARIO.replace("turning", "speeds_kn = [12, 0, 6]\nturning") + "leg_speeds_kn = [10, 5]";
    let scenario = Scenario::parse(&text).expect("valid");
    let speeds = [0.0, 6.0, 12.0].map(mps_from_knots);
    assert_eq!(scenario.own_ship.speeds, speeds);
    assert_eq!(scenario.desired.legs()[1].speed, mps_from_knots(5.0));
    let mean = scenario.desired.length() / scenario.desired.duration();
    assert_eq!(scenario.time_weight, mean * mean);
}

#[test]
fn miles_and_cables_replace_metres() {
    let text = SCENARIO.replace(
        "turning_radius_m = 100",
        "turning_radius_cbl = 0.5\nsafety_margin_nmi = 0.1\nland_margin_cbl = 1",
    );
    let domain = "domain = { fore_nmi = 1, aft_cbl = 2, port_m = 300, starboard_cbl = 5 }";
    let text = format!("{text}[planner]\ncpa_limit_nmi = 2\n{SHIP}{domain}");
    let scenario = Scenario::parse(&text).expect("valid");
    let own = &scenario.own_ship;
    assert!((own.turning_radius - 92.6).abs() < 1e-9);
    assert!((own.safety_margin - 185.2).abs() < 1e-9);
    let ship = scenario.targets[0].ship().expect("a ship");
    let DomainKind::Custom {
        fore,
        aft,
        port,
        starboard,
    } = ship.domain
    else {
        panic!("no domain of its own: {:?}", ship.domain);
    };
    for (found, metres) in [
        (fore, 1852.0),
        (aft, 370.4),
        (port, 300.0),
        (starboard, 926.0),
    ] {
        assert!((found - metres).abs() < 1e-9, "{found} {metres}");
    }
    let twice = text.replace("fore_nmi", "fore_m = 1852, fore_nmi");
    assert_eq!(paths(&twice), ["targets[0].domain.fore_nmi"]);
    let none = text.replace("fore_nmi = 1, ", "");
    assert_eq!(paths(&none), ["targets[0].domain.fore_m"]);
    let far = text.replace("fore_nmi = 1", "fore_nmi = 1e9");
    assert_eq!(paths(&far), ["targets[0].domain.fore_nmi"]);
    let newton_metres = text.replace("cpa_limit_nmi", "cpa_limit_nm");
    let faults = Scenario::parse(&newton_metres).expect_err("faulty");
    assert_eq!(
        faults[0].found,
        "an unknown key, perhaps for 'cpa_limit_nmi'"
    );
}

/// A table ends the keys before it, so a key above all tables is easily written into one.
#[test]
fn a_key_in_the_wrong_table_is_told_where_it_belongs() {
    let first = |text: String| Scenario::parse(&text).expect_err("faulty").swap_remove(0);
    let moved = first(format!("{SCENARIO}time_s = 60\nsafety_margin_m = 5\n"));
    assert_eq!(moved.found, "a key that belongs above all tables");
    let moved = first(format!("{SCENARIO}{SHIP}safety_margin_m = 20\n"));
    assert_eq!(moved.found, "a key that belongs in 'own_ship'");
    let with = |table: &str, line: &str| {
        let text = SCENARIO.replace(table, &format!("{table}\n{line}"));
        first(format!("{text}{SHIP}")).found
    };
    let near = with("[mission]", "speeds_mps = [5]");
    assert_eq!(near, "an unknown key, perhaps for 'speed_mps'");
    let ship = with("title = \"least\"", "name = \"ship\"");
    assert_eq!(ship, "a key that belongs in 'targets'");
    // own ship and targets have one
    let place = with("[mission]", "position = { east_m = 0, north_m = 0 }");
    assert_eq!(place, "an unknown key");
    let late = first(SCENARIO.replace("[mission]", "[mission]\nstart_s = 60"));
    assert_eq!(late.path, "mission.start_s");
    assert!(late.allowed.ends_with("(the present, 'time_s')"), "{late}");
}

#[test]
fn measured_speed_and_course_widen_the_velocities_by_three_deviations() {
    let measured = "speed_std_mps = 0.1\ncourse_std_deg = 1\nspeed_spread_mps = 0.2\n\
                    course_spread_deg = 1.5";
    let widened = "speed_spread_mps = 0.5\ncourse_spread_deg = 4.5";
    let set = |keys: &str| {
        let scenario = Scenario::parse(&format!("{SCENARIO}{SHIP}{keys}")).expect("valid");
        let ship = scenario.targets[0].ship().expect("a ship").clone();
        (ship.outer_velocity_set(), ship.outer_hull(0.0))
    };
    let ((velocities, hull), (wide, wide_hull)) = (set(measured), set(widened));
    for (found, expected) in [(velocities, wide), (hull, wide_hull)] {
        let pairs = found.vertices().iter().zip(expected.vertices());
        assert_eq!(found.vertices().len(), expected.vertices().len());
        for (a, b) in pairs {
            assert!((a - b).norm() < 1e-9, "{a} {b}");
        }
    }
}

#[test]
fn a_ship_may_have_its_velocities_as_a_set() {
    let ship = format!("{SCENARIO}{SHIP}");
    let with = |vertices: &str| format!("{ship}velocity_set = {{ vertices_mps = {vertices} }}");
    let corners = [(-4.0, -1.0), (-6.0, -1.0), (-6.0, 2.0)];
    let scenario = Scenario::parse(&with("[[-4, -1], [-6, -1], [-6, 2]]")).expect("valid");
    let track = scenario.targets[0].ship().expect("a ship");
    let velocities = track.outer_velocity_set();
    assert_eq!(velocities.vertices().len(), 3);
    for (east, north) in corners {
        let corner = Vector::new(east, north);
        assert!(velocities.signed_distance(corner).abs() < 1e-9, "{corner}");
        // the hull has every heading of these velocities
        let hull = track
            .hull
            .polygon(&Pose::new(track.pose.position, heading_of(corner)));
        let outer = track.outer_hull(0.0);
        let inside = |p: &Vector| outer.signed_distance(*p) < 1e-9;
        assert!(hull.vertices().iter().all(inside), "{corner}");
    }
    // around zero it may lie at any angle
    let any = Scenario::parse(&with("[[-6, -1], [1, -1], [1, 2], [-6, 2]]")).expect("valid");
    let any = any.targets[0].ship().expect("a ship").clone();
    assert_eq!(any.course_spread, std::f64::consts::PI);

    let far = with("[[-4, 1], [-6, 1], [-6, 2]]");
    assert_eq!(paths(&far), ["targets[0].velocity_set"]);
    let round = format!(
        "{ship}velocity_set = {{ center_mps = [-5, 0], shape_m2_per_s2 = [[1, 0], [0, 1]] }}"
    );
    assert_eq!(paths(&round), ["targets[0].velocity_set"]);
    let risky = format!("{}[planner]\nmax_risk = 0.1\n", SCENARIO);
    let set = with("[[-4, -1], [-6, -1], [-6, 2]]").replace(SCENARIO, &risky);
    assert_eq!(paths(&set), ["planner.max_risk"]);
    for key in ["speed_spread_mps", "course_std_deg", "turn_rate_deg_per_s"] {
        let both = format!("{}\n{key} = 1", with("[[-4, -1], [-6, -1], [-6, 2]]"));
        assert_eq!(paths(&both), [format!("targets[0].{key}")]);
    }
}

/// The keys of a target on a route west from (1000, 0) at 5 m/s, and the key of the fault, if any.
const ROUTES: &str = r#"
waypoints = [{ east_m = 500, north_m = 0 }, { east_m = 500, north_m = 400 }] |
waypoints = [{ east_m = 500, north_m = 0 }]\nleg_speeds_kn = [10] | targets[0].leg_speeds_kn
waypoints = [{ east_m = 500, north_m = 0 }]\nleg_speeds_kn = [10]\nspeed_spread_mps = 0.2 |
waypoints = [{ east_m = 500, north_m = 12 }]\ncourse_spread_deg = 1 |
waypoints = [{ east_m = 500, north_m = 12 }] | targets[0].waypoints
waypoints = [] | targets[0].waypoints
waypoints = [{ east_m = 1000, north_m = 0 }] | targets[0].waypoints[0]
waypoints = [{ east_m = -9000000, north_m = 0 }] | targets[0].waypoints[0]
waypoints = [{ east_m = 500, north_m = 0 }, { east_m = 500, north_m = 0 }] | targets[0].waypoints[1]
waypoints = [{ east_m = 500, north_m = 0 }]\nleg_speeds_mps = [5, 5] | targets[0].leg_speeds_mps
waypoints = [{ east_m = 500, north_m = 0 }]\nleg_speeds_mps = [0] | targets[0].leg_speeds_mps[0]
waypoints = [{ east_m = 500, north_m = 0 }]\nturn_rate_deg_per_s = 1 | targets[0].turn_rate_deg_per_s
waypoints = [{ east_m = 500, north_m = 0 }]\nstarboard_turn_deg = 1 | targets[0].starboard_turn_deg
waypoints = [{ east_m = 500, north_m = 0 }]\nvelocity_set = { vertices_mps = [[-5, 0]] } | targets[0].velocity_set
waypoints = [{ east_m = 500, north_m = 0 }]\nrepresentation = "ellipsoid" | targets[0].representation
leg_speeds_mps = [5] | targets[0].leg_speeds_mps
time_spread_s = 5 | targets[0].time_spread_s
waypoints = [{ east_m = 500, north_m = 0 }]\ntime_spread_s = 5 |
waypoints = [{ east_m = 500, north_m = 0 }]\ntime_spread_s = -1 | targets[0].time_spread_s
"#;

#[test]
fn a_route_of_a_target_agrees_with_its_course_and_speed() {
    let ship = "[[targets]]\nname = \"other\"\nposition = { east_m = 1000, north_m = 0 }\n\
                course_deg = 270\nspeed_mps = 5\nlength_m = 50\nbeam_m = 10\n";
    for [keys, path] in rows(ROUTES) {
        let keys = keys.replace("\\n", "\n");
        let text = format!("{SCENARIO}\n{ship}{keys}");
        let found = Scenario::parse(&text);
        let expected: Vec<&str> = (!path.is_empty()).then_some(path).into_iter().collect();
        match found {
            Ok(_) => assert!(expected.is_empty(), "{keys}"),
            Err(_) => assert_eq!(paths(&text), expected, "{keys}"),
        }
    }
    // the course follows from the route where it is not given, and speeds have the unit of their key
    let ship_on = |legs: &str| {
        let route = "waypoints = [{ east_m = 1000, north_m = 500 }]";
        format!(
            "{SCENARIO}\n{}{route}\n{legs}",
            ship.replace("course_deg = 270\n", "")
        )
    };
    let scenario = Scenario::parse(&ship_on("")).expect("valid");
    let heading = scenario.targets[0].ship().expect("a ship").pose.heading;
    assert!(
        (heading - std::f64::consts::FRAC_PI_2).abs() < 1e-12,
        "{heading}"
    );
    let faults = Scenario::parse(&ship_on("leg_speeds_kn = [10]")).expect_err("too fast");
    assert_eq!(faults[0].found, "10.000 kn first, and 9.719 kn now");
    let without = format!("{SCENARIO}\n{}", ship.replace("course_deg = 270\n", ""));
    assert_eq!(paths(&without), ["targets[0].course_deg"]);
    let risky = format!(
        "{SCENARIO}[planner]\nmax_risk = 0.1\n{ship}waypoints = [{{ east_m = 500, north_m = 0 }}]"
    );
    assert_eq!(paths(&risky), ["planner.max_risk"]);
}

/// Own ship's keys, the rest of the file, and the key of the fault, if any. From 2.5 to 5 m/s at
/// 0.1 m/s² it is 31.25 m off; the path-time planner also stops, which takes 125 m.
const ACCELERATIONS: &str = r#"
acceleration_mps2 = 0.1\nsafety_margin_m = 40\ntracking_margin_m = 31.3 | |
acceleration_mps2 = 0.1\nsafety_margin_m = 40\ntracking_margin_m = 31.2 | | own_ship.acceleration_mps2
acceleration_mps2 = 0.1 | | own_ship.acceleration_mps2
acceleration_mps2 = 0.1\nspeeds_mps = [5] | |
acceleration_mps2 = 0 | | own_ship.acceleration_mps2
acceleration_mps2 = 0.1\nsafety_margin_m = 99\ntracking_margin_m = 99 | kind = "path-time" | own_ship.acceleration_mps2
acceleration_mps2 = 0.1\nsafety_margin_m = 199\ntracking_margin_m = 126 | kind = "path-time" |
acceleration_mps2 = 0.1\nsafety_margin_m = 99\ntracking_margin_m = 99 | kind = "optimal-control" | own_ship.acceleration_mps2
"#;

#[test]
fn own_ship_may_not_leave_its_tracking_margin_while_it_changes_speed() {
    for [own, planner, path] in rows(ACCELERATIONS) {
        let own = format!("turning_radius_m = 100\n{}", own.replace("\\n", "\n"));
        let text = SCENARIO.replace("turning_radius_m = 100", &own);
        let found = Scenario::parse(&format!("{text}[planner]\n{planner}"));
        let found: Vec<String> = (found.err().into_iter().flatten())
            .map(|fault| fault.path)
            .collect();
        let expected: Vec<String> = Some(path.to_owned())
            .filter(|p| !p.is_empty())
            .into_iter()
            .collect();
        assert_eq!(found, expected, "{own} {planner}");
    }
}

#[test]
fn explicit_sets_are_taken_as_they_are() {
    let text = format!(
        "{SCENARIO}[[targets]]\nname = \"figure 1\"\n\
         initial_set = {{ vertices_m = [[-10, -5], [10, 5], [-10, 5], [10, -5], [10, 0]] }}\n\
         velocity_set = {{ vertices_mps = [[1, 0]] }}"
    );
    let scenario = Scenario::parse(&text).expect("valid");
    let sets = scenario.targets[0].sets().expect("sets");
    let vertices = |set: &ConvexSet| set.as_polygon().expect("a polygon").vertices().to_vec();
    assert_eq!(vertices(&sets.initial).len(), 4);
    let velocities = vertices(&sets.velocities[0].velocities);
    assert_eq!(velocities, [Vector::new(1.0, 0.0)]);
    let dent = text.replace("[10, 0]", "[9, 0]");
    assert_eq!(paths(&dent), ["targets[0].initial_set.vertices_m[4]"]);
    let hull = text.replace("velocity_set", "length_m = 3\nvelocity_set");
    assert_eq!(paths(&hull), ["targets[0].length_m"]);
}

/// A text of the least file, what replaces it (`\n` for a new line), and the place of the fault.
const MISTAKES: &str = r#"
    title = "least" | | title
    title = | tilte = | tilte
    horizon_s = 400 | horizon_s = -inf | horizon_s
    horizon_s = 400 | horizon_s = 1e999 | horizon_s
    course_deg = 90 | course_deg = 361 | own_ship.course_deg
    course_deg = 90 | course = 90 | own_ship.course
    speed_mps = 5 | speed_kn = 5\nspeed_mps = 5 | own_ship.speed_kn
    speed_mps = 5 | speed_mps = 1_000 | own_ship.speed_mps
    speed_mps = 5 | speed_mps = "5" | own_ship.speed_mps
    speed_mps = 5 | | own_ship.speed_mps
    beam_m = 8 | beam_m = 8\nspeeds_mps = [] | own_ship.speeds_mps
    beam_m = 8 | beam_m = 8\nspeeds_mps = [0, 0] | own_ship.speeds_mps
    beam_m = 8 | beam_m = 8\nspeeds_mps = [5,5, 14,0] | own_ship.speeds_mps
    beam_m = 8 | beam_m = 8\nspeeds_mps = [-1, 2] | own_ship.speeds_mps[0]
    _radius_m = 100 | _radius_m = 0 | own_ship.turning_radius_m
    east_m = 1500, north_m = 0 } | east_m = 0, north_m = 0 } | mission.waypoints[1]
    north_m = 400 } | north_m = 5.1e6 } | mission.waypoints[2]
    [mission] | [mission]\nleg_speeds_mps = [1] | mission.leg_speeds_mps
    [mission] | [mission]\nleg_speeds_mps = [1, 2]\nspeed_kn = 1 | mission.leg_speeds_mps
    [mission] | [mission]\nspeed_mps = 0 | mission.speed_mps
    [mission] | [planner]\ntidy = "no"\n[mission] | planner.tidy
    [mission] | [planner]\nmin_speed_time_s = -1\n[mission] | planner.min_speed_time_s
    [mission] | [planner]\ntidy = false\nmin_speed_time_s = 9\n[mission] | planner.min_speed_time_s
"#;

/// Mistakes in a target and the field that is named; more faults may follow.
const SHIP_MISTAKES: &str = r#"
    "ship" | " " | targets[0].name
    beam_m | speed_spread_mps = -0.1\nbeam_m | targets[0].speed_spread_mps
    beam_m | course_spread_deg = 181\nbeam_m | targets[0].course_spread_deg
    beam_m | starboard_turn_deg = -181\nbeam_m | targets[0].starboard_turn_deg
    beam_m | position_std_m = nan\nbeam_m | targets[0].position_std_m
    beam_m | domain = "round"\nbeam_m | targets[0].domain
    beam_m | velocity_set = { vertices_mps = [[0, 0]] }\nbeam_m | targets[0].velocity_set
"#;

#[test]
fn one_mistake_is_one_fault() {
    for [from, to, path] in rows(MISTAKES) {
        assert!(SCENARIO.contains(from), "{from}");
        let text = SCENARIO.replacen(from, &to.replace("\\n", "\n"), 1);
        assert_eq!(paths(&text), [path], "{to}");
    }
    for [from, to, path] in rows(SHIP_MISTAKES) {
        let ship = SHIP.replacen(from, &to.replace("\\n", "\n"), 1);
        assert_eq!(paths(&format!("{SCENARIO}{ship}"))[0], path, "{to}");
    }
    let twice = format!("{SCENARIO}{SHIP}{SHIP}");
    assert_eq!(paths(&twice), ["targets[1].name"]);
}

/// Nothing a file can say may panic: every prefix, and every number replaced by a hostile one.
#[test]
fn hostile_text_is_refused_and_never_panics() {
    let text = format!("{SCENARIO}{SHIP}");
    for end in 0..text.len() {
        let _ = Scenario::parse(&text[..end]);
    }
    assert!(Scenario::parse(&"[".repeat(100_000)).is_err());
    for hostile in [
        "nan", "-inf", "1e308", "-1e308", "5e-324", "-0.0", "[]", "{}", "\"\"", "true",
    ] {
        for (at, _) in text.match_indices(char::is_numeric) {
            let _ = Scenario::parse(&format!("{}{hostile}{}", &text[..at], &text[at + 1..]));
        }
    }
}

const WITH_SETS: &str = "[[targets]]\nname = \"sets\"\n";
const POLYGON: &str = "initial_set = { vertices_m = [[700, 0], [710, 0], [700, 10]] }\n";
const ELLIPSE: &str = "initial_set = { center_m = [700, 0], shape_m2 = [[9, 1], [1, 4]] }\n";
const VELOCITIES: &str = "velocity_set = { vertices_mps = [[1, 0], [0, 1]] }\n";
const ROUND: &str =
    "velocity_set = { center_mps = [0, 1], shape_m2_per_s2 = [[0.1, 0], [0, 0]] }\n";

fn with_sets(sets: &[&str]) -> Result<Scenario, Vec<String>> {
    let sets = sets.join("\n");
    Scenario::parse(&format!("{SCENARIO}{WITH_SETS}{sets}")).map_err(|faults| {
        let short = |path: &str| path.replace("targets[0].", "");
        faults.iter().map(|f| short(&f.path)).collect()
    })
}

#[test]
fn every_kind_is_read() {
    let ellipses = with_sets(&[ELLIPSE, ROUND]).expect("valid");
    let sets = ellipses.targets[0].sets().expect("sets");
    let initial = sets.initial.as_ellipse().expect("an ellipse");
    assert!((initial.shape()[(0, 1)] - 1.0).abs() < 1e-12);
    assert!(sets.velocities[0].velocities.center().y == 1.0);
    assert!(with_sets(&[ELLIPSE, ROUND, "representation = \"ellipsoid\""]).is_ok());
    let around = with_sets(&[POLYGON, VELOCITIES, "representation = \"ellipsoid\""]);
    assert_eq!(
        around.expect("valid").targets[0].representation,
        Representation::Ellipsoid
    );
    let several =
        "velocity_sets = [{ until_s = 60, vertices_mps = [[1, 0]] }, { vertices_mps = [[0, 0]] }]";
    let several = with_sets(&[POLYGON, several]).expect("valid");
    assert_eq!(several.targets[0].changes(), [60.0, f64::INFINITY]);
    let at = several.targets[0].position_at(100.0);
    assert!((at.x - (700.0 + 10.0 / 3.0 + 60.0)).abs() < 1e-9);
}

/// Sets, separated by `;`, and the places of their faults.
const SET_MISTAKES: &str = r#"
    ELLIPSE; VELOCITIES | velocity_set
    POLYGON; ROUND | velocity_set
    POLYGON | velocity_set
    VELOCITIES | initial_set
    initial_set = { center_m = [1, 2], shape_m2 = [[9, 1], [2, 4]] }; velocity_set = { center_mps = [0, 1], shape_m2_per_s2 = [[1, 2], [2, 1]] } | initial_set.shape_m2 velocity_set.shape_m2_per_s2
    initial_set = { center_m = [1, inf], shape_m2 = [[9, 1], [2]] }; velocity_set = { center_mps = [0, 1], shape_m2_per_s2 = 4 } | initial_set.center_m[1] initial_set.shape_m2[1] velocity_set.shape_m2_per_s2
    initial_set = { center_m = [1, 2], shape_m2 = [[9]], vertices_m = [[1, 2]] }; ROUND | initial_set.shape_m2 initial_set.vertices_m
    POLYGON; velocity_sets = [{ until_s = 60, vertices_mps = [[1, 0]] }, { until_s = 60, vertices_mps = [] }, { until_s = 70, vertices_mps = [[0, 0]] }] | velocity_sets[1].until_s velocity_sets[1].vertices_mps velocity_sets[2].until_s
    POLYGON; velocity_sets = [{ vertices_mps = [[1, 0]] }, {}] | velocity_sets[0].until_s velocity_sets[1].vertices_mps
    POLYGON; velocity_sets = [] | velocity_sets
    ELLIPSE; velocity_sets = [{ vertices_mps = [[1, 0]] }] | velocity_sets[0]
    POLYGON; VELOCITIES; velocity_sets = [{ vertices_mps = [[1, 0]] }] | velocity_set
    ELLIPSE; ROUND; representation = "polytope" | representation
    POLYGON; velocity_sets = [{ until_s = 9, vertices_mps = [[1, 0]] }, { vertices_mps = [[1, 0]] }]; representation = "ellipsoid" | representation
    POLYGON; VELOCITIES; turn_rate_deg_per_s = 0 | turn_rate_deg_per_s
"#;

#[test]
fn every_mistake_is_one_fault_with_its_place() {
    for [sets, paths] in rows(SET_MISTAKES) {
        let named = |set| match set {
            "ELLIPSE" => ELLIPSE,
            "POLYGON" => POLYGON,
            "VELOCITIES" => VELOCITIES,
            "ROUND" => ROUND,
            set => set,
        };
        let texts: Vec<&str> = sets.split("; ").map(named).collect();
        let mut found = with_sets(&texts).expect_err("faulty");
        found.sort();
        assert_eq!(found.join(" "), paths, "{sets}");
    }
}

#[test]
fn a_ship_that_may_turn_is_no_ellipsoid() {
    let ship = "position = { east_m = 900, north_m = 0 }\ncourse_deg = 0\nspeed_mps = 4\nlength_m = 50\nbeam_m = 10\n";
    assert!(with_sets(&[ship, "turn_rate_deg_per_s = 0.1"]).is_ok());
    let both = [
        ship,
        "turn_rate_deg_per_s = 0.1\nrepresentation = \"ellipsoid\"",
    ];
    assert_eq!(with_sets(&both).expect_err("faulty"), ["representation"]);
    assert_eq!(
        with_sets(&[ship, "turn_rate_deg_per_s = -0.1"]).expect_err("faulty"),
        ["turn_rate_deg_per_s"]
    );
}

/// Eqs. (10), (11), (20) and (21) are in the files of the paper's figures as they are printed;
/// figure 6 has three greatest speeds, figure 8 the paper's shape.
#[test]
fn the_scenes_of_the_paper_have_its_numbers() {
    let read = |name: &str| {
        Scenario::read(format!("../../scenarios/paper/{name}.toml").as_ref()).expect(name)
    };
    let polygon = |points: &[(f64, f64)]| {
        let points: Vec<Vector> = points.iter().map(|&(x, y)| Vector::new(x, y)).collect();
        ConvexPolygon::from_vertices(&points).expect("convex")
    };
    let polytope = Motion::Sets(Uncertainty::constant(
        polygon(&[(-10.0, -5.0), (-10.0, 5.0), (10.0, 5.0), (10.0, -5.0)]),
        polygon(&[(0.8, 0.0), (1.0, -0.25), (1.2, 0.0), (1.0, 0.25)]),
    ));
    let ellipse = |x: f64, [a, b]: [f64; 2]| {
        let shape = Matrix2::new(a * a, 0.0, 0.0, b * b);
        Ellipse::new(Vector::new(x, 0.0), shape).expect("positive definite")
    };
    let same = |a: &ConvexSet, b: &Ellipse| {
        let Some(a) = a.as_ellipse() else {
            return false;
        };
        (a.center() - b.center()).norm() < 1e-12 && (a.shape() - b.shape()).amax() < 1e-12
    };
    let is_ellipsoid = |motion: &Motion| match motion {
        Motion::Sets(sets) => {
            same(&sets.initial, &ellipse(0.0, [10.0, 5.0]))
                && same(&sets.velocities[0].velocities, &ellipse(1.0, [0.2, 0.25]))
        }
        Motion::Ship(_) => false,
    };
    for name in ["figure_1", "figure_4", "figure_5"] {
        assert_eq!(read(name).targets[0].motion, polytope, "{name}");
    }
    assert!(is_ellipsoid(&read("figure_2").targets[0].motion));
    let both = read("figure_4");
    assert!(is_ellipsoid(&both.targets[1].motion));
    assert_eq!(both.own_ship.pose.position, Vector::new(50.0, 50.0));
    for (name, speed) in [
        ("figure_6", 5.0),
        ("figure_6_slower", 4.0),
        ("figure_6_slowest", 3.0),
    ] {
        let scene = read(name);
        assert_eq!(
            (scene.planner.facts().name, scene.own_ship.max_speed()),
            ("path-time", speed)
        );
        assert_eq!(scene.targets.len(), 3);
    }
    for name in ["7", "8_overtaking", "8_head_on", "8_stand_on", "8_give_way"] {
        let scene = read(&format!("figure_{name}"));
        let ship = scene.targets[0].ship().expect("a ship");
        assert_eq!(ship.domain, DomainKind::Paper, "{name}");
    }
}

const OPTIMAL_CONTROL: &str = r#"
title = "least"
horizon_s = 100
own_ship = { position = { east_m = 0, north_m = 0 }, course_deg = 90, speed_mps = 0.2, length_m = 1.255, beam_m = 0.29, turning_radius_m = 2 }
mission = { waypoints = [{ east_m = 0, north_m = 0 }, { east_m = 20, north_m = 0 }] }
[planner]
kind = "optimal-control"
"#;

fn settings(table: &str) -> Result<ControlSettings, Vec<String>> {
    let text = format!("{OPTIMAL_CONTROL}[planner.optimal_control]\n{table}");
    let faults = |faults: Vec<Fault>| faults.into_iter().map(|f| f.path).collect();
    Scenario::parse(&text)
        .map(|s| s.settings.optimal_control)
        .map_err(faults)
}

#[test]
fn the_vessel_is_as_long_as_own_ship() {
    for length in [0.5, 1.255, 30.0, 300.0] {
        let text = OPTIMAL_CONTROL.replace("1.255", &length.to_string());
        let found = Scenario::parse(&text).expect("valid").settings;
        let expected = ControlSettings::at_length(VesselKind::CyberShip2, length);
        assert_eq!(found.optimal_control, expected);
    }
}

#[test]
fn what_is_left_out_is_that_of_the_ship() {
    let default = ControlSettings::of(VesselKind::CyberShip2);
    assert_eq!(settings(""), Ok(default));
    assert_eq!(default.force_limits, ForceVector::new(2.0, 1.5, 1.5));
    // the same by another word
    let full = "vessel = \"cybership2-full\"";
    assert_eq!(settings(full), Ok(default));
    let given = "intervals = 80\nforce_limits = { surge_n = 1, sway_n = 0.5, yaw_nm = 0.25 }\n\
                 state_weights = [1, 2, 3, 4, 5, 6]\ncontrol_weights = [7, 8, 9]";
    let given = settings(given).expect("valid");
    assert_eq!(given.intervals, 80);
    assert_eq!(given.force_limits, ForceVector::new(1.0, 0.5, 0.25));
    assert_eq!(
        given.state_weights,
        StateVector::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
    );
    assert_eq!(given.force_weights, ForceVector::new(7.0, 8.0, 9.0));
}

/// A table, and the key of its fault.
const CONTROL_MISTAKES: &str = r#"
    vessel = "tanker" | vessel
    intervals = 0 | intervals
    intervals = 12.5 | intervals
    intervals = 2001 | intervals
    force_limits = { surge_n = 0, sway_n = 1, yaw_nm = 1 } | force_limits.surge_n
    force_limits = { surge_n = 1, sway_n = -1, yaw_nm = 1 } | force_limits.sway_n
    force_limits = { surge_n = 1, sway_n = 1 } | force_limits.yaw_nm
    state_weights = [1, 1, 1, 1, 1] | state_weights
    state_weights = [1, 1, -1, 1, 1, 1] | state_weights[2]
    state_weights = [0, 0, 0, 0, 0, 0] | state_weights
    control_weights = [1, 0, 1] | control_weights[1]
    control_weights = [1, nan, 1] | control_weights[1]
    weights = [1] | weights
"#;

#[test]
fn one_mistake_in_the_control_table_is_one_fault() {
    for [table, path] in rows(CONTROL_MISTAKES) {
        let path = format!("planner.optimal_control.{path}");
        assert_eq!(settings(table), Err(vec![path]), "{table}");
    }
}
