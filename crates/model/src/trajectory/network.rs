//! A network of paths: legs between the points at which own ship may change from one path to
//! another.

use searoom_geometry::frame::{Vector, cross};
use searoom_geometry::tolerance;

/// Why alternatives and the main path are not a network.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NetworkError {
    /// A path with fewer than two points, a leg without length, or a NaN.
    #[error("path {path}: leg {leg} has no length, or there is none")]
    EmptyLeg {
        /// 0 is the main path; the alternatives follow.
        path: usize,
        /// Index of the leg, from 0.
        leg: usize,
    },
    /// An alternative that shares no point with another path.
    #[error("alternative {alternative} shares no point with another path")]
    NoSharedPoint {
        /// Index of the alternative, from 0.
        alternative: usize,
    },
    /// An alternative none of whose legs leads from the first waypoint to the last.
    #[error(
        "alternative {alternative} lies on no route from the first waypoint to the last; another path must continue where it ends"
    )]
    NoWayThrough {
        /// Index of the alternative, from 0.
        alternative: usize,
    },
}

/// A straight part of a path between two points at which paths begin, bend, end or meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NetworkLeg {
    /// Start, metres.
    pub start: Vector,
    /// Unit vector.
    pub direction: Vector,
    /// Length, metres, positive.
    pub length: f64,
    /// 0 is the main path; the alternatives follow.
    pub path: usize,
    /// Distance along its own path at the start, metres.
    pub start_distance: f64,
    /// Indices of the points at its ends.
    pub ends: [usize; 2],
}

/// The main path and its alternatives, each sailed from its first waypoint to its last.
///
/// Own ship may change between two paths at a common point: a waypoint, a crossing or an end of a
/// common part. It begins at the main path's first waypoint and arrives at its last. A path that
/// returns to its own points is sailed in full: a path does not meet itself.
#[derive(Debug, Clone, PartialEq)]
pub struct PathNetwork {
    legs: Vec<NetworkLeg>,
    /// Per point, the legs that start there.
    onward: Vec<Vec<usize>>,
    /// Per point, all points at the same position, itself first.
    same_place: Vec<Vec<usize>>,
    /// Per point, the shortest distance to the end, metres; infinite where there is none.
    to_go: Vec<f64>,
    places: Vec<Vector>,
    start: usize,
    is_end: Vec<bool>,
}

impl PathNetwork {
    /// From the waypoints of the main path and of the alternatives, metres. O(legs²).
    ///
    /// Points within [`tolerance::JOINT_M`] of each other are one.
    pub fn new(main: &[Vector], alternatives: &[Vec<Vector>]) -> Result<Self, NetworkError> {
        let paths: Vec<&[Vector]> = std::iter::once(main)
            .chain(alternatives.iter().map(Vec::as_slice))
            .collect();
        let mut ways = Vec::with_capacity(paths.len());
        for (path, points) in paths.iter().enumerate() {
            ways.push(Way::new(path, points)?);
        }
        for i in 0..ways.len() {
            for j in i + 1..ways.len() {
                let (before, after) = ways.split_at_mut(j);
                before[i].meet(&mut after[0]);
            }
        }
        let mut network = Self {
            legs: Vec::new(),
            onward: Vec::new(),
            same_place: Vec::new(),
            to_go: Vec::new(),
            places: Vec::new(),
            start: 0,
            is_end: Vec::new(),
        };
        let mut places: Vec<(usize, Vector)> = Vec::new();
        for way in &mut ways {
            way.lay(&mut network.legs, &mut places);
        }
        let count = places.len();
        let near = |a: usize, b: usize| {
            let ((p, x), (q, y)) = (places[a], places[b]);
            a == b || (p != q && (x - y).norm() <= tolerance::JOINT_M)
        };
        let alone = ways.len() == 1;
        network.same_place = (0..count)
            .map(|a| {
                let others = (0..count).filter(|b| *b != a && !alone && near(a, *b));
                std::iter::once(a).chain(others).collect()
            })
            .collect();
        let leaving: Vec<Option<usize>> = {
            let mut leaving = vec![None; count];
            for (index, leg) in network.legs.iter().enumerate() {
                leaving[leg.ends[0]] = Some(index);
            }
            leaving
        };
        network.onward = network
            .same_place
            .iter()
            .map(|same| same.iter().filter_map(|p| leaving[*p]).collect())
            .collect();
        let last = places.iter().rposition(|(path, _)| *path == 0).unwrap_or(0);
        network.is_end = network
            .same_place
            .iter()
            .map(|same| same.contains(&last))
            .collect();
        network.places = places.iter().map(|(_, place)| *place).collect();
        network.join();
        network.measure();
        network.check(&ways)?;
        Ok(network)
    }

