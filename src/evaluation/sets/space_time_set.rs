//! A moving set as the checker sees it: sections from matched vertices, faces from supports.

use crate::evaluation::distance::clearance::Body;
use crate::evaluation::distance::least::Least;
use crate::evaluation::distance::piece::Piece;
use crate::evaluation::sets::moving_ellipse::MovingEllipse;
use crate::evaluation::sets::moving_slabs::MovingSlabs;
use crate::frame::{Vector, to_starboard};
use crate::geometry::{ConvexPolygon, Ellipse};
use crate::target::VelocitySpell;

/// A set that a plan was made against.
///
/// # Examples
///
/// ```
/// use searoom::evaluation::{Freedom, Request, SpaceTimeSet, evaluate};
/// use searoom::frame::Vector;
/// use searoom::geometry::ConvexPolygon;
/// use searoom::scenario::Scenario;
/// use searoom::trajectory::Segment;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// // own ship holds course and speed
/// let start = scenario.own_ship.pose;
/// let held = [Segment { start, start_time: 0.0, duration: 300.0, speed: 5.0, turn_rate: 0.0 }];
/// let request = Request {
///     segments: &held,
///     own: &scenario.own_ship,
///     freedom: Freedom::Limits,
///     desired: &scenario.desired,
///     targets: &scenario.targets,
///     sets: &[],
///     land: &[],
///     land_margin: 0.0,
///     horizon: scenario.horizon,
///     arrival_hold: scenario.arrival_hold,
///     time_weight: scenario.time_weight,
///     max_risk: 0.0,
/// };
/// let found = evaluate(&request);
/// let shoal = ConvexPolygon::hull(&[(700.0, -10.0), (800.0, -10.0), (750.0, 10.0)].map(|(x, y)| Vector::new(x, y)));
/// let still = ConvexPolygon::point(Vector::zeros());
/// let sets = [SpaceTimeSet::polytope("shoal", shoal.expect("a triangle"), still)];
/// let found = evaluate(&Request { sets: &sets, targets: &[], ..request });
/// assert!(found.violations.iter().any(|v| v.what.contains("shoal")));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceTimeSet {
    /// The target's name.
    pub name: String,
    /// Seconds: before, nothing is claimed; its clock starts then.
    pub from: f64,
    /// What it is made of.
    pub shape: SetShape,
}

/// What a set is made of.
///
/// # Examples
///
/// ```
/// use searoom::evaluation::{SetShape, SpaceTimeSet};
/// use searoom::frame::Vector;
/// use searoom::geometry::Ellipse;
///
/// let around = |x: f64| Ellipse::point(Vector::new(x, 0.0));
/// let shape = SetShape::Ellipses { initial: around(500.0), velocity: around(-5.0) };
/// // nothing is claimed of it in the first minute
/// let set = SpaceTimeSet { name: "ferry".to_owned(), from: 60.0, shape };
/// assert!(matches!(set.shape, SetShape::Ellipses { .. }));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum SetShape {
    /// Every position that is reached from `O_0` (metres) with the velocity sets (m/s), one after
    /// another; the last one holds for ever.
    Polygons {
        /// `O_0`.
        initial: ConvexPolygon,
        /// Not empty, in order of time.
        spells: Vec<VelocitySpell>,
    },
    /// The ellipse of least trace around `O_0 + t V` at every `t`: an outer set of the sum.
    Ellipses {
        /// `O_0`, metres.
        initial: Ellipse,
        /// `V`, m/s.
        velocity: Ellipse,
    },
}

impl SpaceTimeSet {
    /// `initial + t velocity`, `t >= 0`; metres and m/s.
    pub fn polytope(
        name: impl Into<String>,
        initial: ConvexPolygon,
        velocity: ConvexPolygon,
    ) -> Self {
        let spell = VelocitySpell {
            until: f64::INFINITY,
            velocities: velocity,
        };
        Self {
            name: name.into(),
            from: 0.0,
            shape: SetShape::Polygons {
                initial,
                spells: vec![spell],
            },
        }
    }
}

impl SpaceTimeSet {
    /// The least signed distance of own ship's position along what of a chain of pieces is sailed
    /// while the set is in force; infinite where nothing is.
    pub(crate) fn least_distance<P: Piece>(&self, pieces: &[P]) -> Least {
        if self.from == 0.0 {
            return self.shape.least_distance(pieces);
        }
        let mut least = self
            .shape
            .least_distance(&since(pieces, self.from, self.from));
        least.time += self.from;
        least
    }
}

/// What of a chain is sailed from a time on, by a clock that starts at `zero`. A NaN keeps all of
/// it.
pub(crate) fn since<P: Piece>(pieces: &[P], from: f64, zero: f64) -> Vec<P> {
    // negated on purpose: a NaN is before
    let later = pieces.iter().filter(|piece| !(piece.end_time() <= from));
    later
        .map(|piece| piece.part(piece.start_time().max(from), piece.end_time(), zero))
        .collect()
}

