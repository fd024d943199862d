//! What a manoeuvre lacks: slots whose first metre would lower the cost.
//!
//! A slot that is put in between two others moves all that follows as a rigid body, so the rate of the cost with
//! its length, the price of the contacts included, is one linear form of its motor, the same for every kind of slot
//! at that place (column generation, with the multipliers of the last quadratic programme). Where no rate is
//! negative, no template with more slots is cheaper, to first order.

use crate::frame::{Side, Vector};
use crate::planner::space_time::refinement::Seed;
use crate::planner::space_time::refinement::gauss_newton::{Moment, Motor, dot4};
use crate::planner::space_time::refinement::model::Full;
use crate::planner::space_time::refinement::quadratic::{MAX_VARIABLES, Programme, Row};
use crate::planner::space_time::refinement::rollout::Owner;
use crate::planner::space_time::refinement::structure::{Ending, Slot, Template};
use crate::planner::space_time::refinement::trial::Scene;
use crate::planner::space_time::selection::initial_guess::Paces;

/// Metres. Shorter slots are left out before new ones are put in.
const EMPTY_M: f64 = 0.5;

/// Radians of turn, and turning radii of line, below which a slot is of no use.
const LEAST_TURN: f64 = 0.03;
const LEAST_LINE: f64 = 0.05;

/// Metres by which one step may change a length when the contacts are priced.
const PRICING_RADIUS_M: f64 = 20.0;

/// m²/m. What a missing metre of slack is worth at most.
const DEAREST: f64 = 1e5;

/// Slots added at a time, the most promising.
const MOST_ADDED: usize = 8;

/// Share of the cost that the additions have to promise.
const WORTH_ADDING: f64 = 1e-3;

/// A slot that could be put in before slot `gap`.
#[derive(Debug, Clone, Copy)]
struct Addition {
    gap: usize,
    slot: Slot,
    /// m², to second order and alone.
    gain: f64,
}

/// The manoeuvre with lines cut in two where they are longer than `uncut` metres, and with the slots that promise most,
/// still empty. `None` when nothing is promised, or it does not fit.
pub(crate) fn enriched(scene: &Scene, seed: &Seed, uncut: f64) -> Option<Seed> {
    let base = cut(scene, seed, uncut)?;
    let found = additions(scene, &base)?;
    let mut enriched = Seed {
        template: Template {
            slots: Vec::with_capacity(MAX_VARIABLES),
            ending: base.template.ending,
        },
        lengths: [0.0; MAX_VARIABLES],
    };
    let slots = &mut enriched.template.slots;
    for gap in 0..=base.template.slots.len() {
        slots.extend(found.iter().filter(|a| a.gap == gap).map(|a| a.slot));
        if let Some(slot) = base.template.slots.get(gap) {
            enriched.lengths[slots.len()] = base.lengths[gap];
            slots.push(*slot);
        }
    }
    Some(enriched)
}

/// The manoeuvre without turns and lines too short to be of use; `None` when it has none.
pub(crate) fn tidied(scene: &Scene, seed: &Seed) -> Option<Seed> {
    let radius = scene.problem.own.turning_radius;
    let is_of_use = |(slot, length): &(&Slot, &f64)| match slot {
        Slot::Run { .. } => true,
        Slot::Arc { .. } => **length >= LEAST_TURN * radius,
        Slot::Line { .. } => **length >= LEAST_LINE * radius,
    };
    let all = seed.template.slots.iter().zip(&seed.lengths);
    let kept: Vec<_> = all.filter(is_of_use).collect();
    if kept.len() == seed.template.slots.len() {
        return None;
    }
    let mut lengths: Row = [0.0; MAX_VARIABLES];
    for (to, (_, length)) in lengths.iter_mut().zip(&kept) {
        *to = **length;
    }
    Some(Seed {
        template: Template {
            slots: kept.iter().map(|k| *k.0).collect(),
            ending: seed.template.ending,
        },
        lengths,
    })
}

/// Leaves out what is empty, and cuts long lines, the solved one of a return included.
fn cut(scene: &Scene, seed: &Seed, uncut: f64) -> Option<Seed> {
    let mut parts: Vec<(Slot, f64)> = Vec::with_capacity(MAX_VARIABLES);
    let mut add = |slot: Slot, length: f64| {
        let is_line = matches!(slot, Slot::Line { .. });
        let count = if is_line && length > uncut { 2 } else { 1 };
        parts.extend(std::iter::repeat_n((slot, length / count as f64), count));
    };
    for (slot, length) in seed.template.slots.iter().zip(&seed.lengths) {
        let is_run = matches!(slot, Slot::Run { .. });
        if *length >= EMPTY_M || is_run && *length > 0.0 {
            add(*slot, *length);
        }
    }
    if let Ending::Return { speed, .. } = seed.template.ending {
        let sailed = seed
            .template
            .sail(scene.problem, scene.route, &seed.lengths)?;
        if sailed.solved[0] > uncut {
            add(Slot::Line { speed }, 2.0 / 3.0 * sailed.solved[0]);
        }
    }
    let mut lengths: Row = [0.0; MAX_VARIABLES];
    // one addition at least has to fit beside the two solved slots
    if parts.len() + 3 > MAX_VARIABLES {
        return None;
    }
    for (to, part) in lengths.iter_mut().zip(&parts) {
        *to = part.1;
    }
    Some(Seed {
        template: Template {
            slots: parts.iter().map(|p| p.0).collect(),
            ending: seed.template.ending,
        },
        lengths,
    })
}

