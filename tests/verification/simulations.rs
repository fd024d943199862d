//! Altered documents of simulations: plans that are left out, with other settings that would hide it,
//! and statements that the rest of the document contradicts.

use searoom::scenario::Scenario;
use searoom::simulation::Simulation;
use searoom::verification::{verify, verify_simulations};
use serde_json::{Value, json};

use crate::alter::{alter, list, rows};
use crate::documents::{document, fault, parsed, scenario};

/// The document of a scenario that is sailed to its end, which verifies.
fn sailed(scenario: Scenario) -> Value {
    let mut simulation = Simulation::new(scenario, false).expect("a scenario for the loop");
    while !simulation.finished() {
        simulation.step();
    }
    let document = serde_json::to_value(simulation.record()).expect("a document");
    assert_eq!(violations(&document), [""; 0]);
    document
}

fn violations(document: &Value) -> Vec<String> {
    let found = verify_simulations(&document.to_string()).expect("a document of a simulation");
    let found = found.into_iter().flat_map(|checked| checked.violations);
    found.map(|violation| violation.what).collect()
}

fn assert_rejected(original: &Value, table: &'static str) {
    for [what, edits, word] in rows(table) {
        let mut document = original.clone();
        alter(&mut document, edits);
        let found = violations(&document);
        assert!(found.iter().any(|v| v.contains(word)), "{what}: {found:#?}");
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// A target comes within range, which asks for a plan between two periods.
fn with_an_event() -> Value {
    let text = fault("target-seen-late.toml");
    let (before, _) = text.split_once("sensor = ").expect("a sensor, last");
    let sensor = "sensor = { kind = \"exact\", range_m = 1100 }\nreplan = \"events\"";
    let mut scenario = parsed(&format!("{before}{sensor}"));
    scenario.simulation.delay = 5.0;
    let document = sailed(scenario);
    let plans = document["replans"].as_array().expect("plans");
    let is_event = |plan: &Value| plan["reason"] == "acquired: late";
    assert!(plans.iter().any(is_event));
    document
}

/// Events ask for a plan when own ship's ends before another could take effect, so that none is made: the steps
/// then do not begin anew when the period ends.
#[test]
fn events_that_make_no_plan_leave_the_document_sound() {
    sailed(parsed(&fault("event-after-the-last-plan.toml")));
}

/// Every plan but the first is left out in turn, with all that was said when it was made. No longer
/// period or step explains that it is missing. The plans of a mission in parts end short, so that
/// the next ones are due early.
#[test]
fn a_plan_that_is_left_out_is_missed_with_any_period_and_step() {
    let parts = sailed(parsed(&fault("longer-than-its-horizon.toml")));
    let early = sailed(parsed(&fault("moored-at-the-end.toml")));
    let period = number(&early["settings"]["replan_s"]);
    let times = list(&mut early.clone(), "/replans").clone();
    let is_early =
        |pair: &[Value]| number(&pair[1]["t_s"]) - number(&pair[0]["t_s"]) < period - 1.0;
    assert!(times.windows(2).any(is_early));
    for document in [
        sailed(scenario("colregs/head-on.toml")),
        parts,
        early,
        with_an_event(),
    ] {
        let period = number(&document["settings"]["replan_s"]);
        let count = list(&mut document.clone(), "/replans").len();
        for left_out in 1..count {
            let mut without = document.clone();
            let plan = list(&mut without, "/replans").remove(left_out);
            list(&mut without, "/timing/plan_s").remove(left_out);
            list(&mut without, "/alarms").retain(|alarm| alarm["t_s"] != plan["t_s"]);
            for (period, step) in [(1.0, 1.0), (1.5, 1.0), (2.0, 1.0), (2.0, 30.0), (1.0, 30.0)]
                .map(|(longer, step)| (longer * period, step))
            {
                without["settings"]["replan_s"] = json!(period);
                without["settings"]["step_s"] = json!(step);
                let found = violations(&without);
                let is_missed = |what: &String| {
                    [
                        "a plan at another time",
                        "plans are missing",
                        "a step or a delay longer",
                    ]
                    .contains(&&**what)
                };
                let what = &document["scenario"];
                assert!(
                    found.iter().any(is_missed),
                    "{what}: plan {left_out}, {period} s, {step} s: {found:#?}"
                );
            }
        }
    }
}

/// The times at which targets turn, alarms are raised and events ask for plans are those of steps.
#[test]
fn another_step_or_period_is_not_that_of_the_loop() {
    const SETTINGS: &str = "a longer step | /settings/step_s = 1000 | a step or a delay longer
        a longer period | /settings/replan_s * 1.25 | a plan at another time
        a shorter period | /settings/replan_s * 0.75 | a plan at another time
        a longer delay | /settings/delay_s + 1 | a plan that begins at another time";
    let turning = sailed(scenario("closed-loop/give-way-pursuit.toml"));
    let event = with_an_event();
    assert_rejected(&turning, SETTINGS);
    assert_rejected(&event, SETTINGS);
    let another = "a turn | /settings/step_s = 7.3 | a time between two steps";
    assert_rejected(&turning, another);
    let another = "an event | /settings/step_s = 7.3 | a plan at another time";
    assert_rejected(&event, another);
}

/// Statements that do not fit the rest of a document.
const STATEMENTS: &str = r#"
a plan without an end | /replans/1/end_s = null | a plan that ends at another time
a plan that ends before it begins | /replans/1/end_s = 1 | a plan that ends at another time
another end of the last plan | /replans/last/end_s + 1 | it ends neither with its plan
another cost of the first plan | /conduct/first_plan_cost_m2 * 1.1 | conduct.first_plan_cost_m2
no cost of the first plan | /conduct/first_plan_cost_m2 = null | conduct.first_plan_cost_m2
more turns | /conduct/turns = 9 | conduct.turns
more changes of speed | /conduct/speed_changes = 9 | conduct.speed_changes
a rule that is broken | /conduct/breaks = ["8(d)"] | conduct.breaks
lost remainders | /conduct/lost_remainders = 99 | more plans with another manoeuvre
replaced manoeuvres | /conduct/replaced_manoeuvres = 99 | more plans with another manoeuvre
switches of side | /conduct/side_switches = 1 | more plans with another manoeuvre
a manoeuvre after the end | /conduct/manoeuvres/0/from_s = 1e9 | a time of the conduct
far off later | /conduct/largest_off_plan_t_s = 1e9 | a time of the conduct
manoeuvres in disorder | /conduct/manoeuvres = [{"kind": "speed", "slower": true, "speed_mps": 1, "from_s": 50, "returns_s": null}, {"kind": "speed", "slower": true, "speed_mps": 1, "from_s": 20, "returns_s": null}] | manoeuvres in another order
not off its plan at a time | /conduct/largest_off_plan_m = 0; /conduct/largest_off_plan_t_s = 5 | off its plan by nothing
farther off its plan | /replans/2/off_plan_m = 1e3 | farther off its plan than ever
far from its end | /to_go_m = 400 | arrived: the document says true, it is false
not arrived | /arrived = false; /ends_short = true | arrived: the document says false, it is true
outside its velocities | /replans/1/outside_velocities = ["target"] | alarms, length
outside its places | /replans/1/outside_places = ["target"] | outside_sets[0]
outside more sets | /targets/0/outside_sets = 3 | outside_sets[0]
no such target | /replans/1/outside_velocities = ["nobody"] | names no target
an alarm for nobody | /alarms = [{"t_s": 20, "alarm": "stale", "target": "nobody"}] | names no target
an alarm without a cause | /alarms = [{"t_s": 20, "alarm": "no plan", "target": null}] | alarms, length
an alarm between steps | /alarms = [{"t_s": 20.3, "alarm": "stale", "target": "target"}] | between two steps
fewer times of planning | /timing/plan_s/last remove | other times of planning than plans
asked for by an alarm | /settings/replan_on_events = true; /replans/1/reason = "beyond the tracking margin" | replans[1].reason
asked for by a velocity | /settings/replan_on_events = true; /replans/1/reason = "another velocity: target" | replans[1].reason
asked for by a target | /settings/replan_on_events = true; /replans/1/reason = "acquired: target" | replans[1].reason
"#;

#[test]
fn statements_that_the_document_contradicts_are_found() {
    let head_on = sailed(scenario("colregs/head-on.toml"));
    assert!(head_on["arrived"] == true && head_on["alarms"] == json!([]));
    assert_rejected(&head_on, STATEMENTS);
    // a ship under forces arrives within own length
    let forces = sailed(scenario("forces/give-way.toml"));
    let edits =
        r#"far from its end | /to_go_m = 1e4; /arrived = true | arrived: the document says true"#;
    assert_rejected(&forces, edits);
}

/// The rest of the mission after the end of a plan is a length, and nothing with a stay.
#[test]
fn a_plan_leaves_out_a_length_of_its_mission() {
    let mut plan = document(scenario("colregs/head-on.toml"));
    let refused = |plan: &Value| {
        verify(&plan.to_string())
            .err()
            .map(|error| error.to_string())
    };
    plan["mission"]["left_out_m"] = json!(5.0);
    assert_eq!(refused(&plan), None);
    plan["mission"]["stay_until_s"] = plan["horizon_s"].clone();
    let found = refused(&plan).expect("a stay at an intermediate end");
    assert!(found.contains("mission.left_out_m: found 5"), "{found}");
    plan["mission"]["left_out_m"] = json!(-1.0);
    let found = refused(&plan).expect("less than nothing");
    assert!(found.contains("mission.left_out_m: found -1"), "{found}");
}
