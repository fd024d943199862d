//! Initial guesses of the refinement: the graph's plans, and predefined manoeuvres on both sides.

use crate::colregs::APPARENT_TIME;
use crate::frame::{Side, to_port};
use crate::planner::Problem;
use crate::planner::space_time::graph::node::State;
use crate::planner::space_time::proxy::Proxy;
use crate::planner::space_time::refinement::InitialGuess;
use crate::planner::space_time::refinement::quadratic::{MAX_VARIABLES, Row};
use crate::planner::space_time::refinement::structure::{Ending, SegmentVariable, Structure};
use crate::planner::space_time::route::Route;
use crate::planner::space_time::rules::compliance::{slow, visibly_slow};
use crate::trajectory::Segment;

/// Speeds of the manoeuvres: least and greatest speed, and the desired one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpeedTable {
    pub slow: f64,
    pub normal: f64,
    pub fast: f64,
}

impl SpeedTable {
    /// Least and greatest moving speed, and the one nearest to the desired speed.
    pub(crate) fn of(problem: &Problem) -> Self {
        let moving: Vec<f64> = problem
            .own
            .speeds
            .iter()
            .copied()
            .filter(|u| *u > 0.0)
            .collect();
        let desired = problem.desired.length() / problem.desired.duration();
        let nearest = moving
            .iter()
            .copied()
            .min_by(|a, b| (a - desired).abs().total_cmp(&(b - desired).abs()));
        let fast = problem.own.max_speed();
        Self {
            slow: moving.first().copied().unwrap_or(fast),
            normal: nearest.unwrap_or(fast),
            fast,
        }
    }
}

/// Stretch of the nominal motion inside a set, and the offsets that clear the set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Conflict {
    /// Seconds at which the contact begins and ends.
    pub from: f64,
    pub to: f64,
    /// Distance sailed inside, metres.
    pub through: f64,
    /// Offsets to starboard and to port that clear the set throughout, metres.
    pub offsets: [f64; 2],
    /// Offset astern that clears the set throughout, metres, and the time at which it is needed.
    pub astern: (f64, f64),
    /// Offset ahead that clears the set throughout, metres, and the time at which it is needed.
    pub ahead: (f64, f64),
}

impl Conflict {
    /// Offset to a side, metres.
    pub(crate) fn offset(&self, side: Side) -> f64 {
        self.offsets[usize::from(side == Side::Port)]
    }

    /// Ratio of the distance sailed inside to the smaller offset.
    pub(crate) fn slenderness(&self) -> f64 {
        self.through / self.nearest_offset().max(1.0)
    }

    /// Smaller offset of the two sides, metres.
    pub(crate) fn nearest_offset(&self) -> f64 {
        self.offsets[0].min(self.offsets[1])
    }

    /// Contact of one obstacle, given by its proxies, with the nominal motion, from its first to
    /// its last instant.
    pub(crate) fn of(proxies: &[Proxy], nominal_motion: &[Segment]) -> Option<Self> {
        let from = proxies
            .iter()
            .filter_map(|h| nominal_motion.iter().find_map(|s| h.first_contact(s)))
            .min_by(f64::total_cmp)?;
        let end = nominal_motion.last()?.end_time();
        let mut conflict = Self {
            from,
            to: from,
            through: 0.0,
            offsets: [0.0; 2],
            astern: (0.0, from),
            ahead: (0.0, from),
        };
        for k in 0..=CONFLICT_SAMPLES {
            let time = from + (end - from) * k as f64 / CONFLICT_SAMPLES as f64;
            let segment = nominal_motion
                .iter()
                .find(|s| s.end_time() >= time)
                .or(nominal_motion.last())?;
            let pose = segment.pose_at(time);
            let inside = |h: &&Proxy| {
                h.slack(pose.position, time)
                    .is_some_and(|slack| !(slack > 0.0))
            };
            let Some(proxy) = proxies.iter().find(inside) else {
                continue;
            };
            conflict.to = time;
            let behind = proxy.way_out(pose.position, time, -pose.ahead());
            if behind > conflict.astern.0 {
                conflict.astern = (behind, time);
            }
            let before = proxy.way_out(pose.position, time, pose.ahead());
            if before > conflict.ahead.0 {
                conflict.ahead = (before, time);
            }
            for (side, offset) in Side::BOTH.into_iter().zip(&mut conflict.offsets) {
                let beam = to_port(pose.ahead()) * side.turn_sign();
                *offset = offset.max(proxy.way_out(pose.position, time, beam));
            }
        }
        conflict.through = nominal_motion
            .iter()
            .map(|s| s.between(conflict.from, conflict.to).length())
            .sum();
        Some(conflict)
    }
}

