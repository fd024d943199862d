//! Closest approaches of a manoeuvre to convex pieces: local minima of the slack in time.

use crate::space_time::proxy::Proxy;
use crate::space_time::refinement::rollout::{Leg, Rollout};
use searoom_geometry::frame::{Vector, to_port, to_starboard};
use searoom_geometry::tolerance;
use searoom_sets::contact::Interval;
use searoom_sets::{EllipsoidObstacle, PolytopeObstacle, SpaceTimeObstacle};

/// Metres. Approaches closer than this become rows.
pub(crate) const NEAR_M: f64 = 40.0;

/// Metres. Joints of segments closer than this become rows too. A segment that slides along a face
/// touches it at both ends, and only one of the two is a minimum.
const SLIDING_M: f64 = 20.0;

/// Seconds within which a joint coincides with the minimum beside it.
const SAME_S: f64 = 0.2;

/// Largest number of cuts for one minimum.
const MAX_CUTS: usize = 30;

/// Accuracy of a smooth minimum, metres.
const SETTLED_M: f64 = 1e-7;

/// Local minimum of the slack along a manoeuvre.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Approach {
    /// Index of the segment, and the fraction along it.
    pub leg: usize,
    pub fraction: f64,
    /// Slack, metres.
    pub slack: f64,
    /// Rates of the slack per metre east, metre north and second. They belong to the face that
    /// attains it, or to a mixture of two for which the slack's rate along the manoeuvre vanishes.
    pub rates: [f64; 3],
}

/// Set to which the slack is measured. Along a line the slack is convex in time.
trait Shape {
    /// Face, or other element, that attains the slack.
    type Face: Copy;

    /// Slack in metres and the face that attains it; `near` is a face that attains it nearby.
    fn slack(&self, position: Vector, time: f64, near: Option<Self::Face>) -> Slack<Self::Face>;

    /// Outward normal of a face, and its speed along the normal, m/s.
    fn plane(&self, face: Self::Face) -> (Vector, f64);

    /// True when no lower minimum lies between. `gap` is how far below `found` the neighbours'
    /// tangents meet, metres.
    fn is_settled(found: Self::Face, neighbours: [Self::Face; 2], gap: f64) -> bool;
}

/// Signed distance or a lower bound of it.
#[derive(Debug, Clone, Copy)]
struct Slack<F> {
    value: f64,
    face: F,
}

impl Shape for PolytopeObstacle {
    type Face = usize;

    fn slack(&self, position: Vector, time: f64, near: Option<usize>) -> Slack<usize> {
        let slack = match near {
            Some(face) => self.slack_near(position, time, face),
            None => self.slack(position, time),
        };
        Slack {
            value: slack.value,
            face: slack.face,
        }
    }

    fn plane(&self, face: usize) -> (Vector, f64) {
        let face = &self.faces()[face];
        (face.normal, face.velocity_support)
    }

    fn is_settled(found: usize, neighbours: [usize; 2], _: f64) -> bool {
        neighbours.contains(&found)
    }
}

impl Shape for EllipsoidObstacle {
    type Face = (Vector, f64);

    fn slack(&self, position: Vector, time: f64, _: Option<Self::Face>) -> Slack<Self::Face> {
        let found = self.signed_distance(position, time);
        Slack {
            value: found.distance,
            face: (found.normal, self.support(found.normal, time).rate),
        }
    }

    fn plane(&self, face: (Vector, f64)) -> (Vector, f64) {
        face
    }

    fn is_settled(_: (Vector, f64), _: [(Vector, f64); 2], gap: f64) -> bool {
        // negated on purpose: a NaN ends the search
        !(gap > SETTLED_M)
    }
}

/// Adds the local minima of a proxy's slack along a manoeuvre, below [`NEAR_M`], and joints below
/// [`SLIDING_M`]. Arcs are divided into chords of at most `chord` radians. `middles` are the
/// midpoints of [`Rollout::middles`].
pub(crate) fn add_approaches(
    proxy: &Proxy,
    rollout: &Rollout,
    middles: &[Vector],
    chord: f64,
    found: &mut Vec<Approach>,
) {
    match proxy.ellipsoid {
        Some(ellipsoid) => add_of(ellipsoid, proxy, rollout, (middles, chord), found),
        None => add_of(proxy.body, proxy, rollout, (middles, chord), found),
    }
}

