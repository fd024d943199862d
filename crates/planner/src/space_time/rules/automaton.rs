//! The graph of manoeuvres by the rules: a node is a phase with the motion to it, and an edge a part of
//! a manoeuvre that hugs what it passes.
//!
//! ```text
//! Route ─► Out ─┬► direct ──────────┬► Passed ─► back at an angle, or to the end ─► End
//!               └► parallel, wider ─┘
//! Route ─► Out at half speed or less ──► along the route again ──► End
//! ```
//!
//! The cost is J by [`Manoeuvres::price`]. The judge decides on an end when it leaves the queue, so
//! the first goal is the cheapest lawful manoeuvre of the graph. A wider parallel course is a successor of
//! the next narrower one where it is sure to cost more ([`Manoeuvres::leads_off`]).

use std::cell::RefCell;

use petgraph::graph::NodeIndex;

use crate::clock::Clock;
use crate::search::{Fate, Search, Space};
use crate::space_time::bound::squared_ramp;
use crate::space_time::manoeuvre::motion::part;
use crate::space_time::proxy::first_met;
use crate::space_time::rules::hug::COARSE_S;
use crate::space_time::rules::manoeuvre::{
    FirstAlteration, Manoeuvres, Outward, Partial, Phase, WayBack,
};
use crate::{
    EdgeVerdict, ExploredEdge, ExploredGraph, ExploredNode, NodeKind, SearchKind, SearchStats,
};
use searoom_geometry::frame::{Vector, cross};

/// The graph of manoeuvres with these departures and first alterations.
pub(super) struct Graph<'g, 's, 'a> {
    pub manoeuvres: &'g Manoeuvres<'s, 'a>,
    /// Successors of the start.
    pub departures: Vec<(f64, FirstAlteration)>,
    /// Angles of the returns, radians.
    pub angles: &'g [f64],
    /// Only manoeuvres that cost less before they are improved are of use, m².
    pub below: f64,
}

impl Space for Graph<'_, '_, '_> {
    type State = Partial;

    fn successors(&mut self, state: &Partial, out: &mut Vec<(Partial, f64)>) {
        let from = state.cost;
        let mut add = |next: Partial| {
            let step = next.cost - from;
            // the cost of a part and that of the whole differ by rounding
            out.push((next, step.max(0.0)));
        };
        match state.phase {
            Phase::Route => {
                let all = self.departures.iter();
                all.filter_map(|&(leave, first)| self.manoeuvres.out(leave, first))
                    .for_each(add);
            }
            Phase::Out => match state.first {
                FirstAlteration::Slow { .. } => {
                    self.manoeuvres
                        .slowed(state, COARSE_S)
                        .into_iter()
                        .for_each(add);
                }
                FirstAlteration::Turn { .. } => {
                    for passed in outward(self.manoeuvres, state) {
                        // where a wider course may be cheaper, it does not wait for the narrower one
                        let mut next = match self.manoeuvres.leads_off(state) {
                            true => None,
                            false => wider(self.manoeuvres, &passed),
                        };
                        add(passed);
                        while let Some(found) = next {
                            next = wider(self.manoeuvres, &found);
                            add(found);
                        }
                    }
                }
            },
            Phase::Passed => {
                if self.manoeuvres.leads_off(state) {
                    wider(self.manoeuvres, state).into_iter().for_each(&mut add);
                }
                ways_back(self.manoeuvres, state, self.angles, self.below).for_each(add);
            }
            Phase::End => {}
        }
    }

    fn bound(&mut self, state: &Partial) -> f64 {
        let to_go = match self.manoeuvres.problem().search {
            SearchKind::Dijkstra => 0.0,
            _ => self.manoeuvres.to_go(state),
        };
        match state.cost + to_go < self.below {
            true => to_go,
            false => f64::INFINITY,
        }
    }

    fn is_goal(&self, state: &Partial) -> bool {
        state.phase == Phase::End
    }

    fn admits(&mut self, state: &Partial) -> bool {
        match state.phase {
            Phase::Route => true,
            Phase::Out => self.manoeuvres.is_clear(state.off_route()),
            // each was tested when it was made
            Phase::Passed => true,
            Phase::End => self.manoeuvres.is_lawful(state),
        }
    }

    fn is_out_of_time(&self) -> bool {
        self.manoeuvres.effort.clock.is_up()
    }
}

