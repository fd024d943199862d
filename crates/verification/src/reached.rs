//! Support functions of the region that a target may reach by a time, with the required distance.

use super::claim::Claim;
use super::coverage::{largest, scaled_about};
use searoom_evaluation::TurnedHull;
use searoom_geometry::frame::{Vector, direction, heading_of, wrap};
use searoom_geometry::tolerance;
use searoom_geometry::{ConvexPolygon, ConvexSet, Ellipse, outer_enclosing_ellipse};
use searoom_model::target::{Motion, Representation, ShipTrack, Target, TimedVelocitySet};
use std::f64::consts::{FRAC_PI_2, PI};

/// Half the angle between tangents of the outer arc, radians: a quarter of a degree. The tangents
/// exceed the arc by a hundred-thousandth of the speed.
pub(super) const TANGENT_SPACING: f64 = PI / 720.0;

/// Sorts directions counter-clockwise, without duplicates.
pub(super) fn in_order(directions: impl Iterator<Item = Vector>) -> Vec<Vector> {
    let mut normals: Vec<(f64, Vector)> = directions.map(|n| (heading_of(n), n)).collect();
    normals.sort_by(|a, b| a.0.total_cmp(&b.0));
    normals.dedup_by(|a, b| a.1 == b.1);
    normals.into_iter().map(|(_, normal)| normal).collect()
}

/// Required distance of own ship's centre from a target's hull, metres, and the places about the
/// estimate at which the hull may be.
pub(super) fn reach(claim: &Claim, ship: &ShipTrack) -> (f64, ConvexPolygon) {
    let own = claim.own.hull.half_diagonal() + claim.own.safety_margin;
    match &ship.kept_positions {
        Some(_) => (own, ship.outer_positions()),
        None => (
            own + tolerance::SIGMAS * ship.position_std,
            ConvexPolygon::point(Vector::zeros()),
        ),
    }
}

/// Velocity sets of a target at a risk level, in order of time. Each is scaled about the centre
/// that the target's representation defines.
pub(super) fn at_level(target: &Target, level: f64, horizon: f64) -> Vec<TimedVelocitySet> {
    let sets = match &target.motion {
        Motion::Ship(ship) => ship.outer_velocity_sets(ship.turn_rate, horizon),
        Motion::Sets(sets) => sets.velocities.clone(),
    };
    let scaled = |set: ConvexSet| match &set {
        ConvexSet::Polygon(polygon) => scaled_about(polygon, center(target, &set), level).into(),
        ConvexSet::Ellipse(_) if level == 1.0 => set,
        ConvexSet::Ellipse(_) => set.scaled_about_center(level),
    };
    sets.into_iter()
        .map(|set| TimedVelocitySet::new(set.until, scaled(set.velocities)))
        .collect()
}

/// Centre of a velocity set of a target, about which a level of risk scales it.
fn center(target: &Target, set: &ConvexSet) -> Vector {
    match (target.representation, set) {
        (Representation::Ellipsoid, ConvexSet::Polygon(set)) => {
            outer_enclosing_ellipse(set).center()
        }
        _ => set.center(),
    }
}

/// Known reachable set of a target with the required distance, by its supports in given directions.
pub(super) struct Known<'a> {
    normals: &'a [Vector],
    /// Support in each direction at t = 0, metres.
    initial: Vec<f64>,
    /// Upper bound of the diameter at t = 0, metres.
    across: f64,
    motion: Moving,
    /// Ends of a ship's velocity sets and their centres.
    centers: Vec<(f64, Vector)>,
}

/// Further motion of the target.
enum Moving {
    /// Every speed and course within the spreads.
    Ship(Box<ShipTrack>),
    /// For each velocity set: its end, its support in each direction, and its diameter in m/s.
    Sets(Vec<(f64, Vec<f64>, f64)>),
}

impl<'a> Known<'a> {
    /// Builds the reachable set. `scale` is the scale of the velocities about their centre. The
    /// directions are in counter-clockwise order.
    pub fn of(claim: &Claim, target: &Target, scale: f64, normals: &'a [Vector]) -> Self {
        let supports = |set: &ConvexSet| match set {
            ConvexSet::Polygon(polygon) => (polygon.supports(normals), polygon.across()),
            ConvexSet::Ellipse(e) => (normals.iter().map(|n| e.support(*n)).collect(), widest(e)),
        };
        let (initial, across) = match &target.motion {
            Motion::Ship(ship) => {
                let hull = TurnedHull::of(ship, claim.file.horizon_s);
                let (reach, places) = reach(claim, ship);
                let support = |n: &Vector| hull.support(*n) + places.support(*n) + reach;
                let supports = normals.iter().map(support);
                let across = 2.0 * (ship.hull.half_diagonal() + places.reach() + reach);
                (supports.collect(), across)
            }
            Motion::Sets(sets) => supports(&sets.initial),
        };
        let motion = match &target.motion {
            Motion::Ship(ship)
                if scale == 1.0 && ship.kept_velocities.is_none() && ship.route.is_empty() =>
            {
                Moving::Ship(Box::new(ship.clone()))
            }
            _ => {
                let sets = at_level(target, scale, claim.file.horizon_s);
                let timed = |set: &TimedVelocitySet| {
                    let (rates, across) = supports(&set.velocities);
                    (set.until, rates, across)
                };
                Moving::Sets(sets.iter().map(timed).collect())
            }
        };
        let held = match &target.motion {
            Motion::Ship(_) if scale == 1.0 => at_level(target, 1.0, claim.file.horizon_s),
            _ => Vec::new(),
        };
        let centers = held.iter();
        Self {
            normals,
            initial,
            across,
            motion,
            centers: centers
                .map(|s| (s.until, center(target, &s.velocities)))
                .collect(),
        }
    }

