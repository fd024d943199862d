//! Scores and monitors of short encounters against values from the definitions: rectangles, arcs
//! and the formulas alone, by a program in another language, to twelve digits.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{ComplianceReport, LENGTH, Measure, MonitorVerdict, standard, steady};
use crate::colregs::Role;
use crate::frame::{Pose, Vector, deg_from_radians, radians_from_deg};
use crate::trajectory::{Segment, Trajectory};

/// A leg of own ship.
#[derive(Debug, Clone, Copy)]
enum Leg {
    /// Seconds at m/s.
    Straight(f64, f64),
    /// Degrees to port at 6 m/s, with a radius of 2.5 lengths.
    Turn(f64),
}

use Leg::{Straight, Turn};

/// The trajectory of these legs from the origin east.
fn sailed(legs: &[Leg]) -> Trajectory {
    let mut segments: Vec<Segment> = Vec::new();
    for leg in legs {
        let (duration, speed, turn_rate) = match *leg {
            Straight(seconds, speed) => (seconds, speed, 0.0),
            Turn(degrees) => {
                let rate = 6.0 / (2.5 * LENGTH);
                let seconds = radians_from_deg(degrees.abs()) / rate;
                (seconds, 6.0, rate * degrees.signum())
            }
        };
        let last = segments.last();
        segments.push(Segment {
            start: last.map_or(Pose::new(Vector::zeros(), 0.0), Segment::end),
            start_time: last.map_or(0.0, Segment::end_time),
            duration,
            speed,
            turn_rate,
        });
    }
    Trajectory::new(segments).expect("a trajectory")
}

/// The report for a target at `[east, north, heading, speed]`; own ship begins in `role`.
fn judged(legs: &[Leg], target: [f64; 4], role: Role) -> ComplianceReport {
    let [east, north, heading, speed] = target;
    let conduct = ComplianceReport::judge(
        &steady(&sailed(legs), east, north, heading, speed),
        standard(),
    );
    assert_eq!(conduct.roles[0].role, role, "{legs:?}");
    conduct
}

/// Legs, target, role, and expected result.
type Case<'a, T> = (&'a [Leg], [f64; 4], Role, T);

fn assert_scores(cases: &[Case<&[(&str, f64)]>]) {
    for (legs, target, role, expected) in cases {
        let found = judged(legs, *target, *role).scores.by_name();
        assert_eq!(found.len(), expected.len(), "{legs:?}: {found:?}");
        for (found, expected) in found.iter().zip(*expected) {
            assert_eq!(found.0, expected.0, "{legs:?}");
            assert!(
                (found.1 - expected.1).abs() < 1e-9,
                "{legs:?}: {found:?}, by hand {expected:?}"
            );
        }
    }
}

/// A target on the opposite course, on a line `north` metres north of own ship's.
const fn opposite(north: f64) -> [f64; 4] {
    [1440.0, north, PI, 6.0]
}

const FROM_PORT: [f64; 4] = [720.0, 720.0, -FRAC_PI_2, 6.0];
const FROM_STARBOARD: [f64; 4] = [720.0, -720.0, FRAC_PI_2, 6.0];
const AHEAD: [f64; 4] = [432.0, 0.0, 0.0, 2.4];

