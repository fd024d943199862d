//! Trial point of the refinement: one rolled-out manoeuvre with its cost and closest approaches.
//! This suffices to accept or reject a step; derivatives are computed for accepted ones only.

use crate::space_time::context::Context;
use crate::space_time::land;
use crate::space_time::manoeuvre::ending::Ending;
use crate::space_time::refinement::approach::{Approach, NEAR_M, add_approaches};
use crate::space_time::refinement::model::REFINEMENT_MARGIN_M;
use crate::space_time::refinement::quadratic::Row;
use crate::space_time::refinement::return_segments::ReturnSegments;
use crate::space_time::refinement::rollout::{Place, Rollout, SegmentOrigin};
use crate::space_time::refinement::structure::Structure;
use searoom_geometry::numerics::{GAUSS_2, GAUSS_3, GAUSS_4};
use searoom_model::trajectory::Nearest;

/// Evaluated trial point.
#[derive(Debug)]
pub(crate) struct Trial {
    pub rollout: Rollout,
    /// Cost, m².
    pub cost: f64,
    /// Largest missing slack, metres; zero when clear with the margin. A sum would make the merit
    /// function jump when one approach splits in two.
    pub violation: f64,
    /// Least slack of all approaches, metres.
    pub least_slack: f64,
    pub approaches: Vec<Approach>,
    /// Return segments or the wait at the end, if any.
    pub return_segments: Option<ReturnSegments>,
    /// Rates of the joining position and time.
    pub joining: (Row, Row),
    /// Quadrature points of the cost before the return segments.
    pub points: Vec<Point>,
}

/// Quadrature point of a segment variable's cost.
#[derive(Debug)]
pub(crate) struct Point {
    pub variable: usize,
    /// Cost per metre of the segment variable, m².
    pub growth: f64,
    /// `None` where the segment variable is empty.
    pub weighed: Option<WeightedPoint>,
}

/// Position of a quadrature point, its nearest desired position, and its weight.
#[derive(Debug)]
pub(crate) struct WeightedPoint {
    pub place: Place,
    pub nearest: Nearest,
    pub weight: f64,
}

impl<'a> Context<'a> {
    /// Rolls out and computes the cost; `None` when the manoeuvre's ending does not fit.
    pub(crate) fn trial(&self, structure: &Structure, lengths: &Row) -> Option<Trial> {
        let rollout = structure.roll_out(self.problem, self.route, lengths)?;
        let mut points = Vec::with_capacity(GAUSS_4.len() * rollout.return_segments);
        for leg in 0..rollout.return_segments {
            self.add_points(&rollout, leg, &mut points);
        }
        let weighed = points.iter().filter_map(|p| p.weighed.as_ref());
        let mut cost: f64 = weighed.map(|w| w.weight * w.nearest.error).sum();
        let return_segments = match structure.ending {
            Ending::Goal { .. } => self.wait_at_end(&rollout),
            _ => Some(self.return_segments(rollout.joined.0, rollout.joined.1)),
        };
        cost += return_segments.as_ref().map_or(0.0, |t| t.cost);
        let sails = rollout.legs.iter().map(|l| &l.segment);
        let land = land::near(self.problem.land_obstacle, sails, NEAR_M);
        let middles = rollout.middles();
        let mut approaches = Vec::new();
        let near_land = land.into_iter().map(|b| &self.blocks[b]);
        for proxy in self.proxies.iter().chain(near_land) {
            add_approaches(proxy, &rollout, &middles, self.chord, &mut approaches);
        }
        let least_slack = approaches
            .iter()
            .fold(f64::INFINITY, |least, a| least.min(a.slack));
        let joining = rollout.joining_rates();
        Some(Trial {
            rollout,
            cost,
            violation: (REFINEMENT_MARGIN_M - least_slack).max(0.0),
            least_slack,
            approaches,
            return_segments,
            joining,
            points,
        })
    }

    /// Quadrature points of a segment.
    fn add_points(&self, rollout: &Rollout, leg: usize, points: &mut Vec<Point>) {
        let SegmentOrigin::SegmentVariable { index, grows } = rollout.legs[leg].owner else {
            return;
        };
        let segment = rollout.legs[leg].segment;
        let desired = self.problem.desired;
        let q = self.problem.time_weight;
        let per_time = 1.0 / desired.duration();
        let growth = if grows { per_time / segment.speed } else { 0.0 };
        if segment.duration <= 0.0 {
            let nearest = desired.nearest(segment.start.position, segment.start_time, q);
            points.push(Point {
                variable: index,
                growth: growth * nearest.error,
                weighed: None,
            });
            return;
        }
        let nodes: &[(f64, f64)] = match segment.turn_rate.abs() * segment.duration {
            turn if turn < 0.3 => &GAUSS_2,
            turn if turn < 1.0 => &GAUSS_3,
            _ => &GAUSS_4,
        };
        for (fraction, share) in nodes {
            let Some(place) = rollout.place(leg, *fraction) else {
                continue;
            };
            let nearest = desired.nearest(place.position, place.time, q);
            points.push(Point {
                variable: index,
                growth: growth * share * nearest.error,
                weighed: Some(WeightedPoint {
                    place,
                    nearest,
                    weight: segment.duration * per_time * share,
                }),
            });
        }
    }
}
