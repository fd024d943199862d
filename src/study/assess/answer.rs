//! A query about a situation and its answers.

use super::{OwnSituation, least_alteration};
use crate::document::{
    AlterationDocument, ApproachDocument, AssessedSets, AssessmentDocument, HeldDocument,
    HoldCourseDocument, PointDocument, PointRiskDocument, SectionDocument, TargetSectionsDocument,
    VelocityDocument,
};
use crate::frame::{Vector, deg_from_radians};
use crate::obstacle::{ClosestApproach, Obstacle, SpaceTimeObstacle};
use crate::tolerance::EDGE_M;

/// Position at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpaceTimePoint {
    /// Position in metres.
    pub position: Vector,
    /// Time in seconds from the scenario's start.
    pub time: f64,
}

/// Questions in addition to the risk of holding course and the least alteration.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Query {
    /// Times of the sections in seconds, non-negative.
    pub sections: Vec<f64>,
    /// Points at which the risk is evaluated.
    pub points: Vec<SpaceTimePoint>,
    /// Velocities of own ship from t = 0, m/s.
    pub velocities: Vec<Vector>,
}

/// Answers a query about the scenario `title`. `sets` says which sets are those of
/// the situation. Cost per target:
/// O(n + m) per point and per velocity; O((n + m)²) at worst for the largest risk of holding
/// course. For the alteration see [`least_alteration`].
pub fn assess(
    title: &str,
    sets: AssessedSets,
    situation: &OwnSituation,
    query: &Query,
) -> AssessmentDocument {
    let obstacles = situation.obstacles;
    let held = situation.held();
    let alteration = least_alteration(situation);
    let degrees = |turn: Option<f64>| turn.map(deg_from_radians);
    let targets = obstacles.iter().map(|target| TargetSectionsDocument {
        name: target.name().to_owned(),
        representation: target.representation(),
        sections: (query.sections.iter())
            .map(|&t_s| SectionDocument {
                t_s,
                set: (&target.section(t_s)).into(),
            })
            .collect(),
    });
    let points = query.points.iter().map(|point| PointDocument {
        east_m: point.position.x,
        north_m: point.position.y,
        t_s: point.time,
        targets: obstacles.iter().map(|o| risk_at(o, point)).collect(),
    });
    let hold_course = obstacles.iter().map(|target| {
        let approach = approach(situation, target, situation.velocity());
        // where the set is only touched, by rounding beyond its edge too
        let touched = SpaceTimePoint {
            position: held.pose_at(approach.tcpa_s).position,
            time: approach.tcpa_s,
        };
        let max_risk = match approach.in_velocity_obstacle {
            true => target
                .peak_risk(&held)
                .risk
                .max(risk_at(target, &touched).risk),
            false => 0.0,
        };
        HeldDocument {
            name: approach.name,
            dcpa_m: approach.dcpa_m,
            tcpa_s: approach.tcpa_s,
            max_risk,
        }
    });
    let velocities = query.velocities.iter().map(|velocity| VelocityDocument {
        east_mps: velocity.x,
        north_mps: velocity.y,
        targets: (obstacles.iter())
            .map(|target| approach(situation, target, *velocity))
            .collect(),
    });
    AssessmentDocument {
        scenario: title.to_owned(),
        horizon_s: situation.horizon,
        sets,
        targets: targets.collect(),
        points: points.collect(),
        hold_course: HoldCourseDocument {
            targets: hold_course.collect(),
        },
        alteration: AlterationDocument {
            starboard_deg: degrees(alteration.starboard),
            port_deg: degrees(alteration.port),
            speed_mps: alteration.speed,
        },
        velocities: velocities.collect(),
    }
}

/// Inside is what is within [`EDGE_M`] of the set: there alpha is at most 1, and beyond it is more.
fn risk_at(target: &Obstacle, point: &SpaceTimePoint) -> PointRiskDocument {
    let (position, time) = (point.position, point.time);
    // both negated so that a NaN is inside
    let inside = !(time < 0.0) && !(target.signed_distance(position, time).distance > EDGE_M);
    let alpha = match inside {
        true => target.alpha_within(position, time, EDGE_M).min(1.0),
        false => target.alpha(position, time).max(1.0_f64.next_up()),
    };
    PointRiskDocument {
        name: target.name().to_owned(),
        inside,
        alpha: Some(alpha).filter(|alpha| alpha.is_finite()),
        risk: (1.0 - alpha).max(0.0),
    }
}

fn approach(situation: &OwnSituation, target: &Obstacle, velocity: Vector) -> ApproachDocument {
    let nearest = situation.closest_approach(target, velocity);
    ApproachDocument {
        name: target.name().to_owned(),
        dcpa_m: nearest.distance,
        tcpa_s: nearest.time,
        in_velocity_obstacle: nearest.distance == 0.0,
    }
}

impl OwnSituation<'_> {
    /// The closest approach to a target with a constant velocity; the distance is 0 where own ship
    /// comes within [`EDGE_M`] of the set, so it is 0 in the velocity obstacle and only there.
    pub(super) fn closest_approach(&self, target: &Obstacle, velocity: Vector) -> ClosestApproach {
        let mut nearest = target.closest_approach(self.pose.position, velocity, self.horizon);
        // negated so that a NaN is a contact
        if !(nearest.distance > EDGE_M) {
            nearest.distance = 0.0;
        }
        nearest
    }
}
