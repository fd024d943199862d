//! Certified least value of a function of time, by branch and bound.

use searoom_geometry::tolerance;

/// Most probes spent on one function.
const MAX_PROBES: usize = 200_000;

/// Value and lower bound of a function near an instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Probe {
    /// Value at the instant.
    pub value: f64,
    /// Lower bound of the values within the half-width of the probe.
    pub lower: f64,
}

/// Least value found so far of a distance or a depth, metres. A NaN counts as a collision, and a value
/// that is not certified is no lower bound.
#[derive(Debug, Clone, Copy)]
pub struct Least {
    /// Metres. NaN if any value was NaN.
    pub value: f64,
    /// Time of the least value, seconds.
    pub time: f64,
    /// False when the probes ran out before the bound was proven.
    pub certified: bool,
    /// Probes spent.
    pub probes: usize,
}

impl Probe {
    /// A value, and the lower bound around it.
    pub fn new(value: f64, lower: f64) -> Self {
        Self { value, lower }
    }

    /// Probe of a value that is nowhere below `lower`, if that exceeds the `known` least value by
    /// more than rounding.
    pub fn beyond(known: f64, lower: f64) -> Option<Self> {
        let value = f64::INFINITY;
        (lower > known + tolerance::DEPTH_M + tolerance::LIMIT * lower.abs())
            .then_some(Self { value, lower })
    }
}

impl Least {
    /// Initial state without any value.
    pub(crate) fn new() -> Self {
        Self {
            value: f64::INFINITY,
            time: 0.0,
            certified: true,
            probes: 0,
        }
    }

    /// Updates the least value with one more value.
    pub fn see(&mut self, value: f64, time: f64) {
        // Negated on purpose: a NaN replaces the value and remains.
        if !(value >= self.value) && !self.value.is_nan() {
            self.value = value;
            self.time = time;
        }
    }

    /// Searches an interval by bisection until a lower bound proves every part.
    ///
    /// A part is proven if its bound is at most [`tolerance::MARGIN_M`] below the best value. For a
    /// part shorter than [`tolerance::INSTANT_S`] the limit is half of [`tolerance::DEPTH_M`].
    /// `probe(time, half, known)` returns the value at `time` and a lower bound on
    /// `[time - half, time + half]`. Where the bound exceeds `known`, the least value so far, the
    /// value may be infinite.
    pub(crate) fn search(&mut self, from: f64, until: f64, probe: impl Fn(f64, f64, f64) -> Probe) {
        let mut open = vec![(from, until)];
        while let Some((from, until)) = open.pop() {
            if self.probes >= MAX_PROBES {
                self.certified = false;
                return;
            }
            self.probes += 1;
            let (middle, half) = (0.5 * (from + until), 0.5 * (until - from));
            let found = probe(middle, half, self.value);
            self.see(found.value, middle);
            if self.value.is_nan() {
                return;
            }
            // An error within such a short time is below the depth tolerance, for slow and for fast
            // ships.
            let close = 2.0 * half <= tolerance::INSTANT_S;
            let open_m = if close {
                0.5 * tolerance::DEPTH_M
            } else {
                tolerance::MARGIN_M
            };
            // Negated on purpose: a NaN bound certifies nothing.
            if !(found.lower >= self.value - open_m) {
                if !(from < middle && middle < until) {
                    self.certified = false;
                    return;
                }
                open.push((middle, until));
                open.push((from, middle));
            }
        }
    }
}
