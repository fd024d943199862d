//! Tests of plans of random encounters: safety, sizes, the search, and placement.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use searoom::frame::{Pose, Vector};
use searoom::pipeline;
use searoom::planner::SearchKind;
use searoom::scenario::{Compliance, Scenario};
use searoom::trajectory::{DesiredTrajectory, Segment, Trajectory};

use crate::campaigns::behaviour::Signal;
use crate::campaigns::documents::{parsed, unhurried};
use crate::campaigns::encounter_generator::{
    EncounterKind, Placement, random_encounter, random_traffic,
};
use crate::campaigns::plans::encounters::{claims_of, least_hull_distance, least_sampled, planned};
use crate::campaigns::plans::harbour::{QUAYS, across_the_island, harbour, scene};
use crate::campaigns::plans::invariance as moved;
use crate::campaigns::statistics::quantile;

#[test]
fn a_ship_that_does_not_give_way_is_hit() {
    let mut hit = 0;
    for (kind, seed) in EncounterKind::with_seeds(0..10) {
        let drawn = random_encounter(kind, seed, Placement::Random).expect("drawn");
        let (scenario, own) = (&drawn.scenario, &drawn.scenario.own_ship);
        let line = Segment::straight(own.pose, 0.0, scenario.desired.duration(), own.speed);
        let undisturbed = Trajectory::new(vec![line]).expect("one line");
        let ship = scenario.targets[0].ship().expect("a ship");
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        hit += (0..20)
            .map(|_| least_hull_distance(own, &undisturbed, ship, Signal::Constant, &mut rng))
            .any(|least| least < 0.0) as usize;
    }
    assert!(hit >= 30, "only {hit} of 50 undisturbed ships are hit");
}

/// A ship at rest 3 km away is in no one's way, so it is nothing to the plan around the one that is met, whichever
/// of them the file lists first. Before, the first in the file decided on which side the search began, 1,733 m²
/// against 1,679; and a tidy plan was searched as one among several, 4,927 m² against 4,569.
#[test]
fn a_ship_that_is_never_near_changes_nothing_wherever_it_is_listed() {
    let far = "[[targets]]\nname = \"far\"\nposition = { east_m = 750, north_m = 3000 }\ncourse_deg = 0\nspeed_mps = 0\nlength_m = 60\nbeam_m = 12\n";
    let met = "[[targets]]\nname = \"met\"\nposition = { east_m = 808, north_m = -328 }\ncourse_deg = 45\nspeed_mps = 2\nlength_m = 60\nbeam_m = 12\nspeed_spread_mps = 0.3\ncourse_spread_deg = 3\n";
    let at_rest = "[[targets]]\nname = \"at rest\"\nposition = { east_m = 667, north_m = 53 }\ncourse_deg = 50\nspeed_mps = 0\nlength_m = 100\nbeam_m = 20\nposition_std_m = 10\n";
    let cost = |compliance: &str, length: u32, targets: &[&str]| {
        let text = format!(
            "title = \"far\"\nhorizon_s = 1200\nplanner = {{ compliance = \"{compliance}\" }}\nmission = {{ waypoints = [{{ east_m = 0, north_m = 0 }}, {{ east_m = {length}, north_m = 0 }}] }}\n[own_ship]\nposition = {{ east_m = 0, north_m = 0 }}\n\
             course_deg = 90\nspeed_mps = 5\nlength_m = 30\nbeam_m = 8\nturning_radius_m = 100\nspeeds_mps = [0, 2.5, 5, 6]\nsafety_margin_m = 20\n{}",
            targets.concat()
        );
        let run = pipeline::run(parsed(&text));
        let plan = run.planned.outcome.plan().expect("a plan");
        plan.cost
    };
    for (compliance, length, met) in [("none", 1500, met), ("rules", 3000, at_rest)] {
        let alone = cost(compliance, length, &[met]);
        assert!(alone > 0.0, "the ship is met");
        let with_far = [
            cost(compliance, length, &[met, far]),
            cost(compliance, length, &[far, met]),
        ];
        assert_eq!(with_far, [alone; 2], "{compliance}");
    }
}

/// Without the coarse search these plans cost 256,094 and 35,827 m².
#[test]
fn a_coarse_search_finds_ways_past_several_targets_that_no_manoeuvre_has() {
    for (targets, seed, compliance, most) in [
        (4, 12, Compliance::Shape, 160_000.0),
        (10, 48, Compliance::None, 16_000.0),
    ] {
        let drawn = random_traffic(targets, seed, Placement::Random).expect("drawn");
        let run = pipeline::run(Scenario {
            compliance,
            deadline: 60.0,
            ..drawn.scenario
        });
        assert!(run.evaluation.is_some_and(|e| e.verified()));
        let cost = run.planned.outcome.plan().expect("a plan").cost;
        assert!(cost < most, "{targets} targets, seed {seed}: {cost} m²");
    }
}

/// Tests plans that avoid the hard sets alone and pass at their edge. The margin is kept for any
/// course of the target, with its hull turned to that course.
#[test]
fn a_hull_that_turns_with_its_course_keeps_the_margin() {
    let (mut broken, mut near) = (Vec::new(), 0);
    for (kind, seed) in EncounterKind::with_seeds(0..15) {
        let mut drawn = random_encounter(kind, seed, Placement::Random).expect("drawn");
        drawn.scenario.compliance = Compliance::None;
        let margin = drawn.scenario.own_ship.safety_margin;
        let record = planned(seed, drawn);
        let least = least_sampled(&record);
        near += usize::from(least < 2.0 * margin);
        broken.extend(claims_of(&record, least));
    }
    assert_eq!(broken, Vec::<String>::new());
    assert!(near >= 12, "only {near} of 75 pass near");
}

