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
use super::reached::{Known, TANGENT_SPACING, at_level, in_order, outer_velocities, reach, widest};
use searoom_evaluation::{SpaceTimeSet, TurnedHull, Violation, shape_rounding};
use searoom_geometry::frame::{Vector, direction, to_port};
use searoom_geometry::tolerance;
use searoom_geometry::{ConvexPolygon, ConvexSet, Ellipse};
use searoom_model::PlannerKind;
use searoom_model::target::{Motion, Representation, Target, TimedVelocitySet};

/// Parts of the known set that a set may fail to contain.
const HULL: &str = "the hull, the margin and the uncertainty";
const VELOCITIES: &str = "the velocities of the target";
const INITIAL: &str = "the initial set";
const VELOCITY: &str = "the velocity set";
/// Fraction of its width to which the centre of a smallest ellipse is known: those around the same
/// polygon, less its last digits, differ by so much.
const CENTRE: f64 = 1e-7;

/// Fraction of its size to which the places of an explicit set are held, docs/reference/verify.md.
const KNOWN_TO: f64 = 1e-9;

const LEVEL: &str = "the velocities at the accepted risk";
const LEFT: &str = "the positions possible when own ship has left the set";

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
        if let Some(what) = of_another_kind(claim, target, set) {
            note(format!("set of '{name}': {what}"), 0.0);
        }
        for (what, time) in lacks(claim, target, set) {
            note(format!("set of '{name}': {what}"), time);
        }
    }
    found
}

/// Why a set is not of the kind that the target's representation asks for, if it is not.
///
/// The sets of a motion under forces are ellipses, and so are those of explicit ellipses. Polygons
/// of velocities one after another have no ellipsoid.
fn of_another_kind(claim: &Claim, target: &Target, set: &SpaceTimeSet) -> Option<String> {
    let is_changing = match &target.motion {
        Motion::Ship(ship) => ship.turn_rate > 0.0 || !ship.route.is_empty(),
        Motion::Sets(sets) => sets.velocities.len() > 1,
    };
    let explicit = target.sets();
    let is_ellipse = claim.planner == PlannerKind::OptimalControl
        || explicit.is_some_and(|sets| sets.initial.as_ellipse().is_some())
        || target.representation == Representation::Ellipsoid && !is_changing;
    let word = |is_ellipse: bool| if is_ellipse { "ellipses" } else { "polygons" };
    let found = set.sets.initial.as_ellipse().is_some();
    (found != is_ellipse).then(|| {
        format!(
            "found {}; allowed with representation '{}': {}",
            word(found),
            target.representation,
            word(is_ellipse)
        )
    })
}

/// Describes each part of a target's known set that the set does not contain, with the first time.
fn lacks(claim: &Claim, target: &Target, set: &SpaceTimeSet) -> Vec<(String, f64)> {
    let level = 1.0 - claim.file.max_risk;
    match &set.sets.initial {
        ConvexSet::Polygon(initial) => {
            let mut scales = vec![level];
            // The set around a scaled polygon has a centre of its own, so it cannot be scaled back.
            // Explicit sets are known as they are: the first check is complete.
            let ship = target.ship().is_some();
            if level < 1.0 && ship && claim.file.optimal_control.is_none() {
                scales.push(1.0);
            }
            let short = |scale| in_sections(claim, target, set, initial, scale);
            scales.into_iter().filter_map(short).collect()
        }
        ConvexSet::Ellipse(initial) => of_ellipses(claim, target, set, initial),
    }
}

