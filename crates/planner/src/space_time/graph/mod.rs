//! Space-time graph: tangents from the route to moving vertices, courses held beyond them, returns.
//!
//! Nodes and edges are generated on demand by the search. The graph decides on which side and in
//! which order to pass, and whether to wait. `refinement` optimises the lengths.

mod land_edges;
pub(crate) mod node;
pub(crate) mod tangent;

use std::cell::Cell;

use crate::clock::Clock;
use crate::search::Space;
use crate::space_time::bound::Heuristic;
use crate::space_time::context::Context;
use crate::space_time::graph::land_edges::land_edges;
use crate::space_time::graph::node::State;
use crate::space_time::graph::tangent::TangentEdges;
use crate::space_time::land;
use crate::space_time::manoeuvre::chain::Chain;
use crate::space_time::manoeuvre::ending::Ending;
use crate::space_time::manoeuvre::interceptor::{Interceptor, Limits};
use crate::space_time::manoeuvre::motion::until;
use crate::space_time::manoeuvre::return_to_line::motion_back;
use crate::space_time::proxy::{Proxy, by_obstacle, first_met};
use crate::space_time::route::Route;
use crate::{NodeKind, Problem, SearchKind};
use searoom_geometry::frame::Side;
use searoom_geometry::outer_simplified;
use searoom_model::trajectory::Segment;
use searoom_model::vessel::OwnShip;
use searoom_sets::{PolytopeObstacle, Track, along_track};

/// Length of the pieces of the nominal motion in the test which obstacles are relevant, seconds.
const PIECE_S: f64 = 5.0;

/// Space-time graph of one problem.
#[derive(Debug)]
pub(crate) struct Graph<'a> {
    problem: &'a Problem<'a>,
    proxies: &'a [Proxy<'a>],
    route: &'a Route,
    nominal_motion: &'a [Segment],
    contacts: Vec<f64>,
    tangent_edges: Vec<TangentEdges>,
    heuristic: Option<Heuristic<'a>>,
    clock: Clock,
}

impl<'a> Graph<'a> {
    /// `nominal_motion` is the route followed from t = 0. Generates
    /// nothing after the deadline.
    pub(crate) fn new(context: &Context<'a>, nominal_motion: &'a [Segment], clock: Clock) -> Self {
        let &Context {
            problem,
            route,
            proxies,
            ..
        } = context;
        let settings = &problem.settings.graph;
        let first = |h: &Proxy| nominal_motion.iter().find_map(|s| h.first_contact(s));
        let mut contacts: Vec<f64> = by_obstacle(proxies)
            .filter_map(|parts| parts.iter().filter_map(first).min_by(f64::total_cmp))
            .chain(
                land::conflicts(problem.land_obstacle, nominal_motion)
                    .iter()
                    .map(|c| c.from),
            )
            .collect();
        contacts.sort_by(f64::total_cmp);
        contacts.dedup_by(|a, b| *a - *b < settings.contacts_apart_s);
        // short pieces: the bound is loose on long ones
        let pieces: Vec<Segment> = nominal_motion
            .iter()
            .flat_map(|s| {
                let count = (s.duration / PIECE_S).ceil() as usize;
                (0..count).map(move |k| {
                    let from = s.start_time + PIECE_S * k as f64;
                    s.between(from, from + PIECE_S)
                })
            })
            .collect();
        let tangent_edges = proxies
            .iter()
            .filter(|_| !contacts.is_empty())
            .filter(|h| {
                pieces
                    .iter()
                    .any(|s| h.clearance_bound(s) < settings.relevant_m)
            })
            .map(|h| {
                let body = PolytopeObstacle::new(
                    "",
                    outer_simplified(h.body.initial(), settings.initial_vertices),
                    outer_simplified(h.body.velocity(), settings.velocity_vertices),
                );
                TangentEdges::new(h, &body, problem.own.moving_speeds(), |_| true)
            })
            .chain(land_edges(problem, nominal_motion).filter(|_| !contacts.is_empty()))
            .collect();
        let heuristic = (problem.search != SearchKind::Dijkstra)
            .then(|| Heuristic::new(problem.desired, problem.time_weight, problem.own));
        Self {
            problem,
            proxies,
            route,
            nominal_motion,
            contacts,
            tangent_edges,
            heuristic,
            clock,
        }
    }

