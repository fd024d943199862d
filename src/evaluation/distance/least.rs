//! The certified least value of a function of time, by branch and bound.

use crate::tolerance;

/// Probes spent on one function before the search gives up.
const MAX_PROBES: usize = 200_000;

/// What is known of a function around an instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Probe {
    /// Its value at the instant.
    pub value: f64,
    /// A lower bound of its values within the half-width asked for.
    pub lower: f64,
}

/// The least value found so far.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Least {
    /// NaN as soon as any value was.
    pub value: f64,
    /// Seconds.
    pub time: f64,
    /// False when the budget ran out before the bound was proven.
    pub certified: bool,
    /// Probes spent.
    pub probes: usize,
}

impl Least {
    /// Nothing seen yet.
    pub fn new() -> Self {
        Self {
            value: f64::INFINITY,
            time: 0.0,
            certified: true,
            probes: 0,
        }
    }

    /// Takes note of a value.
    pub fn see(&mut self, value: f64, time: f64) {
        // negated on purpose: a NaN is taken over and stays
        if !(value >= self.value) && !self.value.is_nan() {
            self.value = value;
            self.time = time;
        }
    }

    /// Searches an interval: halves it until every part is bounded by the best value less
    /// [`tolerance::MARGIN_M`], or, where it is shorter than [`tolerance::INSTANT_S`], half of
    /// [`tolerance::DEPTH_M`]. `probe(time, half)` gives the value at `time` and a lower bound on
    /// `[time - half, time + half]`.
    pub fn search(&mut self, from: f64, until: f64, probe: impl Fn(f64, f64) -> Probe) {
        let mut open = vec![(from, until)];
        while let Some((from, until)) = open.pop() {
            if self.probes >= MAX_PROBES {
                self.certified = false;
                return;
            }
            self.probes += 1;
            let (middle, half) = (0.5 * (from + until), 0.5 * (until - from));
            let found = probe(middle, half);
            self.see(found.value, middle);
            if self.value.is_nan() {
                return;
            }
            // what is left open between two instants counts as none, of slow and of fast ships
            let close = 2.0 * half <= tolerance::INSTANT_S;
            let open_m = if close {
                0.5 * tolerance::DEPTH_M
            } else {
                tolerance::MARGIN_M
            };
            // negated on purpose: a NaN bound certifies nothing
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
