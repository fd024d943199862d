//! The search on its own: hand cases, and the bound against what was in fact still to come.

use super::*;
use crate::campaigns::encounter_generator::{EncounterKind, Placement, random_encounter};
use searoom::obstacle::{LandObstacle, Obstacle};
use searoom::pipeline;
use searoom::scenario::Scenario;

fn scene(kind: EncounterKind, seed: u64, placement: Placement) -> Scenario {
    random_encounter(kind, seed, placement)
        .expect("drawn")
        .scenario
}

fn problem<'a>(scenario: &'a Scenario, obstacles: &'a [Obstacle]) -> Problem<'a> {
    pipeline::problem(scenario, obstacles, LandObstacle::none())
}

#[test]
fn nothing_in_the_way_costs_nothing() {
    for placement in [Placement::Origin, Placement::Random] {
        let scenario = scene(EncounterKind::HeadOn, 0, placement);
        let problem = problem(&scenario, &[]);
        let search = DenseSearch::default();
        let answer = search.cheaper_than(&problem, 1.0);
        assert!(answer.cheaper.expect("the desired trajectory itself").cost < 1e-9);
        assert!(search.cheaper_than(&problem, 0.0).cheaper.is_none());
    }
}

#[test]
fn what_it_finds_is_clear_and_costs_what_it_says() {
    for kind in EncounterKind::ALL {
        let scenario = scene(kind, 1, Placement::Random);
        let sets = pipeline::sets(&scenario).into_iter().map(|s| s.hard);
        let sets: Vec<Obstacle> = sets.collect();
        let problem = problem(&scenario, &sets);
        let answer = DenseSearch::coarse(40_000.0).cheaper_than(&problem, 40_000.0);
        let found = answer.cheaper.expect("a way round");
        recheck(&problem, &found);
        // the bound never exceeds what was in fact still to come
        let leg = problem.desired.legs()[0];
        let bound = Bound::new(&problem, &leg, 4.0);
        let duration = problem.desired.duration();
        let mut so_far = 0.0;
        for i in 0..(found.trajectory.end_time() / 4.0) as usize {
            let time = 4.0 * i as f64;
            let bound = bound.to_go(&found.trajectory.pose_at(time), i);
            let to_go = found.cost * duration - so_far;
            assert!(
                bound <= to_go + 1e-3 * found.cost * duration,
                "{bound} {to_go} at {time}"
            );
            for j in 0..400 {
                let t = time + 0.01 * (f64::from(j) + 0.5);
                let p = found.trajectory.pose_at(t).position;
                so_far += 0.01 * problem.desired.nearest(p, t, problem.time_weight).error;
            }
        }
    }
}