/// Maximum cost of the graph's plan relative to the optimum for several targets under a weighted
/// search: median, 90th percentile and maximum. The weights permit 4. Measured: 1.05, 1.16 and
/// 1.36.
const HASTE: [f64; 3] = [1.1, 1.3, 1.7];

/// Tests that the cost is equal for one target, and slightly higher for several under a weighted
/// search; also among land.
#[test]
fn a_star_finds_what_dijkstra_finds_and_in_haste_hardly_more() {
    let alone = EncounterKind::with_seeds(0..25)
        .map(|(kind, seed)| random_encounter(kind, seed, Placement::Random));
    let among = (0..25).map(|seed| random_traffic(2 + seed as usize % 2, seed, Placement::Random));
    let open = alone
        .chain(among)
        .map(|drawn| drawn.expect("drawn").scenario);
    let map = harbour();
    let quays = (0..8).map(|seed| scene(&map, &QUAYS, seed));
    let island = (0..12).filter_map(|seed| across_the_island(&map, seed));
    let (mut expanded, mut blind, mut equal, mut by_land) = (0, 0, 0, 0);
    let mut hasty = Vec::new();
    for scenario in open.chain(quays).chain(island) {
        let title = &scenario.title;
        let land = scenario.land.is_some();
        let several = scenario.targets.len() > 1;
        let planned = [SearchKind::AStar, SearchKind::Dijkstra].map(|search| {
            let mut scenario = scenario.clone();
            scenario.search = search;
            pipeline::run(scenario).planned
        });
        let cost = planned
            .each_ref()
            .map(|p| p.outcome.plan().and_then(|p| p.graph_cost));
        let [weight, unweighted] = planned
            .each_ref()
            .map(|p| p.stats.map_or(1.0, |s| s.heuristic_weight));
        assert_eq!(unweighted, 1.0, "{title}");
        match cost {
            [Some(a), Some(b)] => {
                let rounding = 1e-9 * (1.0 + b);
                assert!(a >= b - rounding, "{title}: {a} {b}");
                assert!(a <= weight * b + rounding, "{title}: {a} {b} {weight}");
                by_land += usize::from(land);
                if several {
                    hasty.push(a / b.max(1e-9));
                } else {
                    assert_eq!(weight, 1.0, "{title}");
                    equal += 1;
                }
            }
            // the reference may exceed its budget
            [Some(_), None] => assert!(several || land, "{title}"),
            other => assert_eq!(other[0], other[1], "{title}"),
        }
        let [a, b] = planned.map(|p| p.stats.map_or(0, |s| s.expanded));
        assert!(a <= b, "{title}: {a} {b}");
        expanded += a;
        blind += b;
    }
    assert!(3 * expanded < 2 * blind, "{expanded} {blind}");
    let enough = equal >= 90 && hasty.len() >= 15 && by_land > 12;
    assert!(enough, "{equal} {} {by_land}", hasty.len());
    let found = [0.5, 0.9, 1.0].map(|share| quantile(&hasty, share));
    let within = found.iter().zip(HASTE).all(|(found, most)| *found <= most);
    assert!(within, "{found:?}, at most {HASTE:?}");
}

/// Costs of the plans of two files with the same scene.
fn costs_of(files: [&str; 2]) -> [f64; 2] {
    files.map(|file| {
        let path = format!("tests/faults/{file}.toml");
        let scenario = Scenario::read(std::path::Path::new(&path)).expect("reads");
        moved::cost(unhurried(scenario)).expect("a plan")
    })
}

/// Tests coordinates of millions of metres, and a scene moved by 1.6 km: corners of the path must
/// not become full circles.
#[test]
fn the_same_scene_in_another_place_costs_the_same() {
    for files in [["utm-a", "utm-b"], ["dear-a", "dear-b"]] {
        let [a, b] = costs_of(files);
        assert!((a - b).abs() <= 1e-6 * a, "{files:?}: {a} {b}");
        assert!(a < 100_000.0, "{files:?}: {a}");
    }
}

/// Tests starts slightly beside the path, before or behind its start, or slightly turned. Without
/// targets, the plan contains no full circle.
#[test]
fn a_hair_beside_the_path_is_on_it() {
    let file = std::path::Path::new("tests/faults/offset-circle.toml");
    let asked = unhurried(Scenario::read(file).expect("reads"));
    let hairs = (3..=12).map(|k| 10.0_f64.powi(-k)).chain([0.0]);
    let both = hairs.flat_map(|hair| [hair, -hair]);
    for hair in both {
        for (along, across, turned) in [
            (0.0, hair, 0.0),
            (hair, 0.0, 0.0),
            (0.0, 0.0, hair),
            (hair, hair, hair),
        ] {
            for (far, course) in [(0.0, 0.0), (7e6, 0.0), (1e3, 2.0)] {
                let beside = Pose::new(Vector::new(along, across), turned);
                let place = Pose::new(Vector::new(0.1 * far, far), course);
                let mut scenario = asked.clone();
                let waypoints = asked.desired.waypoints().into_iter();
                let waypoints: Vec<Vector> =
                    waypoints.map(|w| place.world_coordinates(w)).collect();
                scenario.desired = DesiredTrajectory::new(&waypoints, &[5.0]).expect("a path");
                scenario.own_ship.pose = Pose::new(
                    place.world_coordinates(beside.position),
                    beside.heading + course,
                );
                let cost = moved::cost(scenario).expect("a plan");
                assert!(cost < 0.1, "{beside:?} of {place:?}: {cost}");
            }
        }
    }
}
