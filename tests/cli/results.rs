//! Uses of results: verifying, comparing, reporting, recording and inspecting.

use std::fs;

use super::program::{
    Folder, document, json, list, number, run, says, searoom, stdout, text, untimed,
};
use assert_cmd::Command;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};
use serde_json::{Value, json};

#[test]
fn plans_that_a_suite_wrote_are_verified_and_altered_ones_rejected() {
    let folder = Folder::new();
    let plans = text(folder.path()).to_owned();
    searoom(&["suite", "scenarios/colregs", "--plans", &plans]).success();
    let file = |name: &str| format!("{plans}/{name}.json");
    let four = ["give-way", "head-on", "overtaking", "stand-on"].map(file);
    run(&format!("verify {}", four.join(" ")))
        .success()
        .stderr(is_empty())
        .stdout(contains("Head-on: verified, safe").and(contains("margin")));
    searoom(&["verify", &plans])
        .success()
        .stdout(contains("4 documents: 4 verified, 4 safe"));
    let empty = Folder::new();
    searoom(&["verify", text(empty.path())])
        .code(2)
        .stderr(contains("a folder without plan documents"));
    let altered = file("altered");
    let good = fs::read_to_string(&four[1]).expect("a plan");
    let from = "\"turning_radius_m\": 100.0";
    assert!(good.contains(from));
    fs::write(&altered, good.replace(from, "\"turning_radius_m\": 101.0")).expect("written");
    searoom(&["verify", &altered])
        .code(1)
        .stderr(is_empty())
        .stdout(contains("Head-on: REJECTED").and(contains("turning radius in segment")));
    // the highest status of all wins, and every file is answered
    let broken = file("broken");
    fs::write(&broken, &good[..good.len() / 2]).expect("written");
    let first = &four[0];
    let all = run(&format!(
        "verify --json {broken} {altered} {first} no-such.json"
    ))
    .code(2)
    .stderr(contains("broken.json: ").and(contains("no-such.json: cannot be read")));
    let found = document(&all);
    let verdicts: Vec<_> = list(&found["plans"])
        .iter()
        .map(|p| &p["verified"])
        .collect();
    assert_eq!(verdicts, [false, false, true, false]);
    assert_eq!(found["verified"], 1);
    assert_eq!(found["plans"][2]["targets"][0]["target"], "target");
    searoom(&["verify"]).code(2).stderr(contains("PLAN.json"));
    // what is not proven in time is not verified, and says so
    let budget = ["verify", "--budget-s", "1e-9", &four[0]];
    let late = "give-way.json: not proven within the budget of 0.000000001 s";
    searoom(&budget).code(1).stderr(contains(late));
    let all = searoom(&[&budget[..], &["--json"]].concat()).code(1);
    let found = document(&all);
    assert_eq!(found["plans"][0]["outcome"], "unproven");
    assert_eq!(found["plans"][0]["verified"], false);
    for wrong in ["0", "-1", "soon", "1e300"] {
        searoom(&["verify", "--budget-s", wrong, &four[0]])
            .code(2)
            .stderr(contains("a positive number of seconds"));
    }
}

