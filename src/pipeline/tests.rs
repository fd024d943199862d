//! Which sets are used, what is given up, and what the evaluation sees.

use super::*;
use crate::colregs::Role;
use crate::frame::{Pose, Vector};
use crate::geometry::ConvexPolygon;
use crate::obstacle::PolytopeObstacle;
use crate::planner::SearchKind;
use crate::planner::path_time::PathTimePlanner;
use crate::scenario::Compliance;
use crate::ship_fixtures::own_ship;
use crate::simulation::{EncounterKind, Placement, random_encounter, random_traffic};
use crate::target::{DomainKind, Motion, Representation, ShipTrack, Target, Uncertainty};
use crate::tolerance;
use crate::trajectory::{DesiredTrajectory, Segment, Trajectory};
use crate::vessel::Hull;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::{FRAC_PI_2, PI};

mod land;
mod last_moments;

fn released(run: &Run) -> Vec<Option<f64>> {
    run.targets.iter().map(|target| target.released).collect()
}

fn polytope(o: &Obstacle) -> &PolytopeObstacle {
    o.as_polytope().expect("a polytope")
}

fn scenario(target: ShipTrack, compliance: Compliance) -> Scenario {
    let points = [Vector::zeros(), Vector::new(1500.0, 0.0)];
    Scenario {
        title: "one target".to_owned(),
        horizon: 400.0,
        own_ship: own_ship(&[2.5, 5.0, 6.0]),
        desired: DesiredTrajectory::new(&points, &[5.0]).expect("valid"),
        targets: vec![Target {
            name: "other".to_owned(),
            motion: Motion::Ship(target),
            representation: Representation::Polytope,
            status: None,
        }],
        compliance,
        deadline: 5.0,
        ..random_traffic(0, 0, Placement::Origin)
            .expect("drawn")
            .scenario
    }
}

fn track(x: f64, y: f64, heading: f64, speed: f64) -> ShipTrack {
    let pose = Pose::new(Vector::new(x, y), heading);
    ShipTrack {
        speed_spread: 0.5,
        course_spread: 0.08,
        domain: DomainKind::Colregs,
        ..ShipTrack::exact(pose, speed, Hull::new(60.0, 12.0))
    }
}

#[test]
fn compliance_chooses_the_sets() {
    let target = track(1500.0, 0.0, PI, 5.0);
    let with_domain = run(scenario(target.clone(), Compliance::Shape));
    let hard = run(scenario(target, Compliance::None));
    assert_eq!(with_domain.targets[0].sets.encounter.role, Role::HeadOn);
    assert_eq!(
        with_domain.targets[0].obstacle,
        with_domain.targets[0].sets.with_domain
    );
    assert_eq!(hard.targets[0].obstacle, hard.targets[0].sets.hard);
    assert!(with_domain.relaxations.is_empty() && hard.relaxations.is_empty());
    let areas = |run: &Run| polytope(&run.targets[0].obstacle).initial().area();
    assert!(areas(&with_domain) > 2.0 * areas(&hard));
}

#[test]
fn a_domain_over_the_start_is_reduced_and_reported() {
    let target = track(100.0, -50.0, FRAC_PI_2, 5.0);
    let relaxed = run(scenario(target.clone(), Compliance::Shape));
    assert!(matches!(
        relaxed.relaxations.as_slice(),
        [Relaxation::Domain { target, amount }] if target == "other" && *amount > 1.0
    ));
    let start = relaxed.scenario.own_ship.pose.position;
    assert!(
        polytope(&relaxed.targets[0].obstacle)
            .slack(start, 0.0)
            .value
            > 0.0
    );
    // the hard sets have no domain
    assert!(
        run(scenario(target, Compliance::None))
            .relaxations
            .is_empty()
    );
}

