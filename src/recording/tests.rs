//! A recording is read back as a user's tools would read it.

use std::collections::BTreeMap;
use std::time::Duration;

use rerun::{ChunkStore, ChunkStoreConfig};

use super::*;
use crate::colregs::{Encounter, Role};
use crate::evaluation::{Evaluation, Passage};
use crate::frame::{Pose, Side, Vector, direction, heading_from_course_deg};
use crate::geometry::{ConvexPolygon, outer_disc};
use crate::obstacle::PolytopeObstacle;
use crate::pipeline::TargetSets;
use crate::planner::{
    EdgeVerdict, ExploredEdge, ExploredGraph, ExploredNode, NoPlan, NodeKind, Outcome, Plan,
    Planned, SearchKind, SearchStats,
};
use crate::scenario::{Compliance, Scenario};
use crate::target::{DomainKind, Motion, ShipTrack, Target};
use crate::trajectory::{DesiredTrajectory, Segment, Trajectory};
use crate::vessel::{Hull, OwnShip};

fn own_ship() -> OwnShip {
    OwnShip {
        pose: Pose::new(Vector::zeros(), heading_from_course_deg(90.0)),
        speed: 5.0,
        hull: Hull {
            length: 30.0,
            beam: 8.0,
        },
        turning_radius: 100.0,
        speeds: vec![2.5, 5.0, 6.0],
        safety_margin: 20.0,
    }
}

fn target(name: &str, position: Vector, course_deg: f64) -> Target {
    Target {
        name: name.to_owned(),
        motion: Motion::Ship(ShipTrack {
            pose: Pose::new(position, heading_from_course_deg(course_deg)),
            speed: 5.0,
            hull: Hull {
                length: 60.0,
                beam: 12.0,
            },
            position_std: 0.0,
            speed_spread: 0.5,
            course_spread: 5f64.to_radians(),
            domain: DomainKind::Colregs,
        }),
    }
}

/// Hull, own half diagonal and margin; the shape swept to the target's starboard side.
fn sets(own: &OwnShip, target: &Target) -> TargetSets {
    let Some(ship) = target.ship() else {
        panic!("a ship")
    };
    let keep = outer_disc(
        own.hull.half_diagonal() + own.safety_margin,
        ship.pose.heading,
    );
    let hard = ship.hull.polygon(&ship.pose).minkowski_sum(&keep);
    let sweep = ConvexPolygon::hull(&[
        Vector::zeros(),
        crate::frame::to_starboard(ship.pose.ahead()) * 60.0 + ship.pose.ahead() * 40.0,
    ]);
    let shaped = hard.minkowski_sum(&sweep.expect("finite"));
    let velocity = ship.outer_velocity_set();
    TargetSets {
        hard: PolytopeObstacle::new(target.name.clone(), hard, velocity.clone()),
        shaped: PolytopeObstacle::new(target.name.clone(), shaped, velocity),
        encounter: Encounter {
            role: Role::HeadOn,
            undisturbed_dcpa: -10.0,
            undisturbed_tcpa: 145.0,
        },
        shape_reduced: 0.0,
    }
}

/// A turn to starboard, a straight, back across and onto the desired line.
fn trajectory() -> Trajectory {
    let rate = 5.0 / 100.0;
    let mut segments = Vec::new();
    let mut pose = Pose::new(Vector::zeros(), 0.0);
    let mut time = 0.0;
    for (duration, speed, turn) in [
        (40.0, 5.0, 0.0),
        (10.0, 5.0, -rate),
        (85.0, 6.0, 0.0),
        (20.0, 5.0, rate),
        (85.0, 6.0, 0.0),
        (10.0, 5.0, -rate),
        (36.0, 2.5, 0.0),
    ] {
        let segment = Segment {
            start: pose,
            start_time: time,
            duration,
            speed,
            turn_rate: turn,
        };
        pose = segment.end();
        time = segment.end_time();
        segments.push(segment);
    }
    Trajectory::new(segments).expect("continuous")
}

