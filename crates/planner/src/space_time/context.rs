//! Data of one problem that no search changes.

use crate::Problem;
use crate::space_time::land;
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::proxy::{Proxy, first_contact};
use crate::space_time::route::Route;
use searoom_model::trajectory::Segment;

/// Longest arc per chord in the search for approaches in the end, radians.
pub(crate) const FINE_CHORD_RAD: f64 = 0.05;

/// Data that stay fixed for one problem.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Context<'a> {
    pub problem: &'a Problem<'a>,
    pub route: &'a Route,
    pub proxies: &'a [Proxy<'a>],
    /// Land blocks.
    pub blocks: &'a [Proxy<'a>],
    /// Speeds where the first conflict is.
    pub speeds: ManoeuvreSpeeds,
    /// Longest arc per chord in the search for approaches, radians.
    pub chord: f64,
    /// Least time of a segment variable, seconds.
    pub segment_time: f64,
}

impl<'a> Context<'a> {
    /// Final accuracy, and no least time. The nominal motion has its first conflict at a time, seconds.
    pub(crate) fn new(
        problem: &'a Problem<'a>,
        route: &'a Route,
        proxies: &'a [Proxy<'a>],
        blocks: &'a [Proxy<'a>],
        first_conflict: f64,
    ) -> Self {
        Self {
            problem,
            route,
            proxies,
            blocks,
            speeds: ManoeuvreSpeeds::at(problem, first_conflict),
            chord: FINE_CHORD_RAD,
            segment_time: 0.0,
        }
    }

    /// First time at which a motion meets a set or land, seconds.
    pub(crate) fn first_conflict(&self, motion: &[Segment]) -> Option<f64> {
        let contact = first_contact(self.proxies, motion).map(|c| c.1);
        let grounding = land::first_contact(self.problem.land_obstacle, motion);
        contact.into_iter().chain(grounding).reduce(f64::min)
    }
}
