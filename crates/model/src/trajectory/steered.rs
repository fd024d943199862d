//! Motion under forces: states at nodes, constant forces between them.

use super::TrajectoryError;
use searoom_geometry::frame::{Pose, Vector, to_port};

/// The state of a ship at one time, and the forces from then on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceNode {
    /// Seconds.
    pub time: f64,
    /// Pose; the heading is not wrapped.
    pub pose: Pose,
    /// Velocity in the ship's frame: surge ahead and sway to port, m/s.
    pub velocity: Vector,
    /// rad/s, counter-clockwise.
    pub yaw_rate: f64,
    /// Surge ahead and sway to port, newtons; constant until the next node.
    pub force: Vector,
    /// Yaw moment counter-clockwise, newton metres; constant until the next node.
    pub moment: f64,
}

impl ForceNode {
    /// Velocity over ground, m/s.
    pub fn ground_velocity(&self) -> Vector {
        let ahead = self.pose.ahead();
        ahead * self.velocity.x + to_port(ahead) * self.velocity.y
    }

    fn is_finite(&self) -> bool {
        [
            self.time,
            self.pose.position.x,
            self.pose.position.y,
            self.pose.heading,
            self.velocity.x,
            self.velocity.y,
            self.yaw_rate,
            self.force.x,
            self.force.y,
            self.moment,
        ]
        .iter()
        .all(|v| v.is_finite())
    }
}

/// A motion given at nodes. Between two nodes position and heading are the cubics that interpolate
/// values and rates.
///
/// This is what a plan of forces claims; a check decides how closely the ship follows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Steered {
    nodes: Vec<ForceNode>,
}

impl Steered {
    /// From at least two nodes of finite numbers with increasing times.
    pub fn new(nodes: Vec<ForceNode>) -> Result<Self, TrajectoryError> {
        if nodes.len() < 2 {
            return Err(TrajectoryError::Empty);
        }
        for (index, node) in nodes.iter().enumerate() {
            let later = index == 0 || node.time > nodes[index - 1].time;
            if !node.is_finite() || !later {
                return Err(TrajectoryError::Invalid { index });
            }
        }
        Ok(Self { nodes })
    }

    /// This motion by a clock that starts `time` seconds later.
    pub fn after(&self, time: f64) -> Self {
        let nodes = self.nodes.iter().map(|node| ForceNode {
            time: node.time - time,
            ..*node
        });
        Self {
            nodes: nodes.collect(),
        }
    }

    /// The nodes, in order of time.
    pub fn nodes(&self) -> &[ForceNode] {
        &self.nodes
    }

    /// The pieces from each node to the next.
    pub fn pieces(&self) -> impl Iterator<Item = Cubic> + '_ {
        self.nodes
            .windows(2)
            .map(|pair| Cubic::from_nodes(&pair[0], &pair[1]))
    }

    /// The piece at `time`; the first before the start, the last after the end.
    pub fn piece_at(&self, time: f64) -> Cubic {
        let after = self.nodes.partition_point(|node| node.time <= time);
        let index = after.clamp(1, self.nodes.len() - 1);
        Cubic::from_nodes(&self.nodes[index - 1], &self.nodes[index])
    }

    /// The node at `time`, clamped like [`Self::piece_at`].
    pub fn node_at(&self, time: f64) -> &ForceNode {
        let after = self.nodes.partition_point(|node| node.time <= time);
        &self.nodes[after.clamp(1, self.nodes.len()) - 1]
    }

    /// Length of the motion, metres, to about 1e-5 of it.
    pub fn length(&self) -> f64 {
        // Simpson's rule on quarters of each piece
        let speed = |piece: &Cubic, part: f64| piece.velocity(part).norm();
        self.pieces()
            .map(|piece| {
                (0..4)
                    .map(|k| 0.25 * f64::from(k))
                    .map(|from| {
                        speed(&piece, from)
                            + 4.0 * speed(&piece, from + 0.125)
                            + speed(&piece, from + 0.25)
                    })
                    .sum::<f64>()
                    * piece.duration
                    / 24.0
            })
            .sum()
    }
}

/// A piece of motion whose position and heading are cubics of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic {
    /// Seconds.
    pub start_time: f64,
    /// Seconds, positive.
    pub duration: f64,
    /// Position at both ends, metres.
    pub positions: [Vector; 2],
    /// Velocity over ground at both ends, m/s.
    pub velocities: [Vector; 2],
    /// Heading at both ends, radians.
    pub headings: [f64; 2],
    /// Yaw rate at both ends, rad/s.
    pub yaw_rates: [f64; 2],
}

/// Upper bounds of the absolute derivatives in a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// m/s.
    pub speed: f64,
    /// m/s².
    pub acceleration: f64,
    /// rad/s.
    pub yaw_rate: f64,
    /// rad/s².
    pub yaw_acceleration: f64,
}

impl Cubic {
    /// From a node to the next one.
    pub fn from_nodes(from: &ForceNode, to: &ForceNode) -> Self {
        Self {
            start_time: from.time,
            duration: to.time - from.time,
            positions: [from.pose.position, to.pose.position],
            velocities: [from.ground_velocity(), to.ground_velocity()],
            headings: [from.pose.heading, to.pose.heading],
            yaw_rates: [from.yaw_rate, to.yaw_rate],
        }
    }

