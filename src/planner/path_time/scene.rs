//! The obstacles as they are seen along every leg, and what is free of them.

use super::TOUCH_M;
use super::due::Due;
use crate::frame::Vector;
use crate::geometry::ConvexPolygon;
use crate::obstacle::{
    HalfSpace, PathTime, PathTimeObstacle, SpaceTimeObstacle, Track, outer_faces_along,
};
use crate::planner::Problem;
use crate::planner::space_time::piece::{Body, Piece, pieces};
use crate::tolerance;
use crate::trajectory::PathNetwork;

/// Where a motion may end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Aim {
    /// At the last waypoint, before the horizon.
    Arrive,
    /// There, or anywhere at the horizon.
    Last,
}

/// An obstacle on one leg.
#[derive(Debug, Clone)]
pub(crate) struct Seen {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Distances from the start of the leg.
    pub body: PathTimeObstacle,
}

/// See the head of the file.
#[derive(Debug)]
pub(crate) struct Scene<'a> {
    pub network: &'a PathNetwork,
    pub tracks: Vec<Track>,
    /// Per leg, by the time at which they begin.
    pub seen: Vec<Vec<Seen>>,
    /// Per point the legs that begin or end at its place, with the distance at which they do.
    touching: Vec<Vec<(usize, f64)>>,
    /// Per leg where own ship is meant to be; `None` on alternatives.
    pub dues: Vec<Option<Due>>,
    pub max_speed: f64,
    pub horizon: f64,
    pub aim: Aim,
}

impl<'a> Scene<'a> {
    /// Projects every part of every obstacle onto every leg that its positions up to the horizon
    /// come near. Sets without interior are widened, ellipsoids replaced by outer polytopes.
    pub(crate) fn new(problem: &Problem, network: &'a PathNetwork, aim: Aim) -> Self {
        let tracks: Vec<Track> = network
            .legs()
            .iter()
            .map(|leg| Track {
                start: leg.start,
                direction: leg.direction,
                length: leg.length,
            })
            .collect();
        let boxes: Vec<Extent> = tracks
            .iter()
            .map(|t| Extent::of(&[t.start, t.at(t.length)]))
            .collect();
        let mut seen: Vec<Vec<Seen>> = vec![Vec::new(); tracks.len()];
        for part in pieces(problem.obstacles, problem.horizon) {
            let times = match part.window {
                Some(window) => [window.start, window.end.min(problem.horizon)],
                None => [0.0, problem.horizon],
            };
            let clock = times[0];
            let covered = covered(&part, times[1] - clock);
            let near: Vec<usize> = (0..tracks.len())
                .filter(|i| covered.meets(&boxes[*i]))
                .collect();
            if near.is_empty() {
                continue;
            }
            let rounded: Vec<HalfSpace>;
            let faces = match &part.body {
                Body::Polytope(polytope) => polytope.faces(),
                Body::Ellipsoid(rounded_body) => {
                    let along: Vec<Track> = near.iter().map(|i| tracks[*i]).collect();
                    rounded = outer_faces_along(&rounded_body.exact, &along, problem.horizon);
                    &rounded
                }
            };
            for leg in near {
                let body = PathTimeObstacle::new(faces, clock, &tracks[leg], times, TOUCH_M);
                seen[leg].extend(body.map(|body| Seen {
                    obstacle: part.obstacle,
                    body,
                }));
            }
        }
        for on_leg in &mut seen {
            on_leg.sort_by(|a, b| a.body.low().time.total_cmp(&b.body.low().time));
        }
        let mut touching: Vec<Vec<(usize, f64)>> = vec![Vec::new(); network.points()];
        for (index, leg) in network.legs().iter().enumerate() {
            for (end, distance) in [(leg.ends[0], 0.0), (leg.ends[1], leg.length)] {
                for point in network.same_place(end) {
                    touching[*point].push((index, distance));
                }
            }
        }
        Self {
            network,
            tracks,
            seen,
            touching,
            dues: network
                .legs()
                .iter()
                .map(|leg| Due::on(problem.desired, leg))
                .collect(),
            max_speed: problem.own.max_speed(),
            horizon: problem.horizon,
            aim,
        }
    }

    /// True where own ship may be at a time with so many metres to the end left.
    pub(crate) fn in_time(&self, to_go: f64, time: f64) -> bool {
        let needed = match self.aim {
            Aim::Arrive => to_go / self.max_speed,
            // a path that leads nowhere is no way
            Aim::Last if to_go.is_finite() => 0.0,
            Aim::Last => f64::INFINITY,
        };
        time + needed <= self.horizon + tolerance::TIME_S
    }

    /// The legs that begin or end at the place of a point, with the distance at which they do.
    pub(crate) fn touching(&self, point: usize) -> &[(usize, f64)] {
        &self.touching[point]
    }

