//! The desired path as own ship can sail it, from its own pose to the last waypoint, with a
//! schedule and the policy that follows it.

use std::f64::consts::FRAC_PI_2;

use crate::Problem;
use crate::clock::Clock;
use searoom_colregs::{ON_COURSE, SMALL_TURN};
use searoom_geometry::frame::{Pose, cross, heading_of, wrap};
use searoom_geometry::tolerance;
use searoom_model::trajectory::{DesiredTrajectory, Segment};
use searoom_model::vessel::dubins;

/// Seconds. A smaller deviation from the schedule counts as on time.
const ON_TIME_S: f64 = 1e-6;

/// Joining points ahead of the nearest point of the path, in turning radii.
const JOINS: [f64; 10] = [0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 9.0, 14.0];

/// Turning radii. A sharper corner is passed on the mean course: rounding it would leave out too
/// much of its legs.
const LONGEST_TANGENT_RADII: f64 = 3.0;

/// Turning radii. A waypoint nearer than this to the last one, without room for its corner, is
/// skipped.
const SKIPPED_RADII: f64 = 4.0;

/// Least distance between two changes of speed, metres. Shorter remainders of a piece would vanish
/// in rounding.
const SHORTEST_M: f64 = 1e-3;

/// Seconds of the least change of speed where the rules ask for plain manoeuvres.
pub(crate) const LEAST_CHANGE_S: f64 = 3.0;

/// Factor of the cost of a route that joins the path by turns that are visible but small, or very
/// large. It counts where the rules ask for plain manoeuvres.
const ODD_TURNS_PRICE: f64 = 1e3;

/// Line or arc of the route.
#[derive(Debug, Clone, Copy)]
struct RoutePiece {
    start: Pose,
    /// Distance along the route at its start, metres.
    distance: f64,
    length: f64,
    /// Curvature, radians per metre, to port positive.
    curvature: f64,
    /// Scheduled time at its start, and seconds per metre along it.
    due: f64,
    slowness: f64,
    /// Leg that it lies on, where it is straight on one.
    leg: Option<usize>,
    /// Speed of its leg, or of the leg before a corner, m/s.
    ordered: f64,
    /// Speed regardless of the schedule: set for the joining manoeuvre.
    speed: Option<f64>,
}

impl RoutePiece {
    fn end(&self) -> Pose {
        self.pose_after(self.length)
    }

    /// Remaining length at a distance along the route, metres; at its start exactly its own length.
    fn left(&self, at: f64) -> f64 {
        self.length - (at - self.distance)
    }

    fn pose_after(&self, distance: f64) -> Pose {
        segment(self.start, 0.0, distance, 1.0, self.curvature).end()
    }
}

fn segment(start: Pose, start_time: f64, length: f64, speed: f64, curvature: f64) -> Segment {
    Segment::new(start, start_time, length / speed, speed, curvature * speed)
}

/// Straight stretch of the route on one leg.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StraightStretch {
    /// Distance along the route at its start, metres.
    pub distance: f64,
    /// Distances along the leg at its start and end, metres.
    pub from: f64,
    pub to: f64,
}

/// Sailable path with its schedule.
#[derive(Debug, Clone)]
pub(crate) struct Route {
    pieces: Vec<RoutePiece>,
    /// Own ship's speeds, increasing.
    speeds: Vec<f64>,
    /// Shortest change of speed that is made only to regain the schedule, seconds.
    least_change: f64,
    /// Seconds for which a speed is kept where the speed alternates.
    speed_time: f64,
    /// Metres between two returns to schedule, least metres of the faster part, and most alternations on a piece,
    /// where the speed alternates.
    alternation: [f64; 3],
}

/// Order of routes: those in time first, then by cost.
struct Rank {
    /// True where the route is too long for the horizon.
    is_late: bool,
    /// Space-time error with the price of odd turns, m².
    cost: f64,
}

impl Rank {
    /// True where this route is better by more than rounding.
    fn is_less_than(&self, other: &Self) -> bool {
        match self.is_late == other.is_late {
            true => self.cost < other.cost * (1.0 - 1e-9) - 1e-9,
            false => other.is_late,
        }
    }
}

