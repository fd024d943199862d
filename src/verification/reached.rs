//! Where a target may be at a time, with what has to be kept of her, by how far it reaches in
//! directions.

use super::claim::Claim;
use super::coverage::{about_centroid, largest};
use crate::evaluation::TurnedHull;
use crate::frame::{Vector, direction, heading_of, wrap};
use crate::geometry::{ConvexPolygon, Ellipse, outer_enclosing_ellipse};
use crate::target::{Motion, Representation, ShipTrack, Target, VelocitySpell};
use crate::tolerance;
use std::f64::consts::{FRAC_PI_2, PI};

/// Radians, a quarter of a degree: half the angle between tangents of the faster arc. What they cut
/// off beyond the arc is a hundred-thousandth of the speed.
pub(super) const TANGENT_SPACING: f64 = PI / 720.0;

/// Directions counter-clockwise, each once.
pub(super) fn in_order(directions: impl Iterator<Item = Vector>) -> Vec<Vector> {
    let mut normals: Vec<(f64, Vector)> = directions.map(|n| (heading_of(n), n)).collect();
    normals.sort_by(|a, b| a.0.total_cmp(&b.0));
    normals.dedup_by(|a, b| a.1 == b.1);
    normals.into_iter().map(|(_, normal)| normal).collect()
}

/// Metres that own ship has to keep from a ship's hull, own ship's middle being what is kept out.
pub(super) fn reach(claim: &Claim, ship: &ShipTrack) -> f64 {
    claim.own.hull.half_diagonal()
        + claim.own.safety_margin
        + tolerance::POSITION_SIGMAS * ship.position_std
}

/// The velocities of a target at a level, one set after another: scaled about the centre that her
/// representation has. None of ellipses.
pub(super) fn at_level(target: &Target, level: f64, horizon: f64) -> Vec<VelocitySpell> {
    let forever = |velocities| VelocitySpell {
        until: f64::INFINITY,
        velocities,
    };
    let spells = match &target.motion {
        Motion::Ship(ship) => ship.outer_velocity_spells(ship.turn_rate, horizon),
        Motion::Sets { velocity, .. } => vec![forever(velocity.clone())],
        Motion::Spells { spells, .. } => spells.clone(),
        Motion::Ellipses { .. } => Vec::new(),
    };
    let scaled = |set: &ConvexPolygon| match target.representation {
        _ if level == 1.0 => set.clone(),
        Representation::Polytope => about_centroid(set, level),
        Representation::Ellipsoid => {
            let center = outer_enclosing_ellipse(set).center();
            let about = set.translated(-center);
            about.scaled(level).translated(center)
        }
    };
    spells
        .into_iter()
        .map(|spell| VelocitySpell {
            until: spell.until,
            velocities: scaled(&spell.velocities),
        })
        .collect()
}

/// How far a target may have come in directions, and what has to be kept of her.
pub(super) struct Known<'a> {
    normals: &'a [Vector],
    /// Metres in each direction at t = 0.
    initial: Vec<f64>,
    /// Metres across it, at most.
    across: f64,
    motion: Moving,
}

/// How it goes on.
enum Moving {
    /// At every speed and course within the spreads.
    Ship(ShipTrack),
    /// The end of each velocity set, how fast it reaches in each direction, and m/s across it.
    Sets(Vec<(f64, Vec<f64>, f64)>),
}

impl<'a> Known<'a> {
    /// `scale` is that of the velocities about their centre. The directions go around
    /// counter-clockwise.
    pub fn of(claim: &Claim, target: &Target, scale: f64, normals: &'a [Vector]) -> Self {
        let of_ellipse = |e: &Ellipse| normals.iter().map(|n| e.support(*n)).collect();
        let (initial, across) = match &target.motion {
            Motion::Ship(ship) => {
                let hull = TurnedHull::of(ship, claim.file.horizon_s);
                let reach = reach(claim, ship);
                let supports = normals.iter().map(|n| hull.support(*n) + reach);
                let across = 2.0 * (ship.hull.half_diagonal() + reach);
                (supports.collect(), across)
            }
            Motion::Sets { initial, .. } | Motion::Spells { initial, .. } => {
                (initial.supports(normals), initial.across())
            }
            Motion::Ellipses { initial, .. } => (of_ellipse(initial), widest(initial)),
        };
        let motion = match &target.motion {
            Motion::Ship(ship) if scale == 1.0 => Moving::Ship(ship.clone()),
            Motion::Ellipses { velocity, .. } => {
                let velocity = velocity.scaled_about_center(scale);
                let rates = of_ellipse(&velocity);
                Moving::Sets(vec![(f64::INFINITY, rates, widest(&velocity))])
            }
            _ => {
                let spells = at_level(target, scale, claim.file.horizon_s);
                let of = |s: &VelocitySpell| {
                    let rates = s.velocities.supports(normals);
                    (s.until, rates, s.velocities.across())
                };
                Moving::Sets(spells.iter().map(of).collect())
            }
        };
        Self {
            normals,
            initial,
            across,
            motion,
        }
    }