/// The most promising additions, or `None` where all together promise next to nothing.
fn additions(scene: &Scene, base: &Seed) -> Option<Vec<Addition>> {
    let free = base.template.free();
    let outline = scene.outline(&base.template, &base.lengths)?;
    let full = scene.full(&base.template, outline);
    let multipliers = multipliers(scene, base)?;
    let prices = Prices::new(scene, &base.template, &full, &multipliers);
    let first = full.outline.sailed.runs;
    let mut found = Vec::new();
    let turn = first_turn(&base.template);
    let is_seen = !scene.problem.duty().is_none();
    for gap in first..=free {
        let beside = [gap.checked_sub(1), Some(gap)];
        let beside = beside.map(|i| i.and_then(|i| base.template.slots.get(i)));
        for slot in kinds(scene) {
            let swings_out = turn.is_some_and(|(at, side)| {
                gap <= at
                    && matches!(slot, Slot::Arc { side: other, .. } if other != side || is_seen && gap < at)
            });
            if swings_out || beside.contains(&Some(&slot)) {
                continue;
            }
            let gain = prices.gain(scene, &full, gap, slot);
            if gain > 0.0 {
                found.push(Addition { gap, slot, gain });
            }
        }
    }
    found.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    found.truncate(MOST_ADDED.min(MAX_VARIABLES - 2 - free));
    let promised: f64 = found.iter().map(|a| a.gain).sum();
    (promised > WORTH_ADDING * full.outline.cost).then_some(found)
}

/// Where the first turn is, and to which side. Nothing turns to the other side before it: others have to see at once
/// on which side own ship means to pass.
fn first_turn(template: &Template) -> Option<(usize, Side)> {
    let mut slots = template.slots.iter().enumerate();
    slots.find_map(|(at, slot)| match slot {
        Slot::Arc { side, .. } => Some((at, *side)),
        _ => None,
    })
}

/// Every kind of slot after the runs.
fn kinds(scene: &Scene) -> impl Iterator<Item = Slot> + use<> {
    let paces = Paces::of(scene.problem);
    let mut speeds = vec![paces.slow, paces.normal, paces.fast];
    speeds.dedup();
    speeds.into_iter().flat_map(|speed| {
        let turns = Side::BOTH.map(|side| Slot::Arc { side, speed });
        turns.into_iter().chain([Slot::Line { speed }])
    })
}

/// What a metre of slack is worth at each row, m²/m: the multipliers of one step.
fn multipliers(scene: &Scene, base: &Seed) -> Option<Vec<f64>> {
    let free = base.template.free();
    let model = scene.model(&base.template, &base.lengths)?;
    let programme = Programme {
        size: free,
        hessian: &model.hessian,
        gradient: &model.gradient,
        low: &base.lengths.map(|l| (-PRICING_RADIUS_M).max(-l)),
        high: &[PRICING_RADIUS_M; MAX_VARIABLES],
        rows: &model.rows,
        price: Some(DEAREST),
    };
    Some(programme.solve()?.multipliers)
}

/// What a change before each slot costs per metre, as a linear form of its motor about `origin`.
struct Prices {
    origin: Vector,
    forms: Vec<Motor>,
    moments: Vec<Moment>,
}

