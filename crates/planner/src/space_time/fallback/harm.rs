//! Harm of a motion to hulls: an order on motions none of which is clear of every set.

use std::cmp::Ordering;

use crate::clock::Clock;
use crate::space_time::piece::Piece;
use crate::space_time::proxy::Proxy;
use searoom_geometry::frame::Pose;
use searoom_model::trajectory::Segment;
use searoom_model::vessel::{Hull, OwnShip};

/// Resolution of depths as a fraction of own ship's length, and of times as a fraction of
/// themselves.
const DEPTH_STEP: f64 = 0.05;
const TIME_STEP: f64 = 0.1;

/// Least resolution of depths, metres: own ship may have zero size.
const LEAST_STEP_M: f64 = 0.1;

/// Least and largest number of samples along a motion for its depth in the sets. Between them, one
/// a second.
const LEAST_SAMPLES: f64 = 200.0;
const MOST_SAMPLES: f64 = 2000.0;

/// Resolution of the speed of an impact, m/s.
const IMPACT_STEP_MPS: f64 = 0.5;

/// Largest approach of two ships between two samples, as a fraction of own beam. It doubles after
/// each [`MANY`] samples, and after each [`MANY_WHEN_LATE`] once the time is up.
const SAMPLE_BEAMS: f64 = 0.25;
const MANY: u32 = 1000;
const MANY_WHEN_LATE: u32 = 50;

/// Resolution of depths and distances, metres.
pub(crate) fn depth_step(own: &OwnShip) -> f64 {
    (DEPTH_STEP * own.hull.length).max(LEAST_STEP_M)
}

/// Logarithm of a ratio of times, in steps.
fn time_steps(ratio: f64) -> f64 {
    ratio.ln() / (1.0 + TIME_STEP).ln()
}

/// Harm of an exit from sets, or of a whole motion. Compared in this order: depth in nominal hulls,
/// depth in the sets, speed of the impact, delay, speed, time in the sets, turn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Harm {
    /// Depth in nominal hulls, in steps; 0 where none is met.
    hulls: f64,
    /// Depth in the sets beyond that at the start, in steps.
    sets: f64,
    /// Relative speed where the depth in nominal hulls is largest, in steps; 0 where none is met.
    impact: f64,
    /// Logarithm of the delay, in steps; 0 for an exit that is about as soon as the soonest.
    delay: f64,
    /// Logarithm of the time in the sets, in steps.
    time: f64,
    /// m/s.
    speed: f64,
    /// Radians.
    turn: f64,
}

impl Harm {
    /// Harm of a motion until `out`; `depth` is its depth in the sets, metres.
    pub(crate) fn of(
        own: &OwnShip,
        nominal_hulls: &NominalHulls,
        motion: &[Segment],
        out: f64,
        depth: impl Fn(&Pose, f64) -> f64,
    ) -> Self {
        let step = depth_step(own);
        let steps = |metres: f64| (metres / step).ceil();
        let start = depth(&own.pose, 0.0);
        let mut deepest = start;
        let samples = out.clamp(LEAST_SAMPLES, MOST_SAMPLES) as u32;
        for sample in 1..samples {
            let time = out * f64::from(sample) / f64::from(samples);
            if let Some(s) = motion.iter().find(|s| time <= s.end_time()) {
                deepest = deepest.max(depth(&s.pose_at(time), time));
            }
        }
        let first = &motion[0];
        let nearest = nominal_hulls.nearest(own, motion, out, 0.0);
        Self {
            hulls: steps(0.0 - nearest.apart),
            sets: ((deepest - start) / step).floor(),
            impact: (nearest.closing / IMPACT_STEP_MPS).ceil(),
            delay: 0.0,
            time: time_steps(out).floor(),
            speed: first.speed,
            turn: first.turn_rate.abs() * first.duration,
        }
    }

    /// Compares what is met alone: the depths in nominal hulls and in the sets, and the impact.
    pub(crate) fn depth_cmp(&self, other: &Self) -> Ordering {
        let key = |h: &Self| [h.hulls, h.sets, h.impact];
        lexical(&key(self), &key(other))
    }

