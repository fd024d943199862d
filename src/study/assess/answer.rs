//! Everything that is asked of a situation, and the answers.

use super::{Alteration, Situation, least_alteration};
use crate::frame::Vector;
use crate::geometry::ConvexSet;
use crate::obstacle::{Obstacle, SpaceTimeObstacle};

/// A position at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpaceTimePoint {
    /// Metres.
    pub position: Vector,
    /// Seconds from the scenario's start.
    pub time: f64,
}

/// What is asked beside holding course and the alteration.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Query {
    /// Times of the sections, seconds, not negative.
    pub sections: Vec<f64>,
    /// Where and when the risk is asked.
    pub points: Vec<SpaceTimePoint>,
    /// Own ship's velocities from t = 0 on, m/s.
    pub velocities: Vec<Vector>,
}

/// Where a target may be.
#[derive(Debug, Clone, PartialEq)]
pub struct TargetSections {
    /// Her name.
    pub name: String,
    /// `"polytope"` or `"ellipsoid"`.
    pub representation: &'static str,
    /// Times, seconds, and sections, in the order asked.
    pub sections: Vec<(f64, ConvexSet)>,
}

/// Risk at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointRisk {
    /// In the closed set.
    pub inside: bool,
    /// `alpha*`, paper eq. (25) without its bound: above 1 outside, infinite where no scaling reaches.
    pub alpha: f64,
    /// `1 - alpha*`, clipped to `[0, 1]`.
    pub risk: f64,
}

/// One point against every target, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct PointAssessment {
    /// Where and when.
    pub point: SpaceTimePoint,
    /// One per target.
    pub targets: Vec<PointRisk>,
}

/// How near own ship comes to one target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// Metres; 0 in contact.
    pub dcpa: f64,
    /// Seconds: the earliest instant at that distance, the first contact where there is one.
    pub tcpa: f64,
    /// True when the velocity meets the set within the horizon.
    pub in_velocity_obstacle: bool,
}

/// One velocity against every target, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct VelocityAssessment {
    /// m/s.
    pub velocity: Vector,
    /// One per target.
    pub targets: Vec<Approach>,
}

/// What holding course and speed comes to with one target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoldCourse {
    /// Closest approach.
    pub approach: Approach,
    /// The largest risk on the way, in `[0, 1]`.
    pub max_risk: f64,
}

/// The answers; every list per target is in the order of the situation's obstacles.
#[derive(Debug, Clone, PartialEq)]
pub struct Assessment {
    /// One per target.
    pub targets: Vec<TargetSections>,
    /// One per point asked.
    pub points: Vec<PointAssessment>,
    /// One per target.
    pub hold_course: Vec<HoldCourse>,
    /// Least alteration that leaves every velocity obstacle.
    pub alteration: Alteration,
    /// One per velocity asked.
    pub velocities: Vec<VelocityAssessment>,
}

/// Answers a query. Per target: a point O(n + m), a velocity O(n + m), the largest risk of holding course
/// O((n + m)²) at worst; for the alteration see [`least_alteration`].
pub fn assess(situation: &Situation, query: &Query) -> Assessment {
    let obstacles = situation.obstacles;
    let held = situation.held();
    let approaches = |velocity| -> Vec<Approach> {
        obstacles
            .iter()
            .map(|target| approach(situation, target, velocity))
            .collect()
    };
    Assessment {
        targets: obstacles
            .iter()
            .map(|target| TargetSections {
                name: target.name().to_owned(),
                representation: target.representation(),
                sections: query
                    .sections
                    .iter()
                    .map(|time| (*time, target.section(*time)))
                    .collect(),
            })
            .collect(),
        points: query
            .points
            .iter()
            .map(|point| PointAssessment {
                point: *point,
                targets: obstacles.iter().map(|o| risk_at(o, point)).collect(),
            })
            .collect(),
        hold_course: obstacles
            .iter()
            .zip(approaches(situation.velocity()))
            .map(|(target, approach)| HoldCourse {
                approach,
                max_risk: target.peak_risk(&held).risk,
            })
            .collect(),
        alteration: least_alteration(situation),
        velocities: query
            .velocities
            .iter()
            .map(|velocity| VelocityAssessment {
                velocity: *velocity,
                targets: approaches(*velocity),
            })
            .collect(),
    }
}

fn risk_at(target: &Obstacle, point: &SpaceTimePoint) -> PointRisk {
    let obstacle = target;
    PointRisk {
        inside: obstacle.contains(point.position, point.time),
        alpha: obstacle.alpha(point.position, point.time),
        risk: obstacle.risk(point.position, point.time),
    }
}

fn approach(situation: &Situation, target: &Obstacle, velocity: Vector) -> Approach {
    let (from, horizon) = (situation.pose.position, situation.horizon);
    let obstacle = target;
    let nearest = obstacle.closest_approach(from, velocity, horizon);
    Approach {
        dcpa: nearest.distance,
        tcpa: nearest.time,
        in_velocity_obstacle: obstacle.in_velocity_obstacle(from, velocity, horizon),
    }
}