/// Own ship starts at the edge of a domain that then grows over it. No plan is clear of the domain;
/// one is clear of the reduced domain, which contains the hard set, and the run reports the
/// reduction.
#[test]
fn domains_that_no_plan_clears_are_reduced_as_far_as_the_plan_needs() {
    let drawn = random_encounter(EncounterKind::GiveWay, 104, Placement::Origin);
    let run = run(drawn.expect("drawn").scenario);
    let sets = &run.targets[0].sets;
    assert!(sets.shape_reduced > 0.0 && run.level == RelaxationLevel::ReducedDomains);
    let initial = |set: &Obstacle| polytope(set).initial().clone();
    let (kept, hard) = (initial(&run.targets[0].obstacle), initial(&sets.hard));
    for corner in hard.vertices() {
        assert!(kept.signed_distance(*corner) < tolerance::LENGTH_M);
    }
    let [Relaxation::Domain { amount, .. }] = &run.relaxations[..] else {
        panic!("{:?}", run.relaxations);
    };
    assert!(*amount > sets.shape_reduced && *amount <= sets.shape_reach);
    assert!(run.evaluation.is_some_and(|e| e.verified()));
}

/// A ship on the opposite course in a channel of ships at rest: no way around.
fn in_a_channel(spread: f64) -> Scenario {
    let mut scenario = scenario(track(1500.0, 0.0, PI, 5.0), Compliance::Shape);
    let wide = |x: f64, y: f64| {
        ConvexPolygon::hull(&[
            Vector::new(x, y),
            Vector::new(x + 2400.0, y),
            Vector::new(x + 2400.0, y + 3000.0),
            Vector::new(x, y + 3000.0),
        ])
        .expect("a box")
    };
    let at_rest = ConvexPolygon::point(Vector::zeros());
    for (name, y) in [("north", 60.0), ("south", -3160.0)] {
        scenario.targets.push(Target {
            name: name.to_owned(),
            motion: Motion::Sets(Uncertainty::constant(wide(-400.0, y), at_rest.clone())),
            representation: Representation::Polytope,
            status: None,
        });
    }
    let lateral = |v: f64| Vector::new(-5.0, v);
    let ahead = [
        (1480.0, 20.0),
        (1520.0, 20.0),
        (1520.0, 60.0),
        (1480.0, 60.0),
    ];
    scenario.targets[0].motion = Motion::Sets(Uncertainty::constant(
        ConvexPolygon::hull(&ahead.map(|(x, y)| Vector::new(x, y))).expect("a box"),
        ConvexPolygon::hull(&[lateral(spread), lateral(-spread)]).expect("a segment"),
    ));
    scenario
}

/// The ship ahead may drift across the channel, so passing it takes a risk. It is the least to one
/// step: the planner finds a plan at this risk, and none at two steps less.
#[test]
fn without_a_plan_clear_of_the_hard_sets_the_least_risk_is_taken_and_reported() {
    assert_eq!(run(in_a_channel(0.1)).level, RelaxationLevel::Compliant);
    let scenario = in_a_channel(2.0);
    let run = run(scenario.clone());
    assert_eq!(run.level, RelaxationLevel::Risk);
    assert!(
        run.max_risk > 2.0 * RISK_STEP && run.evaluation.as_ref().is_some_and(|e| e.verified())
    );
    let [
        Relaxation::Risk {
            target,
            amount,
            until: None,
        },
    ] = &run.relaxations[..]
    else {
        panic!("{:?}", run.relaxations);
    };
    assert!(
        target == "other" && *amount <= run.max_risk && *amount > run.max_risk - 2.0 * RISK_STEP
    );
    let at = |max_risk: f64| {
        super::run(Scenario {
            max_risk,
            ..scenario.clone()
        })
        .level
    };
    assert_eq!(at(run.max_risk - 2.0 * RISK_STEP), RelaxationLevel::Risk);
    assert_eq!(at(run.max_risk), RelaxationLevel::Compliant);
}

fn fault(name: &str) -> Scenario {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/faults");
    Scenario::read(&folder.join(name)).expect("a scenario")
}

/// Own ship may stop until the set has gone. The path leads back to the start, but is still to be
/// sailed.
#[test]
fn a_stop_at_the_start_of_a_round_trip_is_no_arrival() {
    let run = run(fault("round_trip_from_inside.toml"));
    let evaluation = run.evaluation.expect("a plan");
    assert!(evaluation.verified(), "{:?}", evaluation.violations);
}