fn add_of<S: Shape>(
    shape: &S,
    proxy: &Proxy,
    rollout: &Rollout,
    (middles, chord): (&[Vector], f64),
    found: &mut Vec<Approach>,
) {
    let already = found.len();
    let mut minima = Minima::new(shape, proxy, rollout, found);
    let mut joints: Vec<Approach> = Vec::new();
    let clock = proxy.start();
    // a segment begins where the one before ended
    let mut near = None;
    for (leg, (l, middle)) in rollout.legs.iter().zip(middles).enumerate() {
        let segment = &l.segment;
        if segment.duration <= 0.0 {
            continue;
        }
        if proxy.clearance_bound_about(segment, *middle) > NEAR_M {
            minima.end_run();
            continue;
        }
        let Span { first, last } = Span::of(l, proxy.window);
        let count = (segment.turn_rate.abs() * segment.duration * (last - first) / chord)
            .ceil()
            .max(1.0);
        let sample = |fraction: f64, position: Vector, near: Option<S::Face>| {
            let time = segment.start_time + segment.duration * fraction - clock;
            Sample {
                position,
                time,
                fraction,
                slack: shape.slack(position, time, near),
            }
        };
        // each sample is the one before, rotated about the centre of the arc
        let turn = segment.turn_rate * segment.duration * (last - first) / count;
        let (sin, cos) = if segment.is_arc() {
            turn.sin_cos()
        } else {
            (0.0, 1.0)
        };
        let (start, ahead) = if first > 0.0 {
            l.along(first)
        } else {
            (segment.start.position, l.ahead)
        };
        let mut arm = to_starboard(ahead) * segment.radius();
        let mut from = sample(first, start, near);
        if first == 0.0 && from.slack.value < SLIDING_M {
            joints.push(joint(shape, leg, &from));
        }
        let closing = (segment.speed + proxy.speed()) * segment.duration * (last - first) / count;
        let mut k = 0.0;
        loop {
            // a distant sample stays distant for the time that closing takes
            let far = ((from.slack.value - NEAR_M) / closing).floor();
            if far >= 1.0 {
                minima.end_run();
                k += far;
                if k >= count {
                    break;
                }
                let fraction = first + (last - first) * (k / count);
                let (position, ahead) = l.along(fraction);
                arm = to_starboard(ahead) * segment.radius();
                from = sample(fraction, position, Some(from.slack.face));
                continue;
            }
            if k >= count {
                break;
            }
            k += 1.0;
            let fraction = first + (last - first) * (k / count);
            let position = if segment.is_arc() {
                let turned = arm * cos + to_port(arm) * sin;
                let moved = turned - arm;
                arm = turned;
                from.position + moved
            } else {
                from.position + l.ahead * (segment.length() * (last - first))
            };
            let to = sample(fraction, position, Some(from.slack.face));
            let mut piece = Chord::new(shape, leg, &from, &to);
            if segment.is_arc() && piece.least.is_mixed() {
                piece.move_onto_arc(shape, l, [&from, &to]);
                let place = l.along(piece.least.fraction).0;
                let at = sample(piece.least.fraction, place, Some(to.slack.face));
                piece.least.slack = at.slack.value;
            }
            minima.push(piece);
            from = to;
        }
        near = Some(from.slack.face);
    }
    minima.end_run();
    let time = |a: &Approach| {
        let s = &rollout.legs[a.leg].segment;
        s.start_time + s.duration * a.fraction
    };
    let end = found.len();
    for joint in joints {
        let is_apart = |f: &Approach| (time(f) - time(&joint)).abs() > SAME_S;
        if found[already..end].iter().all(is_apart) {
            found.push(joint);
        }
    }
}

