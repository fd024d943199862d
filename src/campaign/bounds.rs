//! Bounds on a probability from counts.

use statrs::distribution::{ContinuousCDF, StudentsT};
use statrs::function::beta::{beta_reg, ln_beta};

/// Steps of a bisection: more than a double has bits.
const STEPS: usize = 80;

/// Clopper-Pearson interval of the probability of an event seen in `count` of `trials`, a number
/// that was fixed beforehand. Quantiles of beta distributions, by bisection: `inv_beta_reg` of
/// statrs 0.19 need not end. C. J. Clopper and E. S. Pearson, 1934, doi:10.1093/biomet/26.4.404.
pub fn clopper_pearson(count: u64, trials: u64, confidence: f64) -> [f64; 2] {
    let (k, n) = (count.min(trials) as f64, trials as f64);
    let half = (1.0 - confidence) / 2.0;
    let quantile = |a: f64, b: f64, p: f64| edge(0.0, 1.0, |x| beta_reg(a, b, x) < p);
    // an event that was never seen, or always, has one bound
    let low = if count > 0 {
        quantile(k, n - k + 1.0, half)
    } else {
        0.0
    };
    let high = if count < trials {
        quantile(k + 1.0, n - k, 1.0 - half)
    } else {
        1.0
    };
    [low, high]
}

