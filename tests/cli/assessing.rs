//! Assessments: documents, tables, figures, and what they cannot read.

use std::fs;

use super::program::{Folder, HEAD_ON, assert_values, document, json, list, number, run, stdout};
use predicates::prelude::PredicateBooleanExt;
use predicates::str::{contains, is_empty};
use serde_json::Value;

/// Values of the document of an assessment.
const ASSESSMENT: &str = r#"
/scenario "Give-way"
/targets/0/name "target"
/targets/0/representation "polytope"
/targets/0/sections/0/t_s 0.0
/targets/0/sections/1/t_s 60.0
/points/0/east_m -10.0
/points/0/north_m 5.5
/points/0/t_s 0.0
/points/0/targets/0/inside false
/points/0/targets/0/alpha null
/points/0/targets/0/risk 0.0
/points/1/t_s 300.0
/hold_course/targets/0/name "target"
/hold_course/targets/0/dcpa_m 0.0
/velocities/0/east_mps -5.0
/velocities/0/targets/0/in_velocity_obstacle false
/velocities/1/north_mps 6.0
/velocities/2/targets/0/in_velocity_obstacle true
"#;

#[test]
fn an_assessment_document_has_what_the_contract_names() {
    let folder = Folder::new();
    let points = folder.write("points.csv", "t_s,east_m,north_m\n300,0,0\n");
    let velocities = folder.write("velocities.csv", "east_mps,north_mps\n0,6\n5,0\n");
    let asked = format!(
        "assess scenarios/colregs/give-way.toml --at -10,5.5,0 --points {points} \
         --velocity -5,0 --velocities {velocities} --section 0 --section 60 --json"
    );
    let assert = run(&asked).success().stderr(is_empty());
    let assessment = document(&assert);
    assert_values(&assessment, ASSESSMENT);
    assert_eq!(stdout(&assert), stdout(&run(&asked)), "the same bytes");
    let width = |document: &Value| {
        let vertices = list(&document["targets"][0]["sections"][0]["vertices_m"]);
        let norths = vertices.iter().map(|vertex| number(&vertex[1]));
        let most = norths.clone().fold(f64::NEG_INFINITY, f64::max);
        most - norths.fold(f64::INFINITY, f64::min)
    };
    let with_domain = json(&format!("{asked} --domains"));
    assert!(width(&with_domain) > width(&assessment));
}

#[test]
fn an_assessment_reads_as_a_table() {
    run("assess scenarios/colregs/give-way.toml --at 0,0,0 --velocity -1,0 --section 1.5")
        .success()
        .stderr(is_empty())
        .stdout(
            contains("Give-way: 1 target, hard sets, 0 to 400 s")
                .and(contains(
                    "Holding course 090.0° at 9.7 kn: own centre to the hard sets; at dCPA 0.0 it ",
                ))
                .and(contains("to starboard").and(contains("to port").and(contains("kn slower"))))
                .and(contains("Points").and(contains("Velocities").and(contains("Sections")))),
        );
}

#[test]
fn what_an_assessment_cannot_read_is_named() {
    let folder = Folder::new();
    folder.write("early.csv", "east_m,north_m,t_s\n1,2,-0.5\nx,,3\n");
    folder.write("bad.toml", "title = 3");
    folder.write("empty.csv", "");
    // polygons given velocities that are an ellipse
    let mixed = format!(
        "{HEAD_ON}\n[[targets]]\nname = \"mixed\"\ninitial_set = {{ vertices_m = [[900, 900]] }}\n\
         velocity_set = {{ center_mps = [1, 0], shape_m2_per_s2 = [[0.04, 0], [0, 0.06]] }}\n"
    );
    folder.write("mixed.toml", mixed);
    let assess = "assess scenarios/colregs/head-on.toml";
    folder.refuses(&format!(
        "
        {assess} --points DIR/early.csv | early.csv: 3 faults | line 2: t_s: found -0.5; allowed:
        {assess} --velocities DIR/missing.csv | missing.csv: cannot be read
        {assess} --velocities DIR | not a regular file
        {assess} --at 1,2,-1 | --at | t_s: found -1; allowed: a number from 0
        {assess} --velocity 1,101 | --velocity | north_mps: found 101
        {assess} --section -1 | --section | '-1' | seconds from 0 to
        assess DIR/bad.toml --points DIR/empty.csv | title: found 3 | an empty file
        assess DIR | a folder
        assess DIR/mixed.toml | mixed.toml | targets[1].velocity_set
        "
    ));
}

#[test]
fn an_assessment_can_be_drawn() {
    let folder = Folder::new();
    let scenario = "scenarios/colregs/give-way.toml";
    let drawn = |name: &str| {
        let file = folder.at(name);
        let asked = format!("assess {scenario} --section 0 --section 100 --figure {file}");
        let drawn = run(&asked).success().stdout(contains("Give-way"));
        drawn.stderr(format!("note: wrote {file}\n"));
        fs::read(&file).expect("written")
    };
    let svg = drawn("new/a.svg");
    assert!(svg.starts_with(b"<svg"));
    assert_eq!(svg, drawn("b.SVG"), "the same bytes");
    assert!(drawn("a.png").starts_with(b"\x89PNG\r\n\x1a\n"));
    folder.refuses(&format!(
        "
        assess {scenario} --figure DIR/new/a.eps | allowed: one of the three
        assess {scenario} --figure DIR/new/a | in none of .svg, .png and .pdf
        assess {scenario} --figure DIR/new/a.svg/b.svg | the folder cannot be made
        assess {scenario} --figure DIR/new/. | in none of
        "
    ));
}
