//! The places of the diagram at which a profile may bend.

use super::TOUCH_M;
use super::scene::Scene;
use crate::obstacle::PathTime;
use crate::tolerance;

/// Where own ship is on the network.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Place {
    /// Between the ends of a leg, at a distance from its start, metres.
    On { leg: usize, distance: f64 },
    /// At a point of the network.
    At(usize),
}

impl Place {
    /// Metres of the shortest way to the end; infinite where there is none.
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

/// What a node is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Mark {
    /// Own ship at t = 0.
    Start,
    /// A corner of an obstacle.
    Corner,
    /// On the desired trajectory.
    Due,
    /// Passed at an extreme speed.
    Passed,
    /// The end of a leg, made as the search asks for it.
    Arrival,
}

/// A place and a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Node {
    pub place: Place,
    /// Seconds.
    pub time: f64,
    /// The obstacle on whose edge it is.
    pub on_edge_of: Option<usize>,
    /// True on the desired trajectory.
    pub due: bool,
    pub mark: Mark,
}

impl Node {
    /// Its distance on a leg, if it is there.
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
        Some(PathTime {
            distance,
            time: self.time,
        })
    }

    /// Metres of the shortest way to the end.
    pub(crate) fn left(&self, scene: &Scene) -> f64 {
        self.place.to_go(scene)
    }
}

/// Nodes that are known before the search, by place and in order of time.
#[derive(Debug)]
pub(crate) struct Known {
    /// Per leg, between its ends.
    pub on: Vec<Vec<Node>>,
    /// Per point.
    pub at: Vec<Vec<Node>>,
}

impl Known {
    /// The corners of the obstacles at which a shortest way may bend, that can be reached and left
    /// in time, and that no other obstacle covers.
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

    /// Adds the places at which a motion may stay until the horizon: the ends of legs, and where it
    /// begins.
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

    /// Adds a place on a leg, unless it is of no use.
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

    /// Gives the nodes of each point to every other point at its place, too: own ship may be there
    /// on any of the paths.
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

    /// In order of time and place, each once.
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

/// True where a line at a speed from 0 to the greatest may touch a polygon at a corner without
/// entering it: only there a taut profile bends. `before`, `at`, `after` are in the order of the
/// polygon, either way round.
fn bends(before: PathTime, at: PathTime, after: PathTime, max_speed: f64) -> bool {
    // on which side of the line at a speed a neighbour is: linear in the speed
    let side = |p: PathTime, speed: f64| (p.distance - at.distance) - speed * (p.time - at.time);
    let [slow, fast] = [0.0, max_speed].map(|u| [side(before, u), side(after, u)]);
    // both on one side at an extreme speed, or one of them on the line at a speed between
    let together = |[a, b]: [f64; 2]| a * b >= -TOUCH_M * (a.abs() + b.abs());
    together(slow) || together(fast) || slow[0] * fast[0] <= 0.0 || slow[1] * fast[1] <= 0.0
}