    /// Counts the delay against the soonest exit, which leaves the sets at `soonest`. This one is
    /// about as soon where it takes at most a step longer, or at most the time in which own ship
    /// sails its length: own hull needs as long to cross the edge of a set.
    pub(crate) fn with_delay(self, own: &OwnShip, out: f64, soonest: f64) -> Self {
        let length = own.hull.length / own.max_speed();
        let soon = (soonest * (1.0 + TIME_STEP)).max(soonest + length);
        Self {
            delay: time_steps(out / soon).ceil().max(0.0),
            ..self
        }
    }

    /// True where the exit is about as soon as the soonest.
    pub(crate) fn is_soon(&self) -> bool {
        self.delay == 0.0
    }

    /// True where no nominal hull is met.
    pub(crate) fn is_clear(&self) -> bool {
        self.hulls == 0.0
    }

    pub(crate) fn total_cmp(&self, other: &Self) -> Ordering {
        let key = |h: &Self| [h.delay, h.speed, h.time, h.turn];
        self.depth_cmp(other)
            .then_with(|| lexical(&key(self), &key(other)))
    }
}

fn lexical(a: &[f64], b: &[f64]) -> Ordering {
    let mut orders = a.iter().zip(b).map(|(a, b)| a.total_cmp(b));
    let first = orders.find(|order| order.is_ne());
    first.unwrap_or(Ordering::Equal)
}

/// Where a motion is nearest to the hulls of targets.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearest {
    /// Distance between the hulls, metres; negative in overlap.
    pub apart: f64,
    /// Relative speed there, m/s; 0 where no hull comes nearer than asked.
    closing: f64,
}

/// Hulls of the targets on their nominal tracks.
pub(crate) struct NominalHulls<'a> {
    hulls: Vec<(Proxy<'a>, Hull)>,
    clock: Clock,
}

impl<'a> NominalHulls<'a> {
    /// Builds the set from the convex pieces of the hulls, with own hull toward each.
    pub(crate) fn new(pieces: &'a [Piece], own: &[Hull], clock: Clock) -> Self {
        let hulls = pieces
            .iter()
            .map(|part| (Proxy::new(part), own[part.obstacle]));
        Self {
            hulls: hulls.collect(),
            clock,
        }
    }

    /// Largest depth of own hull in one of them until a time, metres; 0 where it meets none.
    pub(crate) fn depth(&self, own: &OwnShip, motion: &[Segment], until: f64) -> f64 {
        0.0 - self.nearest(own, motion, until, 0.0).apart
    }

    /// Where own hull is nearest to them until a time; at most `enough` metres. The sampling
    /// interval follows from the largest closing speed.
    pub(crate) fn nearest(
        &self,
        own: &OwnShip,
        motion: &[Segment],
        until: f64,
        enough: f64,
    ) -> Nearest {
        let until = until.min(motion.last().map_or(0.0, Segment::end_time));
        let many = match self.clock.is_up() {
            true => MANY_WHEN_LATE,
            false => MANY,
        };
        let mut nearest = Nearest {
            apart: enough,
            closing: 0.0,
        };
        for (proxy, hull) in &self.hulls {
            let mut least = SAMPLE_BEAMS * own.hull.beam.max(LEAST_STEP_M);
            let (mut time, mut at, mut samples): (f64, _, u32) = (0.0, 0, 0);
            while let Some(segment) = motion.get(at) {
                // its closing speed is not that of the next one, which may begin at rest
                if segment.end_time() <= time && at + 1 < motion.len() {
                    at += 1;
                    continue;
                }
                samples += 1;
                if samples.is_multiple_of(many) {
                    least *= 2.0;
                }
                let turning = segment.turn_rate.abs() * hull.half_diagonal();
                let closing = segment.speed + turning + proxy.speed();
                let apart = proxy
                    .clearance_of(hull, &segment.pose_at(time), time)
                    .unwrap_or(f64::INFINITY);
                if apart < nearest.apart {
                    let relative = segment.velocity_at(time) - proxy.drift();
                    nearest = Nearest {
                        apart,
                        closing: relative.norm(),
                    };
                }
                let next = time + (apart - nearest.apart).max(least) / closing;
                // the next segment may be faster
                time = if next > segment.end_time() && time < segment.end_time() {
                    segment.end_time()
                } else {
                    next
                };
                if !(time <= until) {
                    break;
                }
            }
        }
        nearest
    }
}
