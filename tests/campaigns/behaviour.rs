//! Random motion of a target: a point of its initial set and a velocity signal in its velocity set.

use rand::Rng;

use searoom::frame::Vector;
use searoom::geometry::ConvexPolygon;

/// Seconds: range of the random time for which a signal holds a velocity.
const HOLD: std::ops::Range<f64> = 5.0..60.0;

/// Fraction of the way to a new velocity in one step of a random walk.
const WALK_STEP: f64 = 0.3;

/// Variation of a velocity in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Signal {
    /// One velocity for ever.
    Constant,
    /// Jumps from vertex to vertex of the velocity set.
    BangBang,
    /// Random walk through the velocity set.
    RandomWalk,
}

impl Signal {
    /// Every signal.
    pub const ALL: [Self; 3] = [Self::Constant, Self::BangBang, Self::RandomWalk];
}

/// A stretch of constant velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stretch {
    start_time: f64,
    start: Vector,
    velocity: Vector,
}

/// A motion of piecewise constant velocity from t = 0: exact at every instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Behaviour {
    stretches: Vec<Stretch>,
}

impl Behaviour {
    /// Draws a first position in `initial` (metres) and a velocity signal in `velocity` (m/s) that
    /// varies until `until` seconds and then holds its last value. Convex combinations of vertices
    /// are inside the sets; half of the positions and of the constant velocities are vertices,
    /// where a reachable set is touched first. O(vertices · until).
    pub fn random(
        signal: Signal,
        initial: &ConvexPolygon,
        velocity: &ConvexPolygon,
        until: f64,
        rng: &mut impl Rng,
    ) -> Self {
        let mut at = vertex_or_point(initial, rng);
        let mut now = match signal {
            Signal::BangBang => vertex(velocity, rng),
            Signal::Constant | Signal::RandomWalk => vertex_or_point(velocity, rng),
        };
        let mut time = 0.0;
        let mut stretches = Vec::new();
        loop {
            stretches.push(Stretch {
                start_time: time,
                start: at,
                velocity: now,
            });
            let hold = rng.random_range(HOLD);
            time += hold;
            // negated on purpose: a horizon that is not a number ends the signal
            if signal == Signal::Constant || !(time < until) {
                return Self { stretches };
            }
            at += now * hold;
            now = match signal {
                Signal::Constant => now,
                Signal::BangBang => vertex(velocity, rng),
                Signal::RandomWalk => now.lerp(&vertex_or_point(velocity, rng), WALK_STEP),
            };
        }
    }

    /// Position at `time` seconds, metres; before 0 the first motion is extrapolated.
    pub fn position_at(&self, time: f64) -> Vector {
        let stretch = self.stretch_at(time);
        stretch.start + stretch.velocity * (time - stretch.start_time)
    }

    /// Velocity at `time` seconds, m/s; at a jump the later velocity.
    pub fn velocity_at(&self, time: f64) -> Vector {
        self.stretch_at(time).velocity
    }

    fn stretch_at(&self, time: f64) -> &Stretch {
        let after = self.stretches.partition_point(|s| s.start_time <= time);
        &self.stretches[after.saturating_sub(1)]
    }
}

fn vertex(set: &ConvexPolygon, rng: &mut impl Rng) -> Vector {
    set.vertices()[rng.random_range(0..set.vertices().len())]
}

fn vertex_or_point(set: &ConvexPolygon, rng: &mut impl Rng) -> Vector {
    if rng.random_bool(0.5) {
        return vertex(set, rng);
    }
    // exponential weights are uniform on the simplex of convex combinations
    let weights: Vec<f64> = set
        .vertices()
        .iter()
        .map(|_| -(1.0 - rng.random_range(0.0..1.0_f64)).ln() + f64::MIN_POSITIVE)
        .collect();
    let total: f64 = weights.iter().sum();
    set.vertices()
        .iter()
        .zip(&weights)
        .map(|(v, w)| v * (w / total))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::super::path_time::set;
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use searoom::obstacle::PolytopeObstacle;

    #[test]
    fn no_behaviour_leaves_the_reachable_set() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        for _ in 0..500 {
            let [initial, velocity] = [50.0, 5.0].map(|size| set(&mut rng, Vector::zeros(), size));
            let reachable = PolytopeObstacle::new("x", initial.clone(), velocity.clone());
            for signal in Signal::ALL {
                let b = Behaviour::random(signal, &initial, &velocity, 300.0, &mut rng);
                for i in 0..=60 {
                    let t = f64::from(i) * 5.0;
                    assert!(reachable.slack(b.position_at(t), t).value < 1e-9, "{b:?}");
                    assert!(velocity.signed_distance(b.velocity_at(t)) < 1e-9);
                }
            }
        }
    }
}