    /// The part between two times within the piece, the second one later.
    pub fn between(&self, from: f64, to: f64) -> Self {
        let [a, b] = [from, to].map(|time| self.part(time));
        Self {
            start_time: from,
            // an instant is also a piece, with all parameters 0
            duration: (to - from).max(f64::MIN_POSITIVE),
            positions: [self.position(a), self.position(b)],
            velocities: [self.velocity(a), self.velocity(b)],
            headings: [self.pose_at(from).heading, self.pose_at(to).heading],
            yaw_rates: [self.yaw_rate_at(from), self.yaw_rate_at(to)],
        }
    }

    /// End time, seconds.
    pub fn end_time(&self) -> f64 {
        self.start_time + self.duration
    }

    /// Fraction of the duration at a time in seconds.
    pub fn part(&self, time: f64) -> f64 {
        (time - self.start_time) / self.duration
    }

    /// Position at a fraction of the duration, in `[0, 1]`.
    pub fn position(&self, part: f64) -> Vector {
        let [a, b, c, d] = hermite(part);
        self.positions[0] * a
            + self.velocities[0] * (b * self.duration)
            + self.positions[1] * c
            + self.velocities[1] * (d * self.duration)
    }

    /// Velocity over ground at a fraction of the duration, m/s.
    pub fn velocity(&self, part: f64) -> Vector {
        let [a, b, c, d] = hermite_rate(part);
        self.positions[0] * (a / self.duration)
            + self.velocities[0] * b
            + self.positions[1] * (c / self.duration)
            + self.velocities[1] * d
    }

    /// Pose at a time in seconds, extrapolated beyond the ends.
    pub fn pose_at(&self, time: f64) -> Pose {
        let part = self.part(time);
        let [a, b, c, d] = hermite(part);
        let heading = self.headings[0] * a
            + self.yaw_rates[0] * (b * self.duration)
            + self.headings[1] * c
            + self.yaw_rates[1] * (d * self.duration);
        Pose::new(self.position(part), heading)
    }

    /// State at a time in seconds as a node without forces.
    pub fn node_at(&self, time: f64) -> ForceNode {
        let (pose, velocity) = (self.pose_at(time), self.velocity(self.part(time)));
        let ahead = pose.ahead();
        ForceNode {
            time,
            pose,
            velocity: Vector::new(velocity.dot(&ahead), velocity.dot(&to_port(ahead))),
            yaw_rate: self.yaw_rate_at(time),
            force: Vector::zeros(),
            moment: 0.0,
        }
    }

    /// Yaw rate at a time in seconds, rad/s.
    pub fn yaw_rate_at(&self, time: f64) -> f64 {
        let [a, b, c, d] = hermite_rate(self.part(time));
        (self.headings[0] * a + self.headings[1] * c) / self.duration
            + self.yaw_rates[0] * b
            + self.yaw_rates[1] * d
    }

    /// Bounds over the whole piece.
    ///
    /// Second derivatives of cubics are largest at an end. First derivatives differ from their mean
    /// by at most half of that times the duration.
    pub fn bounds(&self) -> Bounds {
        let t = self.duration;
        let ends = |rise: f64, first: f64, last: f64| {
            [
                (6.0 * rise / t - 4.0 * first - 2.0 * last) / t,
                (-6.0 * rise / t + 2.0 * first + 4.0 * last) / t,
            ]
        };
        let rise = self.positions[1] - self.positions[0];
        let [x, y] = [0, 1].map(|i| ends(rise[i], self.velocities[0][i], self.velocities[1][i]));
        let acceleration = [0, 1]
            .map(|end| Vector::new(x[end], y[end]).norm())
            .into_iter()
            .fold(0.0, f64::max);
        let turn = self.headings[1] - self.headings[0];
        let [a, b] = ends(turn, self.yaw_rates[0], self.yaw_rates[1]);
        let yaw_acceleration = a.abs().max(b.abs());
        let [v, w] = self.velocities.map(|v| v.norm());
        let [p, q] = self.yaw_rates.map(f64::abs);
        Bounds {
            speed: v.max(w) + 0.5 * acceleration * t,
            acceleration,
            yaw_rate: p.max(q) + 0.5 * yaw_acceleration * t,
            yaw_acceleration,
        }
    }
}

/// Hermite's four cubics: weights of the start value, its rate times the duration, the end value,
/// and its rate times the duration.
pub fn hermite(part: f64) -> [f64; 4] {
    let (s, r) = (part, 1.0 - part);
    [
        r * r * (1.0 + 2.0 * s),
        s * r * r,
        s * s * (3.0 - 2.0 * s),
        -s * s * r,
    ]
}

/// Derivatives of [`hermite`].
fn hermite_rate(part: f64) -> [f64; 4] {
    let (s, r) = (part, 1.0 - part);
    [
        -6.0 * s * r,
        r * (1.0 - 3.0 * s),
        6.0 * s * r,
        s * (3.0 * s - 2.0),
    ]
}

#[cfg(test)]
mod tests;