/// A target crosses near the start. The short way to the end would be clear of it and early.
#[test]
fn round_trips_are_sailed() {
    for name in ["round-trip.toml", "near-round-trip.toml"] {
        let run = run(fault(name));
        let (judged, length) = (
            run.evaluation.expect("a plan"),
            run.scenario.desired.length(),
        );
        assert!(judged.verified() && judged.safe(), "{name}");
        let (sailed, late) = (judged.length, judged.delay);
        assert!(sailed > 0.9 * length, "{name}: {sailed} m of {length} m");
        assert!(late > -60.0, "{name}: {late} s");
    }
}

/// No plan comes to a waypoint beside a moored ship. It ends before that ship's set, by the rules
/// toward another ship on the way.
#[test]
fn a_set_over_the_last_waypoint_costs_the_arrival_alone() {
    for compliance in [Compliance::None, Compliance::Shape, Compliance::Rules] {
        let run = run(Scenario {
            compliance,
            ..fault("moored-at-the-end.toml")
        });
        assert!(
            run.safe() && !run.enters() && !run.arrives(),
            "{compliance:?}"
        );
        assert!(!run.gives_up_rules(), "{compliance:?}");
        let why = run.reason().expect("a reason");
        assert!(why.starts_with("the last waypoint is inside sets"), "{why}");
        let left = run.planned.outcome.plan().expect("a plan").to_go;
        // 50 m beside the other, whose set reaches farther by half a hull each, and the margin
        assert!((120.0..200.0).contains(&left), "{left} m");
        let arrival = run.relaxations.iter().any(|r| {
            matches!(r, Relaxation::Arrival { target, amount } if target == "moored" && *amount == left)
        });
        assert!(arrival, "{:?}", run.relaxations);
        let evaluation = run.evaluation.expect("judged");
        assert!(evaluation.verified() && evaluation.delay.is_nan());
        let crossing = &evaluation.passages[1];
        assert!(crossing.min_clearance > 150.0, "{}", crossing.min_clearance);
    }
}

fn changes_of_speed(trajectory: &Trajectory) -> usize {
    let segments = trajectory.segments().windows(2);
    segments
        .filter(|pair| pair[0].speed != pair[1].speed)
        .count()
}

/// A ship close ahead may go anywhere, faster than own ship, so no motion leaves its set. On its
/// nominal track it crosses ahead: own ship rams it at full speed and passes astern of it at low
/// speed.
#[test]
fn where_no_motion_leaves_the_sets_own_ship_slows_and_meets_no_nominal_hull() {
    for deadline in [60.0, 0.0] {
        let scenario = Scenario {
            deadline,
            ..fault("deadline-escape.toml")
        };
        let run = run(scenario);
        assert_eq!(run.level, RelaxationLevel::Inside);
        let is_late = matches!(run.planned.outcome, Outcome::Deadline(_));
        assert_eq!(is_late, deadline == 0.0);
        let trajectory = &run.planned.outcome.plan().expect("a plan").trajectory;
        assert_eq!(released(&run), [Some(trajectory.end_time())]);
        let first = trajectory.segments()[0];
        assert!(first.speed < 0.5 * run.scenario.own_ship.speed, "{first:?}");
        assert!(changes_of_speed(trajectory) <= 2);
        let judged = run.evaluation.expect("judged");
        assert!(judged.verified() && judged.passages[0].dcpa > 15.0);
    }
}

/// Alongside one ship and with another ahead; the time is up before anything is planned.
#[test]
fn out_of_time_own_ship_still_meets_no_nominal_hull() {
    let scenario = Scenario {
        deadline: 0.0,
        ..fault("deadline-without-relaxation.toml")
    };
    let run = run(scenario);
    assert_eq!(run.level, RelaxationLevel::Inside);
    let trajectory = &run.planned.outcome.plan().expect("a plan").trajectory;
    assert!(changes_of_speed(trajectory) <= 2);
    let judged = run.evaluation.expect("judged");
    assert!(judged.verified() && judged.passages.iter().all(|p| p.dcpa > 0.0));
}

