//! The costs on the free edges of the explored graph, by petgraph.

use crate::campaigns::encounter_generator::{EncounterKind, Placement, random_encounter};
use petgraph::algo::{astar, dijkstra};
use petgraph::graph::NodeIndex;
use searoom::pipeline;
use searoom::planner::space_time::Heuristic;
use searoom::planner::{EdgeVerdict, NodeKind, SearchKind};

/// petgraph's Dijkstra, and its A* with this bound, find the cost that our search reports on
/// the free edges of its graph.
#[test]
fn petgraph_finds_the_cost_of_the_graph() {
    let mut compared = 0;
    for (kind, seed) in EncounterKind::with_seeds(0..15) {
        let drawn = random_encounter(kind, seed, Placement::Random).expect("drawn");
        for search in [SearchKind::AStar, SearchKind::Dijkstra] {
            let mut scenario = drawn.scenario.clone();
            scenario.search = search;
            let run = pipeline::run(scenario);
            let planned = run.planned;
            let Some(ours) = planned.outcome.plan().and_then(|p| p.graph_cost) else {
                continue;
            };
            let mut graph = planned.explored;
            graph.retain_edges(|graph, edge| graph[edge].verdict == EdgeVerdict::Free);
            let mut nodes = graph.node_indices();
            let start = nodes.find(|n| graph[*n].kind == NodeKind::Start);
            let start = start.expect("a start");
            let is_end = |node: NodeIndex| graph[node].kind == NodeKind::End;
            let costs = dijkstra(&graph, start, None, |e| e.weight().cost);
            let ends = costs.iter().filter(|(node, _)| is_end(**node));
            let least = ends.map(|(_, cost)| *cost).fold(f64::INFINITY, f64::min);
            let own = &run.scenario.own_ship;
            let bound = Heuristic::new(&run.scenario.desired, run.scenario.time_weight, own);
            let to_go = |node: NodeIndex| match is_end(node) {
                true => 0.0,
                false => bound.cost_to_go(&graph[node].pose, graph[node].time),
            };
            let found = astar(&graph, start, is_end, |e| e.weight().cost, to_go);
            let (informed, _) = found.expect("a path");
            let what = format!("{kind:?} {seed}: {least} {informed} {ours}");
            for found in [least, informed] {
                assert!((found - ours).abs() <= 1e-9 * ours.max(1.0), "{what}");
            }
            compared += 1;
        }
    }
    assert!(compared >= 80, "{compared}");
}
