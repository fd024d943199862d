//! Nodes of the diagram at which a profile may bend.

use super::TOUCH_M;
use super::scene::Scene;
use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance;
use searoom_sets::PathTime;

/// Position of own ship on the network.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Place {
    /// Position between the ends of a leg, at a distance in metres from its start.
    On { leg: usize, distance: f64 },
    /// Point of the network.
    At(usize),
}

impl Place {
    /// Position, metres.
    pub(crate) fn position(self, scene: &Scene) -> Vector {
        match self {
            Self::On { leg, distance } => scene.tracks[leg].at(distance),
            Self::At(point) => scene.network.place(point),
        }
    }

    /// Shortest distance to the end in metres; infinite if there is no path.
    pub(crate) fn to_go(self, scene: &Scene) -> f64 {
        match self {
            Self::On { leg, distance } => {
                let leg = &scene.network.legs()[leg];
                leg.length - distance + scene.network.to_go(leg.ends[1])
            }
            Self::At(point) => scene.network.to_go(point),
        }
    }
}

/// Kind of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Mark {
    /// Own ship at t = 0.
    Start,
    /// Corner of an obstacle.
    Corner,
    /// Point on the desired trajectory.
    Due,
    /// End of a ray at an extreme speed.
    Passed,
    /// Full-speed arrival at the end of a leg, created on demand by the search.
    Arrival,
}

/// Position at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Node {
    pub place: Place,
    /// Time in seconds.
    pub time: f64,
    /// Obstacle whose edge contains the node.
    pub on_edge_of: Option<usize>,
    /// True on the desired trajectory.
    pub due: bool,
    pub mark: Mark,
}

impl Node {
    /// Coordinates on a leg; `None` if the node is not on it.
    pub(crate) fn on(&self, scene: &Scene, leg: usize) -> Option<PathTime> {
        let ends = scene.network.legs()[leg].ends;
        let distance = match self.place {
            Place::On { leg: own, distance } => (own == leg).then_some(distance),
            Place::At(point) if scene.network.same_place(point).contains(&ends[0]) => Some(0.0),
            Place::At(point) if scene.network.same_place(point).contains(&ends[1]) => {
                Some(scene.tracks[leg].length)
            }
            Place::At(_) => None,
        }?;
        Some(PathTime::new(distance, self.time))
    }

    /// Coordinates on a leg that leads to the node: at its end for a point, also of a closed leg.
    pub(crate) fn at_end_of(&self, scene: &Scene, leg: usize) -> PathTime {
        let distance = match self.place {
            Place::On { distance, .. } => distance,
            Place::At(_) => scene.tracks[leg].length,
        };
        PathTime::new(distance, self.time)
    }

    /// Shortest distance to the end in metres.
    pub(crate) fn left(&self, scene: &Scene) -> f64 {
        self.place.to_go(scene)
    }
}

/// Nodes known before the search, by position and in order of time.
#[derive(Debug)]
pub(crate) struct Known {
    /// Nodes in the interior of each leg.
    pub on: Vec<Vec<Node>>,
    /// Nodes at each point.
    pub at: Vec<Vec<Node>>,
}

impl Known {
    /// Collects the obstacle corners at which a shortest path may bend. They must be reachable,
    /// leave enough time to arrive, and lie outside every other obstacle.
    pub(crate) fn corners(scene: &Scene) -> Self {
        let mut known = Self {
            on: vec![Vec::new(); scene.tracks.len()],
            at: vec![Vec::new(); scene.network.points()],
        };
        for leg in 0..scene.tracks.len() {
            for seen in &scene.seen[leg] {
                let corners = seen.body.corners();
                let count = corners.len();
                for (i, corner) in corners.iter().enumerate() {
                    let (before, after) =
                        (corners[(i + count - 1) % count], corners[(i + 1) % count]);
                    let inner = corner.distance > tolerance::LENGTH_M
                        && corner.distance < scene.tracks[leg].length - tolerance::LENGTH_M;
                    if !inner || bends(before, *corner, after, scene.max_speed) {
                        known.add(scene, leg, *corner, Some(seen.obstacle), Mark::Corner);
                    }
                }
            }
        }
        known.in_order();
        known
    }

