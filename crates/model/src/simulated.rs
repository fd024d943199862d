//! Words of a simulation: how targets move, and how own ship sees them.

searoom_geometry::words! {
    /// Kind of a target's true motion.
    pub enum BehaviourKind {
        /// Keeps course and speed.
        Constant => "constant",
        /// Takes random courses and speeds within its spreads.
        Random => "random",
        /// Takes the extremes of its spreads.
        Extremes => "extremes",
        /// Steers for own ship.
        Pursuit => "pursuit",
        /// Follows the points of a track.
        Track => "track",
        /// Keeps clear of own ship by a turn before the closest approach.
        GivesWay => "gives-way",
        /// Plans as own ship does.
        Mutual => "mutual",
    }
}

searoom_geometry::words! {
    /// Type of own ship's sensor.
    pub enum SensorType {
        /// The true position and velocity in every step.
        Exact => "exact",
        /// Reports of position, course and speed.
        Ais => "ais",
        /// Positions alone.
        Radar => "radar",
    }
}
