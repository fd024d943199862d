//! Node of the space-time graph, and the results read from a search over such nodes.

use std::cell::Cell;

use petgraph::graph::NodeIndex;

use crate::search::{Fate, Search};
use crate::space_time::manoeuvre::ending::Ending;
use crate::{EdgeVerdict, ExploredEdge, ExploredGraph, ExploredNode, NodeKind};
use searoom_geometry::frame::Pose;
use searoom_model::trajectory::Segment;

/// Node with the motion that leads to it.
#[derive(Debug, Clone)]
pub(crate) struct State {
    pub kind: NodeKind,
    pub pose: Pose,
    pub time: f64,
    /// Motion from the parent node.
    pub motion: Vec<Segment>,
    /// Number of its segments that follow the route before the departure.
    pub along: usize,
    /// How a motion to the end ends; meaningless for other nodes.
    pub ending: Ending,
    /// Number of vertices met so far.
    pub chain: u8,
    /// Number of holds since the last vertex.
    pub held: u8,
    /// Obstacle that the motion meets, once known.
    pub met: Cell<Option<usize>>,
}

impl State {
    /// Own ship at t = 0.
    pub(crate) fn start(pose: Pose) -> Self {
        Self {
            kind: NodeKind::Start,
            pose,
            time: 0.0,
            motion: Vec::new(),
            along: 0,
            ending: Ending::Follow,
            chain: 0,
            held: 0,
            met: Cell::new(None),
        }
    }

    /// Extends the last line.
    fn prolong(&mut self, line: &[Segment]) {
        match self.motion.last_mut() {
            Some(last) if !last.is_arc() => {
                last.duration += line.iter().map(|s| s.duration).sum::<f64>();
            }
            _ => self.motion.extend_from_slice(line),
        }
    }
}

/// Path to a goal for the refinement: the departure, the vertices with the whole lines to and
/// beyond them, and the end.
pub(crate) fn path_to(search: &Search<State>, goal: usize) -> Vec<State> {
    let mut path: Vec<State> = Vec::new();
    for index in &search.way_to(goal)[1..] {
        let mut state = search.nodes()[*index].state.clone();
        if state.kind == NodeKind::Held
            && let Some(vertex) = path.last_mut()
        {
            vertex.prolong(&state.motion);
            continue;
        }
        if path.is_empty() && state.kind != NodeKind::End {
            let ahead = state.motion.split_off(state.along);
            path.push(State {
                motion: std::mem::replace(&mut state.motion, ahead),
                ..State::start(search.nodes()[0].state.pose)
            });
        }
        path.push(state);
    }
    path
}

/// The start, and every tested edge, with the node at its end.
pub(crate) fn explored(search: Search<State>) -> ExploredGraph {
    let nodes = search.into_nodes();
    let costs: Vec<f64> = nodes.iter().map(|n| n.cost).collect();
    let mut graph = ExploredGraph::default();
    let mut index_of: Vec<Option<NodeIndex>> = vec![None; nodes.len()];
    for (index, node) in nodes.into_iter().enumerate() {
        let state = node.state;
        let verdict = match (node.fate, state.met.get()) {
            (_, Some(obstacle)) => EdgeVerdict::Blocked { obstacle },
            (Fate::Queued | Fate::Rejected, None) if index > 0 => continue,
            _ => EdgeVerdict::Free,
        };
        let added = graph.add_node(ExploredNode {
            kind: state.kind,
            pose: state.pose,
            time: state.time,
            cost: node.cost,
            expanded: node.fate == Fate::Expanded,
        });
        index_of[index] = Some(added);
        let Some((parent, before)) = node.parent.and_then(|p| Some((p, index_of[p]?))) else {
            continue;
        };
        let edge = ExploredEdge {
            segments: state.motion,
            cost: node.cost - costs[parent],
            verdict,
        };
        graph.add_edge(before, added, edge);
    }
    graph
}
