//! Where the nominal motion meets a set, and how far aside own ship has to go.

use crate::space_time::manoeuvre::motion::{pose_at, sailed_between};
use crate::space_time::proxy::Proxy;
use searoom_geometry::frame::{Side, to_port};
use searoom_model::trajectory::Segment;

/// Samples of a conflict's width.
const CONFLICT_SAMPLES: usize = 24;

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
}

impl Conflict {
    /// Offset to a side, metres.
    pub(crate) fn offset(&self, side: Side) -> f64 {
        self.offsets[usize::from(side == Side::Port)]
    }

    /// Ratio of the distance sailed inside to the smaller offset.
    pub(crate) fn slenderness(&self) -> f64 {
        let [starboard, port] = self.offsets;
        self.through / starboard.min(port).max(1.0)
    }

    /// Conflict of an instant, without a width.
    pub(crate) fn at(time: f64) -> Self {
        Self {
            from: time,
            to: time,
            through: 0.0,
            offsets: [0.0; 2],
        }
    }

    /// Contact of one obstacle, given by its proxies, with the nominal motion, from its first to
    /// its last instant.
    pub(crate) fn of(proxies: &[Proxy], nominal_motion: &[Segment]) -> Option<Self> {
        let from = proxies
            .iter()
            .filter_map(|h| nominal_motion.iter().find_map(|s| h.first_contact(s)))
            .min_by(f64::total_cmp)?;
        let end = nominal_motion.last()?.end_time();
        let mut conflict = Self::at(from);
        for k in 0..=CONFLICT_SAMPLES {
            let time = from + (end - from) * k as f64 / CONFLICT_SAMPLES as f64;
            let pose = pose_at(nominal_motion, time)?;
            let inside = |h: &&Proxy| {
                h.slack(pose.position, time)
                    .is_some_and(|slack| !(slack > 0.0))
            };
            let Some(proxy) = proxies.iter().find(inside) else {
                continue;
            };
            conflict.to = time;
            for (side, offset) in Side::BOTH.into_iter().zip(&mut conflict.offsets) {
                let beam = to_port(pose.ahead()) * side.turn_sign();
                *offset = offset.max(proxy.exit_distance(pose.position, time, beam));
            }
        }
        conflict.through = sailed_between(nominal_motion, conflict.from, conflict.to);
        Some(conflict)
    }
}

/// Number of conflicts, ordered by start, that begin more than `apart_s` seconds apart; those that begin together
/// are one. At least 1.
pub(crate) fn far_apart(conflicts: &[Conflict], apart_s: f64) -> usize {
    let mut first = f64::NEG_INFINITY;
    let begin = conflicts.iter().map(|conflict| conflict.from);
    let apart = begin.filter(|from| {
        let is_apart = *from > first + apart_s;
        if is_apart {
            first = *from;
        }
        is_apart
    });
    apart.count().max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conflicts_that_begin_together_are_one() {
        for (begin, expected) in [
            (&[][..], 1),
            (&[50.0], 1),
            (&[0.0, 120.0], 1),
            (&[0.0, 121.0], 2),
            // the third is far from the first, not from the second
            (&[0.0, 100.0, 200.0], 2),
            (&[0.0, 200.0, 300.0, 400.0], 3),
            (&[f64::NAN], 1),
        ] {
            let conflicts: Vec<Conflict> = begin.iter().map(|t| Conflict::at(*t)).collect();
            assert_eq!(far_apart(&conflicts, 120.0), expected, "{begin:?}");
        }
    }
}
