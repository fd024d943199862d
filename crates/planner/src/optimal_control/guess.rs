//! Initial guesses of the solver; they need be neither feasible nor clear.

use super::keep_out::KeepOut;
use super::task::{Profile, Task};
use searoom_geometry::frame::{Vector, heading_of, to_port, wrap};
use searoom_model::vessel::{ForceVector, Manoeuvring, StateVector};

/// Amplitudes of the lateral family as fractions of the path length.
const AMPLITUDES: [f64; 5] = [0.0, -0.135, 0.135, -0.27, 0.27];

/// Number of the worst conflicting sets that are passed on either side, in every combination.
const MAX_SIDED: usize = 4;

/// Clearance from a set as a fraction of its extent.
const CLEARANCE: f64 = 0.3;

/// Kind of initial guess.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Start {
    /// The last plan.
    Previous,
    /// Trajectory of the space-time planner.
    SpaceTime,
    /// Desired trajectory, bent to one side; the index of the amplitude.
    Lateral(usize),
    /// Desired trajectory, bent around the sets it meets; bit `k` gives the side for the `k`-th
    /// worst one.
    Sided(usize),
}

impl std::fmt::Display for Start {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Previous => f.write_str("previous"),
            Self::SpaceTime => f.write_str("space-time"),
            Self::Lateral(index) => write!(f, "lateral {}", index + 1),
            Self::Sided(sides) => write!(f, "sides {}", sides + 1),
        }
    }
}

/// States along positions at the nodes: heading and speed follow from the displacement, forces hold
/// the speed.
pub fn profile_along<V: Manoeuvring>(task: &Task<V>, positions: &[Vector]) -> Profile {
    let n = task.intervals;
    let step = task.step();
    // a shorter displacement defines no heading
    let least = 1e-3 * task.vessel.scales().state[0];
    let mut headings = vec![task.first[2]; n + 1];
    for k in 1..=n {
        let way = positions[(k + 1).min(n)] - positions[k - 1];
        let turn = if way.norm() > least {
            wrap(heading_of(way) - headings[k - 1])
        } else {
            0.0
        };
        headings[k] = headings[k - 1] + turn;
    }
    let mut states = vec![task.first];
    for k in 1..=n {
        let way = (positions[k] - positions[k - 1]).norm() / step;
        states.push(StateVector::new(
            positions[k].x,
            positions[k].y,
            headings[k],
            way,
            0.0,
            (headings[k] - headings[k - 1]) / step,
        ));
    }
    let limits = task.controls.force_limits;
    let forces = (0..n)
        .map(|k| {
            let held = task.vessel.steady(states[k + 1][3]);
            // the solver rejects reversed limits
            ForceVector::from_fn(|i, _| held[i].max(-limits[i]).min(limits[i]))
        })
        .collect();
    Profile { states, forces }
}

/// Desired positions at the nodes, plus own ship's initial offset, which decays.
fn desired_positions<V: Manoeuvring>(task: &Task<V>) -> Vec<Vector> {
    let at = |k: usize| task.desired.position_at(task.time(k));
    let offset = Vector::new(task.first[0], task.first[1]) - at(0);
    (0..=task.intervals)
        .map(|k| {
            let left = 1.0 - k as f64 / task.intervals as f64;
            at(k) + offset * left * left
        })
        .collect()
}

/// Initial guesses that need no other planner, in a fixed order and without repetition.
pub fn family<V: Manoeuvring>(task: &Task<V>) -> Vec<(Start, Profile)> {
    let base = desired_positions(task);
    let way = base[base.len() - 1] - base[0];
    let aside = way.try_normalize(0.0).map_or_else(Vector::zeros, to_port);
    let mut starts: Vec<(Start, Vec<Vector>)> = AMPLITUDES
        .iter()
        .enumerate()
        .map(|(index, amplitude)| {
            let bent = base.iter().enumerate().map(|(k, place)| {
                let part = k as f64 / task.intervals as f64;
                place + aside * (amplitude * way.norm() * (std::f64::consts::PI * part).sin())
            });
            (Start::Lateral(index), bent.collect())
        })
        .collect();
    let conflicts = conflicts(task, &base);
    for sides in 0..1usize << conflicts.len() {
        if conflicts.is_empty() {
            break;
        }
        let mut bent = base.clone();
        for (k, conflict) in conflicts.iter().enumerate() {
            conflict.push(task, &mut bent, sides >> k & 1 == 1);
        }
        starts.push((Start::Sided(sides), bent));
    }
    starts
        .into_iter()
        .map(|(start, positions)| (start, profile_along(task, &positions)))
        .collect()
}

/// Set that the desired trajectory comes near.
#[derive(Debug, Clone, Copy)]
struct Conflict {
    /// Time of the greatest depth, seconds.
    time: f64,
    level: f64,
    /// Unit vector to port of the motion relative to the set's centre.
    port: Vector,
    /// Offset that clears the set from the desired position, to port and to starboard, metres.
    shift: [f64; 2],
    /// Duration of the passage, seconds.
    passing: f64,
}

impl Conflict {
    /// Moves positions to port or starboard around the time of the conflict.
    fn push<V: Manoeuvring>(&self, task: &Task<V>, positions: &mut [Vector], port: bool) {
        let shift = self.port * if port { self.shift[0] } else { -self.shift[1] };
        for (k, place) in positions.iter_mut().enumerate().skip(1) {
            let off = (task.time(k) - self.time) / self.passing;
            *place += shift * (-0.5 * off * off).exp();
        }
    }
}

/// Conflicts of given positions, the worst first.
fn conflicts<V: Manoeuvring>(task: &Task<V>, positions: &[Vector]) -> Vec<Conflict> {
    let mut found: Vec<Conflict> = task
        .keep_outs
        .iter()
        .filter_map(|keep| conflict(task, positions, keep))
        .collect();
    found.sort_by(|a, b| a.level.total_cmp(&b.level));
    found.truncate(MAX_SIDED);
    found
}

fn conflict<V: Manoeuvring>(
    task: &Task<V>,
    positions: &[Vector],
    keep: &KeepOut,
) -> Option<Conflict> {
    let level = |k: &usize| keep.at(task.time(*k)).level(positions[*k]);
    let k = (1..task.intervals).min_by(|a, b| level(a).total_cmp(&level(b)))?;
    let level = level(&k);
    // beyond twice its size the set is no obstacle
    if !(level < 4.0) {
        return None;
    }
    let time = task.time(k);
    let own = (positions[k + 1] - positions[k - 1]) / (2.0 * task.step());
    let relative = own - keep.set().velocity().center();
    let port = to_port(relative.try_normalize(0.0)?);
    let section = keep.set().outer_section(time);
    let lateral = port.dot(&(positions[k] - section.center()));
    let reach = (1.0 + CLEARANCE) * section.radius(port);
    Some(Conflict {
        time,
        level,
        port,
        shift: [(reach - lateral).max(0.0), (reach + lateral).max(0.0)],
        passing: (reach / relative.norm()).max(0.05 * task.duration),
    })
}
