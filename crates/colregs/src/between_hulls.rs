//! Distance of two hulls.

use searoom_geometry::frame::{Vector, to_port};
use searoom_model::vessel::Hull;

/// Two hulls, by the Minkowski sum of both about the offset of their centres, which is the intersection of
/// four strips. In closed form and exact but for rounding; a NaN stays one.
#[derive(Debug, Clone, Copy)]
pub struct BetweenHulls {
    offset: Vector,
    /// Half of own length and beam and of the target's, each with its axis.
    halves: [(Vector, f64); 4],
}

impl BetweenHulls {
    /// From the offset of the target's centre from own, metres, and from both hulls with the unit vectors
    /// ahead of them.
    pub fn new(offset: Vector, own: (&Hull, Vector), target: (&Hull, Vector)) -> Self {
        let axes = |(hull, ahead): (&Hull, Vector)| {
            let (long, wide) = (0.5 * hull.length, 0.5 * hull.beam);
            [(ahead, long), (to_port(ahead), wide)]
        };
        let ([a1, a2], [b1, b2]) = (axes(own), axes(target));
        Self {
            offset,
            halves: [a1, a2, b1, b2],
        }
    }

    /// Half-width of the sum along a normal.
    fn half(&self, normal: &Vector) -> f64 {
        self.halves
            .iter()
            .map(|(axis, half)| half * normal.dot(axis).abs())
            .sum()
    }

    /// Metres between the hulls, negative in overlap.
    pub fn distance(&self) -> f64 {
        let beyond = self
            .halves
            .iter()
            .map(|(n, _)| n.dot(&self.offset).abs() - self.half(n));
        let most = beyond.fold(f64::NEG_INFINITY, |most, next| {
            // negated on purpose: a NaN is taken over and stays
            if next <= most || most.is_nan() {
                most
            } else {
                next
            }
        });
        if !(most > 0.0) {
            return most;
        }
        // the nearest points are a corner of one hull and a point of the other
        let [a, b] = [&self.halves[..2], &self.halves[2..]];
        let corners = |of: &[(Vector, f64)]| {
            let (ahead, aside) = (of[0].0 * of[0].1, of[1].0 * of[1].1);
            [ahead + aside, ahead - aside, aside - ahead, -ahead - aside]
        };
        let away = |of: &[(Vector, f64)], point: Vector| {
            let beyond = |(axis, half): &(Vector, f64)| (axis.dot(&point).abs() - half).max(0.0);
            Vector::new(beyond(&of[0]), beyond(&of[1]))
        };
        let theirs = corners(b).map(|corner| away(a, self.offset + corner));
        let ours = corners(a).map(|corner| away(b, corner - self.offset));
        let ways = theirs.into_iter().chain(ours);
        let squares = ways.map(|way| way.norm_squared());
        squares.fold(f64::INFINITY, f64::min).sqrt()
    }

    /// Seconds until the hulls meet when the target's centre holds and own moves at a velocity, m/s;
    /// infinite if they never do.
    pub fn seconds_to(&self, velocity: Vector) -> f64 {
        let (mut from, mut until) = (0.0_f64, f64::INFINITY);
        for (axis, _) in &self.halves {
            for normal in [*axis, -axis] {
                let rate = normal.dot(&velocity);
                let room = normal.dot(&self.offset) + self.half(axis);
                if rate > 0.0 {
                    until = until.min(room / rate);
                } else if rate < 0.0 {
                    from = from.max(room / rate);
                } else if room < 0.0 {
                    return f64::INFINITY;
                }
            }
        }
        if from > until { f64::INFINITY } else { from }
    }
}
