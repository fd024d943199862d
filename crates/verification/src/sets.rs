//! Assembles the sets of a document from entries with successive velocity sets.

use super::claim::{ClaimError, fault, placed};
use super::coverage::{largest, sampled_directions};
use super::reached::{in_order, widest};
use nalgebra::Matrix2;
use searoom_document::{ObstacleDocument, RelaxationDocument};
use searoom_evaluation::{SpaceTimeSet, Violation};
use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance;
use searoom_geometry::{ConvexPolygon, ConvexSet, Ellipse};
use searoom_model::target::{TimedVelocitySet, Uncertainty};

/// Reads the sets, and reports inconsistent entries of one name.
///
/// Each entry is valid until the next one starts, with the section reached then, and the last one
/// until the horizon. The first one starts at 0, or at the release of a set that is entered.
pub(super) fn read(
    entries: &[ObstacleDocument],
    relaxations: &[RelaxationDocument],
    horizon: f64,
) -> Result<(Vec<SpaceTimeSet>, Vec<Violation>), ClaimError> {
    let mut sets: Vec<SpaceTimeSet> = Vec::new();
    let mut faults = Vec::new();
    let mut until = 0.0;
    let mut section: Option<ConvexSet> = None;
    for (index, entry) in entries.iter().enumerate() {
        let path = format!("obstacles[{index}]");
        let [from, to] = entry.valid_s;
        let follows = index > 0 && entries[index - 1].name == entry.name;
        let released = released(relaxations, &entry.name);
        // A set that is not released before the horizon is never valid.
        let never = released.is_some() && from == to && from == horizon;
        if !(from < to || never) {
            let (path, found) = (format!("{path}.valid_s"), format!("{from} to {to}"));
            return Err(fault(&path, found, "a start before an end"));
        }
        let mut note = |what: String, time: f64| {
            let what = format!("set of '{}': {what}", entry.name);
            faults.push(Violation { what, time });
        };
        let starts = if follows {
            until
        } else {
            released.unwrap_or(0.0).min(horizon)
        };
        if from != starts {
            let what = format!("valid from {from} s, expected {starts} s");
            note(what, from.min(starts));
        }
        let next = entries.get(index + 1);
        let last = next.is_none_or(|next| next.name != entry.name);
        if last && !((to - horizon).abs() <= tolerance::TIME_S * (1.0 + horizon)) {
            let what = format!("valid until {to} s, expected the horizon, {horizon} s");
            note(what, to);
        }
        let initial = placed(&format!("{path}.initial_set"), entry.initial_set.set())?;
        let velocity = placed(&format!("{path}.velocity_set"), entry.velocity_set.set())?;
        let is_polygon = |set: &ConvexSet| set.as_polygon().is_some();
        let before = section.as_ref().filter(|_| follows);
        let mut others = std::iter::once(&velocity).chain(before);
        if others.any(|set| is_polygon(set) != is_polygon(&initial)) {
            let found = "a polygon with an ellipse";
            return Err(fault(&path, found, "sets of one kind"));
        }
        if follows && !section.as_ref().is_some_and(|s| same(s, &initial)) {
            let what = "a slab does not begin with the final section of the previous one";
            note(what.to_owned(), from);
        }
        section = section_after(&initial, &velocity, to - from);
        let until_local = if last {
            f64::INFINITY
        } else {
            to - released.unwrap_or(0.0)
        };
        let timed = TimedVelocitySet::new(until_local, velocity);
        until = to;
        if let (true, Some(set)) = (follows, sets.last_mut()) {
            set.sets.velocities.push(timed);
            continue;
        }
        sets.push(SpaceTimeSet {
            name: entry.name.clone(),
            from: released.unwrap_or(0.0),
            sets: Uncertainty::new(initial, vec![timed]),
        });
    }
    Ok((sets, faults))
}

/// Section of a slab at its end: the Minkowski sum of polygons, or the ellipse of least trace
/// around the sum of ellipses.
fn section_after(initial: &ConvexSet, velocity: &ConvexSet, duration: f64) -> Option<ConvexSet> {
    Some(match (initial, velocity) {
        (ConvexSet::Ellipse(initial), ConvexSet::Ellipse(velocity)) => {
            least_trace_sum([(initial, 1.0), (velocity, duration)])?.into()
        }
        _ => {
            let slab = Uncertainty::constant(initial.clone(), velocity.clone());
            slab.outer_section(duration).into()
        }
    })
}

/// Ellipse of least trace around a sum of ellipses with factors (docs/reference/theory.md 3).
fn least_trace_sum(terms: [(&Ellipse, f64); 2]) -> Option<Ellipse> {
    let (mut center, mut shape, mut sum) = (Vector::zeros(), Matrix2::zeros(), 0.0);
    for (ellipse, factor) in terms {
        let scaled = ellipse.shape() * (factor * factor);
        let root = scaled.trace().sqrt();
        // Negated on purpose: a NaN is included.
        if !(root <= 0.0) {
            shape += scaled / root;
            sum += root;
        }
        center += ellipse.center() * factor;
    }
    Ellipse::new(center, shape * sum).ok()
}

/// Release time of a set that is entered, seconds. The set is valid from then on.
pub(super) fn released(relaxations: &[RelaxationDocument], name: &str) -> Option<f64> {
    let mut own = relaxations.iter().filter(|r| r.target == name);
    own.find_map(|r| r.until_s)
}

/// Returns true if the sets have equal supports, to the tolerance of equal sets.
fn same(a: &ConvexSet, b: &ConvexSet) -> bool {
    let (normals, across) = match (a, b) {
        (ConvexSet::Polygon(a), ConvexSet::Polygon(b)) => {
            let normals = [a, b].into_iter().flat_map(ConvexPolygon::normals);
            (in_order(normals), a.across())
        }
        (ConvexSet::Ellipse(a), ConvexSet::Ellipse(b)) => {
            let normals = sampled_directions(a).chain(sampled_directions(b));
            (normals.collect(), widest(a))
        }
        _ => return false,
    };
    let apart = |n: &Vector| (a.support(*n) - b.support(*n)).abs();
    let apart = largest(normals.iter().map(apart));
    apart <= tolerance::DEPTH_M.max(tolerance::COLLINEAR_RAD * across)
}