#[test]
fn every_planner_is_compared_on_the_same_scenarios() {
    let folder = Folder::new();
    let csv = folder.at("rows.csv");
    let figure = folder.at("compared.svg");
    let asked = format!("compare scenarios/colregs --csv {csv} --figure {figure}");
    let written = format!("note: wrote {csv}\nnote: wrote {figure}\n");
    let shown = stdout(&run(&asked).success().stderr(written));
    let methods = "space-time, Dijkstra, ellipsoids | hold course | COLLIDES | optimal control";
    says(&shown, &format!("Head-on\n | {methods}"));
    let rows = fs::read_to_string(&csv).expect("rows");
    assert_eq!(rows.lines().count(), 1 + 4 * 9);
    assert!(rows.starts_with("file,scenario,method,max_risk,"));
    let drawn = fs::read_to_string(&figure).expect("a figure");
    says(&drawn, "Overtaking: trajectories | space-time, A*");
    assert!(!drawn.contains("NaN"));
    // the same whatever runs at the same time, but for the times
    let json = |threads: &str| {
        let assert = Command::new(env!("CARGO_BIN_EXE_searoom"))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .env("RAYON_NUM_THREADS", threads)
            .args("compare scenarios/colregs/give-way.toml --max-risk 0,0.2 --json".split(' '))
            .assert()
            .success();
        untimed(document(&assert))
    };
    let found = json("1");
    assert_eq!(found, json("4"));
    let entries = list(&found["comparisons"][0]["entries"]);
    assert_eq!(entries.len(), 8 * 2 + 1);
    assert_eq!(entries[1]["max_risk"], 0.2);
    assert_eq!(entries[14]["method"], "hold course");
    assert_eq!(entries[14]["verified"], false);
    assert!(entries.iter().all(|e| list(&e["track"]).len() > 10));
}

#[test]
fn a_comparison_answers_every_file_and_says_what_is_wrong() {
    let folder = Folder::new();
    let bad = folder.write("bad.toml", "title = 3");
    let head_on = "scenarios/colregs/head-on.toml";
    run(&format!(
        "compare {bad} {head_on} --planner space-time --search a-star"
    ))
    .code(2)
    .stderr(contains("bad.toml: "))
    .stdout(contains("Head-on"))
    .stdout(contains("Dijkstra").not().and(contains("path-time").not()));
    // on the path alone nothing is clear
    searoom(&["compare", head_on, "--planner", "path-time"])
        .code(1)
        .stdout(contains("COLLIDES").and(contains("relaxed").not()));
    Folder::new().refuses(
        "
        compare scenarios/colregs/head-on.toml --max-risk 0,1 | allowed: a number from 0 to 0.999999
        compare scenarios/colregs/head-on.toml --figure x.pdf | ends neither in .svg nor in .png
        ",
    );
    let unwritten = run(&format!("compare {head_on} --csv /no/such/folder/x.csv")).code(2);
    unwritten.stderr(contains("/no/such/folder/x.csv"));
}

/// A motion that enters a whole set within the accepted risk is relaxed, whether a planner chose it
/// or not.
#[test]
fn a_baseline_that_takes_an_accepted_risk_is_relaxed() {
    let compared = json(
        "compare scenarios/colregs/give-way.toml --planner space-time --max-risk 0,0.4 --json",
    );
    let entries = compared["comparisons"][0]["entries"].as_array();
    let outcomes: Vec<(&str, f64)> = (entries.expect("a list").iter())
        .filter(|entry| entry["method"] == "constant velocity")
        .map(|entry| {
            assert_eq!(entry["verified"], true);
            let risk = number(&entry["cost"]["max_risk"]);
            (entry["outcome"].as_str().expect("a word"), risk)
        })
        .collect();
    let [("clear", without), ("relaxed", with)] = outcomes[..] else {
        panic!("{outcomes:?}");
    };
    assert!(without == 0.0 && with > 0.3, "{without}, {with}");
}

/// A time of no return that cannot be sought is no silence.
#[test]
fn a_plan_on_a_path_says_why_it_has_no_time_of_no_return() {
    let scenario = "scenarios/harbour/ferry-crossing.toml";
    let plan = searoom(&["plan", scenario, "--no-return", "--json"])
        .success()
        .stderr(contains("this one is of the path-time planner"));
    assert!(document(&plan).get("time_of_no_return_s").is_none());
}

/// The message for another document says that it is no plan document, and which kind it is.
#[test]
fn other_documents_are_no_plans() {
    let folder = Folder::new();
    let compared = run("compare scenarios/colregs/head-on.toml --planner path-time --json");
    folder.write("comparison.json", stdout(&compared.code(1)));
    folder.refuses(
        "
        verify README.md | found no JSON (expected value at line 1 column 1); allowed: a plan document
        verify DIR/comparison.json | format: found none in a document with the keys comparisons; allowed: searoom-plan/1
        ",
    );
}

