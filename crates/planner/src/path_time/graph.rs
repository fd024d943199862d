//! Implicit graph of constant-speed lines, defined by its successor function.

use std::cell::Cell;

use super::measure::Measure;
use super::nodes::{Known, Mark, Node, Place};
use super::scene::{Aim, Scene};
use crate::SearchKind;
use crate::clock::Clock;
use crate::search::Space;
use searoom_geometry::tolerance;
use searoom_sets::PathTime;

/// Relative excess over the maximum speed that a line may have, to absorb rounding of its ends.
const FASTER: f64 = 1e-11;

/// Minimum number of lines examined, even after the deadline.
const FEW_LINES: usize = 1_000;

/// Node together with the line that leads to it.
#[derive(Debug, Clone)]
pub(crate) struct State {
    /// Index of the node in the graph.
    pub node: usize,
    /// Index of the node at the start of the line; the node itself at the root.
    pub from: usize,
    /// Leg of the line; `None` for a wait at a point.
    pub leg: Option<usize>,
    /// Bend of the line: full speed before and rest after, or the reverse.
    pub via: Option<PathTime>,
    /// Obstacle that the line intersects, once known.
    pub met: Cell<Option<usize>>,
    /// True after the line was tested.
    pub tested: Cell<bool>,
}

impl State {
    /// A line that is not tested yet.
    fn new(node: usize, from: usize, leg: Option<usize>, via: Option<PathTime>) -> Self {
        Self {
            node,
            from,
            leg,
            via,
            met: Cell::new(None),
            tested: Cell::new(false),
        }
    }
}

/// Implicit search graph. Lines never leave a leg. Full-speed arrivals at the end of a leg become
/// nodes when the search requests them.
#[derive(Debug)]
pub(crate) struct Graph<'a> {
    pub scene: &'a Scene<'a>,
    pub measure: Measure<'a>,
    informed: bool,
    pub nodes: Vec<Node>,
    settled: Vec<bool>,
    /// Indices of the known nodes per leg and per point, in order of time.
    on: Vec<Vec<usize>>,
    at: Vec<Vec<usize>>,
    /// Times at which each point was reached.
    reached: Vec<Vec<f64>>,
    /// Number of lines examined.
    lines: usize,
    clock: Clock,
}

impl<'a> Graph<'a> {
    pub(crate) fn new(
        scene: &'a Scene<'a>,
        known: Known,
        measure: Measure<'a>,
        search: SearchKind,
        root: Node,
        clock: Clock,
    ) -> Self {
        let mut nodes = vec![root];
        let mut number = |list: Vec<Node>| -> Vec<usize> {
            let first = nodes.len();
            nodes.extend(list);
            (first..nodes.len()).collect()
        };
        let on = known.on.into_iter().map(&mut number).collect();
        let at = known.at.into_iter().map(&mut number).collect();
        Self {
            scene,
            measure,
            // the bound selects the best end if own ship need not arrive
            informed: search == SearchKind::AStar || scene.aim == Aim::Last,
            settled: vec![false; nodes.len()],
            nodes,
            on,
            at,
            reached: vec![Vec::new(); scene.network.points()],
            lines: 0,
            clock,
        }
    }

    pub(crate) fn root(&mut self) -> State {
        self.settled[0] = true;
        State::new(0, 0, None, None)
    }

    /// Generates the lines on a leg from a node on it.
    fn along(&mut self, from: usize, leg: usize, out: &mut Vec<(State, f64)>) {
        let scene = self.scene;
        let Some(here) = self.nodes[from].on(scene, leg) else {
            return;
        };
        let end = scene.network.legs()[leg].ends[1];
        let ahead = |list: &Vec<usize>| {
            let first = list.partition_point(|n| self.nodes[*n].time <= here.time);
            list[first..].to_vec()
        };
        let mut candidates = ahead(&self.on[leg]);
        candidates.extend(ahead(&self.at[end]));
        self.lines += candidates.len();
        for to in candidates {
            if self.settled[to] {
                continue;
            }
            let node = self.nodes[to];
            let there = node.at_end_of(scene, leg);
            if self.sailable(here, there)
                && self
                    .measure
                    .joins(scene, [&self.nodes[from], &node], here, there)
            {
                self.offer(from, to, Some(leg), &[here, there], out);
            }
            if let Some(via) = self.measure.bend(scene, leg, &node, here, there) {
                self.offer(from, to, Some(leg), &[here, via, there], out);
            }
        }
        let length = scene.tracks[leg].length;
        let arrival = here.time + (length - here.distance) / scene.max_speed;
        let mut node = Node {
            place: Place::At(end),
            time: arrival,
            on_edge_of: None,
            due: false,
            mark: Mark::Arrival,
        };
        let mut there = PathTime::new(length, arrival);
        // farthest position that own ship reaches before the horizon
        if scene.aim == Aim::Last && arrival > scene.horizon {
            there = PathTime::new(
                here.distance + (scene.horizon - here.time) * scene.max_speed,
                scene.horizon,
            );
            node.place = Place::On {
                leg,
                distance: there.distance,
            };
            node.time = scene.horizon;
        }
        if !scene.in_time(node.left(scene), node.time) {
            return;
        }
        let to = self.nodes.len();
        self.nodes.push(node);
        self.settled.push(false);
        self.offer(from, to, Some(leg), &[here, there], out);
    }

