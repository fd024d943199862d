//! Initial guesses of the refinement: the graph's plans, and predefined manoeuvres on both sides.

use crate::Problem;
use crate::space_time::graph::node::State;
use crate::space_time::manoeuvre::conflict::Conflict;
use crate::space_time::manoeuvre::ending::Ending;
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::refinement::InitialGuess;
use crate::space_time::refinement::quadratic::MAX_VARIABLES;
use crate::space_time::refinement::structure::SegmentVariable;
use crate::space_time::route::Route;
use searoom_geometry::frame::Side;
use searoom_model::trajectory::Segment;

/// Predefined evasive manoeuvre: turn, a line out to the offset that clears the set, turn back, a
/// line until the set is passed, return.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EvasiveManoeuvre {
    /// Turn, radians.
    pub turn: f64,
    /// Fraction of the outbound part that precedes the contact.
    pub lead: f64,
    /// Target offset as a fraction of the conflict's offset.
    pub reach: f64,
    /// True where the outbound part uses the least speed, not the greatest.
    pub slow: bool,
    /// Fraction of the time before it that is sailed at the greatest speed.
    pub fast_share: f64,
}

/// Initial guess under construction.
#[derive(Debug, Default)]
pub(crate) struct InitialGuessBuilder {
    pieces: Vec<(SegmentVariable, f64)>,
}

impl InitialGuessBuilder {
    pub(crate) fn push(&mut self, variable: SegmentVariable, length: f64) {
        self.pieces.push((variable, length));
    }

    fn turn(&mut self, side: Side, lengths: &[(f64, f64)]) {
        for (speed, length) in lengths {
            let speed = *speed;
            self.push(SegmentVariable::Arc { side, speed }, *length);
        }
    }

    fn line(&mut self, lengths: &[(f64, f64)]) {
        for (speed, length) in lengths {
            self.push(SegmentVariable::Line { speed: *speed }, *length);
        }
    }

    /// The route at the ordered speeds, then at the greatest and the least one.
    pub(crate) fn runs(&mut self, speeds: &ManoeuvreSpeeds, ordered: f64, fast: f64, slow: f64) {
        let speed = speeds.normal;
        self.push(SegmentVariable::Ordered { speed }, ordered);
        for (speed, length) in [(speeds.fast, fast), (speeds.slow, slow)] {
            self.push(SegmentVariable::Run { speed }, length);
        }
    }

    pub(crate) fn build(self, ending: Ending) -> Option<InitialGuess> {
        // the ending may have two segment variables
        let has_room = self.pieces.len() + 2 <= MAX_VARIABLES;
        has_room.then(|| InitialGuess::new(&self.pieces, ending))
    }
}

impl EvasiveManoeuvre {
    /// Manoeuvre whose outbound part uses the greatest speed.
    pub(crate) const fn new(turn: f64, lead: f64, reach: f64) -> Self {
        Self {
            turn,
            lead,
            reach,
            slow: false,
            fast_share: 0.0,
        }
    }

    /// Manoeuvre whose outbound part uses the least speed.
    pub(crate) const fn slow(turn: f64, lead: f64, reach: f64) -> Self {
        Self {
            slow: true,
            ..Self::new(turn, lead, reach)
        }
    }

