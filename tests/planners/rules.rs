//! Tests of plans by the rules, on scenes that are easily planned against them.

use searoom::colregs::Role;
use searoom::obstacle::SpaceTimeObstacle;
use searoom::pipeline::{self, Run};
use searoom::planner::{PlanMethod, SearchKind};
use searoom::scenario::Scenario;

use crate::campaigns::documents::{parsed, unhurried};
use crate::campaigns::encounter_generator::{EncounterKind, Meeting};
use crate::campaigns::meeting;

fn run(text: &str) -> Run {
    pipeline::run(parsed(text))
}

#[test]
fn no_rule_is_broken_where_none_need_be() {
    for text in [
        include_str!("../faults/rule-19.toml"),
        include_str!("../faults/rules-corner.toml"),
        include_str!("../faults/rules-later-role.toml"),
        include_str!("../faults/rules-length-of-one.toml"),
        include_str!("../faults/rules-slow-turn.toml"),
        include_str!("../faults/rules-starboard-to-starboard.toml"),
        include_str!("../faults/stop-by-the-rules.toml"),
    ] {
        let run = run(text);
        let title = &run.scenario.title;
        assert!(run.planned.outcome.plan().is_some(), "{title}");
        assert!(run.relaxations.is_empty(), "{title}");
        for report in run.judged_compliance().iter().flatten() {
            let broken: Vec<_> = report.broken().collect();
            assert!(broken.is_empty(), "{title}: {broken:?}");
        }
    }
}

/// A ship that cannot turn in time may stop where that is among its speeds.
#[test]
fn a_stop_lets_a_crosser_pass_where_no_turn_does() {
    let mut scenario = parsed(include_str!("../faults/stop-by-the-rules.toml"));
    let stops = pipeline::run(scenario.clone());
    let plan = stops.planned.outcome.plan().expect("a plan");
    assert_eq!(plan.method, PlanMethod::Rules);
    let segments = plan.trajectory.segments();
    assert!(
        segments
            .iter()
            .any(|s| s.speed == 0.0 && s.duration > 100.0)
    );
    scenario.own_ship.speeds.retain(|speed| *speed > 0.0);
    assert!(!pipeline::run(scenario).relaxations.is_empty());
}

/// The turn is made at the speed of its leg, 12 kn, though the mission ends with a leg of 6 kn.
#[test]
fn a_turn_is_made_at_the_ordered_speed_of_its_leg() {
    let run = run(include_str!("../faults/two-ordered-speeds.toml"));
    let plan = run.planned.outcome.plan().expect("a plan");
    assert_eq!(plan.method, PlanMethod::Rules);
    let legs = run.scenario.desired.legs();
    let segments = plan.trajectory.segments();
    let first = segments.iter().position(|s| s.is_arc()).expect("a turn");
    assert!(segments[first].end_time() < legs[1].start_time);
    for segment in &segments[..=first] {
        assert!((segment.speed - legs[0].speed).abs() < 1e-3, "{segment:?}");
    }
}

/// The route is too short for a line back onto it: own ship turns once, to the last waypoint.
#[test]
fn a_way_back_may_lead_to_the_last_waypoint() {
    for (text, most) in [
        (
            include_str!("../faults/goal-at-meeting-head-on.toml"),
            200.0,
        ),
        (
            include_str!("../faults/goal-at-meeting-give-way.toml"),
            120.0,
        ),
    ] {
        let run = run(text);
        let plan = run.planned.outcome.plan().expect("a plan");
        assert_eq!(plan.method, PlanMethod::Rules);
        assert!(
            run.relaxations.is_empty() && run.evaluation.as_ref().is_some_and(|e| e.verified())
        );
        for report in run.judged_compliance().iter().flatten() {
            assert_eq!(report.broken().count(), 0, "{report:?}");
        }
        let delay = plan.trajectory.end_time() - run.scenario.desired.duration();
        assert!(delay < most, "{delay}");
    }
}

