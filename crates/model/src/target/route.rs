//! The declared track of a target: consecutive stretches, and the possible velocities on them.

use std::f64::consts::FRAC_PI_2;

use super::{DomainKind, KnownLeg, ShipTrack, TURN_LENGTHS};
use crate::vessel::Hull;
use searoom_geometry::ConvexPolygon;
use searoom_geometry::frame::{Pose, Vector, heading_of, wrap};
use searoom_geometry::tolerance;

/// Half-widths up to which consecutive stretches become one: radians (1°) and m/s.
const ONE_COURSE: f64 = std::f64::consts::PI / 180.0;
const ONE_SPEED: f64 = 0.1;

/// Seconds: changes nearer to one another than this are one.
const LEAST_INTERVAL: f64 = 0.01;

/// Most changes of a track that are compared; of more only every second or third is used.
const MOST_CHANGES: usize = 1000;

/// m/s: the rounding of a speed from places and times.
const SAME_SPEED: f64 = 1e-9;

/// Metres: least length of a straight, so that two turns never share a point.
const NO_LENGTH: f64 = 1e-3;

/// A point of a declared route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoutePoint {
    /// Metres.
    pub position: Vector,
    /// Radius of the turn here, metres; `None` if unknown.
    pub turn_radius: Option<f64>,
}

/// A leg of a route: least and greatest speed, m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RouteLeg {
    /// Least speed, m/s.
    pub slow: f64,
    /// Greatest speed, m/s.
    pub fast: f64,
}

/// A stretch of a track: length, courses and speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stretch {
    /// Least and greatest length, metres.
    shortest: f64,
    longest: f64,
    /// Middle of the courses, radians counter-clockwise from east, and half their width.
    course: f64,
    half: f64,
    /// m/s.
    slow: f64,
    fast: f64,
}

impl Stretch {
    /// This stretch and the next as one; `None` if they are too different.
    fn joined(&self, next: &Self) -> Option<Self> {
        let turn = wrap(next.course - self.course);
        let low = f64::min(-self.half, turn - next.half);
        let high = f64::max(self.half, turn + next.half);
        let one = Self {
            shortest: self.shortest + next.shortest,
            longest: self.longest + next.longest,
            course: wrap(self.course + 0.5 * (low + high)),
            half: 0.5 * (high - low),
            slow: self.slow.min(next.slow),
            fast: self.fast.max(next.fast),
        };
        let same = one.half <= ONE_COURSE && 0.5 * (one.fast - one.slow) <= ONE_SPEED;
        same.then_some(one)
    }

    /// A ship with every velocity of this stretch, spreads added; only its velocities are of use.
    fn ship(&self, spread: &Spread) -> ShipTrack {
        ShipTrack {
            speed_spread: 0.5 * (self.fast - self.slow) + spread.speed,
            course_spread: self.half + spread.course,
            domain: DomainKind::Colregs,
            ..ShipTrack::exact(
                Pose::new(Vector::zeros(), self.course),
                0.5 * (self.slow + self.fast),
                Hull::new(0.0, 0.0),
            )
        }
    }
}

/// Allowed deviation from the declared track.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Half-width, m/s.
    pub speed: f64,
    /// Half-width, radians.
    pub course: f64,
    /// How much earlier or later the ship may reach each stretch, seconds.
    pub time: f64,
    /// How far ahead or astern of the track's start the ship may be at first, metres.
    pub place: f64,
}

/// Radians: a ship that turns this much may turn to either side, 170°.
const EITHER_SIDE: f64 = 17.0 * std::f64::consts::PI / 18.0;

/// True for a turn that is about as long to either side.
pub(super) fn is_to_either_side(turn: f64) -> bool {
    turn.abs() >= EITHER_SIDE
}

/// Courses of a turn that begins at `course`: the middle, and half their width.
fn courses_of(course: f64, turn: f64) -> (f64, f64) {
    if is_to_either_side(turn) {
        (course, std::f64::consts::PI)
    } else {
        (wrap(course + 0.5 * turn), 0.5 * turn.abs())
    }
}