/// A heading holds for what follows it.
#[test]
fn options_stand_under_their_own_heading() {
    for (command, option) in [
        ("plan", "--no-return"),
        ("suite", "--plans"),
        ("suite", "--lint"),
    ] {
        let help = stdout(&searoom(&[command, "--help"]).success());
        let (own, foreign) = help.split_once("Foreign files").expect("a heading");
        assert!(own.contains(option) && !foreign.contains(option), "{help}");
        assert!(foreign.contains("--variants"), "{help}");
    }
}

/// Ellipsoids are compared for the targets that may have them; a turning one keeps its polytopes.
#[test]
fn a_turning_target_is_no_ellipsoid_beside_others() {
    let file = "tests/faults/turning-beside-ellipsoid.toml";
    searoom(&["compare", file, "--planner", "path-time"])
        .code(1)
        .stdout(contains("path-time, ellipsoids"));
}

/// The centre of the ellipse is found again from the numbers of the document.
#[test]
fn a_wide_ellipse_at_an_accepted_risk_verifies() {
    let folder = Folder::new();
    let plan = searoom(&["plan", "tests/faults/wide-ellipse-at-risk.toml", "--json"]).code(1);
    let plan = folder.write("plan.json", stdout(&plan));
    searoom(&["verify", &plan]).success();
}

#[test]
fn shells_know_every_command() {
    let commands = [
        "init", "check", "assess", "plan", "suite", "compare", "inspect", "verify",
    ];
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = stdout(
            &searoom(&["completions", shell])
                .success()
                .stderr(is_empty()),
        );
        let all = commands.iter().all(|c| text.contains(c)) && text.contains("max-risk");
        assert!(all, "{shell}");
    }
    searoom(&["completions", "csh"]).code(2);
}

#[test]
fn a_report_is_one_page_with_its_figures() {
    let folder = Folder::new();
    let broken = folder.write("broken.toml", "title = \"<b>\"\n");
    let (suite, plans) = (folder.at("suite"), folder.at("plans"));
    run(&format!(
        "suite scenarios/colregs {broken} --report {suite} --plans {plans}"
    ))
    .code(2);
    let page = fs::read_to_string(format!("{suite}/index.html")).expect("a page");
    assert_eq!(page.matches("<img").count(), 4, "{page}");
    assert!(page.contains("href=\"./../plans/head-on.json\"") && page.contains("unreadable"));
    assert!(page.contains("5 scenarios: 4 solved"));

    run(&format!(
        "plan scenarios/colregs/head-on.toml --report {broken}"
    ))
    .code(2)
    .stderr(contains("--report: ").and(contains("a folder")));
}

/// Recordings are written and read by the default features alone.
#[cfg(feature = "recording")]
mod recordings {
    use std::path::PathBuf;

    use super::*;

    const HEAD_ON: &str = "scenarios/colregs/head-on.toml";
    const GIVE_WAY: &str = "scenarios/colregs/give-way.toml";

    fn recorded(folder: &Folder, name: &str, scenario: &str) -> (String, String) {
        let file = folder.at(name);
        let plan = searoom(&["plan", scenario, "--json", "--rrd", &file]).success();
        (file, stdout(&plan))
    }

    #[test]
    fn a_recording_gives_back_what_it_was_made_from() {
        let folder = Folder::new();
        let (file, plan) = recorded(&folder, "head-on.rrd", HEAD_ON);
        searoom(&["verify", &file])
            .success()
            .stdout(contains(": verified"));
        let said = stdout(&searoom(&["inspect", &file]).success());
        says(
            &said,
            "Head-on: solved (verified, safe) | space-time, a-star | a manoeuvre by the rules | head-on with 'target' | sim_time 0 to 302 | /curves/clearance_m",
        );
        let found = document(&searoom(&["inspect", "--json", &file]).success());
        let plan: Value = serde_json::from_str(&plan).expect("a plan");
        for key in ["scenario", "cost"] {
            assert_eq!(found[key], plan[key]);
        }
        let last = number(&found["timelines"][0]["last"]);
        let arrival = number(&plan["cost"]["duration_s"]);
        assert!((last - arrival).abs() < 1e-6, "{last} {arrival}");
    }

