//! A* and Dijkstra over a graph that is given by its successors.
//!
//! States are continuous, so two paths to one position are two nodes: the search tree contains
//! paths. An edge is tested when its node leaves the queue, not when it enters: most nodes never
//! leave it.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use ordered_float::OrderedFloat;

/// A graph for [`Search`].
///
/// ```
/// use searoom_planner::search::{Counts, Fate, Search, Space, Stop};
///
/// /// Whole numbers, from each one on or twice as far.
/// struct Numbers;
///
/// impl Space for Numbers {
///     type State = u32;
///     fn successors(&mut self, state: &u32, out: &mut Vec<(u32, f64)>) {
///         out.extend([(state + 1, 1.0), (state * 2, 1.0)]);
///     }
///     fn bound(&mut self, _: &u32) -> f64 {
///         0.0
///     }
///     fn is_goal(&self, state: &u32) -> bool {
///         *state == 10
///     }
///     fn admits(&mut self, state: &u32) -> bool {
///         *state <= 10
///     }
/// }
///
/// let mut search = Search::new(1);
/// let Stop::Goal(goal) = search.next_goal(&mut Numbers, 1000) else {
///     panic!("10 can be reached");
/// };
/// let way: Vec<u32> = search.way_to(goal).iter().map(|&n| search.nodes()[n].state).collect();
/// assert_eq!((way.first(), way.last(), way.len()), (Some(&1), Some(&10), 5));
/// assert_eq!(search.nodes()[goal].fate, Fate::Goal);
/// let Counts { expanded, .. } = search.counts();
/// assert!(expanded > 3);
/// ```
pub trait Space {
    /// The state of a node.
    type State;

    /// Adds all successors of a state, each with the cost of its edge (not negative).
    fn successors(&mut self, state: &Self::State, out: &mut Vec<(Self::State, f64)>);

    /// A lower bound of the cost from here to any goal; infinite where no goal is reachable. Zero
    /// turns A* into Dijkstra.
    fn bound(&mut self, state: &Self::State) -> f64;

    /// True at a goal.
    fn is_goal(&self, state: &Self::State) -> bool;

    /// True when the edge into this state may be used. Called at most once per node, when it leaves
    /// the queue.
    fn admits(&mut self, state: &Self::State) -> bool;

    /// True when the search must stop. Asked before every node; successors and bounds made since it
    /// turned true are not used.
    fn is_out_of_time(&self) -> bool {
        false
    }
}

/// Status of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fate {
    /// In the queue; its edge is untested.
    Queued,
    /// Its edge is not admitted.
    Rejected,
    /// Its successors were generated.
    Expanded,
    /// A goal that was reached.
    Goal,
}

/// A node of the search tree.
#[derive(Debug, Clone)]
pub struct Node<S> {
    /// Its state.
    pub state: S,
    /// Its predecessor; `None` at the root.
    pub parent: Option<usize>,
    /// Cost from the root.
    pub cost: f64,
    /// Its status.
    pub fate: Fate,
}

/// Why a search stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// Index of the cheapest goal not yet reported.
    Goal(usize),
    /// No goals remain.
    Exhausted,
    /// The budget of expansions is used up.
    Budget,
    /// [`Space::is_out_of_time`] is true.
    Time,
}

/// Counters of a search.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub struct Counts {
    /// Expanded nodes.
    pub expanded: usize,
    /// Generated nodes.
    pub generated: usize,
    /// Tested edges.
    pub edges_checked: usize,
    /// Last factor of the bounds: 1 for A* and Dijkstra, more for weighted A*.
    #[cfg_attr(feature = "serde", serde(default = "unweighted"))]
    pub heuristic_weight: f64,
}

fn unweighted() -> f64 {
    1.0
}

impl Default for Counts {
    fn default() -> Self {
        Self {
            expanded: 0,
            generated: 0,
            edges_checked: 0,
            heuristic_weight: unweighted(),
        }
    }
}

/// A best-first search that can be resumed: each [`Search::next_goal`] gives the next cheapest
/// goal.
///
/// Ties are broken by smaller cost plus bound, then by greater cost (nearer the goal), then by age.
#[derive(Debug)]
pub struct Search<S> {
    nodes: Vec<Node<S>>,
    queue: BinaryHeap<Reverse<Entry>>,
    counts: Counts,
}