impl SetShape {
    /// The least signed distance of own ship's position along a chain of pieces.
    pub(crate) fn least_distance<P: Piece>(&self, pieces: &[P]) -> Least {
        match self {
            Self::Polygons { initial, spells } => {
                MovingSlabs::new(initial, spells).least_distance(pieces, Body::POINT)
            }
            Self::Ellipses { initial, velocity } => {
                MovingEllipse::new(initial, velocity).least_distance(pieces)
            }
        }
    }

    /// False when a section is a point or a segment for a while.
    pub(crate) fn has_interior(&self) -> bool {
        match self {
            Self::Polygons { initial, spells } => MovingSlabs::new(initial, spells).has_interior(),
            Self::Ellipses { initial, velocity } => {
                MovingEllipse::new(initial, velocity).has_interior()
            }
        }
    }
}

/// A vertex of the section: `initial + t velocity`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MovingVertex {
    /// Metres, at t = 0.
    pub initial: Vector,
    /// m/s.
    pub velocity: Vector,
}

impl MovingVertex {
    /// Where it is at `time`.
    pub fn at(&self, time: f64) -> Vector {
        self.initial + self.velocity * time
    }
}

/// A face: `normal . x <= initial + t rate`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Face {
    /// Unit, outward.
    pub normal: Vector,
    /// Metres at t = 0.
    pub initial: f64,
    /// m/s outward.
    pub rate: f64,
}

impl Face {
    /// Where the face is along its normal at `time`.
    pub fn support(&self, time: f64) -> f64 {
        self.initial + self.rate * time
    }
}

/// `O_0 + t V` prepared for distances: for `t > 0` each vertex of the section is one vertex of
/// `O_0` that moves with one vertex of `V`, and each face moves along its normal.
#[derive(Debug, Clone)]
pub(crate) struct MovingSet {
    initial: ConvexPolygon,
    velocity: ConvexPolygon,
    /// Counter-clockwise.
    pub vertices: Vec<MovingVertex>,
    /// By the angle of their normals.
    pub faces: Vec<Face>,
}

impl MovingSet {
    /// Matches vertices by asking both sets for their extreme point between each two neighbouring
    /// normals, once around. O((n + m) log (n + m)).
    pub fn new(initial: &ConvexPolygon, velocity: &ConvexPolygon) -> Self {
        let normals = initial.normals().into_iter().chain(velocity.normals());
        let mut normals: Vec<(f64, Vector)> = normals.map(|n| (n.y.atan2(n.x), n)).collect();
        normals.sort_by(|a, b| a.0.total_cmp(&b.0));
        let normals: Vec<Vector> = normals.into_iter().map(|(_, normal)| normal).collect();
        let next = normals.iter().cycle().skip(1);
        let gaps: Vec<Vector> = (normals.iter().zip(next))
            .map(|(a, b)| between(*a, *b))
            .collect();
        let faces: Vec<Face> = (initial.extremes(&normals))
            .zip(velocity.extremes(&normals))
            .zip(&normals)
            .map(|((initial, velocity), normal)| Face {
                normal: *normal,
                initial: normal.dot(&initial),
                rate: normal.dot(&velocity),
            })
            .collect();
        let mut vertices: Vec<MovingVertex> = (initial.extremes(&gaps))
            .zip(velocity.extremes(&gaps))
            .map(|(initial, velocity)| MovingVertex { initial, velocity })
            .collect();
        vertices.dedup();
        while vertices.len() > 1 && vertices[0] == vertices[vertices.len() - 1] {
            vertices.pop();
        }
        Self {
            initial: initial.clone(),
            velocity: velocity.clone(),
            vertices,
            faces,
        }
    }

    /// The section at a time as a set that does not move.
    pub fn still_at(&self, time: f64) -> Self {
        let section = self.initial.minkowski_sum(&self.velocity.scaled(time));
        Self::new(&section, &ConvexPolygon::point(Vector::zeros()))
    }

    /// The supporting line in any unit direction.
    pub fn face(&self, normal: Vector) -> Face {
        Face {
            normal,
            initial: self.initial.support(normal),
            rate: self.velocity.support(normal),
        }
    }

    /// m/s of its fastest vertex.
    pub fn fastest(&self) -> f64 {
        self.velocity.reach()
    }

    /// False when the sections are points or segments at every time.
    pub fn has_interior(&self) -> bool {
        self.vertices.len() > 2
    }
}

/// Along the bisector of the counter-clockwise gap, at most half a turn, between two unit vectors.
/// The first part vanishes for opposite vectors, the second for equal ones.
fn between(a: Vector, b: Vector) -> Vector {
    (a + b) + to_starboard(b - a)
}
