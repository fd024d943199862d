//! Piecewise constant speed profile along legs, and its conversion to a trajectory.

use super::TOUCH_M;
use super::diagram::{DiagramCorner, DiagramLeg, DiagramObstacle, PathTimeDiagram};
use super::nodes::Place;
use super::scene::Scene;
use searoom_geometry::frame::{Pose, heading_of, wrap};
use searoom_geometry::tolerance;
use searoom_model::trajectory::{Segment, Trajectory};
use searoom_sets::PathTime;

/// Time in seconds below which two bends count as one; own ship moves some micrometres meanwhile.
const INSTANT_S: f64 = 1e-6;

/// Sequence of legs and the distance along them as a function of time.
#[derive(Debug, Clone)]
pub(crate) struct Profile {
    /// Indices of the legs.
    pub legs: Vec<usize>,
    /// Distance from the start to the start of each leg, in metres.
    pub begins: Vec<f64>,
    /// Knots from start to end; distances count from the start.
    pub knots: Vec<PathTime>,
}

impl Profile {
    /// Creates a profile that stays at the start.
    pub(crate) fn new() -> Self {
        let start = PathTime::new(0.0, 0.0);
        Self {
            legs: Vec::new(),
            begins: Vec::new(),
            knots: vec![start],
        }
    }

    /// Last knot.
    pub(crate) fn end(&self) -> PathTime {
        self.knots[self.knots.len() - 1]
    }

    /// Position of the last knot on the network.
    pub(crate) fn place(&self, scene: &Scene) -> Place {
        let (Some(leg), Some(begin)) = (self.legs.last(), self.begins.last()) else {
            return Place::At(scene.network.start());
        };
        let distance = self.end().distance - begin;
        if distance >= scene.tracks[*leg].length - tolerance::LENGTH_M {
            Place::At(scene.network.legs()[*leg].ends[1])
        } else {
            Place::On {
                leg: *leg,
                distance,
            }
        }
    }

    /// Shortest distance in metres from the end of the profile to the last waypoint.
    pub(crate) fn to_go(&self, scene: &Scene) -> f64 {
        match self.place(scene) {
            Place::At(point) if !self.legs.is_empty() && scene.network.is_end(point) => 0.0,
            place => place.to_go(scene),
        }
    }

    /// Returns the part of the profile before a time.
    pub(crate) fn until(&self, scene: &Scene, time: f64) -> Self {
        let mut begun = Self::new();
        for (leg, from, to) in self.lines(scene) {
            if from.time >= time {
                break;
            }
            let share = ((time - from.time) / (to.time - from.time)).min(1.0);
            let at = PathTime::new(
                from.distance + share * (to.distance - from.distance),
                to.time.min(time),
            );
            if to.distance > from.distance {
                begun.sail(scene, leg, from, at);
            } else {
                begun.wait(at.time);
            }
        }
        begun
    }

    /// Splits the profile into lines per leg. A wait at a joint belongs to one of its legs.
    pub(crate) fn lines(&self, scene: &Scene) -> Vec<(usize, PathTime, PathTime)> {
        let mut lines = Vec::new();
        for pair in self.knots.windows(2) {
            let pieces = self.pieces(scene, pair[0], pair[1]);
            let count = if pair[1].distance > pair[0].distance {
                pieces.len()
            } else {
                1
            };
            lines.extend(pieces.into_iter().take(count));
        }
        lines
    }

    /// Total length of the legs so far, in metres.
    fn length(&self, scene: &Scene) -> f64 {
        match (self.legs.last(), self.begins.last()) {
            (Some(leg), Some(begin)) => begin + scene.tracks[*leg].length,
            _ => 0.0,
        }
    }