    /// Own ship at t = 0.
    pub(crate) fn root(&self) -> State {
        State::start(self.problem.own.pose)
    }

    fn push(
        &self,
        out: &mut Vec<(State, f64)>,
        kind: NodeKind,
        ending: Ending,
        motion: Vec<Segment>,
        along: usize,
        from: &State,
    ) {
        let (pose, time) = motion
            .last()
            .map_or((from.pose, from.time), |s| (s.end(), s.end_time()));
        // the search ends after this expansion
        if time > self.problem.horizon || self.clock.is_up() {
            return;
        }
        let cost = match kind {
            NodeKind::End => self.problem.error_to_end(&motion),
            _ => self.problem.error_of(&motion),
        };
        let chain = from.chain + u8::from(matches!(kind, NodeKind::Vertex { .. }));
        let held = if kind == NodeKind::Held {
            from.held + 1
        } else {
            0
        };
        out.push((
            State {
                kind,
                pose,
                time,
                motion,
                along,
                ending,
                chain,
                held,
                met: Cell::new(None),
            },
            cost,
        ));
    }

    /// Edges to a first vertex from several points of the nominal motion, and edges that never
    /// leave the route. A departure is not a node: it costs nothing and decides nothing.
    fn departures(&self, from: &State, out: &mut Vec<(State, f64)>) {
        let nominal_motion = self.nominal_motion.to_vec();
        self.push(out, NodeKind::End, Ending::Follow, nominal_motion, 0, from);
        if self.contacts.is_empty() {
            return;
        }
        let leads = self.problem.settings.graph.leads_s;
        let before = |c: &f64| leads.map(|lead| c - lead).into_iter().chain([*c * 0.5]);
        let mut times: Vec<f64> = self.contacts.iter().flat_map(before).collect();
        times.retain(|t| *t > from.time);
        times.push(from.time);
        times.sort_by(f64::total_cmp);
        times.dedup_by(|a, b| *a - *b < 2.0);
        self.speed_changes(from, out);
        for &time in &times {
            self.interceptions(from, &until(self.nominal_motion, time), out);
        }
    }

    /// Edges that never leave the route: on schedule, then at the least or greatest speed to touch
    /// a corner of a path-time obstacle, then back on schedule.
    fn speed_changes(&self, from: &State, out: &mut Vec<(State, f64)>) {
        let (own, desired) = (self.problem.own, self.problem.desired);
        for (proxy, (index, leg)) in self
            .proxies
            .iter()
            .filter(|h| {
                self.nominal_motion
                    .iter()
                    .any(|s| h.first_contact(s).is_some())
            })
            .flat_map(|h| desired.legs().iter().enumerate().map(move |l| (h, l)))
        {
            if self.clock.is_up() {
                return;
            }
            let Some(stretch) = self.route.stretch(index, desired) else {
                continue;
            };
            let track = Track {
                start: leg.start + leg.direction * stretch.from,
                direction: leg.direction,
                length: stretch.to - stretch.from,
            };
            // in the clock of the convex piece
            let clock = proxy.start();
            let end = proxy.window.map_or(f64::INFINITY, |w| w.end);
            let duration = end.min(self.problem.horizon) - clock;
            let corners = along_track(proxy.body, &track, 0.0, duration);
            for mut corner in corners {
                corner.time += clock;
                let goal = stretch.distance + corner.distance;
                for speed in [own.min_speed(), own.max_speed()] {
                    let Some(departure) = leave_for(self.nominal_motion, goal, corner.time, speed)
                    else {
                        continue;
                    };
                    let mut motion = until(self.nominal_motion, departure);
                    let at: f64 = motion.iter().map(Segment::length).sum();
                    let (pose, _) = self.route.pose_at(at);
                    if speed > 0.0 {
                        self.route.run(at, departure, goal - at, speed, &mut motion);
                    } else {
                        motion.push(Segment::straight(
                            pose,
                            departure,
                            corner.time - departure,
                            speed,
                        ));
                    }
                    let at = if speed > 0.0 { goal } else { at };
                    motion.extend(self.route.follow(at, corner.time));
                    self.push(out, NodeKind::End, Ending::Follow, motion, 0, from);
                }
            }
        }
    }

