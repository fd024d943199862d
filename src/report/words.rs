//! The words of the contract for what the program computes.

use crate::colregs::Role;
use crate::planner::SearchKind;

/// The only kind of planner that exists.
pub(super) const PLANNER: &str = "space-time";

/// What it minimises.
pub(super) const OBJECTIVE: &str = "space-time-error";

pub(super) fn role(role: Role) -> &'static str {
    match role {
        Role::HeadOn => "head-on",
        Role::GiveWay => "give-way",
        Role::StandOn => "stand-on",
        Role::Overtaking => "overtaking",
        Role::Overtaken => "overtaken",
        Role::BothGiveWay => "both-give-way",
        Role::PortToPort => "port-to-port",
        Role::Static => "static",
        Role::None => "none",
    }
}

pub(super) fn search(kind: SearchKind) -> &'static str {
    match kind {
        SearchKind::AStar => "a-star",
        SearchKind::Dijkstra => "dijkstra",
    }
}
