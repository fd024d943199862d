//! The finite graph, searched by petgraph.

use std::collections::HashMap;
use std::time::{Duration, Instant};

use petgraph::algo::{astar, dijkstra};
use petgraph::graph::{DiGraph, NodeIndex};

use super::*;
use crate::search::{Search, Stop};
use crate::{Objective, Problem};
use searoom_model::trajectory::PathNetwork;

#[path = "../../../../../benches/shared/path_network.rs"]
mod path_network;

/// Every line that meets no set, between the nodes that can be reached. Arrivals at one point at one
/// time are one node.
fn finite(graph: &mut Graph) -> DiGraph<usize, f64> {
    let mut made = DiGraph::new();
    let mut index_of = HashMap::from([(0, made.add_node(0))]);
    let mut arrivals: HashMap<(usize, u64), usize> = HashMap::new();
    let (mut open, mut lines) = (vec![0], Vec::new());
    while let Some(from) = open.pop() {
        graph.successors(&State::new(from, from, None, None), &mut lines);
        for (line, cost) in lines.drain(..) {
            if graph.bound(&line).is_infinite() || graph.barrier(&line).is_some() {
                continue;
            }
            let Node {
                place, time, mark, ..
            } = graph.nodes[line.node];
            let to = match (mark, place) {
                (Mark::Arrival, Place::At(point)) => {
                    *arrivals.entry((point, time.to_bits())).or_insert(line.node)
                }
                _ => line.node,
            };
            let end = *index_of.entry(to).or_insert_with(|| {
                open.push(to);
                made.add_node(to)
            });
            made.add_edge(index_of[&from], end, cost);
        }
    }
    made
}

/// Our search generates the nodes that it needs; petgraph is given all of them.
#[test]
fn petgraph_finds_the_least_time_of_the_finite_graph() {
    for (targets, legs) in NETWORKS {
        let scene = path_network::scene(targets, legs);
        let problem = Problem {
            objective: Objective::Time,
            ..Problem::new(&scene.own, &scene.desired, &scene.obstacles, scene.horizon)
        };
        let network = PathNetwork::new(&scene.desired.waypoints(), &[]).expect("a path");
        let scene = Scene::new(&problem, &network, Aim::Arrive);
        let root = Node {
            place: Place::At(network.start()),
            time: 0.0,
            on_edge_of: None,
            due: true,
            mark: Mark::Start,
        };
        let graph = || {
            let mut known = Known::corners(&scene);
            known.share(&scene);
            let measure = Measure::new(&problem);
            let clock = Clock::new(Duration::from_secs(600));
            Graph::new(&scene, known, measure, problem.search, root, clock)
        };
        let begun = Instant::now();
        let mut lazy = graph();
        let mut search = Search::new(lazy.root());
        let Stop::Goal(goal) = search.next_goal(&mut lazy, usize::MAX) else {
            panic!("{targets} targets, {legs} legs: no plan");
        };
        let (ours, searched) = (search.nodes()[goal].cost, begun.elapsed());

        let begun = Instant::now();
        let mut whole = graph();
        let made = finite(&mut whole);
        let built = begun.elapsed();
        let is_end = |node: NodeIndex| match whole.nodes[made[node]].place {
            Place::At(point) => network.is_end(point),
            Place::On { .. } => false,
        };
        let to_go = |node: NodeIndex| {
            let node = &whole.nodes[made[node]];
            whole.measure.bound(&scene, node.left(&scene), node.time)
        };
        let start = NodeIndex::new(0);
        let begun = Instant::now();
        let found = astar(&made, start, is_end, |e| *e.weight(), to_go);
        let informed = begun.elapsed();
        let (cost, _) = found.expect("a path");
        let costs = dijkstra(&made, start, None, |e| *e.weight());
        let ends = costs.iter().filter(|(node, _)| is_end(**node));
        let least = ends.map(|(_, cost)| *cost).fold(f64::INFINITY, f64::min);
        let what = format!(
            "{targets} targets, {legs} legs: our search {searched:.1?}; {} nodes and {} lines in \
             {built:.1?}, petgraph's A* {informed:.1?}",
            made.node_count(),
            made.edge_count()
        );
        println!("{what}");
        for found in [cost, least] {
            assert!(
                (found - ours).abs() <= 1e-9 * ours,
                "{what}: {found} {ours}"
            );
        }
    }
}

/// Targets and legs of each network.
const NETWORKS: [(usize, usize); 4] = [(3, 5), (30, 5), (3, 30), (300, 300)];
