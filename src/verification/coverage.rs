//! Checks that the sets are large enough for the known state and uncertainty of the targets.
//!
//! A tracked ship's set has to contain two things:
//!
//! - its hull, on every heading that it may have until the horizon, ⊕ a disc; the radius of the
//!   disc is own half-diagonal, safety margin and three standard deviations of the target's
//!   position;
//! - every position that it may reach at a speed and course within the spreads, with the largest
//!   possible turn.
//!
//! Explicit sets have to be contained unchanged. If risk was accepted, the level set has to contain
//! the known velocities scaled to that level. The level set of a ship, scaled back, has to contain
//! all of them.
//!
//! Polygons are compared by their sections. The support of a section in a direction is linear in
//! time between two changes of its velocities. The support of the target's reachable set is linear
//! too, or convex where the target turns. Containment at the changes, at the start and at the
//! horizon therefore proves containment at all times, for a slab of any duration and speed.

use super::claim::Claim;
use super::reached::{Known, TANGENT_SPACING, at_level, in_order, outer_velocities, reach};
use crate::evaluation::{SetShape, SpaceTimeSet, TurnedHull, Violation};
use crate::frame::{Vector, direction, to_port};
use crate::geometry::{ConvexPolygon, Ellipse};
use crate::target::{Motion, Target, VelocitySpell};
use crate::tolerance;

/// Parts of the known set that a set may fail to contain.
const HULL: &str = "the hull, the margin and the uncertainty";
const VELOCITIES: &str = "her velocities";
const INITIAL: &str = "the initial set";
const VELOCITY: &str = "the velocity set";
const LEVEL: &str = "the velocities at the accepted risk";
const LEFT: &str = "where she may be when it has been left";

/// Number of directions in which two ellipses are compared.
pub(super) const SAMPLED_DIRECTIONS: usize = 720;

/// Reports every target without exactly one set of sufficient size, and every set without a target.
pub(super) fn check(claim: &Claim) -> Vec<Violation> {
    let mut found = Vec::new();
    let mut note = |what: String, time: f64| found.push(Violation { what, time });
    for set in &claim.sets {
        if !claim.targets.iter().any(|t| t.name == set.name) {
            note(
                format!("set of '{}': no target has this name", set.name),
                0.0,
            );
        }
    }
    for (index, target) in claim.targets.iter().enumerate() {
        let name = &target.name;
        if claim.targets[..index].iter().any(|t| t.name == *name) {
            note(format!("target '{name}': twice"), 0.0);
        }
        let mut own = claim.sets.iter().filter(|s| s.name == *name);
        let (Some(set), None) = (own.next(), own.next()) else {
            note(format!("target '{name}': not exactly one set"), 0.0);
            continue;
        };
        for (what, time) in lacks(claim, target, set) {
            note(format!("set of '{name}': {what}"), time);
        }
    }
    found
}

/// Describes each part of a target's known set that the set does not contain, with the first time.
fn lacks(claim: &Claim, target: &Target, set: &SpaceTimeSet) -> Vec<(String, f64)> {
    let level = 1.0 - claim.file.max_risk;
    match &set.shape {
        SetShape::Polygons { initial, spells } => {
            let mut scales = vec![level];
            // The set around a scaled polygon has a centre of its own, so it cannot be scaled back.
            // Explicit sets are known as they are: the first check is complete.
            let ship = target.ship().is_some();
            if level < 1.0 && ship && claim.file.optimal_control.is_none() {
                scales.push(1.0);
            }
            let short = |scale| in_sections(claim, target, set.from, (initial, spells), scale);
            scales.into_iter().filter_map(short).collect()
        }
        SetShape::Ellipses { initial, velocity } => {
            of_ellipses(claim, target, set.from, (initial, velocity))
        }
    }
}

/// Returns by how much a polygonal set is too small and the first such time; `None` for a
/// sufficient set. `scale` is the scale of the velocities about their centre.
fn in_sections(
    claim: &Claim,
    target: &Target,
    from: f64,
    (initial, spells): (&ConvexPolygon, &[VelocitySpell]),
    scale: f64,
) -> Option<(String, f64)> {
    let (horizon, level) = (claim.file.horizon_s, 1.0 - claim.file.max_risk);
    let velocities = spells.iter().map(|spell| &spell.velocities);
    let normals = in_order(
        std::iter::once(initial)
            .chain(velocities)
            .flat_map(ConvexPolygon::normals),
    );
    let known = Known::of(claim, target, scale, &normals);
    let factor = scale / level;
    let ends: Vec<f64> = spells.iter().map(|spell| from + spell.until).collect();
    let mut times: Vec<f64> = (ends.iter().copied().chain(known.changes()))
        .chain([from, horizon])
        .filter(|time| (from..=horizon).contains(time))
        .collect();
    times.sort_by(f64::total_cmp);
    let starts = std::iter::once(from).chain(ends.iter().copied());
    let rates: Vec<Vec<f64>> = (spells.iter().zip(starts.zip(&ends)))
        .map(|(spell, (start, end))| {
            // The centroid of a narrow level set is not that of the whole set, to rounding.
            let middle = 0.5 * (start + end.min(horizon));
            let center = known.center_at(middle);
            let center = center.unwrap_or_else(|| spell.velocities.centroid());
            scaled_about(&spell.velocities, center, factor).supports(&normals)
        })
        .collect();
    let mut section = initial.supports(&normals);
    let mut wanted = known.at(from);
    let (mut here, mut slab) = (from, 0);
    for time in times {
        let before = std::mem::replace(&mut wanted, known.at(time));
        let short = largest((0..normals.len()).flat_map(|k| {
            let step = (time - here) * rates[slab][k];
            section[k] += step;
            // An oversized initial set does not compensate for a velocity set that is too small.
            [wanted[k] - section[k], wanted[k] - before[k] - step]
        }));
        here = time;
        while slab + 1 < ends.len() && ends[slab] <= time {
            slab += 1;
        }
        let rounding = known.rounding(&wanted, time, factor);
        // Negated on purpose: a NaN counts as too small.
        if !(short <= rounding && rounding.is_finite()) {
            let ship = matches!(target.motion, Motion::Ship(_));
            let part = match (time > from, ship) {
                (false, _) if from > 0.0 => LEFT,
                (false, true) => HULL,
                (false, false) => INITIAL,
                (true, _) if scale < 1.0 => LEVEL,
                (true, true) => VELOCITIES,
                (true, false) => VELOCITY,
            };
            let what = format!("too small for {part}: by {short:.3e} m");
            return Some((what, time));
        }
    }
    None
}