/// The turn at a point does not fit into the legs beside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TightTurn {
    /// Index of the point.
    pub point: usize,
    /// Metres from the point at which the turn would begin.
    pub begins: f64,
}

/// A declared track. The ship rests at its start until `appears`, follows the track, and continues
/// as on its last stretch.
///
/// A ship follows the track within a spread if, on each stretch, its course differs from the
/// track's by at most `spread.course` and its speed from the declared one by at most
/// `spread.speed`. It reaches the next stretch when it has made good the length of this one. At a
/// point without a radius it turns on the spot, or on an arc of any radius up to the assumed one that
/// begins and ends within half of the shorter leg beside it.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// First position, metres.
    pub start: Vector,
    appears: f64,
    stretches: Vec<Stretch>,
    /// The legs, if each has one speed, and each turn begins and ends within half of the legs beside
    /// it.
    legs: Vec<KnownLeg>,
    /// The greatest radius of its own that a turn of `legs` has, metres; 0 without one.
    greatest_radius: f64,
}

impl Track {
    /// A straight track without end, or a ship at rest: `course` radians, `speed` m/s.
    pub fn straight(start: Vector, course: f64, speed: f64) -> Self {
        let only = Stretch {
            shortest: f64::INFINITY,
            longest: f64::INFINITY,
            course,
            half: 0.0,
            slow: speed,
            fast: speed,
        };
        Self {
            start,
            appears: 0.0,
            stretches: vec![only],
            legs: Vec::new(),
            greatest_radius: 0.0,
        }
    }

    /// The track along a route of at least two different points; `legs` has one entry less. A point
    /// without a radius allows arcs up to `usual_radius`, if they fit. `heading` is the heading at
    /// the start, if it is not the course of the first leg.
    pub fn along(
        points: &[RoutePoint],
        legs: &[RouteLeg],
        usual_radius: f64,
        heading: Option<f64>,
    ) -> Result<Self, TightTurn> {
        let ways: Vec<Vector> = points
            .windows(2)
            .map(|pair| pair[1].position - pair[0].position)
            .collect();
        let mut stretches = Vec::with_capacity(2 * legs.len());
        let mut begun = 0.0;
        if let (Some(heading), Some(way), Some(leg)) = (heading, ways.first(), legs.first()) {
            let turn = wrap(heading_of(*way) - heading);
            stretches.push(Stretch {
                shortest: 0.0,
                longest: usual_radius * turn.abs(),
                course: courses_of(heading, turn).0,
                half: courses_of(heading, turn).1,
                slow: leg.slow,
                fast: leg.fast,
            });
        }
        for (index, (way, leg)) in ways.iter().zip(legs).enumerate() {
            let (course, length) = (heading_of(*way), way.norm());
            let next = ways.get(index + 1).zip(legs.get(index + 1));
            let turn = next.map(|(next, _)| wrap(heading_of(*next) - course));
            // metres before the next point at which the turn begins
            let mut ends = 0.0;
            if let (Some(turn), Some((next_way, _))) = (turn, next) {
                let half = 0.5 * turn.abs();
                let room = 0.5 * (length.min(next_way.norm()));
                let asked = points[index + 1].turn_radius;
                let wanted = asked.unwrap_or(usual_radius) * half.min(FRAC_PI_2).tan();
                if asked.is_some() && !(wanted <= length - begun && wanted <= next_way.norm()) {
                    return Err(TightTurn {
                        point: index + 1,
                        begins: wanted,
                    });
                }
                ends = if asked.is_some() {
                    wanted
                } else {
                    wanted.min(room)
                };
            }
            stretches.push(Stretch {
                shortest: (length - begun - ends).max(0.0),
                longest: (length - begun - ends).max(NO_LENGTH),
                course,
                half: 0.0,
                slow: leg.slow,
                fast: leg.fast,
            });
            if let (Some(turn), Some((_, next_leg))) = (turn, next) {
                let half = 0.5 * turn.abs();
                // an arc that begins `ends` before the point is never longer than the two sides
                let arc = if half > 0.0 {
                    ends / half.min(FRAC_PI_2).tan() * turn.abs()
                } else {
                    2.0 * ends
                };
                stretches.push(Stretch {
                    shortest: arc.min(2.0 * ends),
                    longest: 2.0 * ends,
                    course: courses_of(course, turn).0,
                    half: courses_of(course, turn).1,
                    slow: leg.slow.min(next_leg.slow),
                    fast: leg.fast.max(next_leg.fast),
                });
            }
            begun = ends;
        }
        Ok(Self {
            start: points.first().map_or(Vector::zeros(), |p| p.position),
            appears: 0.0,
            stretches: joined_stretches(stretches),
            legs: known_legs(points, legs, heading).unwrap_or_default(),
            greatest_radius: (points.windows(3))
                .filter_map(|beside| beside[1].turn_radius)
                .fold(0.0, f64::max),
        })
    }

