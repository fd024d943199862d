//! Path-time diagram of a plan.

use searoom_sets::{PathTime, Track};

/// Leg of the planned path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiagramLeg {
    /// Position and direction of the leg.
    pub track: Track,
    /// Index of the path that contains the leg: 0 is the main path, alternatives follow.
    pub path: usize,
    /// Distance from the start of the path to the start of the leg, in metres.
    pub begin: f64,
}

/// Obstacle projected onto one leg.
#[derive(Debug, Clone, PartialEq)]
pub struct DiagramObstacle {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Index of the leg in the diagram.
    pub leg: usize,
    /// Corners of a convex polygon, in order around it. Distances count from the start of the path.
    pub corners: Vec<PathTime>,
}

/// Corner of the path, exempt from the turning radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiagramCorner {
    /// Distance from the start, in metres.
    pub distance: f64,
    /// Course change in radians, positive to port.
    pub turn: f64,
}

/// Path-time diagram: distance along the planned legs against time, paper figures 5b and 6b.
#[derive(Debug, Clone, PartialEq)]
pub struct PathTimeDiagram {
    /// Legs in the order of the plan. Without a plan, these are the legs of the main path.
    pub legs: Vec<DiagramLeg>,
    /// Obstacles, leg by leg.
    pub obstacles: Vec<DiagramObstacle>,
    /// Course changes. The first is at distance 0 if own ship does not start on the course of the
    /// first leg.
    pub corners: Vec<DiagramCorner>,
    /// Corners of the piecewise linear profile from start to arrival; without a plan, the start
    /// alone.
    pub profile: Vec<PathTime>,
    /// Horizon in seconds.
    pub horizon: f64,
    /// Maximum speed in m/s.
    pub max_speed: f64,
}

impl PathTimeDiagram {
    /// Total length of the legs in metres.
    pub fn length(&self) -> f64 {
        self.legs
            .last()
            .map_or(0.0, |leg| leg.begin + leg.track.length)
    }
}
