//! Classifies what a motion enters: sets, hulls or land. This is independent of verification.

use super::{Least, MovingSlabs, Piece, Request, Violation};
use crate::tolerance;

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

#[cfg(test)]
mod tests {
    use super::Safety;
    use crate::evaluation::{Evaluation, Freedom, Request, SpaceTimeSet, evaluate};
    use crate::frame::Vector;
    use crate::geometry::fixtures::places;
    use crate::geometry::{ConvexPolygon, Polygon};
    use crate::scenario::Scenario;
    use crate::target::{Motion, Uncertainty};
    use crate::trajectory::Segment;

    /// Scenario in which own ship moves 1500 m along the path and passes a target at rest half-way.
    /// The centres are `north` metres apart there. The half-beams are 4 m and 6 m, half of own
    /// diagonal is 15.524 m, and the margin is 20 m.
    struct Scene {
        scenario: Scenario,
        held: Segment,
    }

    fn scene(north: f64, spread_m: f64) -> Scene {
        let text = format!(
            r#"title = "abeam"
            horizon_s = 400.0
            own_ship = {{ position = {{ east_m = 0, north_m = 0 }}, course_deg = 90, speed_mps = 5, length_m = 30, beam_m = 8,
                turning_radius_m = 100, safety_margin_m = 20 }}
            mission = {{ waypoints = [{{ east_m = 0, north_m = 0 }}, {{ east_m = 1500, north_m = 0 }}] }}
            targets = [{{ name = "t", position = {{ east_m = 750, north_m = {north} }}, course_deg = 90, speed_mps = 0,
                length_m = 60, beam_m = 12, position_std_m = {spread_m} }}]"#
        );
        let scenario = Scenario::parse(&text).expect("valid");
        let held = Segment::straight(scenario.own_ship.pose, 0.0, 300.0, 5.0);
        Scene { scenario, held }
    }

    fn box_around(half: f64) -> ConvexPolygon {
        ConvexPolygon::rectangle(Vector::new(750.0, 60.0), half, half)
    }

    /// Evaluates the motion with these sets, risk, land and land margin.
    fn judged(
        scene: &Scene,
        sets: &[SpaceTimeSet],
        max_risk: f64,
        land: &[Polygon],
        land_margin: f64,
    ) -> Evaluation {
        let Scene { scenario, held } = scene;
        evaluate(&Request {
            freedom: Freedom::Any,
            targets: &scenario.targets,
            sets,
            land,
            land_margin,
            max_risk,
            ..Request::new(
                std::slice::from_ref(held),
                &scenario.own_ship,
                &scenario.desired,
                scenario.horizon,
            )
        })
    }

    /// The limits do not depend on the sets. They are 10 m for the nominal hull, 10 m plus three
    /// standard deviations for any hull, and 41.524 m for the hard set.
    #[test]
    fn what_is_entered_is_told_to_the_millimetre() {
        for (north, spread_m, expected) in [
            (9.999, 0.0, Safety::Collides),
            (10.001, 0.0, Safety::Unsafe),
            (10.001, 5.0, Safety::Unsafe),
            (41.523, 0.0, Safety::Unsafe),
            (41.525, 0.0, Safety::Safe),
            (41.525, 0.1, Safety::Unsafe),
            (41.850, 0.1, Safety::Safe),
        ] {
            let found = judged(&scene(north, spread_m), &[], 0.0, &[], 0.0);
            assert_eq!(found.safety, expected, "{north} m, {spread_m} m");
            assert_eq!(found.safe(), expected == Safety::Safe);
        }
    }

    /// At an accepted risk, the hard set may be entered if its level set is retained. A released
    /// set is never retained.
    #[test]
    fn an_accepted_risk_is_told_from_a_set_of_which_nothing_is_kept() {
        let scene = scene(30.0, 0.0);
        let far = box_around(10.0);
        let near = box_around(70.0);
        let still = ConvexPolygon::point(Vector::zeros());
        for (set, max_risk, from, expected) in [
            (&far, 0.3, 0.0, Safety::AtRisk),
            (&near, 0.3, 0.0, Safety::Unsafe),
            (&far, 0.3, 10.0, Safety::Unsafe),
        ] {
            let sets = [SpaceTimeSet {
                from,
                ..SpaceTimeSet::constant("t", set.clone(), still.clone())
            }];
            let found = judged(&scene, &sets, max_risk, &[], 0.0);
            assert_eq!(found.safety, expected, "{max_risk}, {from}");
        }
    }

    /// An explicit set is the hard set.
    #[test]
    fn a_set_that_is_given_is_entered_or_not() {
        for (half, expected) in [(59.0, Safety::Safe), (61.0, Safety::Unsafe)] {
            let mut scene = scene(60.0, 0.0);
            let still = ConvexPolygon::point(Vector::zeros());
            let sets = Uncertainty::constant(box_around(half), still);
            scene.scenario.targets[0].motion = Motion::Sets(sets);
            let found = judged(&scene, &[], 0.0, &[], 0.0);
            assert_eq!(found.safety, expected, "{half} m");
        }
    }

    /// Land or its margin is entered. A motion outside own ship's limits, or with a NaN, is never
    /// safe.
    #[test]
    fn land_and_motions_that_are_none_are_told() {
        let mut scene = scene(500.0, 0.0);
        let outline = places(&[(700.0, 14.0), (800.0, 14.0), (750.0, 90.0)]);
        let land = [Polygon::new(&[outline]).expect("a polygon")];
        for (margin, expected) in [(9.9, Safety::Safe), (10.1, Safety::Unsafe)] {
            let found = judged(&scene, &[], 0.0, &land, margin);
            assert_eq!(found.safety, expected, "{margin} m");
        }
        scene.scenario.own_ship.pose.position.y = 12.0;
        scene.held.start.position.y = 12.0;
        let aground = judged(&scene, &[], 0.0, &land, 0.0);
        assert_eq!(aground.safety, Safety::Collides);
        scene.held.start.position.x += 1.0;
        let elsewhere = judged(&scene, &[], 0.0, &[], 0.0);
        assert_eq!(elsewhere.safety, Safety::Unsafe);
        scene.held.duration = f64::NAN;
        assert!(!judged(&scene, &[], 0.0, &[], 0.0).safe());
    }
}