    /// Adds the positions where a motion may wait until the horizon: the ends of legs, and its
    /// start.
    pub(crate) fn add_last(&mut self, scene: &Scene, root: &Node) {
        let mut add = |leg: usize, distance: f64| {
            let time = scene.horizon;
            self.add(scene, leg, PathTime { distance, time }, None, Mark::Corner);
        };
        for (leg, track) in scene.tracks.iter().enumerate() {
            add(leg, 0.0);
            add(leg, track.length);
        }
        if let Place::On { leg, distance } = root.place {
            add(leg, distance);
        }
        self.in_order();
    }

    /// Adds a node on a leg, unless it cannot be part of a solution.
    pub(crate) fn add(
        &mut self,
        scene: &Scene,
        leg: usize,
        at: PathTime,
        on_edge_of: Option<usize>,
        mark: Mark,
    ) {
        let ends = scene.network.legs()[leg].ends;
        let length = scene.tracks[leg].length;
        let place = if at.distance <= tolerance::LENGTH_M {
            Place::At(ends[0])
        } else if at.distance >= length - tolerance::LENGTH_M {
            Place::At(ends[1])
        } else {
            Place::On {
                leg,
                distance: at.distance,
            }
        };
        let node = Node {
            place,
            time: at.time,
            on_edge_of,
            due: mark == Mark::Due,
            mark,
        };
        if !(node.time >= 0.0 && scene.in_time(node.left(scene), node.time)) {
            return;
        }
        match place {
            Place::On { .. } if scene.barrier(leg, at, at).is_none() => self.on[leg].push(node),
            Place::At(point) if scene.barrier_at(point, at.time, at.time).is_none() => {
                self.at[point].push(node);
            }
            Place::On { .. } | Place::At(_) => {}
        }
    }

    /// Copies the nodes of each point to all other points at the same position, because own ship
    /// may be there on any of the paths.
    pub(crate) fn share(&mut self, scene: &Scene) {
        let own: Vec<usize> = self.at.iter().map(Vec::len).collect();
        for point in 0..self.at.len() {
            for other in &scene.network.same_place(point)[1..] {
                let theirs = self.at[*other][..own[*other]].to_vec();
                let place = Place::At(point);
                self.at[point].extend(theirs.into_iter().map(|node| Node { place, ..node }));
            }
        }
        self.in_order();
    }

    /// Sorts the nodes by time and position and removes duplicates.
    pub(crate) fn in_order(&mut self) {
        let along = |node: &Node| match node.place {
            Place::On { distance, .. } => distance,
            Place::At(_) => 0.0,
        };
        for nodes in self.on.iter_mut().chain(&mut self.at) {
            nodes.sort_by(|a, b| {
                a.time
                    .total_cmp(&b.time)
                    .then(along(a).total_cmp(&along(b)))
                    .then(a.mark.cmp(&b.mark))
            });
            nodes.dedup_by(|b, a| {
                let same = b.time - a.time <= tolerance::TIME_S
                    && (along(b) - along(a)).abs() <= tolerance::LENGTH_M;
                if same {
                    a.due |= b.due;
                    a.mark = a.mark.min(b.mark);
                    a.on_edge_of = a.on_edge_of.or(b.on_edge_of);
                }
                same
            });
        }
    }
}

/// True if a line with a speed between 0 and `max_speed` can touch a polygon at a corner without
/// entering it. A taut profile bends only at such corners. `before`, `at` and `after` follow the
/// polygon in either orientation.
fn bends(before: PathTime, at: PathTime, after: PathTime, max_speed: f64) -> bool {
    // side of a neighbour relative to the line at a speed: linear in the speed
    let side = |p: PathTime, speed: f64| (p.distance - at.distance) - speed * (p.time - at.time);
    let [slow, fast] = [0.0, max_speed].map(|u| [side(before, u), side(after, u)]);
    // both on one side at an extreme speed, or one of them on the line at an intermediate speed
    let together = |[a, b]: [f64; 2]| a * b >= -TOUCH_M * (a.abs() + b.abs());
    together(slow) || together(fast) || slow[0] * fast[0] <= 0.0 || slow[1] * fast[1] <= 0.0
}
