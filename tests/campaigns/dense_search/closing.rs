//! Closed-form ways back to the path and to its end, as turns and runs.

use searoom::frame::{Pose, Vector, heading_of};
use searoom::trajectory::Segment;

/// Angles (radians) between path and closing line that are tried.
const RETURN_ANGLES: [f64; 4] = [0.15, 0.3, 0.5, 0.8];

/// A turn (counter-clockwise positive, radians) or a run straight on (metres).
#[derive(Debug, Clone, Copy)]
pub enum Piece {
    Turn(f64),
    Run(f64),
}

/// Segments at one speed along the pieces; empty pieces leave none.
pub fn chain(from: &Pose, time: f64, speed: f64, radius: f64, pieces: &[Piece]) -> Vec<Segment> {
    let (mut pose, mut now) = (*from, time);
    let mut segments = Vec::with_capacity(pieces.len() + 2);
    for piece in pieces {
        let (length, turn) = match *piece {
            Piece::Turn(angle) => (angle.abs() * radius, angle.signum()),
            Piece::Run(length) => (length, 0.0),
        };
        if length > 1e-9 {
            let segment = Segment::new(pose, now, length / speed, speed, turn * speed / radius);
            (pose, now) = (segment.end(), segment.end_time());
            segments.push(segment);
        }
    }
    segments
}

/// Arc, line, arc that end on the path and along it, for a ship `across` metres to port of it whose
/// heading is `heading` from it. One way per angle of the line, and the one with no line.
pub fn returns(across: f64, heading: f64, radius: f64) -> Vec<[Piece; 3]> {
    // seen from the port side of the path; the starboard side is its mirror image
    let mirror = if across < 0.0 || (across == 0.0 && heading < 0.0) {
        -1.0
    } else {
        1.0
    };
    let (y, psi) = (across * mirror, heading * mirror);
    // no line: turn away down to -g, then back; r cos g = (r + r cos psi - y) / 2
    let without = (radius + radius * psi.cos() - y) / (2.0 * radius);
    let without = (without.abs() <= 1.0).then(|| without.acos());
    let mut ways = Vec::new();
    for angle in RETURN_ANGLES.into_iter().chain(without) {
        let turn = -angle - psi;
        // height after the first turn, by r (cos - cos) on either circle
        let rise = radius * (angle.cos() - psi.cos());
        let start_of_line = if turn < 0.0 { y + rise } else { y - rise };
        let end_of_line = radius * (1.0 - angle.cos());
        let line = (start_of_line - end_of_line) / angle.sin();
        if line >= -1e-7 && angle > 1e-6 {
            ways.push([
                Piece::Turn(turn * mirror),
                Piece::Run(line.max(0.0)),
                Piece::Turn(angle * mirror),
            ]);
        }
    }
    if y < 1e-6 && psi.abs() < 1e-9 {
        ways.push([Piece::Run(0.0); 3]);
    }
    ways
}

/// One arc to the side of `turn`, then a line to the point: nothing when it is inside the circle.
pub fn turn_then_straight(
    pose: &Pose,
    point: Vector,
    turn: f64,
    radius: f64,
) -> Option<[Piece; 2]> {
    let centre = pose.world_coordinates(Vector::new(0.0, turn * radius));
    let to_point = point - centre;
    let run = (to_point.norm_squared() - radius * radius).sqrt();
    let course = heading_of(to_point) + turn * radius.atan2(run);
    let angle = (turn * (course - pose.heading)).rem_euclid(std::f64::consts::TAU);
    (run.is_finite() && angle < 3.0).then_some([Piece::Turn(turn * angle), Piece::Run(run)])
}
