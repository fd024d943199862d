//! A target: a tracked ship as two sets, where she may be now and every velocity she may take.

use crate::frame::{Pose, Vector, direction, to_port};
use crate::geometry::{ConvexPolygon, DISC_SIDES, Ellipse};
use crate::vessel::Hull;

/// Half the angle between two tangents of the faster arc: 5°, radians.
const TANGENT_SPACING: f64 = std::f64::consts::PI / 36.0;

/// The turn that one spell of a turning target stands for: 5°, radians.
const TURN_OF_A_SPELL: f64 = std::f64::consts::PI / 36.0;

/// Of a hull's half-diagonal. A side of the outer polygon of a turned hull that is shorter is left out.
const SHORT_SIDE: f64 = 1e-3;

/// Sides of the polygon that stands for an ellipse in figures: 0.12 % beyond it at most.
const SET_SIDES: usize = 64;

/// How the initial set of a target is shaped for the rules of the road.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DomainKind {
    /// A symmetric base swept to the side that the encounter forbids.
    Colregs,
    /// One convex polygon, large in front and to starboard, sized by the target's length.
    Paper,
    /// No shape: the hull and the margin alone.
    Hull,
    /// Distances from the hull's edge, metres.
    Custom {
        /// Ahead of the bow.
        fore: f64,
        /// Behind the stern.
        aft: f64,
        /// To port.
        port: f64,
        /// To starboard.
        starboard: f64,
    },
}

/// A set of velocities and until when it holds: one of several, one after another.
#[derive(Debug, Clone, PartialEq)]
pub struct VelocitySpell {
    /// Seconds from the scenario's start; infinite for the last.
    pub until: f64,
    /// Every velocity possible until then, m/s.
    pub velocities: ConvexPolygon,
}

/// A tracked ship: nominal motion and what is not known of it.
#[derive(Debug, Clone, PartialEq)]
pub struct ShipTrack {
    /// Estimated hull centre and heading at t = 0. Course and heading are one: no drift.
    pub pose: Pose,
    /// Estimated speed, m/s, not negative.
    pub speed: f64,
    /// Her hull.
    pub hull: Hull,
    /// Standard deviation of the position, metres per axis.
    pub position_std: f64,
    /// Half-width of the speed, m/s.
    pub speed_spread: f64,
    /// Half-width of the course, radians.
    pub course_spread: f64,
    /// How fast she may turn to either side, radians per second, not negative: her course at `t` is within
    /// `course_spread + turn_rate t`.
    pub turn_rate: f64,
    /// The shape asked for.
    pub domain: DomainKind,
}

impl ShipTrack {
    /// Estimated velocity, m/s.
    pub fn velocity(&self) -> Vector {
        self.pose.ahead() * self.speed
    }

    /// Estimated pose at `time`.
    pub fn pose_at(&self, time: f64) -> Pose {
        Pose::new(
            self.pose.position + self.velocity() * time,
            self.pose.heading,
        )
    }

    /// Half-width of her heading at `time`, which is her course, radians: at most half a turn.
    pub fn heading_spread(&self, time: f64) -> f64 {
        let turned = if self.turn_rate == 0.0 {
            0.0
        } else {
            self.turn_rate.abs() * time
        };
        // of a NaN and a number the least is the number: every heading
        (self.course_spread + turned).min(std::f64::consts::PI)
    }

    /// An outer polygon of her hull at t = 0 on every heading that she may have until `time`: on the nominal one
    /// the hull itself, otherwise at most 2 % of its half-diagonal larger. Its sides are among those of
    /// [`crate::geometry::outer_disc`] about her heading, so that the sum with such a disc has no more vertices than the disc.
    pub fn outer_hull(&self, time: f64) -> ConvexPolygon {
        let spread = self.heading_spread(time);
        if spread == 0.0 {
            return self.hull.polygon(&self.pose);
        }
        let (reach, corner) = (
            self.hull.half_diagonal(),
            self.hull.beam.atan2(self.hull.length),
        );
        // a quarter of the sides, from ahead to abeam; the others are its mirror images
        let quarter = DISC_SIDES / 4;
        let step = std::f64::consts::FRAC_PI_2 / quarter as f64;
        let support = |side: f64| {
            let off = (side * step - corner).abs() - spread;
            reach * off.max(0.0).cos()
        };
        let is_long = |side: f64| {
            let beside = support(side - 1.0) + support(side + 1.0);
            beside - 2.0 * support(side) * step.cos() > SHORT_SIDE * reach * step.sin()
        };
        let mut sides = vec![0.0];
        sides.extend((1..quarter).map(|k| k as f64).filter(|side| is_long(*side)));
        sides.push(quarter as f64);
        let meet = |pair: &[f64]| {
            let (ahead, gap) = (direction(pair[0] * step), (pair[1] - pair[0]) * step);
            let [here, next] = [support(pair[0]), support(pair[1])];
            ahead * here + to_port(ahead) * ((next - here * gap.cos()) / gap.sin())
        };
        let bow: Vec<Vector> = sides.windows(2).map(meet).collect();
        let mirrored = |x: f64, y: f64| {
            let there = bow.iter().map(move |p| Vector::new(p.x * x, p.y * y));
            there.map(|p| self.pose.world_coordinates(p))
        };
        let mut points: Vec<Vector> = mirrored(1.0, 1.0).collect();
        points.extend(mirrored(-1.0, 1.0).rev());
        points.extend(mirrored(-1.0, -1.0));
        points.extend(mirrored(1.0, -1.0).rev());
        ConvexPolygon::from_ccw(points)
    }

