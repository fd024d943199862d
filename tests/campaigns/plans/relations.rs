//! Scenes and changes of them whose effect on the cost is known without a plan: a longer horizon or one
//! more speed costs no more, a larger set no less, and what own ship never comes near nothing at all.

use rayon::prelude::*;
use searoom::frame::{Pose, Vector};
use searoom::scenario::{Compliance, Scenario};
use searoom::target::{Motion, ShipTrack, Target};
use searoom::trajectory::DesiredTrajectory;
use searoom::vessel::Hull;

use crate::campaigns::encounter_generator::{
    EncounterKind, Meeting, Placement, random_meeting, random_traffic,
};
use crate::campaigns::plans::invariance::cost;
use crate::campaigns::{Report, Seeds};

/// Relative difference above which a relation is broken, and the cost below which a difference is
/// none, m².
const BROKEN: f64 = 1e-3;
const LEAST_COST: f64 = 1.0;

/// What a change may do to the cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Effect {
    NoMore,
    NoLess,
    Nothing,
}

/// A change of a scene.
pub struct Relation {
    pub name: &'static str,
    pub effect: Effect,
    /// A scene, and what it is changed to.
    pub pair: fn(Scenario) -> [Scenario; 2],
    /// True where no scene may break it; the others are counted.
    pub always: bool,
}

/// All relations.
pub const RELATIONS: [Relation; 7] = [
    Relation {
        name: "a horizon half as long again",
        effect: Effect::NoMore,
        pair: |scene| {
            let horizon = 1.5 * scene.horizon;
            let longer = Scenario {
                horizon,
                ..scene.clone()
            };
            [scene, longer]
        },
        always: false,
    },
    Relation {
        name: "one more speed",
        effect: Effect::NoMore,
        pair: |scene| changed(scene, add_a_speed),
        always: false,
    },
    Relation {
        name: "10 m more margin",
        effect: Effect::NoLess,
        pair: |scene| changed(scene, |scene| scene.own_ship.safety_margin += 10.0),
        always: false,
    },
    Relation {
        name: "a ship that is never near",
        effect: Effect::Nothing,
        pair: |scene| changed(scene, add_a_far_ship),
        always: false,
    },
    Relation {
        name: "a ship at rest that is never near",
        effect: Effect::Nothing,
        pair: |scene| changed(scene, add_a_ship_at_rest),
        always: false,
    },
    Relation {
        name: "a waypoint on the line",
        effect: Effect::Nothing,
        pair: |scene| changed(scene, add_a_waypoint),
        always: true,
    },
    Relation {
        // the plan of the shorter mission is one of the longer one
        name: "an earlier leg at another speed",
        effect: Effect::NoMore,
        pair: |scene| {
            changed(with_certain_targets(scene, EARLIER), |scene| {
                begin_sooner(scene, EARLIER)
            })
        },
        always: false,
    },
];

/// Speed of an earlier leg, as a share of the desired speed, and its duration in seconds.
const EARLIER: f64 = 0.6;
const SOONER_S: f64 = 200.0;

fn changed(scene: Scenario, change: impl FnOnce(&mut Scenario)) -> [Scenario; 2] {
    let mut changed = scene.clone();
    change(&mut changed);
    [scene, changed]
}

/// Between the two greatest.
fn add_a_speed(scene: &mut Scenario) {
    let speeds = &mut scene.own_ship.speeds;
    if let [.., a, b] = speeds[..] {
        speeds.insert(speeds.len() - 1, 0.5 * (a + b));
    }
}

/// On a parallel course, 2.5 km to port.
fn add_a_far_ship(scene: &mut Scenario) {
    add_far(scene, scene.own_ship.speed);
}

/// 2.5 km to port.
fn add_a_ship_at_rest(scene: &mut Scenario) {
    add_far(scene, 0.0);
}

fn add_far(scene: &mut Scenario, speed: f64) {
    let own = scene.own_ship.pose;
    let place = own.world_coordinates(Vector::new(0.0, 2500.0));
    scene.targets.push(Target {
        name: "far".to_owned(),
        motion: Motion::Ship(ShipTrack::exact(
            Pose::new(place, own.heading),
            speed,
            Hull::new(60.0, 10.0),
        )),
        representation: scene.targets[0].representation,
        status: None,
    });
}

fn add_a_waypoint(scene: &mut Scenario) {
    let points = scene.desired.waypoints();
    let speed = scene.desired.legs()[0].speed;
    let middle = points[0].lerp(&points[1], 0.4);
    let desired = DesiredTrajectory::new(&[points[0], middle, points[1]], &[speed; 2]);
    scene.desired = desired.expect("a path");
}

