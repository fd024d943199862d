//! Plan documents that the check accepts, and its message for anything else.

use searoom::document::PlanDocument;
use searoom::pipeline;
use searoom::scenario::Scenario;
use searoom::verification::verify;
use serde_json::{Value, json};

use crate::alter::{alter, at, list, rows};
use crate::documents::{checked, document, documents, file, numbers, scenario, text};

#[test]
fn what_was_planned_passes() {
    let mut count = 0;
    for folder in ["colregs", "harbour", "paper", "uncertainty"] {
        for entry in std::fs::read_dir(file(folder)).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.extension().is_none_or(|e| e != "toml") {
                continue;
            }
            let found = checked(&document(Scenario::read(&path).expect("a scenario")));
            assert!(found.verified(), "{path:?}: {:#?}", found.violations);
            let evaluation = found.evaluation.expect("a plan");
            assert_eq!(evaluation.passages.len(), found.targets.len());
            assert!(evaluation.passages.iter().all(|p| p.min_margin >= -1e-6));
            count += 1;
        }
    }
    assert!(count >= 14, "{count}");
    for (name, document) in documents() {
        let found = checked(&document);
        assert!(found.verified(), "{name}: {:#?}", found.violations);
    }
}

/// Checks a plan of a million seconds (11.5 days), the maximum length. The sample interval grows
/// just enough to limit the file size.
#[test]
fn a_plan_of_a_million_seconds_is_written_and_checked() {
    let text = text("long", 1e6, &[[0.0, 0.0], [4.9e6, 0.0]], "");
    let written = document(Scenario::parse(&text).expect("a scenario"));
    let samples = "/trajectory/samples";
    let count = written.pointer(samples).and_then(Value::as_array);
    assert!((19_000..20_010).contains(&count.expect("samples").len()));
    assert!(written.to_string().len() < 8 << 20);
    let found = checked(&written);
    assert!(found.violations.is_empty(), "{:?}", found.violations);
    let mut gap = written;
    list(&mut gap, samples).remove(700);
    let found = checked(&gap);
    assert!(
        found
            .violations
            .iter()
            .any(|v| v.what.contains("samples[700]"))
    );
}