    /// An outer polygon of every velocity with a speed in `[speed - spread, speed + spread]`,
    /// clipped at 0, and a course within `course_spread`. The faster arc is replaced by tangents at
    /// most 5° from their touching point: it reaches at most 0.4 % beyond the largest speed.
    pub fn outer_velocity_set(&self) -> ConvexPolygon {
        self.outer_velocities_within(self.course_spread)
    }

    /// Outer sets of every velocity that she may have while she turns at up to `turn_rate` radians per second
    /// to either side: her course at `t` is within `course_spread + turn_rate t`. Every set is that of the end
    /// of its spell, when it is widest; a spell is at most as long as 5° of turn take, so a half-width is never
    /// more than 5° too wide. From `horizon` seconds on, or from when they are, all courses are possible. A rate
    /// of 0 gives one set; one that is not finite gives every course at once.
    pub fn outer_velocity_spells(&self, turn_rate: f64, horizon: f64) -> Vec<VelocitySpell> {
        let spell = |until, spread| VelocitySpell {
            until,
            velocities: self.outer_velocities_within(spread),
        };
        let rate = turn_rate.abs();
        if rate == 0.0 {
            return vec![spell(f64::INFINITY, self.course_spread)];
        }
        let all = std::f64::consts::PI;
        let duration = TURN_OF_A_SPELL / rate;
        let mut spells = Vec::new();
        let mut start = 0.0;
        while start < horizon && rate.is_finite() {
            let until = f64::min(start + duration, horizon);
            let spread = self.course_spread + rate * until;
            if !(spread < all && until > start) {
                break;
            }
            spells.push(spell(until, spread));
            start = until;
        }
        spells.push(spell(f64::INFINITY, all));
        spells
    }

    fn outer_velocities_within(&self, course_spread: f64) -> ConvexPolygon {
        let (slow, fast) = (
            (self.speed - self.speed_spread).max(0.0),
            self.speed + self.speed_spread,
        );
        let spread = course_spread.min(std::f64::consts::PI);
        let mut points = Vec::new();
        for edge in [-spread, spread] {
            let ahead = direction(self.pose.heading + edge);
            points.push(ahead * slow);
            points.push(ahead * fast);
        }
        if spread > 0.0 {
            let pieces = (spread / TANGENT_SPACING).ceil().max(1.0);
            let half = spread / pieces;
            for piece in 0..pieces as usize {
                let middle = self.pose.heading - spread + half * (2 * piece + 1) as f64;
                points.push(direction(middle) * (fast / half.cos()));
            }
        }
        // finite by the type's contract; should a number overflow, every velocity is possible
        ConvexPolygon::hull(&points).unwrap_or_else(|_| everything())
    }
}

fn everything() -> ConvexPolygon {
    let far = f64::MAX.sqrt();
    ConvexPolygon::from_ccw(vec![
        Vector::new(-far, -far),
        Vector::new(far, -far),
        Vector::new(far, far),
        Vector::new(-far, far),
    ])
}

/// What is known of a target's motion.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// A tracked ship.
    Ship(ShipTrack),
    /// The two sets outright: own ship is then a point, and nothing is added.
    Sets {
        /// Where it may be at t = 0, metres.
        initial: ConvexPolygon,
        /// Every velocity it may take, m/s.
        velocity: ConvexPolygon,
    },
    /// The same, as ellipses.
    Ellipses {
        /// Where it may be at t = 0, metres.
        initial: Ellipse,
        /// Every velocity it may take, m/s.
        velocity: Ellipse,
    },
    /// The same with velocity sets one after another.
    Spells {
        /// Where it may be at t = 0, metres.
        initial: ConvexPolygon,
        /// In order of time; the ends increase and the last one's is infinite.
        spells: Vec<VelocitySpell>,
    },
}