    /// The obstacle that a line on a leg, sailed from its beginning or back from its end, meets
    /// first, and the share of the line at which it does: half as deep as a line may go, so that
    /// the place itself is free.
    pub(crate) fn nearest_barrier(
        &self,
        leg: usize,
        from: PathTime,
        to: PathTime,
        forward: bool,
    ) -> Option<(usize, f64)> {
        let met = self.seen[leg].iter().filter_map(|seen| {
            let shares = seen.body.inside(from, to, 0.5 * TOUCH_M)?;
            Some((seen.obstacle, shares))
        });
        if forward {
            let first = met.min_by(|a, b| a.1[0].total_cmp(&b.1[0]));
            first.map(|(obstacle, [enter, _])| (obstacle, enter))
        } else {
            let last = met.max_by(|a, b| a.1[1].total_cmp(&b.1[1]));
            last.map(|(obstacle, [_, leave])| (obstacle, leave))
        }
    }

    /// What bars a line on a leg: of the obstacles that it meets the one that begins first.
    /// O(obstacles on the leg), most of them by their extent.
    pub(crate) fn barrier(&self, leg: usize, from: PathTime, to: PathTime) -> Option<usize> {
        self.seen[leg]
            .iter()
            .take_while(|seen| seen.body.low().time < to.time || from == to)
            .find(|seen| seen.body.inside(from, to, TOUCH_M).is_some())
            .map(|seen| seen.obstacle)
    }

    /// What bars waiting at a point.
    pub(crate) fn barrier_at(&self, point: usize, from: f64, to: f64) -> Option<usize> {
        self.touching[point].iter().find_map(|&(leg, distance)| {
            let at = |time| PathTime { distance, time };
            self.barrier(leg, at(from), at(to))
        })
    }

    /// Until when an obstacle that is met at a place of a leg is there, or ahead on the leg;
    /// infinite where that is up to the horizon.
    pub(crate) fn bars_until(&self, leg: usize, obstacle: usize, at: PathTime) -> f64 {
        let seen = self.seen[leg].iter().filter(|s| s.obstacle == obstacle);
        let ahead = seen
            .flat_map(|s| s.body.corners())
            .filter(|c| c.distance >= at.distance && c.time >= at.time);
        let last = ahead.map(|c| c.time).fold(at.time, f64::max);
        if last >= self.horizon - 1e-6 {
            f64::INFINITY
        } else {
            last.max(self.covered_until(leg, obstacle, at))
        }
    }

    /// Until when, waiting from `time` on at a place of a leg, an obstacle that covers it then goes
    /// on to; infinite when it does up to the horizon.
    pub(crate) fn covered_until(&self, leg: usize, obstacle: usize, at: PathTime) -> f64 {
        let end = PathTime {
            time: self.horizon,
            ..at
        };
        let mut until = at.time;
        // slabs follow one another
        for seen in self.seen[leg].iter().filter(|s| s.obstacle == obstacle) {
            if let Some([enter, leave]) = seen.body.inside(at, end, 0.0) {
                let span = self.horizon - at.time;
                if at.time + span * enter <= until + 1e-3 {
                    until = until.max(at.time + span * leave);
                }
            }
        }
        if until >= self.horizon - 1e-6 {
            f64::INFINITY
        } else {
            until
        }
    }
}

/// A rectangle of the plane.
#[derive(Debug, Clone, Copy)]
struct Extent {
    low: Vector,
    high: Vector,
}

impl Extent {
    fn of(points: &[Vector]) -> Self {
        let first = Self {
            low: points[0],
            high: points[0],
        };
        points.iter().fold(first, |e, p| Self {
            low: e.low.inf(p),
            high: e.high.sup(p),
        })
    }

    fn meets(&self, other: &Self) -> bool {
        // negated on purpose: a NaN is near
        !(self.low.x > other.high.x
            || self.low.y > other.high.y
            || self.high.x < other.low.x
            || self.high.y < other.low.y)
    }
}

/// A rectangle around every position of a part within `duration` seconds from its clock's start.
fn covered(part: &Piece, duration: f64) -> Extent {
    let reach = |normal: Vector| match &part.body {
        // linear in time
        Body::Polytope(o) => {
            let (initial, velocity): (&ConvexPolygon, _) = (o.initial(), o.velocity());
            initial.support(normal) + (velocity.support(normal) * duration).max(0.0)
        }
        // concave in time: below its tangents at both ends
        Body::Ellipsoid(o) => {
            let (first, last) = (
                o.exact.support(normal, 0.0),
                o.exact.support(normal, duration),
            );
            let rise = (first.rate * duration).max(0.0);
            let back = (-last.rate * duration).max(0.0);
            // where a tangent has no slope, the growth of the sets alone bounds it
            let bound = (first.value + rise).min(last.value + back);
            if bound.is_finite() {
                bound
            } else {
                f64::INFINITY
            }
        }
    };
    let (east, north) = (Vector::new(1.0, 0.0), Vector::new(0.0, 1.0));
    Extent {
        low: -Vector::new(reach(-east), reach(-north)),
        high: Vector::new(reach(east), reach(north)),
    }
}
