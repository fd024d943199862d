//! Least-harm motion, used when no motion along the paths is clear of every set.
//!
//! Candidates: own ship waits at the start, or follows a path at a fraction of its maximum speed.
//! It then stops somewhere on the path, or continues to the end.
//!
//! The harm of a candidate counts its motion inside sets: metres travelled, plus seconds at a tenth
//! of the maximum speed, each weighted by the risk. Stopping to let a target pass is therefore
//! better than passing through its set, and leaving a set is better than staying in it.
//!
//! Candidates that meet no hull on its nominal track come first, unless the time is up. Among those
//! of nearly the least harm, the planner selects the one that still arrives or gets farthest. It
//! breaks ties by the shortest distance, then by the lowest speed. After the candidate is
//! permanently clear, the regular planner continues the motion.

use super::profile::Profile;
use super::scene::{Aim, Scene};
use super::{Found, TOUCH_M, finished, search};
use crate::clock::Clock;
use crate::space_time::NominalHulls;
use crate::space_time::piece::pieces;
use crate::{NominalTarget, Outcome, PlanMethod, Planned, Problem};
use searoom_model::trajectory::PathNetwork;
use searoom_sets::{Obstacle, PathTime, SpaceTimeObstacle};

/// Candidate speeds as fractions of the maximum speed.
const SPEEDS: [f64; 4] = [0.25, 0.5, 0.75, 1.0];

/// Number of candidate stop positions along a path.
const STOPS: usize = 16;

/// Risk levels. The harm is the mean over their level sets, which weights it by the risk.
const LEVELS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// Weight of one second inside a set, as a fraction of the distance covered at maximum speed.
const SECOND: f64 = 0.1;

/// Candidates with at most this multiple of the least harm count as equally harmful.
const ABOUT: f64 = 1.1;

/// Plans the least-harm motion against the whole sets; `None` for invalid paths. Takes some
/// milliseconds. Once the time is up no more candidates are looked at.
pub fn least_harm(problem: &Problem, nominal: &[NominalTarget]) -> Option<Planned> {
    let clock = Clock::new(problem.deadline);
    let network = PathNetwork::new(&problem.desired.waypoints(), problem.alternatives).ok()?;
    let mut scenes: Vec<Scene> = (LEVELS.iter())
        .take_while(|risk| **risk == LEVELS[0] || !clock.is_up())
        .map(|risk| {
            let sets = problem.obstacles.iter().map(|set| set.at_risk(*risk));
            let obstacles: Vec<Obstacle> = sets.collect();
            let level = Problem {
                obstacles: &obstacles,
                ..problem.clone()
            };
            Scene::new(&level, &network, Aim::Last)
        })
        .collect();
    let mut judged: Vec<Judged> = Vec::new();
    for profile in candidates(&scenes[0]) {
        if judged.is_empty() || !clock.is_up() {
            judged.push(Judged::new(&scenes, profile));
        }
    }
    let (hulls, own): (Vec<_>, Vec<_>) = nominal.iter().map(|t| (t.hull.clone(), t.own)).unzip();
    let hulls = pieces(&hulls, problem.horizon);
    let hulls = NominalHulls::new(&hulls, &own, clock);
    let is_clear = |judged: &Judged| {
        let trajectory = judged.profile.trajectory(&scenes[0], problem.own.pose);
        trajectory.is_some_and(|t| {
            hulls.depth(problem.own, t.segments(), f64::INFINITY) == 0.0 && !clock.is_up()
        })
    };
    let mut by_harm: Vec<&Judged> = judged.iter().collect();
    by_harm.sort_by(|a, b| a.harm.total_cmp(&b.harm));
    let mut in_time = by_harm.iter().take_while(|_| !clock.is_up());
    // without a candidate that is clear of the hulls, the least harm to sets decides
    let clear = in_time.find(|judged| is_clear(judged));
    let least = clear.unwrap_or(&by_harm[0]).harm;
    let best = (judged.iter())
        .filter(|j| j.harm >= least && j.harm <= ABOUT * least)
        .filter(|j| clear.is_none_or(|clear| std::ptr::eq(*j, *clear) || is_clear(j)))
        .min_by(|a, b| a.left.total_cmp(&b.left))?
        .clone();
    let scene = &mut scenes[0];
    if let Some(clear) = best.clear_from {
        let begun = best.profile.until(scene, clear);
        for aim in [Aim::Arrive, Aim::Last] {
            scene.aim = aim;
            let rest = Problem {
                deadline: clock.left(),
                ..problem.clone()
            };
            let mut onward = search(&rest, scene, &begun, 1.0);
            if let Some(plan) = onward.outcome.plan_mut() {
                plan.method = PlanMethod::LeastHarm;
                return Some(onward);
            }
        }
    }
    let found = Found {
        to_go: best.profile.to_go(scene),
        profile: best.profile,
        method: PlanMethod::LeastHarm,
        graph_cost: None,
    };
    let plan = finished(problem, scene, &found, 1.0)?;
    Some(Planned {
        path_time: Some(Box::new(found.profile.diagram(scene, problem.own.pose))),
        ..Planned::of(Outcome::Solved(plan))
    })
}

