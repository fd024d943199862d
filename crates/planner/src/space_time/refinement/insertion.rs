//! Segment insertion: finds new segment variables whose first metre lowers the cost.
//!
//! A segment variable that is inserted between two others moves all that follows as a rigid body.
//! So the rate of the cost with its length, including the price of the contacts, is one linear form
//! of its twist. This form is common to every kind of segment variable at that position (column
//! generation, with the multipliers of the last quadratic programme). Where no rate is negative, no
//! structure with more segment variables is cheaper, to first order.

use crate::space_time::context::Context;
use crate::space_time::manoeuvre::ending::Ending;
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::refinement::InitialGuess;
use crate::space_time::refinement::gauss_newton::{Accumulation, Twist, dot4};
use crate::space_time::refinement::model::UnreducedModel;
use crate::space_time::refinement::quadratic::{MAX_VARIABLES, Programme};
use crate::space_time::refinement::rollout::SegmentOrigin;
use crate::space_time::refinement::structure::{SegmentVariable, Structure};
use searoom_geometry::frame::{Side, Vector};

/// Largest multiplier of a metre of slack, m²/m.
const MAX_MULTIPLIER: f64 = 1e5;

/// Segment variable to be inserted before segment variable `gap`.
#[derive(Debug, Clone, Copy)]
struct Insertion {
    gap: usize,
    variable: SegmentVariable,
    /// Predicted gain to second order, on its own, m².
    gain: f64,
}

/// Divides long lines in two and inserts the most promising segment variables, with zero length. `None` when
/// nothing is promising, or when it does not fit.
pub(crate) fn with_insertions(context: &Context, guess: &InitialGuess) -> Option<InitialGuess> {
    let base = split(context, guess, context.problem.settings.insertion.uncut_m)?;
    let found = insertions(context, &base)?;
    let mut pieces: Vec<(SegmentVariable, f64)> = Vec::with_capacity(MAX_VARIABLES);
    for gap in 0..=base.structure.free() {
        let inserted = found.iter().filter(|a| a.gap == gap);
        pieces.extend(inserted.map(|a| (a.variable, 0.0)));
        pieces.extend(base.pieces().nth(gap));
    }
    Some(InitialGuess::new(&pieces, base.structure.ending))
}

/// Removes turns and lines too short to be useful; `None` when there are none.
pub(crate) fn pruned(context: &Context, guess: &InitialGuess) -> Option<InitialGuess> {
    let radius = context.problem.own.turning_radius;
    let settings = &context.problem.settings.insertion;
    let is_of_use = |(variable, length): &(SegmentVariable, f64)| match variable {
        SegmentVariable::Ordered { .. } | SegmentVariable::Run { .. } => true,
        SegmentVariable::Arc { .. } => *length >= settings.least_turn * radius,
        SegmentVariable::Line { .. } => *length >= settings.least_line * radius,
    };
    let kept: Vec<_> = guess.pieces().filter(is_of_use).collect();
    let is_shorter = kept.len() < guess.structure.free();
    is_shorter.then(|| InitialGuess::new(&kept, guess.structure.ending))
}

/// Removes empty segment variables and divides lines longer than `uncut` metres, including the dependent line of a
/// return.
fn split(context: &Context, guess: &InitialGuess, uncut: f64) -> Option<InitialGuess> {
    let empty = context.problem.settings.insertion.empty_m;
    let mut pieces: Vec<(SegmentVariable, f64)> = Vec::with_capacity(MAX_VARIABLES);
    let mut add = |variable: SegmentVariable, length: f64| {
        let is_line = matches!(variable, SegmentVariable::Line { .. });
        let count = if is_line && length > uncut { 2 } else { 1 };
        pieces.extend(std::iter::repeat_n(
            (variable, length / count as f64),
            count,
        ));
    };
    for (variable, length) in guess.pieces() {
        let is_run = variable.is_on_route();
        if length >= empty || is_run && length > 0.0 {
            add(variable, length);
        }
    }
    if let Ending::Return { speed, .. } = guess.structure.ending {
        let rollout = guess
            .structure
            .roll_out(context.problem, context.route, &guess.lengths)?;
        if rollout.solved[0] > uncut {
            add(
                SegmentVariable::Line { speed },
                2.0 / 3.0 * rollout.solved[0],
            );
        }
    }
    // at least one insertion must fit beside the two dependent segment variables
    let has_room = pieces.len() + 3 <= MAX_VARIABLES;
    has_room.then(|| InitialGuess::new(&pieces, guess.structure.ending))
}

