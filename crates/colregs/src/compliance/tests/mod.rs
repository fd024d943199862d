//! Fixtures of docs/reference/colregs.md 0.1 with good and bad manoeuvres.

mod hand_worked;

use std::f64::consts::{FRAC_PI_2, PI};

use super::*;
use crate::ship_fixtures;
use searoom_geometry::frame::{Pose, Vector};
use searoom_model::target::ShipTrack;
use searoom_model::trajectory::{Segment, Trajectory};
use searoom_model::vessel::{Hull, OwnShip};

/// Metres, of both ships.
pub const LENGTH: f64 = 50.0;

/// Pieces from the origin east, one after another: seconds, m/s, rad/s. Empty ones are left out.
fn joined(pieces: impl Iterator<Item = (f64, f64, f64)>) -> Trajectory {
    let mut segments: Vec<Segment> = Vec::new();
    for (duration, speed, turn_rate) in pieces.filter(|(duration, ..)| *duration > 0.0) {
        let last = segments.last();
        let start = last.map_or(Pose::new(Vector::zeros(), 0.0), Segment::end);
        let time = last.map_or(0.0, Segment::end_time);
        segments.push(Segment::new(start, time, duration, speed, turn_rate));
    }
    Trajectory::new(segments).expect("a trajectory")
}

/// An arc of 2.5 lengths: radians to port.
fn arc(turn: f64, speed: f64) -> (f64, f64, f64) {
    let radius = 2.5 * LENGTH;
    let rate = turn.signum() * speed / radius;
    (turn.abs() * radius / speed, speed, rate)
}

/// Turns (radians, to port positive; arcs of 2.5 lengths) each followed by seconds of straight
/// line, from the origin east.
pub fn planned(legs: &[(f64, f64)], speed: f64) -> Trajectory {
    let pieces = |(turn, straight): &(f64, f64)| [arc(*turn, speed), (*straight, speed, 0.0)];
    joined(legs.iter().flat_map(pieces))
}

/// Legs in words, from the origin east: `20s` at 6 m/s, `20s@3` at 3 m/s, and `-8°`, a turn to
/// starboard at 6 m/s.
fn sailed(legs: &str) -> Trajectory {
    let number = |word: &str| word.parse::<f64>().expect("a number");
    joined(legs.split_whitespace().map(|word| {
        let Some(degrees) = word.strip_suffix('°') else {
            let (seconds, speed) = word.split_once('s').expect("seconds");
            let speed = speed.strip_prefix('@').unwrap_or("6");
            return (number(seconds), number(speed), 0.0);
        };
        arc(number(degrees).to_radians(), 6.0)
    }))
}

const HULL: Hull = Hull::new(LENGTH, 10.0);

/// Own ship at 6 m/s, with this hull and without a margin.
pub fn own_ship() -> OwnShip {
    OwnShip {
        speed: 6.0,
        hull: HULL,
        safety_margin: 0.0,
        ..ship_fixtures::own_ship(&[6.0])
    }
}

pub fn standard() -> &'static Thresholds {
    Thresholds::standard()
}

fn track(pose: Pose, speed: f64) -> ShipTrack {
    ShipTrack::exact(pose, speed, HULL)
}

/// Own ship and a target that holds course and speed.
pub fn steady(own: &Trajectory, x: f64, y: f64, heading: f64, speed: f64) -> EncounterSamples {
    let pose = Pose::new(Vector::new(x, y), heading);
    EncounterSamples::along(own, &own_ship(), &track(pose, speed))
}

const OUT_AND_BACK: [(f64, f64); 4] = [(0.0, 30.0), (-0.7, 90.0), (1.1, 50.0), (-0.4, 60.0)];

fn conduct(legs: &[(f64, f64)], x: f64, y: f64, heading: f64, speed: f64) -> ComplianceReport {
    let meeting = steady(&planned(legs, 6.0), x, y, heading, speed);
    ComplianceReport::judge(&meeting, standard())
}

fn rules(c: &ComplianceReport) -> Vec<&'static str> {
    c.violations.iter().map(|b| b.rule.word()).collect()
}

fn violated(c: &ComplianceReport) -> Vec<&'static str> {
    let is_violated = |f: &&MonitorResult| f.verdict == MonitorVerdict::Violated;
    let broken = c.monitors.iter().filter(is_violated);
    broken.map(|f| f.monitor.word()).collect()
}

#[test]
fn nothing_done_is_a_collision_and_scores_nothing() {
    for (x, y, heading, speed) in [
        (1440.0, 0.0, PI, 6.0),
        (720.0, -720.0, FRAC_PI_2, 6.0),
        (432.0, 0.0, 0.0, 2.4),
    ] {
        let idle = conduct(&[(0.0, 240.0)], x, y, heading, speed);
        assert_eq!(idle.scores.least(), 0.0);
        let mut scores = idle.scores.by_name().into_iter();
        assert!(scores.all(|(_, s)| s == 0.0), "{idle:?}");
        assert!(rules(&idle).contains(&"8(d)"));
        assert_eq!(violated(&idle)[..2], ["S", "R1"]);
    }
}

