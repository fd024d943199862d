//! Graph explored by a search, for figures and for tests.

use petgraph::graph::DiGraph;

use searoom_geometry::frame::Pose;
use searoom_model::trajectory::Segment;

/// Kind of a graph node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum NodeKind {
    /// Own ship at t = 0.
    Start,
    /// Moving vertex on the boundary of an obstacle.
    Vertex {
        /// Index of the obstacle.
        obstacle: usize,
        /// Index of the initial set's vertex.
        initial: usize,
        /// Index of the velocity set's vertex.
        velocity: usize,
    },
    /// Point reached by holding the course beyond a vertex.
    Held,
    /// Manoeuvre by the rules: own ship is on a new course, or has passed every target.
    Course,
    /// Path-time graph: point on the boundary of an obstacle, mostly a corner.
    Corner {
        /// Index of the obstacle.
        obstacle: usize,
    },
    /// Path-time graph: end of a leg, or a point on schedule.
    Waypoint,
    /// End of the desired path.
    End,
}

/// Node of the explored graph.
#[derive(Debug, Clone, PartialEq)]
pub struct ExploredNode {
    /// Kind.
    pub kind: NodeKind,
    /// Pose of own ship.
    pub pose: Pose,
    /// Time, seconds.
    pub time: f64,
    /// Cost of the best known path to it, m².
    pub cost: f64,
    /// True when its successors were generated.
    pub expanded: bool,
}

/// Result of the collision test of an edge.
#[derive(Debug, Clone, PartialEq)]
pub enum EdgeVerdict {
    /// Clear of every set.
    Free,
    /// In contact with a set.
    Blocked {
        /// Index of the obstacle: the first, in their order, that the first blocked segment meets.
        obstacle: usize,
    },
}

/// Motion between two nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct ExploredEdge {
    /// Lines and arcs, in order.
    pub segments: Vec<Segment>,
    /// Space-time error of the edge, m².
    pub cost: f64,
    /// Result of its collision test.
    pub verdict: EdgeVerdict,
}

/// The start, and every edge that a search tested, with the node at its end.
pub type ExploredGraph = DiGraph<ExploredNode, ExploredEdge>;