    /// Roles over time, scores, every broken rule with its moment, and how long a ship that stands
    /// on holds.
    #[test]
    fn inspect_tells_what_the_rules_say() {
        let folder = Folder::new();
        let file = folder.at("rules.rrd");
        let plan = |compliance: &str| {
            let asked = format!("plan scenarios/colregs/stand-on.toml --compliance {compliance}");
            run(&format!("{asked} --rrd {file}")).success();
            let said = stdout(&run(&format!("inspect {file}")).success());
            let lanes = run(&format!("inspect --csv rules/roles {file}")).success();
            [said, stdout(&lanes)]
        };
        let [said, lanes] = plan("shape");
        says(
            &said,
            "stand-on 0 to | scores: rule 17  | violates 17(c) at",
        );
        says(&lanes, "target: stand-on | target: violates");
        let [said, lanes] = plan("rules");
        says(&said, "stands on    course and speed are held until ");
        says(
            &lanes,
            "own ship holds course and speed | own ship escapes: ",
        );
        let whole = json(&format!("inspect --json {file}"));
        assert!(whole["escape"]["held_until_s"].is_f64(), "{whole}");
    }

    /// The recording contains the key that `--no-return` adds to the document.
    #[test]
    fn the_time_of_no_return_is_recorded() {
        let folder = Folder::new();
        let file = folder.at("a.rrd");
        let scenario = "scenarios/colregs/give-way.toml";
        let asked = ["plan", scenario, "--no-return", "--json", "--rrd", &file];
        let plan = stdout(&searoom(&asked).success());
        says(&plan, "\"time_of_no_return_s\": ");
        let back = searoom(&["inspect", "--plan", &file]).success();
        assert_eq!(stdout(&back), plan);
        // times are shown to the millisecond
        let said = stdout(&searoom(&["inspect", &file]).success());
        let times = said.lines().find(|line| line.starts_with("Timelines: "));
        let words = times.expect("a line").split(' ');
        let mut decimals = words.filter_map(|word| word.split_once('.'));
        assert!(decimals.all(|(_, digits)| digits.len() <= 3), "{said}");
    }

    /// Largest recording with its document, bytes.
    const MOST: u64 = 2_000_000;

    #[test]
    fn recordings_of_the_scenarios_are_small() {
        let folder = Folder::new();
        let all = fs::read_dir("scenarios").expect("a folder").flatten();
        let folders = all.map(|entry| entry.path()).filter(|path| path.is_dir());
        let files = folders.flat_map(|path| fs::read_dir(path).expect("a folder").flatten());
        let is_ours = |path: &PathBuf| path.extension().is_some_and(|e| e == "toml");
        let scenarios: Vec<PathBuf> = files.map(|e| e.path()).filter(is_ours).collect();
        assert!(scenarios.len() >= 15, "{scenarios:?}");
        for scenario in scenarios {
            let (file, plan) = recorded(&folder, "a.rrd", text(&scenario));
            let size = fs::metadata(&file).expect("written").len();
            assert!(size < MOST, "{}: {size} bytes", scenario.display());
            let back = searoom(&["inspect", "--plan", &file]).success();
            assert_eq!(stdout(&back), plan, "{}", scenario.display());
        }
    }

