//! Tolerances and shared numerical constants, each with its unit and reason.

/// Metres. Lengths that differ by less are equal. The rounding error of coordinates up to 1,000 km
/// is a thousand times smaller.
pub const LENGTH_M: f64 = 1e-9;

/// Metres. A checker rejects a plan that is deeper inside a set. Planners aim for zero, so the
/// difference covers the rounding of both.
pub const DEPTH_M: f64 = 1e-6;

/// Metres. Planned motions may touch a set; deeper than this they are in contact. A tenth of
/// [`DEPTH_M`], so that the checker accepts what a planner accepts.
pub const TOUCH_M: f64 = 1e-7;

/// Metres. A point this near to a set is on its edge, and the edge belongs to the set. It is several
/// times the rounding error of a place that is reached after 1,000,000 s at 100 m/s, and fifty times
/// that of coordinates up to 10,000 km.
pub const EDGE_M: f64 = 1e-7;

/// Standard deviations of a target's position, speed and course that its sets cover.
pub const SIGMAS: f64 = 3.0;

/// Metres. Positions at the joint of two segments may differ by this: rounding along a chain of
/// some hundred segments.
pub const JOINT_M: f64 = 1e-6;

/// Radians. Headings at the joint of two segments may differ by this; see [`joint_rad`].
pub const JOINT_RAD: f64 = 1e-9;

/// Allowed difference of headings at the joint of two segments, radians: the turn of two arcs of
/// [`LENGTH_M`], which planners leave out. It exceeds [`JOINT_RAD`] for turning radii below 2 m.
pub fn joint_rad(turning_radius: f64) -> f64 {
    // unlike the maximum, this is a NaN for a NaN
    (2.0 * LENGTH_M / turning_radius).clamp(JOINT_RAD, f64::INFINITY)
}

/// Radians. A recommended turn ends this far beyond the boundary of a velocity obstacle: a
/// millimetre at a thousand kilometres, and far more than rounding.
pub const ALTERATION_RAD: f64 = 1e-9;

/// m/s. A recommended change of speed ends this far beyond the boundary of a velocity obstacle.
pub const ALTERATION_MPS: f64 = 1e-9;

/// Relative. Points of a set closer than this fraction of its extent are merged.
pub const DUPLICATE: f64 = 1e-11;

/// Relative. A set narrower than this fraction of its extent is a segment.
pub const THIN: f64 = 1e-12;

/// Sides of the polygon around an ellipse where polygons are asked for: at most 0.12 % too large.
pub const ELLIPSE_SIDES: usize = 64;

/// Radians. A vertex at which the boundary turns by less is removed.
pub const COLLINEAR_RAD: f64 = 1e-9;

/// Relative. A shape matrix may deviate from symmetry, and its eigenvalues from zero, by this
/// fraction of its largest entry: nine digits from a person or another program.
pub const SHAPE: f64 = 1e-9;

/// Relative. An ellipse narrower than this fraction of its length counts as a segment: a shape
/// matrix, as documents state it, loses shorter semi-axes to rounding.
pub const THIN_ELLIPSE: f64 = 1e-7;

/// Absolute, in a condition of value 3: the smallest enclosing ellipse may deviate from optimality
/// by this. So the ellipse around a turned polygon is the turned ellipse to twelve digits.
pub const LOEWNER: f64 = 1e-13;

/// Seconds. Times that differ by less are equal.
pub const TIME_S: f64 = 1e-9;

/// Relative. A turning radius, a speed or a curvature may exceed its limit by this fraction.
pub const LIMIT: f64 = 1e-9;

/// Metres. A plan has arrived when it ends this near to the last waypoint: a ship's distance in
/// some microseconds, the accuracy of arrival times.
pub const ARRIVAL_M: f64 = 1e-5;

/// Metres. Planners grow sets narrower than twice this by it.
pub const HALF_WIDTH_M: f64 = 5e-4;

/// Metres. A domain that is reduced to let own ship start outside leaves this distance.
pub const START_M: f64 = 1e-3;

/// Metres. Accuracy of the checker's least distances to a set. It is a tenth of [`DEPTH_M`], so
/// that the depth decides and not the checker's error.
pub const MARGIN_M: f64 = 1e-7;

/// Seconds. Between two times this close the checker leaves half of [`DEPTH_M`] unchecked: the
/// distance that two ships closing at 50 m/s cover. It uses shorter times for faster ships.
pub const INSTANT_S: f64 = 1e-8;

/// Relative. Accuracy of integrals along a trajectory.
pub const QUADRATURE: f64 = 1e-10;

/// Metres. A face that a point exceeds by at most this does not count in a risk. A risk divides by
/// times near zero, and the last digit of a point on the face must not decide it.
pub const FACE_M: f64 = 1e-12;

/// Dimensionless. Accuracy of a largest risk found by bisection.
pub const RISK: f64 = 1e-12;

/// Relative. An instant this near to the end of a leg of the desired trajectory is at its end:
/// horizon and end are sums of different numbers.
pub const LEG_END: f64 = 1e-12;

/// Seconds. End of searches without a horizon, 31 years.
pub const FOREVER_S: f64 = 1e9;

/// Metres. An arc that comes this near to an obstacle without an exact test is in contact.
pub const GRAZE_M: f64 = 1e-8;

/// In a ship's own units of length, speed and angle (for CyberShip II metres, m/s and radians). The
/// integrated motion may miss the next node of a plan of forces by this. It is a tenth of a
/// millimetre for a ship of one metre, which feedback corrects at once.
pub const DEFECT: f64 = 1e-4;

/// Relative, and absolute below one. A figure of a document may differ from a recomputed one by
/// this: angles are written in degrees, and a least distance is exact to [`MARGIN_M`].
pub const FIGURE: f64 = 1e-6;
