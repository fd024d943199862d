//! The obstacles of one problem with what a quick test needs.

use crate::frame::Vector;
use crate::obstacle::{PolytopeObstacle, contact};
use crate::trajectory::Segment;

/// Metres. Planned motions may touch a set; deeper than this they meet it. A tenth of what a checker
/// rejects.
pub(crate) const TOUCH_M: f64 = 1e-7;

/// An obstacle inside a growing disc that moves with its middle.
#[derive(Debug)]
pub(crate) struct Hazard<'a> {
    pub body: &'a PolytopeObstacle,
    centre: Vector,
    drift: Vector,
    radius: f64,
    growth: f64,
}

impl<'a> Hazard<'a> {
    pub(crate) fn new(body: &'a PolytopeObstacle) -> Self {
        let (centre, drift) = (body.initial().centroid(), body.velocity().centroid());
        Self {
            body,
            centre,
            drift,
            radius: body.initial().translated(-centre).reach(),
            growth: body.velocity().translated(-drift).reach(),
        }
    }

    /// A lower bound of the distance between the segment and the obstacle, metres; negative says nothing.
    pub(crate) fn clearance_bound(&self, segment: &Segment) -> f64 {
        let half = 0.5 * segment.duration;
        let middle = segment.start_time + half;
        let apart = segment.pose_after(half).position - self.centre - self.drift * middle;
        let closing = (segment.speed + self.drift.norm()) * half;
        apart.norm() - closing - self.radius - self.growth * segment.end_time()
    }

    /// Metres from a point inside to the boundary of the section in a direction.
    pub(crate) fn way_out(&self, position: Vector, time: f64, toward: Vector) -> f64 {
        self.body
            .faces()
            .iter()
            .filter(|f| f.normal.dot(&toward) > 1e-9)
            .map(|f| (-f.slack(position, time)).max(0.0) / f.normal.dot(&toward))
            .fold(f64::INFINITY, f64::min)
    }

    /// Position and velocity relative to the middle of the obstacle.
    pub(crate) fn relative(
        &self,
        position: Vector,
        velocity: Vector,
        time: f64,
    ) -> (Vector, Vector) {
        (
            position - self.centre - self.drift * time,
            velocity - self.drift,
        )
    }

    /// The first instant at which the segment is inside, deeper than touching.
    pub(crate) fn first_contact(&self, segment: &Segment) -> Option<f64> {
        if self.clearance_bound(segment) > 0.0 {
            return None;
        }
        contact::first_contact(self.body, segment, TOUCH_M)
    }
}

/// The first obstacle, in their order, that the first segment to meet any meets deeper than touching.
pub(crate) fn first_met(hazards: &[Hazard], segments: &[Segment]) -> Option<usize> {
    segments.iter().find_map(|s| {
        hazards
            .iter()
            .position(|h| h.clearance_bound(s) <= 0.0 && contact::meets(h.body, s, TOUCH_M))
    })
}

/// The first contact of a chain of segments with any obstacle: `(obstacle, time)`; of several at one
/// instant the first obstacle.
pub(crate) fn first_contact(hazards: &[Hazard], segments: &[Segment]) -> Option<(usize, f64)> {
    for segment in segments {
        let hit = hazards
            .iter()
            .enumerate()
            .filter_map(|(i, h)| h.first_contact(segment).map(|t| (i, t)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        if hit.is_some() {
            return hit;
        }
    }
    None
}
