//! Everything that is asked of a situation, and the answers.

use super::{Alteration, Situation, least_alteration};
use crate::frame::Vector;
use crate::geometry::ConvexSet;
use crate::obstacle::{Obstacle, SpaceTimeObstacle};

/// A position at a time.
///
/// # Examples
///
/// ```
/// use searoom::assessment::SpaceTimePoint;
/// use searoom::frame::Vector;
///
/// let buoy_in_five_minutes = SpaceTimePoint { position: Vector::new(750.0, 0.0), time: 300.0 };
/// assert_eq!(buoy_in_five_minutes.position.x, 750.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpaceTimePoint {
    /// Metres.
    pub position: Vector,
    /// Seconds from the scenario's start.
    pub time: f64,
}

/// What is asked beside holding course and the alteration.
///
/// # Examples
///
/// ```
/// use searoom::assessment::{Query, SpaceTimePoint};
/// use searoom::frame::Vector;
///
/// // no velocities: of these nothing is asked
/// let query = Query {
///     sections: vec![60.0],
///     points: vec![SpaceTimePoint { position: Vector::new(750.0, 0.0), time: 150.0 }],
///     ..Query::default()
/// };
/// assert!(query.velocities.is_empty());
/// ```
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
///
/// # Examples
///
/// ```
/// use searoom::assessment::{Query, Situation, TargetSections, assess};
/// use searoom::obstacle::Obstacle;
/// use searoom::pipeline::sets;
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let obstacles: Vec<Obstacle> = sets(&scenario).into_iter().map(|target| target.hard).collect();
/// let own = &scenario.own_ship;
/// let situation = Situation {
///     pose: own.pose,
///     speed: own.speed,
///     max_speed: own.max_speed(),
///     horizon: scenario.horizon,
///     obstacles: &obstacles,
/// };
/// let query = Query { sections: vec![0.0, 60.0], ..Query::default() };
/// let ferry: &TargetSections = &assess(&situation, &query).targets[0];
/// assert_eq!((ferry.name.as_str(), ferry.representation, ferry.sections.len()), ("target", "polytope", 2));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
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
///
/// # Examples
///
/// ```
/// use searoom::assessment::{PointRisk, Query, Situation, SpaceTimePoint, assess};
/// use searoom::obstacle::Obstacle;
/// use searoom::pipeline::sets;
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let obstacles: Vec<Obstacle> = sets(&scenario).into_iter().map(|target| target.hard).collect();
/// let own = &scenario.own_ship;
/// let situation = Situation {
///     pose: own.pose,
///     speed: own.speed,
///     max_speed: own.max_speed(),
///     horizon: scenario.horizon,
///     obstacles: &obstacles,
/// };
/// use searoom::frame::Vector;
/// let point = SpaceTimePoint { position: Vector::new(750.0, 0.0), time: 150.0 };
/// let query = Query { points: vec![point], ..Query::default() };
/// let PointRisk { inside, alpha, risk } = assess(&situation, &query).points[0].targets[0];
/// // where she is expected at that time
/// assert!(inside && alpha == 0.0 && risk == 1.0);
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
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
///
/// # Examples
///
/// ```
/// use searoom::assessment::{PointAssessment, Query, Situation, SpaceTimePoint, assess};
/// use searoom::obstacle::Obstacle;
/// use searoom::pipeline::sets;
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let obstacles: Vec<Obstacle> = sets(&scenario).into_iter().map(|target| target.hard).collect();
/// let own = &scenario.own_ship;
/// let situation = Situation {
///     pose: own.pose,
///     speed: own.speed,
///     max_speed: own.max_speed(),
///     horizon: scenario.horizon,
///     obstacles: &obstacles,
/// };
/// use searoom::frame::Vector;
/// let point = SpaceTimePoint { position: Vector::new(750.0, 0.0), time: 150.0 };
/// let query = Query { points: vec![point], ..Query::default() };
/// let answers = assess(&situation, &query);
/// let answer: &PointAssessment = &answers.points[0];
/// assert_eq!((answer.point.time, answer.targets.len()), (150.0, 1));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PointAssessment {
    /// Where and when.
    pub point: SpaceTimePoint,
    /// One per target.
    pub targets: Vec<PointRisk>,
}