/// Most promising insertions; `None` where their total predicted gain is negligible.
fn insertions(context: &Context, base: &InitialGuess) -> Option<Vec<Insertion>> {
    let settings = &context.problem.settings.insertion;
    let free = base.structure.free();
    let trial = context.trial(&base.structure, &base.lengths)?;
    let unreduced = context.unreduced(&base.structure, trial);
    let multipliers = multipliers(context, base)?;
    let prices = Prices::new(context, &base.structure, &unreduced, &multipliers);
    let first = unreduced.trial.rollout.runs;
    let mut found = Vec::new();
    let turn = first_turn(&base.structure);
    for gap in first..=free {
        let beside = [gap.checked_sub(1), Some(gap)];
        let beside = beside.map(|i| i.and_then(|i| base.structure.variables.get(i)));
        for variable in kinds(context) {
            let swings_out = turn.is_some_and(|(at, side)| {
                gap <= at
                    && matches!(variable, SegmentVariable::Arc { side: other, .. } if other != side)
            });
            if swings_out || beside.contains(&Some(&variable)) {
                continue;
            }
            let gain = prices.gain(context, &unreduced, gap, variable);
            if gain > 0.0 {
                found.push(Insertion {
                    gap,
                    variable,
                    gain,
                });
            }
        }
    }
    found.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    found.truncate(settings.max_insertions.min(MAX_VARIABLES - 2 - free));
    let promised: f64 = found.iter().map(|a| a.gain).sum();
    (promised > settings.min_predicted_gain * unreduced.trial.cost).then_some(found)
}

/// Position and side of the first turn. No turn to the other side is inserted before it: other
/// ships must see at once on which side own ship intends to pass.
fn first_turn(structure: &Structure) -> Option<(usize, Side)> {
    let mut variables = structure.variables.iter().enumerate();
    variables.find_map(|(at, variable)| match variable {
        SegmentVariable::Arc { side, .. } => Some((at, *side)),
        _ => None,
    })
}

/// Every kind of segment variable after the runs.
fn kinds(context: &Context) -> impl Iterator<Item = SegmentVariable> + use<> {
    let ManoeuvreSpeeds {
        slow, normal, fast, ..
    } = context.speeds;
    let mut speeds = vec![slow, normal, fast];
    speeds.dedup();
    speeds.into_iter().flat_map(|speed| {
        let turns = Side::BOTH.map(|side| SegmentVariable::Arc { side, speed });
        turns.into_iter().chain([SegmentVariable::Line { speed }])
    })
}

/// Multiplier of each row, m² per metre of slack, from one quadratic programme.
fn multipliers(context: &Context, base: &InitialGuess) -> Option<Vec<f64>> {
    let free = base.structure.free();
    let model = context.model(&base.structure, &base.lengths)?;
    let radius = context.problem.settings.insertion.pricing_radius_m;
    let programme = Programme {
        size: free,
        hessian: &model.hessian,
        gradient: &model.gradient,
        low: &base.lengths.map(|l| (-radius).max(-l)),
        high: &[radius; MAX_VARIABLES],
        rows: &model.rows,
        price: Some(MAX_MULTIPLIER),
    };
    Some(programme.solve()?.multipliers)
}

/// Cost per metre of a change before each segment variable, as a linear form of its twist about
/// `origin`.
struct Prices {
    origin: Vector,
    forms: Vec<Twist>,
    moments: Vec<Accumulation>,
}

impl Prices {
    fn new(
        context: &Context,
        structure: &Structure,
        unreduced: &UnreducedModel,
        multipliers: &[f64],
    ) -> Self {
        let (free, all) = (structure.free(), structure.all());
        let rollout = &unreduced.trial.rollout;
        let origin = context.problem.own.pose.position;
        let moments = unreduced.moments.sums_from_each();
        let joined_by = rollout.joined_by(origin);
        // contribution of the return segments, common to all changes
        let mut common = [0.0; 4];
        let add_tail = |form: &mut Twist, by_distance: f64, by_time: f64| {
            add(form, &joined_by, by_distance);
            add(form, &[0.0, 0.0, 1.0, 0.0], by_time);
        };
        if let Some(return_segments) = &unreduced.trial.return_segments {
            add_tail(
                &mut common,
                return_segments.by_distance,
                return_segments.by_time,
            );
        }
        let mut forms: Vec<Twist> = moments.iter().map(Accumulation::gradient_form).collect();
        let mut of_solved = [0.0; 2];
        for (k, price) in of_solved.iter_mut().enumerate().take(all - free) {
            *price = unreduced.gradient[free + k];
        }
        for (approach, multiplier) in unreduced.trial.approaches.iter().zip(multipliers) {
            if *multiplier <= 0.0 {
                continue;
            }
            let [east, north, clock] = approach.rates;
            let legs = &rollout.legs[approach.leg];
            let last = match (rollout.place(approach.leg, approach.fraction), legs.owner) {
                (Some(place), _) => {
                    let at = place.position - origin;
                    let form = [east, north, clock, at.x * north - at.y * east];
                    for form_of_gap in forms.iter_mut().take(place.variable + 1) {
                        add(form_of_gap, &form, -multiplier);
                    }
                    place.variable
                }
                (None, SegmentOrigin::ReturnSegments { index }) => {
                    let (by_distance, by_time) =
                        context.return_segment_rates(rollout, index, approach);
                    add_tail(
                        &mut common,
                        -multiplier * by_distance,
                        -multiplier * by_time,
                    );
                    all
                }
                (None, SegmentOrigin::SegmentVariable { .. }) => continue,
            };
            if last >= free {
                let row = context.approach_row(&unreduced.trial, approach);
                for (k, price) in of_solved.iter_mut().enumerate().take(all - free) {
                    *price -= multiplier * row[free + k];
                }
            }
        }
        // rows after those of the approaches keep the dependent segment variables positive
        for (price, multiplier) in of_solved
            .iter_mut()
            .zip(&multipliers[unreduced.trial.approaches.len()..])
        {
            *price -= multiplier;
        }
        let by = rollout.solved_by(structure.ending, context.problem, origin);
        for (form, price) in by.iter().zip(of_solved) {
            add(&mut common, form, price);
        }
        for form in &mut forms {
            add(form, &common, 1.0);
        }
        Self {
            origin,
            forms,
            moments,
        }
    }

