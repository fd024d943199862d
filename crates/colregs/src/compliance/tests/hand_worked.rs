//! Scores and monitors of short encounters against values from the definitions: rectangles, arcs
//! and the formulas alone, by a program in another language, to twelve digits.

use std::f64::consts::{FRAC_PI_2, PI};

use super::rows;
use super::{ComplianceReport, Measure, MonitorVerdict, judged};
use crate::Role;
use searoom_geometry::frame::deg_from_radians;

/// The report for a target; own ship begins in the role toward it. `opposite 40` comes on a line
/// 40 m north of own ship's.
fn report(legs: &str, target: &str) -> ComplianceReport {
    let (role, target) = match target.split_once(' ') {
        Some((_, north)) => {
            let north = north.parse().expect("metres");
            (Role::HeadOn, [1440.0, north, PI, 6.0])
        }
        None if target == "port" => (Role::StandOn, [720.0, 720.0, -FRAC_PI_2, 6.0]),
        None if target == "starboard" => (Role::GiveWay, [720.0, -720.0, FRAC_PI_2, 6.0]),
        None => (Role::Overtaking, [432.0, 0.0, 0.0, 2.4]),
    };
    let report = judged(legs, target);
    assert_eq!(report.roles[0].role, role, "{legs}");
    report
}

fn assert_near(found: f64, expected: &str, what: &dyn std::fmt::Debug) {
    let expected: f64 = expected.parse().expect("a number");
    assert!(
        (found - expected).abs() < 1e-9,
        "{what:?}: {found}, by hand {expected}"
    );
}

/// Legs, target, and each score that applies.
const SCORES: &str = "
    // before the closest approach: 8 of 10 degrees to starboard
    20s -8° 80s | opposite 40 | safety 0.510162132032 rule_8 0.071111111111 rule_14 0.251087193505
    // past it
    20s -8° 120s | opposite 40 | safety 0.976614476890 rule_8 0.071111111111 rule_14 0.388718064482
    // more than what is readily apparent
    20s -40° 75s | opposite 0 | safety 0.700974470501 rule_8 1.0 rule_14 0.893958835822
    // to port, and later at half the speed
    20s 3° 80s | opposite 95 | safety 0.500654090670 rule_8 0.01 rule_14 0.101616945776
    20s -8° 20s 50s@3 | opposite 40 | safety 0.500303702694 rule_8 1.0 rule_14 0.182159185017
    // half of a safe distance, and half of the pose: both see each other 45 degrees off the bow
    90s | port | safety 0.542893218813 rule_17 0.542893218813
    // 14 of the 28 degrees from steady to apparent cost a quarter
    20s -16° 70s | port | safety 0.553656505606 rule_17 0.303656505606
    // steady enough, and 0.4 of the speed lost
    20s -1° 20s 40s@3.6 | port | safety 0.541492871277 rule_17 0.341492871277
    20s -16° 20s 40s@9 | port | safety 0.521305634696 rule_17 0.120580282087
    20s -25° 60s | starboard | safety 0.525662583469 rule_8 1.0 rule_15 0.413631472137 rule_16 0.413631472137
    20s 12° 60s | ahead | safety 0.626325967634 rule_8 0.16 rule_13 0.073986668006 rule_16 0.073986668006
";

#[test]
fn scores_are_those_worked_out_by_hand() {
    for [legs, target, expected] in rows(SCORES) {
        let found = report(legs, target).scores.by_name();
        let words: Vec<&str> = expected.split(' ').collect();
        assert_eq!(2 * found.len(), words.len(), "{legs}: {found:?}");
        for ((name, score), expected) in found.iter().zip(words.chunks(2)) {
            assert_eq!(*name, expected[0], "{legs}");
            assert_near(*score, expected[1], &(legs, name));
        }
    }
}

/// Legs, target, and of each monitor that is not idle its verdict, robustness in metres, seconds or
/// degrees, and time.
const MONITORS: &str = "
    // 8 of the 20 degrees; whether more follows is not known before they have passed
    20s -8° 80s | opposite 40 | S satisfied 188.971776290851 102.908882086657; R4 undecided -12 0
    20s -8° 120s | opposite 40 | S satisfied 108.965846387641 120; R4 violated -12 0
    // bows of two ships of 50 m meet after 1390 m at 12 m/s
    110s | opposite 0 | S satisfied 70 110; R1 undecided 5.833333333333 110; R4 undecided -20 0
    70s -60° 30s | opposite 0 | S satisfied 200.893758327955 119; R1 satisfied 45.833333333333 70; R4 satisfied 40 0
    // from the end of the first turn on
    20s -16° 30s 16° 30s | port | S satisfied 248.430136265234 91.635528346629; R1 undecided 33.247688330451 91.635528346629; R6 violated -6 25.817764173314
    20s -1° 20s 40s@3.6 | port | S satisfied 370.942138952457 80.363610260832; R6 satisfied 9 20.363610260832
    20s -25° 60s | starboard | S satisfied 191.131127964599 89.090256520804; R3 satisfied 5 0
    20s 12° 60s | ahead | S satisfied 112.622592343490 84.363323129986; R5 undecided -8 0
";

#[test]
fn monitors_are_those_worked_out_by_hand() {
    for [legs, target, expected] in rows(MONITORS) {
        let monitors = report(legs, target).monitors;
        let names = monitors.each_ref().map(|f| f.monitor.word());
        assert_eq!(names, ["S", "R1", "R3", "R4", "R5", "R6"]);
        let expected: Vec<Vec<&str>> = (expected.split("; "))
            .map(|monitor| monitor.split(' ').collect())
            .collect();
        for found in monitors {
            let expected = expected
                .iter()
                .find(|words| words[0] == found.monitor.word());
            let Some([_, verdict, robustness, time]) = expected.map(|words| &words[..]) else {
                assert_eq!(found.verdict, MonitorVerdict::Idle, "{legs}: {found:?}");
                continue;
            };
            assert_eq!(found.verdict.word(), *verdict, "{legs}: {found:?}");
            let value = found.robustness.expect("a number");
            let value = match found.measure {
                Measure::Angle => deg_from_radians(value),
                _ => value,
            };
            assert_near(value, robustness, &(legs, found));
            assert_near(found.time.expect("a time"), time, &(legs, found));
        }
    }
}
