//! Where a manoeuvre comes closest to an obstacle: the local minima of the slack in time.

use super::hazard::Hazard;
use super::template::Sailed;
use crate::frame::{Vector, to_port, to_starboard};
use crate::obstacle::Slack;

/// Metres. Approaches closer than this become rows.
const NEAR_M: f64 = 60.0;

/// Radians. Longest arc that one chord stands for when a minimum is sought, to begin with and at the end.
pub(crate) const COARSE_CHORD_RAD: f64 = 0.15;
pub(crate) const FINE_CHORD_RAD: f64 = 0.05;

/// Cuts of one minimum at most.
const MAX_CUTS: usize = 30;

/// A local minimum of the slack along a manoeuvre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Approach {
    /// Index of the leg, and where on it.
    pub leg: usize,
    pub fraction: f64,
    /// Metres.
    pub slack: f64,
    /// Faces that attain it with their weights: mixed so, the slack's rate in time vanishes.
    pub faces: [(usize, f64); 2],
}

/// The local minima of a hazard's slack along a manoeuvre, below [`NEAR_M`]; arcs are cut into chords of `chord`
/// radians at most.
pub(crate) fn approaches(hazard: &Hazard, sailed: &Sailed, chord: f64) -> Vec<Approach> {
    let mut chords: Vec<Chord> = Vec::with_capacity(64);
    let mut found: Vec<Approach> = Vec::new();
    for (leg, l) in sailed.legs.iter().enumerate() {
        let segment = &l.segment;
        if segment.duration <= 0.0 {
            continue;
        }
        if hazard.clearance_bound(segment) > NEAR_M {
            local_minima(&mut chords, &mut found);
            continue;
        }
        let count = (segment.turn_rate.abs() * segment.duration / chord)
            .ceil()
            .max(1.0);
        let sample = |fraction: f64, position: Vector| {
            let time = segment.start_time + segment.duration * fraction;
            Sample {
                position,
                time,
                fraction,
                slack: hazard.body.slack(position, time),
            }
        };
        // each sample is the one before turned about the centre of the arc
        let turn = segment.turn_rate * segment.duration / count;
        let (sin, cos) = if segment.is_arc() {
            turn.sin_cos()
        } else {
            (0.0, 1.0)
        };
        let mut arm = to_starboard(l.ahead) * segment.radius();
        let mut from = sample(0.0, segment.start.position);
        for k in 1..=count as usize {
            let fraction = k as f64 / count;
            let position = if segment.is_arc() {
                let turned = arm * cos + to_port(arm) * sin;
                let moved = turned - arm;
                arm = turned;
                from.position + moved
            } else {
                from.position + l.ahead * segment.length()
            };
            let to = sample(fraction, position);
            let mut piece = Chord::new(hazard, leg, &from, &to);
            if count > 1.0 && piece.least.faces[1].1 != 0.0 {
                let at = sample(piece.least.fraction, l.along(piece.least.fraction).0);
                piece.least.slack = at.slack.value;
            }
            chords.push(piece);
            from = to;
        }
    }
    local_minima(&mut chords, &mut found);
    found
}

/// Moves the local minima of a run of chords to `found`.
fn local_minima(chords: &mut Vec<Chord>, found: &mut Vec<Approach>) {
    for i in 0..chords.len() {
        let here = &chords[i].least;
        let before = if i > 0 {
            chords[i - 1].least.slack
        } else {
            f64::INFINITY
        };
        let after = chords.get(i + 1).map_or(f64::INFINITY, |c| c.least.slack);
        if !(here.slack < before && here.slack <= after && here.slack < NEAR_M) {
            continue;
        }
        let mut approach = *here;
        // at a joint the two sides share the instant: its faces are one falling, one rising
        if let Some(next) = chords.get(i + 1)
            && next.least.slack - here.slack < 1e-9
            && here.faces[1].1 == 0.0
            && chords[i].end_rate < 0.0
            && next.start_rate > 0.0
        {
            let weight = next.start_rate / (next.start_rate - chords[i].end_rate);
            approach.faces = [
                (here.faces[0].0, weight),
                (next.least.faces[0].0, 1.0 - weight),
            ];
        }
        found.push(approach);
    }
    chords.clear();
}

/// An instant of a segment with its slack.
#[derive(Debug, Clone, Copy)]
struct Sample {
    position: Vector,
    time: f64,
    fraction: f64,
    slack: Slack,
}

/// A straight piece between two samples, with the least slack on it. Along it the slack is a convex,
/// piecewise linear function, so tangents of a falling and a rising face are intersected until they meet.
#[derive(Debug, Clone, Copy)]
struct Chord {
    least: Approach,
    /// m/s of the slack at the start and at the end.
    start_rate: f64,
    end_rate: f64,
}

impl Chord {
    fn new(hazard: &Hazard, leg: usize, from: &Sample, to: &Sample) -> Self {
        let faces = hazard.body.faces();
        let width = (to.time - from.time).max(1e-12);
        let velocity = (to.position - from.position) / width;
        let rate = |face: usize| faces[face].normal.dot(&velocity) - faces[face].velocity_support;
        let (start_rate, end_rate) = (rate(from.slack.face), rate(to.slack.face));
        let approach = |fraction, slack, faces| Approach {
            leg,
            fraction,
            slack,
            faces,
        };
        let end = |s: &Sample| {
            approach(
                s.fraction,
                s.slack.value,
                [(s.slack.face, 1.0), (s.slack.face, 0.0)],
            )
        };
        let least = if start_rate >= 0.0 {
            end(from)
        } else if end_rate <= 0.0 {
            end(to)
        } else {
            let (mut a, mut b) = ((0.0, from.slack), (width, to.slack));
            let mut best = (0.0, from.slack.value, [(a.1.face, 1.0), (b.1.face, 0.0)]);
            for _ in 0..MAX_CUTS {
                let (fall, rise) = (rate(a.1.face), rate(b.1.face));
                let s = (a.0 + (b.1.value - a.1.value - rise * (b.0 - a.0)) / (fall - rise))
                    .clamp(a.0, b.0);
                let g = hazard
                    .body
                    .slack(from.position + velocity * s, from.time + s);
                let weight = rise / (rise - fall);
                best = (s, g.value, [(a.1.face, weight), (b.1.face, 1.0 - weight)]);
                if g.face == a.1.face || g.face == b.1.face || !(s > a.0 && s < b.0) {
                    break;
                }
                if rate(g.face) < 0.0 {
                    a = (s, g)
                } else {
                    b = (s, g)
                }
            }
            let fraction = from.fraction + (to.fraction - from.fraction) * best.0 / width;
            approach(fraction, best.1, best.2)
        };
        Self {
            least,
            start_rate,
            end_rate,
        }
    }
}