    /// Moves the track; metres.
    pub fn translate(&mut self, shift: Vector) {
        self.start += shift;
        for leg in &mut self.legs {
            leg.to += shift;
        }
    }

    /// This track, on which the ship appears at `time` seconds.
    pub fn appearing(self, time: f64) -> Self {
        Self {
            appears: time,
            ..self
        }
    }

    /// Time at the end of the track at the mean speed of every stretch, seconds; infinite if the
    /// track has no end.
    pub fn end(&self) -> f64 {
        let took = |s: &Stretch| 0.5 * (s.shortest + s.longest) / (0.5 * (s.slow + s.fast));
        self.appears + self.stretches.iter().map(took).sum::<f64>()
    }

    /// A ship of constant course and speed, if the track is a single stretch that begins at t = 0.
    /// The velocities within its spreads contain those of the stretch; it has no hull.
    pub fn steady(&self, spread: &Spread) -> Option<ShipTrack> {
        match self.stretches.as_slice() {
            [only] if self.appears <= 0.0 => {
                let mut ship = only.ship(spread);
                ship.pose.position = self.start;
                Some(ship)
            }
            _ => None,
        }
    }

    /// The route as at most `most` legs that a tracked ship of this length may have, of whose known
    /// route all turns of the track are; `None` for another track.
    pub fn known_legs(&self, most: usize, length: f64) -> Option<&[KnownLeg]> {
        let fits = self.appears <= 0.0
            && (1..=most).contains(&self.legs.len())
            && self.greatest_radius <= TURN_LENGTHS * length;
        fits.then_some(&self.legs)
    }

    /// At most `most` velocity sets with their ends that contain, at every instant, the velocity of
    /// every ship that follows the track within the spread. Its position is then in the start ⊕
    /// their sum.
    ///
    /// A stretch is entered at the earliest on the shortest way at the greatest speed, and left at
    /// the latest on the longest way at the least speed made good. Each set is the hull of the
    /// velocities of all stretches possible in its time interval. Excess changes are omitted: a
    /// longer interval has the hull of more stretches, which errs outward. O(stretches²).
    pub fn outer_velocity_sets(
        &self,
        spread: &Spread,
        horizon: f64,
        most: usize,
    ) -> Vec<(f64, ConvexPolygon)> {
        let times = self.times(spread);
        let mut changes: Vec<f64> = times
            .iter()
            .flat_map(|&(enters, leaves)| [enters, leaves])
            .filter(|time| *time > LEAST_INTERVAL && *time < horizon)
            .collect();
        changes.sort_by(f64::total_cmp);
        changes.dedup_by(|later, earlier| *later - *earlier < LEAST_INTERVAL);
        if changes.len() > MOST_CHANGES {
            let every = changes.len().div_ceil(MOST_CHANGES);
            changes = changes.into_iter().step_by(every).collect();
        }
        while changes.len() + 1 > most.max(1) {
            // the change that ends the shortest time interval
            let length = |k: usize| changes[k] - if k == 0 { 0.0 } else { changes[k - 1] };
            let shortest = (0..changes.len()).min_by(|a, b| length(*a).total_cmp(&length(*b)));
            let Some(shortest) = shortest else { break };
            changes.remove(shortest);
        }
        changes.push(f64::INFINITY);
        let mut from = 0.0;
        let mut sets = Vec::with_capacity(changes.len());
        for until in changes {
            let mut vertices = Vec::new();
            if from < self.appears {
                vertices.push(Vector::zeros());
            }
            for (stretch, (enters, leaves)) in self.stretches.iter().zip(&times) {
                // touching intervals have no instant in common
                if *enters < until && *leaves > from {
                    let velocities = stretch.ship(spread).outer_velocity_set();
                    vertices.extend_from_slice(velocities.vertices());
                }
            }
            // never empty: a stretch is left after the next one is entered
            let velocities = ConvexPolygon::hull(&vertices)
                .unwrap_or_else(|_| ConvexPolygon::point(Vector::zeros()));
            sets.push((until, velocities));
            from = until;
        }
        sets
    }

