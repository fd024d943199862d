//! Quantiles, and bounds on a proportion.

use searoom::campaign::clopper_pearson;

/// The value below which the fraction `p` of the values lies; NaN without values.
pub fn quantile(values: &[f64], p: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().saturating_sub(1);
    sorted
        .get((p * last as f64).ceil() as usize)
        .copied()
        .unwrap_or(f64::NAN)
}

/// Quantiles with the given decimals, between strokes.
pub fn quantiles<const N: usize>(values: &[f64], at: [f64; N], decimals: usize) -> String {
    at.map(|p| format!("{:.decimals$}", quantile(values, p)))
        .join("/")
}

/// How many of all, and the 95 % lower bound of their share in percent, as cells of a table.
pub fn share_cells(count: usize, all: usize) -> String {
    let bound = 100.0 * (1.0 - failure_bound(all - count, all));
    format!("{count}/{all} | {bound:.2} %")
}

/// Median, 95th percentile and maximum in words.
pub fn spread(values: &[f64]) -> String {
    let [half, most, worst] = [0.5, 0.95, 1.0].map(|p| quantile(values, p));
    format!("median {half:.2}, 95 % {most:.2}, worst {worst:.2}")
}

/// Clopper–Pearson, one-sided, 95 %: the largest failure probability at which `failures` or fewer
/// in `trials` still has a chance of 5 %.
pub fn failure_bound(failures: usize, trials: usize) -> f64 {
    clopper_pearson(failures as u64, trials as u64, 0.9)[1]
}

#[test]
fn bounds_match_published_values() {
    // docs/reference/colregs.md section 4.1
    for (failures, trials, bound) in [
        (0, 299, 9.97e-3),
        (0, 10_000, 3.0e-4),
        (1, 10_000, 4.74e-4),
        (3, 10_000, 7.75e-4),
    ] {
        let found = failure_bound(failures, trials);
        assert!((found / bound - 1.0).abs() < 5e-3, "{found} {bound}");
    }
    assert_eq!(failure_bound(5, 5), 1.0);
    assert!((quantile(&[3.0, 1.0, 2.0], 0.5) - 2.0).abs() < 1e-12);
}
