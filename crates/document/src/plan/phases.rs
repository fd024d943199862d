//! Phases of a plan by the rules: free, hold, out, parallel, back (docs/guide/replanning.md).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::PlanDocument;
use super::motions::PlannedLeg;
use crate::memory::PlannedManoeuvreDocument;
use crate::parts::EscapeDocument;
use searoom_colregs::ON_COURSE;
use searoom_geometry::frame::{heading_from_course_deg, wrap};
use searoom_geometry::tolerance;

searoom_geometry::words! {
    /// Own ship's action in a part of a plan by the rules.
    pub enum Phase {
        /// Follows the mission.
        Free => "free",
        /// Stands on: keeps course and speed until its escape begins.
        Hold => "hold",
        /// Has altered course or speed for a target.
        Out => "out",
        /// Steers its first course again, beside the mission.
        Parallel => "parallel",
        /// Returns to the mission; the targets are past and clear.
        Back => "back",
    }
}

/// A phase and its time interval, seconds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PhaseDocument {
    pub phase: Phase,
    pub from_s: f64,
    pub until_s: f64,
}

impl PlanDocument {
    /// The phases that follow from the document's motion, manoeuvres and escape.
    pub fn phases_of_motion(&self) -> Vec<PhaseDocument> {
        phases(&self.motions(), &self.manoeuvres, self.escape.as_ref())
    }
}

/// The phases from the present to the end of a plan, in order; empty without a manoeuvre.
fn phases(
    legs: &[PlannedLeg],
    manoeuvres: &[PlannedManoeuvreDocument],
    escape: Option<&EscapeDocument>,
) -> Vec<PhaseDocument> {
    let Some(end) = legs.last().map(|leg| leg.motion.end_time()) else {
        return Vec::new();
    };
    let mut found: Vec<PhaseDocument> = Vec::new();
    let mut add = |phase: Phase, until: f64| {
        let from_s = found.last().map_or(0.0, |last| last.until_s);
        let until_s = until.min(end);
        if until_s > from_s + tolerance::TIME_S {
            found.push(PhaseDocument {
                phase,
                from_s,
                until_s,
            });
        }
    };
    for manoeuvre in manoeuvres {
        let holds =
            escape.is_some_and(|e| e.held_until_s >= manoeuvre.begins_s - tolerance::TIME_S);
        add(
            if holds { Phase::Hold } else { Phase::Free },
            manoeuvre.begins_s,
        );
        add(Phase::Out, parallel_from(legs, manoeuvre));
        add(Phase::Parallel, manoeuvre.returns_s);
        add(Phase::Back, manoeuvre.joins_s);
    }
    if !manoeuvres.is_empty() {
        add(Phase::Free, end);
    }
    found
}