/// Own ship rests at the last waypoint, in a set: it has arrived, and nothing is claimed of the
/// set.
#[test]
fn at_the_goal_inside_a_set_own_ship_has_arrived() {
    let run = run(fault("infeasible-at-goal.toml"));
    assert_eq!(run.level, RelaxationLevel::Inside);
    assert_eq!(released(&run), [Some(run.scenario.horizon)]);
    let trajectory = &run.planned.outcome.plan().expect("a plan").trajectory;
    assert_eq!(trajectory.end_time(), 0.0);
    assert!(matches!(
        run.relaxations[0],
        Relaxation::Risk { until: Some(_), .. }
    ));
    assert!(run.evaluation.expect("judged").verified());
}

/// Own ship turns away from a ship close ahead and slows until it has left its set; the distance
/// never decreases. From then on it is clear of the set, and always clear of a set that it does not
/// start in.
#[test]
fn from_within_a_hard_set_own_ship_slows_and_turns_away_and_claims_begin_outside() {
    let mut scenario = scenario(track(70.0, 20.0, 0.4, 3.0), Compliance::Shape);
    scenario.own_ship.safety_margin = 80.0;
    let mut beside = scenario.targets[0].clone();
    beside.name = "beside".to_owned();
    beside.motion = Motion::Ship(track(0.0, -260.0, 0.0, 4.0));
    scenario.targets.push(beside);
    let run = run(scenario);
    assert_eq!(run.level, RelaxationLevel::Inside);
    let [Some(until), None] = released(&run)[..] else {
        panic!("{:?}", released(&run));
    };
    let trajectory = &run.planned.outcome.plan().expect("a plan").trajectory;
    let hard = &run.targets[0].sets.hard;
    let depth = |at: Vector, t: f64| -hard.signed_distance(at, t).distance;
    for t in trajectory.sample_times(0.1, 10_000) {
        let deep = depth(trajectory.pose_at(t).position, t);
        assert!(
            if t < until { deep > -1e-6 } else { deep < 1e-6 },
            "{deep} at {t}"
        );
    }
    assert!(
        matches!(&run.relaxations[0], Relaxation::Risk { target, amount, until: Some(_) } if target == "other" && *amount == 1.0)
    );
    let inside = trajectory.segments().iter();
    let inside: Vec<Segment> = inside
        .copied()
        .take_while(|s| s.start_time < until - 1e-3)
        .collect();
    assert!(inside.iter().all(|s| s.speed == 2.5) && inside[0].turn_rate < 0.0);
    // hardly longer than on the slow turn to starboard that it begins with
    let turning = Segment {
        duration: 400.0,
        turn_rate: -2.5 / 100.0,
        ..inside[0]
    };
    let mut times = (0..4000).map(|k| 0.1 * f64::from(k));
    let out = times.find(|&t| depth(turning.pose_at(t).position, t) < 0.0);
    assert!(out.is_some_and(|out| until < 1.05 * out), "{until} {out:?}");
    let judged = run.evaluation.expect("judged");
    assert!(judged.verified());
    // at full speed and least time inside: 16.5 m
    let other = run.scenario.targets[0].ship().expect("a ship");
    let own = run.scenario.own_ship.hull.polygon(&inside[0].start);
    let start = own.separation(&other.hull.polygon(&other.pose));
    assert!(judged.min_clearance > start - 1.0, "{start}");
}

/// At full speed own ship would leave the set 1.7 s earlier. It leaves at its least speed, comes no
/// nearer to the other ship than at the start. The plan that follows is tidy, and so changes speed three times at
/// most.
#[test]
fn out_of_a_set_the_lowest_speed_that_is_about_as_soon_and_then_few_changes() {
    let run = run(fault("leaves-slowly.toml"));
    assert_eq!(run.level, RelaxationLevel::Inside);
    let [Some(until), None, None] = released(&run)[..] else {
        panic!("{:?}", released(&run));
    };
    assert!((9.0..10.5).contains(&until), "{until}");
    let trajectory = &run.planned.outcome.plan().expect("a plan").trajectory;
    assert_eq!(trajectory.speed_at(0.9 * until), 1.0);
    let at_the_exit = 1;
    assert!(changes_of_speed(trajectory) <= at_the_exit + 3);
    let judged = run.evaluation.expect("judged");
    assert!(judged.verified());
    assert!(judged.passages[0].dcpa > 25.0);
    assert!(judged.min_clearance > 8.0, "{}", judged.min_clearance);
}

