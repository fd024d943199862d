//! Queries of a polytope: distance, contact, risk, closest approach, velocity obstacle.

use crate::closest_approach::{ClosestApproach, from_edge, polytope_approach, usable_horizon};
use crate::contact::{self, Line};
use crate::risk::{PeakRisk, level_of, peak_by_bisection, polytope_alpha, polytope_peak};
use crate::{MovingVertex, PolytopeObstacle, SpaceTimeObstacle, Support};
use searoom_geometry::SignedDistance;
use searoom_geometry::frame::Vector;
use searoom_model::trajectory::Segment;

impl SpaceTimeObstacle for PolytopeObstacle {
    fn name(&self) -> &str {
        self.name()
    }

    fn support(&self, normal: Vector, time: f64) -> Support {
        let rate = self.velocity().support(normal);
        Support {
            value: self.initial().support(normal) + rate * time,
            rate,
        }
    }

    /// O(n + m).
    fn signed_distance(&self, position: Vector, time: f64) -> SignedDistance {
        let slack = self.slack(position, time);
        let inside = SignedDistance {
            distance: slack.value,
            normal: self.faces()[slack.face].normal,
        };
        // negated so that a NaN is returned
        if !(slack.value > 0.0) {
            return inside;
        }
        let at = |v: &MovingVertex| v.origin + v.velocity * time;
        let moving = self.moving_vertices();
        let mut from = at(&moving[moving.len() - 1]);
        let mut nearest = Vector::repeat(f64::INFINITY);
        for vertex in moving {
            let to = at(vertex);
            let offset = from_edge(position, from, to);
            if offset.norm_squared() < nearest.norm_squared() {
                nearest = offset;
            }
            from = to;
        }
        let distance = nearest.norm();
        if distance > 0.0 {
            SignedDistance {
                distance,
                normal: nearest / distance,
            }
        } else {
            inside
        }
    }

    fn contains(&self, position: Vector, time: f64) -> bool {
        self.contains(position, time)
    }

    fn first_contact(&self, segment: &Segment, depth: f64) -> Option<f64> {
        contact::first_contact(self, segment, depth)
    }

    /// O(n + m).
    fn alpha_within(&self, position: Vector, time: f64, edge: f64) -> f64 {
        let (faces, spreads) = (self.faces(), self.spreads());
        polytope_alpha(faces, spreads, position, time, edge)
    }

    /// Closed form on a line, O((n + m)²) at worst. On an arc bisection over exact contacts, to
    /// [`searoom_geometry::tolerance::RISK`].
    fn peak_risk(&self, segment: &Segment) -> PeakRisk {
        if segment.is_valid() && !segment.is_arc() {
            polytope_peak(self.faces(), self.spreads(), &Line::of(segment))
        } else {
            // contact depends on the faces alone
            let mut level = self.clone();
            peak_by_bisection(segment.start_time, |risk| {
                let alpha = level_of(risk);
                let faces = self.faces().iter().zip(self.spreads());
                level.move_faces(faces.map(|(face, spread)| Support {
                    value: face.initial_support,
                    rate: spread.nominal_rate
                        + alpha * (face.velocity_support - spread.nominal_rate),
                }));
                contact::first_contact(&level, segment, 0.0)
            })
        }
    }

    fn at_risk(&self, risk: f64) -> Self {
        let velocity = self.velocity().scaled_about_center(level_of(risk));
        Self::new(self.name(), self.initial().clone(), velocity)
    }

    /// In closed form, O(n + m).
    fn closest_approach(
        &self,
        position: Vector,
        velocity: Vector,
        horizon: f64,
    ) -> ClosestApproach {
        polytope_approach(self, position, velocity, horizon)
    }

    /// By the faces, O(n + m); [`PolytopeObstacle::velocity_obstacle`] gives the region.
    fn in_velocity_obstacle(&self, position: Vector, velocity: Vector, horizon: f64) -> bool {
        usable_horizon(position, velocity, horizon).is_none_or(|end| {
            contact::clip(self, &Line::ahead(position, velocity, end), 0.0).is_some()
        })
    }
}