const REFUSED: &str = r#"
another format | /format = "other/2" | format: found 'other/2'; allowed: searoom-plan/1
no time | /horizon_s = -1.0 | horizon_s: found -1; allowed: a positive number
certain contact | /max_risk = 1.0 | max_risk: found 1
a word | /trajectory/segments/3/speed_mps = "fast" | trajectory.segments[3].speed_mps: invalid type: string
no targets | /targets remove | missing field `targets`
no radius | /own_ship/turning_radius_m = 0.0 | own_ship.turning_radius_m: found 0; allowed: a positive number
too fast | /own_ship/speed_mps = 101.0 | own_ship.speed_mps
no speed | /own_ship/speeds_mps = [] | own_ship.speeds_mps: found no speed above 0
no waypoint | /mission/waypoints = [] | mission.leg_speeds_mps: found 1 speeds for 0 waypoints
one waypoint | /mission/waypoints/last remove; /mission/leg_speeds_mps = [] | mission: found what makes no way
no set | /obstacles/0/initial_set = {} | obstacles[0].initial_set: found neither
no validity | /obstacles/0/valid_s = [5.0, 5.0] | obstacles[0].valid_s: found 5 to 5
a box | /targets/0/representation = "box" | targets[0].representation: found 'box'
planner | /planner = "x" | planner: found 'x'; allowed: space-time, path-time, optimal-control
compliance | /compliance = "x" | compliance: found 'x'; allowed: none, shape, rules
objective | /objective = "x" | objective: found 'x'; allowed: space-time-error, time, length, length-risk, stage-cost
outcome | /outcome = "x" | outcome: found 'x'; allowed: solved, relaxed, infeasible, deadline
search | /search = "x" | search: found 'x'; allowed: a-star, dijkstra, thorough
no word | /search = 3 | search: found 3; allowed: a-star, dijkstra, thorough
null for a word | /compliance = null | compliance: found null; allowed: none, shape, rules
a truth value for a word | /outcome = true | outcome: found true; allowed: solved, relaxed
a number for a word | /objective = 1.5 | objective: found 1.5; allowed: space-time-error
a negative number for a word | /relaxations = [{"kind": -1, "target": "target", "amount": 1}] | relaxations[0].kind: found -1; allowed: compliance
null for a planner | /planner = null | planner: found null; allowed: space-time, path-time, optimal-control
a list for a word | /targets/0/representation = [1] | expected one of polytope, ellipsoid
null for a format | /format = null | format: found null; allowed: searoom-plan/1
method | /method = "x" | method: found 'x'; allowed: rules, a-star,
role | /encounters/0/role = "x" | encounters[0].role: found 'x'; allowed: head-on, give-way,
side | /encounters/0/passing_side = "x" | encounters[0].passing_side: found 'x'; allowed: port, starboard
monitor | /encounters/0/monitors/1/monitor = "x" | encounters[0]: monitors[1].monitor: found 'x'; allowed: S, R1, R3
verdict | /encounters/0/monitors/0/verdict = "x" | verdict: found 'x'; allowed: satisfied, violated, idle, undecided
rule | /encounters/0/violations = [{"rule": "99", "what": "", "t_s": 0}] | violations[0].rule: found '99'; allowed: 13, 14(a)
no conduct | /encounters/0/monitors remove | encounters[0]: missing field `monitors`
phase | /phases/0/phase = "x" | phases[0].phase: found 'x'; allowed: free, hold, out, parallel, back
no motion | /trajectory/segments = null | trajectory.segments: found null without optimal_control
land | /land = [[[0.0, 0.0], [1.0, 1.0]]] | land[0]: found
kind | /relaxations = [{"kind": "bogus", "target": "target", "amount": 1}] | relaxations[0].kind: found 'bogus'; allowed: compliance, domain, risk, arrival
nobody | /relaxations = [{"kind": "risk", "target": "nobody", "amount": 0.9}] | relaxations[0].target: found 'nobody'; allowed: target
amount | /relaxations = [{"kind": "domain", "target": "target", "amount": -5}] | relaxations[0].amount: found -5; allowed: a number that is not negative
"#;

#[test]
fn what_is_no_plan_document_is_named() {
    let original = document(scenario("colregs/head-on.toml"));
    let refused = |document: &Value, expected: &str| {
        let error = verify(&document.to_string())
            .expect_err(expected)
            .to_string();
        assert!(error.contains(expected), "{error}");
    };
    for [_, edits, expected] in rows(REFUSED) {
        let mut document = original.clone();
        alter(&mut document, edits);
        refused(&document, expected);
    }
    assert!(verify("").is_err() && verify("[1, 2]").is_err() && verify("{} x").is_err());
    // no file content may cause a panic
    let text = original.to_string();
    for end in (0..text.len()).step_by(997) {
        assert!(verify(text.get(..end).unwrap_or("")).is_err());
    }
}

#[test]
fn no_number_makes_the_check_panic() {
    for (_, document) in documents() {
        let mut pointers = Vec::new();
        numbers(&document, "", &mut pointers);
        let stride = (pointers.len() / 60) | 1;
        for (index, pointer) in pointers.iter().step_by(stride).enumerate() {
            let hostile = [1e300, -1e300, 0.0, 1e-300, -1.0][index % 5];
            let mut document = document.clone();
            *at(&mut document, pointer) = json!(hostile);
            let _ = verify(&document.to_string());
        }
    }
}

#[test]
fn a_document_without_a_plan_is_not_verified_and_not_refused() {
    let mut scenario = scenario("colregs/head-on.toml");
    scenario.horizon = 100.0;
    let run = pipeline::run(scenario);
    let text = serde_json::to_string(&PlanDocument::of(&run)).expect("a document");
    let found = verify(&text).expect("a document");
    assert!(!found.verified() && found.evaluation.is_none() && found.violations.is_empty());
}