impl Route {
    /// Cheapest route of those that join the path at [`JOINS`] at each speed. Corners are rounded
    /// with the turning radius where the legs are long enough; otherwise the mean course leads
    /// through them. `None` only when nothing is finite. After the deadline, the best route so far
    /// or the shortest, which is at the greatest speed until it joins the path.
    pub(crate) fn new(problem: &Problem, clock: Clock) -> Option<Self> {
        let mut best: Option<(Rank, Self)> = None;
        for (leg, along) in joins(problem) {
            for speed in problem.own.moving_speeds() {
                if clock.is_up()
                    && let Some(first) = best
                {
                    let shortest = Self::shortest(problem);
                    let shortest = shortest.map(|(leg, r)| (r.rank(problem, leg), r));
                    let better = shortest.filter(|(rank, _)| rank.is_less_than(&first.0));
                    return Some(better.unwrap_or(first).1);
                }
                let Some(route) = Self::joining(problem, leg, along, speed) else {
                    continue;
                };
                let route = route.before_horizon(problem);
                let rank = route.rank(problem, leg);
                let is_less = best.as_ref().is_none_or(|(b, _)| rank.is_less_than(b));
                if rank.cost.is_finite() && is_less {
                    let direct = route.pieces.first().is_some_and(|p| p.leg.is_some());
                    best = Some((rank, route));
                    // already on the path: every joining point is the same
                    if direct {
                        return best.map(|(_, r)| r);
                    }
                }
            }
        }
        best.map(|(_, route)| route)
    }

    /// Shortest route of those that join the path at the greatest speed, and the leg that it joins.
    fn shortest(problem: &Problem) -> Option<(usize, Self)> {
        let speed = problem.own.max_speed();
        let routes = joins(problem).into_iter().filter_map(|(leg, along)| {
            let route = Self::joining(problem, leg, along, speed)?;
            route.length().is_finite().then_some((leg, route))
        });
        let (leg, shortest) = routes.min_by(|a, b| a.1.length().total_cmp(&b.1.length()))?;
        Some((leg, shortest.before_horizon(problem)))
    }

    fn rank(&self, problem: &Problem, leg: usize) -> Rank {
        let cost = problem.error_to_end(&self.follow(0.0, 0.0));
        let unplain = self.joins_by_odd_turns() || !self.joins_at(problem.desired, leg);
        let is_late = self.arrival(0.0, 0.0) > problem.horizon;
        let price = match asks_for_plain(problem) && unplain && !is_late {
            true => ODD_TURNS_PRICE,
            false => 1.0,
        };
        Rank {
            is_late,
            cost: cost * price,
        }
    }

    /// This route with a faster schedule where the desired one is too late for the horizon.
    fn before_horizon(mut self, problem: &Problem) -> Self {
        let mut arrival = self.arrival(0.0, 0.0);
        if arrival > problem.horizon {
            self.least_change = 0.0;
            arrival = self.arrival(0.0, 0.0);
        }
        if arrival > problem.horizon {
            let factor = problem.horizon * (1.0 - 1e-6) / arrival.max(problem.desired.duration());
            for piece in &mut self.pieces {
                piece.due *= factor;
                piece.slowness *= factor;
                piece.ordered /= factor;
            }
        }
        self
    }

    /// This route, on which own ship does not change its speed to be on schedule again.
    pub(crate) fn without_recovery(&self) -> Self {
        Self {
            least_change: f64::INFINITY,
            ..self.clone()
        }
    }

    /// True where own ship joins the path by a turn that is seen, but not readily apparent, or by a
    /// turn about.
    fn joins_by_odd_turns(&self) -> bool {
        let joining = self.pieces.iter().take_while(|p| p.leg.is_none());
        let mut turns = joining.map(|p| (p.curvature * p.length).abs());
        turns.any(|turn| turn > ON_COURSE && turn < SMALL_TURN || turn > FRAC_PI_2)
    }

    /// True where own ship joins a leg at its speed, or by a turn that is seen.
    fn joins_at(&self, desired: &DesiredTrajectory, leg: usize) -> bool {
        let wanted = desired.legs()[leg].speed;
        let joining = self.pieces.iter().take_while(|p| p.leg.is_none());
        let mut turns = joining.clone().map(|p| (p.curvature * p.length).abs());
        let mut speeds = joining.filter_map(|p| p.speed);
        let nearest = self.nearest_speed(wanted);
        turns.any(|turn| turn > ON_COURSE) || speeds.all(|speed| speed == nearest)
    }