fn explored() -> ExploredGraph {
    let mut graph = ExploredGraph::new();
    let mut node = |kind, pose, time| {
        graph.add_node(ExploredNode {
            kind,
            pose,
            time,
            cost: 0.0,
            expanded: true,
        })
    };
    let start = Pose::new(Vector::zeros(), 0.0);
    let root = node(NodeKind::Start, start, 0.0);
    let leaves: Vec<_> = (0..12)
        .map(|i| node(NodeKind::End, start, f64::from(i)))
        .collect();
    for (i, leaf) in leaves.into_iter().enumerate() {
        let turn = Segment {
            start,
            start_time: 0.0,
            duration: 2.0 * i as f64,
            speed: 5.0,
            turn_rate: if i % 2 == 0 { 0.05 } else { -0.05 },
        };
        let line = Segment {
            start: turn.end(),
            start_time: turn.end_time(),
            duration: 100.0,
            speed: 5.0,
            turn_rate: 0.0,
        };
        let verdict = match i % 3 {
            0 => EdgeVerdict::Free,
            1 => EdgeVerdict::Blocked {
                obstacle: 0,
                time: 50.0,
            },
            _ => EdgeVerdict::Untested,
        };
        graph.add_edge(
            root,
            leaf,
            ExploredEdge {
                segments: vec![turn, line],
                cost: 1.0,
                verdict,
            },
        );
    }
    graph
}

fn run() -> Run {
    let own = own_ship();
    let waypoints = [Vector::zeros(), Vector::new(1500.0, 0.0)];
    let targets = vec![target("ferry / Ærø", Vector::new(1500.0, 0.0), 270.0)];
    let sets: Vec<TargetSets> = targets.iter().map(|t| sets(&own, t)).collect();
    let passage = Passage {
        dcpa: 190.0,
        tcpa: 142.0,
        passing_side: Side::Port,
        min_clearance: 61.0,
        min_margin: 0.4,
        min_margin_time: 120.0,
    };
    Run {
        obstacles: sets.iter().map(|s| s.shaped.clone()).collect(),
        sets,
        planned: Planned {
            outcome: Outcome::Solved(Plan {
                trajectory: trajectory(),
                cost: 1234.5,
                graph_cost: Some(1300.0),
            }),
            stats: SearchStats {
                expanded: 5,
                generated: 12,
                edges_checked: 8,
            },
            explored: explored(),
        },
        relaxations: Vec::new(),
        evaluation: Some(Evaluation {
            violations: Vec::new(),
            space_time_error: 1234.5,
            arc_length_error: 1200.0,
            duration: 286.0,
            length: 1510.0,
            delay: -14.0,
            min_clearance: 61.0,
            passages: vec![passage],
        }),
        plan_time: Duration::from_millis(2),
        scenario: Scenario {
            title: "Head-on".to_owned(),
            horizon: 400.0,
            own_ship: own,
            desired: DesiredTrajectory::new(&waypoints, &[5.0]).expect("valid"),
            targets,
            search: SearchKind::AStar,
            compliance: Compliance::Shape,
            time_weight: 25.0,
            deadline: 5.0,
        },
    }
}

fn run_without_plan() -> Run {
    let mut run = run();
    run.planned.outcome = Outcome::Infeasible(NoPlan::NoCandidate {
        closest: "ferry blocks the desired trajectory at 120.0 s".to_owned(),
    });
    run.evaluation = None;
    run
}

/// Rows and timelines of every entity of the recording's own store.
fn read(path: &Path) -> BTreeMap<String, (u64, Vec<String>)> {
    let mut file = std::fs::File::open(path).expect("opens");
    let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::DEFAULT, &mut file).expect("reads");
    let mut entities = BTreeMap::new();
    for (_, store) in stores.iter().filter(|(id, _)| id.is_recording()) {
        for chunk in store.iter_physical_chunks() {
            let entry: &mut (u64, Vec<String>) =
                entities.entry(chunk.entity_path().to_string()).or_default();
            entry.0 += chunk.num_rows() as u64;
            entry
                .1
                .extend(chunk.timelines().keys().map(ToString::to_string));
        }
    }
    entities
}

