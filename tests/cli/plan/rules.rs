//! The rules: which planner keeps them, roles of a file, and thresholds.

use std::fs;

use crate::program::{Folder, HEAD_ON, document, json, list, number, rows, searoom, untimed};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};
use serde_json::{Value, json};

#[test]
fn rules_are_kept_by_the_space_time_planner_alone() {
    let folder = Folder::new();
    let file = folder.write("ruled.toml", HEAD_ON);
    searoom(&["plan", &file])
        .code(0)
        .stdout(contains("relaxed").not());
    // another planner on the command line keeps the domains in their place
    let other = searoom(&["plan", &file, "--planner", "path-time", "--json"]);
    assert_eq!(document(&other)["compliance"], "shape");
    let asked = HEAD_ON.replacen("[planner]", "[planner]\nkind = \"path-time\"", 1);
    let asked = folder.write("asked.toml", asked);
    searoom(&["plan", &asked])
        .code(2)
        .stdout(is_empty())
        .stderr(contains("planner.compliance").and(contains("path-time")));
    let unknown = folder.write("unknown.toml", HEAD_ON.replacen("rules", "rule", 1));
    searoom(&["plan", &unknown])
        .code(2)
        .stderr(contains("planner.compliance").and(contains("\"none\", \"shape\", \"rules\"")));
}

#[test]
fn limits_of_risk_and_of_ample_time_can_be_set() {
    let folder = Folder::new();
    let scenario = fs::read_to_string("scenarios/colregs/give-way.toml").expect("a scenario");
    let plan = |limit: &str| {
        let text = scenario.replace("[planner]", &format!("[planner]\n{limit}"));
        let file = folder.write("limits.toml", text);
        json(&format!("plan {file} --json"))
    };
    let lead = |plan: &Value| plan["encounters"][0]["manoeuvre"]["lead_s"].as_f64();
    let early = plan("");
    assert_eq!(early["thresholds"], "searoom");
    let late = plan("ample_time_s = 110.0");
    let limits = "searoom, with the limits of the scenario";
    assert_eq!(late["thresholds"], limits);
    assert!(lead(&early) > Some(125.0) && lead(&late) > Some(105.0));
    assert!(lead(&late) < Some(115.0));
    // collision is risk at any distance; ships that pass at 60 m are not at a limit of 50 m, but the
    // set of this one is met: own ship alters for it, so it has a role
    let nearest = plan("cpa_limit_m = 0.0");
    assert_eq!(nearest["encounters"][0]["role"], "give-way");
    let aside = |limit: &str| {
        let text = scenario
            .replace("[planner]", &format!("[planner]\n{limit}"))
            .replace("safety_margin_m = 20.0", "safety_margin_m = 2.0")
            .replace("north_m = -750.0", "north_m = -600.0");
        assert!(text.contains("-600.0"), "the target is moved");
        let file = folder.write("aside.toml", text);
        let plan = json(&format!("plan {file} --json"));
        assert_eq!(plan["encounters"][0]["role"], "give-way", "{limit}");
        plan["targets"][0]["ship"]["cpa_limit_m"].as_f64()
    };
    assert!(aside("cpa_limit_m = 50.0").is_some_and(|limit| limit > 60.0));
    assert_eq!(aside("cpa_limit_m = 150.0"), None);
}

/// Keys of a target, and their fault.
const ROLE_FAULTS: &str = r#"
role = "captain" | targets[0].role: found the text "captain"
role = "stand-on"\nrole_since_s = 91.0 | a number from 0 to 90
role_since_s = 5.0 | targets[0].role_since_s: found 5
"#;

#[test]
fn roles_of_a_file_last() {
    let folder = Folder::new();
    let with = |keys: &str| {
        let text = HEAD_ON.replace("name = \"target\"", &format!("name = \"target\"\n{keys}"));
        let text = text.replace("horizon_s", "time_s = 90.0\nhorizon_s");
        folder.write("roles.toml", text)
    };
    // head-on by geometry
    let file = with("role = \"stand-on\"\nrole_since_s = 30.0\nfirst_course_deg = 85.0");
    let plan = document(&searoom(&["plan", &file, "--json"]));
    assert_eq!(plan["encounters"][0]["role"], "stand-on");
    assert_eq!(plan["encounters"][0]["roles"][0]["from_s"], -60.0);
    for [keys, message] in rows(ROLE_FAULTS) {
        let file = with(&keys);
        searoom(&["check", &file]).code(2).stderr(contains(message));
    }
}

#[test]
fn the_rules_are_judged_by_what_is_asked_for() {
    let folder = Folder::new();
    let stand_on = "scenarios/colregs/stand-on.toml";
    let plan = |args: &[&str]| {
        let all = [&["plan", stand_on, "--json"], args].concat();
        untimed(document(&searoom(&all).success()))
    };
    let usual = plan(&[]);
    assert_eq!(usual["thresholds"], "searoom");
    assert_eq!(plan(&["--thresholds", "searoom"]), usual);
    // who wants five lengths between the ships sees a near miss in the same plan
    let text_of =
        |lines: &str| format!("name = 'mine'\nsource = 'a test'\nlike = 'searoom'\n{lines}");
    let near = "near_miss_lengths = 5\nleast_lengths = 10\npreferred_lengths = 20";
    let file = folder.write("mine.toml", text_of(near));
    let mine = plan(&["--thresholds", &file]);
    assert_eq!(mine["thresholds"], "mine");
    assert_eq!(mine["trajectory"], usual["trajectory"]);
    let safety = |plan: &Value| number(&plan["encounters"][0]["scores"]["safety"]);
    let [usual, mine] = [usual, mine].map(|plan| safety(&plan));
    assert!(usual > 0.5 && mine < usual - 0.1, "{mine}");
    searoom(&["suite", stand_on, "--thresholds", "sfi-autoship"]).success();
}