    /// Centre of a ship's velocities at a time.
    pub fn center_at(&self, time: f64) -> Option<Vector> {
        let mut centers = self.centers.iter();
        let held = centers.find(|(until, _)| time < *until);
        held.map(|(_, center)| *center)
    }

    /// Times at which the velocities change instantly.
    pub fn changes(&self) -> impl Iterator<Item = f64> + '_ {
        let sets = match &self.motion {
            Moving::Ship(_) => &[][..],
            Moving::Sets(sets) => sets,
        };
        sets.iter().map(|(until, ..)| *until)
    }

    /// Support in each direction at a time, metres.
    pub fn at(&self, time: f64) -> Vec<f64> {
        let mut reached = self.initial.clone();
        match &self.motion {
            Moving::Ship(ship) => {
                for (reached, n) in reached.iter_mut().zip(self.normals) {
                    *reached += way(ship, *n, time);
                }
            }
            Moving::Sets(sets) => {
                for (duration, rates, _) in lasting(sets, time) {
                    for (reached, rate) in reached.iter_mut().zip(rates) {
                        *reached += duration * rate;
                    }
                }
            }
        }
        reached
    }

    /// Largest difference between equal sets, metres. It consists of the depth tolerance, the
    /// corners that a polygon omits, and rounding. Scaled velocities lose digits in proportion to
    /// `factor`.
    pub fn rounding(&self, reached: &[f64], time: f64, factor: f64) -> f64 {
        let way = |a: &f64, b: &f64| (a - b).abs();
        let way = largest(reached.iter().zip(&self.initial).map(|(a, b)| way(a, b)));
        let spread = match &self.motion {
            Moving::Ship(ship) => {
                let turned = ship.course_half_width() + ship.turn_rate * time;
                let spread = ship.speed_half_width();
                let fast = ship.speed + spread;
                (2.0 * fast * turned.min(1.0) + 2.0 * spread) * time
            }
            Moving::Sets(sets) => lasting(sets, time).map(|(t, _, across)| t * across).sum(),
        };
        let digits = largest(reached.iter().map(|h| h.abs())) + factor.max(1.0) * way;
        tolerance::DEPTH_M.max(tolerance::COLLINEAR_RAD * (self.across + spread))
            + 16.0 * f64::EPSILON * digits
    }
}

/// Duration of each velocity set until a time.
fn lasting(
    sets: &[(f64, Vec<f64>, f64)],
    time: f64,
) -> impl Iterator<Item = (f64, &Vec<f64>, f64)> {
    let starts = std::iter::once(0.0).chain(sets.iter().map(|(until, ..)| *until));
    starts
        .zip(sets)
        .map(move |(start, (until, rates, across))| {
            ((until.min(time) - start).max(0.0), rates, *across)
        })
}

/// Diameter of an ellipse.
pub(super) fn widest(ellipse: &Ellipse) -> f64 {
    let [a, b] = ellipse.semi_axes();
    2.0 * a.norm().max(b.norm())
}

/// Support of the ship's displacement in a direction by a time, in closed form.
///
/// While the nearest possible course is more than a right angle off the direction, the least speed
/// is the best. After that, the greatest speed is.
fn way(ship: &ShipTrack, n: Vector, time: f64) -> f64 {
    let (slow, fast) = speeds(ship);
    let (middle, half) = (ship.middle_course(), ship.course_half_width());
    let off = wrap(heading_of(n) - middle).abs() - half;
    let turned_to = |angle: f64| {
        if off > angle {
            ((off - angle) / ship.turn_rate).min(time)
        } else {
            0.0
        }
    };
    let (abeam, ahead) = (turned_to(FRAC_PI_2), turned_to(0.0));
    // Integral of the cosine of an angle that decreases uniformly.
    let along = |from: f64, until: f64| {
        let half = 0.5 * (until - from);
        let turn = ship.turn_rate * half;
        let chord = if turn < 1e-4 {
            1.0 - turn * turn / 6.0
        } else {
            turn.sin() / turn
        };
        2.0 * half * (off - ship.turn_rate * (from + half)).cos() * chord
    };
    slow * along(0.0, abeam) + fast * (along(abeam, ahead) + time - ahead)
}

fn speeds(ship: &ShipTrack) -> (f64, f64) {
    let half = ship.speed_half_width();
    ((ship.speed - half).max(0.0), ship.speed + half)
}

/// Points whose convex hull contains every velocity that a ship may have until a time. All are
/// possible velocities, except the intersections of tangents to the outer arc.
pub(super) fn outer_velocities(ship: &ShipTrack, until: f64) -> Vec<Vector> {
    if ship.kept_velocities.is_some() && ship.turn_rate == 0.0 {
        return ship.outer_velocity_set().vertices().to_vec();
    }
    let (slow, fast) = speeds(ship);
    let (middle, half) = (ship.middle_course(), ship.course_half_width());
    let spread = (half + ship.turn_rate * until).min(PI);
    let edges = [-spread, spread].map(|edge| direction(middle + edge));
    let mut points: Vec<Vector> = edges
        .into_iter()
        .flat_map(|ahead| [ahead * slow, ahead * fast])
        .collect();
    if spread > 0.0 {
        let pieces = (spread / TANGENT_SPACING).ceil().max(1.0);
        let half = spread / pieces;
        points.extend((0..pieces as usize).map(|piece| {
            let touching = middle - spread + half * (2 * piece + 1) as f64;
            direction(touching) * (fast / half.cos())
        }));
    }
    points
}
