//! Where a target may be at a time, asked of a set that starts then.

use super::claim::Claim;
use super::coverage::{Bounded, POSITION_SIGMAS, Sector, largest, sampled_directions};
use crate::evaluation::TurnedHull;
use crate::frame::Vector;
use crate::target::{Motion, Target, VelocitySpell};

/// Instants at which the velocities of a ship that turns are looked at.
const INSTANTS: u32 = 1000;

/// How far what a target may have reached at a time is beyond a set: along the normals of a polygon, in sampled directions
/// for an ellipse. Of a ship that turns it is a lower bound, by what she turns in a thousandth of the time.
pub(super) fn short(claim: &Claim, target: &Target, set: &Bounded, time: f64) -> f64 {
    match set {
        Bounded::Polygon(polygon) => {
            let normals = polygon.normals().into_iter();
            largest(normals.map(|n| support(claim, target, n, time) - polygon.support(n)))
        }
        Bounded::Ellipse(ellipse) => largest(
            sampled_directions(ellipse)
                .map(|n| support(claim, target, n, time) - ellipse.support(n)),
        ),
    }
}

/// The farthest in a direction that a target may have come, with what has to be kept of her.
fn support(claim: &Claim, target: &Target, n: Vector, time: f64) -> f64 {
    match &target.motion {
        Motion::Ship(ship) => {
            let reach = claim.own.hull.half_diagonal()
                + claim.own.safety_margin
                + POSITION_SIGMAS * ship.position_std;
            let way = if ship.turn_rate > 0.0 {
                let step = time / f64::from(INSTANTS);
                let instants = (0..INSTANTS).map(|k| step * f64::from(k));
                let rates = instants.map(|t| Sector::of(ship, t).support(n));
                rates.sum::<f64>() * step
            } else {
                Sector::of(ship, 0.0).support(n) * time
            };
            TurnedHull::of(ship, claim.file.horizon_s).support(n) + reach + way
        }
        Motion::Sets { initial, velocity } => initial.support(n) + velocity.support(n) * time,
        Motion::Ellipses { initial, velocity } => initial.support(n) + velocity.support(n) * time,
        Motion::Spells { initial, spells } => {
            let starts = std::iter::once(0.0).chain(spells.iter().map(|s| s.until));
            let way = |(start, spell): (f64, &VelocitySpell)| {
                spell.velocities.support(n) * (spell.until.min(time) - start).max(0.0)
            };
            initial.support(n) + starts.zip(spells).map(way).sum::<f64>()
        }
    }
}