/// The ends of a manoeuvre once the targets are passed: onto the route at some angles, radians, the least
/// first. Where the route is too short for the least, also by one turn to the last waypoint.
/// Only those that cost less than `below`.
pub(super) fn ways_back<'m>(
    manoeuvres: &'m Manoeuvres,
    passed: &'m Partial,
    angles: &'m [f64],
    below: f64,
) -> impl Iterator<Item = Partial> + 'm {
    let onto = angles.iter().map(|angle| WayBack::At(*angle));
    let flattest = angles
        .first()
        .filter(|angle| manoeuvres.ends_soon(passed, **angle));
    let to_end = flattest.map(|_| WayBack::ToEnd);
    let ways = onto.chain(to_end);
    ways.filter_map(move |way| manoeuvres.back(passed, way, COARSE_S, below))
}

/// The ways to go on after a turn until the targets are passed: straight, and on the nearest parallel
/// course.
pub(super) fn outward(manoeuvres: &Manoeuvres, out: &Partial) -> impl Iterator<Item = Partial> {
    let begun = manoeuvres.problem().under_way;
    let may_turn_back = begun.is_none_or(|begun| begun.may_turn_back());
    let parallel = || manoeuvres.parallel(out, manoeuvres.settings().room_s[0], COARSE_S, None);
    let parallel = may_turn_back.then(parallel).flatten();
    manoeuvres.direct(out).into_iter().chain(parallel)
}

/// The next wider parallel course after this one. Where it leads off the route, it costs more.
pub(super) fn wider(manoeuvres: &Manoeuvres, passed: &Partial) -> Option<Partial> {
    let Outward::Parallel { spare } = passed.outward else {
        return None;
    };
    let rooms = manoeuvres
        .settings()
        .room_s
        .map(|room| room * manoeuvres.unit);
    let mut rooms = rooms.into_iter().filter(|room| *room > spare);
    let room = rooms.find(|room| !manoeuvres.goes_on(passed, *room))?;
    let out = manoeuvres.out(passed.leave, passed.first)?;
    manoeuvres.parallel(&out, room, COARSE_S, Some(passed))
}

impl Manoeuvres<'_, '_> {
    /// Lower bound of the cost from a partial manoeuvre to its end, m².
    pub(super) fn to_go(&self, partial: &Partial) -> f64 {
        let held = match partial.phase {
            Phase::End | Phase::Route => return 0.0,
            Phase::Out => self.until_passed(partial),
            Phase::Passed => 0.0,
        };
        let (pose, time) = partial.end(self.problem().own.pose);
        let free = self.bound.cost_to_go(&pose, time);
        free.max(held) * self.price(partial.first)
    }