/// Reciprocal at 6 m/s each, hulls of one length: they meet when the centres are a length apart.
#[test]
fn how_late_she_turns_out_of_the_way_is_the_time_that_was_left() {
    let left = |turn_at: f64| {
        let legs = [(0.0, turn_at), (-0.9, 200.0)];
        let found = conduct(&legs, 1440.0, 0.0, PI, 6.0).monitors[1];
        assert_eq!(
            (found.monitor, found.measure),
            (Monitor::CollisionCourse, Measure::Time)
        );
        (found.verdict, found.robustness)
    };
    let meets = (1440.0 - HULL.length) / 12.0;
    let (verdict, seconds) = left(meets - 50.0);
    assert_eq!(verdict, MonitorVerdict::Satisfied);
    let seconds = seconds.expect("in extremis");
    assert!(seconds < 50.0 && seconds > 40.0, "{seconds}");
    assert_eq!(left(20.0), (MonitorVerdict::Idle, None));
    assert_eq!(left(meets), (MonitorVerdict::Violated, Some(0.0)));
    // the plan ends on the way to the meeting
    let own = planned(&[(0.0, meets - 30.0)], 6.0);
    let meeting = steady(&own, 1440.0, 0.0, PI, 6.0);
    let found = ComplianceReport::judge(&meeting, standard()).monitors[1];
    assert_eq!(found.verdict, MonitorVerdict::Undecided);
    assert!((found.robustness.expect("in extremis") - 30.0).abs() < 1e-6);
}

/// Turned about and moved, nothing changes; mirrored, the give-way ship stands on.
#[test]
fn the_judges_do_not_see_where_the_scene_lies() {
    let own = planned(&OUT_AND_BACK, 6.0);
    let judge = |angle: f64, by: Vector| {
        let turned = |p: &Pose| {
            let (sin, cos) = angle.sin_cos();
            let at = p.position;
            let at = Vector::new(at.x * cos - at.y * sin, at.x * sin + at.y * cos) + by;
            Pose::new(at, p.heading + angle)
        };
        let segments = own.segments().iter().map(|s| Segment {
            start: turned(&s.start),
            ..*s
        });
        let own = Trajectory::new(segments.collect()).expect("a trajectory");
        let crossing = Pose::new(Vector::new(720.0, -720.0), FRAC_PI_2);
        let target = track(turned(&crossing), 6.0);
        let samples = EncounterSamples::along(&own, &own_ship(), &target);
        ComplianceReport::judge(&samples, standard())
    };
    let here = judge(0.0, Vector::zeros());
    for k in 0..20 {
        let there = judge(0.3 * f64::from(k), Vector::new(5e4, -3e4));
        assert_eq!(here.roles.len(), there.roles.len());
        for (a, b) in here.scores.by_name().iter().zip(there.scores.by_name()) {
            assert!(a.0 == b.0 && (a.1 - b.1).abs() < 1e-6, "{a:?} {b:?}");
        }
        assert_eq!(rules(&here), rules(&there));
        assert_eq!(violated(&here), violated(&there));
    }
}

#[test]
fn what_is_not_a_number_is_a_collision() {
    let own = planned(&[(0.0, 60.0)], 6.0);
    let c = ComplianceReport::judge(&steady(&own, f64::NAN, 0.0, PI, 6.0), standard());
    assert_eq!(c.scores.safety, 0.0);
    assert_eq!(c.monitors[0].verdict, MonitorVerdict::Violated);
}

fn judged(legs: &str, target: [f64; 4]) -> ComplianceReport {
    let [x, y, heading, speed] = target;
    ComplianceReport::judge(&steady(&sailed(legs), x, y, heading, speed), standard())
}

