//! The part of a manoeuvre that others have to see, a turn or a run at less speed: its length has a least value, and nothing
//! turns before it.

use crate::colregs::APPARENT_TIME;
use crate::frame::Side;
use crate::planner::Problem;
use crate::planner::space_time::refinement::Seed;
use crate::planner::space_time::refinement::quadratic::Row;
use crate::planner::space_time::refinement::structure::Slot;
use crate::planner::space_time::rules::compliance::slow;

/// Share by which it is longer than the least, for what rounding takes.
const SPARE: f64 = 1e-7;

/// A slot that keeps a length, and the arcs before the first turn, which stay empty.
#[derive(Debug, Clone)]
pub(crate) struct Apparent {
    slot: usize,
    /// Metres.
    least: f64,
    empty: Vec<usize>,
}

/// The side of a slot that turns.
fn side_of(slot: &Slot) -> Option<Side> {
    match slot {
        Slot::Arc { side, .. } => Some(*side),
        Slot::Run { .. } | Slot::Line { .. } => None,
    }
}

impl Apparent {
    /// The first turn of a seed, made as long as it has to be, unless own ship visibly slows down before it; `None` where it is to the
    /// wrong side, or there is none. A turn is arcs to one side, one right after another at several speeds; the longest of them
    /// is the one that keeps its length.
    pub(crate) fn in_seed(seed: &mut Seed, problem: &Problem) -> Option<Self> {
        let duty = problem.duty();
        let slots = &seed.template.slots;
        let turns = |i: &usize| side_of(&slots[*i]).is_some();
        let first = (0..slots.len())
            .find(|i| turns(i) && seed.lengths[*i] > 0.0)
            .or_else(|| (0..slots.len()).find(turns))?;
        let side = side_of(&slots[first])?;
        if !duty.sides().contains(&side) {
            return None;
        }
        let same = |i: &usize| side_of(&slots[*i]) == Some(side);
        let begin = (0..first).rev().take_while(same).last().unwrap_or(first);
        let empty = (0..begin).filter(turns).collect();
        let slows = |i: &usize| match slots[*i] {
            Slot::Run { speed } if duty.may_slow && speed <= slow(problem) => {
                seed.lengths[*i] >= speed * APPARENT_TIME * (1.0 - SPARE)
            }
            _ => false,
        };
        let (slot, least) = match (0..begin).find(slows) {
            Some(slot) => (slot, slots[slot].speed() * APPARENT_TIME),
            None => {
                let turn = (first..slots.len()).take_while(same);
                let longest = turn.max_by(|a, b| {
                    let lengths = seed.lengths[*a].total_cmp(&seed.lengths[*b]);
                    lengths.then(b.cmp(a))
                })?;
                (longest, duty.least_turn() * problem.own.turning_radius)
            }
        };
        let least = least * (1.0 + SPARE);
        seed.lengths[slot] = seed.lengths[slot].max(least);
        Some(Self { slot, least, empty })
    }

    /// Narrows a box of steps from given lengths.
    pub(crate) fn narrow(&self, lengths: &Row, low: &mut Row, high: &mut Row) {
        low[self.slot] = low[self.slot].max((self.least - lengths[self.slot]).min(0.0));
        for &i in &self.empty {
            (low[i], high[i]) = (0.0, 0.0);
        }
    }
}