/// How near own ship comes to one target.
///
/// # Examples
///
/// ```
/// use searoom::assessment::{Approach, Query, Situation, assess};
/// use searoom::obstacle::Obstacle;
/// use searoom::pipeline::sets;
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let obstacles: Vec<Obstacle> = sets(&scenario).into_iter().map(|target| target.hard).collect();
/// let own = &scenario.own_ship;
/// let situation = Situation {
///     pose: own.pose,
///     speed: own.speed,
///     max_speed: own.max_speed(),
///     horizon: scenario.horizon,
///     obstacles: &obstacles,
/// };
/// let held = assess(&situation, &Query::default()).hold_course.remove(0);
/// let Approach { dcpa, tcpa, in_velocity_obstacle } = held.approach;
/// assert!(in_velocity_obstacle && dcpa == 0.0 && (120.0..150.0).contains(&tcpa));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
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
///
/// # Examples
///
/// ```
/// use searoom::assessment::{Query, Situation, VelocityAssessment, assess};
/// use searoom::obstacle::Obstacle;
/// use searoom::pipeline::sets;
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let obstacles: Vec<Obstacle> = sets(&scenario).into_iter().map(|target| target.hard).collect();
/// let own = &scenario.own_ship;
/// let situation = Situation {
///     pose: own.pose,
///     speed: own.speed,
///     max_speed: own.max_speed(),
///     horizon: scenario.horizon,
///     obstacles: &obstacles,
/// };
/// use searoom::frame::Vector;
/// let query = Query { velocities: vec![Vector::new(4.8, -1.4)], ..Query::default() };
/// let answers = assess(&situation, &query);
/// let slightly_to_starboard: &VelocityAssessment = &answers.velocities[0];
/// assert!(!slightly_to_starboard.targets[0].in_velocity_obstacle);
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct VelocityAssessment {
    /// m/s.
    pub velocity: Vector,
    /// One per target.
    pub targets: Vec<Approach>,
}

/// What holding course and speed comes to with one target.
///
/// # Examples
///
/// ```
/// use searoom::assessment::{HoldCourse, Query, Situation, assess};
/// use searoom::obstacle::Obstacle;
/// use searoom::pipeline::sets;
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let obstacles: Vec<Obstacle> = sets(&scenario).into_iter().map(|target| target.hard).collect();
/// let own = &scenario.own_ship;
/// let situation = Situation {
///     pose: own.pose,
///     speed: own.speed,
///     max_speed: own.max_speed(),
///     horizon: scenario.horizon,
///     obstacles: &obstacles,
/// };
/// let held: HoldCourse = assess(&situation, &Query::default()).hold_course.remove(0);
/// assert_eq!(held.max_risk, 1.0);
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoldCourse {
    /// Closest approach.
    pub approach: Approach,
    /// The largest risk on the way, in `[0, 1]`.
    pub max_risk: f64,
}

/// The answers; every list per target is in the order of the situation's obstacles.
///
/// # Examples
///
/// ```
/// use searoom::assessment::{Assessment, Query, Situation, assess};
/// use searoom::obstacle::Obstacle;
/// use searoom::pipeline::sets;
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let obstacles: Vec<Obstacle> = sets(&scenario).into_iter().map(|target| target.hard).collect();
/// let own = &scenario.own_ship;
/// let situation = Situation {
///     pose: own.pose,
///     speed: own.speed,
///     max_speed: own.max_speed(),
///     horizon: scenario.horizon,
///     obstacles: &obstacles,
/// };
/// let answers: Assessment = assess(&situation, &Query::default());
/// assert!(answers.hold_course[0].approach.in_velocity_obstacle);
/// assert!(answers.alteration.starboard.is_some());
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
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