impl Prices {
    fn new(scene: &Scene, template: &Template, full: &Full, multipliers: &[f64]) -> Self {
        let (free, all) = (template.free(), template.all());
        let sailed = &full.outline.sailed;
        let origin = scene.problem.own.pose.position;
        let moments = full.moments.sums_from_each();
        let joined_by = sailed.joined_by(origin);
        // what every later change has in common: the tail
        let mut common = [0.0; 4];
        let add_tail = |form: &mut Motor, by_distance: f64, by_time: f64| {
            add(form, &joined_by, by_distance);
            add(form, &[0.0, 0.0, 1.0, 0.0], by_time);
        };
        if let Some(tail) = &full.outline.tail {
            add_tail(&mut common, tail.by_distance, tail.by_time);
        }
        let mut forms: Vec<Motor> = moments.iter().map(Moment::pull).collect();
        let mut of_solved = [0.0; 2];
        for (k, price) in of_solved.iter_mut().enumerate().take(all - free) {
            *price = full.gradient[free + k];
        }
        for (approach, multiplier) in full.outline.approaches.iter().zip(multipliers) {
            if *multiplier <= 0.0 {
                continue;
            }
            let [east, north, clock] = approach.rates;
            let legs = &sailed.legs[approach.leg];
            let last = match (sailed.place(approach.leg, approach.fraction), legs.owner) {
                (Some(place), _) => {
                    let at = place.position - origin;
                    let form = [east, north, clock, at.x * north - at.y * east];
                    for form_of_gap in forms.iter_mut().take(place.slot + 1) {
                        add(form_of_gap, &form, -multiplier);
                    }
                    place.slot
                }
                (None, Owner::Tail { index }) => {
                    let (by_distance, by_time) = scene.tail_rates(sailed, index, approach);
                    add_tail(
                        &mut common,
                        -multiplier * by_distance,
                        -multiplier * by_time,
                    );
                    all
                }
                (None, Owner::Slot { .. }) => continue,
            };
            if last >= free {
                let row = scene.approach_row(&full.outline, approach);
                for (k, price) in of_solved.iter_mut().enumerate().take(all - free) {
                    *price -= multiplier * row[free + k];
                }
            }
        }
        // rows after those of the approaches keep the solved slots from running out
        for (price, multiplier) in of_solved
            .iter_mut()
            .zip(&multipliers[full.outline.approaches.len()..])
        {
            *price -= multiplier;
        }
        let by = sailed.solved_by(template.ending, scene.problem, origin);
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

    /// The rate of the cost with the length of a slot put in before slot `gap`, m² per metre, and the second rate.
    fn rate(&self, scene: &Scene, full: &Full, gap: usize, slot: Slot) -> Option<(f64, f64)> {
        let leg = full.outline.sailed.legs.iter().find(
            |l| matches!(l.owner, Owner::Slot { index, from, .. } if index == gap && from == 0.0),
        )?;
        let at = leg.segment.start.position - self.origin;
        let slowness = 1.0 / slot.speed();
        let curvature = match slot {
            Slot::Arc { side, .. } => side.turn_sign() / scene.problem.own.turning_radius,
            _ => 0.0,
        };
        let motor = [
            leg.ahead.x + curvature * at.y,
            leg.ahead.y - curvature * at.x,
            slowness,
            curvature,
        ];
        let desired = scene.problem.desired;
        let start = leg.segment.start.position;
        let here = desired.nearest(start, leg.segment.start_time, scene.problem.time_weight);
        let own = slowness / desired.duration() * here.error;
        Some((
            dot4(&motor, &self.forms[gap]) + own,
            self.moments[gap].bend(&motor),
        ))
    }

    /// What the slot alone would gain, m², to second order; zero when its first metre costs.
    fn gain(&self, scene: &Scene, full: &Full, gap: usize, slot: Slot) -> f64 {
        let Some((rate, bend)) = self.rate(scene, full, gap, slot) else {
            return 0.0;
        };
        if rate < 0.0 {
            0.5 * rate * rate / bend.max(1e-9 * full.outline.cost.max(1.0))
        } else {
            0.0
        }
    }
}

fn add(form: &mut Motor, other: &Motor, weight: f64) {
    for (a, b) in form.iter_mut().zip(other) {
        *a += weight * b;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planner::space_time::refinement::model::tests::at_manoeuvres;

    /// Every price against the reduced gradient of the template that has the slot, empty.
    #[test]
    fn prices_are_the_rates_of_the_larger_template() {
        at_manoeuvres(|scene, seed| {
            let outline = scene.outline(&seed.template, &seed.lengths);
            let full = scene.full(&seed.template, outline.expect("fits"));
            let multipliers = multipliers(scene, seed).expect("solvable");
            let prices = Prices::new(scene, &seed.template, &full, &multipliers);
            assert!(multipliers.iter().any(|m| *m > 0.0));
            for gap in full.outline.sailed.runs..=seed.template.free() {
                for slot in kinds(scene) {
                    let mut larger = seed.clone();
                    larger.template.slots.insert(gap, slot);
                    larger.lengths[gap..].rotate_right(1);
                    larger.lengths[gap] = 0.0;
                    let model = scene.model(&larger.template, &larger.lengths);
                    let model = model.expect("an empty slot changes nothing");
                    let of_rows: f64 = model
                        .rows
                        .iter()
                        .zip(&multipliers)
                        .map(|(row, multiplier)| row.coefficients[gap] * multiplier)
                        .sum();
                    let expected = model.gradient[gap] - of_rows;
                    let (found, bend) = prices.rate(scene, &full, gap, slot).expect("a place");
                    assert!(
                        (found - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                        "{slot:?} before {gap}: {found} {expected}"
                    );
                    assert!(bend >= -1e-9 * (1.0 + found.abs()));
                }
            }
        });
    }

    #[test]
    fn a_cut_manoeuvre_is_the_same_manoeuvre() {
        at_manoeuvres(|scene, seed| {
            let whole = scene.model(&seed.template, &seed.lengths).expect("fits");
            let parts = cut(scene, seed, 30.0).expect("room for parts");
            assert!(parts.template.free() > 0);
            let again = scene.model(&parts.template, &parts.lengths).expect("fits");
            assert!((whole.cost - again.cost).abs() < 1e-6 * whole.cost);
        });
    }
}
