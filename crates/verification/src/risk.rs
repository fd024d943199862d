//! Checks the risks of a document against its motion.
//!
//! A motion takes the risk `r` of a set if it enters the level set of `r` and no level set of a
//! greater risk. The velocities of the level set are scaled by `1 - r` about their centre. The
//! reported risk is therefore checked from both sides: slightly above it, the motion is clear of
//! the level set; slightly below it, the motion is not, at the reported time.

use super::claim::{Claim, ClaimedMotion};
use super::coverage::largest;
use super::figures::near;
use super::mismatch;
use super::motion::around;
use searoom_document::{EncounterDocument, RelaxationKind};
use searoom_evaluation::{MovingSlabs, Request, SpaceTimeSet, Violation, least_margins};
use searoom_geometry::ConvexPolygon;
use searoom_geometry::frame::direction;
use searoom_geometry::tolerance;
use searoom_model::target::Motion;
use searoom_model::trajectory::Segment;

/// Kind of the relaxation where risk is taken.
const KIND: RelaxationKind = RelaxationKind::Risk;

/// Reported risk of an encounter; NaN without one.
fn said(encounter: &EncounterDocument) -> f64 {
    encounter.max_risk.unwrap_or(f64::NAN)
}

/// Largest risk of the encounters, which [`check`] proves; 0 without any.
pub(super) fn greatest_risk(claim: &Claim) -> f64 {
    let risks = claim.file.encounters.iter().map(said);
    // `f64::max` would make nothing of a NaN
    largest(std::iter::once(0.0).chain(risks))
}

/// Checks the risk and its time for each target, and the reported relaxations.
pub(super) fn check(claim: &Claim, request: &Request) -> Vec<Violation> {
    let mut found = Vec::new();
    for encounter in &claim.file.encounters {
        found.extend(bounds(claim, encounter, said(encounter)));
        found.extend(relaxation(claim, encounter, said(encounter)));
        found.extend(instant(encounter, said(encounter)));
        if let Some(ClaimedMotion::Segments(segments)) = &claim.motion {
            found.extend(taken(claim, encounter, segments, request));
        }
    }
    found
}

fn label(encounter: &EncounterDocument, key: &str) -> String {
    format!("encounter with '{}', {key}", encounter.target)
}

/// Checks that the risk is at most the accepted one; for a released set it may be up to 1.
fn bounds(claim: &Claim, encounter: &EncounterDocument, said: f64) -> Option<Violation> {
    let mut sets = claim.sets.iter();
    let released = sets.any(|set| set.name == encounter.target && set.from > 0.0);
    let accepted = if released { 1.0 } else { claim.file.max_risk };
    let within = said >= 0.0 && said <= accepted + tolerance::FIGURE;
    let so = format!("from 0 to {accepted}");
    (!within).then(|| mismatch(&label(encounter, "max_risk"), said, so))
}

/// Checks that a target whose risk is taken has a relaxation with that risk.
fn relaxation(claim: &Claim, encounter: &EncounterDocument, said: f64) -> Option<Violation> {
    let mut named = claim.file.relaxations.iter();
    let named = named.find(|r| r.kind == KIND && r.target == encounter.target);
    let what = format!("relaxation of '{}', amount", encounter.target);
    match named {
        Some(risk) if !near(risk.amount, said) => Some(mismatch(&what, risk.amount, said)),
        Some(risk) if said == 0.0 && risk.until_s.is_none() => {
            Some(mismatch(&what, risk.amount, "nothing"))
        }
        None if said > 0.0 => Some(mismatch(&what, "nothing", said)),
        _ => None,
    }
}

/// Checks that a time is given if, and only if, a risk is taken.
fn instant(encounter: &EncounterDocument, said: f64) -> Option<Violation> {
    let what = label(encounter, "max_risk_t_s");
    match encounter.max_risk_t_s {
        Some(time) if said == 0.0 => Some(mismatch(&what, time, "nothing")),
        None if said > 0.0 => Some(mismatch(&what, "nothing", "a time")),
        _ => None,
    }
}

