//! Places where a profile of least space-time error may bend besides the corners: where it joins or
//! leaves the desired trajectory, or an obstacle's edge.
//!
//! While own ship is behind her schedule, or ahead of it, nothing is won by a speed in between: she
//! waits or sails at full speed, or slides along an edge. So from every corner rays are drawn at
//! both extreme speeds, forward and backward in time, toward the schedule, until they reach it or
//! meet an obstacle.

use super::due::Due;
use super::nodes::{Known, Mark, Node, Place};
use super::scene::Scene;
use crate::obstacle::PathTime;
use crate::tolerance;

/// Rays go on over leg after leg; at most so many pieces of one.
const MAX_PIECES: usize = 100;

/// Adds to the corners where the schedule meets legs' ends and obstacles' edges, and where the rays
/// end.
pub(crate) fn add_rays(scene: &Scene, known: &mut Known, root: &Node) {
    for (leg, due) in scene.dues.iter().enumerate() {
        if let Some(due) = due {
            schedule(scene, leg, due, known);
        }
    }
    // the latest arrival: a schedule that is later is left for it
    for (leg, ends) in scene.network.legs().iter().map(|leg| leg.ends).enumerate() {
        if scene.network.is_end(ends[1]) {
            let last = PathTime {
                distance: scene.tracks[leg].length,
                time: scene.horizon,
            };
            known.add(scene, leg, last, None, Mark::Corner);
        }
    }
    let corners: Vec<(usize, PathTime)> = sources(scene, known, root);
    for (leg, at) in corners {
        for forward in [true, false] {
            Ray { scene }.cast(leg, at, forward, known);
        }
    }
    known.in_order();
}

/// The corners, each with a leg that it is on; those at points with every leg there. And the root.
fn sources(scene: &Scene, known: &Known, root: &Node) -> Vec<(usize, PathTime)> {
    let nodes = known.on.iter().chain(&known.at).flatten();
    let mut sources = Vec::new();
    for node in nodes.filter(|n| n.mark == Mark::Corner) {
        match node.place {
            Place::On { leg, distance } => sources.push((
                leg,
                PathTime {
                    distance,
                    time: node.time,
                },
            )),
            Place::At(point) => {
                for &(leg, distance) in scene.touching(point) {
                    sources.push((
                        leg,
                        PathTime {
                            distance,
                            time: node.time,
                        },
                    ));
                }
            }
        }
    }
    let onward = match root.place {
        Place::On { leg, .. } => &[leg][..],
        Place::At(point) => scene.network.onward(point),
    };
    let begun = |leg: &usize| Some((*leg, root.on(scene, *leg)?));
    sources.extend(onward.iter().filter_map(begun));
    sources
}

/// Where own ship is due at the ends of a leg, and where the schedule meets obstacles.
fn schedule(scene: &Scene, leg: usize, due: &Due, known: &mut Known) {
    let length = scene.tracks[leg].length;
    let from = PathTime {
        distance: 0.0,
        time: due.start,
    };
    let to = PathTime {
        distance: length,
        time: due.start + length / due.speed,
    };
    // a schedule that is faster than own ship cannot be followed
    if due.speed > scene.max_speed * (1.0 + tolerance::LIMIT) {
        return;
    }
    known.add(scene, leg, from, None, Mark::Due);
    known.add(scene, leg, to, None, Mark::Due);
    for seen in &scene.seen[leg] {
        if let Some(shares) = seen.body.inside(from, to, 0.0) {
            for share in shares.into_iter().filter(|s| *s > 0.0 && *s < 1.0) {
                let at = PathTime {
                    distance: length * share,
                    time: from.time + (to.time - from.time) * share,
                };
                known.add(scene, leg, at, Some(seen.obstacle), Mark::Due);
            }
        }
    }
}

struct Ray<'a> {
    scene: &'a Scene<'a>,
}

impl Ray<'_> {
    /// A ray toward the schedule: at full speed to catch up and at rest to let it catch up,
    /// forward; backward the other way round. Where there is no schedule, at full speed.
    fn cast(&self, leg: usize, at: PathTime, forward: bool, known: &mut Known) {
        let Some(due) = self.scene.dues[leg] else {
            self.run(leg, at, forward, None, known);
            return;
        };
        let behind = due.lag(at);
        if behind.abs() <= tolerance::LENGTH_M {
            return;
        }
        if (behind > 0.0) == forward {
            self.run(leg, at, forward, Some(behind > 0.0), known);
        } else {
            // at rest until it is on schedule
            let time = due.start + at.distance / due.speed;
            let to = PathTime {
                distance: at.distance,
                time: time.clamp(0.0, self.scene.horizon),
            };
            self.end(leg, at, to, forward, to.time == time, known);
        }
    }

    /// At full speed over the legs, until on schedule, against an obstacle, or at the end of what
    /// there is.
    fn run(
        &self,
        leg: usize,
        at: PathTime,
        forward: bool,
        behind: Option<bool>,
        known: &mut Known,
    ) {
        let scene = self.scene;
        let sign = if forward { 1.0 } else { -1.0 };
        let mut open = vec![(leg, at)];
        for _ in 0..MAX_PIECES {
            let Some((leg, at)) = open.pop() else { return };
            let length = scene.tracks[leg].length;
            let way = if forward {
                length - at.distance
            } else {
                at.distance
            };
            let sailed = |way: f64| PathTime {
                distance: at.distance + sign * way,
                time: at.time + sign * way / scene.max_speed,
            };
            let mut to = sailed(way);
            let mut due_there = false;
            if let Some(due) = self.scene.dues[leg]
                && behind.is_some()
            {
                let closing = scene.max_speed - due.speed;
                let needed = due.lag(at).abs() * scene.max_speed / closing;
                if closing > 0.0 && needed <= way {
                    to = sailed(needed);
                    due_there = true;
                }
            }
            if !(to.time >= 0.0 && to.time <= scene.horizon) {
                continue;
            }
            let whole = self.end(leg, at, to, forward, due_there, known);
            if due_there || !whole {
                continue;
            }
            let ends = scene.network.legs()[leg].ends;
            let point = if forward { ends[1] } else { ends[0] };
            for &(next, distance) in scene.touching(point) {
                let starts = distance == 0.0;
                let same_schedule = behind.is_none() || self.scene.dues[next].is_some();
                if starts == forward && next != leg && same_schedule {
                    let at = PathTime {
                        distance,
                        time: to.time,
                    };
                    open.push((next, at));
                }
            }
        }
    }

    /// Adds where a line ends or meets an obstacle. True when nothing is met.
    fn end(
        &self,
        leg: usize,
        at: PathTime,
        to: PathTime,
        forward: bool,
        due: bool,
        known: &mut Known,
    ) -> bool {
        let scene = self.scene;
        let (from, until) = if forward { (at, to) } else { (to, at) };
        match scene.nearest_barrier(leg, from, until, forward) {
            None => {
                let mark = if due { Mark::Due } else { Mark::Passed };
                known.add(scene, leg, to, None, mark);
                true
            }
            Some((obstacle, share)) => {
                let met = PathTime {
                    distance: from.distance + share * (until.distance - from.distance),
                    time: from.time + share * (until.time - from.time),
                };
                known.add(scene, leg, met, Some(obstacle), Mark::Passed);
                false
            }
        }
    }
}
