//! Multilevel splitting: the probability of a rare event of a random process.
//!
//! An event that is rare is reached by way of levels, each of which is not rare on the way from the
//! one before. In each replica the same number of trajectories begins at every level, from copies
//! of the states in which the level before was reached, and the product of the fractions that go on
//! is an unbiased estimate for any levels that were fixed beforehand (fixed effort).
//! M. J. J. Garvels, "The splitting method in rare event simulation", 2000; P. Del Moral,
//! "Feynman-Kac Formulae", 2004, section 12.2.

use std::sync::atomic::{AtomicBool, Ordering};

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::bounds::{clopper_pearson, mean_interval};
use crate::parallel::map;

/// Most levels of a pilot run.
const MOST_LEVELS: usize = 64;

/// A random process that can be split.
pub(super) trait Process: Clone + Send + Sync {
    /// Replaces the generators of all later random numbers.
    fn reseed(&mut self, seed: u64);

    /// Goes on by one step; returns its cost, such as simulated seconds.
    fn step(&mut self) -> f64;

    /// Distance from the event, in any measure that falls as the event becomes more likely. The event
    /// is at zero and below, and at a NaN. Every measure gives an unbiased estimate; a good one, a
    /// narrow interval.
    fn distance(&self) -> f64;

    /// True where it does not go on.
    fn is_over(&self) -> bool;
}

/// How much work is done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Trajectories that begin at each level.
    pub trajectories: usize,
    /// Independent estimates.
    pub replicas: usize,
    /// Fraction of the trajectories of the pilot run that reach the next level.
    pub fraction: f64,
}

/// A probability as it was estimated.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Estimate {
    /// Mean of the replicas.
    pub probability: f64,
    /// Interval from the replicas.
    pub interval: [f64; 2],
    /// Standard error of the mean.
    pub standard_error: f64,
    /// The estimate of each replica.
    pub replicas: Vec<f64>,
    /// Each level, zero last, with the fraction of all trajectories that reach it from the one
    /// before; no fraction where none began.
    pub levels: Vec<(f64, Option<f64>)>,
    /// Cost of the pilot run, and of the replicas.
    pub cost: [f64; 2],
    /// Mean cost of a trajectory from the beginning to its end.
    pub whole_cost: f64,
}

/// Seeds by what they are for: the same on any number of threads.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seeds {
    /// Seed of all.
    pub seed: u64,
    /// Which estimate of this seed.
    pub stream: u32,
}

impl Seeds {
    /// The generator of a trajectory; replica 0 is the pilot run, trajectory 0 is none.
    fn rng(self, replica: usize, level: usize, trajectory: usize) -> ChaCha8Rng {
        let mut key = *b"splitting             of levels.";
        key[10..18].copy_from_slice(&self.seed.to_le_bytes());
        key[18..22].copy_from_slice(&self.stream.to_le_bytes());
        let mut rng = ChaCha8Rng::from_seed(key);
        // each number has its own bits
        let stream = (replica as u64) << 40 | (level as u64) << 32 | trajectory as u64;
        rng.set_stream(stream);
        rng
    }
}

/// A trajectory that ended, or reached its level.
struct Went<P> {
    process: P,
    reached: bool,
    /// The least distance from the event.
    least: f64,
    cost: f64,
}

/// Goes on until the event is no farther than `level`, or to the end; `None` once `stop` is set.
fn follow<P: Process>(mut process: P, level: f64, stop: &AtomicBool) -> Option<Went<P>> {
    let (mut cost, mut least) = (0.0, f64::INFINITY);
    while !stop.load(Ordering::Relaxed) {
        let distance = process.distance();
        // negated so that a NaN is the event
        if !(distance > 0.0) {
            least = 0.0;
        }
        least = least.min(distance);
        let reached = least <= level;
        if reached || process.is_over() {
            return Some(Went {
                process,
                reached,
                least,
                cost,
            });
        }
        cost += process.step();
    }
    None
}

/// One run by way of levels: where its trajectories begin at each of them.
struct Stage<'a, P, N> {
    /// A process at its beginning.
    new: &'a N,
    seeds: Seeds,
    replica: usize,
    trajectories: usize,
    stop: &'a AtomicBool,
    /// The states in which the last level was reached; none before the first.
    reached: Vec<P>,
}