    fn joining(problem: &Problem, leg: usize, along: f64, speed: f64) -> Option<Self> {
        let (own, desired) = (problem.own, problem.desired);
        let legs = desired.legs();
        let heading = |i: usize| heading_of(legs[i].direction);
        let radius = own.turning_radius;
        let first = legs.get(leg)?;
        let mut route = Self {
            pieces: Vec::new(),
            speeds: own.speeds.clone(),
            least_change: if asks_for_plain(problem) {
                LEAST_CHANGE_S
            } else {
                0.0
            },
            speed_time: problem.tidy.map_or(0.0, |tidy| tidy.speed_time),
            alternation: {
                let settings = &problem.settings.route;
                let [apart, least] = match problem.tidy {
                    Some(_) => [
                        settings.tidy_alternation_m,
                        settings.tidy_least_alternation_m,
                    ],
                    None => [settings.alternation_m, settings.least_alternation_m],
                };
                [apart, least, settings.most_alternations]
            },
        };
        let join = Pose::new(first.start + first.direction * along, heading(leg));
        let due = first.start_time + along / first.speed;
        route.connect(own.pose, join, radius, None, (due, speed), Some(speed))?;
        let mut at = (join, due, along);
        for next in leg + 1..legs.len() {
            let before = &legs[next - 1];
            let after = &legs[next];
            let turn = wrap(heading(next) - heading(next - 1));
            let tangent = radius * (turn.abs() / 2.0).tan();
            let share = if next + 1 == legs.len() { 1.0 } else { 0.5 };
            let fits = tangent <= before.length - at.2
                && tangent <= after.length * share
                && tangent <= LONGEST_TANGENT_RADII * radius;
            let (entry, exit, offset) = if turn.abs() < tolerance::JOINT_RAD {
                let pose = Pose::new(after.start, heading(next));
                (pose, pose, 0.0)
            } else if fits {
                (
                    Pose::new(after.start - before.direction * tangent, heading(next - 1)),
                    Pose::new(after.start + after.direction * tangent, heading(next)),
                    tangent,
                )
            } else if (after.start - at.0.position).norm() < SKIPPED_RADII * radius {
                // no room to turn onto a course here: the path is shortened to the next corner
                continue;
            } else {
                let mean = Pose::new(after.start, heading(next - 1) + turn / 2.0);
                (mean, mean, 0.0)
            };
            let entry_due = after.start_time - offset / before.speed;
            let exit_due = after.start_time + offset / after.speed;
            route.connect(
                at.0,
                entry,
                radius,
                Some((next - 1, before)),
                (entry_due, before.speed),
                None,
            )?;
            let due = (exit_due, before.speed);
            route.connect(entry, exit, radius, None, due, None)?;
            at = (exit, exit_due, offset);
        }
        let last = legs.len() - 1;
        // the last waypoint may be reached on any course: on a short last leg, on the direct course
        let chord = desired.end() - at.0.position;
        let short =
            legs[last].length < SKIPPED_RADII * radius && chord.norm() > tolerance::LENGTH_M;
        let end = Pose::new(
            desired.end(),
            if short && at.2 == 0.0 {
                heading_of(chord)
            } else {
                heading(last)
            },
        );
        route.connect(
            at.0,
            end,
            radius,
            Some((last, &legs[last])),
            (desired.duration(), legs[last].speed),
            None,
        )?;
        (!route.pieces.is_empty()).then_some(route)
    }