/// Start of a segment. Its position on the segment is fixed, so any face that attains the slack
/// gives its rates.
fn joint<S: Shape>(shape: &S, leg: usize, at: &Sample<S::Face>) -> Approach {
    let (normal, speed) = shape.plane(at.slack.face);
    Approach {
        leg,
        fraction: at.fraction,
        slack: at.slack.value,
        rates: [normal.x, normal.y, -speed],
    }
}

/// Part of a segment within the time window of a convex piece, as fractions.
#[derive(Debug, Clone, Copy)]
struct Span {
    first: f64,
    last: f64,
}

impl Span {
    fn of(leg: &Leg, window: Option<Interval>) -> Self {
        let whole = Self {
            first: 0.0,
            last: 1.0,
        };
        let Some(window) = window else {
            return whole;
        };
        let s = &leg.segment;
        let fraction = |time: f64| ((time - s.start_time) / s.duration).clamp(0.0, 1.0);
        let (first, last) = (fraction(window.start), fraction(window.end));
        Self {
            first,
            last: last.max(first),
        }
    }
}

/// Own ship's velocity at a minimum on the edge of a time window: there the instant is fixed,
/// not the fraction of the segment.
fn velocity_at_edge<F>(proxy: &Proxy, rollout: &Rollout, least: &Minimum<F>) -> Option<Vector> {
    let window = proxy.window?;
    let leg = &rollout.legs[least.leg];
    let time = leg.segment.start_time + leg.segment.duration * least.fraction;
    let near = |edge: f64| (time - edge).abs() <= tolerance::TIME_S;
    (near(window.start) || near(window.end))
        .then(|| leg.along(least.fraction).1 * leg.segment.speed)
}

/// Local minima of runs of chords, found while the chords are added.
struct Minima<'a, S: Shape> {
    shape: &'a S,
    proxy: &'a Proxy<'a>,
    rollout: &'a Rollout,
    /// Last chord of the run, and the least slack on the one before it.
    last: Option<Chord<S::Face>>,
    before: f64,
    found: &'a mut Vec<Approach>,
}

impl<'a, S: Shape> Minima<'a, S> {
    fn new(
        shape: &'a S,
        proxy: &'a Proxy<'a>,
        rollout: &'a Rollout,
        found: &'a mut Vec<Approach>,
    ) -> Self {
        Self {
            shape,
            proxy,
            rollout,
            last: None,
            before: f64::INFINITY,
            found,
        }
    }

    fn push(&mut self, chord: Chord<S::Face>) {
        let Some(last) = self.last.replace(chord) else {
            return;
        };
        let slack = last.least.slack;
        if slack < self.before && slack <= chord.least.slack {
            self.add(&last, Some(&chord));
        }
        self.before = slack;
    }

    /// Ends a run: the next chord does not continue it.
    fn end_run(&mut self) {
        if let Some(last) = self.last.take()
            && last.least.slack < self.before
        {
            self.add(&last, None);
        }
        self.before = f64::INFINITY;
    }

    fn add(&mut self, chord: &Chord<S::Face>, next: Option<&Chord<S::Face>>) {
        let here = &chord.least;
        if !(here.slack < NEAR_M) {
            return;
        }
        let mut faces = here.faces;
        // at a joint the two sides share the instant: one face with falling slack, one with rising
        // slack
        if let Some(next) = next
            && next.least.slack - here.slack < 1e-9
            && !here.is_mixed()
            && chord.end_rate < 0.0
            && next.start_rate > 0.0
        {
            let weight = next.start_rate / (next.start_rate - chord.end_rate);
            faces = [
                (here.faces[0].0, weight),
                (next.least.faces[0].0, 1.0 - weight),
            ];
        }
        let edge = velocity_at_edge(self.proxy, self.rollout, here);
        let mut rates = [0.0; 3];
        for (face, weight) in faces {
            let (normal, speed) = self.shape.plane(face);
            let clock = edge.map_or(speed, |velocity| normal.dot(&velocity));
            for (sum, rate) in rates.iter_mut().zip([normal.x, normal.y, -clock]) {
                *sum += weight * rate;
            }
        }
        self.found.push(Approach {
            leg: here.leg,
            fraction: here.fraction,
            slack: here.slack,
            rates,
        });
    }
}