#[test]
fn rule_14_scores_are_those_worked_out_by_hand() {
    assert_scores(&[
        // before the closest approach: 8 of 10 degrees to starboard
        (
            &[Straight(20.0, 6.0), Turn(-8.0), Straight(80.0, 6.0)],
            opposite(40.0),
            Role::HeadOn,
            &[
                ("safety", 0.510162132032),
                ("rule_8", 0.071111111111),
                ("rule_14", 0.251087193505),
            ],
        ),
        // past it
        (
            &[Straight(20.0, 6.0), Turn(-8.0), Straight(120.0, 6.0)],
            opposite(40.0),
            Role::HeadOn,
            &[
                ("safety", 0.976614476890),
                ("rule_8", 0.071111111111),
                ("rule_14", 0.388718064482),
            ],
        ),
        // more than what is readily apparent
        (
            &[Straight(20.0, 6.0), Turn(-40.0), Straight(75.0, 6.0)],
            opposite(0.0),
            Role::HeadOn,
            &[
                ("safety", 0.700974470501),
                ("rule_8", 1.0),
                ("rule_14", 0.893958835822),
            ],
        ),
        // to port, and later at half the speed
        (
            &[Straight(20.0, 6.0), Turn(3.0), Straight(80.0, 6.0)],
            opposite(95.0),
            Role::HeadOn,
            &[
                ("safety", 0.500654090670),
                ("rule_8", 0.01),
                ("rule_14", 0.101616945776),
            ],
        ),
        (
            &[
                Straight(20.0, 6.0),
                Turn(-8.0),
                Straight(20.0, 6.0),
                Straight(50.0, 3.0),
            ],
            opposite(40.0),
            Role::HeadOn,
            &[
                ("safety", 0.500303702694),
                ("rule_8", 1.0),
                ("rule_14", 0.182159185017),
            ],
        ),
    ]);
}

#[test]
fn rule_17_scores_are_those_worked_out_by_hand() {
    let scored = |legs: &[Leg], safety: f64, rule_17: f64| {
        let expected = [("safety", safety), ("rule_17", rule_17)];
        assert_scores(&[(legs, FROM_PORT, Role::StandOn, &expected)]);
    };
    // half of a safe distance, and half of the pose: both ships see each other 45 degrees off the
    // bow
    let held = 0.5 + 0.5 * (1.0 - 0.5_f64.sqrt()).powi(2);
    scored(&[Straight(90.0, 6.0)], held, held);
    let turned = [Straight(20.0, 6.0), Turn(-16.0), Straight(70.0, 6.0)];
    // 14 of the 28 degrees from steady to apparent cost a quarter
    scored(&turned, 0.553656505606, 0.303656505606);
    // steady enough, and 0.4 of the speed lost
    let slower = [
        Straight(20.0, 6.0),
        Turn(-1.0),
        Straight(20.0, 6.0),
        Straight(40.0, 3.6),
    ];
    scored(&slower, 0.541492871277, 0.341492871277);
    let faster = [
        Straight(20.0, 6.0),
        Turn(-16.0),
        Straight(20.0, 6.0),
        Straight(40.0, 9.0),
    ];
    scored(&faster, 0.521305634696, 0.120580282087);
}

#[test]
fn scores_of_giving_way_and_of_overtaking_are_those_worked_out_by_hand() {
    assert_scores(&[
        (
            &[Straight(20.0, 6.0), Turn(-25.0), Straight(60.0, 6.0)],
            FROM_STARBOARD,
            Role::GiveWay,
            &[
                ("safety", 0.525662583469),
                ("rule_8", 1.0),
                ("rule_15", 0.413631472137),
                ("rule_16", 0.413631472137),
            ],
        ),
        (
            &[Straight(20.0, 6.0), Turn(12.0), Straight(60.0, 6.0)],
            AHEAD,
            Role::Overtaking,
            &[
                ("safety", 0.626325967634),
                ("rule_8", 0.16),
                ("rule_13", 0.073986668006),
                ("rule_16", 0.073986668006),
            ],
        ),
    ]);
}

/// Verdict, robustness in metres, seconds or degrees, and time of a monitor.
type Found = Option<(MonitorVerdict, f64, f64)>;