/// Like [`in_sections`], for ellipses by their two parts. If each part contains its known part, the
/// obstacle, which is an outer set of the sum, contains the known sum.
fn of_ellipses(
    claim: &Claim,
    target: &Target,
    from: f64,
    (initial, velocity): (&Ellipse, &Ellipse),
) -> Vec<(String, f64)> {
    let level = 1.0 - claim.file.max_risk;
    let whole = velocity.scaled_about_center(level.recip());
    let ship = matches!(target.motion, Motion::Ship(_));
    let mut lacks = Vec::new();
    let mut need = |what: &str, short: f64| {
        // Negated on purpose: a NaN counts as too small.
        if !(short <= tolerance::DEPTH_M) {
            lacks.push((format!("too small for {what}: by {short:.3e}"), from));
        }
    };
    if from > 0.0 {
        let normals = in_order(sampled_directions(initial));
        let known = Known::of(claim, target, 1.0, &normals).at(from);
        let short = normals
            .iter()
            .zip(known)
            .map(|(n, want)| want - initial.support(*n));
        need(LEFT, largest(short));
    } else {
        let short = match &target.motion {
            Motion::Ship(ship) => {
                let hull = TurnedHull::of(ship, claim.file.horizon_s);
                let corners = hull.outer_points(TANGENT_SPACING);
                largest(corners.map(|p| initial.signed_distance(p).distance)) + reach(claim, ship)
            }
            Motion::Sets { initial: known, .. } | Motion::Spells { initial: known, .. } => {
                beyond_polygon(initial, known)
            }
            Motion::Ellipses { initial: known, .. } => beyond_ellipse(initial, known),
        };
        need(if ship { HULL } else { INITIAL }, short);
    }
    // The ellipse around a scaled polygon has a centre of its own, so it cannot be scaled back.
    if level == 1.0 || claim.file.optimal_control.is_none() {
        let short = match &target.motion {
            Motion::Ship(ship) => {
                let points = outer_velocities(ship, claim.file.horizon_s).into_iter();
                largest(points.map(|p| whole.signed_distance(p).distance))
            }
            Motion::Sets { velocity, .. } => beyond_polygon(&whole, velocity),
            Motion::Spells { spells, .. } => {
                largest(spells.iter().map(|s| beyond_polygon(&whole, &s.velocities)))
            }
            Motion::Ellipses { velocity, .. } => beyond_ellipse(&whole, velocity),
        };
        need(if ship { VELOCITIES } else { VELOCITY }, short);
    }
    if level < 1.0 {
        let short = match &target.motion {
            Motion::Ellipses {
                velocity: known, ..
            } => beyond_ellipse(velocity, &known.scaled_about_center(level)),
            _ => {
                let known = at_level(target, level, claim.file.horizon_s);
                largest(
                    known
                        .iter()
                        .map(|s| beyond_polygon(velocity, &s.velocities)),
                )
            }
        };
        need(LEVEL, short);
    }
    lacks
}

/// Largest distance of a polygon's vertices outside an ellipse.
fn beyond_polygon(set: &Ellipse, known: &ConvexPolygon) -> f64 {
    largest(
        known
            .vertices()
            .iter()
            .map(|p| set.signed_distance(*p).distance),
    )
}

/// Largest excess of one ellipse's support over another's, in the directions of
/// [`sampled_directions`].
fn beyond_ellipse(set: &Ellipse, known: &Ellipse) -> f64 {
    largest(sampled_directions(set).map(|n| known.support(n) - set.support(n)))
}

/// The largest value; NaN if any value is NaN.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, |most, v| {
        if v > most || v.is_nan() { v } else { most }
    })
}

/// Scales a polygon about its centroid, as a level of risk scales a velocity set.
pub(super) fn about_centroid(set: &ConvexPolygon, factor: f64) -> ConvexPolygon {
    scaled_about(set, set.centroid(), factor)
}

/// Scales a polygon about a point; unchanged by the factor 1.
pub(super) fn scaled_about(set: &ConvexPolygon, center: Vector, factor: f64) -> ConvexPolygon {
    if factor == 1.0 {
        set.clone()
    } else {
        set.translated(-center).scaled(factor).translated(center)
    }
}

/// Evenly spaced unit vectors, and the normals of an ellipse at points around it. For a thin
/// ellipse, nearly all normals are perpendicular to its long axis.
pub(super) fn sampled_directions(ellipse: &Ellipse) -> impl Iterator<Item = Vector> {
    let [a, b] = ellipse.semi_axes();
    let step = std::f64::consts::TAU / SAMPLED_DIRECTIONS as f64;
    (0..SAMPLED_DIRECTIONS).flat_map(move |k| {
        let z = direction(step * k as f64);
        let tangent = b * z.x - a * z.y;
        let normal = tangent.try_normalize(0.0).map(to_port);
        [Some(z), normal].into_iter().flatten()
    })
}
