//! Reasons why a planner finds no plan.

use searoom_model::trajectory::NetworkError;

/// Reason why there is no plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoPlan {
    /// Own ship starts inside an obstacle.
    #[error("own ship starts inside the set of '{target}', {depth:.1} m deep")]
    StartInside {
        /// Name of the obstacle.
        target: String,
        /// Depth, metres.
        depth: f64,
    },
    /// Own ship starts closer to land than it may be on some heading.
    #[error(
        "own ship starts {depth:.1} m closer to land than its half-diagonal and the land margin allow"
    )]
    StartOnLand {
        /// Depth, metres.
        depth: f64,
    },
    /// The end cannot be reached before the horizon even without obstacles.
    #[error(
        "the last waypoint is reached after {earliest:.1} s at best, on the path found for the turning radius, without targets, but the horizon is {horizon:.1} s"
    )]
    HorizonTooShort {
        /// Earliest arrival, seconds.
        earliest: f64,
        /// Horizon, seconds.
        horizon: f64,
    },
    /// No path joins own ship's pose and the waypoints.
    #[error("no path joins own ship and the waypoints: a coordinate is out of range")]
    NoRoute,
    /// Own ship does not start on the path, which a path-following planner requires.
    #[error("own ship is {away:.3} m from the first waypoint; the path-time planner begins there")]
    OffPath {
        /// Distance from the path, metres.
        away: f64,
    },
    /// The main path and the alternatives do not form a network.
    #[error("the paths cannot be sailed: {0}")]
    NoNetwork(NetworkError),
    /// The end of the path cannot be reached before the horizon even without obstacles.
    #[error(
        "the last waypoint is reached after {earliest:.1} s at best, on the shortest of the paths at the greatest speed, without targets, but the horizon is {horizon:.1} s"
    )]
    PathTooLong {
        /// Earliest arrival, seconds.
        earliest: f64,
        /// Horizon, seconds.
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
        /// Depth, metres.
        depth: f64,
        /// Time until which it is inside, seconds; `None` up to the horizon.
        until: Option<f64>,
    },
    /// No motion along the paths is clear of every set. The fields describe the obstacle that
    /// blocks the motion that came nearest to the end.
    #[error(
        "no motion along the path is clear of every set: {to_go:.0} m before its end own ship, at the earliest, meets the set of '{target}' after {time:.1} s, which is there or ahead {}",
        until_text(*until)
    )]
    Barred {
        /// Name of the obstacle.
        target: String,
        /// Distance to the end of the path, metres.
        to_go: f64,
        /// Time of the contact, seconds.
        time: f64,
        /// Time until which the set is there or ahead on that leg, seconds; `None` up to the
        /// horizon.
        until: Option<f64>,
    },
    /// A motion along the path is clear of the sets, but not within the horizon.
    #[error(
        "no motion along the path is clear of every set ('{target}' is met first) and arrives before the horizon of {horizon:.1} s"
    )]
    OutOfTime {
        /// Name of the obstacle met first on the shortest path at the greatest speed.
        target: String,
        /// Horizon, seconds.
        horizon: f64,
    },
    /// Sets cover the last waypoint from the earliest possible arrival to the horizon.
    #[error(
        "the last waypoint is inside sets at all times from {earliest:.1} s, when own ship can be there first, to the horizon; at the horizon it is in the set of '{target}'"
    )]
    EndCovered {
        /// Name of the obstacle that covers it at the horizon.
        target: String,
        /// Earliest possible arrival, straight and at the greatest speed, seconds.
        earliest: f64,
    },
    /// A set covers the last waypoint while own ship is to lie there.
    #[error(
        "the set of '{target}' reaches the last waypoint {from:.1} s from the start, where own ship is to stay until {until:.1} s"
    )]
    StayCovered {
        /// Name of the obstacle that comes first.
        target: String,
        /// Time of the contact, seconds.
        from: f64,
        /// End of the stay, seconds.
        until: f64,
    },
    /// No candidate is clear of every set.
    #[error(
        "no trajectory of the graph or its refinement is clear of every set and arrives before the horizon; held on the desired \
         trajectory, own ship meets the set of '{target}' after {time:.1} s"
    )]
    NoCandidate {
        /// Name of the obstacle that the nominal motion meets first.
        target: String,
        /// Time of the contact, seconds.
        time: f64,
    },
    /// No manoeuvre by the rules for own ship's roles is clear of every set.
    #[error(
        "no manoeuvre by the rules toward all targets is clear of every set and arrives before the horizon; held on the \
         desired trajectory, own ship meets the set of '{target}' after {time:.1} s"
    )]
    NoneComplies {
        /// Name of the obstacle that the nominal motion meets first.
        target: String,
        /// Time of the contact, seconds.
        time: f64,
    },
    /// What plans in larger domains cost is out of all proportion to a lawful one that keeps less.
    #[error(
        "a plan clear of larger ship domains costs {cost:.0} m², many times the {other:.0} m² of this one, which breaks no rule"
    )]
    OutOfProportion {
        /// *J* of the plan in larger domains, m².
        cost: f64,
        /// *J* of the plan that is taken, m².
        other: f64,
    },
    /// The search produced no candidate, although the nominal motion meets no set.
    #[error(
        "no trajectory of the graph or its refinement arrives clear of every set, though the desired trajectory meets none: rounding errors are too large for these numbers"
    )]
    NoTrajectory,
    /// No initial guess of the optimal-control planner led to a motion clear of every set.
    #[error(
        "none of {starts} initial guesses leads to a plan clear of every set; the shallowest solution is {depth:.3} m inside the set of '{target}' at {time:.1} s"
    )]
    Locked {
        /// Number of initial guesses tried.
        starts: usize,
        /// Name of the obstacle.
        target: String,
        /// Time of the deepest point, seconds.
        time: f64,
        /// Depth, metres.
        depth: f64,
    },
    /// No initial guess of the optimal-control planner was solved.
    #[error("none of {starts} initial guesses was solved: {why}")]
    Unsolved {
        /// Number of initial guesses tried.
        starts: usize,
        /// Solver status of the first one.
        why: String,
    },
    /// There are plans on a coarse grid, but none on the finer grid that the ship's dynamics need.
    #[error(
        "there are plans on {coarse} intervals, but they are too coarse for the ship, and on {intervals} the solver lost the cheapest: {why}"
    )]
    Lost {
        /// Number of intervals requested.
        coarse: usize,
        /// Number of intervals of the last grid.
        intervals: usize,
        /// Solver status on the finer grid.
        why: String,
    },
    /// Between the nodes the motion deviates from the ship's dynamics.
    #[error(
        "with {intervals} intervals, the most that were tried, the ship would be off the plan by {off:.1e} of its units at the end of an interval, {allowed:.0e} allowed; what may help: more intervals (planner.optimal_control), a shorter horizon"
    )]
    Coarse {
        /// Number of intervals.
        intervals: usize,
        /// Largest deviation, in the ship's own units of length, speed and angle.
        off: f64,
        /// Allowed deviation, in the same units.
        allowed: f64,
    },
}

impl NoPlan {
    /// True when smaller sets might admit a plan.
    pub fn is_for_the_sets(&self) -> bool {
        match self {
            Self::EndCovered { .. }
            | Self::StayCovered { .. }
            | Self::NoCandidate { .. }
            | Self::NoneComplies { .. }
            | Self::Barred { .. }
            | Self::OutOfTime { .. }
            | Self::Locked { .. }
            | Self::Lost { .. }
            | Self::OutOfProportion { .. }
            | Self::Unsolved { .. } => true,
            Self::StartInside { .. }
            | Self::StartOnLand { .. }
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
