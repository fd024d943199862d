//! The trait of all space-time obstacles.

use super::closest_approach::ClosestApproach;
use super::risk::{PeakRisk, risk_of};
use searoom_geometry::SignedDistance;
use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance;
use searoom_model::trajectory::{Segment, Trajectory};

/// Number of steps at which the risk is sampled along one piece of a motion under forces.
const SAMPLES: usize = 32;

/// The support function of a section and its time derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// `h(n, t) = max over O_t of n . x`, metres.
    pub value: f64,
    /// Right derivative in time, m/s: how fast the boundary moves outward.
    pub rate: f64,
}

/// A set in space-time that contains every position a target may reach.
///
/// Its sections `O_t`, `t >= 0`, are convex and given by their support function. East-north frame,
/// metres, seconds from the scenario's start. There is no obstacle before t = 0. Fails closed: a
/// position or velocity that is NaN is inside, with distance NaN and risk 1.
///
/// ```
/// use searoom_geometry::frame::{Pose, Vector};
/// use searoom_geometry::ConvexPolygon;
/// use searoom_sets::{PolytopeObstacle, SpaceTimeObstacle};
/// use searoom_model::trajectory::Segment;
///
/// let square = [(-10.0, -10.0), (10.0, -10.0), (10.0, 10.0), (-10.0, 10.0)];
/// let square = square.map(|(x, y)| Vector::new(200.0 + x, y));
/// let initial = ConvexPolygon::hull(&square)?;
/// let velocity = ConvexPolygon::hull(&[Vector::new(-2.0, 0.0), Vector::new(-3.0, 0.0)])?;
/// let set = PolytopeObstacle::new("ferry", initial, velocity);
///
/// // after 10 s it reaches from 160 m to 190 m east
/// assert!(set.contains(Vector::new(161.0, 0.0), 10.0));
/// assert!(!set.contains(Vector::new(159.0, 0.0), 10.0));
/// assert_eq!(set.moving_vertices().len(), set.faces().len());
/// let slack = set.slack(Vector::new(150.0, 0.0), 10.0);
/// assert!((slack.value - 10.0).abs() < 1e-9);
/// assert!(set.faces()[slack.face].normal.x < 0.0);
/// let east = set.support(Vector::new(1.0, 0.0), 10.0);
/// assert_eq!((east.value, east.rate), (190.0, -2.0));
///
/// // own ship at 5 m/s against it
/// let ahead = Segment {
///     start: Pose::new(Vector::zeros(), 0.0),
///     start_time: 0.0,
///     duration: 60.0,
///     speed: 5.0,
///     turn_rate: 0.0,
/// };
/// let contact = set.first_contact(&ahead, 0.0).expect("they meet");
/// assert!((contact - 190.0 / 8.0).abs() < 1e-9);
/// assert!(set.peak_risk(&ahead).risk > 0.9);
/// let approach = set.closest_approach(Vector::new(0.0, 50.0), Vector::new(5.0, 0.0), 60.0);
/// assert!((approach.distance - 40.0).abs() < 1e-6);
/// # Ok::<(), searoom_geometry::GeometryError>(())
/// ```
pub trait SpaceTimeObstacle {
    /// The target's name.
    fn name(&self) -> &str;

    /// Support of the section at `time >= 0` in the direction of the unit vector `normal`.
    fn support(&self, normal: Vector, time: f64) -> Support;

    /// Euclidean distance from the section at `time >= 0`, negative inside, with the outward normal
    /// at the nearest boundary point.
    fn signed_distance(&self, position: Vector, time: f64) -> SignedDistance;

    /// True when the point is in the closed set.
    fn contains(&self, position: Vector, time: f64) -> bool;

    /// The first time at which the segment is at least `depth` metres inside, or `None`.
    ///
    /// A segment or depth that is not finite is in contact at once. At depth 0 touching counts.
    fn first_contact(&self, segment: &Segment, depth: f64) -> Option<f64>;

    /// True where a motion is at least `depth` metres inside at some time, as in
    /// [`SpaceTimeObstacle::first_contact`].
    fn is_entered(&self, motion: &[Segment], depth: f64) -> bool {
        let mut segments = motion.iter();
        segments.any(|segment| self.first_contact(segment, depth).is_some())
    }

    /// `alpha*`: the least `alpha >= 0` for which the point is in `O_alpha`, paper eqs. (22)-(24).
    ///
    /// `O_alpha` is the set with velocities scaled by alpha about their centre. `alpha*` is at most
    /// 1 inside the set and may exceed 1 outside. It is infinite where no scaling reaches, and
    /// before t = 0.
    fn alpha(&self, position: Vector, time: f64) -> f64 {
        self.alpha_within(position, time, tolerance::FACE_M)
    }

    /// [`SpaceTimeObstacle::alpha`] of a point that may be beyond edges of the set by rounding: edges
    /// that it exceeds by at most `edge` metres do not count.
    fn alpha_within(&self, position: Vector, time: f64, edge: f64) -> f64;

    /// `risk = 1 - alpha*`, at least 0, paper eq. (25). It is 0 outside the set and 1 in the set of
    /// a target with the central velocity. Not a probability.
    fn risk(&self, position: Vector, time: f64) -> f64 {
        risk_of(self.alpha(position, time))
    }

    /// The largest risk along a segment.
    fn peak_risk(&self, segment: &Segment) -> PeakRisk;

    /// The largest risk along a trajectory, the first of equal ones.
    ///
    /// A motion under forces is sampled at `SAMPLES` steps per piece. Samples no deeper than
    /// [`tolerance::DEPTH_M`] in the set do not count.
    fn peak_risk_along(&self, trajectory: &Trajectory) -> PeakRisk {
        largest_risk_of_parts(self, trajectory)
    }

    /// The level set `O_alpha` with `alpha = 1 - risk`: outside it the risk is at most `risk`.
    ///
    /// Risk 0, or a risk outside `[0, 1]`, gives the set itself.
    fn at_risk(&self, risk: f64) -> Self
    where
        Self: Sized;

    /// The least distance, and its earliest time, of own ship with constant `velocity` from
    /// `position` at t = 0, over `[0, horizon]`, paper eq. (26). `horizon` may be infinite.
    fn closest_approach(&self, position: Vector, velocity: Vector, horizon: f64)
    -> ClosestApproach;

    /// True when constant `velocity` from `position` at t = 0 meets the set within `[0, horizon]`.
    ///
    /// This is membership in the velocity obstacle `{v : position + v t in O_t for some t}`.
    /// `horizon` may be infinite.
    fn in_velocity_obstacle(&self, position: Vector, velocity: Vector, horizon: f64) -> bool;
}

/// The largest risk over the pieces and segments of a trajectory.
pub(super) fn largest_risk_of_parts<S: SpaceTimeObstacle + ?Sized>(
    set: &S,
    trajectory: &Trajectory,
) -> PeakRisk {
    let mut peak = PeakRisk::new(0.0, trajectory.start_time());
    for piece in trajectory
        .steered()
        .iter()
        .flat_map(|motion| motion.pieces())
    {
        for sample in 0..=SAMPLES {
            let part = sample as f64 / SAMPLES as f64;
            let position = piece.position(part);
            let time = piece.start_time + part * piece.duration;
            let risk = set.risk(position, time);
            if risk > peak.risk
                && !(set.signed_distance(position, time).distance >= -tolerance::DEPTH_M)
            {
                peak = PeakRisk { risk, time };
            }
        }
    }
    for segment in trajectory.segments() {
        let here = set.peak_risk(segment);
        if here.risk > peak.risk {
            peak = here;
        }
    }
    peak
}
