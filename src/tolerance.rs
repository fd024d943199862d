//! Every tolerance of the program, with its unit and its reason.

/// Metres. Two lengths closer than this are the same length: rounding of coordinates up to
/// 1,000 km stays a thousand times smaller.
pub const LENGTH_M: f64 = 1e-9;

/// Metres. A checker rejects a plan that is deeper inside a set than this. Planners aim for zero,
/// so the gap covers the rounding of both.
pub const DEPTH_M: f64 = 1e-6;

/// Metres. Planned motions may touch a set; deeper than this they are in contact. A tenth of
/// [`DEPTH_M`], so that the checker accepts what a planner accepts.
pub const TOUCH_M: f64 = 1e-7;

/// Standard deviations of a target's position that its sets cover.
pub const POSITION_SIGMAS: f64 = 3.0;

/// Metres. Positions at the joint of two segments may differ by this much: rounding along a chain
/// of some hundred segments.
pub const JOINT_M: f64 = 1e-6;

/// Radians. Headings at the joint of two segments may differ by this much.
pub const JOINT_RAD: f64 = 1e-9;

/// Radians. A recommended turn ends this far beyond the boundary of a velocity obstacle: a millimetre at a
/// thousand kilometres, and far more than rounding puts back.
pub const ALTERATION_RAD: f64 = 1e-9;

/// m/s. A recommended change of speed ends this far beyond the boundary of a velocity obstacle.
pub const ALTERATION_MPS: f64 = 1e-9;

/// Relative. Points of a set closer than this fraction of its extent are one point.
pub const DUPLICATE: f64 = 1e-11;

/// Relative. A set narrower than this fraction of its extent is a segment.
pub const THIN: f64 = 1e-12;

/// Radians. A vertex at which the boundary turns less than this is no vertex.
pub const COLLINEAR_RAD: f64 = 1e-9;

/// Relative. A shape matrix may miss symmetry, and its eigenvalues zero, by this fraction of its largest
/// entry: nine digits written by hand or by another program.
pub const SHAPE: f64 = 1e-9;

/// Of 3. How far the smallest enclosing ellipse may be from the condition of its optimum; its area is
/// then within 1e-8 of the least one.
pub const LOEWNER: f64 = 1e-9;

/// Seconds. Two instants closer than this are the same instant.
pub const TIME_S: f64 = 1e-9;

/// Relative. A turning radius, a speed or a curvature may differ from its limit by this fraction.
pub const LIMIT: f64 = 1e-9;

/// Metres. A plan has arrived when it ends this near to the last waypoint: the way of a ship in some
/// microseconds, which is how exactly a plan ends on time.
pub const ARRIVAL_M: f64 = 1e-5;

/// Metres. Sets narrower than twice this are grown by it before they are planned around.
pub const HALF_WIDTH_M: f64 = 5e-4;

/// Metres. A shape that is drawn back to let own ship start outside leaves her this much room.
pub const START_M: f64 = 1e-3;

/// Metres. The checker's least distances to a set are exact to this; a tenth of [`DEPTH_M`], so that
/// it decides on the depth and not on its own error.
pub const MARGIN_M: f64 = 1e-7;

/// Seconds. Between two instants this close the checker leaves half of [`DEPTH_M`] open, which two ships that close at 50 m/s
/// move meanwhile; of faster ones it looks at shorter times.
pub const INSTANT_S: f64 = 1e-8;

/// Relative. Accuracy of integrals along a trajectory.
pub const QUADRATURE: f64 = 1e-10;

/// Metres. A face that a point is beyond by no more than this does not count against it in a risk: a risk
/// divides by times near zero, and a point on the face must not be ruined by its last digit.
pub const FACE_M: f64 = 1e-12;

/// Dimensionless. A largest risk that is found by bisection is exact to this.
pub const RISK: f64 = 1e-12;

/// Seconds. Searches without a horizon end here, after 31 years.
pub const FOREVER_S: f64 = 1e9;

/// Metres. An arc that comes this near to an obstacle without an exact test of its own is in contact.
pub const GRAZE_M: f64 = 1e-8;

/// Of a ship's own units of length, speed and angle (for CyberShip II metres, m/s and radians). Integrated from one node
/// of a plan of forces, she may be off the next one by this: a tenth of a millimetre for a ship of one metre, what
/// any feedback takes out at once.
pub const DEFECT: f64 = 1e-4;

/// Relative, and absolute below one. A figure of a document may differ from the one that is computed anew by this: angles are
/// written in degrees, and a least distance is exact to [`MARGIN_M`].
pub const FIGURE: f64 = 1e-6;
