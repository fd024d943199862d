//! Missions that end near the meeting: own ship may arrive a minute later than where the route goes on for
//! 800 m, because it has less of a route to come back to.

use std::path::Path;

use rayon::prelude::*;
use searoom::obstacle::SpaceTimeObstacle;
use searoom::pipeline;
use searoom::pipeline::RelaxationLevel;
use searoom::scenario::{Compliance, Scenario};
use searoom::trajectory::DesiredTrajectory;

use crate::campaigns::encounter_generator::{EncounterKind, Meeting, Placement, random_meeting};
use crate::campaigns::{Report, Seeds, scene_file};

/// Metres from own ship's place at the closest approach to the last waypoint.
const BEYOND_M: [f64; 5] = [0.0, 100.0, 200.0, 400.0, 600.0];
/// Metres by which the other route is longer.
const LONGER_M: f64 = 800.0;
/// Seconds.
const ALLOWED_S: f64 = 60.0;

/// A scene whose route ends so far beyond the meeting, and then once more 800 m farther.
fn pair(seed: u64) -> Option<[Scenario; 2]> {
    let kinds = EncounterKind::ALL;
    let kind = kinds[seed as usize % kinds.len()];
    let beyond = BEYOND_M[seed as usize / kinds.len() % BEYOND_M.len()];
    let scene = random_meeting(kind, seed, Placement::Origin, &Meeting::NEAR)?.scenario;
    let own = &scene.own_ship;
    let target = scene.targets[0].ship()?;
    let apart = target.pose.position - own.pose.position;
    let velocity = target.pose.ahead() * target.speed - own.pose.ahead() * own.speed;
    let meeting = own.speed * (-apart.dot(&velocity) / velocity.norm_squared()).max(0.0);
    let speed = scene.desired.legs()[0].speed;
    let start = scene.desired.waypoints()[0];
    let of_length = |length: f64| {
        let end = start + own.pose.ahead() * length;
        Some(Scenario {
            desired: DesiredTrajectory::new(&[start, end], &[speed]).ok()?,
            compliance: Compliance::Rules,
            ..scene.clone()
        })
    };
    Some([
        of_length(meeting + beyond)?,
        of_length(meeting + beyond + LONGER_M)?,
    ])
}

/// The plan of a scene.
struct Seen {
    /// Seconds of delay, where the plan satisfies the whole request; else infinite.
    delay: f64,
    /// Seconds after the desired arrival until which the last waypoint is in a set: no plan is earlier.
    covered: f64,
    level: RelaxationLevel,
}

fn seen(scene: &Scenario) -> Seen {
    let run = pipeline::run(scene.clone());
    let plan = run.planned.outcome.plan();
    let is_verified = run.evaluation.as_ref().is_some_and(|e| e.verified());
    let whole = plan.filter(|_| run.relaxations.is_empty() && is_verified);
    let (end, due) = (scene.desired.end(), scene.desired.duration());
    let is_covered = |after: &f64| run.obstacles().any(|o| o.contains(end, due + after));
    let seconds = (0..(scene.horizon - due) as u32).map(f64::from);
    Seen {
        delay: whole.map_or(f64::INFINITY, |plan| plan.trajectory.end_time() - due),
        covered: seconds.take_while(is_covered).last().unwrap_or(0.0),
        level: run.level,
    }
}

/// Prints in how many scenes own ship arrives more than a minute later. The short ones go to a `folder`, where that
/// is given.
pub fn run(seeds: Seeds, folder: Option<&Path>) -> Report {
    let mut report = Report::default();
    if let Some(folder) = folder {
        for (seed, [scene, _]) in seeds.clone().filter_map(|seed| Some((seed, pair(seed)?))) {
            let name = format!("{seed}.toml");
            report.written(scene_file::write(folder, &name, &scene), folder);
        }
    }
    let found: Vec<(u64, Seen, Seen)> = (seeds.into_par_iter())
        .filter_map(|seed| {
            let [short, long] = pair(seed)?;
            Some((seed, seen(&short), seen(&long)))
        })
        // where the longer route has no such plan, the shorter one need not
        .filter(|(_, _, long)| long.delay.is_finite())
        .collect();
    println!("| seed | delay, s | end in a set until, s | with 800 m more, s | level |");
    println!("| --- | --- | --- | --- | --- |");
    let (mut late, mut covered) = (0, 0);
    for (seed, short, long) in &found {
        if short.delay <= long.delay + ALLOWED_S {
            continue;
        }
        late += 1;
        covered += usize::from(short.delay <= short.covered.max(long.delay) + ALLOWED_S);
        let (delay, until, most) = (short.delay, short.covered, long.delay);
        println!(
            "| {seed} | {delay:.0} | {until:.0} | {most:.0} | {:?} |",
            short.level
        );
    }
    println!(
        "{late} of {} are late, {covered} of them because the last waypoint is in a set",
        found.len()
    );
    report
}