    /// Lower bound of the space-time error from the line after a turn to the end, m²: until every target
    /// is passed, own ship keeps its course or turns back to its first one, so neither its offset nor its
    /// lag shrinks; then both may, at the greatest speed.
    ///
    /// A target is passed when a quantity that is linear in time on each of the two courses is used up,
    /// which takes at least as long as at the greatest rate on a course between them. Zero where own ship
    /// does not depart along its leg, and where there are several. The lag counts where own ship is late
    /// and no faster than the leg.
    fn until_passed(&self, out: &Partial) -> f64 {
        let problem = self.problem();
        let ([leg], FirstAlteration::Turn { speed, .. }) = (problem.desired.legs(), out.first)
        else {
            return 0.0;
        };
        let (pose, time) = out.end(problem.own.pose);
        let offset = pose.position - leg.start;
        let (along, across) = (leg.direction.dot(&offset), cross(leg.direction, offset));
        let lag = leg.speed * (time - leg.start_time) - along;
        // on its first course own ship keeps its offset
        if !self.leads_off(out) {
            return 0.0;
        }
        let from = self.departs_from(out).ahead();
        let mut passed = 0.0_f64;
        for e in self.passing.iter().map(|p| p.encountered) {
            let target = e.ship.velocity();
            let apart = e.ship.moved(time).pose.position - pose.position;
            let relative = e.own.velocity() - target;
            let left = apart.dot(&relative);
            let rate = |ahead: Vector| (ahead * speed - target).dot(&relative);
            // on the arc between them the course may be that of the relative velocity
            let [a, b] = [pose.ahead(), from].map(|course| cross(course, relative));
            let between = a * b < 0.0 && relative.dot(&(pose.ahead() + from)) > 0.0;
            let most = match between {
                true => relative.norm() * speed - target.dot(&relative),
                false => f64::NEG_INFINITY,
            };
            let fastest = most.max(rate(pose.ahead())).max(rate(from));
            if left > 0.0 && fastest > 0.0 {
                passed = passed.max(left / fastest);
            }
        }
        // a faster ship may make good its lag before
        let lags = lag >= 0.0 && speed <= leg.speed;
        let kappa = problem.time_weight / (problem.time_weight + leg.speed * leg.speed);
        let kappa = if lags { kappa } else { 0.0 };
        let fastest = problem.own.max_speed();
        let least = (problem.desired.end() - pose.position).norm() / fastest;
        let held = passed * (across * across + kappa * lag * lag);
        let back = squared_ramp(across.abs(), -fastest, f64::INFINITY);
        let recovered = kappa * squared_ramp(lag, leg.speed - fastest, least - passed);
        (held + back + recovered) / problem.desired.duration()
    }
}

/// The time that is left for the searches of one plan, and what they have explored.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Effort<'e> {
    pub clock: Clock,
    pub explored: &'e RefCell<Explored>,
}

/// What the searches of one plan have explored.
#[derive(Debug, Default)]
pub(crate) struct Explored {
    pub counts: SearchStats,
    pub graph: ExploredGraph,
}

impl Explored {
    /// Adds the counts of a search, and every edge that it used. All searches begin at one node.
    pub(super) fn add(&mut self, manoeuvres: &Manoeuvres, search: Search<Partial>) {
        let counts = search.counts();
        self.counts.expanded += counts.expanded;
        self.counts.generated += counts.generated;
        self.counts.edges_checked += counts.edges_checked;
        let own = manoeuvres.problem().own.pose;
        let nodes = search.into_nodes();
        let mut index_of: Vec<Option<NodeIndex>> = vec![None; nodes.len()];
        for (index, node) in nodes.iter().enumerate() {
            let state = &node.state;
            let blocked = || first_met(manoeuvres.context.proxies, state.off_route());
            let verdict = match (node.fate, state.phase) {
                (Fate::Expanded | Fate::Goal, _) => EdgeVerdict::Free,
                (Fate::Rejected, Phase::Out) => match blocked() {
                    Some(obstacle) => EdgeVerdict::Blocked { obstacle },
                    None => continue,
                },
                _ => continue,
            };
            let kind = match state.phase {
                Phase::Route => NodeKind::Start,
                Phase::Out | Phase::Passed => NodeKind::Course,
                Phase::End => NodeKind::End,
            };
            let (pose, time) = state.end(own);
            let start = self.graph.node_indices().next();
            let start = start.filter(|_| state.phase == Phase::Route);
            let added = start.unwrap_or_else(|| {
                self.graph.add_node(ExploredNode {
                    kind,
                    pose,
                    time,
                    cost: node.cost,
                    expanded: node.fate == Fate::Expanded,
                })
            });
            index_of[index] = Some(added);
            // a wider course branches off where the narrower one does
            let mut parent = node.parent;
            while let Some(p) = parent
                && (state.phase, nodes[p].state.phase) == (Phase::Passed, Phase::Passed)
            {
                parent = nodes[p].parent;
            }
            let Some((parent, before)) = parent.and_then(|p| Some((p, index_of[p]?))) else {
                continue;
            };
            let (_, since) = nodes[parent].state.end(own);
            let edge = ExploredEdge {
                segments: part(&state.motion, since, f64::INFINITY),
                cost: node.cost - nodes[parent].cost,
                verdict,
            };
            self.graph.add_edge(before, added, edge);
        }
    }
}
