use super::*;
use crate::evaluation::Safety;
use crate::report::Verdict;

fn summary(meetings: usize) -> Summary {
    let meeting = Meeting {
        target: "t".to_owned(),
        role: "give-way",
        undisturbed_tcpa: 100.0,
        undisturbed_dcpa: -1.0,
        side: Some(Side::Port),
        dcpa: Some(100.0),
        tcpa: Some(90.0),
        cuts_astern: Some(true),
    };
    Summary {
        title: "Busy".to_owned(),
        verdict: Verdict::Relaxed,
        verified: Some(true),
        safety: Some(Safety::AtRisk),
        meetings: vec![meeting; meetings],
        targets: 9,
        turn: None,
        space_time_error: Some(12345.6),
        delay: Some(-0.04),
        clearance: None,
        max_risk: Some(0.25),
        expanded: 7,
        milliseconds: 1.234,
    }
}

#[test]
fn rows_name_a_few_targets_and_count_the_rest() {
    let table = suite_table(&[Row::Run(summary(5))], false);
    assert_eq!(table.matches("port, astern").count(), NAMED);
    assert!(table.contains("+ 2 more"), "{table}");
    assert!(table.contains("12346") && table.contains("+0.0") && table.contains("none"));
    assert!(!table.contains('\u{1b}'));
    assert!(suite_table(&[Row::Run(summary(1))], true).contains('\u{1b}'));
    let failed = Row::Failed {
        file: "x.toml".to_owned(),
        outcome: "unreadable",
    };
    let both = suite_table(&[failed, Row::Run(summary(0))], false);
    assert!(both.find("x.toml") < both.find("Busy"));
}
