use super::*;
use crate::pipeline;
use crate::simulation::Simulation;

const NASTY: &str = r#"<script>alert("x")</script> & 'y'"#;

fn scenario(kind: &str) -> Scenario {
    let title = NASTY.replace('"', "\\\"");
    let text = format!(
        r#"
title = "{title}"
horizon_s = 400.0
own_ship = {{ position = {{ east_m = 0.0, north_m = 0.0 }}, course_deg = 90.0, speed_mps = 5.0, length_m = 30.0, beam_m = 8.0, turning_radius_m = 100.0 }}
mission = {{ waypoints = [{{ east_m = 0.0, north_m = 0.0 }}, {{ east_m = 1500.0, north_m = 0.0 }}] }}
planner = {{ kind = "{kind}" }}
[[targets]]
name = "{title}"
position = {{ east_m = 700.0, north_m = 700.0 }}
course_deg = 180.0
speed_mps = 5.0
length_m = 60.0
beam_m = 12.0
"#
    );
    Scenario::parse(&text).expect("valid")
}

fn subject(stem: &str) -> Subject {
    Subject {
        stem: stem.to_owned(),
        file: NASTY.to_owned(),
        links: vec![(NASTY.to_owned(), link::address("a \"b\"#?.rrd"))],
    }
}

fn add(report: &mut HtmlReport, stem: &str, kind: &str) {
    let run = pipeline::run(scenario(kind));
    report.add_run(&subject(stem), &PlanDocument::of(&run), &run);
}

/// Checks that texts are escaped, every figure on the page exists, and nothing is loaded from
/// elsewhere.
fn assert_sound(report: &HtmlReport, page: &str) {
    assert!(!page.contains("<script") && !page.contains("alert(\"x\")"));
    assert!(page.contains("&lt;script&gt;"));
    assert!(!page.contains("http:") && !page.contains("https:") && !page.contains("//"));
    for (name, svg) in &report.figures {
        assert!(
            page.contains(&format!("src=\"{}\"", link::address(name))),
            "{name}"
        );
        assert!(
            svg.starts_with("<svg") && !svg.contains("<script"),
            "{name}"
        );
    }
    assert_eq!(page.matches("<img").count(), report.figures.len());
    assert_eq!(
        page.matches("<table").count(),
        page.matches("</table>").count()
    );
}

#[test]
fn a_report_of_plans_has_rows_sections_and_figures() {
    let build = || {
        let mut report = HtmlReport::new();
        add(&mut report, "a", "space-time");
        add(&mut report, "b", "path-time");
        report.add_failure(NASTY, SuiteOutcome::Unreadable, NASTY);
        report
    };
    let report = build();
    let page = report.html(NASTY, "3 scenarios");
    assert_sound(&report, &page);
    let names: Vec<&str> = report
        .figures
        .iter()
        .map(|(name, _)| name.as_str())
        .collect();
    assert_eq!(names, ["a-1.svg", "b-1.svg", "b-2.svg"]);
    assert!(report.figures[2].1.contains("Distance along the path"));
    assert_eq!(page.matches("<h2>").count(), 3);
    assert!(page.contains("data-name=\"leg\""));
    assert!(page.contains("href=\"./a%20%22b%22%23%3F.rrd\""));
    // no timestamps
    let again = build();
    assert_eq!(page, again.html(NASTY, "3 scenarios"));
    assert_eq!(report.figures, again.figures);
    assert!(!page.contains("[ms]"));
    // one plan has the table of its legs alone
    let mut single = HtmlReport::new();
    add(&mut single, "a", "space-time");
    assert_eq!(single.html("", "").matches("<table").count(), 1);
}

#[test]
fn a_report_of_a_comparison_has_a_table_and_the_diagrams() {
    let scenario = scenario("space-time");
    let entries = crate::study::compare::compare(&scenario, &[0.0, 0.2]);
    let mut report = HtmlReport::new();
    let compared = ScenarioComparisonDocument::of("c".to_owned(), &scenario, &entries, &[]);
    report.add_comparison(&subject("c"), &compared, &scenario, &entries);
    let page = report.html("Compared", "");
    assert_sound(&report, &page);
    assert!(page.contains("hold course") && page.contains("accepted"));
    let diagrams = |svg: &&(String, String)| svg.1.contains("Distance along the path");
    // polytopes and ellipsoids, at two risks
    assert_eq!(report.figures.iter().filter(diagrams).count(), 4);
    assert!(report.figures[2].1.contains("Accepted risk"));
}

#[test]
fn a_report_of_a_simulation_has_its_chart_and_tables_and_rows_link_to_their_sections() {
    let build = || {
        let scenario = scenario("space-time");
        let mut simulation = Simulation::new(scenario.clone(), false).expect("a closed loop");
        while !simulation.finished() {
            simulation.step();
        }
        let mut report = HtmlReport::new();
        report.add_simulation(&subject("a"), &scenario, &simulation.record());
        report.add_failure(NASTY, SuiteOutcome::Unreadable, NASTY);
        report
    };
    let report = build();
    let page = report.html("Sailed", "");
    assert_sound(&report, &page);
    for text in [
        "no contact",
        "Rules, by both judges",
        "planned at",
        "href=\"#s2\"",
    ] {
        assert!(page.contains(text), "{text}: {page}");
    }
    assert!(report.figures[0].1.contains("closest approach"));
    // no planning times
    assert_eq!(page, build().html("Sailed", ""));
}