    /// Replaces, at the ends of legs, points at one position with equal continuations by the first
    /// of them.
    fn join(&mut self) {
        let sorted = |point: usize| {
            let mut legs = self.onward[point].clone();
            legs.sort_unstable();
            (legs, self.is_end[point])
        };
        let first = |point: usize| {
            let alike = self.same_place[point].iter().copied();
            alike
                .filter(|p| sorted(*p) == sorted(point))
                .min()
                .unwrap_or(point)
        };
        let joined: Vec<usize> = (0..self.onward.len()).map(first).collect();
        for leg in &mut self.legs {
            leg.ends = leg.ends.map(|point| joined[point]);
        }
    }

    /// Shortest distances to the end, by relaxation until nothing changes.
    fn measure(&mut self) {
        let mut to_go: Vec<f64> = self
            .is_end
            .iter()
            .map(|end| if *end { 0.0 } else { f64::INFINITY })
            .collect();
        let mut changed = true;
        while changed {
            changed = false;
            for (point, onward) in self.onward.iter().enumerate().rev() {
                for leg in onward {
                    let leg = &self.legs[*leg];
                    let through = leg.length + to_go[leg.ends[1]];
                    // the start of a round trip is at its end, and has the whole length to go
                    if through < to_go[point] {
                        to_go[point] = through;
                        changed = true;
                    }
                }
            }
        }
        self.to_go = to_go;
    }

    fn check(&self, ways: &[Way]) -> Result<(), NetworkError> {
        let mut reached = vec![false; self.onward.len()];
        let mut open = vec![self.start];
        reached[self.start] = true;
        let mut sailed = vec![false; ways.len()];
        let mut shared = vec![false; ways.len()];
        while let Some(point) = open.pop() {
            for leg in &self.onward[point] {
                let leg = &self.legs[*leg];
                sailed[leg.path] |= self.to_go[leg.ends[1]].is_finite();
                if !reached[leg.ends[1]] {
                    reached[leg.ends[1]] = true;
                    open.push(leg.ends[1]);
                }
            }
        }
        for leg in &self.legs {
            shared[leg.path] |= leg.ends.iter().any(|p| self.same_place[*p].len() > 1);
        }
        for alternative in 0..ways.len() - 1 {
            if !shared[alternative + 1] {
                return Err(NetworkError::NoSharedPoint { alternative });
            }
            if !sailed[alternative + 1] {
                return Err(NetworkError::NoWayThrough { alternative });
            }
        }
        Ok(())
    }

    /// The legs, path by path, in order.
    pub fn legs(&self) -> &[NetworkLeg] {
        &self.legs
    }

    /// The number of points.
    pub fn points(&self) -> usize {
        self.onward.len()
    }

    /// The point at which own ship begins.
    pub fn start(&self) -> usize {
        self.start
    }

    /// Position of a point, metres.
    pub fn place(&self, point: usize) -> Vector {
        self.places[point]
    }

    /// The legs that start at a point.
    pub fn onward(&self, point: usize) -> &[usize] {
        &self.onward[point]
    }

    /// The points at the position of this one, itself first.
    pub fn same_place(&self, point: usize) -> &[usize] {
        &self.same_place[point]
    }

    /// True at the arrival point.
    pub fn is_end(&self, point: usize) -> bool {
        self.is_end[point]
    }

    /// Shortest distance from a point to the end, metres; infinite where there is none.
    pub fn to_go(&self, point: usize) -> f64 {
        self.to_go[point]
    }
}

/// A path during construction.
struct Way {
    path: usize,
    points: Vec<Vector>,
    /// Per leg, distances from its start at which another path is met, metres.
    cuts: Vec<Vec<f64>>,
}

