//! Altered settings, sets and figures: every one is detected.

use searoom::scenario::Scenario;
use searoom::verification::verify;
use serde_json::{Value, json};

use crate::alter::{alter, assert_rejected, assert_word, give_up, list, rows};
use crate::documents::{checked, document, fault, give_way_at_risk, inside, is_caught, scenario};

/// Alterations that increase the danger.
const SETTING: &str = r#"
a set less | /obstacles/0 remove |
a set for nobody | /obstacles/0/name = "nobody" | no target
a target less | /targets/0 remove |
no sets and no targets | /obstacles = []; /targets = [] | encounters
no targets at all | /obstacles = []; /targets = []; /encounters = [] | cost.min_clearance_m
a set that ends before the horizon | /obstacles/0/valid_s/1 + -300 |
a set that begins late | /obstacles/0/valid_s/0 + 1 | valid from
a turning radius above the plan's | /own_ship/turning_radius_m * 1.000001 | turning radius
a turn on the spot | /trajectory/segments/*/speed_mps = 0 | turning radius
a speed that own ship has not | /own_ship/speeds_mps/* * 0.9 | speed
a horizon before arrival | /horizon_s = 100 | arrival time
own ship elsewhere | /own_ship/position/north_m + 0.01 | start position
own ship on another course | /own_ship/course_deg + 0.01 | start heading
a longer ship | /own_ship/length_m + 5 | cost.min_clearance_m
a wider margin | /own_ship/safety_margin_m + 300 | too small for the hull
another mission | /mission/waypoints/1/north_m + 1 | arrival
a target elsewhere | /targets/0/ship/position/north_m + 100 | encounter
a longer target | /targets/0/ship/length_m + 200 | too small for the hull
a target less well known | /targets/0/ship/position_std_m + 40 | too small for the hull
a target on another course | /targets/0/ship/course_deg + 1 | too small for the velocities of the target
a faster target | /targets/0/ship/speed_mps + 0.1 | too small for the velocities of the target
more course spread | /targets/0/ship/course_spread_deg + 1 | too small for the velocities of the target
more speed spread | /targets/0/ship/speed_spread_mps + 0.1 | too small for the velocities of the target
a target that may turn to starboard | /targets/0/ship/starboard_turn_deg + 2 | too small for the velocities of the target
a target that may turn | /targets/0/ship/turn_rate_deg_per_s + 0.1 | too small for the velocities of the target
a set over the plan | /obstacles/0/initial_set/vertices_m/*/0 * 1.2; /obstacles/0/initial_set/vertices_m/*/1 * 5 | set of 'target'
fewer velocities | /obstacles/0/velocity_set/vertices_mps/*/1 * 0.9 | too small for the velocities of the target
one encounter less | /encounters/0 remove | encounters
a mission that was not fulfilled | /cost/arrived = false | cost.arrived
no cost | /cost = null | cost
samples cut off | /trajectory/samples/last remove | samples
a sample cut out | /trajectory/samples/40 remove | samples
no samples | /trajectory/samples = [] | samples
"#;