/// The route ends before own ship could overtake and return: it follows the target, and arrives as soon as the last
/// waypoint is free. Before, it passed at half the domain, and came back over twice the distance: 228,610 m².
#[test]
fn a_ship_that_would_overtake_beside_the_last_waypoint_follows() {
    let run = run(include_str!("../faults/goal-at-meeting-overtaking.toml"));
    let plan = run.planned.outcome.plan().expect("a plan");
    assert_eq!(plan.method, PlanMethod::Rules);
    assert!(run.relaxations.is_empty() && run.evaluation.as_ref().is_some_and(|e| e.verified()));
    for report in run.judged_compliance().iter().flatten() {
        assert_eq!(report.broken().count(), 0, "{report:?}");
    }
    let end = run.scenario.desired.end();
    let is_free = |time| run.obstacles().all(|o| !o.contains(end, time));
    let arrives = plan.trajectory.end_time();
    assert!(is_free(arrives) && !is_free(arrives - 2.0), "{arrives}");
}

/// A bend that breaks no rule is taken in place of a manoeuvre that costs 250 times as much.
#[test]
fn no_detour_of_half_an_hour_is_made_for_a_manoeuvre_by_the_rules() {
    let run = run(include_str!("../faults/detour-by-the-rules.toml"));
    let plan = run.planned.outcome.plan().expect("a plan");
    assert_ne!(plan.method, PlanMethod::Rules);
    assert!(run.relaxations.is_empty());
    for report in run.judged_compliance().iter().flatten() {
        assert_eq!(report.broken().count(), 0, "{report:?}");
    }
    let delay = plan.trajectory.end_time() - run.scenario.desired.duration();
    assert!(delay.abs() < 300.0, "{delay}");
}

/// A manoeuvre in half the domain took nine minutes more than one in a smaller domain, or one in the whole domain
/// fifteen, because the held course is clear of half the domain, though within a length of the target (Rule 8(d)).
#[test]
fn a_dear_manoeuvre_gives_way_to_a_lawful_one_in_smaller_domains() {
    for (text, most) in [
        (include_str!("../faults/dear-in-smaller-domains.toml"), 30.0),
        (
            include_str!("../faults/held-course-within-a-length.toml"),
            240.0,
        ),
    ] {
        let run = run(text);
        let plan = run.planned.outcome.plan().expect("a plan");
        assert_eq!(plan.method, PlanMethod::Rules);
        assert!(run.evaluation.as_ref().is_some_and(|e| e.verified()));
        for report in run.judged_compliance().iter().flatten() {
            assert_eq!(report.broken().count(), 0, "{report:?}");
        }
        let delay = plan.trajectory.end_time() - run.scenario.desired.duration();
        assert!(delay < most, "{}: {delay}", run.scenario.title);
    }
}

/// The target is on own starboard beam, near, and on nearly the same course.
#[test]
fn a_turn_at_less_speed_where_neither_alone_keeps_the_rules() {
    for seed in [14, 193, 277, 742] {
        let run = pipeline::run(meeting(EncounterKind::GiveWay, seed, &Meeting::NEAR));
        let plan = run.planned.outcome.plan().expect("a plan");
        let mut segments = plan.trajectory.segments().iter();
        assert!(
            segments.any(|s| s.turn_rate < 0.0 && s.speed <= 2.5),
            "{seed}"
        );
        for report in run.judged_compliance().iter().flatten() {
            assert_eq!(report.broken().count(), 0, "{seed} {report:?}");
        }
    }
}