/// Manoeuvres toward a target, and the rules and monitors that they violate.
const SEAMANSHIP: &str = "
    head-on in time | ahead | 20s -40° 300s |
    head-on late | far ahead | 310s -40° 200s | R4
    head-on small | ahead | 20s -15° 300s | R4
    head-on to port | ahead | 20s 40° 300s | 14(a) 14(a) R4
    head-on returns too soon | ahead | 20s -40° 60s 80° 150s | 14(a) 14(a)
    head-on returns when past and clear | ahead | 20s -40° 60s 40° 140s 60° 150s |
    head-on returns before that | ahead | 20s -40° 60s 40° 125s 60° 150s | 14(a)
    gives way | starboard | 20s -40° 400s |
    half speed for 200 s | starboard | 20s 200s@3 200s |
    half speed for 20 s | starboard | 20s 20s@3 -10° 300s | R3
    half speed from the beginning, for 29 s | starboard | 29s@3 -10° 300s | R3
    stands on until 12 lengths | port | 170s -60° 300s |
    stands on, turns early | port | 30s -60° 300s | 17(a)(i) R6
    stands on, slows early | port | 30s 300s@3 | 17(a)(i)
    stands on, late to port | port | 170s 60° 300s | 17(c)
    overtaken, late | astern | 200s -60° 300s |
    overtaken, turns early | astern | 30s -60° 300s | 17(a)(i) R6
    crosses ahead | fast from starboard | 20s 34° 60s -34° 130s | 15 15 8(d) R3
    holds on into a collision | port | 500s | 17(b) S R1
    makes many small turns | ahead | 8s -9° 8s -9° 8s -9° 8s -9° 8s 36° 60s | 8(b)
    overtakes to starboard | slower | 5s -40° 25s 40° 240s 23° 60s -23° 90s |
    overtakes to port | slower | 5s 40° 25s -40° 240s -23° 60s 23° 90s |
    overtakes and crosses ahead | slower | 5s -29° 40s 29° 45s 40° 90s | 13 8(d)
";

/// The judges name the rules that each manoeuvre of the table breaks, and no others.
#[test]
fn poor_seamanship_is_caught_by_its_rule() {
    let mut wrong = Vec::new();
    for [name, target, legs, broken] in rows(SEAMANSHIP) {
        let target = match target {
            // 400 s before the closest approach
            "far ahead" => [4800.0, 0.0, PI, 6.0],
            "ahead" => [2880.0, 0.0, PI, 6.0],
            "starboard" => [1440.0, -1440.0, FRAC_PI_2, 6.0],
            "port" => [1440.0, 1440.0, -FRAC_PI_2, 6.0],
            "fast from starboard" => [720.0, -720.0, FRAC_PI_2, 6.6],
            "slower" => [432.0, 0.0, 0.0, 2.4],
            _ => [-1080.0, 0.0, 0.0, 9.0],
        };
        let found = judged(legs, target);
        let violated: Vec<&str> = found.broken().collect();
        if violated.join(" ") != broken {
            wrong.push(format!("{name}: {violated:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn small_turns_and_a_course_ahead_of_the_target_lower_their_scores() {
    let small = "8s -9° 8s -9° 8s -9° 8s -9° 8s 36° 60s";
    let small = judged(small, [2880.0, 0.0, PI, 6.0]).scores;
    assert_eq!(small.rule_8, Some(0.0));
    let ahead = judged("20s 34° 60s -34° 130s", [720.0, -720.0, FRAC_PI_2, 6.6]).scores;
    let passes = judged("5s -29° 40s 29° 45s 40° 90s", [432.0, 0.0, 0.0, 2.4]).scores;
    assert!(ahead.rule_15 < ahead.rule_16, "{ahead:?}");
    assert!(passes.rule_13 < passes.rule_16, "{passes:?}");
}

/// A turn in ample time is not late, wherever the risk began; a later one is, by the way that the
/// ships have come nearer since.
#[test]
fn delay_counts_from_ample_time() {
    // the closest approach would be after 360 s
    let promptness = |turn_at: f64| {
        let legs = format!("{turn_at}s -60° 400s");
        let found = judged(&legs, [2160.0, -2160.0, FRAC_PI_2, 6.0]);
        let rule_16 = found.scores.rule_16.expect("gives way");
        let manoeuvre = found.manoeuvre.expect("a role");
        (rule_16 / found.scores.safety, manoeuvre)
    };
    let (early, manoeuvre) = promptness(10.0);
    assert_eq!((manoeuvre.turns, manoeuvre.speed_changes), (1, 0));
    assert!((manoeuvre.lead.expect("acts") - 350.0).abs() < 1e-6);
    assert!((manoeuvre.smallest_turn.expect("one") - 60_f64.to_radians()).abs() < 1e-9);
    assert_eq!(early, 1.0);
    assert_eq!(promptness(119.0).0, 1.0);
    // a quarter of the 240 s is gone, and more than a quarter of the way to the closest approach
    let (late, manoeuvre) = promptness(180.0);
    assert!((manoeuvre.lead.expect("acts") - 180.0).abs() < 1e-6);
    assert!(late < 0.75 && late > 0.6, "{late}");
}

/// Rows of a table with `|` between the cells, without empty rows and comments.
fn rows<const N: usize>(table: &'static str) -> impl Iterator<Item = [&'static str; N]> {
    let rows = table.lines().map(str::trim);
    let rows = rows.filter(|row| !row.is_empty() && !row.starts_with("//"));
    rows.map(|row| {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        cells.try_into().expect(row)
    })
}
