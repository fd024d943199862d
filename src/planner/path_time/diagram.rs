//! The path-time diagram that a plan was found in.

use crate::obstacle::{PathTime, Track};

/// A leg that is sailed.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::planner::path_time::DiagramLeg;
///
/// let scenario = Scenario::read("scenarios/harbour/ferry-crossing.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let diagram = run.planned.path_time.as_ref().expect("planned along paths");
/// let [first, second]: &[DiagramLeg] = &diagram.legs[..] else { panic!("two legs") };
/// assert_eq!((first.path, first.begin), (0, 0.0));
/// assert!((second.begin - first.track.length).abs() < 1e-9);
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiagramLeg {
    /// Where it is.
    pub track: Track,
    /// The path that it is of: 0 is the main path, the alternatives follow.
    pub path: usize,
    /// Metres from the start at which it begins.
    pub begin: f64,
}

/// An obstacle on a leg.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::planner::path_time::DiagramObstacle;
///
/// let scenario = Scenario::read("scenarios/harbour/ferry-crossing.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let diagram = run.planned.path_time.as_ref().expect("planned along paths");
/// let trawler: &DiagramObstacle = &diagram.obstacles[0];
/// assert_eq!((trawler.obstacle, trawler.leg), (0, 0));
/// assert!(trawler.corners.iter().all(|corner| corner.time <= diagram.horizon));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct DiagramObstacle {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Index of the leg in the diagram.
    pub leg: usize,
    /// The corners of a convex polygon, in order around it; distances from the start of the path.
    pub corners: Vec<PathTime>,
}

/// A corner of the path itself: exempt from the turning radius.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::planner::path_time::DiagramCorner;
///
/// let scenario = Scenario::read("scenarios/harbour/ferry-crossing.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let diagram = run.planned.path_time.as_ref().expect("planned along paths");
/// let corner: &DiagramCorner = diagram.corners.last().expect("the path bends");
/// // the second leg is eleven degrees to port of the first
/// assert!((corner.turn.to_degrees() - 11.2).abs() < 0.1 && corner.distance > 400.0);
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiagramCorner {
    /// Metres from the start.
    pub distance: f64,
    /// Radians, to port positive.
    pub turn: f64,
}

/// Distance along the legs that are sailed across, time up: paper figures 5b and 6b.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::planner::path_time::PathTimeDiagram;
///
/// let scenario = Scenario::read("scenarios/harbour/ferry-crossing.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let diagram = run.planned.path_time.as_ref().expect("planned along paths");
/// let whole: &PathTimeDiagram = diagram;
/// let end = whole.profile.last().expect("a profile");
/// assert!((end.distance - whole.length()).abs() < 1e-6 && end.time < whole.horizon);
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PathTimeDiagram {
    /// In the order in which they are sailed; those of the main path where there is no plan.
    pub legs: Vec<DiagramLeg>,
    /// Leg after leg.
    pub obstacles: Vec<DiagramObstacle>,
    /// Where the course changes; the first is at 0 where own ship does not start on the course of
    /// the first leg.
    pub corners: Vec<DiagramCorner>,
    /// From the start to arrival, straight in between; the start alone where there is no plan.
    pub profile: Vec<PathTime>,
    /// Seconds.
    pub horizon: f64,
    /// m/s.
    pub max_speed: f64,
}

impl PathTimeDiagram {
    /// Metres of all legs.
    pub fn length(&self) -> f64 {
        self.legs
            .last()
            .map_or(0.0, |leg| leg.begin + leg.track.length)
    }
}
