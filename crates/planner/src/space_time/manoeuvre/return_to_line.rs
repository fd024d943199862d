//! Return onto a leg: turn, line, turn.

use crate::Problem;
use crate::space_time::manoeuvre::chain::Chain;
use crate::space_time::route::Route;
use searoom_geometry::frame::{Pose, Side, Vector, cross, heading_of, wrap};
use searoom_model::trajectory::Segment;

/// Turn, line and turn onto a leg's line; each may have zero length.
#[derive(Debug, Clone, Copy)]
struct Return {
    /// Signed length of the first arc (to port positive), length of the line, signed length of the
    /// last arc, metres.
    pub first: f64,
    pub line: f64,
    pub last: f64,
}

/// Motion at the greatest speed from a pose and time back onto a leg, then along the route to its
/// end. `None` where the return does not end on the leg.
pub(crate) fn motion_back(
    problem: &Problem,
    route: &Route,
    (pose, time): (&Pose, f64),
    leg: usize,
    angle: f64,
) -> Option<Vec<Segment>> {
    let (own, desired) = (problem.own, problem.desired);
    let (radius, stretch) = (own.turning_radius, route.stretch(leg, desired)?);
    let l = &desired.legs()[leg];
    let back = return_to_line(pose, l.start, heading_of(l.direction), radius, angle)?;
    let mut chain = Chain::new(*pose, time, own.max_speed(), radius);
    chain.arc(back.first);
    chain.line(back.line);
    chain.arc(back.last);
    let along = l.direction.dot(&(chain.pose.position - l.start));
    if !(along >= stretch.from && along <= stretch.to) {
        return None;
    }
    let rest = route.follow(stretch.distance + along - stretch.from, chain.time);
    chain.segments.extend(rest);
    Some(chain.segments)
}

/// Return onto the line through `origin` along `heading`, approached at `angle` radians: first from
/// own ship's side, else across the line. `None` where neither fits.
fn return_to_line(
    pose: &Pose,
    origin: Vector,
    heading: f64,
    radius: f64,
    angle: f64,
) -> Option<Return> {
    let ahead = searoom_geometry::frame::direction(heading);
    let offset = cross(ahead, pose.position - origin);
    let relative = wrap(pose.heading - heading);
    let near = if offset >= 0.0 {
        Side::Port
    } else {
        Side::Starboard
    };
    for side in [near, near.opposite()] {
        for share in [1.0, 0.7, 0.45, 0.25] {
            let toward = -side.turn_sign() * angle * share;
            let turn = toward - relative;
            let curvature = turn.signum() / radius;
            let after_first = offset + (relative.cos() - toward.cos()) / curvature;
            let last_gain = (toward.cos() - 1.0) * side.turn_sign() * radius;
            let line = -(after_first + last_gain) / toward.sin();
            if line >= 0.0 {
                return Some(Return {
                    first: turn * radius,
                    line,
                    last: -toward * radius,
                });
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_return_ends_on_the_line_on_its_course() {
        for i in 0..400 {
            let k = f64::from(i);
            let pose = Pose::new(
                Vector::new(k, 150.0 * (k * 0.3).sin()),
                1.2 * (k * 0.7).cos(),
            );
            let (origin, heading) = (Vector::new(0.0, 5.0), 0.1);
            let Some(back) = return_to_line(&pose, origin, heading, 100.0, 0.6) else {
                continue;
            };
            let mut at = pose;
            for (length, bend) in [(back.first, true), (back.line, false), (back.last, true)] {
                let curvature = if bend { length.signum() / 100.0 } else { 0.0 };
                at = searoom_model::trajectory::Segment::new(at, 0.0, length.abs(), 1.0, curvature)
                    .end();
            }
            let ahead = searoom_geometry::frame::direction(heading);
            assert!(cross(ahead, at.position - origin).abs() < 1e-9, "{back:?}");
            assert!(wrap(at.heading - heading).abs() < 1e-9);
        }
    }
}