/// Instant of a segment with its slack.
#[derive(Debug, Clone, Copy)]
struct Sample<F> {
    position: Vector,
    time: f64,
    fraction: f64,
    slack: Slack<F>,
}

/// Least slack on a chord.
#[derive(Debug, Clone, Copy)]
struct Minimum<F> {
    leg: usize,
    fraction: f64,
    slack: f64,
    /// Faces that attain it, with their weights.
    faces: [(F, f64); 2],
}

impl<F> Minimum<F> {
    fn is_mixed(&self) -> bool {
        self.faces[1].1 != 0.0
    }
}

/// Straight piece between two samples, with the least slack on it. Along it the slack is convex;
/// for a polytope it is piecewise linear. Tangents of a falling and a rising face are intersected
/// until they meet.
#[derive(Debug, Clone, Copy)]
struct Chord<F> {
    least: Minimum<F>,
    /// Rates of the slack at the start and at the end, m/s.
    start_rate: f64,
    end_rate: f64,
}

impl<F: Copy> Chord<F> {
    fn new<S: Shape<Face = F>>(shape: &S, leg: usize, from: &Sample<F>, to: &Sample<F>) -> Self {
        let width = (to.time - from.time).max(1e-12);
        let velocity = (to.position - from.position) / width;
        let rate = |face: F| {
            let (normal, speed) = shape.plane(face);
            normal.dot(&velocity) - speed
        };
        let (start_rate, end_rate) = (rate(from.slack.face), rate(to.slack.face));
        let end = |s: &Sample<F>| Minimum {
            leg,
            fraction: s.fraction,
            slack: s.slack.value,
            faces: [(s.slack.face, 1.0), (s.slack.face, 0.0)],
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
                let place = from.position + velocity * s;
                let g = shape.slack(place, from.time + s, Some(a.1.face));
                let weight = rise / (rise - fall);
                best = (s, g.value, [(a.1.face, weight), (b.1.face, 1.0 - weight)]);
                let gap = g.value - a.1.value - fall * (s - a.0);
                if S::is_settled(g.face, [a.1.face, b.1.face], gap) || !(s > a.0 && s < b.0) {
                    break;
                }
                if rate(g.face) < 0.0 {
                    a = (s, g)
                } else {
                    b = (s, g)
                }
            }
            Minimum {
                leg,
                fraction: from.fraction + (to.fraction - from.fraction) * best.0 / width,
                slack: best.1,
                faces: best.2,
            }
        };
        Self {
            least,
            start_rate,
            end_rate,
        }
    }

    /// Moves a mixed minimum of the chord to where its two faces meet on the arc, to first order, and weighs
    /// them for the velocity there, so that the slack's rate along the arc vanishes. Where one falls and the
    /// other rises on the chord alone, the weights stay.
    fn move_onto_arc<S: Shape<Face = F>>(&mut self, shape: &S, arc: &Leg, ends: [&Sample<F>; 2]) {
        let [from, to] = ends;
        let least = &mut self.least;
        let share = (least.fraction - from.fraction) / (to.fraction - from.fraction);
        let (place, ahead) = arc.along(least.fraction);
        let off = place - from.position.lerp(&to.position, share);
        let faces = least.faces.map(|(face, _)| shape.plane(face));
        let rates = |ahead: Vector| {
            let velocity = ahead * arc.segment.speed;
            faces.map(|(normal, speed)| normal.dot(&velocity) - speed)
        };
        let [fall, rise] = rates(ahead);
        if !(fall < 0.0 && rise > 0.0) {
            return;
        }
        let [falling, rising] = faces.map(|(normal, _)| normal.dot(&off));
        let later = (falling - rising) / (rise - fall) / arc.segment.duration;
        least.fraction = (least.fraction + later).clamp(from.fraction, to.fraction);
        let [fall, rise] = rates(arc.along(least.fraction).1);
        if fall < 0.0 && rise > 0.0 {
            let weight = rise / (rise - fall);
            [least.faces[0].1, least.faces[1].1] = [weight, 1.0 - weight];
        }
    }
}