/// The last level: no exit leaves the box before the horizon. Own ship slows until the box has moved
/// away from it; nothing is claimed before.
#[test]
fn where_no_exit_leaves_the_sets_own_ship_slows_and_reports_it() {
    let mut scenario = in_a_channel(0.0);
    let around = [
        (-900.0, -900.0),
        (900.0, -900.0),
        (900.0, 900.0),
        (-900.0, 900.0),
    ];
    let around = around.map(|(x, y)| Vector::new(x, y));
    scenario.targets[0].motion = Motion::Sets(Uncertainty::constant(
        ConvexPolygon::hull(&around).expect("a box"),
        ConvexPolygon::point(Vector::new(5.0, 0.0)),
    ));
    let off_paths = run(scenario.clone());
    assert_eq!(off_paths.level, RelaxationLevel::Inside);
    let plan = off_paths.planned.outcome.plan().expect("a plan");
    let end = plan.trajectory.end_time();
    let released_at = released(&off_paths);
    assert!(released_at[0].is_some_and(|left| left > 300.0 && left <= end));
    assert_eq!(released_at[1..], [None, None]);
    assert!(off_paths.evaluation.expect("judged").verified());
    // along its path it stops, and the box, 900 m to its edge at 5 m/s, moves away
    let along = run(Scenario {
        planner: &PathTimePlanner,
        ..scenario
    });
    assert_eq!(along.level, RelaxationLevel::Inside);
    let [Some(until), None, None] = released(&along)[..] else {
        panic!("{:?}", released(&along));
    };
    assert!((until - 180.0).abs() < 1.0, "{until}");
    let plan = along.planned.outcome.plan().expect("a plan");
    assert_eq!(plan.trajectory.speed_at(0.5 * until), 0.0);
    assert!(plan.to_go > 0.0 && along.evaluation.expect("judged").verified());
}

/// A set that grows over the path is passed at a risk. How little is not looked for when the time
/// is up.
#[test]
fn out_of_time_no_more_risks_are_weighed() {
    let text = r#"
        title = "beside"
        horizon_s = 100.0
        own_ship = { position = { east_m = 0.0, north_m = 0.0 }, course_deg = 90.0, speed_mps = 5.0, length_m = 10.0,
            beam_m = 3.0, turning_radius_m = 50.0, safety_margin_m = 0.0 }
        mission = { waypoints = [{ east_m = 0.0, north_m = 0.0 }, { east_m = 300.0, north_m = 0.0 }] }
        planner = { kind = "path-time", objective = "length-risk", risk_weight_m = 100.0, max_risk = 0.9 }
        [[targets]]
        name = "growing"
        initial_set = { vertices_m = [[140.0, 20.0], [160.0, 20.0], [160.0, 40.0], [140.0, 40.0]] }
        velocity_set = { vertices_mps = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]] }
    "#;
    let answer = |deadline: f64| {
        let parsed = Scenario::parse(text).expect("a scenario");
        run(Scenario { deadline, ..parsed }).planned.outcome
    };
    let (Outcome::Solved(best), Outcome::Deadline(Some(quick))) = (answer(60.0), answer(0.0))
    else {
        panic!("a plan in time, and one out of time");
    };
    assert!(best.cost < quick.cost, "{} {}", best.cost, quick.cost);
}