    /// Appends the shortest path between two poses; `due` is the scheduled time at its end, `ordered` the
    /// speed of its leg.
    fn connect(
        &mut self,
        from: Pose,
        to: Pose,
        radius: f64,
        leg: Option<(usize, &searoom_model::trajectory::DesiredLeg)>,
        (due, ordered): (f64, f64),
        speed: Option<f64>,
    ) -> Option<()> {
        let path = dubins::shortest(&from, &to, radius)?;
        let total = path.length();
        if total <= tolerance::LENGTH_M {
            return Some(());
        }
        let mut pose = from;
        let mut distance = self.length();
        let mut due_here = self.pieces.last().map_or_else(
            || speed.map_or(0.0, |u| due - total / u),
            |p| p.due + p.slowness * p.length,
        );
        let slowness = (due - due_here) / total;
        for part in path.pieces {
            if part.length <= tolerance::LENGTH_M {
                continue;
            }
            let curvature = part.turn.map_or(0.0, |side| side.turn_sign() / radius);
            let on_leg = leg.filter(|(_, l)| {
                curvature == 0.0
                    && cross(l.direction, pose.position - l.start).abs() < tolerance::JOINT_M
                    && wrap(pose.heading - heading_of(l.direction)).abs()
                        <= tolerance::joint_rad(radius)
            });
            let piece = RoutePiece {
                start: on_leg.map_or(pose, |(_, l)| {
                    Pose::new(pose.position, heading_of(l.direction))
                }),
                distance,
                length: part.length,
                curvature,
                due: due_here,
                slowness,
                leg: on_leg.map(|(i, _)| i),
                ordered,
                speed,
            };
            pose = piece.end();
            distance += part.length;
            due_here += slowness * part.length;
            self.pieces.push(piece);
        }
        Some(())
    }

    /// True where own ship changes its speed to be on schedule again.
    pub(crate) fn recovers(&self) -> bool {
        self.least_change < f64::INFINITY
    }

    /// Length, metres.
    pub(crate) fn length(&self) -> f64 {
        self.pieces.last().map_or(0.0, |p| p.distance + p.length)
    }

    fn piece_at(&self, distance: f64) -> usize {
        self.pieces
            .partition_point(|p| p.distance + p.length <= distance)
            .min(self.pieces.len().saturating_sub(1))
    }

    /// Pose and curvature (1/m, to port positive) at a distance along the route.
    pub(crate) fn pose_at(&self, distance: f64) -> (Pose, f64) {
        let piece = &self.pieces[self.piece_at(distance)];
        (piece.pose_after(distance - piece.distance), piece.curvature)
    }

    /// Straight stretch on a leg, if any.
    pub(crate) fn stretch(
        &self,
        leg: usize,
        desired: &DesiredTrajectory,
    ) -> Option<StraightStretch> {
        let piece = self
            .pieces
            .iter()
            .filter(|p| p.leg == Some(leg))
            .max_by(|a, b| a.length.total_cmp(&b.length))?;
        let l = desired.legs().get(leg)?;
        let from = l.direction.dot(&(piece.start.position - l.start));
        Some(StraightStretch {
            distance: piece.distance,
            from,
            to: from + piece.length,
        })
    }

    /// Follows `length` metres of the route at one speed; returns the distance reached.
    pub(crate) fn run(
        &self,
        from: f64,
        time: f64,
        length: f64,
        speed: f64,
        out: &mut Vec<Segment>,
    ) -> f64 {
        self.run_at(from, time, length, |_| speed, out)
    }

    /// Follows `length` metres of the route at the ordered speed of each part; returns the distance
    /// reached. A delay is not made good.
    pub(crate) fn run_ordered(
        &self,
        from: f64,
        time: f64,
        length: f64,
        out: &mut Vec<Segment>,
    ) -> f64 {
        self.run_at(from, time, length, |piece| self.ordered(piece), out)
    }

    fn run_at(
        &self,
        from: f64,
        time: f64,
        length: f64,
        speed: impl Fn(&RoutePiece) -> f64,
        out: &mut Vec<Segment>,
    ) -> f64 {
        let (mut at, mut time) = (from, time);
        let end = (from + length).min(self.length());
        while end - at > tolerance::LENGTH_M {
            let piece = &self.pieces[self.piece_at(at)];
            let step = piece.left(at).min(end - at);
            if step < tolerance::LENGTH_M {
                at = past(at, step);
                continue;
            }
            let part = segment(
                piece.pose_after(at - piece.distance),
                time,
                step,
                speed(piece),
                piece.curvature,
            );
            time += part.duration;
            at += step;
            out.push(part);
        }
        at
    }

    /// Own ship's speed that is nearest to the ordered one.
    fn ordered(&self, piece: &RoutePiece) -> f64 {
        piece
            .speed
            .unwrap_or_else(|| self.nearest_speed(piece.ordered))
    }

    /// Ordered speed at a distance along the route, m/s.
    pub(crate) fn ordered_speed(&self, distance: f64) -> f64 {
        self.ordered(&self.pieces[self.piece_at(distance)])
    }

