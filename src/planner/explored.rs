//! The graph that a search made, kept for pictures and as an oracle for tests.

use petgraph::graph::DiGraph;

use crate::frame::Pose;
use crate::trajectory::Segment;

/// What a node of a graph is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum NodeKind {
    /// Own ship at t = 0.
    Start,
    /// On an edge of an obstacle: a moving vertex.
    Vertex {
        /// Index of the obstacle.
        obstacle: usize,
        /// Index of the initial set's vertex.
        initial: usize,
        /// Index of the velocity set's vertex.
        velocity: usize,
    },
    /// Straight on from a vertex for a while.
    Held,
    /// On a path: on the edge of an obstacle in distance and time, mostly at a corner.
    Corner {
        /// Index of the obstacle.
        obstacle: usize,
    },
    /// On a path: the end of a leg, or a place on schedule.
    Waypoint,
    /// The end of the desired path.
    End,
}

/// A node that the search made.
#[derive(Debug, Clone, PartialEq)]
pub struct ExploredNode {
    /// What it is.
    pub kind: NodeKind,
    /// Where own ship is there.
    pub pose: Pose,
    /// And when, seconds.
    pub time: f64,
    /// Cost of the best known way to it, m².
    pub cost: f64,
    /// True when its successors were made.
    pub expanded: bool,
}

/// What is known of an edge.
#[derive(Debug, Clone, PartialEq)]
pub enum EdgeVerdict {
    /// Clear of every set.
    Free,
    /// Meets a set.
    Blocked {
        /// Index of an obstacle that it meets: the first, in their order, that its first blocked segment
        /// meets.
        obstacle: usize,
    },
    /// Never reached by the search, so never tested.
    Untested,
}

/// A motion between two nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct ExploredEdge {
    /// Lines and arcs, in order.
    pub segments: Vec<Segment>,
    /// Its part of the space-time error, m².
    pub cost: f64,
    /// Tested or not, free or not.
    pub verdict: EdgeVerdict,
}

/// Every node and edge that a search made.
pub type ExploredGraph = DiGraph<ExploredNode, ExploredEdge>;
