//! A stay that sets interrupt: own ship clears its place in time, lies aside, and returns.
//!
//! ```text
//! way ─► rest ─► turn and line aside ─► rest ─► turn and line back ─► rest until the stay ends
//!     or     a later arrival along the route, after the sets have passed
//! ```
//!
//! Excursions from the way or the place, by their time, course, distance and speed, are tried from a
//! grid, each by the exact contact test. The motion nearest to the desired places is then moved
//! nearer by bisection.

use crate::clock::Clock;
use crate::space_time::fallback::waiting::{MOVES, Way, unfinished};
use crate::space_time::land;
use crate::space_time::manoeuvre::chain::Chain;
use crate::space_time::manoeuvre::interceptor::Interceptor;
use crate::space_time::manoeuvre::motion::{pose_at, until as to};
use crate::space_time::piece::pieces;
use crate::space_time::proxy::{Proxy, first_met, within_reach};
use crate::{Plan, PlanMethod, Problem};
use searoom_geometry::frame::{Pose, Side, Vector};
use searoom_geometry::numerics::bisected;
use searoom_geometry::tolerance;
use searoom_model::trajectory::{Segment, rested};

/// Excursions between the start and the time at which sets reach the place.
const DEPARTURES: u32 = 8;

/// Courses away from the place, over a half circle to each side.
const COURSES: u32 = 12;

/// Distances from the place: half of own length, and each twice the one before.
const DISTANCES: i32 = 9;

/// Times of return between the first possible one and the end of the stay.
const RETURNS: u32 = 8;

/// Bisection steps for a later departure, and for a lesser distance.
const HALVINGS: usize = 10;

/// Intervals of Simpson's rule per segment.
const INTERVALS: u32 = 8;

/// Motions that keep a stay as well as they can, the best first: at most one that arrives later, and
/// one that leaves with a turn to each side. Each is clear of every set and of land until the stay
/// ends at `until`, seconds.
///
/// `arrival` is a clear motion to the last waypoint. A motion that ends there is better than one that
/// does not, and then the one with the least integral of the squared distance from the desired place. Cost:
/// some ten thousand contact tests, up to a tenth of a second.
pub(crate) fn off_station(problem: &Problem, arrival: &[Segment], until: f64) -> Vec<Plan> {
    let clock = Clock::new(problem.deadline);
    let pieces = pieces(problem.obstacles, problem.horizon);
    let proxies = within_reach(problem, &pieces);
    let Some(station) = Station::of(problem, &proxies, arrival, until) else {
        return Vec::new();
    };
    let aside = Side::BOTH.into_iter();
    let aside = aside.filter_map(|side| station.aside(side, clock));
    let later = later(problem, &proxies, until, clock).map(|motion| station.kept(motion, true));
    let mut found: Vec<Aside> = later.into_iter().chain(aside).collect();
    found.sort_by(|a, b| {
        let back = b.is_back.cmp(&a.is_back);
        back.then(a.error.total_cmp(&b.error))
    });
    let plan = |found: Aside| unfinished(problem, found.motion, PlanMethod::OffStation);
    found.into_iter().filter_map(plan).collect()
}

/// The motion along the route that arrives so late that the rest after it is clear.
fn later(problem: &Problem, proxies: &[Proxy], until: f64, clock: Clock) -> Option<Vec<Segment>> {
    let way = Way::of(problem, &problem.desired.straightened(), clock)?;
    let motion = way.waiting(proxies, MOVES[0], until, clock)?;
    let motion = rested(motion, until);
    let away = motion.last()?.end().position - problem.desired.end();
    (away.norm() <= tolerance::ARRIVAL_M).then_some(motion)
}

/// The end of the path, where own ship lies from its arrival until the stay ends.
struct Station<'a> {
    problem: &'a Problem<'a>,
    proxies: &'a [Proxy<'a>],
    /// The motion to it and the rest there until the first set comes.
    arrival: Vec<Segment>,
    place: Vector,
    /// Seconds: the first time in a set, the last time in one, and the end of the stay.
    covered: f64,
    free: f64,
    until: f64,
}

/// A way to clear the place.
#[derive(Clone, Copy)]
struct Excursion {
    time: f64,
    side: Side,
    turn: f64,
    distance: f64,
    speed: f64,
}

/// A clear motion, and how badly it keeps the stay: first whether it is back at the end, then m² s.
struct Aside {
    motion: Vec<Segment>,
    is_back: bool,
    error: f64,
}

impl Aside {
    fn is_better_than(&self, other: &Self) -> bool {
        match self.is_back == other.is_back {
            // a NaN is no better
            true => self.error < other.error,
            false => self.is_back,
        }
    }
}