impl Way {
    fn new(path: usize, points: &[Vector]) -> Result<Self, NetworkError> {
        let legs = points.windows(2);
        // negated so that a NaN has no length
        let empty = legs.clone().position(|p| {
            let length = (p[1] - p[0]).norm();
            !(length > tolerance::JOINT_M && length.is_finite())
        });
        match empty {
            Some(leg) => Err(NetworkError::EmptyLeg { path, leg }),
            None if points.len() < 2 => Err(NetworkError::EmptyLeg { path, leg: 0 }),
            None => Ok(Self {
                path,
                points: points.to_vec(),
                cuts: vec![Vec::new(); legs.len()],
            }),
        }
    }

    /// Cuts both paths where they meet.
    fn meet(&mut self, other: &mut Self) {
        for (i, own) in self.points.windows(2).enumerate() {
            for (j, theirs) in other.points.windows(2).enumerate() {
                let (a, b) = (own[1] - own[0], theirs[1] - theirs[0]);
                for p in theirs {
                    self.cuts[i].extend(foot(own, *p));
                }
                for p in own {
                    other.cuts[j].extend(foot(theirs, *p));
                }
                let turn = cross(a, b);
                let apart = theirs[0] - own[0];
                let (s, t) = (cross(apart, b) / turn, cross(apart, a) / turn);
                // parallel legs give NaN, and meet at their ends only
                if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
                    self.cuts[i].push(s * a.norm());
                    other.cuts[j].push(t * b.norm());
                }
            }
        }
    }

    /// Adds the legs and points, cut where other paths meet.
    fn lay(&mut self, legs: &mut Vec<NetworkLeg>, places: &mut Vec<(usize, Vector)>) {
        let mut distance = 0.0;
        places.push((self.path, self.points[0]));
        for (pair, cuts) in self.points.windows(2).zip(&mut self.cuts) {
            let step = pair[1] - pair[0];
            let length = step.norm();
            let direction = step / length;
            cuts.sort_by(f64::total_cmp);
            let mut from = 0.0;
            let inner = cuts
                .iter()
                .copied()
                .filter(|cut| *cut < length - tolerance::JOINT_M);
            for cut in inner.chain([length]) {
                if cut - from <= tolerance::JOINT_M {
                    continue;
                }
                let ends = [places.len() - 1, places.len()];
                legs.push(NetworkLeg {
                    start: pair[0] + direction * from,
                    direction,
                    length: cut - from,
                    path: self.path,
                    start_distance: distance + from,
                    ends,
                });
                places.push((
                    self.path,
                    if cut == length {
                        pair[1]
                    } else {
                        pair[0] + direction * cut
                    },
                ));
                from = cut;
            }
            distance += length;
        }
    }
}

