//! Words of a simulation: how targets move, and how own ship sees them.

use crate::vessel::VesselKind;

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
    /// Own ship's true motion.
    pub enum SailedVessel {
        /// Lines and arcs, speed changes at once.
        Kinematic => "kinematic",
        /// Turn rate and speed approach the ordered ones exponentially.
        FirstOrder => "first-order",
        /// Nomoto's first-order model, with limits of the rudder.
        Nomoto => "nomoto",
        /// CyberShip II under forces.
        CyberShip2 => "cybership2",
    }
}

impl From<VesselKind> for SailedVessel {
    fn from(forced: VesselKind) -> Self {
        match forced {
            VesselKind::CyberShip2 => Self::CyberShip2,
        }
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