/// Three ships leave no way near the path: a wide detour is found, clear of every hard set.
#[test]
fn a_wide_detour_is_found_where_no_plan_stays_near_the_path() {
    use crate::scenario::import::{Assumed, Contents};
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenarios/dnv/traffic_situation_47.json");
    let assumed = Assumed::default();
    let contents = Contents::read(&file, &assumed).expect("readable");
    let Contents::Situations(situations) = contents else {
        panic!("a situation");
    };
    let situation = situations.into_iter().next().expect("one").expect("sound");
    let mut scenario = situation.scenario(&assumed).expect("no faults").scenario;
    scenario.deadline = 60.0;
    let run = run(scenario);
    assert!(run.level < RelaxationLevel::Risk && run.max_risk == 0.0);
    assert!(run.risks().iter().all(|peak| peak.risk == 0.0));
    assert!(run.evaluation.is_some_and(|e| e.verified()));
}

#[test]
fn the_time_of_no_return_is_between_the_start_and_the_first_contact() {
    let at = |x: f64, y: f64| run(scenario(track(x, y, PI, 5.0), Compliance::Shape)).no_return();
    let Some(NoReturn::At(time)) = at(1500.0, 0.0) else {
        panic!("there is a time");
    };
    assert!(time > 60.0 && time < 145.0, "{time}");
    assert_eq!(at(1500.0, 5000.0), Some(NoReturn::Never));
    assert_eq!(at(60.0, 0.0), Some(NoReturn::Past));
}

/// The time is up before anything is planned again: own ship keeps its plan, which has entered a
/// ship domain but no hard set.
#[test]
fn out_of_time_own_ship_keeps_a_plan_that_is_clear_of_the_hard_sets() {
    let drawn = random_encounter(EncounterKind::GiveWay, 293, Placement::Origin);
    let mut first = drawn.expect("drawn").scenario;
    first.compliance = Compliance::Rules;
    let before = run(first.clone());
    assert!(!before.relaxations.is_empty() && before.safe());
    let trajectory = &before.planned.outcome.plan().expect("a plan").trajectory;
    let elapsed = 40.0;
    let mut scenario = first.clone();
    scenario.time += elapsed;
    scenario.desired = first.desired.remaining(elapsed);
    scenario.own_ship.pose = trajectory.pose_at(elapsed);
    if let Motion::Ship(ship) = &mut scenario.targets[0].motion {
        ship.pose = ship.pose_at(elapsed);
    }
    let previous = crate::replanning::PreviousPlan::of(&before).expect("a plan");
    crate::replanning::remember(&previous, &mut scenario).expect("own ship is on its plan");
    scenario.deadline = 0.0;
    let after = run(scenario);
    assert!(matches!(after.planned.outcome, Outcome::Deadline(Some(_))));
    assert!(after.planned.is_remainder() && after.safe());
    assert_eq!(after.level, RelaxationLevel::ReducedDomains);
}

/// The hard set contains, for every course of the target, its hull on that heading and own hull on
/// any heading a margin away.
#[test]
fn the_hard_set_contains_the_hull_at_every_heading() {
    let mut rng = ChaCha8Rng::seed_from_u64(41);
    for case in 0..200 {
        let mut within = |a: f64, b: f64| rng.random_range(a..b);
        let mut ship = track(900.0, 0.0, within(-PI, PI), within(0.0, 9.0));
        ship.hull.length = within(5.0, 200.0);
        ship.hull.beam = within(0.1, 0.5) * ship.hull.length;
        ship.course_spread = within(0.0, 0.2);
        ship.turn_rate = [0.0, 1e-3, 0.02][case % 3];
        let mut asked = scenario(ship.clone(), Compliance::Shape);
        if ship.turn_rate == 0.0 && case % 2 == 0 {
            asked.targets[0].representation = Representation::Ellipsoid;
        }
        let sets = sets(&asked);
        let reach = asked.own_ship.hull.half_diagonal() + asked.own_ship.safety_margin;
        for _ in 0..5 {
            let (turns, speed) = (within(-1.0, 1.0), ship.speed + within(-0.5, 0.5));
            let (mut pose, mut time, step) = (ship.pose, 0.0, 0.5);
            while time < asked.horizon {
                let course = turns * (ship.course_spread + ship.turn_rate * time);
                pose.heading = ship.pose.heading + course;
                let hull = ship.hull.polygon(&pose);
                for corner in hull.vertices() {
                    let depth = -sets[0].hard.signed_distance(*corner, time).distance;
                    assert!(
                        depth > reach - 1e-6,
                        "{depth} of {reach}, {time} s, {ship:?}"
                    );
                }
                pose.position += pose.ahead() * (speed.max(0.0) * step);
                time += step;
            }
        }
    }
}