/// The scene with a share of the desired speed among own ship's, and targets that keep their velocity:
/// they are as sure earlier as later.
fn with_certain_targets(mut scene: Scenario, share: f64) -> Scenario {
    let speeds = &mut scene.own_ship.speeds;
    speeds.push(share * scene.desired.legs()[0].speed);
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    for target in &mut scene.targets {
        if let Motion::Ship(ship) = &mut target.motion {
            (ship.speed_spread, ship.course_spread) = (0.0, 0.0);
        }
    }
    scene
}

/// Own ship begins sooner, on a leg at a share of the desired speed.
fn begin_sooner(scene: &mut Scenario, share: f64) {
    let speed = scene.desired.legs()[0].speed;
    let before = scene.own_ship.pose.ahead() * (share * speed * SOONER_S);
    let mut points = scene.desired.waypoints();
    points.insert(0, points[0] - before);
    let desired = DesiredTrajectory::new(&points, &[share * speed, speed]);
    scene.desired = desired.expect("a path");
    scene.own_ship.pose.position -= before;
    scene.own_ship.speed = share * speed;
    scene.horizon += SOONER_S;
    for target in &mut scene.targets {
        if let Motion::Ship(ship) = &mut target.motion {
            ship.pose.position -= ship.pose.ahead() * (ship.speed * SOONER_S);
        }
    }
}

impl Relation {
    /// Whether the relation is broken, and the cost of the changed scene over that of the scene; `None`
    /// where one of them has no plan that satisfies the whole request.
    pub fn broken(&self, scene: Scenario) -> Option<(bool, f64)> {
        // J is a mean over the desired duration
        let [scene, changed] = (self.pair)(scene);
        let least = LEAST_COST * scene.desired.duration();
        let total = |of: &Scenario| Some((cost(of.clone())? * of.desired.duration()).max(least));
        let ratio = total(&changed)? / total(&scene)?;
        let broken = match self.effect {
            Effect::NoMore => ratio > 1.0 + BROKEN,
            Effect::NoLess => ratio < 1.0 - BROKEN,
            Effect::Nothing => (ratio - 1.0).abs() > BROKEN,
        };
        Some((broken, ratio))
    }
}

/// Scenes with one target, or with several.
pub fn scene(targets: usize, compliance: Compliance, seed: u64) -> Scenario {
    let kinds = EncounterKind::ALL;
    let drawn = match targets {
        1 => {
            let kind = kinds[seed as usize % kinds.len()];
            // by the rules own ship acts in ample time, which a near meeting leaves no time for
            let meeting = match compliance {
                Compliance::Rules => &Meeting::FAR,
                _ => &Meeting::NEAR,
            };
            random_meeting(kind, seed, Placement::Origin, meeting)
        }
        _ => random_traffic(targets, seed, Placement::Origin),
    };
    Scenario {
        compliance,
        ..drawn.expect("drawn").scenario
    }
}

/// Prints in how many scenes each relation is broken by more than 0.1 %, and the extreme ratios. Requires
/// that none is broken that always holds.
pub fn run(seeds: Seeds) -> Report {
    let mut report = Report::default();
    println!("| | targets | relation | broken | of | J over J, least | most |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for compliance in [Compliance::None, Compliance::Rules] {
        for targets in [1, 3] {
            for relation in &RELATIONS {
                let found: Vec<(u64, bool, f64)> = (seeds.clone().into_par_iter())
                    .filter_map(|seed| {
                        let scene = scene(targets, compliance, seed);
                        let (broken, ratio) = relation.broken(scene)?;
                        Some((seed, broken, ratio))
                    })
                    .collect();
                let failing: Vec<u64> = found.iter().filter(|f| f.1).map(|f| f.0).collect();
                let (least, most) = (found.iter().map(|f| f.2))
                    .fold((f64::INFINITY, 0.0), |(least, most), ratio| {
                        (f64::min(least, ratio), f64::max(most, ratio))
                    });
                println!(
                    "| {} | {targets} | {} | {} | {} | {least:.3} | {most:.3} |",
                    compliance.word(),
                    relation.name,
                    failing.len(),
                    found.len(),
                );
                let kept = failing.is_empty() && !found.is_empty();
                report.require(!relation.always || kept, || {
                    format!("{}: {failing:?}", relation.name)
                });
            }
        }
    }
    report
}