    /// When its velocities change at once.
    pub fn changes(&self) -> impl Iterator<Item = f64> + '_ {
        let sets = match &self.motion {
            Moving::Ship(_) => &[][..],
            Moving::Sets(sets) => sets,
        };
        sets.iter().map(|(until, ..)| *until)
    }

    /// Metres in each direction at a time.
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

    /// Metres by which two sets may differ that are the same: the depth that counts as none, the
    /// corners that a polygon leaves out, and the last digits, of which velocities lose as many as
    /// they are scaled by.
    pub fn rounding(&self, reached: &[f64], time: f64, factor: f64) -> f64 {
        let way = |a: &f64, b: &f64| (a - b).abs();
        let way = largest(reached.iter().zip(&self.initial).map(|(a, b)| way(a, b)));
        let spread = match &self.motion {
            Moving::Ship(ship) => {
                let turned = ship.course_spread + ship.turn_rate * time;
                let fast = ship.speed + ship.speed_spread;
                (2.0 * fast * turned.min(1.0) + 2.0 * ship.speed_spread) * time
            }
            Moving::Sets(sets) => lasting(sets, time).map(|(t, _, across)| t * across).sum(),
        };
        let digits = largest(reached.iter().map(|h| h.abs())) + factor.max(1.0) * way;
        tolerance::DEPTH_M.max(tolerance::COLLINEAR_RAD * (self.across + spread))
            + 16.0 * f64::EPSILON * digits
    }
}

/// For how long each velocity set holds until a time.
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

/// Metres across an ellipse.
fn widest(ellipse: &Ellipse) -> f64 {
    let [a, b] = ellipse.semi_axes();
    2.0 * a.norm().max(b.norm())
}

/// The farthest that a ship may come in a direction by a time, in closed form: at her greatest
/// speed on the course that is nearest to it, once that is within a right angle of it, and before
/// at her least.
fn way(ship: &ShipTrack, n: Vector, time: f64) -> f64 {
    let (slow, fast) = speeds(ship);
    let off = wrap(heading_of(n) - ship.pose.heading).abs() - ship.course_spread;
    let turned_to = |angle: f64| {
        if off > angle {
            ((off - angle) / ship.turn_rate).min(time)
        } else {
            0.0
        }
    };
    let (abeam, ahead) = (turned_to(FRAC_PI_2), turned_to(0.0));
    // the integral of the cosine of an angle that falls evenly
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
    let slow = (ship.speed - ship.speed_spread).max(0.0);
    (slow, ship.speed + ship.speed_spread)
}

/// Points whose hull contains every velocity that a ship may have until a time: all are of such
/// velocities but the corners of tangents to the faster arc.
pub(super) fn outer_velocities(ship: &ShipTrack, until: f64) -> Vec<Vector> {
    let (slow, fast) = speeds(ship);
    let heading = ship.pose.heading;
    let spread = (ship.course_spread + ship.turn_rate * until).min(PI);
    let edges = [-spread, spread].map(|edge| direction(heading + edge));
    let mut points: Vec<Vector> = edges
        .into_iter()
        .flat_map(|ahead| [ahead * slow, ahead * fast])
        .collect();
    if spread > 0.0 {
        let pieces = (spread / TANGENT_SPACING).ceil().max(1.0);
        let half = spread / pieces;
        points.extend((0..pieces as usize).map(|piece| {
            let middle = heading - spread + half * (2 * piece + 1) as f64;
            direction(middle) * (fast / half.cos())
        }));
    }
    points
}