    /// Appends motion along the current or the next leg, up to a position on it.
    pub(crate) fn sail(&mut self, scene: &Scene, leg: usize, from: PathTime, to: PathTime) {
        if self.legs.last() != Some(&leg) || from.distance == 0.0 {
            let begin = self.length(scene);
            self.legs.push(leg);
            self.begins.push(begin);
        }
        let begin = self.begins[self.begins.len() - 1];
        self.push(begin + to.distance, to.time);
    }

    /// Appends motion along the current leg.
    pub(crate) fn sail_on(&mut self, from: PathTime, to: PathTime) {
        let last = self.knots[self.knots.len() - 1];
        self.push(last.distance + (to.distance - from.distance), to.time);
    }

    /// Appends a wait at the current position.
    pub(crate) fn wait(&mut self, until: f64) {
        let last = self.knots[self.knots.len() - 1];
        self.push(last.distance, until);
    }

    fn push(&mut self, distance: f64, time: f64) {
        let last = self.knots[self.knots.len() - 1];
        if time > last.time {
            let distance = distance.max(last.distance);
            self.knots.push(PathTime { distance, time });
        }
    }

    /// Splits a line at the joints of legs. A wait at a joint is repeated for each of its legs.
    fn pieces(
        &self,
        scene: &Scene,
        from: PathTime,
        to: PathTime,
    ) -> Vec<(usize, PathTime, PathTime)> {
        let way = to.distance - from.distance;
        let time_at = |distance: f64| {
            let share = ((distance - from.distance) / way).clamp(0.0, 1.0);
            from.time + (to.time - from.time) * share
        };
        let mut pieces = Vec::new();
        // at the start, use any leg that starts there
        if let ([], Some(leg)) = (
            &self.legs[..],
            scene.network.onward(scene.network.start()).first(),
        ) {
            return vec![(*leg, from, to)];
        }
        for (leg, begin) in self.legs.iter().zip(&self.begins) {
            let length = scene.tracks[*leg].length;
            let (low, high) = (from.distance.max(*begin), to.distance.min(begin + length));
            if low > high || (way > 0.0 && low == high) {
                continue;
            }
            let at = |distance: f64, time: f64| {
                PathTime::new((distance - begin).clamp(0.0, length), time)
            };
            let ends = if way > 0.0 {
                [time_at(low), time_at(high)]
            } else {
                [from.time, to.time]
            };
            pieces.push((*leg, at(low, ends[0]), at(high, ends[1])));
        }
        pieces
    }

    fn is_free(&self, scene: &Scene, from: PathTime, to: PathTime) -> bool {
        self.pieces(scene, from, to)
            .into_iter()
            .all(|(leg, a, b)| scene.barrier(leg, a, b).is_none())
    }

    /// Pulls the profile taut: connects each knot to the last one reachable at constant speed. The
    /// end point and the arrival time do not change.
    pub(crate) fn pull_taut(&mut self, scene: &Scene) {
        let mut taut = vec![self.knots[0]];
        let mut at = 0;
        while at + 1 < self.knots.len() {
            let next = (at + 2..self.knots.len())
                .rev()
                .find(|k| self.is_free(scene, self.knots[at], self.knots[*k]))
                .unwrap_or(at + 1);
            taut.push(self.knots[next]);
            at = next;
        }
        self.knots = taut;
    }

    /// Removes bends within `INSTANT_S` of a neighbour if the line without them is free. Such
    /// bends occur next to a corner, where a position on an edge is also a node.
    pub(crate) fn tidy(&mut self, scene: &Scene) {
        let mut k = 1;
        while k + 1 < self.knots.len() {
            let [before, here, after] = [self.knots[k - 1], self.knots[k], self.knots[k + 1]];
            let beside = (here.time - before.time).min(after.time - here.time) <= INSTANT_S;
            if beside && self.is_free(scene, before, after) {
                self.knots.remove(k);
            } else {
                k += 1;
            }
        }
    }

