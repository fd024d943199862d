//! Set against which a plan was made.

use crate::Violation;
use crate::distance::clearance::Body;
use crate::least::Least;
use crate::piece::{Piece, end_of, since};
use crate::safety::entered;
use crate::sets::moving_slabs::MovingSlabs;
use searoom_geometry::ConvexSet;
use searoom_model::target::Uncertainty;

/// Space-time set against which a plan was made.
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceTimeSet {
    /// Name of the target.
    pub name: String,
    /// Time from which the set is valid, seconds; the time of the sets starts at zero then.
    pub from: f64,
    /// Every position reached with these velocities. For ellipses the section is the ellipse of
    /// least trace around the sum, an outer set.
    pub sets: Uncertainty,
}

impl SpaceTimeSet {
    /// Builds the set `initial + t velocity`, `t >= 0`; metres and m/s.
    pub fn constant(
        name: impl Into<String>,
        initial: impl Into<ConvexSet>,
        velocity: impl Into<ConvexSet>,
    ) -> Self {
        Self {
            name: name.into(),
            from: 0.0,
            sets: Uncertainty::constant(initial, velocity),
        }
    }

    /// Least signed distance of own ship's position from the set while the set is valid. Infinite
    /// where no piece is within that time.
    pub fn least_distance<P: Piece>(&self, pieces: &[P]) -> Least {
        self.judged("", pieces).0
    }

    /// [`Self::least_distance`], and the violation if the set is entered.
    pub(crate) fn judged<P: Piece>(&self, label: &str, pieces: &[P]) -> (Least, Option<Violation>) {
        let later;
        let pieces = if self.from == 0.0 {
            pieces
        } else {
            later = since(pieces, self.from, self.from);
            &later
        };
        let slabs = MovingSlabs::until(&self.sets, end_of(pieces));
        let mut least = slabs.least_distance(pieces, Body::POINT);
        let mut entered = entered(label, &slabs, pieces, &least);
        least.time += self.from;
        if let Some(violation) = &mut entered {
            violation.time += self.from;
        }
        (least, entered)
    }
}