#[test]
fn a_comparison_says_what_each_method_breaks_by_the_thresholds_asked_for() {
    let folder = Folder::new();
    let compared = |options: &str| {
        let asked = "compare scenarios/paper/figure_8_stand_on.toml --json";
        let compared = json(&format!("{asked} {options}"));
        compared["comparisons"][0]["entries"].clone()
    };
    let usual = compared("");
    let of = |method: &str, entries: &Value| {
        let mut entries = list(entries).iter();
        let entry = entries.find(|e| e["method"] == method).expect("one");
        entry["breaks"].clone()
    };
    assert_eq!(of("space-time, A*", &usual), json!(["17(c)"]));
    assert_eq!(of("path-time", &usual), json!([]));
    // the hulls meet
    assert_eq!(of("hold course", &usual), json!(["17(b)", "R1", "S"]));
    // to whom no turn is one, none is to port
    let text = "name = 'mine'\nsource = 'a test'\nlike = 'searoom'\nsteady_deg = 180";
    let file = folder.write("mine.toml", text);
    let mine = compared(&format!("--thresholds {file}"));
    assert_eq!(of("space-time, A*", &mine), json!([]));
    for (usual, mine) in list(&usual).iter().zip(list(&mine)) {
        assert_eq!(usual["track"], mine["track"]);
    }
}

#[test]
fn thresholds_that_are_wrong_are_named() {
    let folder = Folder::new();
    let faulty = "name = 'mine'\nsource = 'a'\nlike = 'searoom'\nhead_on_deg = 200\nhold = 1";
    folder.write("mine.toml", faulty);
    folder.write("long.toml", "#".repeat(1_100_000));
    let all = "allowed: searoom, dnv-trafficgen, sfi-autoship, or a file that is there";
    let number = "line 4: head_on_deg: found 200; allowed: a number from 0 to 180";
    let unknown = "line 5: hold: found an unknown key, perhaps for 'hold_deg'";
    let plan = "plan scenarios/colregs/stand-on.toml --thresholds";
    folder.refuses(&format!(
        "
        {plan} nobody | {all}
        {plan} DIR/mine.toml | {number} | mine.toml: 2 faults | {unknown}
        {plan} DIR | cannot be read
        {plan} DIR/long.toml | found more than 1 MiB
        suite --lint scenarios/colregs/stand-on.toml --thresholds searoom |
        compare scenarios/colregs --thresholds nobody | allowed: searoom, dnv-trafficgen, sfi-autoship
        "
    ));
}

/// A ship that passes at 250 m, beyond the limit, but whose set reaches own ship's way; and that set.
#[test]
fn the_block_of_a_target_says_why_it_has_a_role_or_none() {
    let folder = Folder::new();
    let scene = |limit: &str| {
        format!(
            "title = \"Far coaster\"\nhorizon_s = 700.0\n{limit}\n[own_ship]\n\
             position = {{ east_m = 0.0, north_m = 0.0 }}\ncourse_deg = 90.0\nspeed_mps = 5.0\n\
             length_m = 30.0\nbeam_m = 8.0\nturning_radius_m = 100.0\n[mission]\n\
             waypoints = [{{ east_m = 0.0, north_m = 0.0 }}, {{ east_m = 2500.0, north_m = 0.0 }}]\n\
             [[targets]]\nname = \"coaster\"\nposition = {{ east_m = 1350.0, north_m = -1000.0 }}\n\
             course_deg = 0.0\nspeed_mps = 5.0\nlength_m = 60.0\nbeam_m = 12.0\n\
             speed_spread_mps = 0.6\ncourse_spread_deg = 6.0\n"
        )
    };
    let note = "passes beyond the limits, but own ship alters for its set";
    let role = "'coaster': own ship is give-way";
    let file = folder.write("far.toml", scene(""));
    let far = contains(role)
        .and(contains(note))
        .and(contains("starboard"));
    searoom(&["plan", &file]).success().stdout(far);
    let lint = ["suite", "--lint", &file];
    searoom(&lint).success().stdout(contains("give-way"));
    let file = folder.write("near.toml", scene("planner = { cpa_limit_m = 400.0 }"));
    let near = contains(role).and(contains(note).not());
    searoom(&["plan", &file]).success().stdout(near);
    let text = scene("planner = { compliance = \"rules\" }");
    let ship = text
        .find("position = { east_m = 1350.0")
        .expect("the coaster");
    let set = "initial_set = { vertices_m = [[1250, -1100], [1450, -1100], [1450, -900], \
               [1250, -900]] }\nvelocity_set = { vertices_mps = [[-0.6, 4.4], [0.6, 4.4], \
               [0.6, 5.6], [-0.6, 5.6]] }\n[[targets]]\nname = \"far off\"\nposition = \
               { east_m = 0.0, north_m = 9000.0 }\ncourse_deg = 0.0\nspeed_mps = 5.0\n\
               length_m = 60.0\nbeam_m = 12.0\n";
    let file = folder.write("set.toml", format!("{}{set}", &text[..ship]));
    let text =
        "gives no role: the rules do not restrict the alteration for it, as it is given as a set";
    searoom(&["plan", &file]).success().stdout(contains(text));
}
