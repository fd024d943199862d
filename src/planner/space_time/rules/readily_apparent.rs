//! Constraint of a readily apparent alteration (Rule 8): a turn or a speed reduction has a least
//! length, and no turn precedes it.

use crate::colregs::APPARENT_TIME;
use crate::frame::Side;
use crate::planner::Problem;
use crate::planner::space_time::refinement::InitialGuess;
use crate::planner::space_time::refinement::quadratic::Row;
use crate::planner::space_time::refinement::structure::SegmentVariable;
use crate::planner::space_time::rules::compliance::apparent_slow_speed;

/// Relative excess of its length over the least one, to cover rounding.
const SPARE: f64 = 1e-7;

/// Segment variable with a least length, and the arcs before the first turn, which stay empty.
#[derive(Debug, Clone)]
pub(crate) struct Apparent {
    variable: usize,
    /// Least length, metres.
    least: f64,
    empty: Vec<usize>,
}

/// Side of a segment variable that turns.
fn side_of(variable: &SegmentVariable) -> Option<Side> {
    match variable {
        SegmentVariable::Arc { side, .. } => Some(*side),
        SegmentVariable::Run { .. } | SegmentVariable::Line { .. } => None,
    }
}

impl Apparent {
    /// Enlarges the first turn of an initial guess to the least apparent one, unless a visible
    /// speed reduction precedes it. `None` where the turn is to the wrong side, or there is none. A
    /// turn consists of consecutive arcs to one side at several speeds; the longest of them keeps
    /// its length.
    pub(crate) fn of_guess(guess: &mut InitialGuess, problem: &Problem) -> Option<Self> {
        let duty = problem.duty();
        let variables = &guess.structure.variables;
        let turns = |i: &usize| side_of(&variables[*i]).is_some();
        let first = (0..variables.len())
            .find(|i| turns(i) && guess.lengths[*i] > 0.0)
            .or_else(|| (0..variables.len()).find(turns))?;
        let side = side_of(&variables[first])?;
        if !duty.sides().contains(&side) {
            return None;
        }
        let same = |i: &usize| side_of(&variables[*i]) == Some(side);
        let begin = (0..first).rev().take_while(same).last().unwrap_or(first);
        let empty = (0..begin).filter(turns).collect();
        let slows = |i: &usize| match variables[*i] {
            SegmentVariable::Run { speed }
                if duty.may_slow && speed <= apparent_slow_speed(problem) =>
            {
                guess.lengths[*i] >= speed * APPARENT_TIME * (1.0 - SPARE)
            }
            _ => false,
        };
        let (variable, least) = match (0..begin).find(slows) {
            Some(variable) => (variable, variables[variable].speed() * APPARENT_TIME),
            None => {
                let turn = (first..variables.len()).take_while(same);
                let longest = turn.max_by(|a, b| {
                    let lengths = guess.lengths[*a].total_cmp(&guess.lengths[*b]);
                    lengths.then(b.cmp(a))
                })?;
                (longest, duty.least_turn() * problem.own.turning_radius)
            }
        };
        let least = least * (1.0 + SPARE);
        guess.lengths[variable] = guess.lengths[variable].max(least);
        Some(Self {
            variable,
            least,
            empty,
        })
    }

    /// Narrows the bounds of a step from given lengths.
    pub(crate) fn narrow(&self, lengths: &Row, low: &mut Row, high: &mut Row) {
        low[self.variable] = low[self.variable].max((self.least - lengths[self.variable]).min(0.0));
        for &i in &self.empty {
            (low[i], high[i]) = (0.0, 0.0);
        }
    }
}