    #[test]
    fn curves_and_lines_come_out_as_columns() {
        let folder = Folder::new();
        let (file, plan) = recorded(&folder, "a.rrd", HEAD_ON);
        let curve = stdout(&searoom(&["inspect", "--csv", "curves/clearance_m", &file]).success());
        let mut lines = curve.lines();
        assert_eq!(lines.next(), Some("sim_time_s,target,safety margin"));
        let row = |line: &str| {
            line.split(',')
                .map(|c| c.parse().expect("a number"))
                .collect()
        };
        let rows: Vec<Vec<f64>> = lines.map(row).collect();
        assert!(rows.len() > 20 && rows.is_sorted_by(|a, b| a[0] <= b[0]));
        assert!(rows.iter().all(|row| row.len() == 3 && row[2] == 20.0));
        // The curve is sampled: it never goes below the plan's least distance, and comes near it.
        let least = rows.iter().map(|row| row[1]).fold(f64::INFINITY, f64::min);
        let plan: Value = serde_json::from_str(&plan).expect("a plan document");
        let dcpa_m = number(&plan["encounters"][0]["dcpa_m"]);
        assert!((-1e-6..0.5).contains(&(least - dcpa_m)), "{least} {dcpa_m}");
        let line = stdout(&searoom(&["inspect", "--csv", "/chart/map/planned", &file]).success());
        assert!(line.starts_with("colors,radii,strips\n"), "{line}");
        says(&line, "[[[0.0,0.0],");
        searoom(&["inspect", "--csv", "curves/clearence", &file])
            .code(2)
            .stderr(contains(
                "no entity /curves/clearence; the nearest names: /curves/clearance_m",
            ));
    }

    #[test]
    fn a_comparison_is_recorded_scenario_by_scenario_and_read_again() {
        let folder = Folder::new();
        let recordings = folder.at("new");
        let asked = "compare scenarios/colregs --search a-star --json --rrd";
        let document = json(&format!("{asked} {recordings}"));
        assert_eq!(folder.names("new").len(), 4);
        let file = format!("{recordings}/head-on.rrd");
        let contents = json(&format!("inspect {file} --json"));
        let read = list(&contents["comparison"]["entries"]);
        let written = list(&document["comparisons"][1]["entries"]);
        assert_eq!(read.len(), written.len());
        for (read, written) in read.iter().zip(written) {
            for key in "method outcome verdict search_stats verified safe".split(' ') {
                assert_eq!(read[key], written[key], "{key}");
            }
            assert_eq!(read["timing"].is_null(), written["timing"].is_null());
            assert!(read["timing"].is_null() || read["timing"]["plan_s"].is_number());
        }
        searoom(&["inspect", &file])
            .success()
            .stdout(contains("Head-on"))
            .stdout(contains("hold course").and(contains("COLLIDES")));
        searoom(&["inspect", "--plan", &file])
            .code(2)
            .stderr(contains("the recording of a comparison"));
        searoom(&["verify", &file])
            .code(2)
            .stderr(contains("`searoom inspect --json` prints its own"));
        searoom(&["compare", "scenarios/colregs", "--rrd", &file])
            .code(2)
            .stderr(contains("name a folder"));
    }

    #[test]
    fn what_is_no_whole_recording_is_said_to_be_so() {
        let folder = Folder::new();
        let (file, _) = recorded(&folder, "a.rrd", HEAD_ON);
        let bytes = fs::read(&file).expect("a recording");
        let broken = folder.at("b.rrd");
        let refused = |contents: &[u8], expected: &str| {
            fs::write(&broken, contents).expect("written");
            for command in ["inspect", "verify"] {
                searoom(&[command, &broken])
                    .code(2)
                    .stdout(is_empty())
                    .stderr(contains(expected).and(contains("panicked").not()));
            }
        };
        refused(b"", "an empty file");
        refused(b"a text", "no Rerun recording");
        let cut_or_changed = "its checksum is missing or wrong";
        for part in 1..8 {
            let at = bytes.len() * part / 8;
            refused(&bytes[..at], cut_or_changed);
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x55;
            refused(&damaged, cut_or_changed);
        }
        // a second one behind the first
        let (other, _) = recorded(&folder, "c.rrd", GIVE_WAY);
        let other = fs::read(other).expect("a recording");
        refused(&[&bytes[..], &other].concat(), cut_or_changed);
        searoom(&["inspect", "no-such.rrd"]).code(2).stderr(
            contains("No such file")
                .count(1)
                .and(contains("no-such.rrd: cannot be read")),
        );
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
    // with thresholds of five lengths the same plan is a near miss
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