/// Evaluated candidate.
#[derive(Clone)]
struct Judged {
    profile: Profile,
    /// Harm in metres.
    harm: f64,
    /// Time in seconds after which it is clear of every set; `None` if it is always clear.
    clear_from: Option<f64>,
    /// Distance to the end in metres at the horizon, if nothing obstructs the rest.
    left: f64,
}

impl Judged {
    fn new(scenes: &[Scene], profile: Profile) -> Self {
        let scene = &scenes[0];
        let mut harm = 0.0;
        let mut clear_from: Option<f64> = None;
        for (level, scene) in scenes.iter().enumerate() {
            for (leg, from, to) in profile.lines(scene) {
                let (way, time) = (to.distance - from.distance, to.time - from.time);
                let weight = (way + SECOND * scene.max_speed * time) / scenes.len() as f64;
                for seen in &scene.seen[leg] {
                    let Some([enter, leave]) = seen.body.inside(from, to, TOUCH_M) else {
                        continue;
                    };
                    harm += weight * (leave - enter);
                    if level == 0 {
                        // up to the exact edge
                        let leave = seen.body.inside(from, to, 0.0).map_or(leave, |[_, l]| l);
                        let left = from.time + leave * time;
                        clear_from = Some(clear_from.map_or(left, |time| time.max(left)));
                    }
                }
            }
        }
        let rest = profile.until(scene, clear_from.unwrap_or(f64::INFINITY));
        let end = rest.end();
        let further = scene.max_speed * (scene.horizon - end.time);
        Self {
            left: (rest.to_go(scene) - further).max(0.0),
            profile,
            harm,
            clear_from,
        }
    }
}

/// Generates the candidates in order of increasing distance.
fn candidates(scene: &Scene) -> Vec<Profile> {
    let network = scene.network;
    let mut all = vec![along(scene, &[], 0.0, 0.0)];
    for speed in SPEEDS.map(|share| share * scene.max_speed) {
        for first in network.onward(network.start()) {
            let path = network.legs()[*first].path;
            let mut way = Vec::new();
            for (leg, on) in network.legs().iter().enumerate().skip(*first) {
                if on.path != path {
                    break;
                }
                way.push(leg);
                if network.is_end(on.ends[1]) {
                    break;
                }
            }
            let length: f64 = way.iter().map(|leg| scene.tracks[*leg].length).sum();
            let reach = length.min(speed * scene.horizon);
            let stops = (1..=STOPS).map(|k| reach * k as f64 / STOPS as f64);
            let ends = stops.map(|stop| along(scene, &way, speed, stop));
            // the last part of a dead-end path has no continuation
            all.extend(ends.filter(|profile| profile.to_go(scene).is_finite()));
        }
    }
    all
}

/// Profile along legs at constant speed for `stop` metres, followed by a wait until the horizon. It
/// ends at the last waypoint without a wait.
fn along(scene: &Scene, way: &[usize], speed: f64, stop: f64) -> Profile {
    let mut profile = Profile::new();
    let (mut time, mut left) = (0.0, stop);
    for leg in way {
        let length = scene.tracks[*leg].length;
        // ignore remainders of the size of rounding errors
        let sailed = if left >= length - TOUCH_M {
            length
        } else {
            left
        };
        let point = |distance, time| PathTime { distance, time };
        let end = time + sailed / speed;
        profile.sail(scene, *leg, point(0.0, time), point(sailed, end));
        (time, left) = (end, left - sailed);
        if left <= TOUCH_M {
            break;
        }
    }
    if profile.to_go(scene) > 0.0 {
        profile.wait(scene.horizon);
    }
    profile
}