/// What the sets of a target are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Representation {
    /// Polygons as they are.
    Polytope,
    /// The smallest ellipses around them.
    Ellipsoid,
}

/// A target.
///
/// ```
/// use searoom::frame::{Pose, Vector};
/// use searoom::target::{DomainKind, Motion, Representation, ShipTrack, Target};
/// use searoom::vessel::Hull;
///
/// let ferry = Target {
///     name: "ferry".to_owned(),
///     motion: Motion::Ship(ShipTrack {
///         pose: Pose::new(Vector::new(1500.0, 0.0), std::f64::consts::PI),
///         speed: 5.0,
///         hull: Hull { length: 60.0, beam: 12.0 },
///         position_std: 0.0,
///         speed_spread: 0.5,
///         course_spread: 0.05,
///         turn_rate: 0.0,
///         domain: DomainKind::Colregs,
///     }),
///     representation: Representation::Polytope,
/// };
/// assert!((ferry.position_at(100.0) - Vector::new(1000.0, 0.0)).norm() < 1e-9);
/// let ship = ferry.ship().expect("a ship");
/// assert!(ship.outer_velocity_set().contains(Vector::new(-5.4, 0.0)));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Unique within a scenario.
    pub name: String,
    /// What is known of it.
    pub motion: Motion,
    /// What its sets are made of; of no meaning where ellipses or several velocity sets are given.
    pub representation: Representation,
}

impl Target {
    /// Nominal centre at `time`: the estimated position, or the centroids of the two sets.
    pub fn position_at(&self, time: f64) -> Vector {
        match &self.motion {
            Motion::Ship(ship) => ship.pose_at(time).position,
            Motion::Sets { initial, velocity } => initial.centroid() + velocity.centroid() * time,
            Motion::Ellipses { initial, velocity } => initial.center() + velocity.center() * time,
            Motion::Spells { initial, spells } => stretches(spells, time)
                .fold(initial.centroid(), |at, (duration, velocities)| {
                    at + velocities.centroid() * duration
                }),
        }
    }

    /// Where a target whose sets are given outright may be at `time >= 0`, metres: the sum of its sets, of ellipses
    /// from outside, by their circumscribed 64-gons. `None` for a tracked ship.
    pub fn outer_set_at(&self, time: f64) -> Option<ConvexPolygon> {
        match &self.motion {
            Motion::Ship(_) => None,
            Motion::Sets { initial, velocity } => {
                Some(initial.minkowski_sum(&velocity.scaled(time)))
            }
            Motion::Ellipses { initial, velocity } => {
                let [initial, velocity] = [initial, velocity].map(|e| e.outer_polygon(SET_SIDES));
                Some(initial.minkowski_sum(&velocity.scaled(time)))
            }
            Motion::Spells { initial, spells } => Some(
                stretches(spells, time).fold(initial.clone(), |set, (duration, velocities)| {
                    set.minkowski_sum(&velocities.scaled(duration))
                }),
            ),
        }
    }

    /// The instants at which its velocity set changes, seconds.
    pub fn changes(&self) -> Vec<f64> {
        match &self.motion {
            Motion::Spells { spells, .. } => spells.iter().map(|s| s.until).collect(),
            Motion::Ship(_) | Motion::Sets { .. } | Motion::Ellipses { .. } => Vec::new(),
        }
    }

    /// The tracked ship, where it is one.
    pub fn ship(&self) -> Option<&ShipTrack> {
        match &self.motion {
            Motion::Ship(ship) => Some(ship),
            Motion::Sets { .. } | Motion::Ellipses { .. } | Motion::Spells { .. } => None,
        }
    }
}

/// For how long each velocity set holds until `time`, seconds.
fn stretches(spells: &[VelocitySpell], time: f64) -> impl Iterator<Item = (f64, &ConvexPolygon)> {
    let starts = std::iter::once(0.0).chain(spells.iter().map(|s| s.until));
    starts
        .zip(spells)
        .map(move |(start, s)| (s.until.min(time) - start, &s.velocities))
        .filter(|(duration, _)| *duration > 0.0)
}

#[cfg(test)]
mod tests;
