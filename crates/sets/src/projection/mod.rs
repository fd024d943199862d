//! A space-time obstacle seen along a straight path: paper eqs. (27)-(29),
//! docs/reference/theory.md section 6.

use crate::{EllipsoidObstacle, HalfSpace, PolytopeObstacle, SpaceTimeObstacle};
use searoom_geometry::SignedDistance;
use searoom_geometry::frame::Vector;

/// Metres. Largest distance of the polygon around an ellipsoid from the ellipse at any time.
const OUTER_EXCESS_M: f64 = 0.05;

/// Bound on the tangent planes that one leg adds to an ellipsoid; some tens are usual.
const MAX_CUTS: usize = 200;

/// A point of the path-time diagram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathTime {
    /// Metres along the path.
    pub distance: f64,
    /// Seconds.
    pub time: f64,
}

impl PathTime {
    /// A point by its coordinates.
    pub fn new(distance: f64, time: f64) -> Self {
        Self { distance, time }
    }
}

/// A straight piece of a path: `x(s) = start + s direction`, `0 <= s <= length`, paper eq. (28).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Track {
    /// Metres.
    pub start: Vector,
    /// Unit vector.
    pub direction: Vector,
    /// Metres.
    pub length: f64,
}

impl Track {
    /// `x(s)`, metres.
    pub fn at(&self, distance: f64) -> Vector {
        self.start + self.direction * distance
    }
}

/// A face of the space-time body cut by a track: `per_metre s - per_second t <= reach`.
///
/// Its slack is the distance of `x(s)` from the face at `t`, in metres in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathTimeFace {
    /// `n . direction`, at most 1.
    pub per_metre: f64,
    /// `h_V(n)`, m/s.
    pub per_second: f64,
    /// `h_O0(n) - n . start + h_V(n) t_0`, metres; the clock of the set starts at `t_0`.
    pub reach: f64,
}

impl PathTimeFace {
    fn new(face: &HalfSpace, clock: f64, track: &Track) -> Self {
        Self {
            per_metre: face.normal.dot(&track.direction),
            per_second: face.velocity_support,
            reach: face.initial_support
                - face.normal.dot(&track.start)
                - face.velocity_support * clock,
        }
    }

    /// Metres beyond the face, negative inside.
    pub fn slack(&self, at: PathTime) -> f64 {
        self.per_metre * at.distance - self.per_second * at.time - self.reach
    }
}

/// `{(s, t) : x(s) in O_t}` along one track in a time interval: a convex polygon, paper eq. (29).
#[derive(Debug, Clone, PartialEq)]
pub struct PathTimeObstacle {
    /// The faces that bound the polygon; the others are redundant along the track.
    faces: Vec<PathTimeFace>,
    corners: Vec<PathTime>,
    low: PathTime,
    high: PathTime,
}

impl PathTimeObstacle {
    /// The part of a track inside all faces, whose clock starts at `clock` seconds, from `times[0]`
    /// to `times[1]` seconds.
    ///
    /// Clips the rectangle of track and times face by face (Sutherland & Hodgman,
    /// doi:10.1145/360767.360802), O(faces × corners). `None` where no point is `depth` metres
    /// inside every face, or where a number is NaN.
    pub fn new(
        faces: &[HalfSpace],
        clock: f64,
        track: &Track,
        times: [f64; 2],
        depth: f64,
    ) -> Option<Self> {
        let faces = faces.iter().map(|f| PathTimeFace::new(f, clock, track));
        let polygon = Clipped::new(faces, track.length, times)?;
        let corners: Vec<PathTime> = polygon.sides.iter().map(|side| side.corner).collect();
        let mut used: Vec<usize> = polygon.sides.iter().filter_map(|side| side.face).collect();
        used.sort_unstable();
        used.dedup();
        let faces: Vec<PathTimeFace> = used.into_iter().map(|i| polygon.faces[i]).collect();
        // in a convex set the distance from a side is nowhere more than three times that of the
        // centroid
        let middle = centroid(&corners);
        let deep = faces.iter().all(|f| f.slack(middle) <= -depth / 3.0);
        let least = |of: fn(&PathTime) -> f64| corners.iter().map(of).fold(f64::INFINITY, f64::min);
        let most =
            |of: fn(&PathTime) -> f64| corners.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        let low = PathTime::new(least(|p| p.distance), least(|p| p.time));
        let high = PathTime::new(most(|p| p.distance), most(|p| p.time));
        (deep && low.time < high.time).then_some(Self {
            faces,
            corners,
            low,
            high,
        })
    }