#[test]
fn a_recording_reads_back_with_every_entity_on_one_timeline() {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("new/deep/head-on.rrd");
    write(&run(), &path).expect("writes");
    let entities = read(&path);
    let name = r"ferry\ \/\ Ærø";
    for expected in [
        "/summary".to_owned(),
        "/chart/map".to_owned(),
        "/chart/map/desired".to_owned(),
        "/chart/map/planned".to_owned(),
        "/chart/map/own_ship".to_owned(),
        "/chart/map/closest_points".to_owned(),
        format!("/chart/map/targets/{name}"),
        format!("/chart/map/hard_sets/{name}"),
        format!("/chart/map/shaped_sets/{name}"),
        "/chart/map/explored/free".to_owned(),
        "/chart/map/explored/blocked".to_owned(),
        format!("/space_time/shaped_sets/{name}"),
        "/space_time/planned".to_owned(),
        "/space_time/explored/free".to_owned(),
        format!("/curves/clearance_m/{name}"),
        "/curves/margin_m/hard".to_owned(),
        "/curves/margin_m/shaped".to_owned(),
        "/curves/speed_kn/own_ship".to_owned(),
        "/curves/course_deg/own_ship".to_owned(),
    ] {
        assert!(
            entities.contains_key(&expected),
            "{expected} in {entities:#?}"
        );
    }
    for (entity, (_, timelines)) in &entities {
        assert!(
            timelines.iter().all(|t| t == TIMELINE),
            "{entity} {timelines:?}"
        );
    }
    let size = std::fs::metadata(&path).expect("exists").len();
    assert!(size < 300_000, "{size} bytes");
}

#[test]
fn the_same_run_twice_has_the_same_content() {
    let folder = tempfile::tempdir().expect("folder");
    let (first, second) = (folder.path().join("1.rrd"), folder.path().join("2.rrd"));
    write(&run(), &first).expect("writes");
    write(&run(), &second).expect("writes");
    assert_eq!(read(&first), read(&second));
}

#[test]
fn a_run_without_a_plan_is_recorded_too() {
    let folder = tempfile::tempdir().expect("folder");
    let path = folder.path().join("none.rrd");
    write(&run_without_plan(), &path).expect("writes");
    let entities = read(&path);
    assert!(!entities.contains_key("/chart/map/planned"));
    assert!(entities.contains_key("/curves/margin_m/hard"));
}

#[test]
fn a_failed_write_leaves_nothing_and_names_the_file() {
    let folder = tempfile::tempdir().expect("folder");
    // a folder of that name is in the way
    let path = folder.path().join("taken.rrd");
    std::fs::create_dir_all(path.join("inside")).expect("folder");
    let error = write(&run(), &path).expect_err("a folder is in the way");
    assert!(error.to_string().contains("taken.rrd"), "{error}");
    let left: Vec<_> = std::fs::read_dir(folder.path()).expect("lists").collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

/// `SEAROOM_LOOK=folder cargo test look -- --ignored` leaves the recordings there to be looked at.
#[test]
#[ignore = "writes files to be looked at"]
fn look() {
    let folder = std::env::var_os("SEAROOM_LOOK").map(PathBuf::from);
    let folder = folder.expect("SEAROOM_LOOK names a folder");
    for (name, run) in [("plan", run()), ("no-plan", run_without_plan())] {
        let path = folder.join(format!("{name}.rrd"));
        let start = std::time::Instant::now();
        write(&run, &path).expect("writes");
        eprintln!("{name}: {:?}", start.elapsed());
    }
    let _ = direction(0.0);
}
