//! Manoeuvres through given corners, from which a refinement starts.

use crate::space_time::context::Context;
use crate::space_time::manoeuvre::ending::Ending;
use crate::space_time::manoeuvre::motion::sailed_between;
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::refinement::structure::SegmentVariable;
use crate::space_time::refinement::{InitialGuess, Refinement};
use crate::space_time::selection::initial_guess::InitialGuessBuilder;
use searoom_geometry::frame::{Side, Vector, cross, heading_of, wrap};
use searoom_model::trajectory::Segment;

/// Largest number of corners of a manoeuvre: with more, its segment variables do not fit.
pub(crate) const MAX_CORNERS: usize = 6;

/// Largest numbers of corners with turns at the slow speed too, and with lines at the normal speed.
const MOST_WITH_SLOW_TURNS: usize = 3;
const MOST_WITH_ALL_SPEEDS: usize = 4;

/// A corner this near to the route, in turning radii, is on it. A line at less than this angle to
/// it, in radians, does not return to it.
const ON_ROUTE: f64 = 0.05;

/// Metres. A manoeuvre does not return where its last corner is.
pub(crate) const SHORTEST_M: f64 = 1.0;

/// Longest turn at a corner, radians.
const SHARPEST: f64 = 2.2;

/// Corner of a manoeuvre: where its lines meet, and about when.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Corner {
    pub time: f64,
    pub position: Vector,
}

/// At least two and at most [`MAX_CORNERS`] corners that a manoeuvre goes through after it leaves the nominal
/// motion at the first of them.
pub(crate) struct Corners<'c> {
    pub nominal_motion: &'c [Segment],
    pub corners: &'c [Corner],
    /// True where it goes on to the last waypoint, otherwise back onto the route.
    pub to_goal: bool,
}

impl Corners<'_> {
    /// Refinement of a manoeuvre through these corners; `None` where none fits.
    pub(crate) fn refinement(&self, context: &Context) -> Option<Refinement> {
        let angles = context.problem.settings.guesses.return_angles.into_iter();
        angles
            .filter_map(|angle| self.guess(context, angle))
            .find_map(|guess| Refinement::fitting(context, guess))
    }

    /// Manoeuvre through the corners. It goes back onto the route at an angle, radians, unless the last
    /// corner is where it returns.
    fn guess(&self, context: &Context, angle: f64) -> Option<InitialGuess> {
        let corners = self.corners;
        let (problem, route) = (context.problem, context.route);
        let radius = problem.own.turning_radius;
        let first = corners.first()?;
        let speeds = ManoeuvreSpeeds::at(problem, first.time);
        let sailed = sailed_between(self.nominal_motion, 0.0, first.time);
        let (departure, _) = route.pose_at(sailed);
        let mut builder = InitialGuessBuilder::default();
        let run = |builder: &mut InitialGuessBuilder, length: f64| {
            let length = length.max(0.0);
            let [slow, normal, fast] =
                mixed(&speeds, length, first.time - route.ordered_time(length));
            builder.runs(&speeds, normal, fast, slow);
        };
        // a corner may be ahead of where own ship is then, or behind it
        let off = first.position - departure.position;
        let along = sailed + departure.ahead().dot(&off);
        let (leg, end) = self.ending(context, angle);
        let last = corners[corners.len() - 1].position;
        if end.is_some_and(|end| (end - last).norm() < SHORTEST_M) {
            return None;
        }
        let mut points: Vec<Vector> = corners.iter().map(|corner| corner.position).collect();
        points.extend(end);
        let turns = points.len() - 1;
        // without a turn there is nothing to refine
        if !(1..=MAX_CORNERS).contains(&turns) {
            return None;
        }
        let mut heading = departure.heading;
        let mut angles = Vec::with_capacity(turns);
        for pair in points.windows(2) {
            let next = heading_of(pair[1] - pair[0]);
            angles.push(wrap(next - heading));
            heading = next;
        }
        // negated on purpose: a NaN is too sharp
        if angles.iter().any(|angle| !(angle.abs() < SHARPEST)) {
            return None;
        }
        let tangent = |angle: f64| radius * (0.5 * angle.abs()).tan();
        run(&mut builder, along - tangent(angles[0]));
        for (i, &angle) in angles.iter().enumerate() {
            let side = Side::of_turn(angle).unwrap_or(Side::Starboard);
            let last = i + 1 == turns;
            if last && self.to_goal {
                let speed = speeds.fast;
                return builder.build(Ending::Goal { side, speed });
            }
            let arc = |speed: f64| SegmentVariable::Arc { side, speed };
            if turns <= MOST_WITH_SLOW_TURNS {
                builder.push(arc(speeds.slow), 0.0);
            }
            builder.push(arc(speeds.fast), radius * angle.abs());
            if last {
                break;
            }
            let way = (points[i + 1] - points[i]).norm();
            let length = (way - tangent(angle) - tangent(angles[i + 1])).max(0.0);
            let time = (corners[i + 1].time - corners[i].time) * length / way;
            let [slow, normal, fast] = mixed(&speeds, length, time - length / speeds.normal);
            let line = |speed: f64| SegmentVariable::Line { speed };
            builder.push(line(speeds.slow), slow);
            if turns <= MOST_WITH_ALL_SPEEDS {
                builder.push(line(speeds.normal), normal);
                builder.push(line(speeds.fast), fast);
            } else {
                builder.push(line(speeds.fast), normal + fast);
            }
        }
        builder.build(Ending::Return {
            leg,
            speed: speeds.fast,
        })
    }

    /// The leg to which a manoeuvre through corners returns, and where; nowhere if the last corner is
    /// there already. The end of the path for a manoeuvre that goes there.
    fn ending(&self, context: &Context, angle: f64) -> (usize, Option<Vector>) {
        let problem = context.problem;
        let legs = problem.desired.legs();
        let [.., before, last] = self.corners else {
            return (0, None);
        };
        let leg = legs.iter().position(|l| l.end_time() > last.time);
        let leg = leg.unwrap_or(legs.len() - 1);
        if self.to_goal {
            return (leg, Some(problem.desired.end()));
        }
        let line = &legs[leg];
        let offset = |p: Vector| cross(line.direction, p - line.start);
        let way = last.position - before.position;
        let is_back = offset(last.position).abs() < ON_ROUTE * problem.own.turning_radius
            && cross(line.direction, way).abs() > ON_ROUTE * way.norm()
            && line.direction.dot(&way) > 0.0;
        if is_back {
            return (leg, None);
        }
        let back = offset(last.position).abs() / angle.tan();
        let along = line.direction.dot(&(last.position - line.start)) + back;
        (leg, Some(line.start + line.direction * along))
    }
}

/// Lengths at the slow, the normal and the fast speed that together take some seconds more than the
/// normal speed, as nearly as possible.
fn mixed(speeds: &ManoeuvreSpeeds, length: f64, spare: f64) -> [f64; 3] {
    let ManoeuvreSpeeds {
        slow, normal, fast, ..
    } = *speeds;
    let other = if spare > 0.0 { slow } else { fast };
    // without another speed the share is a NaN or infinite, and becomes the length
    let share = (spare / (1.0 / other - 1.0 / normal)).min(length).max(0.0);
    if spare > 0.0 {
        [share, length - share, 0.0]
    } else {
        [0.0, length - share, share]
    }
}
