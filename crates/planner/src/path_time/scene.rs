//! Obstacles projected onto every leg, and collision queries against them.

use super::TOUCH_M;
use super::due::Due;
use crate::Problem;
use crate::space_time::piece::{Piece, pieces};
use searoom_geometry::Window;
use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance;
use searoom_model::trajectory::PathNetwork;
use searoom_sets::{
    HalfSpace, PathTime, PathTimeObstacle, SpaceTimeObstacle, Track, outer_faces_along,
};

/// Goal of the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Aim {
    /// At the last waypoint before the horizon.
    Arrive,
    /// At the last waypoint, or anywhere at the horizon.
    Last,
}

/// Obstacle on one leg.
#[derive(Debug, Clone)]
pub(crate) struct Seen {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Projection; distances count from the start of the leg.
    pub body: PathTimeObstacle,
}

/// Network with its projected obstacles and schedule.
#[derive(Debug)]
pub(crate) struct Scene<'a> {
    pub network: &'a PathNetwork,
    pub tracks: Vec<Track>,
    /// Obstacles per leg, sorted by start time.
    pub seen: Vec<Vec<Seen>>,
    /// Legs that start or end at the position of each point, with the distance of that end.
    touching: Vec<Vec<(usize, f64)>>,
    /// Schedule per leg; `None` on alternatives.
    pub dues: Vec<Option<Due>>,
    pub max_speed: f64,
    pub horizon: f64,
    pub aim: Aim,
}

impl<'a> Scene<'a> {
    /// Projects every convex piece of every obstacle onto the legs that it may approach before the
    /// horizon. Sets without interior are widened. Ellipsoids are replaced by outer polytopes.
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
        let boxes: Vec<Window> = tracks
            .iter()
            .filter_map(|t| Window::around(&[t.start, t.at(t.length)]))
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
            let faces = match &part.ellipsoid {
                None => part.body.faces(),
                Some(ellipsoid) => {
                    let along: Vec<Track> = near.iter().map(|i| tracks[*i]).collect();
                    rounded = outer_faces_along(ellipsoid, &along, problem.horizon);
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

    /// True if the remaining distance can be covered before the horizon.
    pub(crate) fn in_time(&self, to_go: f64, time: f64) -> bool {
        let needed = match self.aim {
            Aim::Arrive => to_go / self.max_speed,
            // a dead end is not a valid end
            Aim::Last if to_go.is_finite() => 0.0,
            Aim::Last => f64::INFINITY,
        };
        time + needed <= self.horizon + tolerance::TIME_S
    }

    /// Legs that start or end at the position of a point, with the distance of that end.
    pub(crate) fn touching(&self, point: usize) -> &[(usize, f64)] {
        &self.touching[point]
    }

    /// Returns the first obstacle along a line on a leg, and the point of the line at entry.
    /// `forward` selects the direction of travel. Half the permitted depth is used, so the position
    /// itself is free.
    pub(crate) fn nearest_barrier(
        &self,
        leg: usize,
        from: PathTime,
        to: PathTime,
        forward: bool,
    ) -> Option<(usize, PathTime)> {
        let met = self.seen[leg].iter().filter_map(|seen| {
            let shares = seen.body.inside(from, to, 0.5 * TOUCH_M)?;
            Some((seen.obstacle, shares))
        });
        let (obstacle, share) = if forward {
            let first = met.min_by(|a, b| a.1[0].total_cmp(&b.1[0]));
            first.map(|(obstacle, [enter, _])| (obstacle, enter))
        } else {
            let last = met.max_by(|a, b| a.1[1].total_cmp(&b.1[1]));
            last.map(|(obstacle, [_, leave])| (obstacle, leave))
        }?;
        let met = PathTime::new(
            from.distance + share * (to.distance - from.distance),
            from.time + share * (to.time - from.time),
        );
        Some((obstacle, met))
    }

    /// Returns the obstacle with the earliest start time that a line on a leg intersects.
    /// O(obstacles on the leg); most are rejected by their extent.
    pub(crate) fn barrier(&self, leg: usize, from: PathTime, to: PathTime) -> Option<usize> {
        self.seen[leg]
            .iter()
            .take_while(|seen| seen.body.low().time < to.time || from == to)
            .find(|seen| seen.body.inside(from, to, TOUCH_M).is_some())
            .map(|seen| seen.obstacle)
    }

    /// Returns the obstacle that blocks waiting at a point.
    pub(crate) fn barrier_at(&self, point: usize, from: f64, to: f64) -> Option<usize> {
        self.touching[point].iter().find_map(|&(leg, distance)| {
            let at = |time| PathTime { distance, time };
            self.barrier(leg, at(from), at(to))
        })
    }

    /// Time until which an obstacle covers a position or lies ahead on the leg; infinite if until
    /// the horizon.
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

    /// Time until which an obstacle keeps covering a position at which own ship waits; infinite if
    /// until the horizon.
    pub(crate) fn covered_until(&self, leg: usize, obstacle: usize, at: PathTime) -> f64 {
        let end = PathTime {
            time: self.horizon,
            ..at
        };
        let mut until = at.time;
        // slabs are consecutive in time
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

/// Bounding box of all positions of a piece during `duration` seconds from its start.
fn covered(part: &Piece, duration: f64) -> Window {
    let reach = |normal: Vector| match &part.ellipsoid {
        // linear in time
        None => {
            let (initial, velocity) = (part.body.initial(), part.body.velocity());
            initial.support(normal) + (velocity.support(normal) * duration).max(0.0)
        }
        // concave in time: below the tangents at both ends
        Some(o) => {
            let (first, last) = (o.support(normal, 0.0), o.support(normal, duration));
            let rise = (first.rate * duration).max(0.0);
            let back = (-last.rate * duration).max(0.0);
            // without a tangent slope, the growth of the sets alone bounds it
            let bound = (first.value + rise).min(last.value + back);
            if bound.is_finite() {
                bound
            } else {
                f64::INFINITY
            }
        }
    };
    let (east, north) = (Vector::new(1.0, 0.0), Vector::new(0.0, 1.0));
    Window::new(
        -Vector::new(reach(-east), reach(-north)),
        Vector::new(reach(east), reach(north)),
    )
}