    /// The corners in order around the polygon; some may coincide.
    pub fn corners(&self) -> &[PathTime] {
        &self.corners
    }

    /// The least distance and the least time of the polygon.
    pub fn low(&self) -> PathTime {
        self.low
    }

    /// Signed distance of a point of the track from the set: outside, metres; inside, minus the
    /// least distance to a face.
    #[cfg(test)]
    pub fn slack(&self, at: PathTime) -> f64 {
        self.faces
            .iter()
            .map(|f| f.slack(at))
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The part of the line from `from` to `to`, as parameters from 0 to 1, that is deeper than
    /// `depth` metres inside every face and within the set's time interval. O(faces).
    ///
    /// Both points are on the track. `None` where the part is at most an instant; a NaN is inside.
    /// The ends of the track are not faces: a wait at an end is inside where its position is.
    pub fn inside(&self, from: PathTime, to: PathTime, depth: f64) -> Option<[f64; 2]> {
        if to.time <= self.low.time
            || from.time >= self.high.time
            || to.distance < self.low.distance
            || from.distance > self.high.distance
        {
            return None;
        }
        let duration = to.time - from.time;
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        if duration > 0.0 {
            enter = enter.max((self.low.time - from.time) / duration);
            leave = leave.min((self.high.time - from.time) / duration);
        }
        for face in &self.faces {
            let (a, b) = (face.slack(from) + depth, face.slack(to) + depth);
            if a <= 0.0 && b <= 0.0 {
                continue;
            }
            if a >= 0.0 && b >= 0.0 {
                return None;
            }
            let share = a / (a - b);
            if a > 0.0 {
                enter = enter.max(share);
            } else {
                leave = leave.min(share);
            }
        }
        // negated so that a NaN is inside
        (!(enter >= leave)).then_some([enter, leave])
    }
}

/// Faces of an outer polytope of an ellipsoid that exceeds it along each track by at most
/// `OUTER_EXCESS_M`, as long as `MAX_CUTS` tangent planes suffice.
///
/// Each face is a tangent plane of the convex space-time body. It cuts off the corner of a track's
/// polygon that is farthest outside, at the corner's nearest point. The distance to a convex set is
/// convex in position and time, so the farthest point of a polygon is a corner.
pub fn outer_faces_along(
    obstacle: &EllipsoidObstacle,
    tracks: &[Track],
    horizon: f64,
) -> Vec<HalfSpace> {
    let mut faces: Vec<HalfSpace> = Vec::new();
    for track in tracks {
        let seen = faces.iter().map(|f| PathTimeFace::new(f, 0.0, track));
        let mut polygon = Clipped::new(seen, track.length, [0.0, horizon]);
        for _ in 0..MAX_CUTS {
            let Some(polygon) = &mut polygon else {
                break;
            };
            let measured = polygon.sides.iter_mut().map(|side| {
                let at = side.corner;
                let distance = || obstacle.signed_distance(track.at(at.distance), at.time);
                (*side.outside.get_or_insert_with(distance), at.time)
            });
            let farthest = measured.max_by(|a, b| a.0.distance.total_cmp(&b.0.distance));
            let Some((outside, time)) = farthest else {
                break;
            };
            // a NaN adds no plane: fewer planes are also an outer set
            if !(outside.distance > OUTER_EXCESS_M) {
                break;
            }
            let support = obstacle.support(outside.normal, time);
            let face = HalfSpace {
                normal: outside.normal,
                velocity_support: support.rate,
                initial_support: support.value - support.rate * time,
            };
            faces.push(face);
            if !polygon.cut(PathTimeFace::new(&face, 0.0, track)) {
                break;
            }
        }
    }
    faces
}

/// A corner, and the face of the side from it to the next; `None` on the rectangle.
#[derive(Debug, Clone, Copy)]
struct Side {
    corner: PathTime,
    face: Option<usize>,
    /// How far the corner is outside of what is enclosed, once that is measured.
    outside: Option<SignedDistance>,
}

/// A rectangle cut by faces.
struct Clipped {
    sides: Vec<Side>,
    faces: Vec<PathTimeFace>,
}

impl Clipped {
    /// `None` where nothing is left.
    fn new(
        mut faces: impl Iterator<Item = PathTimeFace>,
        length: f64,
        times: [f64; 2],
    ) -> Option<Self> {
        let side = |distance, time| Side {
            corner: PathTime { distance, time },
            face: None,
            outside: None,
        };
        let [from, until] = times;
        let mut clipped = Self {
            sides: vec![
                side(0.0, from),
                side(length, from),
                side(length, until),
                side(0.0, until),
            ],
            faces: Vec::with_capacity(faces.size_hint().0),
        };
        faces.all(|face| clipped.cut(face)).then_some(clipped)
    }