/// Return angles of predefined manoeuvres, radians; the smallest that fits is used.
const RETURN_ANGLES: [f64; 4] = [0.3, 0.5, 0.8, 1.1];

/// Turn of a waiting manoeuvre, radians.
const WAITING_TURN: f64 = 0.6;

/// Turns (radians) and outbound line (metres) of a manoeuvre that only slows down on the route.
const SLOWING_TURN: f64 = 0.2;
const SLOWING_OUT_M: f64 = 20.0;

/// Distance beyond the route behind a target that passed ahead, metres, and return angle, radians.
const OVERSHOOT_M: f64 = 20.0;
const OVERSHOOT_RETURN: f64 = 0.08;

/// Manoeuvre that passes ahead: largest ratio of the fast time to the available time; outbound turn
/// and return turn, radians; lines, metres.
const MOST_RUSHING: f64 = 1.6;
const AHEAD_TURN: f64 = 0.5;
const AHEAD_RETURN: f64 = 0.3;
const AHEAD_OUT_M: f64 = 40.0;

/// Samples of a conflict's width.
const CONFLICT_SAMPLES: usize = 24;

/// Predefined evasive manoeuvre: turn, a line out to the offset that clears the set, turn back, a
/// line until the set is passed, return.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Canonical {
    /// Turn, radians.
    pub turn: f64,
    /// Fraction of the outbound part that precedes the contact.
    pub lead: f64,
    /// Target offset as a fraction of the conflict's offset.
    pub reach: f64,
    /// True where the outbound part uses the least speed, not the greatest.
    pub slow: bool,
    /// Fraction of the time before it that is sailed at the greatest speed.
    pub rush: f64,
}

/// Initial guess under construction.
#[derive(Debug, Default)]
pub(crate) struct Draft {
    variables: Vec<SegmentVariable>,
    lengths: Vec<f64>,
}

impl Draft {
    pub(crate) fn push(&mut self, variable: SegmentVariable, length: f64) {
        self.variables.push(variable);
        self.lengths.push(length);
    }

    fn turn(&mut self, side: Side, lengths: &[(f64, f64)]) {
        for (speed, length) in lengths {
            self.push(
                SegmentVariable::Arc {
                    side,
                    speed: *speed,
                },
                *length,
            );
        }
    }

    fn line(&mut self, lengths: &[(f64, f64)]) {
        for (speed, length) in lengths {
            self.push(SegmentVariable::Line { speed: *speed }, *length);
        }
    }

    pub(crate) fn runs(&mut self, speed_table: &SpeedTable, normal: f64, fast: f64, slow: f64) {
        self.push(
            SegmentVariable::Run {
                speed: speed_table.normal,
            },
            normal,
        );
        self.push(
            SegmentVariable::Run {
                speed: speed_table.fast,
            },
            fast,
        );
        self.push(
            SegmentVariable::Run {
                speed: speed_table.slow,
            },
            slow,
        );
    }

    pub(crate) fn guess(self, ending: Ending) -> Option<InitialGuess> {
        if self.variables.len() + 2 > MAX_VARIABLES {
            return None;
        }
        let mut lengths: Row = [0.0; MAX_VARIABLES];
        lengths[..self.lengths.len()].copy_from_slice(&self.lengths);
        Some(InitialGuess {
            structure: Structure {
                variables: self.variables,
                ending,
            },
            lengths,
        })
    }
}

