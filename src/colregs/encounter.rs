//! Roles of two ships that meet.

/// What own ship is to a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Role {
    /// Rule 14.
    HeadOn,
    /// Rule 15, the other on own starboard side.
    GiveWay,
    /// Rule 17.
    StandOn,
    /// Rule 13, own ship overtakes.
    Overtaking,
    /// Rule 13, own ship is overtaken.
    Overtaken,
    /// Each on the other's starboard side: both keep clear.
    BothGiveWay,
    /// Each on the other's port side: treated like head-on.
    PortToPort,
    /// The target does not move: no role.
    Static,
    /// No risk of collision.
    None,
}

/// A target as own ship meets it, judged from two motions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encounter {
    /// Own ship's role.
    pub role: Role,
    /// Least distance of the hulls along the undisturbed desired trajectory, metres.
    pub undisturbed_dcpa: f64,
    /// And when, seconds.
    pub undisturbed_tcpa: f64,
}