impl<P: Process, N: Fn(u64) -> P + Sync> Stage<'_, P, N> {
    /// All trajectories that begin at a level and go on to `next`; `None` once `stop` is set.
    fn go(&self, level: usize, next: f64) -> Option<Vec<Went<P>>> {
        // copies are spread evenly; the offset makes each state's number of them unbiased
        let offset: f64 = self.seeds.rng(self.replica, level, 0).random();
        let share = self.reached.len() as f64 / self.trajectories as f64;
        let numbers: Vec<usize> = (0..self.trajectories).collect();
        let went = map(&numbers, |_, number| {
            if self.stop.load(Ordering::Relaxed) {
                return None;
            }
            let mut rng = self.seeds.rng(self.replica, level, number + 1);
            let seed = rng.random::<u64>() >> 12;
            if level == 0 {
                return follow((self.new)(seed), next, self.stop);
            }
            let from = ((*number as f64 + offset) * share) as usize;
            let mut process = self.reached[from.min(self.reached.len() - 1)].clone();
            process.reseed(seed);
            follow(process, next, self.stop)
        });
        went.into_iter().collect()
    }

    /// The product of the fractions that go on from level to level. Adds to the counts of each, and
    /// to the cost. `None` once `stop` is set.
    fn estimate(mut self, levels: &[f64], hits: &mut [[u64; 2]], cost: &mut f64) -> Option<f64> {
        let mut product = 1.0;
        for (index, (level, hits)) in levels.iter().zip(hits).enumerate() {
            let went = self.go(index, *level)?;
            *cost += went.iter().map(|w| w.cost).sum::<f64>();
            self.reached = reached(went);
            let count = self.reached.len();
            hits[0] += count as u64;
            hits[1] += self.trajectories as u64;
            product *= count as f64 / self.trajectories as f64;
            if count == 0 {
                break;
            }
        }
        Some(product)
    }
}

/// Estimates the probability that a process reaches its event. `new` makes one from a seed; `tick`
/// is called after the pilot run and after each replica. Where `stop` is set, the estimate is that of
/// the replicas that had ended, and `None` with fewer than two.
///
/// A pilot run of as many trajectories fixes the levels: each is what a given fraction reaches. Its
/// trajectories count for nothing else. O(replicas × levels × trajectories), on all cores.
pub(super) fn estimate<P: Process>(
    new: &(impl Fn(u64) -> P + Sync),
    seeds: Seeds,
    effort: &Effort,
    confidence: f64,
    stop: &AtomicBool,
    tick: &dyn Fn(),
) -> Option<Estimate> {
    let stage = |replica| Stage {
        new,
        seeds,
        replica,
        trajectories: effort.trajectories,
        stop,
        reached: Vec::new(),
    };
    let (mut levels, mut cost, mut whole_cost) = (Vec::new(), [0.0; 2], 0.0);
    let mut pilot = stage(0);
    let mut last = f64::INFINITY;
    while levels.len() < MOST_LEVELS {
        let went = pilot.go(levels.len(), 0.0)?;
        let sum: f64 = went.iter().map(|w| w.cost).sum();
        cost[0] += sum;
        if levels.is_empty() {
            whole_cost = sum / effort.trajectories as f64;
        }
        let mut least: Vec<f64> = went.iter().map(|w| w.least).collect();
        least.sort_by(f64::total_cmp);
        let index = (effort.fraction * effort.trajectories as f64).ceil() as usize;
        let next = least[index.clamp(1, least.len()) - 1];
        // no copy comes nearer than the states it began from: nothing is random any more
        if !(next > 0.0 && next < last) {
            break;
        }
        let again = pilot.go(levels.len(), next)?;
        cost[0] += again.iter().map(|w| w.cost).sum::<f64>();
        pilot.reached = reached(again);
        levels.push(next);
        last = next;
    }
    levels.push(0.0);
    tick();
    let mut hits = vec![[0_u64; 2]; levels.len()];
    let mut replicas = Vec::with_capacity(effort.replicas);
    for replica in 1..=effort.replicas {
        let mut own = hits.clone();
        let Some(found) = stage(replica).estimate(&levels, &mut own, &mut cost[1]) else {
            break;
        };
        hits = own;
        replicas.push(found);
        tick();
    }
    if replicas.len() < 2 {
        return None;
    }
    let (probability, standard_error, mut interval) = mean_interval(&replicas, confidence);
    let of_first_level = clopper_pearson(hits[0][0], hits[0][1], confidence);
    if levels.len() == 1 {
        interval = of_first_level;
    } else if probability == 0.0 {
        // whatever reaches the event reaches the first level
        interval = [0.0, of_first_level[1]];
    }
    let fraction = |[hits, of]: &[u64; 2]| (*of > 0).then(|| *hits as f64 / *of as f64);
    Some(Estimate {
        probability,
        interval,
        standard_error,
        replicas,
        levels: levels.into_iter().zip(hits.iter().map(fraction)).collect(),
        cost,
        whole_cost,
    })
}

