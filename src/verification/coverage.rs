//! Are the sets large enough for what is known of the targets?
//!
//! A tracked ship's set has to contain its hull, on every heading that it may have until the
//! horizon, ⊕ a disc of own half-diagonal, safety margin and three standard deviations of its
//! position, and every place that it may come to at a speed and a course within the spreads, turned
//! as far as it may have turned. Explicit sets have to be contained as they are. Where risk was
//! accepted, the set of the level has to hold what is known of her scaled to that level, and the
//! set scaled back all of it.
//!
//! Polygons are compared by their sections. How far a section reaches in a direction is linear in
//! time between two changes of its velocities, and how far a target may have come in it linear too,
//! or convex where she turns: what is contained at the changes, at the start and at the horizon is
//! contained always, however short or fast a slab is.

use super::claim::Claim;
use super::reached::{Known, TANGENT_SPACING, at_level, in_order, outer_velocities, reach};
use crate::evaluation::{SetShape, SpaceTimeSet, TurnedHull, Violation};
use crate::frame::{Vector, direction, to_port};
use crate::geometry::{ConvexPolygon, Ellipse};
use crate::target::{Motion, Target, VelocitySpell};
use crate::tolerance;

/// What a set may be too small for.
const HULL: &str = "the hull, the margin and the uncertainty";
const VELOCITIES: &str = "her velocities";
const INITIAL: &str = "the initial set";
const VELOCITY: &str = "the velocity set";
const LEVEL: &str = "the velocities at the accepted risk";
const LEFT: &str = "where she may be when it has been left";

/// Places around an ellipse at which it is compared with an ellipse.
pub(super) const SAMPLED_DIRECTIONS: usize = 720;

/// Every target without a set of her own, or with one that is too small; every set of nobody.
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

/// What a set lacks of a target, and from when.
fn lacks(claim: &Claim, target: &Target, set: &SpaceTimeSet) -> Vec<(String, f64)> {
    let level = 1.0 - claim.file.max_risk;
    match &set.shape {
        SetShape::Polygons { initial, spells } => {
            let mut scales = vec![level];
            // the set around a polygon that was scaled has a centre of its own: it cannot be scaled
            // back
            if level < 1.0 && claim.file.optimal_control.is_none() {
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

/// By how much a set is too small, and when first: nothing where it is not. `scale` is that of the
/// velocities about their centre.
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
    let rates: Vec<Vec<f64>> = (spells.iter())
        .map(|spell| about_centroid(&spell.velocities, factor).supports(&normals))
        .collect();
    let mut section = initial.supports(&normals);
    let mut wanted = known.at(from);
    let (mut here, mut slab) = (from, 0);
    for time in times {
        let before = std::mem::replace(&mut wanted, known.at(time));
        let short = largest((0..normals.len()).flat_map(|k| {
            let step = (time - here) * rates[slab][k];
            section[k] += step;
            // no slab lives on what the initial set is larger than it has to be
            [wanted[k] - section[k], wanted[k] - before[k] - step]
        }));
        here = time;
        while slab + 1 < ends.len() && ends[slab] <= time {
            slab += 1;
        }
        let rounding = known.rounding(&wanted, time, factor);
        // negated on purpose: a NaN is too small
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

/// The same for ellipses, by their two parts: the sum that is kept out of contains the sum of what
/// these contain.
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
        // negated on purpose: a NaN is too small
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
    // the ellipse around a polygon that was scaled has a centre of its own: it cannot be scaled
    // back
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

/// How far the farthest point of a polygon is outside an ellipse.
fn beyond_polygon(set: &Ellipse, known: &ConvexPolygon) -> f64 {
    largest(
        known
            .vertices()
            .iter()
            .map(|p| set.signed_distance(*p).distance),
    )
}

/// How far an ellipse reaches outside another, in the directions of [`sampled_directions`].
fn beyond_ellipse(set: &Ellipse, known: &Ellipse) -> f64 {
    largest(sampled_directions(set).map(|n| known.support(n) - set.support(n)))
}

/// The largest, NaN if any is.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, |most, v| {
        if v > most || v.is_nan() { v } else { most }
    })
}

/// A polygon scaled about its centroid: what a level of risk does to a velocity set.
pub(super) fn about_centroid(set: &ConvexPolygon, factor: f64) -> ConvexPolygon {
    let center = set.centroid();
    set.translated(-center).scaled(factor).translated(center)
}

/// Unit vectors all around, evenly, and the normals of an ellipse at places all around it: where it
/// is a needle, nearly all are across.
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
