//! Tests that A* matches Dijkstra among land.

use searoom::obstacle::Obstacle;
use searoom::pipeline;
use searoom::planner::{Problem, SearchKind, space_time};

use crate::campaigns::harbour::{QUAYS, across_the_island, harbour, scene};

/// Maximum cost of the graph's plan relative to the optimum for several targets under a weighted
/// search.
const HASTE: f64 = 1.5;

/// Tests the same graph without the bound.
#[test]
fn a_star_costs_what_dijkstra_costs_among_land() {
    let (mut compared, mut worst) = (0, 0.0_f64);
    let map = harbour();
    let quays = (0..8).map(|seed| scene(&map, &QUAYS, seed));
    let island = (0..12).filter_map(|seed| across_the_island(&map, seed));
    for scenario in quays.chain(island) {
        let scenario = &scenario;
        let obstacles: Vec<Obstacle> = pipeline::sets(scenario)
            .into_iter()
            .map(|s| s.hard)
            .collect();
        let land = pipeline::land_within_reach(scenario);
        let land_obstacle = pipeline::land_obstacle(scenario, &land);
        let asked = pipeline::problem(scenario, &obstacles, &land_obstacle);
        let graph_cost = |search| {
            let planned = space_time::plan(&Problem {
                search,
                ..asked.clone()
            });
            planned.outcome.plan().and_then(|p| p.graph_cost)
        };
        let (a, d) = (
            graph_cost(SearchKind::AStar),
            graph_cost(SearchKind::Dijkstra),
        );
        if let (Some(a), Some(d)) = (a, d) {
            let most = if scenario.targets.len() > 1 {
                HASTE
            } else {
                1.0
            };
            let rounding = 1e-9 * (1.0 + d);
            let title = &scenario.title;
            assert!(
                a >= d - rounding && a <= most * d + rounding,
                "{title}: {a} {d}"
            );
            compared += 1;
            worst = worst.max(a / d.max(1e-9));
        }
    }
    println!("{compared} compared, worst {worst}");
    assert!(compared > 12, "{compared}");
}
