//! Why a planner finds no plan.

use crate::trajectory::NetworkError;

/// Why there is no plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoPlan {
    /// Own ship starts inside an obstacle.
    #[error("own ship starts inside the set of '{target}', {depth:.1} m deep")]
    StartInside {
        /// Name of the obstacle.
        target: String,
        /// Metres.
        depth: f64,
    },
    /// Own ship starts nearer to land than she may be on some heading.
    #[error(
        "own ship starts {depth:.1} m nearer to land than her half-diagonal and the land margin allow"
    )]
    StartAshore {
        /// Metres.
        depth: f64,
    },
    /// The end cannot be reached before the horizon even without obstacles.
    #[error(
        "the last waypoint is reached after {earliest:.1} s at best, on the path found for the turning radius, without targets, but the horizon is {horizon:.1} s"
    )]
    HorizonTooShort {
        /// Seconds.
        earliest: f64,
        /// Seconds.
        horizon: f64,
    },
    /// The waypoints and own ship's pose cannot be joined by a path.
    #[error("no path joins own ship and the waypoints: a coordinate is out of range")]
    NoRoute,
    /// A planner that keeps to a path begins on it.
    #[error("own ship is {away:.3} m from the first waypoint; the path-time planner begins there")]
    OffPath {
        /// Metres.
        away: f64,
    },
    /// The alternatives and the main path are no network.
    #[error("the paths cannot be sailed: {0}")]
    NoNetwork(NetworkError),
    /// The end of the path cannot be reached before the horizon even without obstacles.
    #[error(
        "the last waypoint is reached after {earliest:.1} s at best, on the shortest of the paths at the greatest speed, without targets, but the horizon is {horizon:.1} s"
    )]
    PathTooLong {
        /// Seconds.
        earliest: f64,
        /// Seconds.
        horizon: f64,
    },
    /// The start of the path is in a set at t = 0.
    #[error(
        "own ship starts inside the set of '{target}', {depth:.1} m deep, which stays over the start {}",
        until_text(*until)
    )]
    StartCovered {
        /// Name of the obstacle.
        target: String,
        /// Metres.
        depth: f64,
        /// Seconds; `None` up to the horizon.
        until: Option<f64>,
    },
    /// No motion along the paths is clear of every set; what bars the way where own ship came nearest to the end.
    #[error(
        "no motion along the path is clear of every set: {to_go:.0} m before its end own ship, at the earliest, meets the set of '{target}' after {time:.1} s, which is there or ahead {}",
        until_text(*until)
    )]
    Barred {
        /// Name of the obstacle.
        target: String,
        /// Metres to the end of the path.
        to_go: f64,
        /// Seconds.
        time: f64,
        /// Seconds, until when its set is there or ahead on that leg; `None` up to the horizon.
        until: Option<f64>,
    },
    /// The sets leave a way, but not within the horizon.
    #[error(
        "no motion along the path is clear of every set, that of '{target}' on the way, and at the end before the horizon of {horizon:.1} s"
    )]
    OutOfTime {
        /// Name of the obstacle that is met first on the shortest way at the greatest speed.
        target: String,
        /// Seconds.
        horizon: f64,
    },
    /// No candidate is clear of every set.
    #[error(
        "no trajectory of the graph or its refinement is clear of every set until arrival; held on the desired \
         trajectory, own ship meets the set of '{target}' after {time:.1} s"
    )]
    NoCandidate {
        /// Name of the obstacle that the undisturbed motion meets first.
        target: String,
        /// Seconds.
        time: f64,
    },
    /// No candidate that keeps the rules of own ship's roles is clear of every set.
    #[error(
        "no trajectory of the graph or its refinement keeps the rules toward all and is clear of every set until arrival; held on the \
         desired trajectory, own ship meets the set of '{target}' after {time:.1} s"
    )]
    NoneComplies {
        /// Name of the obstacle that the undisturbed motion meets first.
        target: String,
        /// Seconds.
        time: f64,
    },
    /// No candidate came of the search at all, though the undisturbed motion meets no set.
    #[error(
        "no trajectory of the graph or its refinement arrives clear of every set, though the desired trajectory meets none: the numbers leave no digits for it"
    )]
    NoTrajectory,
    /// No start of the optimal-control planner led out of every set.
    #[error(
        "of {starts} starts none leads to a plan clear of every set; the least deep of those solved is {depth:.3} m inside the set of '{target}' at {time:.1} s"
    )]
    Locked {
        /// Starts that were tried.
        starts: usize,
        /// Name of the obstacle.
        target: String,
        /// Seconds.
        time: f64,
        /// Metres.
        depth: f64,
    },
    /// No start of the optimal-control planner was solved at all.
    #[error("of {starts} starts none was solved: {why}")]
    Unsolved {
        /// Starts that were tried.
        starts: usize,
        /// How the first one ended.
        why: String,
    },
    /// Plans of a coarse grid, but none on the finer one that the ship's motion needs.
    #[error(
        "there are plans on {coarse} intervals, but they are too coarse for the ship, and on {intervals} the cheapest is lost: {why}"
    )]
    Lost {
        /// Of the horizon, as asked for.
        coarse: usize,
        /// Of the horizon, in the end.
        intervals: usize,
        /// How the solve on the finer grid ended.
        why: String,
    },
    /// The motion between the nodes is not the ship's.
    #[error(
        "with {intervals} intervals, the most that were tried, the ship would be off the plan by {off:.1e} of her units at the end of an interval, {allowed:.0e} allowed; what may help: more intervals (planner.optimal_control), a shorter horizon"
    )]
    Coarse {
        /// Of the horizon.
        intervals: usize,
        /// In the ship's own units of length, speed and angle.
        off: f64,
        /// In the same units.
        allowed: f64,
    },
}

impl NoPlan {
    /// True when smaller sets might leave a way.
    pub fn is_for_the_sets(&self) -> bool {
        match self {
            Self::NoCandidate { .. }
            | Self::NoneComplies { .. }
            | Self::Barred { .. }
            | Self::OutOfTime { .. }
            | Self::Locked { .. }
            | Self::Lost { .. }
            | Self::Unsolved { .. } => true,
            Self::StartInside { .. }
            | Self::StartAshore { .. }
            | Self::StartCovered { .. }
            | Self::HorizonTooShort { .. }
            | Self::PathTooLong { .. }
            | Self::OffPath { .. }
            | Self::NoNetwork(_)
            | Self::Coarse { .. }
            | Self::NoRoute
            | Self::NoTrajectory => false,
        }
    }
}

fn until_text(until: Option<f64>) -> String {
    match until {
        Some(time) => format!("until {time:.1} s"),
        None => "up to the horizon".to_owned(),
    }
}