    /// Tangent edges to vertices, from a node or from the end of a motion `before` along the route.
    fn interceptions(&self, from: &State, before: &[Segment], out: &mut Vec<(State, f64)>) {
        let radius = self.problem.own.turning_radius;
        let settings = &self.problem.settings.graph;
        let (pose, time) = before
            .last()
            .map_or((from.pose, from.time), |s| (s.end(), s.end_time()));
        let limits = Limits {
            turn: settings.max_turn,
            time: (time + settings.max_interception_s).min(self.problem.horizon),
        };
        let interceptors = Side::BOTH.map(|side| Interceptor::new(&pose, time, 1.0, radius, side));
        let mut scratch = Vec::new();
        let first = out.len();
        for tangent_edges in &self.tangent_edges {
            let (clock, until) = tangent_edges.window();
            if time > clock + until {
                continue;
            }
            if self.clock.is_up() {
                return;
            }
            let by_its_clock;
            let interceptors = if clock == 0.0 {
                &interceptors
            } else {
                by_its_clock =
                    Side::BOTH.map(|side| Interceptor::new(&pose, time - clock, 1.0, radius, side));
                &by_its_clock
            };
            let limits = Limits {
                time: (limits.time - clock).min(until),
                ..limits
            };
            tangent_edges.for_each_edge(interceptors, limits, &mut scratch, |edge| {
                if edge.kind == from.kind || edge.meeting.time < 0.0 {
                    return;
                }
                let mut chain = Chain::new(pose, time, edge.speed, radius);
                chain.segments.extend_from_slice(before);
                chain.arc(edge.meeting.turn * radius * edge.side.turn_sign());
                chain.line(edge.meeting.line);
                // a turn of zero length is found on both sides
                let known = out[first..].iter().any(|(s, _)| {
                    s.kind == edge.kind
                        && (s.time - chain.time).abs() < 1e-6
                        && (s.pose.heading - chain.pose.heading).abs() < 1e-6
                });
                if known {
                    return;
                }
                self.push(
                    out,
                    edge.kind,
                    Ending::Follow,
                    chain.segments,
                    before.len(),
                    from,
                );
            });
        }
    }

    /// Edges back onto the legs ahead and straight to the last waypoint, at the greatest speed: own
    /// ship is late after a manoeuvre. Where it would arrive early, a lower speed is tried, too.
    fn returns(&self, from: &State, out: &mut Vec<(State, f64)>) {
        let (own, desired) = (self.problem.own, self.problem.desired);
        let settings = &self.problem.settings.graph;
        let (radius, speed) = (own.turning_radius, own.max_speed());
        let near = desired.nearest(from.pose.position, from.time, 0.0).leg;
        let start = (&from.pose, from.time);
        for leg in near..desired.legs().len().min(near + 2) {
            for angle in settings.return_angles {
                if let Some(motion) = motion_back(self.problem, self.route, start, leg, angle) {
                    let ending = Ending::Return { leg, speed };
                    self.push(out, NodeKind::End, ending, motion, 0, from);
                }
            }
        }
        for side in Side::BOTH {
            let interceptor = Interceptor::new(&from.pose, from.time, speed, radius, side);
            if let Some((turn, line)) = interceptor.path_to(desired.end())
                && turn <= settings.max_turn
            {
                let way = turn * radius + line;
                for speed in goal_speeds(own, way, desired.duration() - from.time) {
                    let mut chain = Chain::new(from.pose, from.time, speed, radius);
                    chain.arc(turn * radius * side.turn_sign());
                    chain.line(line);
                    let ending = Ending::Goal { side, speed };
                    self.push(out, NodeKind::End, ending, chain.segments, 0, from);
                }
            }
        }
    }