/// Ships that come from any side in restricted visibility, and the side to which own ship turns.
#[test]
fn in_restricted_visibility_own_ship_turns_away() {
    let scene = include_str!("../faults/rule-19.toml");
    for (from, role, starboard) in [
        ((1500.0, 1500.0, 180.0, 5.0), Role::Rule19Forward, true),
        ((1500.0, -1500.0, 0.0, 5.0), Role::Rule19Forward, true),
        ((2800.0, 0.0, 270.0, 5.0), Role::Rule19Forward, true),
        ((-300.0, -1500.0, 50.0, 8.0), Role::Rule19Starboard, false),
        ((-300.0, 1500.0, 130.0, 8.0), Role::Rule19Port, true),
    ] {
        let (east, north, course, speed) = from;
        let text = scene.replace(
            "east_m = 1500.0, north_m = 1500.0",
            &format!("east_m = {east:?}, north_m = {north:?}"),
        );
        let text = text.replace(
            "course_deg = 180.0\nspeed_mps = 5.0",
            &format!("course_deg = {course:?}\nspeed_mps = {speed:?}"),
        );
        let run = run(&text);
        assert_eq!(run.targets[0].sets.encounter.role, role, "{from:?}");
        let plan = run.planned.outcome.plan().expect("a plan");
        let turns = plan.trajectory.segments().iter().map(|s| s.turn_rate);
        let mut turns = turns.filter(|rate| *rate != 0.0);
        let first = turns.next();
        assert!(run.relaxations.is_empty(), "{from:?} {:?}", run.relaxations);
        assert!(
            first.is_none_or(|rate| (rate < 0.0) == starboard),
            "{from:?}"
        );
        for report in run.judged_compliance().iter().flatten() {
            assert_eq!(report.roles[0].role, role);
            assert!(report.complies(), "{from:?} {report:?}");
        }
    }
}

#[test]
fn a_ship_does_not_slow_down_just_ahead_of_one_that_it_has_overtaken() {
    let run = run(include_str!("../faults/rules-hampered.toml"));
    assert!(run.planned.outcome.plan().is_some());
    let reports = run.judged_compliance();
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

/// A longer horizon offers more escapes, a turn back among them. Own ship does not hold on until
/// that is the only one left.
#[test]
fn time_to_turn_back_makes_no_stand_on_ship_wait_for_it() {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/faults/stand-on-turn-back.toml"
    );
    let cost = |horizon: f64| {
        let mut scenario = unhurried(Scenario::read(file.as_ref()).expect("valid"));
        scenario.horizon = horizon;
        let run = pipeline::run(scenario);
        assert!(run.relaxations.is_empty());
        assert!(run.planned.escape.is_some());
        let reports = run.judged_compliance();
        assert!(reports.iter().flatten().all(|report| report.complies()));
        run.planned.outcome.plan().expect("a plan").cost
    };
    let [short, long] = [2000.0, 4000.0].map(cost);
    assert!(long < 1.001 * short, "{long} {short}");
}

/// The bound of A* is one: the least price is that of Dijkstra's algorithm, which expands no fewer
/// nodes. Both search the graph of manoeuvres, and say what they have seen.
#[test]
fn dijkstra_finds_the_same_manoeuvres_from_more_nodes() {
    let (mut nodes, mut fewer) = ([0, 0], 0);
    for (kind, seed) in EncounterKind::with_seeds(570..582) {
        let scenario = meeting(kind, seed, &Meeting::NEAR);
        let runs = [SearchKind::AStar, SearchKind::Dijkstra].map(|search| {
            pipeline::run(Scenario {
                search,
                ..scenario.clone()
            })
        });
        let plans = runs
            .each_ref()
            .map(|run| run.planned.outcome.plan().expect("a plan"));
        let about = format!("{kind:?} {seed}");
        assert_eq!(plans[0].method, plans[1].method, "{about}");
        if plans[0].method != PlanMethod::Rules {
            continue;
        }
        let [a_star, dijkstra] = plans.map(|plan| plan.cost);
        let about = format!("{kind:?} {seed}: {a_star} {dijkstra}");
        assert!((a_star - dijkstra).abs() <= 1e-9 * dijkstra, "{about}");
        let expanded = runs
            .each_ref()
            .map(|run| run.planned.stats.expect("a search").expanded);
        assert!(
            expanded[0] > 0 && expanded[0] <= expanded[1],
            "{about} {expanded:?}"
        );
        assert!(runs[0].planned.explored.edge_count() > 0, "{about}");
        fewer += usize::from(expanded[0] < expanded[1]);
        nodes = [nodes[0] + expanded[0], nodes[1] + expanded[1]];
    }
    println!("{nodes:?} nodes, fewer in {fewer}");
    assert!(fewer > 30, "fewer nodes in {fewer} of 60");
}