#[derive(Debug, PartialEq, Eq)]
struct Entry {
    estimate: OrderedFloat<f64>,
    cost: OrderedFloat<f64>,
    node: usize,
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        self.estimate
            .cmp(&other.estimate)
            .then_with(|| other.cost.cmp(&self.cost))
            .then_with(|| self.node.cmp(&other.node))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<S> Search<S> {
    /// A search from one root, whose edge needs no test.
    pub fn new(root: S) -> Self {
        let zero = OrderedFloat(0.0);
        let mut queue = BinaryHeap::new();
        queue.push(Reverse(Entry {
            estimate: zero,
            cost: zero,
            node: 0,
        }));
        Self {
            nodes: vec![Node {
                state: root,
                parent: None,
                cost: 0.0,
                fate: Fate::Queued,
            }],
            queue,
            counts: Counts {
                generated: 1,
                ..Counts::default()
            },
        }
    }

    /// Multiplies every bound by a factor of at least 1 from now on (weighted A*,
    /// doi:10.1016/0004-3702(70)90007-X).
    ///
    /// Fewer nodes are expanded. Reported goals cost at most this factor times the cheapest
    /// remaining one. Without bounds nothing changes.
    pub fn weigh(&mut self, weight: f64) {
        let change = weight / self.counts.heuristic_weight;
        let queue = std::mem::take(&mut self.queue).into_vec();
        self.queue = queue
            .into_iter()
            .map(|Reverse(entry)| {
                let to_go = entry.estimate - entry.cost;
                Reverse(Entry {
                    estimate: entry.cost + to_go * change,
                    ..entry
                })
            })
            .collect();
        self.counts.heuristic_weight = weight;
    }

    /// All nodes generated so far.
    pub fn nodes(&self) -> &[Node<S>] {
        &self.nodes
    }

    /// All generated nodes, by value.
    pub fn into_nodes(self) -> Vec<Node<S>> {
        self.nodes
    }

    /// Counters of the search so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Indices of the nodes from the root to `node`.
    pub fn way_to(&self, node: usize) -> Vec<usize> {
        let mut way = vec![node];
        let mut at = node;
        while let Some(parent) = self.nodes[at].parent {
            way.push(parent);
            at = parent;
        }
        way.reverse();
        way
    }

    /// Runs until the next cheapest goal, exhaustion, or `max_expanded` expansions in total.
    ///
    /// The `k`-th goal reported is the `k`-th cheapest if the bound never exceeds the true cost to
    /// go. An edge whose cost or bound is NaN is dropped as not admitted.
    pub fn next_goal<G: Space<State = S>>(&mut self, space: &mut G, max_expanded: usize) -> Stop {
        let mut successors = Vec::new();
        loop {
            if space.is_out_of_time() {
                return Stop::Time;
            }
            let Some(Reverse(entry)) = self.queue.pop() else {
                return Stop::Exhausted;
            };
            let index = entry.node;
            if self.counts.expanded >= max_expanded {
                self.queue.push(Reverse(entry));
                return Stop::Budget;
            }
            if self.nodes[index].parent.is_some() {
                self.counts.edges_checked += 1;
                if !space.admits(&self.nodes[index].state) {
                    self.nodes[index].fate = Fate::Rejected;
                    continue;
                }
            }
            if space.is_goal(&self.nodes[index].state) {
                self.nodes[index].fate = Fate::Goal;
                return Stop::Goal(index);
            }
            self.nodes[index].fate = Fate::Expanded;
            self.counts.expanded += 1;
            successors.clear();
            space.successors(&self.nodes[index].state, &mut successors);
            let cost_here = self.nodes[index].cost;
            for (state, step) in successors.drain(..) {
                let cost = cost_here + step;
                let estimate = cost + self.counts.heuristic_weight * space.bound(&state);
                let comparable = step >= 0.0 && estimate.is_finite();
                let node = self.nodes.len();
                self.counts.generated += 1;
                if comparable {
                    self.queue.push(Reverse(Entry {
                        estimate: OrderedFloat(estimate),
                        cost: OrderedFloat(cost),
                        node,
                    }));
                }
                let fate = if comparable {
                    Fate::Queued
                } else {
                    Fate::Rejected
                };
                self.nodes.push(Node {
                    state,
                    parent: Some(index),
                    cost,
                    fate,
                });
            }
        }
    }
}

#[cfg(test)]
mod tests;