    /// Initial guess on one side of the route.
    pub(crate) fn guess(
        &self,
        problem: &Problem,
        route: &Route,
        side: Side,
        conflict: &Conflict,
        leg: usize,
    ) -> Option<InitialGuess> {
        let speeds = ManoeuvreSpeeds::at(problem, conflict.from);
        let radius = problem.own.turning_radius;
        let (slow, fast) = (speeds.slow, speeds.fast);
        let offset = (conflict.offset(side) * self.reach).min(2.0 * route.length());
        // two arcs alone reach an offset of twice the versine
        let needed = (1.0 - (offset / (2.0 * radius))).clamp(-1.0, 1.0).acos();
        let turn = self.turn.min(needed.max(0.1));
        let out = ((offset - 2.0 * radius * (1.0 - turn.cos())) / turn.sin()).max(0.0);
        let arc = turn * radius;
        let exit_distance = (2.0 * arc + out) / if self.slow { speeds.normal } else { fast };
        let departure = (conflict.from - self.lead * exit_distance).max(0.0);
        let lead = route.ordered_distance(departure);
        // progress along the route outbound, and on the return at the smallest angle that fits
        let made_good = lead + 2.0 * radius * turn.sin() + out * turn.cos();
        let room = route.length() - made_good;
        let way_back = |angle: f64| {
            let line = (offset - 2.0 * radius * (1.0 - angle.cos())).max(0.0);
            2.0 * radius * angle.sin() + line / angle.tan()
        };
        let angle = problem.settings.guesses.return_angles;
        let angle = angle.into_iter().find(|a| way_back(*a) < room);
        let along = ((conflict.to - departure - exit_distance) * fast).max(0.0);
        let along = along
            .min(0.98 * (room - angle.map_or(0.5 * room, way_back)))
            .max(0.0);
        let mut builder = InitialGuessBuilder::default();
        builder.runs(
            &speeds,
            (1.0 - self.fast_share) * lead,
            self.fast_share * departure * fast,
            0.0,
        );
        let (fast_arc, slow_arc) = if self.slow { (0.0, arc) } else { (arc, 0.0) };
        let (fast_line, slow_line) = if self.slow { (0.0, out) } else { (out, 0.0) };
        let back = side.opposite();
        builder.turn(side, &[(fast, fast_arc), (slow, slow_arc)]);
        builder.line(&[(slow, slow_line), (fast, fast_line)]);
        builder.turn(back, &[(fast, arc)]);
        builder.line(&[(fast, 0.5 * along)]);
        builder.turn(back, &[(fast, 0.0)]);
        builder.line(&[(fast, 0.5 * along)]);
        let Some(angle) = angle else {
            return builder.build(Ending::Goal {
                side: back,
                speed: fast,
            });
        };
        builder.turn(back, &[(fast, angle.min(needed.max(0.1)) * radius)]);
        builder.build(Ending::Return { leg, speed: fast })
    }
}

/// Graph plan as an initial guess. It keeps the order of arcs and lines, adds the other speeds
/// beside each, and an empty turn back where it has only one turn. `path` holds the states after
/// the root.
pub(crate) fn from_graph(problem: &Problem, path: &[&State]) -> Option<InitialGuess> {
    let (last, before) = path.split_last()?;
    let (departure, vertices) = before.split_first()?;
    let speeds = ManoeuvreSpeeds::at(problem, departure.time);
    if vertices.is_empty() {
        return None;
    }
    let mut builder = InitialGuessBuilder::default();
    let along: f64 = departure.motion.iter().map(Segment::length).sum();
    builder.runs(&speeds, along, 0.0, 0.0);
    let mut side = None;
    let mut turns = 0;
    for vertex in vertices {
        let turn = vertex.motion.iter().find(|s| s.is_arc());
        let line = vertex.motion.iter().find(|s| !s.is_arc());
        let before = side;
        side = turn.and_then(|s| Side::of_turn(s.turn_rate)).or(side);
        let side = side.unwrap_or(Side::Starboard);
        turns += usize::from(before != Some(side));
        group(&mut builder, &speeds, side, turn, line, vertices.len());
        if vertices.len() == 1 {
            builder.turn(side, &[(speeds.fast, 0.0)]);
            builder.line(&[(speeds.fast, 0.0)]);
        }
    }
    let back = side.unwrap_or(Side::Starboard).opposite();
    if turns < 2 && vertices.len() < 3 {
        group(&mut builder, &speeds, back, None, None, vertices.len());
    }
    match last.ending {
        Ending::Return { leg, .. } => {
            let first = last.motion.first().filter(|s| s.is_arc());
            let side = first
                .and_then(|s| Side::of_turn(s.turn_rate))
                .unwrap_or(back);
            let length = first.map_or(0.0, Segment::length);
            let speed = speeds.fast;
            builder.turn(side, &[(speed, length)]);
            builder.build(Ending::Return { leg, speed })
        }
        Ending::Goal { side, speed } => builder.build(Ending::Goal { side, speed }),
        Ending::Follow => None,
    }
}

/// Turn and line, with fewer speeds where there are many such groups.
fn group(
    builder: &mut InitialGuessBuilder,
    speeds: &ManoeuvreSpeeds,
    side: Side,
    turn: Option<&Segment>,
    line: Option<&Segment>,
    groups: usize,
) {
    let ManoeuvreSpeeds {
        slow, normal, fast, ..
    } = *speeds;
    let own = turn.or(line).map_or(fast, |s| s.speed);
    let (turns, lines): (&[f64], &[f64]) = match groups {
        0..=3 => (&[slow, fast], &[slow, normal, fast]),
        // limits the number of variables
        4 => (&[own], &[slow, normal, fast]),
        _ => (&[own], &[slow, fast]),
    };
    let turns = shared(turn, turns);
    builder.turn(side, &turns);
    let lines = shared(line, lines);
    builder.line(&lines);
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