    /// Converts the profile to a trajectory from a pose. Own ship turns on the spot at joints of
    /// legs.
    pub(crate) fn trajectory(&self, scene: &Scene, start: Pose) -> Option<Trajectory> {
        let mut segments = Vec::new();
        let heading = |leg: usize| heading_of(scene.tracks[leg].direction);
        // own ship turns when it moves off
        let mut facing = start.heading;
        let still = |pose| Segment::straight(pose, 0.0, 0.0, 0.0);
        for pair in self.knots.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let way = to.distance - from.distance;
            // a negligible distance is a wait; rounding of a short piece may exceed the maximum
            // speed
            let speed = if way > TOUCH_M {
                (way / (to.time - from.time)).min(scene.max_speed)
            } else {
                0.0
            };
            let pieces = self.pieces(scene, from, to);
            // a wait at a joint of legs yields one segment
            let count = if speed > 0.0 { pieces.len() } else { 1 };
            for (leg, a, b) in pieces.into_iter().take(count) {
                if speed > 0.0 {
                    facing = heading(leg);
                }
                let place = scene.tracks[leg].at(a.distance);
                if segments.is_empty() && wrap(facing - start.heading).abs() > tolerance::JOINT_RAD
                {
                    // where own ship moves off, which need not be its position to the last digit
                    segments.push(still(Pose::new(place, start.heading)));
                }
                segments.push(Segment::straight(
                    Pose::new(place, facing),
                    a.time,
                    b.time - a.time,
                    speed,
                ));
            }
        }
        if segments.is_empty() {
            segments.push(still(start));
        }
        Trajectory::with_corners(segments).ok()
    }

    /// Diagram of the planned legs; without any, of the main path.
    pub(crate) fn diagram(&self, scene: &Scene, start: Pose) -> PathTimeDiagram {
        if self.legs.is_empty() {
            let legs = scene.network.legs().iter().enumerate();
            let main = legs.filter(|(_, leg)| leg.path == 0);
            let (legs, begins) = main.map(|(index, leg)| (index, leg.start_distance)).unzip();
            let knots = self.knots.clone();
            let main = Self {
                legs,
                begins,
                knots,
            };
            return main.diagram(scene, start);
        }
        let mut facing = start.heading;
        let mut corners = Vec::new();
        let mut legs = Vec::with_capacity(self.legs.len());
        let mut obstacles = Vec::new();
        for (index, (leg, begin)) in self.legs.iter().zip(&self.begins).enumerate() {
            let track = scene.tracks[*leg];
            let turn = wrap(heading_of(track.direction) - facing);
            facing = heading_of(track.direction);
            if turn.abs() > tolerance::JOINT_RAD {
                corners.push(DiagramCorner {
                    distance: *begin,
                    turn,
                });
            }
            legs.push(DiagramLeg {
                track,
                path: scene.network.legs()[*leg].path,
                begin: *begin,
            });
            obstacles.extend(scene.seen[*leg].iter().map(|seen| DiagramObstacle {
                obstacle: seen.obstacle,
                leg: index,
                corners: outline(seen.body.corners(), *begin),
            }));
        }
        PathTimeDiagram {
            legs,
            obstacles,
            corners,
            profile: self.knots.clone(),
            horizon: scene.horizon,
            max_speed: scene.max_speed,
        }
    }
}

/// Removes coincident corners and converts distances to count from the start of the path.
fn outline(corners: &[PathTime], begin: f64) -> Vec<PathTime> {
    let apart = |a: &PathTime, b: &PathTime| {
        (a.distance - b.distance).abs() > TOUCH_M || (a.time - b.time).abs() > tolerance::TIME_S
    };
    let mut kept: Vec<PathTime> = Vec::with_capacity(corners.len());
    for corner in corners {
        if kept.last().is_none_or(|last| apart(last, corner)) {
            kept.push(*corner);
        }
    }
    while kept.len() > 1 && !apart(&kept[0], &kept[kept.len() - 1]) {
        kept.pop();
    }
    for corner in &mut kept {
        corner.distance += begin;
    }
    kept
}
