//! The vector by which a domain is swept to the side that the rules forbid.

use super::encounter::{Risk, offset_from_wake, risk_distance};
use super::role::Role;
use crate::frame::{Vector, direction, to_port};
use crate::target::ShipTrack;
use crate::vessel::OwnShip;

/// How much the sweep exceeds what the design inequality needs: covers a planner that does not find
/// the exact optimum.
const SWEEP_EXCESS: f64 = 0.1;

/// Radians. Own ship this far off the wake of the ship that she overtakes passes on that side (5°).
const OFF_THE_WAKE: f64 = std::f64::consts::PI / 36.0;

/// `e` of docs/colregs.md 3.3, metres: which way, and how far, the base is swept. Passing on the side that
/// the rules forbid then costs `|e| = 2 (1 + 0.1)` risk distances more of displacement than on the other,
/// so that the cheaper side is the compliant one for every miss distance that is a risk (3.2).
///
/// The direction is the normal of the relative velocity at the first instant of risk on the bad side:
/// the target's starboard side in a head-on or port-to-port meeting; ahead of her when giving way; when
/// overtaking her starboard side, unless own ship is more than 5° to starboard of her wake, then her
/// port side. Zero for every other role.
pub fn sweep(own: &OwnShip, target: &ShipTrack, risk: &Risk) -> Vector {
    let ahead = direction(target.pose.heading);
    let port = to_port(ahead);
    // the bad side, and what decides when the normal has no part in it
    let (bad, otherwise) = match risk.role {
        Role::HeadOn | Role::PortToPort => (-port, ahead),
        Role::GiveWay => (ahead, -port),
        Role::Overtaking if offset_from_wake(risk) > OFF_THE_WAKE => (port, ahead),
        Role::Overtaking => (-port, ahead),
        Role::StandOn | Role::Overtaken | Role::BothGiveWay | Role::Static | Role::None => {
            return Vector::zeros();
        }
    };
    let relative = risk.own.velocity() - risk.target.velocity();
    let Some(along) = relative.try_normalize(0.0) else {
        return Vector::zeros();
    };
    let normal = to_port(along);
    let toward = match normal.dot(&bad) {
        0.0 => normal.dot(&otherwise),
        part => part,
    };
    normal * toward.signum() * (2.0 * (1.0 + SWEEP_EXCESS) * risk_distance(own, target))
}