    /// Edges straight on from a vertex: the tangent line stays clear of that obstacle.
    fn hold_course(&self, from: &State, out: &mut Vec<(State, f64)>) {
        let hold = self
            .problem
            .settings
            .graph
            .holds_s
            .get(usize::from(from.held));
        if let (Some(last), Some(hold)) = (from.motion.last(), hold) {
            let mut chain = Chain::new(
                from.pose,
                from.time,
                last.speed,
                self.problem.own.turning_radius,
            );
            chain.line(last.speed * hold);
            self.push(out, NodeKind::Held, Ending::Follow, chain.segments, 0, from);
        }
    }
}

/// Time at which to leave a motion for a constant speed, in order to be at a given distance along
/// it at a given time.
fn leave_for(nominal_motion: &[Segment], distance: f64, time: f64, speed: f64) -> Option<f64> {
    let mut at = 0.0;
    for s in nominal_motion {
        // at + s.speed (t - s.start_time) + speed (time - t) = distance
        let gap = distance - at + s.speed * s.start_time - speed * time;
        let t = gap / (s.speed - speed);
        if t.is_finite() && t >= s.start_time && t <= s.end_time() && t < time {
            return Some(t);
        }
        at += s.length();
    }
    None
}

/// The greatest speed, and where that arrives before `left` seconds are over, the greatest one that
/// does not.
fn goal_speeds(own: &OwnShip, way: f64, left: f64) -> impl Iterator<Item = f64> {
    let is_early = |speed: f64| way < speed * left;
    let on_time = own.moving_speeds().filter(|speed| !is_early(*speed));
    let on_time = on_time.reduce(f64::max);
    let (fast, slow) = (own.max_speed(), own.moving_speeds().reduce(f64::min));
    let slower = on_time.or(slow).filter(|speed| *speed < fast);
    [Some(fast), slower].into_iter().flatten()
}

impl Space for Graph<'_> {
    type State = State;

    fn successors(&mut self, state: &State, out: &mut Vec<(State, f64)>) {
        match state.kind {
            NodeKind::Start => self.departures(state, out),
            NodeKind::Vertex { .. } => {
                if state.chain < self.problem.settings.graph.max_chain {
                    self.interceptions(state, &[], out);
                }
                self.returns(state, out);
                self.hold_course(state, out);
            }
            NodeKind::Held => {
                self.returns(state, out);
                self.hold_course(state, out);
            }
            // the others belong to other graphs
            NodeKind::End | NodeKind::Course | NodeKind::Corner { .. } | NodeKind::Waypoint => {}
        }
    }

    fn bound(&mut self, state: &State) -> f64 {
        match (&self.heuristic, state.kind) {
            (None, _) | (_, NodeKind::End) => 0.0,
            (Some(heuristic), _) => heuristic.cost_to_go(&state.pose, state.time),
        }
    }

    fn is_goal(&self, state: &State) -> bool {
        state.kind == NodeKind::End
    }

    fn admits(&mut self, state: &State) -> bool {
        let met = first_met(self.proxies, &state.motion).or_else(|| {
            let on_land = land::meets(self.problem.land_obstacle, &state.motion);
            on_land.then_some(self.problem.obstacles.len())
        });
        state.met.set(met);
        met.is_none()
    }

    fn is_out_of_time(&self) -> bool {
        self.clock.is_up()
    }
}