    fn sailable(&self, from: PathTime, to: PathTime) -> bool {
        let (way, time) = (to.distance - from.distance, to.time - from.time);
        way >= 0.0 && time > 0.0 && way <= self.scene.max_speed * time * (1.0 + FASTER)
    }

    /// Adds the line between two nodes, with an optional bend, to the successors.
    fn offer(
        &self,
        from: usize,
        to: usize,
        leg: Option<usize>,
        line: &[PathTime],
        out: &mut Vec<(State, f64)>,
    ) {
        let place = leg.map_or(self.nodes[from].place, |leg| Place::On {
            leg,
            distance: 0.0,
        });
        // collision test first: the cost integral is more expensive
        if let (false, Some(leg)) = (self.measure.waits_are_free(), leg)
            && line
                .windows(2)
                .any(|p| self.scene.barrier(leg, p[0], p[1]).is_some())
        {
            return;
        }
        let mut step: f64 = line
            .windows(2)
            .map(|p| self.measure.of(self.scene, place, p[0], p[1]))
            .sum();
        let via = (line.len() > 2).then(|| line[1]);
        let state = State::new(to, from, leg, via);
        if self.has_arrived(&state) {
            step += self.measure.after_arrival(self.nodes[to].time);
        }
        out.push((state, step));
    }

    /// True if an earlier arrival at the same position dominates this one by waiting. The earlier
    /// path must offer every leg that this point offers.
    fn waited_for(&self, point: usize, time: f64) -> bool {
        let within = self.measure.as_good_within();
        let network = self.scene.network;
        let onward = network.onward(point);
        let as_good = |p: &&usize| onward.iter().all(|leg| network.onward(**p).contains(leg));
        network.same_place(point).iter().filter(as_good).any(|p| {
            self.reached[*p].iter().any(|before| {
                *before <= time
                    && time - *before < within
                    && self.scene.barrier_at(point, *before, time).is_none()
            })
        })
    }

    /// True at the end of the path. A round trip starts at its end, so at least one leg is
    /// required.
    pub(crate) fn has_arrived(&self, state: &State) -> bool {
        let place = self.nodes[state.node].place;
        state.leg.is_some() && matches!(place, Place::At(point) if self.scene.network.is_end(point))
    }

    /// Returns the obstacle that the line into a state intersects.
    fn barrier(&self, state: &State) -> Option<usize> {
        let (from, to) = (&self.nodes[state.from], &self.nodes[state.node]);
        match (state.leg, from.place) {
            (Some(leg), _) => {
                let here = from.on(self.scene, leg)?;
                let there = to.at_end_of(self.scene, leg);
                let first = (self.scene).barrier(leg, here, state.via.unwrap_or(there));
                first.or_else(|| self.scene.barrier(leg, state.via?, there))
            }
            (None, Place::At(point)) => self.scene.barrier_at(point, from.time, to.time),
            (None, Place::On { .. }) => None,
        }
    }
}

impl Space for Graph<'_> {
    type State = State;

    fn successors(&mut self, state: &State, out: &mut Vec<(State, f64)>) {
        let from = state.node;
        match self.nodes[from].place {
            Place::On { leg, .. } => self.along(from, leg, out),
            Place::At(point) => {
                let network = self.scene.network;
                for &leg in network.onward(point) {
                    self.along(from, leg, out);
                }
                let here = PathTime::new(0.0, self.nodes[from].time);
                let first = self.at[point].partition_point(|n| self.nodes[*n].time <= here.time);
                for &to in &self.at[point][first..] {
                    if !self.settled[to] {
                        let there = PathTime::new(0.0, self.nodes[to].time);
                        self.offer(from, to, None, &[here, there], out);
                    }
                }
            }
        }
    }

    fn is_out_of_time(&self) -> bool {
        self.lines >= FEW_LINES && self.clock.is_up()
    }

    fn bound(&mut self, state: &State) -> f64 {
        let node = &self.nodes[state.node];
        let to_go = node.left(self.scene);
        if !self.scene.in_time(to_go, node.time) {
            f64::INFINITY
        } else if self.informed {
            self.measure.bound(self.scene, to_go, node.time)
        } else {
            0.0
        }
    }

    fn is_goal(&self, state: &State) -> bool {
        self.has_arrived(state)
            || self.scene.aim == Aim::Last
                && self.nodes[state.node].time >= self.scene.horizon - tolerance::TIME_S
    }

    fn admits(&mut self, state: &State) -> bool {
        if self.settled[state.node] {
            return false;
        }
        let node = self.nodes[state.node];
        let made = node.mark == Mark::Arrival;
        if let (true, Place::At(point)) = (made, node.place)
            && self.waited_for(point, node.time)
        {
            return false;
        }
        state.tested.set(true);
        state.met.set(self.barrier(state));
        if state.met.get().is_some() {
            return false;
        }
        self.settled[state.node] = true;
        if let Place::At(point) = node.place {
            self.reached[point].push(node.time);
        }
        true
    }
}

#[cfg(test)]
mod tests;
