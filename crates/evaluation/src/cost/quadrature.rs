//! Integrals of piecewise smooth functions of one variable.

use searoom_geometry::tolerance;

/// Positive nodes and weights of the 12-point Gauss-Legendre rule on `[-1, 1]`: exact for
/// polynomials up to degree 23.
const GAUSS_LEGENDRE: [(f64, f64); 6] = [
    (0.125_233_408_511_468_9, 0.249_147_045_813_402_77),
    (0.367_831_498_998_180_2, 0.233_492_536_538_354_8),
    (0.587_317_954_286_617_5, 0.203_167_426_723_065_92),
    (0.769_902_674_194_304_7, 0.160_078_328_543_346_22),
    (0.904_117_256_370_474_9, 0.106_939_325_995_318_43),
    (0.981_560_634_246_719_2, 0.047_175_336_386_511_83),
];

/// Positive nodes and weights of the 12-point Gauss-Lobatto rule. It samples the ends of the
/// interval, and so detects a kink beyond the outermost Gauss-Legendre node.
const GAUSS_LOBATTO: [(f64, f64); 6] = [
    (0.136_552_932_854_927_56, 0.271_405_240_910_696_2),
    (0.399_530_940_965_348_9, 0.251_275_603_199_201_3),
    (0.632_876_153_031_860_7, 0.212_508_417_761_021_14),
    (0.819_279_321_644_006_6, 0.157_974_705_564_370_13),
    (0.944_899_272_222_882_2, 0.091_684_517_413_196_14),
    (1.0, 0.015_151_515_151_515_152),
];

/// Most halvings of one interval.
const MAX_DEPTH: u32 = 32;

/// Most intervals of one integral.
const MAX_INTERVALS: usize = 20_000;

/// Integral below which the tolerance is no smaller, m² s. On the desired trajectory the integrand
/// is rounding, which no interval is short enough for.
const LEAST_SIZE: f64 = 1.0;

/// Integrates a smooth function by one Gauss-Legendre rule.
pub(crate) fn smooth(from: f64, until: f64, f: &impl Fn(f64) -> f64) -> f64 {
    rule(&GAUSS_LEGENDRE, from, until, f)
}

fn rule(rule: &[(f64, f64)], from: f64, until: f64, f: &impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (from + until), 0.5 * (until - from));
    let sum: f64 = rule
        .iter()
        .map(|&(x, w)| w * (f(middle - half * x) + f(middle + half * x)))
        .sum();
    half * sum
}

/// Integrates a function that is smooth except for kinks, over the intervals between sorted
/// `joints`.
///
/// Adaptive bisection: an interval is halved until the two rules agree, and one rule agrees with
/// its two halves. The tolerance is [`tolerance::QUADRATURE`] of the whole integral or of `least`,
/// the larger of the two, and of [`LEAST_SIZE`]; `least` is the size of the sum to which the
/// integral is added. NaN where the function is NaN.
pub(crate) fn adaptive(joints: &[f64], least: f64, f: &impl Fn(f64) -> f64) -> f64 {
    let mut open: Vec<(f64, f64, f64, u32)> = joints
        .windows(2)
        .map(|w| (w[0], w[1], smooth(w[0], w[1], f), 0))
        .collect();
    let size: f64 = open.iter().map(|piece| piece.2.abs()).sum();
    let span: f64 = open.iter().map(|piece| piece.1 - piece.0).sum();
    let allowed = tolerance::QUADRATURE * size.max(least).max(LEAST_SIZE);
    let mut total = 0.0;
    let mut done = 0;
    while let Some((from, until, whole, depth)) = open.pop() {
        let middle = 0.5 * (from + until);
        let (left, right) = (smooth(from, middle, f), smooth(middle, until, f));
        let closed = rule(&GAUSS_LOBATTO, from, until, f);
        let error = (left + right - whole).abs().max((closed - whole).abs());
        done += 1;
        // A NaN error is not halved.
        if error > allowed * (until - from) / span && depth < MAX_DEPTH && done < MAX_INTERVALS {
            open.push((from, middle, left, depth + 1));
            open.push((middle, until, right, depth + 1));
        } else {
            total += left + right;
        }
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_is_exact_for_degree_23() {
        for degree in 0..24 {
            let exact = 3.0_f64.powi(degree + 1) / f64::from(degree + 1);
            let found = smooth(0.0, 3.0, &|x| x.powi(degree));
            assert!((found - exact).abs() <= 1e-13 * exact, "{degree}");
        }
    }

    #[test]
    fn kinks_are_found() {
        let found = adaptive(&[0.0, 1.0, 7.0], 0.0, &|x| (x - std::f64::consts::PI).abs());
        let (a, b) = (std::f64::consts::PI, 7.0 - std::f64::consts::PI);
        let exact = 0.5 * (a * a + b * b);
        assert!((found - exact).abs() < 1e-9 * exact, "{found} {exact}");
        // The kink is so near the end that the open rule and both of its halves miss it.
        let found = adaptive(&[0.0, 1.0], 0.0, &|x| 1.0 + (x - 0.999).max(0.0));
        assert!((found - 1.0 - 0.5e-6).abs() < 1e-10, "{found}");
        assert_eq!(adaptive(&[0.0, 5.0], 0.0, &|_| 0.0), 0.0);
        assert!(adaptive(&[0.0, 5.0], 0.0, &|_| f64::NAN).is_nan());
    }

    #[test]
    fn rounding_is_not_searched_for_kinks() {
        let calls = std::cell::Cell::new(0);
        // a tenth of a micrometre off a path 10 km from the origin
        let squared = |x: f64| {
            calls.set(calls.get() + 1);
            let off = (1e4 + 1e-7 * (1.0 + 1e-3 * (1e9 * x).sin())) - 1e4;
            off * off
        };
        let found = adaptive(&[0.0, 500.0], 0.0, &squared);
        assert!(
            (found - 5e-12).abs() < 1e-13 && calls.get() < 100,
            "{found} {calls:?}"
        );
    }
}