/// Alterations of slabs, entered sets, risk, land, forces and paths.
const TURNING: &str = r#"
a slab less | /obstacles/1 remove | valid from
the last slab less | /obstacles/last remove | valid until
a slab elsewhere | /obstacles/1/initial_set/vertices_m/0/0 + 0.1 |
a slab that lags | /obstacles/1/initial_set/vertices_m/*/1 + 5 | does not begin with the final section
a target that turns faster | /targets/0/ship/turn_rate_deg_per_s * 1.2 | too small for the velocities of the target
"#;
const TIMED_SETS: &str = r#"
velocities that begin earlier | /targets/0/velocity_sets/0/until_s + -20 | too small for the velocity set
a larger set | /targets/0/initial_set/vertices_m/0/0 * 1.5 |
"#;
const ELLIPSES: &str = r#"
a larger target | /targets/0/initial_set/shape_m2/0/0 * 1.1 | too small for the initial set
a faster target | /targets/0/velocity_sets/0/shape_m2_per_s2/1/1 * 1.1 | too small for the velocity set
a larger ellipse | /obstacles/0/initial_set/shape_m2/*/* * 9 | set of 'tracked': distance
"#;
const ROUTE: &str = r#"
a later turn | /targets/0/ship/route/0/to/east_m + -60 | too small for the velocities of the target
a turn beyond | /targets/0/ship/route/1/to/east_m + -300 | too small for the velocities of the target
a faster leg | /targets/0/ship/route/1/speed_mps + 0.5 | too small for the velocities of the target
no route | /targets/0/ship/route = [] | too small for the velocities of the target
"#;
const RISK: &str = r#"
less risk than was taken | /cost/max_risk * 0.9 | cost.max_risk
less risk accepted | /max_risk = 0.1 |
more risk accepted | /max_risk = 0.6 |
no risk | /cost/max_risk = 0 | cost.max_risk
"#;
const LAND: &str = r#"
a margin to land that is not kept | /own_ship/land_margin_m = 70 | land
land moved | /land/*/*/1 + 60 | land
farther from land | /cost/min_land_distance_m + 1 | cost.min_land_distance_m
nearer to land | /cost/min_land_distance_m * 0.5 | min_land_distance_m
a waypoint passed nearer | /cost/waypoint_distances_m/0 * 0.9 | cost.waypoint_distances_m[0]
no waypoint passed | /cost/waypoint_distances_m = [] | cost.waypoint_distances_m, length
no land to be far from | /cost/min_land_distance_m = null | cost.min_land_distance_m
"#;
const FIGURE_9: &str = r#"
weaker engines | /optimal_control/force_limits/surge_n * 0.01 | surge force
a weaker rudder | /optimal_control/force_limits/yaw_nm * 0.01 | yaw moment
a cheaper plan | /cost/objective * 0.9999 | cost.objective
other weights | /optimal_control/control_weights/1 * 1.001 | cost.objective
a ship of another size | /own_ship/length_m * 1.01 | off the plan
an error counted for longer | /cost/space_time_error_until_s * 1.01 | cost.space_time_error_until_s
a larger ellipse | /obstacles/0/initial_set/shape_m2/*/* * 1.5 | set of
"#;
const CANAL: &str = r#"
off the path | /mission/waypoints/1/east_m + 0.5 | path
a slower ship | /own_ship/speeds_mps/* * 0.5 | speed
"#;
/// Own ship stops before the set over its last waypoint.
const SHORT_OF_END: &str = r#"
another ship in the way | /relaxations/0/target = "crossing" | relaxation of arrival, target
more left | /relaxations/0/amount = 5000 | relaxation of arrival, amount
less left | /relaxations/0/amount = 100 | relaxation of arrival, amount
no arrival given up | /relaxations/0 remove | arrival
arrived | /cost/arrived = true | cost.arrived
"#;

#[test]
fn every_altered_setting_is_caught() {
    let original = document(scenario("colregs/head-on.toml"));
    assert_rejected(&original, SETTING);
    let mut swapped = original;
    list(&mut swapped, "/trajectory/samples").swap(30, 31);
    assert_word(&swapped, "samples in another order", "samples");
}

#[test]
fn what_only_some_plans_have_is_held_too() {
    let turning = document(scenario("uncertainty/turning.toml"));
    let slabs = turning["obstacles"].as_array();
    assert!(slabs.is_some_and(|slabs| slabs.len() > 1));
    assert_rejected(&turning, TURNING);
    let route = document(scenario("uncertainty/known-route.toml"));
    assert_rejected(&route, ROUTE);
    let mut late = route.clone();
    late["targets"][0]["ship"]["time_spread_s"] = json!(10.0);
    assert_word(
        &late,
        "turns at another time",
        "too small for the velocities of the target",
    );
    let mut turns = route;
    turns["targets"][0]["ship"]["turn_rate_deg_per_s"] = json!(2.0);
    let refused = verify(&turns.to_string()).expect_err("a turn beside a route");
    assert!(
        refused.to_string().contains("targets[0].ship.route"),
        "{refused}"
    );
    assert_rejected(
        &document(scenario("uncertainty/changing-velocities.toml")),
        TIMED_SETS,
    );
    assert_rejected(&document(scenario("uncertainty/ellipse.toml")), ELLIPSES);
    assert_rejected(&give_way_at_risk(0.4), RISK);
    assert_rejected(&document(scenario("harbour/munkholmen.toml")), LAND);
    assert_rejected(&document(scenario("harbour/canal-transit.toml")), CANAL);
    let moored = Scenario::parse(&fault("moored-at-the-end.toml")).expect("a scenario");
    assert_rejected(&document(moored), SHORT_OF_END);
    let forces = document(scenario("paper/figure_9.toml"));
    assert_rejected(&forces, FIGURE_9);
    let has_force = |s: &Value| s["surge_n"].is_number();
    let mut weaker = forces.clone();
    for sample in list(&mut weaker, "/trajectory/samples") {
        if let Some(surge) = sample["surge_n"].as_f64() {
            sample["surge_n"] = json!(0.9 * surge);
        }
    }
    assert_word(&weaker, "other forces", "off the plan");
    let mut fewer = forces;
    let nodes = list(&mut fewer, "/trajectory/samples");
    let late = |s: &&mut Value| s["t_s"].as_f64() > Some(20.0) && has_force(s);
    let node = nodes.iter_mut().find(late).expect("one");
    node.as_object_mut().expect("a sample").remove("surge_n");
    assert_word(&fewer, "a node less", "off the plan");
}

const CLAIMS: &str = r#"
solved as infeasible | /outcome = "infeasible" | outcome
solved as relaxed | /outcome = "relaxed" | outcome
no plan | /trajectory = null; /cost = null | it is infeasible or deadline
as of forces | /planner = "optimal-control" | planner
land where none is | /cost/min_land_distance_m = 7 | min_land_distance_m
another objective | /objective = "stage-cost" | objective
another planner's objective | /objective = "length-risk" | objective
not safe | /safe = false | safe: the document says false, it is true
nothing of its safety | /safe remove | safe: the document says nothing, it is true
another word | /verdict = "solved, and clear of all" | verdict: the document says solved, and
"#;

/// Compliance, requirements given up, and what is said of them.
const GIVEN_UP: &str = r#"
shape | risk 0 | amount: the document says 0, it is nothing
shape | compliance 1 | not possible with compliance 'shape'
none | domain 1 | not possible with compliance 'none'
shape | domain 1, domain 2 | 'domain' twice
shape | domain 0 | reduced by 0
"#;

/// Another word for what made a plan by the rules.
const METHODS: &str = r#"
by another search | /method = "dijkstra" | method
by the other planner | /method = "path-time-graph"; /search_stats/expanded = 3 | method
by nothing known | /method = "magic" |
by the rules without a search | /search_stats/expanded = null | method
by rules that are not asked | /compliance = "shape" | method
without a plan | /trajectory = null | method
nothing of it | /method = null | method: the document says nothing, it is that of a plan
no such key | /method remove | method: the document says nothing, it is that of a plan
"#;

/// Another result of the verification that the document reports of itself, and other kinds of sets.
const ITS_OWN: &str = r#"
not verified | /verified = false | verified: the document says false, it is true
with violations | /violations = [{"what": "a lie", "t_s": 1}] | violations: the document says 1 of them, first 'a lie', it is none
an ellipsoid of polygons | /targets/0/representation = "ellipsoid" | found polygons; allowed with representation 'ellipsoid': ellipses
"#;

/// Other units of the risk that is taken.
const UNITS: &str = r#"
risk in metres | /relaxations/0/unit = "m" | unit: the document says m, it is '1' for 'risk'
nothing of the unit | /relaxations/0/unit remove | unit: the document says nothing, it is '1' for 'risk'
null | /relaxations/0/unit = null | unit: the document says nothing, it is '1' for 'risk'
"#;

/// Checks that the words of a document agree with its content, and that figures independent of the
/// motion are recomputed.
#[test]
fn every_claim_of_a_document_is_held() {
    let clear = document(scenario("colregs/head-on.toml"));
    assert_rejected(&clear, CLAIMS);
    let relaxed = inside();
    assert_eq!(relaxed["outcome"], "relaxed");
    assert_rejected(
        &relaxed,
        r#"relaxed as solved | /outcome = "solved" | outcome
        relaxed as infeasible | /outcome = "infeasible" | outcome
        safe within a set | /safe = true | safe: the document says true, it is false
        claimed from too early | /relaxations/0/until_s + -1; /obstacles/0/valid_s/0 + -1 | set of
        a set that has shrunk | /obstacles/0/initial_set/vertices_m/*/0 + 1 | the positions possible"#,
    );
    for file in ["harbour/ferry-crossing.toml", "forces/give-way.toml"] {
        let free = r#"as free | /planner = "space-time" | planner"#;
        assert_rejected(&document(scenario(file)), free);
    }
    for [compliance, given_up, word] in rows(GIVEN_UP) {
        let mut document = clear.clone();
        document["compliance"] = json!(compliance);
        document["outcome"] = json!("relaxed");
        for given_up in given_up.split(", ") {
            let (kind, amount) = given_up.split_once(' ').expect("an amount");
            let amount = amount.parse().expect("a number");
            give_up(&mut document, kind, "target", amount);
        }
        assert_word(&document, word, word);
    }
    assert_rejected(&clear, METHODS);
    assert_rejected(&clear, ITS_OWN);
    assert_rejected(&relaxed, UNITS);
    let mut without_a_plan = clear.clone();
    alter(
        &mut without_a_plan,
        r#"/trajectory = null; /cost = null; /method = null; /search_stats/expanded = null;
           /outcome = "infeasible"; /verdict = "infeasible"; /safe = false"#,
    );
    assert_word(
        &without_a_plan,
        "no plan",
        "verified: the document says true, it is false",
    );
    alter(&mut without_a_plan, "/verified = false");
    let found = checked(&without_a_plan);
    assert!(found.violations.is_empty() && !found.verified());
    let mut late = clear;
    for outcome in ["solved", "deadline"] {
        alter(
            &mut late,
            &format!("/outcome = \"{outcome}\"; /verdict = \"{outcome}\""),
        );
        assert!(!is_caught(&late), "{outcome}");
    }
}