    /// Cuts off what is beyond a face, in O(corners). False where nothing is left.
    fn cut(&mut self, face: PathTimeFace) -> bool {
        let index = self.faces.len();
        self.faces.push(face);
        let sides = &self.sides;
        let beyond = |side: &Side| face.slack(side.corner);
        if sides.iter().all(|s| beyond(s) <= 0.0) {
            return true;
        }
        let mut kept = Vec::with_capacity(sides.len() + 1);
        for (i, a) in sides.iter().enumerate() {
            let b = &sides[(i + 1) % sides.len()];
            let (fa, fb) = (beyond(a), beyond(b));
            if fa <= 0.0 {
                kept.push(*a);
            }
            if (fa <= 0.0) != (fb <= 0.0) {
                let share = fa / (fa - fb);
                let (p, q) = (a.corner, b.corner);
                kept.push(Side {
                    corner: PathTime::new(
                        p.distance + (q.distance - p.distance) * share,
                        p.time + (q.time - p.time) * share,
                    ),
                    face: if fa <= 0.0 { Some(index) } else { a.face },
                    outside: None,
                });
            }
        }
        self.sides = kept;
        !self.sides.is_empty()
    }
}

/// The area centroid; the mean of the corners for a polygon without area.
fn centroid(corners: &[PathTime]) -> PathTime {
    let first = corners[0];
    let (mut area, mut distance, mut time) = (0.0, 0.0, 0.0);
    for pair in corners[1..].windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let twice = (a.distance - first.distance) * (b.time - first.time)
            - (b.distance - first.distance) * (a.time - first.time);
        area += twice;
        distance += twice * (a.distance + b.distance - 2.0 * first.distance);
        time += twice * (a.time + b.time - 2.0 * first.time);
    }
    if area == 0.0 {
        let count = corners.len() as f64;
        return PathTime::new(
            corners.iter().map(|c| c.distance).sum::<f64>() / count,
            corners.iter().map(|c| c.time).sum::<f64>() / count,
        );
    }
    PathTime::new(
        first.distance + distance / (3.0 * area),
        first.time + time / (3.0 * area),
    )
}

/// The corners of `{(s, t) : x(s) in O_(t_0 + t)}` along a track, `0 <= t <= duration`, in order:
/// paper eq. (29) for any `t_0`, seconds. O((n + m)²).
///
/// Times count from `t_0`. Empty where they do not meet.
///
/// ```
/// use searoom_geometry::frame::Vector;
/// use searoom_geometry::ConvexPolygon;
/// use searoom_sets::{PolytopeObstacle, Track, along_track};
///
/// let square = |half: f64| {
///     let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
///     ConvexPolygon::hull(&corners.map(|(x, y)| Vector::new(x, y)))
/// };
/// let velocity = ConvexPolygon::point(Vector::new(1.0, 0.0));
/// let target = PolytopeObstacle::new("drifting", square(10.0)?, velocity);
/// // a path to the north, 100 m east; the target is on it from 90 to 110 s, own ship starts at 60 s
/// let start = Vector::new(100.0, -50.0);
/// let track = Track { start, direction: Vector::new(0.0, 1.0), length: 100.0 };
/// let corners = along_track(&target, &track, 60.0, 200.0);
/// let first = corners.iter().map(|c| c.time).fold(f64::INFINITY, f64::min);
/// assert!((first - 30.0).abs() < 1e-9, "{first} s after the start");
/// # Ok::<(), searoom_geometry::GeometryError>(())
/// ```
pub fn along_track(
    obstacle: &PolytopeObstacle,
    track: &Track,
    start_time: f64,
    duration: f64,
) -> Vec<PathTime> {
    // the clock of the set starts before that of the track
    let faces = obstacle.faces().iter();
    let faces = faces.map(|f| PathTimeFace::new(f, -start_time, track));
    Clipped::new(faces, track.length, [0.0, duration]).map_or_else(Vec::new, |polygon| {
        polygon.sides.iter().map(|side| side.corner).collect()
    })
}

#[cfg(test)]
mod tests;