/// The time is up before anything is found: the run reports what is known.
#[test]
fn out_of_time_there_is_still_an_answer() {
    let mut scenario = scenario(track(1500.0, 0.0, PI, 5.0), Compliance::Shape);
    scenario.deadline = 0.0;
    let run = run(scenario);
    assert!(matches!(run.planned.outcome, Outcome::Deadline(Some(_))));
    assert!(run.evaluation.is_some_and(|e| e.verified()));
    assert!(matches!(
        run.relaxations[0],
        Relaxation::Risk { until: Some(_), .. }
    ));
}

/// Own ship starts in a set, and the time is up before a way out and on is found. To join the path
/// where it begins takes a full turn, for which the horizon is too short.
#[test]
fn out_of_time_a_start_inside_is_not_called_infeasible() {
    let in_time = fault("inside-out-of-time.toml");
    let out_of_time = run(Scenario {
        deadline: 0.0,
        ..in_time.clone()
    });
    assert!(matches!(
        out_of_time.planned.outcome,
        Outcome::Deadline(Some(_))
    ));
    assert!(matches!(run(in_time).planned.outcome, Outcome::Solved(_)));
}

/// Own ship starts in a set, but without any set the horizon would be too short as well.
#[test]
fn the_reason_is_the_horizon_where_no_set_could_be_away() {
    let file = fault("inside-with-a-short-horizon.toml");
    for deadline in [0.0, 20.0] {
        let run = run(Scenario {
            deadline,
            ..file.clone()
        });
        let outcome = &run.planned.outcome;
        let is_horizon = matches!(outcome, Outcome::Infeasible(NoPlan::HorizonTooShort { .. }));
        assert!(is_horizon, "{outcome:?}");
        assert!(run.relaxations.is_empty(), "{:?}", run.relaxations);
    }
}

/// A thorough search notes its answers, the last of which is the plan.
#[test]
fn a_thorough_search_notes_what_it_found_and_when() {
    let of = |search| {
        run(Scenario {
            compliance: Compliance::Shape,
            search,
            ..fault("rules-role-on-the-plan.toml")
        })
    };
    let [quick, thorough] = [SearchKind::AStar, SearchKind::Thorough].map(of);
    let cost = |run: &Run| run.planned.outcome.plan().expect("a plan").cost;
    let found = &thorough.planned.improvements;
    assert!(quick.planned.improvements.is_empty());
    assert!(
        found.len() > 1 && found[0].cost == cost(&quick),
        "{found:?}"
    );
    assert_eq!(found[found.len() - 1].cost, cost(&thorough));
    for pair in found.windows(2) {
        assert!(pair[1].cost < pair[0].cost && pair[1].after > pair[0].after);
    }
    assert!(found[found.len() - 1].after < thorough.plan_time);
}

#[test]
fn the_evaluation_finds_the_nominal_trajectory_in_the_set() {
    let scenario = scenario(track(1500.0, 0.0, PI, 5.0), Compliance::Shape);
    let sets = sets(&scenario);
    let straight = Segment::straight(scenario.own_ship.pose, 0.0, 300.0, 5.0).into();
    let judged = judge(&scenario, &[sets[0].with_domain.clone()], &straight);
    assert!(!judged.verified());
    assert!(
        judged
            .violations
            .iter()
            .any(|v| v.what.starts_with("set of 'other'"))
    );
    assert!(
        judged
            .violations
            .iter()
            .any(|v| v.what.starts_with("hull of 'other'"))
    );
    assert!(judged.space_time_error.abs() < 1e-9 && judged.delay.abs() < 1e-9);
}