impl<'a> Station<'a> {
    /// `None` where no set covers the place.
    fn of(
        problem: &'a Problem<'a>,
        proxies: &'a [Proxy<'a>],
        arrival: &[Segment],
        until: f64,
    ) -> Option<Self> {
        let last = arrival.last()?;
        let (pose, arrives) = (last.end(), last.end_time());
        let covers = |proxy: &Proxy| proxy.covers(pose.position, arrives, until);
        let covers: Vec<_> = proxies.iter().filter_map(covers).collect();
        let covered = covers.iter().map(|c| c.start).reduce(f64::min)?;
        Some(Self {
            problem,
            proxies,
            arrival: rested(arrival.to_vec(), covered),
            place: pose.position,
            covered,
            free: covers.iter().map(|c| c.end).fold(arrives, f64::max),
            until,
        })
    }

    /// The best motion that first turns to a side.
    fn aside(&self, side: Side, clock: Clock) -> Option<Aside> {
        let own = self.problem.own;
        let mut best: Option<(Excursion, Aside)> = None;
        let moving: Vec<f64> = own.moving_speeds().collect();
        let (first, last) = (moving.first()?, moving.last()?);
        let speeds = if first < last {
            vec![*first, *last]
        } else {
            vec![*last]
        };
        for k in 0..DEPARTURES {
            let time = self.covered * f64::from(k) / f64::from(DEPARTURES);
            for speed in &speeds {
                for course in 0..=COURSES {
                    let turn = std::f64::consts::PI * f64::from(course) / f64::from(COURSES);
                    for doubled in 0..DISTANCES {
                        if clock.is_up() {
                            return best.map(|(_, aside)| aside);
                        }
                        let distance = 0.5 * own.hull.length * 2.0_f64.powi(doubled);
                        let departure = Excursion {
                            time,
                            side,
                            turn,
                            distance,
                            speed: *speed,
                        };
                        let Some(found) = self.by(departure) else {
                            continue;
                        };
                        let is_better = |(_, best): &(_, Aside)| found.is_better_than(best);
                        if best.as_ref().is_none_or(is_better) {
                            best = Some((departure, found));
                        }
                    }
                }
            }
        }
        let (mut departure, mut aside) = best?;
        let is_back = aside.is_back;
        let is_as_good = |departure| self.by(departure).is_some_and(|a| a.is_back >= is_back);
        let with_time = |time| Excursion { time, ..departure };
        let [time, _] = bisected([departure.time, self.covered], HALVINGS, |time| {
            is_as_good(with_time(time))
        });
        departure = with_time(time);
        let with_distance = |distance| Excursion {
            distance,
            ..departure
        };
        let [distance, _] = bisected([departure.distance, 0.0], HALVINGS, |distance| {
            is_as_good(with_distance(distance))
        });
        if let Some(nearer) = self.by(with_distance(distance))
            && nearer.is_better_than(&aside)
        {
            aside = nearer;
        }
        Some(aside)
    }

    /// The motion of a departure, with the soonest clear return; `None` where it meets something.
    fn by(&self, departure: Excursion) -> Option<Aside> {
        let (own, until) = (self.problem.own, self.until);
        let Excursion { time, speed, .. } = departure;
        let from = pose_at(&self.arrival, time)?;
        let mut chain = Chain::new(from, time, speed, own.turning_radius);
        chain.arc(departure.turn * own.turning_radius * departure.side.turn_sign());
        chain.line(departure.distance);
        if chain.time > until || !self.is_clear(&chain.segments) {
            return None;
        }
        let lies = (chain.pose, chain.time);
        let mut begun = to(&self.arrival, time);
        begun.extend(chain.segments);
        let back = self.returns(lies, speed);
        let is_back = back.is_some();
        let rest = match back {
            Some(back) => back,
            None => {
                let rest = Segment::straight(lies.0, lies.1, until - lies.1, 0.0);
                self.is_clear(&[rest]).then(|| vec![rest])?
            }
        };
        begun.extend(rest);
        Some(self.kept(rested(begun, until), is_back))
    }

    fn kept(&self, motion: Vec<Segment>, is_back: bool) -> Aside {
        let error = motion.iter().map(|segment| self.error(segment)).sum();
        Aside {
            motion,
            is_back,
            error,
        }
    }

    /// The rest aside and the way back to the place, after the last set over it.
    fn returns(&self, (lies, from): (Pose, f64), speed: f64) -> Option<Vec<Segment>> {
        let radius = self.problem.own.turning_radius;
        let ways = Side::BOTH.into_iter().filter_map(|side| {
            let turner = Interceptor::new(&lies, from, speed, radius, side);
            Some((side, turner.path_to(self.place)?))
        });
        let (side, (turn, line)) =
            ways.min_by(|a, b| (a.1.0 * radius + a.1.1).total_cmp(&(b.1.0 * radius + b.1.1)))?;
        let lasts = (turn * radius + line) / speed;
        let soonest = from.max(self.free - lasts);
        let latest = self.until - lasts;
        if !(soonest <= latest) {
            return None;
        }
        (0..=RETURNS).find_map(|k| {
            let leaves = soonest + (latest - soonest) * f64::from(k) / f64::from(RETURNS);
            let mut motion = Vec::new();
            if leaves > from {
                motion.push(Segment::straight(lies, from, leaves - from, 0.0));
            }
            let mut chain = Chain::new(lies, leaves, speed, radius);
            chain.arc(turn * radius * side.turn_sign());
            chain.line(line);
            motion.extend(chain.segments);
            let motion = rested(motion, self.until);
            self.is_clear(&motion).then_some(motion)
        })
    }

    fn is_clear(&self, motion: &[Segment]) -> bool {
        first_met(self.proxies, motion).is_none()
            && !land::meets(self.problem.land_obstacle, motion)
    }

    /// Integral of the squared distance from the desired place, m² s, by Simpson's rule.
    fn error(&self, segment: &Segment) -> f64 {
        let off = |k: u32| -> f64 {
            let share = f64::from(k) / f64::from(INTERVALS);
            let time = segment.start_time + share * segment.duration;
            let place: Vector = self.problem.desired.position_at(time);
            (segment.pose_at(time).position - place).norm_squared()
        };
        let inner = (1..INTERVALS).map(|k| f64::from(2 + 2 * (k % 2)) * off(k));
        let sum = off(0) + inner.sum::<f64>() + off(INTERVALS);
        sum * segment.duration / f64::from(3 * INTERVALS)
    }
}