    /// Seconds from the start to a distance along the route at the ordered speeds.
    pub(crate) fn ordered_time(&self, distance: f64) -> f64 {
        let sailed = |p: &RoutePiece| (distance - p.distance).clamp(0.0, p.length);
        let times = self.pieces.iter().map(|p| sailed(p) / self.ordered(p));
        times.sum()
    }

    /// Distance along the route that is reached at a time at the ordered speeds, metres.
    pub(crate) fn ordered_distance(&self, time: f64) -> f64 {
        let mut left = time;
        for piece in &self.pieces {
            let speed = self.ordered(piece);
            // negated on purpose: a NaN goes nowhere
            if !(left * speed > piece.length) {
                return piece.distance + (left * speed).max(0.0);
            }
            left -= piece.length / speed;
        }
        self.length()
    }

    /// Scheduled time at a distance along the route.
    pub(crate) fn due_at(&self, distance: f64) -> f64 {
        let piece = &self.pieces[self.piece_at(distance)];
        piece.due + piece.slowness * (distance - piece.distance)
    }

    /// Follows the route to its end: at the greatest speed while late, at the least while early,
    /// then on schedule. Where the desired speed is not one of own ship's, the speed alternates
    /// between slower and faster.
    pub(crate) fn follow(&self, from: f64, time: f64) -> Vec<Segment> {
        let mut out = Vec::with_capacity(4);
        let (mut at, mut time) = (from, time);
        let end = self.length();
        while end - at > tolerance::LENGTH_M {
            let index = self.piece_at(at);
            let piece = &self.pieces[index];
            let left = piece.left(at);
            if left < tolerance::LENGTH_M {
                at = past(at, left);
                continue;
            }
            let (speed, length) = self.speed_and_length(piece, at, left, time);
            let step = if left - length < SHORTEST_M {
                left
            } else {
                length.max(SHORTEST_M)
            };
            let pose = piece.pose_after(at - piece.distance);
            let late = time - self.due_at(at);
            if speed == 0.0 {
                let wait = Segment::straight(pose, time, -late, speed);
                time += wait.duration;
                out.push(wait);
                continue;
            }
            let part = segment(pose, time, step, speed, piece.curvature);
            time += part.duration;
            at += step;
            out.push(part);
        }
        out
    }

    /// Arrival time when the route is followed from a distance at a time, seconds.
    pub(crate) fn arrival(&self, from: f64, time: f64) -> f64 {
        let motion = self.follow(from, time);
        motion.last().map_or(time, Segment::end_time)
    }

    /// Speed, and the distance for which to keep it, metres.
    fn speed_and_length(&self, piece: &RoutePiece, at: f64, left: f64, time: f64) -> (f64, f64) {
        if let Some(speed) = piece.speed {
            return (speed, left);
        }
        let slowness = piece.slowness;
        let late = self.worth_a_change(time - self.due_at(at), slowness);
        let (slowest, fastest) = (self.speeds[0], self.speeds[self.speeds.len() - 1]);
        // on an arc own ship keeps its speed unless it is far off schedule
        if piece.curvature != 0.0 && late.abs() < 0.5 * slowness * piece.length {
            return (self.nearest_speed(1.0 / slowness), left);
        }
        // where the schedule is regained at this many seconds per metre
        let regained = |off: f64, rate: f64| {
            if rate > 0.0 {
                (off / rate).min(left)
            } else {
                left
            }
        };
        // a shorter way would overshoot by more than it makes good, a thousand times a metre
        let is_worth_it = |way: f64| way >= SHORTEST_M.min(left);
        if late > ON_TIME_S {
            let way = regained(late, slowness - 1.0 / fastest);
            if is_worth_it(way) {
                return (fastest, way);
            }
        }
        if late < -ON_TIME_S {
            let slower = match self.speed_time > 0.0 && self.listed(slowness).is_none() {
                true => self.slower(slowness).unwrap_or(slowest),
                false => slowest,
            };
            if slower == 0.0 {
                return (0.0, 0.0);
            }
            let way = regained(-late, 1.0 / slower - slowness);
            if is_worth_it(way) {
                return (slower, way);
            }
        }
        // never wait where the schedule allows no time, because zero-length waits would repeat for ever
        if slowness <= 0.0 {
            return (fastest, left);
        }
        if let Some(same) = self.listed(slowness) {
            return (same, left);
        }
        let speed = 1.0 / slowness;
        if !self.recovers() {
            return (self.nearest_speed(speed), left);
        }
        // faster first: own ship then falls back to schedule within the same cycle
        let faster = |u: &&f64| **u > speed && **u > 0.0;
        match self.speeds.iter().find(faster) {
            Some(&fast) => {
                let slow = self.slower(slowness);
                let share = slow.map_or(1.0, |s| (1.0 / s - slowness) / (1.0 / s - 1.0 / fast));
                let [least, least_fast, most] = self.alternation;
                let least = least.max(piece.length / most);
                let mut cycles = (left / least).ceil();
                if let Some(slow) = slow.filter(|_| self.speed_time > 0.0) {
                    let least = self.speed_time * (fast / share).max(slow / (1.0 - share));
                    cycles = cycles.min((left / least).floor());
                }
                let cycle = left / cycles.max(1.0);
                (fast, (cycle * share).max(least_fast))
            }
            None => (fastest, left),
        }
    }

