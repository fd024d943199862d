//! Tests of plans by the rules, on scenes that are easily planned against them.

use searoom::colregs::Role;
use searoom::pipeline::{self, Run};
use searoom::scenario::Scenario;

fn run(text: &str) -> Run {
    pipeline::run(Scenario::parse(text).expect("valid"))
}

#[test]
fn no_rule_is_broken_where_none_need_be() {
    for text in [
        include_str!("../faults/rules-corner.toml"),
        include_str!("../faults/rules-later-role.toml"),
        include_str!("../faults/rules-length-of-one.toml"),
        include_str!("../faults/rules-slow-turn.toml"),
        include_str!("../faults/rules-starboard-to-starboard.toml"),
    ] {
        let run = run(text);
        let title = &run.scenario.title;
        assert!(run.planned.outcome.plan().is_some(), "{title}");
        assert!(run.relaxations.is_empty(), "{title}");
        for report in run.judged_conduct().iter().flatten() {
            let broken: Vec<_> = report.broken().collect();
            assert!(broken.is_empty(), "{title}: {broken:?}");
        }
    }
}

#[test]
fn a_ship_does_not_slow_down_just_ahead_of_one_that_it_has_overtaken() {
    let run = run(include_str!("../faults/rules-hampered.toml"));
    assert!(run.planned.outcome.plan().is_some());
    let reports = run.judged_conduct();
    let mut roles = reports.iter().flatten().flat_map(|report| &report.roles);
    assert!(roles.all(|r| r.role != Role::Overtaken), "{reports:?}");
}

#[test]
fn a_ship_is_on_time_again_without_a_moment_at_another_speed() {
    let run = run(include_str!("../faults/rules-short-part.toml"));
    let plan = run.planned.outcome.plan().expect("a plan");
    let segments = plan.trajectory.segments();
    assert!(segments.iter().all(|s| s.duration >= 3.0), "{segments:?}");
}