/// When own ship is on its first course again before it returns; else the return.
fn parallel_from(legs: &[PlannedLeg], manoeuvre: &PlannedManoeuvreDocument) -> f64 {
    let first = heading_from_course_deg(manoeuvre.first_course_deg);
    let is_off = |leg: &&PlannedLeg| wrap(leg.motion.end().heading - first).abs() > ON_COURSE;
    let during = |leg: &&PlannedLeg| {
        let middle = 0.5 * (leg.motion.start_time + leg.motion.end_time());
        middle > manoeuvre.begins_s && middle < manoeuvre.returns_s
    };
    let legs = || legs.iter().filter(during);
    // the turn away lies before the present where the manoeuvre is under way
    let turned = legs().find(is_off).map(|leg| leg.motion.start_time);
    let turned = turned.or((manoeuvre.begins_s < 0.0).then_some(0.0));
    let back = legs().find(|leg| {
        turned.is_some_and(|turned| leg.motion.start_time >= turned)
            && !leg.motion.is_arc()
            && !is_off(leg)
    });
    match back {
        // less speed alone leaves no course
        Some(leg) if manoeuvre.turn_deg != 0.0 => leg.motion.start_time.max(0.0),
        _ => manoeuvre.returns_s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parts::EscapePolicy;
    use searoom_geometry::frame::{Pose, Vector};
    use searoom_model::trajectory::Segment;

    /// Legs with these courses, radians to port, until these times; an arc turns to the next one.
    fn legs(until: &[(f64, f64)]) -> Vec<PlannedLeg> {
        let mut start = 0.0;
        let legs = until.iter().map(|(heading, until)| {
            let pose = Pose::new(Vector::zeros(), *heading);
            let motion = Segment::straight(pose, start, until - start, 5.0);
            start = *until;
            PlannedLeg {
                motion,
                corner_deg: 0.0,
                because_of: None,
                events: Vec::new(),
            }
        });
        legs.collect()
    }

    fn manoeuvre(
        begins_s: f64,
        returns_s: f64,
        joins_s: f64,
        turn_deg: f64,
    ) -> PlannedManoeuvreDocument {
        PlannedManoeuvreDocument {
            begins_s,
            returns_s,
            joins_s,
            first_course_deg: 90.0,
            turn_deg,
        }
    }

    /// Word and end of each phase; each begins where the one before ends.
    fn found(
        legs: &[PlannedLeg],
        manoeuvres: &[PlannedManoeuvreDocument],
        held_until_s: Option<f64>,
    ) -> Vec<(&'static str, f64)> {
        let escape = held_until_s.map(|held_until_s| EscapeDocument {
            policy: EscapePolicy::StandOnHold,
            held_until_s,
            first_segment: 1,
            turn_deg: 0.0,
            speed_mps: 2.5,
        });
        let found = phases(legs, manoeuvres, escape.as_ref());
        let mut from = 0.0;
        for phase in &found {
            assert_eq!(phase.from_s, from);
            from = phase.until_s;
        }
        found.iter().map(|p| (p.phase.word(), p.until_s)).collect()
    }

    #[test]
    fn every_kind_of_manoeuvre_has_its_phases() {
        let turned = legs(&[
            (0.0, 20.0),
            (-0.9, 70.0),
            (0.0, 160.0),
            (0.6, 220.0),
            (0.0, 300.0),
        ]);
        let whole = manoeuvre(20.0, 160.0, 220.0, 50.0);
        let (out, parallel, back) = (("out", 70.0), ("parallel", 160.0), ("back", 220.0));
        let expected = [("free", 20.0), out, parallel, back, ("free", 300.0)];
        assert_eq!(found(&turned, &[whole], None), expected);
        // a hold that ends by a rounding before the manoeuvre begins
        let held = found(&turned, &[whole], Some(20.0 - 1e-12));
        assert_eq!(held[0], ("hold", 20.0));
        // under way: out, parallel, and on the way back
        let begun = |legs: &[(f64, f64)], returns: f64, joins: f64| {
            found(
                &self::legs(legs),
                &[manoeuvre(-30.0, returns, joins, 50.0)],
                None,
            )
        };
        let later = [(-0.9, 10.0), (0.0, 100.0), (0.6, 160.0), (0.0, 240.0)];
        let expected = [
            ("out", 10.0),
            ("parallel", 100.0),
            ("back", 160.0),
            ("free", 240.0),
        ];
        assert_eq!(begun(&later, 100.0, 160.0), expected);
        let expected = [("parallel", 90.0), ("back", 150.0), ("free", 230.0)];
        assert_eq!(
            begun(&[(0.0, 90.0), (0.6, 150.0), (0.0, 230.0)], 90.0, 150.0),
            expected
        );
        let expected = [("back", 60.0), ("free", 140.0)];
        assert_eq!(begun(&[(0.6, 60.0), (0.0, 140.0)], -20.0, 60.0), expected);
        // less speed alone leaves no course; the plan ends before own ship joins
        let straight = legs(&[(0.0, 50.0), (0.0, 180.0)]);
        let slower = [manoeuvre(50.0, 180.0, 180.0, 0.0)];
        assert_eq!(
            found(&straight, &slower, Some(50.0)),
            [("hold", 50.0), ("out", 180.0)]
        );
        let two = [
            manoeuvre(10.0, 30.0, 40.0, 0.0),
            manoeuvre(60.0, 90.0, 400.0, 0.0),
        ];
        let words: Vec<_> = found(&straight, &two, None).iter().map(|p| p.0).collect();
        assert_eq!(words, ["free", "out", "back", "free", "out", "back"]);
        assert!(found(&straight, &[], None).is_empty() && found(&[], &two, None).is_empty());
    }
}