impl Canonical {
    /// Initial guess on one side of the route.
    pub(crate) fn guess(
        &self,
        problem: &Problem,
        route: &Route,
        side: Side,
        conflict: &Conflict,
        leg: usize,
    ) -> Option<InitialGuess> {
        let speed_table = SpeedTable::of(problem);
        let radius = problem.own.turning_radius;
        let (slow, fast) = (speed_table.slow, speed_table.fast);
        let offset = (conflict.offset(side) * self.reach).min(2.0 * route.length());
        // two arcs alone reach an offset of twice the versine
        let needed = (1.0 - (offset / (2.0 * radius))).clamp(-1.0, 1.0).acos();
        let turn = self
            .turn
            .min(needed.max(0.1))
            .max(problem.duty().least_turn());
        let out = ((offset - 2.0 * radius * (1.0 - turn.cos())) / turn.sin()).max(0.0);
        let arc = turn * radius;
        let way_out = (2.0 * arc + out) / if self.slow { speed_table.normal } else { fast };
        let departure = (conflict.from - self.lead * way_out).max(0.0);
        let lead = (departure * speed_table.normal).min(route.length());
        // progress along the route outbound, and on the return at the smallest angle that fits
        let made_good = lead + 2.0 * radius * turn.sin() + out * turn.cos();
        let room = route.length() - made_good;
        let way_back = |angle: f64| {
            let line = (offset - 2.0 * radius * (1.0 - angle.cos())).max(0.0);
            2.0 * radius * angle.sin() + line / angle.tan()
        };
        let angle = RETURN_ANGLES.into_iter().find(|a| way_back(*a) < room);
        let along = ((conflict.to - departure - way_out) * fast).max(0.0);
        let along = along
            .min(0.98 * (room - angle.map_or(0.5 * room, way_back)))
            .max(0.0);
        let mut draft = Draft::default();
        draft.runs(
            &speed_table,
            (1.0 - self.rush) * lead,
            self.rush * departure * fast,
            0.0,
        );
        let (fast_arc, slow_arc) = if self.slow { (0.0, arc) } else { (arc, 0.0) };
        let (fast_line, slow_line) = if self.slow { (0.0, out) } else { (out, 0.0) };
        let back = side.opposite();
        draft.turn(side, &[(fast, fast_arc), (slow, slow_arc)]);
        draft.line(&[(slow, slow_line), (fast, fast_line)]);
        draft.turn(back, &[(fast, arc)]);
        draft.line(&[(fast, 0.5 * along)]);
        draft.turn(back, &[(fast, 0.0)]);
        draft.line(&[(fast, 0.5 * along)]);
        let Some(angle) = angle else {
            return draft.guess(Ending::Goal {
                side: back,
                speed: fast,
            });
        };
        draft.push(
            SegmentVariable::Arc {
                side: back,
                speed: fast,
            },
            angle.min(needed.max(0.1)) * radius,
        );
        draft.guess(Ending::Return { leg, speed: fast })
    }
}