/// Where `is_in` ends between a number for which it holds and one for which it does not.
fn edge(mut inside: f64, mut outside: f64, is_in: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..STEPS {
        let middle = f64::midpoint(inside, outside);
        if is_in(middle) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    outside
}

/// Confidence sequence for the probability of an event: with the given confidence it holds at
/// every number of trials at once, so that a run may be watched and stopped at any time.
///
/// It has the probabilities `p` at which the likelihood, mixed over a Beta(½, ½) distribution, is
/// less than `1 / (1 - confidence)` times that of `p`. The ratio is a martingale under `p`, which
/// by Ville's inequality exceeds this with at most that probability. H. Robbins, 1970,
/// doi:10.1214/aoms/1177696786; S. R. Howard et al., 2021, doi:10.1214/20-AOS1991. Bisection.
pub fn anytime(count: u64, trials: u64, confidence: f64) -> [f64; 2] {
    let (k, n) = (count.min(trials) as f64, trials as f64);
    if trials == 0 {
        return [0.0, 1.0];
    }
    let mixed = ln_beta(k + 0.5, n - k + 0.5) - ln_beta(0.5, 0.5);
    let times_ln = |times: f64, x: f64| if times == 0.0 { 0.0 } else { times * x };
    let log_ratio = |p: f64| mixed - times_ln(k, p.ln()) - times_ln(n - k, (-p).ln_1p());
    let is_in = |p: f64| log_ratio(p) < -(1.0 - confidence).ln();
    let low = if count > 0 {
        edge(k / n, 0.0, is_in)
    } else {
        0.0
    };
    let high = if count < trials {
        edge(k / n, 1.0, is_in)
    } else {
        1.0
    };
    [low, high]
}

/// Mean of independent estimates, its standard error, and its interval by Student's t
/// distribution.
///
/// The interval is that of the logarithm of the mean (delta method): never below zero, and wider
/// above. It assumes that the mean is about normal. From 0 to 1 for fewer than two estimates.
pub(super) fn mean_interval(estimates: &[f64], confidence: f64) -> (f64, f64, [f64; 2]) {
    let n = estimates.len() as f64;
    let mean = estimates.iter().sum::<f64>() / n;
    let squares = estimates.iter().map(|x| (x - mean).powi(2));
    let error = (squares.sum::<f64>() / (n - 1.0) / n).sqrt();
    let Ok(student) = StudentsT::new(0.0, 1.0, n - 1.0) else {
        return (mean, f64::INFINITY, [0.0, 1.0]);
    };
    let level = f64::midpoint(1.0, confidence);
    // the quantile of statrs rests on `inv_beta_reg`, too
    let quantile = edge(0.0, 1e6, |x| student.cdf(x) < level);
    let factor = (quantile * error / mean).exp();
    (mean, error, [mean / factor, (mean * factor).min(1.0)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 1e-7, "{found} {expected}");
    }

    /// Probability of at most `k` events in `n` trials, its terms in logarithms.
    fn at_most(k: u64, n: u64, p: f64) -> f64 {
        let mut log_term = n as f64 * (-p).ln_1p();
        let mut sum = log_term.exp();
        for i in 0..k {
            log_term += ((n - i) as f64 / (i + 1) as f64).ln() + p.ln() - (-p).ln_1p();
            sum += log_term.exp();
        }
        sum
    }

    #[test]
    fn exact_bounds_are_those_of_the_binomial_distribution() {
        let cases = [
            (1, 10),
            (3, 299),
            (17, 10_000),
            (1, 100_000),
            (2, 1_000_000),
            (300, 1_000_000),
            (10, 10_000_000),
        ];
        for (count, trials) in cases {
            let [low, high] = clopper_pearson(count, trials, 0.95);
            let (above, below) = (
                at_most(count, trials, high),
                at_most(count - 1, trials, low),
            );
            assert!((above - 0.025).abs() < 1e-7, "{count}/{trials} {above}");
            assert!((below - 0.975).abs() < 1e-7, "{count}/{trials} {below}");
        }
    }

    #[test]
    fn exact_bounds_of_none_and_of_all_have_closed_forms() {
        for trials in [1, 30, 299, 100_000] {
            let [low, high] = clopper_pearson(0, trials, 0.95);
            assert_eq!(low, 0.0);
            near(high, 1.0 - 0.025_f64.powf(1.0 / trials as f64));
            let [low, high] = clopper_pearson(trials, trials, 0.95);
            near(low, 0.025_f64.powf(1.0 / trials as f64));
            assert_eq!(high, 1.0);
        }
        assert_eq!(clopper_pearson(0, 0, 0.95), [0.0, 1.0]);
    }

    /// Without an event the mixture is `∏ (2 i - 1) / (2 i)`.
    #[test]
    fn the_bound_at_all_times_of_none_has_a_closed_form() {
        for trials in [1_u64, 30, 299, 100_000] {
            let mixed = (1..=trials).map(|i| (2.0 * i as f64 - 1.0) / (2.0 * i as f64));
            let log_mixed: f64 = mixed.map(f64::ln).sum();
            let [low, high] = anytime(0, trials, 0.95);
            assert_eq!(low, 0.0);
            let expected = -((0.05_f64.ln() + log_mixed) / trials as f64).exp_m1();
            assert!((high / expected - 1.0).abs() < 1e-6, "{high} {expected}");
            let mirrored = anytime(trials, trials, 0.95);
            assert!((mirrored[0] - (1.0 - high)).abs() < 1e-9 && mirrored[1] == 1.0);
        }
        assert_eq!(anytime(0, 0, 0.95), [0.0, 1.0]);
    }

    /// Quantile of a table: 2.776 for four degrees of freedom.
    #[test]
    fn the_interval_of_a_mean_is_that_of_students_distribution() {
        let (mean, error, [low, high]) = mean_interval(&[0.1, 0.2, 0.3, 0.4, 0.5], 0.95);
        near(mean, 0.3);
        near(error, (0.025_f64 / 5.0).sqrt());
        let factor = (2.776_445_105_2 * error / mean).exp();
        near(high, (mean * factor).min(1.0));
        near(low, mean / factor);
        assert_eq!(mean_interval(&[0.5], 0.95).2, [0.0, 1.0]);
    }

    /// 400 runs of up to 500 trials, watched after each: at most one in 20 may leave the interval,
    /// while the exact interval is left by many.
    #[test]
    fn the_bound_at_all_times_holds_when_a_run_is_watched() {
        use rand::{Rng, SeedableRng};
        let p = 0.03;
        let (mut left, mut left_exact) = (0, 0);
        for seed in 0..400 {
            let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
            let mut count = 0;
            let outside = |[low, high]: [f64; 2]| !(low..=high).contains(&p);
            let (mut is_left, mut is_left_exact) = (false, false);
            for trials in 1..=500 {
                count += u64::from(rng.random_bool(p));
                is_left |= outside(anytime(count, trials, 0.95));
                is_left_exact |= outside(clopper_pearson(count, trials, 0.95));
            }
            left += usize::from(is_left);
            left_exact += usize::from(is_left_exact);
        }
        assert!(left <= 20 && left_exact > 40, "{left} {left_exact}");
    }
}