/// Parameter of a point along a leg, if it lies on it.
fn foot(leg: &[Vector], p: Vector) -> Option<f64> {
    let step = leg[1] - leg[0];
    let length = step.norm();
    let along = step.dot(&(p - leg[0])) / length;
    let on = (leg[0] + step * (along / length).clamp(0.0, 1.0) - p).norm() <= tolerance::JOINT_M;
    on.then_some(along.clamp(0.0, length))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry_fixtures::places as points;

    /// Lengths of all ways from start to end that use each leg at most once.
    fn ways(network: &PathNetwork) -> Vec<f64> {
        fn follow(n: &PathNetwork, at: usize, used: &mut Vec<usize>, run: f64, out: &mut Vec<f64>) {
            if !used.is_empty() && n.is_end(at) {
                out.push(run);
                return;
            }
            for &leg in n.onward(at) {
                if !used.contains(&leg) {
                    used.push(leg);
                    let l = &n.legs()[leg];
                    follow(n, l.ends[1], used, run + l.length, out);
                    used.pop();
                }
            }
        }
        let mut out = Vec::new();
        follow(network, network.start(), &mut Vec::new(), 0.0, &mut out);
        out.sort_by(f64::total_cmp);
        out
    }

    #[test]
    fn one_path_is_sailed_as_it_is() {
        let main = points(&[(0.0, 0.0), (100.0, 0.0), (100.0, 50.0), (0.0, 0.0)]);
        let network = PathNetwork::new(&main, &[]).expect("sound");
        assert_eq!(network.legs().len(), 3);
        let round = 150.0 + 100.0_f64.hypot(50.0);
        assert_eq!(ways(&network), [round]);
        assert!((network.to_go(network.start()) - round).abs() < 1e-9);
        assert_eq!(network.legs()[2].start_distance, 150.0);
        let twice = points(&[(0.0, 0.0), (0.0, 0.0)]);
        let empty = NetworkError::EmptyLeg { path: 0, leg: 0 };
        assert_eq!(PathNetwork::new(&twice, &[]), Err(empty));
        assert_eq!(PathNetwork::new(&main[..1], &[]), Err(empty));
    }

    #[test]
    fn paths_are_changed_at_waypoints_crossings_and_common_stretches() {
        let main = points(&[(0.0, 0.0), (300.0, 0.0)]);
        let detour = |list: &[(f64, f64)]| vec![points(list)];
        // leaves the leg and returns to it
        let network =
            PathNetwork::new(&main, &detour(&[(100.0, 0.0), (150.0, 50.0), (200.0, 0.0)]))
                .expect("sound");
        assert_eq!(network.legs().len(), 5);
        let around = 200.0 + 2.0 * 50.0_f64.hypot(50.0);
        let found = ways(&network);
        assert!((found[0] - 300.0).abs() < 1e-9 && (found[1] - around).abs() < 1e-9);
        // crosses twice between its own waypoints
        let zigzag = detour(&[(50.0, -30.0), (90.0, 30.0), (150.0, -30.0)]);
        let network = PathNetwork::new(&main, &zigzag).expect("sound");
        assert_eq!((network.legs().len(), ways(&network).len()), (3 + 4, 2));
        // a common part, then another way to the same end
        let other = detour(&[(0.0, 0.0), (100.0, 0.0), (200.0, 80.0), (300.0, 0.0)]);
        let network = PathNetwork::new(&main, &other).expect("sound");
        assert_eq!(ways(&network).len(), 4);
        // two detours in succession, the second one from the first
        let chained = [
            points(&[(100.0, 0.0), (150.0, 50.0), (200.0, 0.0)]),
            points(&[(150.0, 50.0), (250.0, 90.0), (300.0, 0.0)]),
        ];
        let network = PathNetwork::new(&main, &chained).expect("sound");
        assert_eq!(ways(&network).len(), 3);
    }

    #[test]
    fn alternatives_of_no_use_are_named() {
        let main = points(&[(0.0, 0.0), (300.0, 0.0)]);
        let apart = points(&[(0.0, 90.0), (300.0, 90.0)]);
        let dead_end = points(&[(100.0, 0.0), (100.0, 80.0)]);
        let joining = points(&[(100.0, 80.0), (100.0, 0.0)]);
        let good = points(&[(100.0, 0.0), (150.0, 50.0), (200.0, 0.0)]);
        let found = |list: &[&Vec<Vector>]| {
            let list: Vec<Vec<Vector>> = list.iter().map(|p| (*p).clone()).collect();
            PathNetwork::new(&main, &list).map(|_| ())
        };
        assert_eq!(found(&[&good]), Ok(()));
        let no_point = NetworkError::NoSharedPoint { alternative: 1 };
        assert_eq!(found(&[&good, &apart]), Err(no_point));
        let no_way = NetworkError::NoWayThrough { alternative: 0 };
        assert_eq!(found(&[&dead_end]), Err(no_way));
        assert_eq!(found(&[&joining]), Err(no_way));
        let nan = points(&[(0.0, 0.0), (f64::NAN, 0.0)]);
        assert_eq!(
            found(&[&nan]),
            Err(NetworkError::EmptyLeg { path: 1, leg: 0 })
        );
    }

    #[test]
    fn a_round_trip_with_an_alternative_is_not_over_before_it_begins() {
        let main = points(&[(0.0, 0.0), (100.0, 0.0), (0.0, 0.0)]);
        let other = vec![points(&[(0.0, 0.0), (0.0, 70.0), (100.0, 0.0)])];
        let network = PathNetwork::new(&main, &other).expect("sound");
        assert!(!network.is_end(network.start()));
        assert!((network.to_go(network.start()) - 200.0).abs() < 1e-9);
    }
}
