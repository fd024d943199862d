//! What a motion does to hulls, to choose between motions none of which is clear of every set.

use std::cmp::Ordering;

use crate::frame::Pose;
use crate::planner::space_time::piece::Piece;
use crate::planner::space_time::proxy::Proxy;
use crate::trajectory::Segment;
use crate::vessel::{Hull, OwnShip};

/// Depths are told apart to this fraction of own ship's length, and times to this fraction of themselves.
const DEPTH_STEP: f64 = 0.05;
const TIME_STEP: f64 = 0.1;

/// Metres. Depths are told apart to no less: own ship may have no size.
pub(crate) const LEAST_STEP_M: f64 = 0.1;

/// Looks along a way out for its depth in the sets.
const LOOKS: u32 = 200;

/// Between two looks for hulls ships come closer by this fraction of own beam; twice as much after each [`MANY`].
const LOOK_BEAMS: f64 = 0.25;
const MANY: u32 = 1000;

/// The harm of a way out of sets. The less in this order: the depth in nominal hulls, the depth in the sets, the time in them, the
/// speed, the turn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Harm {
    /// In steps: 0 where no nominal hull is met.
    hulls: f64,
    /// In steps, beyond the depth at the start.
    sets: f64,
    /// In steps, as a logarithm.
    time: f64,
    /// m/s.
    speed: f64,
    /// Radians.
    turn: f64,
}

impl Harm {
    /// Of a motion that is out of the sets at a time; `depth` is that in the sets, in metres.
    pub(crate) fn of(
        own: &OwnShip,
        watch: &Watch,
        motion: &[Segment],
        out: f64,
        depth: impl Fn(&Pose, f64) -> f64,
    ) -> Self {
        let step = (DEPTH_STEP * own.hull.length).max(LEAST_STEP_M);
        let steps = |metres: f64| (metres / step).ceil();
        let start = depth(&own.pose, 0.0);
        let mut deepest = start;
        for look in 1..LOOKS {
            let time = out * f64::from(look) / f64::from(LOOKS);
            if let Some(s) = motion.iter().find(|s| time <= s.end_time()) {
                deepest = deepest.max(depth(&s.pose_at(time), time));
            }
        }
        let first = &motion[0];
        Self {
            hulls: steps(watch.depth(own, motion, out)),
            sets: ((deepest - start) / step).floor(),
            time: (out.ln() / (1.0 + TIME_STEP).ln()).floor(),
            speed: first.speed,
            turn: first.turn_rate.abs() * first.duration,
        }
    }

    /// True where no nominal hull is met.
    pub(crate) fn is_clear(&self) -> bool {
        self.hulls == 0.0
    }

    pub(crate) fn total_cmp(&self, other: &Self) -> Ordering {
        let key = |h: &Self| [h.hulls, h.sets, h.time, h.speed, h.turn];
        let both = key(self).into_iter().zip(key(other));
        both.map(|(a, b)| a.total_cmp(&b))
            .find(|order| order.is_ne())
            .unwrap_or(Ordering::Equal)
    }
}

/// The hulls of targets on their nominal tracks.
pub(crate) struct Watch<'a> {
    hulls: Vec<(Proxy<'a>, Hull)>,
}

impl<'a> Watch<'a> {
    /// From the parts of the hulls, and own hull toward each.
    pub(crate) fn new(pieces: &'a [Piece], own: &[Hull]) -> Self {
        let hulls = pieces
            .iter()
            .map(|part| (Proxy::new(part), own[part.obstacle]));
        Self {
            hulls: hulls.collect(),
        }
    }

    /// How deep own hull gets in one of them until a time, metres; 0 where it meets none. By looks that are as far apart as ships
    /// can come closer.
    pub(crate) fn depth(&self, own: &OwnShip, motion: &[Segment], until: f64) -> f64 {
        let until = until.min(motion.last().map_or(0.0, Segment::end_time));
        let mut deepest: f64 = 0.0;
        for (proxy, hull) in &self.hulls {
            let mut least = LOOK_BEAMS * own.hull.beam.max(LEAST_STEP_M);
            let (mut time, mut at, mut looks): (f64, _, u32) = (0.0, 0, 0);
            while let Some(segment) = motion.get(at) {
                if segment.end_time() < time {
                    at += 1;
                    continue;
                }
                looks += 1;
                if looks.is_multiple_of(MANY) {
                    least *= 2.0;
                }
                let turning = segment.turn_rate.abs() * hull.half_diagonal();
                let closing = segment.speed + turning + proxy.speed();
                let apart = proxy
                    .clearance_of(hull, &segment.pose_at(time), time)
                    .unwrap_or(f64::INFINITY);
                deepest = deepest.max(-apart);
                let next = time + (apart + deepest).max(least) / closing;
                // what follows may be faster
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
        deepest
    }
}
