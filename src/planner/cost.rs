//! The space-time error: what the search minimises. Formulas section 7.

use std::f64::consts::PI;

use crate::trajectory::{DesiredTrajectory, Mover, Nearest, Segment};

/// Nodes and weights of the 4-point Gauss-Legendre rule on [0, 1].
pub(crate) const GAUSS_4: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Two points, exact for cubics: the squared error along a line is quadratic.
pub(crate) const GAUSS_2: [(f64, f64); 2] = [
    (0.211_324_865_405_187_13, 0.5),
    (0.788_675_134_594_812_9, 0.5),
];

/// Halvings of a stretch in which the nearest leg or its end changes.
const MAX_HALVINGS: u32 = 10;

/// `(1/T_d) integral of e² dt` over one segment, m²: its part of the space-time error `J`. Exact to
/// rounding on a line near one leg; elsewhere 4-point Gauss-Legendre on arcs up to pi/4, cut by halves to
/// a thousandth of the stretch where the nearest leg or the clamp at its ends changes.
pub fn space_time_error(desired: &DesiredTrajectory, segment: &Segment, time_weight: f64) -> f64 {
    let pieces = (segment.turn_rate.abs() * segment.duration / (PI / 4.0))
        .ceil()
        .max(1.0);
    let duration = segment.duration / pieces;
    let stretch = Stretch {
        desired,
        mover: Mover::new(segment),
        time_weight,
        bent: segment.is_arc(),
    };
    let integral: f64 = (0..pieces as usize)
        .map(|k| {
            stretch.integral(
                segment.start_time + duration * k as f64,
                duration,
                MAX_HALVINGS,
            )
        })
        .sum();
    integral / desired.duration()
}

struct Stretch<'a> {
    desired: &'a DesiredTrajectory,
    mover: Mover,
    time_weight: f64,
    bent: bool,
}

impl Stretch<'_> {
    fn at(&self, time: f64) -> Nearest {
        self.desired
            .nearest(self.mover.position_at(time), time, self.time_weight)
    }

    /// Which leg is nearest, and whether one of its ends is.
    fn regime(&self, time: f64) -> (usize, bool, bool) {
        let nearest = self.at(time);
        let leg = &self.desired.legs()[nearest.leg];
        let along = nearest.distance - leg.start_distance;
        (nearest.leg, along > 0.0, along < leg.length)
    }

    fn integral(&self, from: f64, duration: f64, halvings: u32) -> f64 {
        let first = self.regime(from);
        // within one leg and one clamp the error is smooth
        let inner: &[f64] = if self.desired.legs().len() == 1 {
            &[1.0]
        } else {
            &[1.0, 0.5, 0.25, 0.75]
        };
        if halvings == 0
            || inner
                .iter()
                .all(|f| self.regime(from + duration * f) == first)
        {
            let nodes: &[(f64, f64)] = if self.bent { &GAUSS_4 } else { &GAUSS_2 };
            return duration
                * nodes
                    .iter()
                    .map(|(x, w)| w * self.at(from + duration * x).error)
                    .sum::<f64>();
        }
        let half = duration / 2.0;
        self.integral(from, half, halvings - 1) + self.integral(from + half, half, halvings - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Pose, Vector};

    fn dense(desired: &DesiredTrajectory, s: &Segment, q: f64) -> f64 {
        let n = 200_000;
        let sum: f64 = (0..n)
            .map(|i| {
                let t = s.start_time + s.duration * (f64::from(i) + 0.5) / f64::from(n);
                desired.nearest(s.pose_at(t).position, t, q).error
            })
            .sum();
        sum * s.duration / f64::from(n) / desired.duration()
    }

    #[test]
    fn matches_a_dense_sum_on_lines_arcs_corners_and_clamped_ends() {
        let corner = [(0.0, 0.0), (500.0, 0.0), (700.0, 400.0)].map(|(x, y)| Vector::new(x, y));
        let straight = [(0.0, 0.0), (1500.0, 0.0)].map(|(x, y)| Vector::new(x, y));
        for desired in [
            DesiredTrajectory::new(&corner, &[5.0, 4.0]).expect("valid"),
            DesiredTrajectory::new(&straight, &[5.0]).expect("valid"),
        ] {
            for i in 0..60 {
                let k = f64::from(i);
                let segment = Segment {
                    start: Pose::new(
                        Vector::new(800.0 * (0.31 * k).sin(), 150.0 * (k * 0.7).cos()),
                        k * 0.41,
                    ),
                    start_time: (k * 3.7) % 90.0,
                    duration: 20.0 + k,
                    speed: [0.0, 2.5, 5.0, 6.0][i as usize % 4],
                    turn_rate: [0.0, 0.05, -0.06][i as usize % 3],
                };
                let exact = dense(&desired, &segment, 25.0);
                let found = space_time_error(&desired, &segment, 25.0);
                assert!(
                    (found - exact).abs() <= 1e-5 * (1.0 + exact),
                    "{found} {exact} {segment:?}"
                );
            }
        }
    }

    #[test]
    fn the_desired_motion_costs_nothing_and_a_constant_lag_its_square() {
        let straight = [(0.0, 0.0), (1500.0, 0.0)].map(|(x, y)| Vector::new(x, y));
        let desired = DesiredTrajectory::new(&straight, &[5.0]).expect("valid");
        let run = |from: f64| Segment {
            start: Pose::new(Vector::new(from, 0.0), 0.0),
            start_time: 60.0,
            duration: 150.0,
            speed: 5.0,
            turn_rate: 0.0,
        };
        assert!(space_time_error(&desired, &run(300.0), 25.0) < 1e-18);
        let lag = space_time_error(&desired, &run(260.0), 25.0);
        assert!((lag - 0.5 * 1600.0 * 150.0 / 300.0).abs() < 1e-9);
    }
}