    /// Earliest and latest time on every stretch, seconds.
    fn times(&self, spread: &Spread) -> Vec<(f64, f64)> {
        let (mut enters, mut leaves) = (self.appears, self.appears);
        let last = self.stretches.len().saturating_sub(1);
        // a ship that begins ahead has less way to go
        let mut ahead = spread.place;
        let time = |(index, stretch): (usize, &Stretch)| {
            let entered = (enters - spread.time).max(self.appears);
            let made = stretch.shortest.min(ahead);
            ahead -= made;
            enters += (stretch.shortest - made) / (stretch.fast + spread.speed);
            let good = (stretch.slow - spread.speed) * spread.course.min(FRAC_PI_2).cos();
            let astern = if index == 0 { spread.place } else { 0.0 };
            leaves = if index == last || !(good > 0.0) {
                f64::INFINITY
            } else {
                leaves + (stretch.longest + astern) / good
            };
            (entered, leaves + spread.time)
        };
        self.stretches.iter().enumerate().map(time).collect()
    }
}

/// True for turns that begin and end within half of the shorter leg beside them, as those of a known
/// route do. A turn without a radius does.
fn turns_within_legs(points: &[RoutePoint]) -> bool {
    points.windows(3).all(|beside| {
        let [before, after] = [0, 1].map(|i| beside[i + 1].position - beside[i].position);
        let half = 0.5 * wrap(heading_of(after) - heading_of(before)).abs();
        let begins = beside[1].turn_radius.unwrap_or(0.0) * half.min(FRAC_PI_2).tan();
        begins <= 0.5 * before.norm().min(after.norm())
    })
}

/// Legs of one speed each, with those on one line at one speed as one.
fn known_legs(
    points: &[RoutePoint],
    legs: &[RouteLeg],
    heading: Option<f64>,
) -> Option<Vec<KnownLeg>> {
    let same = |leg: &RouteLeg| leg.slow == leg.fast && leg.slow > 0.0;
    if heading.is_some() || !turns_within_legs(points) || !legs.iter().all(same) {
        return None;
    }
    let mut known: Vec<KnownLeg> = Vec::new();
    let mut from = points.first()?.position;
    for (pair, leg) in points.windows(2).zip(legs) {
        let to = pair[1].position;
        let next = KnownLeg {
            to,
            speed: leg.fast,
        };
        match known.last_mut() {
            Some(last)
                if is_one_line([from, last.to, to])
                    && (last.speed - next.speed).abs() <= SAME_SPEED =>
            {
                *last = next;
            }
            _ => {
                from = pair[0].position;
                known.push(next);
            }
        }
    }
    Some(known)
}

fn is_one_line([from, by, to]: [Vector; 3]) -> bool {
    wrap(heading_of(to - by) - heading_of(by - from)).abs() <= tolerance::JOINT_RAD
}

fn joined_stretches(stretches: Vec<Stretch>) -> Vec<Stretch> {
    let mut joined: Vec<Stretch> = Vec::new();
    for stretch in stretches {
        let last = joined.last_mut();
        match last.and_then(|last| Some((last.joined(&stretch)?, last))) {
            Some((both, last)) => *last = both,
            None => joined.push(stretch),
        }
    }
    joined
}
