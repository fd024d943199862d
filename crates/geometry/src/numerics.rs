//! Quadrature rules and one-dimensional search.

/// Nodes and weights of the 2-point Gauss-Legendre rule on [0, 1]: exact for cubics.
pub const GAUSS_2: [(f64, f64); 2] = [
    (0.211_324_865_405_187_13, 0.5),
    (0.788_675_134_594_812_9, 0.5),
];

/// Nodes and weights of the 3-point Gauss-Legendre rule on [0, 1]: exact up to degree 5.
pub const GAUSS_3: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 0.277_777_777_777_777_8),
    (0.5, 0.444_444_444_444_444_4),
    (0.887_298_334_620_741_7, 0.277_777_777_777_777_8),
];

/// Nodes and weights of the 4-point Gauss-Legendre rule on [0, 1]: exact up to degree 7.
pub const GAUSS_4: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Golden-section search for a minimum in a bracket.
///
/// Each step shortens the bracket by the golden ratio and evaluates the function once.
#[derive(Debug, Clone, Copy)]
pub struct GoldenSection {
    low: f64,
    high: f64,
    /// The lower inner point with its value.
    pub left: (f64, f64),
    /// The upper inner point with its value.
    pub right: (f64, f64),
}

impl GoldenSection {
    /// Evaluates the function at the two inner points of the bracket.
    pub fn new(low: f64, high: f64, function: impl Fn(f64) -> f64) -> Self {
        let golden = golden_ratio();
        let at = |x: f64| (x, function(x));
        Self {
            low,
            high,
            left: at(high - golden * (high - low)),
            right: at(low + golden * (high - low)),
        }
    }

    /// Keeps the part of the bracket around the smaller value.
    pub fn shorten(&mut self, function: impl Fn(f64) -> f64) {
        let golden = golden_ratio();
        if self.left.1 < self.right.1 {
            self.high = self.right.0;
            self.right = self.left;
            let x = self.high - golden * (self.high - self.low);
            self.left = (x, function(x));
        } else {
            self.low = self.left.0;
            self.left = self.right;
            let x = self.low + golden * (self.high - self.low);
            self.right = (x, function(x));
        }
    }
}

fn golden_ratio() -> f64 {
    0.5 * (5.0_f64.sqrt() - 1.0)
}

/// Bisects `steps` times between a place where a condition holds and one where it does not.
///
/// Returns the last place of each kind, in that order.
pub fn bisected(
    [mut holds, mut fails]: [f64; 2],
    steps: usize,
    condition: impl Fn(f64) -> bool,
) -> [f64; 2] {
    for _ in 0..steps {
        let middle = 0.5 * (holds + fails);
        if condition(middle) {
            holds = middle;
        } else {
            fails = middle;
        }
    }
    [holds, fails]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_polynomials_up_to_their_degree() {
        let rules: [(&[(f64, f64)], i32); 3] = [(&GAUSS_2, 3), (&GAUSS_3, 5), (&GAUSS_4, 7)];
        for (rule, degree) in rules {
            for power in 0..=degree {
                let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(power)).sum();
                assert!((sum - 1.0 / f64::from(power + 1)).abs() < 1e-15, "{power}");
            }
        }
    }

    #[test]
    fn bisection_finds_where_a_condition_ends() {
        let [holds, fails] = bisected([4.0, 1.0], 50, |x| x * x > 2.0);
        assert!(holds * holds > 2.0 && fails * fails <= 2.0 && holds - fails < 1e-14);
    }

    #[test]
    fn golden_section_finds_a_minimum() {
        let function = |x: f64| (x - 0.3).powi(2);
        let mut search = GoldenSection::new(-1.0, 2.0, function);
        for _ in 0..40 {
            search.shorten(function);
        }
        assert!((search.left.0 - 0.3).abs() < 1e-7, "{search:?}");
    }
}