#[test]
fn monitors_are_those_worked_out_by_hand() {
    use MonitorVerdict::{Satisfied, Undecided, Violated};
    let cases: &[Case<[Found; 6]>] = &[
        // 8 of the 20 degrees; whether more follows is not known before they have passed
        (
            &[Straight(20.0, 6.0), Turn(-8.0), Straight(80.0, 6.0)],
            opposite(40.0),
            Role::HeadOn,
            [
                Some((Satisfied, 188.971776290851, 102.908882086657)),
                None,
                None,
                Some((Undecided, -12.0, 0.0)),
                None,
                None,
            ],
        ),
        (
            &[Straight(20.0, 6.0), Turn(-8.0), Straight(120.0, 6.0)],
            opposite(40.0),
            Role::HeadOn,
            [
                Some((Satisfied, 108.965846387641, 120.0)),
                None,
                None,
                Some((Violated, -12.0, 0.0)),
                None,
                None,
            ],
        ),
        // bows of two ships of 50 m meet after 1390 m at 12 m/s
        (
            &[Straight(110.0, 6.0)],
            opposite(0.0),
            Role::HeadOn,
            [
                Some((Satisfied, 70.0, 110.0)),
                Some((Undecided, 1390.0 / 12.0 - 110.0, 110.0)),
                None,
                Some((Undecided, -20.0, 0.0)),
                None,
                None,
            ],
        ),
        (
            &[Straight(70.0, 6.0), Turn(-60.0), Straight(30.0, 6.0)],
            opposite(0.0),
            Role::HeadOn,
            [
                Some((Satisfied, 200.893758327955, 119.0)),
                Some((Satisfied, 1390.0 / 12.0 - 70.0, 70.0)),
                None,
                Some((Satisfied, 40.0, 0.0)),
                None,
                None,
            ],
        ),
        (
            &[
                Straight(20.0, 6.0),
                Turn(-16.0),
                Straight(30.0, 6.0),
                Turn(16.0),
                Straight(30.0, 6.0),
            ],
            FROM_PORT,
            Role::StandOn,
            [
                Some((Satisfied, 248.430136265234, 91.635528346629)),
                Some((Undecided, 33.247688330451, 91.635528346629)),
                None,
                None,
                None,
                // from the end of the first turn on
                Some((Violated, 10.0 - 16.0, 25.817764173314)),
            ],
        ),
        (
            &[
                Straight(20.0, 6.0),
                Turn(-1.0),
                Straight(20.0, 6.0),
                Straight(40.0, 3.6),
            ],
            FROM_PORT,
            Role::StandOn,
            [
                Some((Satisfied, 370.942138952457, 80.363610260832)),
                None,
                None,
                None,
                None,
                Some((Satisfied, 10.0 - 1.0, 20.363610260832)),
            ],
        ),
        (
            &[Straight(20.0, 6.0), Turn(-25.0), Straight(60.0, 6.0)],
            FROM_STARBOARD,
            Role::GiveWay,
            [
                Some((Satisfied, 191.131127964599, 89.090256520804)),
                None,
                Some((Satisfied, 25.0 - 20.0, 0.0)),
                None,
                None,
                None,
            ],
        ),
        (
            &[Straight(20.0, 6.0), Turn(12.0), Straight(60.0, 6.0)],
            AHEAD,
            Role::Overtaking,
            [
                Some((Satisfied, 112.622592343490, 84.363323129986)),
                None,
                None,
                None,
                Some((Undecided, 12.0 - 20.0, 0.0)),
                None,
            ],
        ),
    ];
    for (legs, target, role, expected) in cases {
        let monitors = judged(legs, *target, *role).monitors;
        let names = monitors.each_ref().map(|f| f.monitor);
        assert_eq!(names, ["S", "R1", "R3", "R4", "R5", "R6"]);
        for (found, expected) in monitors.iter().zip(expected) {
            let Some((verdict, robustness, time)) = *expected else {
                assert_eq!(found.verdict, MonitorVerdict::Idle, "{legs:?}: {found:?}");
                continue;
            };
            assert_eq!(found.verdict, verdict, "{legs:?}: {found:?}");
            let is_angle = found.measure == Measure::Angle;
            let in_degrees = found.robustness.map(deg_from_radians);
            let value = if is_angle {
                in_degrees
            } else {
                found.robustness
            };
            let by = value.map_or(f64::NAN, |value| (value - robustness).abs());
            assert!(by < 1e-9, "{legs:?}: {found:?}, by hand {robustness}");
            let at = found.time.map_or(f64::NAN, |at| (at - time).abs());
            assert!(at < 1e-9, "{legs:?}: {found:?}, by hand at {time} s");
        }
    }
}
