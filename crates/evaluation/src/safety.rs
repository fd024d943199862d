//! Classifies what a motion enters: sets, hulls or land. This is independent of verification.

use super::{Least, MovingSlabs, Piece, Request, Violation};
use searoom_geometry::tolerance;

/// Worst region that a motion enters from start to arrival, in ascending order of severity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Safety {
    /// Enters no hard set, no hull and no land.
    Safe,
    /// Enters a hard set, but neither its level set of the accepted risk nor a hull.
    AtRisk,
    /// Enters a hull that a target may have, a hard set without a retained level set, or the margin
    /// to land. Also a motion outside own ship's limits, and any case without proof.
    Unsafe,
    /// Enters land, or the hull of a target that keeps course and speed.
    Collides,
}

impl Safety {
    /// Safety of a motion that is within own ship's limits (`sound`) or not.
    pub(super) fn of_motion(sound: bool) -> Self {
        if sound { Self::Safe } else { Self::Unsafe }
    }

    /// Safety of a motion with this least distance to land.
    pub(super) fn of_land(least: &Least, request: &Request) -> Self {
        // Negated on purpose: a NaN counts as aground.
        if !(least.value >= -tolerance::DEPTH_M) {
            Self::Collides
        } else if grounding(least, request.land_margin).is_some() {
            Self::Unsafe
        } else {
            Self::Safe
        }
    }
}

/// Violation of the land margin by a least distance, if any.
pub(super) fn grounding(least: &Least, margin: f64) -> Option<Violation> {
    let allowed = margin - tolerance::DEPTH_M;
    // Negated on purpose: a NaN counts as aground.
    let what = if !(least.value >= allowed) {
        format!(
            "land: own hull at {:.6e} m, allowed {allowed:.6e}",
            least.value
        )
    } else if !least.certified {
        "land: distance not proven within the budget of the check".to_owned()
    } else {
        return None;
    };
    Some(Violation::new(what, least.time))
}

/// Violation of a set by a motion with this least distance, if any. While the sections are too
/// narrow for the allowed depth, a distance below the tolerance is a violation.
pub(super) fn entered<P: Piece>(
    label: &str,
    slabs: &MovingSlabs,
    pieces: &[P],
    least: &Least,
) -> Option<Violation> {
    collision(label, least, slabs.edge(least.time)).or_else(|| {
        let narrow = slabs.least_distance_while_narrow(pieces);
        collision(label, &narrow, -tolerance::DEPTH_M)
    })
}

/// Violation of a set or a hull by a least distance, if any. `depth` is the allowed depth.
pub(super) fn collision(label: &str, least: &Least, depth: f64) -> Option<Violation> {
    let allowed = -depth;
    let what = if !(least.value >= allowed) {
        format!(
            "{label}: distance {:.6e} m, allowed {allowed:.0e}",
            least.value
        )
    } else if !least.certified {
        format!("{label}: clearance not proven within the budget of the check")
    } else {
        return None;
    };
    Some(Violation::new(what, least.time))
}

/// Result of the checks against the sets of one target.
pub(super) struct Claim {
    /// Least distance to the sets.
    pub margin: Least,
    /// Time from which the sets are valid, seconds.
    pub from: f64,
    sets: usize,
    kept: bool,
}

impl Claim {
    /// Result for a target without a set.
    pub fn new() -> Self {
        Self {
            margin: Least::new(),
            from: 0.0,
            sets: 0,
            kept: true,
        }
    }

    /// Adds the result of one set.
    pub fn see(&mut self, least: &Least, kept: bool, from: f64) {
        self.margin.see(least.value, least.time);
        self.from = self.from.max(from);
        self.sets += 1;
        self.kept &= kept;
    }

    /// Safety with respect to a ship.
    ///
    /// `closest` is the distance from the target's hull at constant course and speed. `worst` is
    /// the distance from any hull that it may have, and `centre` the distance of own ship's centre
    /// from these. The hard set contains all positions where own hull, on any heading, would be
    /// nearer than the margin.
    pub fn of_ship(
        &self,
        request: &Request,
        [closest, worst]: [&Least; 2],
        centre: impl FnOnce() -> Least,
    ) -> Safety {
        // Negated on purpose: a NaN counts as a collision.
        if !(closest.value >= -tolerance::DEPTH_M) {
            return Safety::Collides;
        }
        if collision("", worst, tolerance::DEPTH_M).is_some() {
            return Safety::Unsafe;
        }
        self.of_hard_set(request, || {
            let mut least = centre();
            least.value -= request.own.hull.half_diagonal() + request.own.safety_margin;
            collision("", &least, tolerance::DEPTH_M).is_none()
        })
    }

    /// Safety with respect to the hard set of a target, by whether the motion is `clear` of it.
    pub fn of_hard_set(&self, request: &Request, clear: impl FnOnce() -> bool) -> Safety {
        if self.from > 0.0 {
            return Safety::Unsafe;
        }
        let kept = self.sets > 0 && self.kept;
        // A full set contains the hard set.
        if kept && request.max_risk == 0.0 || clear() {
            Safety::Safe
        } else if kept {
            Safety::AtRisk
        } else {
            Safety::Unsafe
        }
    }
}
