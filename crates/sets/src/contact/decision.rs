//! Whether a line or an arc in time meets a space-time polytope, without the time of contact.

use crate::PolytopeObstacle;
use crate::contact::{CHORD_RAD, line_contact};
use searoom_geometry::frame::{Vector, to_port};
use searoom_model::trajectory::{Mover, Segment};

/// True when the segment is at least `depth` metres inside the obstacle at some time.
///
/// Many times faster than `first_contact` on arcs. An arc is compared with its chords, which are
/// halved until they or a single face decide. A case still open at a sagitta below a hundredth of
/// the depth, or below a nanometre, is contact.
pub fn meets(obstacle: &PolytopeObstacle, segment: &Segment, depth: f64) -> bool {
    if !(segment.is_valid() && depth.is_finite()) {
        return true;
    }
    if !segment.is_arc() {
        return segment.end_time() >= 0.0 && line_contact(obstacle, segment, depth).is_some();
    }
    let count = (segment.turn_rate.abs() * segment.duration / CHORD_RAD)
        .ceil()
        .max(1.0);
    let duration = segment.duration / count;
    let mover = Mover::new(segment);
    let arc = Arc {
        obstacle,
        mover,
        radius: segment.radius().abs(),
        rate: segment.turn_rate,
        depth,
    };
    let mut from = segment.start.position;
    (0..count as usize).any(|k| {
        let start = segment.start_time + duration * k as f64;
        let to = mover.position_at(start + duration);
        let met = arc.meets(from, to, start, duration);
        from = to;
        met
    })
}

/// An arc and a depth, for [`meets`].
struct Arc<'a> {
    obstacle: &'a PolytopeObstacle,
    mover: Mover,
    radius: f64,
    rate: f64,
    depth: f64,
}

impl Arc<'_> {
    fn meets(&self, from: Vector, to: Vector, start: f64, duration: f64) -> bool {
        // at equal times the arc is within the sagitta of the chord
        let sagitta = self.radius * (self.rate * duration).powi(2) / 8.0;
        // there is no obstacle before t = 0
        let first = (-start / duration).max(0.0);
        if first > 1.0 {
            return false;
        }
        // parameter ranges of the chord that are possibly, and certainly, deep enough
        let (mut nearly, mut surely) = ((first, 1.0_f64), (first, 1.0_f64));
        let mut farthest = (f64::NEG_INFINITY, 0);
        for (index, face) in self.obstacle.faces().iter().enumerate() {
            let a = face.slack(from, start) + self.depth;
            let b = face.slack(to, start + duration) + self.depth;
            let outside = a.min(b);
            if outside > sagitta {
                return false;
            }
            if outside > farthest.0 {
                farthest = (outside, index);
            }
            if a.max(b) > -sagitta {
                narrow(&mut nearly, a - sagitta, b - sagitta);
                narrow(&mut surely, a + sagitta, b + sagitta);
                if nearly.0 > nearly.1 {
                    return false;
                }
            }
        }
        let doubt = (0.01 * self.depth).max(1e-9);
        if surely.0 <= surely.1 || sagitta < doubt {
            return true;
        }
        if farthest.0 > doubt && self.keeps_outside(farthest.1, start, duration) {
            return false;
        }
        let half = duration / 2.0;
        let middle = self.mover.position_at(start + half);
        self.meets(from, middle, start, half) || self.meets(middle, to, start + half, half)
    }

    /// True when the distance from a face is smallest at an end of the arc.
    ///
    /// Over less than half a turn the derivative of the distance has at most one extremum. So it
    /// changes its sign once when the derivatives at the ends differ in sign. It does not change it
    /// when they agree and the extremum lies beyond an end.
    fn keeps_outside(&self, face: usize, start: f64, duration: f64) -> bool {
        let face = &self.obstacle.faces()[face];
        let velocities = [start, start + duration].map(|t| self.mover.velocity_at(t));
        let [before, after] = velocities.map(|v| face.normal.dot(&v) - face.velocity_support);
        let [bent_before, bent_after] =
            velocities.map(|v| self.rate * face.normal.dot(&to_port(v)));
        if before >= 0.0 {
            after <= 0.0 || bent_before >= 0.0 || bent_after <= 0.0
        } else {
            after <= 0.0 && (bent_before <= 0.0 || bent_after >= 0.0)
        }
    }
}

/// Narrows a parameter range of a chord to where a linear function, given at both ends, is not
/// positive.
fn narrow(shares: &mut (f64, f64), at_start: f64, at_end: f64) {
    if at_start > 0.0 {
        // both positive: nothing is left
        let share = if at_end > 0.0 {
            f64::INFINITY
        } else {
            at_start / (at_start - at_end)
        };
        shares.0 = shares.0.max(share);
    } else if at_end > 0.0 {
        shares.1 = shares.1.min(at_start / (at_start - at_end));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::first_contact;
    use crate::geometry_fixtures::{random_polygon, random_vector};
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use searoom_geometry::frame::Pose;

    /// Least signed distance from the body along the segment, sampled densely.
    fn least(obstacle: &PolytopeObstacle, s: &Segment) -> f64 {
        (0..=20_000)
            .map(|i| s.start_time + s.duration * f64::from(i) / 20_000.0)
            .filter(|t| *t >= 0.0)
            .map(|t| obstacle.slack(s.pose_at(t).position, t).value)
            .fold(f64::INFINITY, f64::min)
    }

    /// Arcs that begin or end on the boundary, in a corner or beside one, and arcs anywhere. The
    /// decision agrees with the first contact and with dense samples.
    #[test]
    fn arcs_from_and_to_the_boundary_meet_when_their_first_contact_says_so() {
        let mut rng = ChaCha8Rng::seed_from_u64(11);
        let mut counts = [0, 0];
        for round in 0..30_000 {
            let mut set = |size: f64| random_polygon(&mut rng, size);
            let o = PolytopeObstacle::new("x", set(20.0), set(1.3));
            let time = rng.random_range(-5.0..60.0_f64);
            let section = o.section(time);
            let corners = section.vertices();
            let k = rng.random_range(0..corners.len());
            let beside = corners[(k + 1) % corners.len()] - corners[k];
            let position = match round % 3 {
                0 => corners[k],
                1 => corners[k] + beside * rng.random_range(0.0..1.0),
                _ => random_vector(&mut rng, 300.0),
            };
            let speed = rng.random_range(0.5..8.0);
            let radius = rng.random_range(20.0..150.0);
            let mut arc = Segment::new(
                Pose::new(position, rng.random_range(-3.2..3.2)),
                time,
                rng.random_range(0.01..2.0) * radius / speed,
                speed,
                [1.0, -1.0][rng.random_range(0..2)] * speed / radius,
            );
            if rng.random_bool(0.5) {
                // the same arc, ending there
                arc.start = arc.pose_after(-arc.duration);
                arc.start_time -= arc.duration;
            }
            let depth = [1e-7, 1e-3, 0.0][rng.random_range(0..3)];
            let met = meets(&o, &arc, depth);
            counts[usize::from(met)] += 1;
            if met == first_contact(&o, &arc, depth).is_some() {
                continue;
            }
            // differences are rounding errors on the safe side
            let least = least(&o, &arc);
            let tolerance = (0.01 * depth).max(1e-9) + 1e-9;
            let step = 12.0 * arc.duration / 20_000.0;
            assert!(
                met && least + depth > -1e-9 && least + depth < tolerance + 0.1 * step * step,
                "{met} {least} {depth} {arc:?} {o:?}"
            );
        }
        assert!(counts[0] > 5000 && counts[1] > 5000, "{counts:?}");
    }
}