    /// The one of own ship's speeds that keeps the schedule of a stretch, seconds per metre.
    fn listed(&self, slowness: f64) -> Option<f64> {
        let speed = 1.0 / slowness;
        let same = |u: &f64| *u > 0.0 && (u - speed).abs() <= 1e-9 * speed;
        self.speeds.iter().copied().find(same)
    }

    /// Greatest moving speed below that of the schedule.
    fn slower(&self, slowness: f64) -> Option<f64> {
        let mut slower = self.speeds.iter().rev().copied();
        slower.find(|u| *u < 1.0 / slowness && *u > 0.0)
    }

    /// Seconds behind schedule, or none where to make them good takes too little time for a change
    /// of speed.
    fn worth_a_change(&self, late: f64, slowness: f64) -> f64 {
        let (slowest, fastest) = (self.speeds[0], self.speeds[self.speeds.len() - 1]);
        // the time at another speed in which a second is gained or lost
        let takes = match late > 0.0 {
            true => 1.0 / (fastest * slowness - 1.0),
            false => 1.0 / (1.0 - slowest * slowness),
        };
        // a ship that is early at a desired speed of its own does not slow down for a moment
        let least = match late < 0.0 && self.listed(slowness).is_some() {
            true => self.least_change.max(self.speed_time),
            false => self.least_change,
        };
        if takes > 0.0 && late.abs() * takes < least {
            return 0.0;
        }
        late
    }

    fn nearest_speed(&self, speed: f64) -> f64 {
        self.speeds
            .iter()
            .copied()
            .filter(|u| *u > 0.0)
            .min_by(|a, b| (a - speed).abs().total_cmp(&(b - speed).abs()))
            .unwrap_or(speed)
    }
}

/// Distance after a step, which may be smaller than a rounding; always greater than before.
fn past(at: f64, step: f64) -> f64 {
    (at + step).max(at.next_up())
}

/// True where own ship is in an encounter from before, and the rules ask for plain manoeuvres. It
/// is near its route then, and rarely exactly on it.
fn asks_for_plain(problem: &Problem) -> bool {
    let mut encountered = problem.encountered.iter();
    encountered.any(|e| e.risk_since < 0.0) || problem.under_way.is_some()
}

/// Candidate joining points on the path: `(leg, metres along it)`.
fn joins(problem: &Problem) -> Vec<(usize, f64)> {
    let (own, desired) = (problem.own, problem.desired);
    let here = own.pose.position;
    // where the path comes by twice, own ship goes on along the leg that is due
    let due = desired.nearest(here, 0.0, problem.time_weight).distance;
    let geometric = desired.nearest(here, 0.0, 0.0).distance;
    let mut from = vec![due, geometric];
    from.dedup_by(|a, b| (*a - *b).abs() <= own.turning_radius);
    let mut places: Vec<f64> = from
        .into_iter()
        .flat_map(|from| JOINS.map(|k| (from + k * own.turning_radius).min(desired.length())))
        .collect();
    places.dedup();
    places
        .into_iter()
        .map(|s| {
            let leg = desired
                .legs()
                .partition_point(|l| l.start_distance <= s)
                .saturating_sub(1);
            (leg, s - desired.legs()[leg].start_distance)
        })
        .collect()
}

#[cfg(test)]
mod tests;