/// Checks the risk along lines and arcs from both sides.
fn taken(
    claim: &Claim,
    encounter: &EncounterDocument,
    segments: &[Segment],
    request: &Request,
) -> Option<Violation> {
    let said = encounter.max_risk?;
    let set = claim.sets.iter().find(|s| s.name == encounter.target)?;
    let accepted = claim.file.max_risk;
    // Every full set is checked elsewhere, and a motion that is clear of it takes no risk.
    if accepted == 0.0 && set.from == 0.0 {
        return None;
    }
    if set.from > 0.0 && has_changing_velocities(claim, &encounter.target) {
        return None;
    }
    let whole = before_release(set)?;
    let margin = |risk: f64, segments: &[Segment]| {
        let sets = [scaled(&whole, (1.0 - risk).max(0.0) / (1.0 - accepted))];
        let least = least_margins(&Request {
            segments,
            sets: &sets,
            ..request.clone()
        });
        least.first().copied().unwrap_or(f64::NAN)
    };
    let what = label(encounter, "max_risk");
    // A set is closed, and the risk drops to zero beyond its edge; there is no risk above 1.
    let above = said + tolerance::FIGURE;
    if above < 1.0 && !(margin(above, segments) >= -tolerance::DEPTH_M) {
        return Some(mismatch(&what, said, "more"));
    }
    let time = encounter.max_risk_t_s?;
    let below = said - tolerance::FIGURE;
    let then: Vec<Segment> = around(segments, time)
        .map(|s| s.between(time.max(s.start_time), time.min(s.end_time())))
        .collect();
    // A set that is narrow in its first time interval was enlarged for the planner, by a polygon
    // around a disc, and for all times.
    let first = whole.sets.velocities.first()?.until;
    let narrow_at = if set.from > 0.0 { 0.0 } else { time.min(first) };
    let wide = MovingSlabs::new(&whole.sets).half_width(narrow_at) >= tolerance::HALF_WIDTH_M;
    let near = if wide {
        tolerance::DEPTH_M
    } else {
        tolerance::DEPTH_M + 1.1 * tolerance::HALF_WIDTH_M
    };
    // Negated on purpose: a NaN is not in the set.
    if below > 0.0 && !(margin(below, &then) <= near) {
        let so = format!("less at {time} s");
        return Some(Violation {
            time,
            ..mismatch(&what, said, so)
        });
    }
    None
}

/// Returns true for a target with several velocity sets in sequence: the last one does not
/// determine the earlier ones.
fn has_changing_velocities(claim: &Claim, name: &str) -> bool {
    let mut targets = claim.targets.iter().filter(|t| t.name == name);
    targets.any(|target| match &target.motion {
        Motion::Ship(ship) => ship.turn_rate > 0.0 || !ship.route.is_empty(),
        Motion::Sets(sets) => sets.velocities.len() > 1,
    })
}

/// Reconstructs a released set at t = 0 from its section at the release.
///
/// A vertex of the section is a vertex of the initial set that has moved with the extreme velocity
/// of the same direction. `None` for ellipses and for several velocity sets, which cannot be
/// reconstructed.
fn before_release(set: &SpaceTimeSet) -> Option<SpaceTimeSet> {
    if set.from == 0.0 {
        return Some(set.clone());
    }
    let initial = set.sets.initial.as_polygon()?;
    let [only] = &set.sets.velocities[..] else {
        return None;
    };
    let velocities = only.velocities.as_polygon()?;
    let normals = initial.normals();
    let headings: Vec<f64> = normals.iter().map(|n| n.y.atan2(n.x)).collect();
    let between: Vec<_> = (0..headings.len())
        .map(|k| {
            let (here, next) = (headings[k], headings[(k + 1) % headings.len()]);
            direction(here + 0.5 * (next - here).rem_euclid(std::f64::consts::TAU))
        })
        .collect();
    let both = initial
        .extremes(&between)
        .zip(velocities.extremes(&between));
    let begun: Vec<_> = both
        .map(|(place, velocity)| place - velocity * set.from)
        .collect();
    Some(SpaceTimeSet::constant(
        set.name.clone(),
        ConvexPolygon::hull(&begun).ok()?,
        velocities.clone(),
    ))
}

fn scaled(set: &SpaceTimeSet, factor: f64) -> SpaceTimeSet {
    let mut scaled = set.clone();
    for timed in &mut scaled.sets.velocities {
        timed.velocities = timed.velocities.scaled_about_center(factor);
    }
    scaled
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry_fixtures::places;

    #[test]
    fn a_set_is_what_it_was_before_it_was_left() {
        let polygon = |corners| ConvexPolygon::hull(&places(corners)).expect("finite");
        let hull = polygon(&[(0.0, 0.0), (40.0, 3.0), (40.0, 10.0), (0.0, 10.0)]);
        let velocities = polygon(&[(4.0, -0.5), (5.0, -0.6), (5.0, 0.6), (4.0, 0.5)]);
        let point = polygon(&[(3.0, 1.0)]);
        let time = 60.0;
        for (initial, velocity) in [
            (&hull, &velocities),
            (&hull, &point),
            (&point, &velocities),
            (&velocities, &hull),
        ] {
            let section = initial.minkowski_sum(&velocity.scaled(time));
            let left = SpaceTimeSet {
                from: time,
                ..SpaceTimeSet::constant("t", section, velocity.clone())
            };
            let whole = before_release(&left).expect("one velocity set");
            let found = &whole.sets.initial;
            for k in 0..90 {
                let n = direction(0.07 * f64::from(k));
                assert!((found.support(n) - initial.support(n)).abs() < 1e-9, "{n}");
            }
        }
    }
}