/// Waiting manoeuvre: lets the target pass ahead. As late as possible own ship slows down and loses
/// distance by a turn of [`WAITING_TURN`] to the side, a turn back of twice that, and a turn onto
/// the route.
pub(crate) fn waiting(
    problem: &Problem,
    side: Side,
    across: bool,
    conflict: &Conflict,
    leg: usize,
) -> Option<InitialGuess> {
    let speed_table = SpeedTable::of(problem);
    let (slow, normal, fast) = (speed_table.slow, speed_table.normal, speed_table.fast);
    let (lag, due) = conflict.astern;
    let needed = lag / (normal - slow * WAITING_TURN.cos());
    let begin = (due - needed).max(0.0);
    let arc = WAITING_TURN * problem.own.turning_radius;
    let lines = ((due - begin) * slow - 3.0 * arc).max(0.0);
    // negated on purpose: a NaN gives no initial guess
    if !(normal > slow && needed < 1.3 * due && lines.is_finite()) {
        return None;
    }
    let back = side.opposite();
    let mut draft = Draft::default();
    draft.runs(&speed_table, begin * normal, 0.0, 0.0);
    draft.turn(side, &[(fast, 0.0), (slow, arc)]);
    draft.line(&[(slow, 0.6 * lines), (fast, 0.0)]);
    draft.turn(back, &[(slow, 2.0 * arc), (fast, 0.0)]);
    draft.line(&[(slow, 0.4 * lines)]);
    if across {
        let (sine, cosine) = WAITING_TURN.sin_cos();
        let offset = problem.own.turning_radius * (1.0 - cosine) + 0.2 * lines * sine;
        draft.line(&[(fast, (offset + OVERSHOOT_M) / sine)]);
        draft.turn(back, &[(fast, 0.0)]);
        draft.turn(
            side,
            &[(fast, arc + OVERSHOOT_RETURN * problem.own.turning_radius)],
        );
        draft.line(&[(fast, 0.0)]);
        return draft.guess(Ending::Return { leg, speed: fast });
    }
    draft.line(&[(fast, 0.0)]);
    draft.turn(back, &[(fast, 0.0)]);
    draft.line(&[(fast, 0.0)]);
    draft.turn(back, &[(fast, 0.0)]);
    draft.guess(Ending::Return { leg, speed: fast })
}

/// Manoeuvre that slows down on the route until the target has passed, then moves slightly to the
/// side and back.
pub(crate) fn slowing(
    problem: &Problem,
    side: Side,
    conflict: &Conflict,
    leg: usize,
) -> Option<InitialGuess> {
    let speed_table = SpeedTable::of(problem);
    let (lag, due) = conflict.astern;
    let spell = (lag / (speed_table.normal - speed_table.slow)).max(APPARENT_TIME);
    let begin = (due - spell).max(0.0);
    // negated on purpose: a NaN gives no initial guess
    if !(problem.duty().may_slow && speed_table.slow <= slow(problem) && spell < 2.0 * due) {
        return None;
    }
    let radius = problem.own.turning_radius;
    let arc = SLOWING_TURN * radius;
    let back = side.opposite();
    let mut draft = Draft::default();
    draft.runs(
        &speed_table,
        begin * speed_table.normal,
        0.0,
        spell * speed_table.slow,
    );
    draft.turn(side, &[(speed_table.slow, arc), (speed_table.fast, 0.0)]);
    draft.line(&[(speed_table.slow, 0.0), (speed_table.fast, SLOWING_OUT_M)]);
    draft.turn(back, &[(speed_table.fast, arc)]);
    draft.line(&[(speed_table.slow, 0.0), (speed_table.fast, 0.0)]);
    draft.turn(back, &[(speed_table.fast, arc)]);
    draft.guess(Ending::Return {
        leg,
        speed: speed_table.fast,
    })
}

/// Manoeuvre that passes ahead of the target. Own ship speeds up as early as needed, turns to the
/// side halfway through the contact for the missing distance, and loses its lead on a slow return.
pub(crate) fn ahead(
    problem: &Problem,
    side: Side,
    conflict: &Conflict,
    leg: usize,
) -> Option<InitialGuess> {
    let speed_table = SpeedTable::of(problem);
    let (slow, normal, fast) = (speed_table.slow, speed_table.normal, speed_table.fast);
    let (lead, due) = conflict.ahead;
    let needed = lead / (fast - normal);
    let begin = (due - needed).max(0.0);
    let turn = 0.5 * (conflict.from + due);
    // negated on purpose: a NaN gives no initial guess
    if !(fast > normal && needed < MOST_RUSHING * due && turn > begin) {
        return None;
    }
    let radius = problem.own.turning_radius;
    let arc = AHEAD_TURN * radius;
    let back = side.opposite();
    let mut draft = Draft::default();
    draft.runs(&speed_table, begin * normal, (turn - begin) * fast, 0.0);
    draft.turn(side, &[(fast, arc)]);
    draft.line(&[(fast, AHEAD_OUT_M)]);
    draft.turn(back, &[(fast, 0.0), (slow, arc + AHEAD_RETURN * radius)]);
    draft.line(&[(slow, AHEAD_OUT_M), (normal, 0.0)]);
    draft.turn(side, &[(slow, 0.0), (fast, 0.0)]);
    draft.line(&[(slow, 0.0), (fast, 0.0)]);
    draft.guess(Ending::Return { leg, speed: normal })
}

