//! Corners of a motion.

use searoom_geometry::frame::Vector;
use searoom_model::trajectory::Segment;

/// Turns below this are no corners, radians.
const STRAIGHT: f64 = 0.03;

/// Corner of a manoeuvre: where its lines meet, and about when.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Corner {
    pub time: f64,
    pub position: Vector,
}

/// Where the lines of a motion meet; its end if there is no turn.
pub(crate) fn corners_of(legs: &[Segment]) -> Vec<Corner> {
    let mut corners: Vec<Corner> = Vec::new();
    let mut turn: Option<(Segment, f64)> = None;
    let mut end = |turn: &mut Option<(Segment, f64)>| {
        if let Some((first, angle)) = turn.take()
            && angle.abs() > STRAIGHT
        {
            let radius = first.speed / first.turn_rate.abs();
            corners.push(Corner {
                time: first.start_time + 0.5 * angle.abs() / first.turn_rate.abs(),
                position: first.start.position
                    + first.start.ahead() * (radius * (0.5 * angle.abs()).min(1.2).tan()),
            });
        }
    };
    for leg in legs.iter().filter(|leg| leg.duration > 0.0) {
        let angle = leg.turn_rate * leg.duration;
        match &mut turn {
            Some((_, sum)) if angle * *sum > 0.0 => *sum += angle,
            _ if angle != 0.0 => {
                end(&mut turn);
                turn = Some((*leg, angle));
            }
            Some(_) if leg.length() > 1.0 => end(&mut turn),
            _ => {}
        }
    }
    end(&mut turn);
    if corners.is_empty() {
        corners.extend(legs.last().map(|leg| Corner {
            time: leg.end_time(),
            position: leg.end().position,
        }));
    }
    corners
}