    /// Rate of the cost with the length of a segment variable inserted before segment variable
    /// `gap`, m² per metre, and the second rate.
    fn rate(
        &self,
        context: &Context,
        unreduced: &UnreducedModel,
        gap: usize,
        variable: SegmentVariable,
    ) -> Option<(f64, f64)> {
        let leg = unreduced.trial.rollout.legs.iter().find(
            |l| matches!(l.owner, SegmentOrigin::SegmentVariable { index, .. } if index == gap),
        )?;
        let at = leg.segment.start.position - self.origin;
        let slowness = 1.0 / variable.speed();
        let curvature = match variable {
            SegmentVariable::Arc { side, .. } => {
                side.turn_sign() / context.problem.own.turning_radius
            }
            _ => 0.0,
        };
        let twist = [
            leg.ahead.x + curvature * at.y,
            leg.ahead.y - curvature * at.x,
            slowness,
            curvature,
        ];
        let desired = context.problem.desired;
        let start = leg.segment.start.position;
        let here = desired.nearest(start, leg.segment.start_time, context.problem.time_weight);
        let own = slowness / desired.duration() * here.error;
        Some((
            dot4(&twist, &self.forms[gap]) + own,
            self.moments[gap].curvature_along(&twist),
        ))
    }

    /// Predicted gain of one insertion, m², to second order; zero when its first metre costs.
    fn gain(
        &self,
        context: &Context,
        unreduced: &UnreducedModel,
        gap: usize,
        variable: SegmentVariable,
    ) -> f64 {
        let Some((rate, curvature_along)) = self.rate(context, unreduced, gap, variable) else {
            return 0.0;
        };
        if rate < 0.0 {
            0.5 * rate * rate / curvature_along.max(1e-9 * unreduced.trial.cost.max(1.0))
        } else {
            0.0
        }
    }
}

fn add(form: &mut Twist, other: &Twist, weight: f64) {
    for (a, b) in form.iter_mut().zip(other) {
        *a += weight * b;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space_time::refinement::model::tests::at_manoeuvres;

    /// Compares every price with the reduced gradient of the structure with the inserted, empty
    /// segment variable.
    #[test]
    fn prices_are_the_rates_of_the_larger_structure() {
        at_manoeuvres(|context, guess| {
            let trial = context.trial(&guess.structure, &guess.lengths);
            let unreduced = context.unreduced(&guess.structure, trial.expect("fits"));
            let multipliers = multipliers(context, guess).expect("solvable");
            let prices = Prices::new(context, &guess.structure, &unreduced, &multipliers);
            assert!(multipliers.iter().any(|m| *m > 0.0));
            for gap in unreduced.trial.rollout.runs..=guess.structure.free() {
                for variable in kinds(context) {
                    let mut larger = guess.clone();
                    larger.structure.variables.insert(gap, variable);
                    larger.lengths[gap..].rotate_right(1);
                    larger.lengths[gap] = 0.0;
                    let model = context.model(&larger.structure, &larger.lengths);
                    let model = model.expect("an empty variable changes nothing");
                    let of_rows: f64 = model
                        .rows
                        .iter()
                        .zip(&multipliers)
                        .map(|(row, multiplier)| row.coefficients[gap] * multiplier)
                        .sum();
                    let expected = model.gradient[gap] - of_rows;
                    let (found, curvature_along) = prices
                        .rate(context, &unreduced, gap, variable)
                        .expect("a place");
                    assert!(
                        (found - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                        "{variable:?} before {gap}: {found} {expected}"
                    );
                    assert!(curvature_along >= -1e-9 * (1.0 + found.abs()));
                }
            }
        });
    }

    #[test]
    fn a_split_manoeuvre_has_the_same_rollout() {
        at_manoeuvres(|context, guess| {
            let whole = context
                .model(&guess.structure, &guess.lengths)
                .expect("fits");
            let pieces = split(context, guess, 30.0).expect("room for pieces");
            assert!(pieces.structure.free() > 0);
            let again = context
                .model(&pieces.structure, &pieces.lengths)
                .expect("fits");
            assert!((whole.cost - again.cost).abs() < 1e-6 * whole.cost);
        });
    }
}