/// Graph plan as an initial guess. It keeps the order of arcs and lines, adds the other speeds
/// beside each, and an empty turn back where it has only one turn. `way` holds the states after the
/// root.
pub(crate) fn from_graph(problem: &Problem, way: &[&State]) -> Option<InitialGuess> {
    let speed_table = SpeedTable::of(problem);
    let (last, before) = way.split_last()?;
    let (departure, vertices) = before.split_first()?;
    if vertices.is_empty() {
        return None;
    }
    let mut draft = Draft::default();
    let along: f64 = departure.motion.iter().map(Segment::length).sum();
    let slow = visibly_slow(problem, &departure.motion);
    draft.runs(&speed_table, along - slow, 0.0, slow);
    let mut side = None;
    let mut turns = 0;
    for vertex in vertices {
        let turn = vertex.motion.iter().find(|s| s.is_arc());
        let line = vertex.motion.iter().find(|s| !s.is_arc());
        let before = side;
        side = turn.and_then(|s| Side::of_turn(s.turn_rate)).or(side);
        let side = side.unwrap_or(Side::Starboard);
        turns += usize::from(before != Some(side));
        group(&mut draft, &speed_table, side, turn, line, vertices.len());
        if vertices.len() == 1 {
            draft.turn(side, &[(speed_table.fast, 0.0)]);
            draft.line(&[(speed_table.fast, 0.0)]);
        }
    }
    let back = side.unwrap_or(Side::Starboard).opposite();
    if turns < 2 && vertices.len() < 3 {
        group(&mut draft, &speed_table, back, None, None, vertices.len());
    }
    match last.ending {
        Ending::Return { leg, .. } => {
            let first = last.motion.first().filter(|s| s.is_arc());
            let side = first
                .and_then(|s| Side::of_turn(s.turn_rate))
                .unwrap_or(back);
            let length = first.map_or(0.0, Segment::length);
            draft.push(
                SegmentVariable::Arc {
                    side,
                    speed: speed_table.fast,
                },
                length,
            );
            draft.guess(Ending::Return {
                leg,
                speed: speed_table.fast,
            })
        }
        Ending::Goal { side, speed } => draft.guess(Ending::Goal { side, speed }),
        Ending::Follow => None,
    }
}

/// Turn and line, with fewer speeds where there are many such groups.
fn group(
    draft: &mut Draft,
    speed_table: &SpeedTable,
    side: Side,
    turn: Option<&Segment>,
    line: Option<&Segment>,
    groups: usize,
) {
    let SpeedTable { slow, normal, fast } = *speed_table;
    let own = turn.or(line).map_or(fast, |s| s.speed);
    let (turns, lines): (&[f64], &[f64]) = match groups {
        0..=3 => (&[slow, fast], &[slow, normal, fast]),
        // limits the number of variables
        4 => (&[own], &[slow, normal, fast]),
        _ => (&[own], &[slow, fast]),
    };
    let turns = shared(turn, turns);
    draft.turn(side, &turns);
    let lines = shared(line, lines);
    draft.line(&lines);
}

/// Speeds without repetition; the one nearest to the segment's speed gets its length.
fn shared(segment: Option<&Segment>, speeds: &[f64]) -> Vec<(f64, f64)> {
    let mut lengths: Vec<(f64, f64)> = speeds.iter().map(|u| (*u, 0.0)).collect();
    lengths.dedup();
    if let Some(s) = segment {
        let nearest = lengths
            .iter_mut()
            .min_by(|a, b| (a.0 - s.speed).abs().total_cmp(&(b.0 - s.speed).abs()));
        if let Some(nearest) = nearest {
            nearest.1 = s.length();
        }
    }
    lengths
}