/// The states of those that reached their level.
fn reached<P>(went: Vec<Went<P>>) -> Vec<P> {
    let reached = went.into_iter().filter(|w| w.reached);
    reached.map(|w| w.process).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicUsize;

    use super::*;

    /// A walk by ±1, whose event is a height within 100 steps.
    #[derive(Clone)]
    struct Walk {
        height: i32,
        steps: usize,
        event: i32,
        rng: ChaCha8Rng,
        /// Random bits that are left, below a one.
        bits: u64,
    }

    const STEPS: usize = 100;

    impl Walk {
        fn begin(event: i32) -> impl Fn(u64) -> Self + Sync {
            move |seed| Self {
                height: 0,
                steps: 0,
                event,
                rng: ChaCha8Rng::seed_from_u64(seed),
                bits: 1,
            }
        }

        /// `P(max ≥ b) = P(S ≥ b) + P(S > b)` by reflection; W. Feller, "An Introduction to
        /// Probability Theory and Its Applications", volume 1, 1968, section III.7.
        fn exact(event: i32) -> f64 {
            let above = |b: usize| {
                let mut sum = 0.0;
                // of k steps up, S = 2 k - STEPS
                for k in (STEPS + b).div_ceil(2)..=STEPS {
                    let factors = (0..STEPS - k).map(|i| (STEPS - i) as f64 / (i + 1) as f64);
                    sum += factors.product::<f64>() * 0.5_f64.powi(STEPS as i32);
                }
                sum
            };
            above(event as usize) + above(event as usize + 1)
        }
    }

    impl Process for Walk {
        fn reseed(&mut self, seed: u64) {
            (self.rng, self.bits) = (ChaCha8Rng::seed_from_u64(seed), 1);
        }

        fn step(&mut self) -> f64 {
            if self.bits == 1 {
                self.bits = self.rng.random::<u64>() | 1 << 63;
            }
            self.height += if self.bits & 1 == 1 { 1 } else { -1 };
            self.bits >>= 1;
            self.steps += 1;
            1.0
        }

        fn distance(&self) -> f64 {
            f64::from(self.event - self.height)
        }

        fn is_over(&self) -> bool {
            self.steps >= STEPS
        }
    }

    const EFFORT: Effort = Effort {
        trajectories: 500,
        replicas: 20,
        fraction: 0.2,
    };

    fn of_walk(event: i32, seed: u64) -> Estimate {
        let seeds = Seeds { seed, stream: 0 };
        let go_on = AtomicBool::new(false);
        let found = estimate(&Walk::begin(event), seeds, &EFFORT, 0.95, &go_on, &|| ());
        found.expect("not stopped")
    }

    /// Six seeds: an interval of 95 % is missed by more than one of them once in 30 times.
    #[test]
    fn one_in_a_million_is_estimated_within_the_stated_confidence() {
        let (event, seeds) = (48, 6);
        let exact = Walk::exact(event);
        assert!((1e-6..2e-6).contains(&exact), "{exact}");
        let (mut held, mut sum) = (0, 0.0);
        for seed in 0..seeds {
            let found = of_walk(event, seed);
            let [low, high] = found.interval;
            held += u64::from((low..=high).contains(&exact));
            sum += found.probability;
        }
        let ratio = sum / (seeds as f64 * exact);
        println!("{held} of {seeds} intervals hold {exact:.3e}; mean {ratio:.3} of it");
        assert!(held >= seeds - 1, "{held}");
        assert!((ratio - 1.0).abs() < 0.2, "{ratio}");
    }

    #[test]
    fn one_in_ten_thousand_costs_a_tenth_of_plain_trajectories() {
        let exact = Walk::exact(38);
        assert!((1e-4..3e-4).contains(&exact), "{exact}");
        let found = of_walk(38, 1);
        // plain trajectories for the same standard error, which go on until the event
        let plain = exact * (1.0 - exact) / found.standard_error.powi(2);
        let ratio = plain * found.whole_cost / (found.cost[0] + found.cost[1]);
        let (estimate, [low, high]) = (found.probability, found.interval);
        println!("{exact:.3e}: {estimate:.3e}, {low:.2e} to {high:.2e}; {ratio:.0} times cheaper");
        assert!(ratio > 10.0, "{ratio}");
    }

    /// Ended in the middle of a replica, an estimate is that of the replicas before.
    #[test]
    fn a_stopped_estimate_has_the_replicas_that_had_ended() {
        let seeds = Seeds { seed: 1, stream: 0 };
        let of = |replicas: usize, last: usize| {
            let (stop, ticks) = (AtomicBool::new(false), AtomicUsize::new(0));
            let effort = Effort { replicas, ..EFFORT };
            // the first tick is that of the pilot run
            let tick = || {
                let ended = ticks.fetch_add(1, Ordering::Relaxed);
                stop.store(ended >= last, Ordering::Relaxed);
            };
            estimate(&Walk::begin(30), seeds, &effort, 0.95, &stop, &tick)
        };
        let stopped = of(20, 3).expect("three replicas");
        assert_eq!(stopped.replicas.len(), 3);
        assert_eq!(Some(stopped), of(3, 20));
        assert_eq!((of(20, 1), of(20, 0)), (None, None));
    }

    #[test]
    fn an_event_that_never_or_always_happens_is_said_to() {
        let never = of_walk(STEPS as i32 + 1, 1);
        assert_eq!(never.probability, 0.0);
        assert!(never.interval[0] == 0.0 && never.interval[1] < 0.5);
        let always = of_walk(0, 1);
        assert_eq!((always.probability, always.interval[1]), (1.0, 1.0));
        assert!((0.9..1.0).contains(&always.interval[0]));
        assert_eq!(
            (always.levels, always.cost),
            (vec![(0.0, Some(1.0))], [0.0; 2])
        );
    }
}