/// Returns by how much a polygonal set is too small and the first such time; `None` for a
/// sufficient set. `scale` is the scale of the velocities about their centre.
fn in_sections(
    claim: &Claim,
    target: &Target,
    set: &SpaceTimeSet,
    initial: &ConvexPolygon,
    scale: f64,
) -> Option<(String, f64)> {
    let (horizon, level) = (claim.file.horizon_s, 1.0 - claim.file.max_risk);
    let from = set.from;
    let sets = &set.sets.velocities;
    // The sets of a document are of one kind.
    let velocities: Option<Vec<&ConvexPolygon>> = sets
        .iter()
        .map(|timed| timed.velocities.as_polygon())
        .collect();
    let Some(velocities) = velocities else {
        return Some((
            format!("too small for {VELOCITY}: a polygon with an ellipse"),
            from,
        ));
    };
    let normals = in_order(
        std::iter::once(initial)
            .chain(velocities.iter().copied())
            .flat_map(ConvexPolygon::normals),
    );
    let known = Known::of(claim, target, scale, &normals);
    let factor = scale / level;
    let ends: Vec<f64> = sets.iter().map(|timed| from + timed.until).collect();
    let mut times: Vec<f64> = (ends.iter().copied().chain(known.changes()))
        .chain([from, horizon])
        .filter(|time| (from..=horizon).contains(time))
        .collect();
    times.sort_by(f64::total_cmp);
    let starts = std::iter::once(from).chain(ends.iter().copied());
    let rates: Vec<Vec<f64>> = (velocities.iter().zip(starts.zip(&ends)))
        .map(|(polygon, (start, end))| {
            // The centroid of a narrow level set is not that of the whole set, to rounding.
            let middle = 0.5 * (start + end.min(horizon));
            let center = known.center_at(middle);
            let center = center.unwrap_or_else(|| polygon.centroid());
            scaled_about(polygon, center, factor).supports(&normals)
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

/// Like [`in_sections`], for ellipses by their parts. If each part contains its known part, the
/// obstacle, which is an outer set of the sum, contains the known sum.
fn of_ellipses(
    claim: &Claim,
    target: &Target,
    set: &SpaceTimeSet,
    initial: &Ellipse,
) -> Vec<(String, f64)> {
    let (from, level) = (set.from, 1.0 - claim.file.max_risk);
    let horizon = claim.file.horizon_s;
    let ship = matches!(target.motion, Motion::Ship(_));
    let mut lacks = Vec::new();
    let mut need = |what: &str, short: f64| {
        // Negated on purpose: a NaN counts as too small.
        if !(short <= tolerance::DEPTH_M) {
            lacks.push((format!("too small for {what}: by {short:.3e} m"), from));
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
                let (reach, places) = reach(claim, ship);
                let corners = hull.outer_points(TANGENT_SPACING);
                let places = corners.flat_map(|p| places.vertices().iter().map(move |at| p + at));
                largest(places.map(|p| initial.signed_distance(p).distance)) + reach
            }
            Motion::Sets(known) => {
                // by the size of what is known, as the size of what is claimed may be anything
                let across = match &known.initial {
                    ConvexSet::Polygon(known) => known.across(),
                    ConvexSet::Ellipse(known) => widest(known),
                };
                beyond(initial, &known.initial) - KNOWN_TO * across
            }
        };
        need(if ship { HULL } else { INITIAL }, short);
    }
    // The ellipse around a scaled polygon has a centre of its own, so it cannot be scaled back.
    if level == 1.0 || claim.file.optimal_control.is_none() {
        let scale = level.recip();
        let short = match &target.motion {
            Motion::Ship(ship) => largest(set.sets.velocities.iter().map(|timed| {
                let Some(whole) = timed.velocities.as_ellipse() else {
                    return f64::NAN;
                };
                let whole = whole.scaled_about_center(scale);
                let points = outer_velocities(ship, horizon).into_iter();
                let short = largest(points.map(|p| whole.signed_distance(p).distance));
                (short - rounding_of(&whole)) * horizon
            })),
            Motion::Sets(known) => velocities_beyond(set, &known.velocities, scale, horizon),
        };
        need(if ship { VELOCITIES } else { VELOCITY }, short);
    }
    if level < 1.0 {
        let known = at_level(target, level, horizon);
        let ellipses = set
            .sets
            .velocities
            .iter()
            .filter_map(|t| t.velocities.as_ellipse());
        let across = largest(ellipses.map(widest));
        let allowed = CENTRE * across * horizon;
        need(
            LEVEL,
            velocities_beyond(set, &known, 1.0, horizon) - allowed,
        );
    }
    lacks
}

/// Distance by which known velocities can exceed the velocity ellipses of a set until the horizon,
/// metres: the excess at each time, beyond the rounding of shape matrices, times its duration. The
/// ellipses are scaled by `scale` about their centres.
fn velocities_beyond(
    set: &SpaceTimeSet,
    known: &[TimedVelocitySet],
    scale: f64,
    horizon: f64,
) -> f64 {
    let mut excess = 0.0;
    let mut start = set.from;
    for timed in &set.sets.velocities {
        let end = (set.from + timed.until).min(horizon);
        let Some(ellipse) = timed.velocities.as_ellipse() else {
            return f64::NAN;
        };
        let ellipse = ellipse.scaled_about_center(scale);
        let mut known_start: f64 = 0.0;
        for known in known {
            let overlap = end.min(known.until) - start.max(known_start);
            known_start = known.until;
            let short = beyond(&ellipse, &known.velocities) - rounding_of(&ellipse);
            // Negated on purpose: a NaN is included.
            if overlap > 0.0 && !(short <= 0.0) {
                excess += overlap * short;
            }
        }
        start = end;
    }
    excess
}

/// Largest change of an ellipse's support by the rounding of its shape matrix.
fn rounding_of(ellipse: &Ellipse) -> f64 {
    let [long, short] = ellipse.semi_axes().map(|axis| axis.norm());
    shape_rounding(long, short)
}

/// Largest distance by which a set extends beyond an ellipse.
fn beyond(set: &Ellipse, known: &ConvexSet) -> f64 {
    match known {
        ConvexSet::Polygon(known) => beyond_polygon(set, known),
        ConvexSet::Ellipse(known) => beyond_ellipse(set, known),
    }
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
