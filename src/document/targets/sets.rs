//! Convex sets of positions and of velocities: the one conversion to their documents and back.

use nalgebra::Matrix2;
use serde::{Deserialize, Serialize};

use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, ConvexSet, Ellipse};
use crate::scenario::Fault;

/// Convex set of positions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, try_from = "SetKeys")]
pub enum InitialSetDocument {
    Polygon {
        vertices_m: Vec<[f64; 2]>,
    },
    Ellipse {
        center_m: [f64; 2],
        shape_m2: [[f64; 2]; 2],
    },
}

/// Convex set of velocities.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, try_from = "SetKeys")]
pub enum VelocitySetDocument {
    Polygon {
        vertices_mps: Vec<[f64; 2]>,
    },
    Ellipse {
        center_mps: [f64; 2],
        shape_m2_per_s2: [[f64; 2]; 2],
    },
}

/// All keys of a set. An untagged enum is read from these so that an error names the wrong key.
#[derive(Deserialize)]
struct SetKeys {
    vertices_m: Option<Vec<[f64; 2]>>,
    center_m: Option<[f64; 2]>,
    shape_m2: Option<[[f64; 2]; 2]>,
    vertices_mps: Option<Vec<[f64; 2]>>,
    center_mps: Option<[f64; 2]>,
    shape_m2_per_s2: Option<[[f64; 2]; 2]>,
}

/// The keys of one unit: those of positions, or those of velocities.
type Keys = (
    Option<Vec<[f64; 2]>>,
    Option<[f64; 2]>,
    Option<[[f64; 2]; 2]>,
);

impl SetKeys {
    fn of_positions(self) -> Keys {
        match (self.vertices_mps, self.center_mps, self.shape_m2_per_s2) {
            (None, None, None) => (self.vertices_m, self.center_m, self.shape_m2),
            _ => (None, None, None),
        }
    }

    fn of_velocities(self) -> Keys {
        match (self.vertices_m, self.center_m, self.shape_m2) {
            (None, None, None) => (self.vertices_mps, self.center_mps, self.shape_m2_per_s2),
            _ => (None, None, None),
        }
    }
}

const NEITHER: &str = "found neither vertices alone nor centre and shape alone, in metres or in \
                       metres per second as the set asks; allowed: one of the two";

impl TryFrom<SetKeys> for InitialSetDocument {
    type Error = &'static str;

    fn try_from(keys: SetKeys) -> Result<Self, Self::Error> {
        match keys.of_positions() {
            (Some(vertices_m), None, None) => Ok(Self::Polygon { vertices_m }),
            (None, Some(center_m), Some(shape_m2)) => Ok(Self::Ellipse { center_m, shape_m2 }),
            _ => Err(NEITHER),
        }
    }
}

impl TryFrom<SetKeys> for VelocitySetDocument {
    type Error = &'static str;

    fn try_from(keys: SetKeys) -> Result<Self, Self::Error> {
        match keys.of_velocities() {
            (Some(vertices_mps), None, None) => Ok(Self::Polygon { vertices_mps }),
            (None, Some(center_mps), Some(shape_m2_per_s2)) => Ok(Self::Ellipse {
                center_mps,
                shape_m2_per_s2,
            }),
            _ => Err(NEITHER),
        }
    }
}

impl From<&ConvexSet> for InitialSetDocument {
    fn from(set: &ConvexSet) -> Self {
        match set {
            ConvexSet::Polygon(set) => Self::Polygon {
                vertices_m: vertices(set),
            },
            ConvexSet::Ellipse(set) => Self::Ellipse {
                center_m: plain(set.center()),
                shape_m2: rows(set),
            },
        }
    }
}

impl From<&ConvexSet> for VelocitySetDocument {
    fn from(set: &ConvexSet) -> Self {
        match set {
            ConvexSet::Polygon(set) => Self::Polygon {
                vertices_mps: vertices(set),
            },
            ConvexSet::Ellipse(set) => Self::Ellipse {
                center_mps: plain(set.center()),
                shape_m2_per_s2: rows(set),
            },
        }
    }
}

impl InitialSetDocument {
    /// The set; the fault has no place.
    pub(crate) fn set(&self) -> Result<ConvexSet, Fault> {
        match self {
            Self::Polygon { vertices_m } => polygon(vertices_m),
            Self::Ellipse { center_m, shape_m2 } => ellipse(*center_m, shape_m2),
        }
    }
}

impl VelocitySetDocument {
    /// The set; the fault has no place.
    pub(crate) fn set(&self) -> Result<ConvexSet, Fault> {
        match self {
            Self::Polygon { vertices_mps } => polygon(vertices_mps),
            Self::Ellipse {
                center_mps,
                shape_m2_per_s2,
            } => ellipse(*center_mps, shape_m2_per_s2),
        }
    }
}

fn polygon(vertices: &[[f64; 2]]) -> Result<ConvexSet, Fault> {
    let points: Vec<Vector> = vertices.iter().copied().map(Vector::from).collect();
    let polygon = ConvexPolygon::from_vertices(&points);
    let polygon = polygon.map_err(|e| Fault::new("", e, "the vertices of a convex polygon"))?;
    Ok(polygon.into())
}

fn ellipse(center: [f64; 2], [a, b]: &[[f64; 2]; 2]) -> Result<ConvexSet, Fault> {
    let ellipse = Ellipse::new(center.into(), Matrix2::new(a[0], a[1], b[0], b[1]));
    let ellipse = ellipse.map_err(|e| Fault::new("", e, "a centre and a shape matrix"))?;
    Ok(ellipse.into())
}

pub(in crate::document) fn vertices(polygon: &ConvexPolygon) -> Vec<[f64; 2]> {
    polygon.vertices().iter().copied().map(plain).collect()
}

fn plain(p: Vector) -> [f64; 2] {
    // adding +0.0 converts a negative zero to zero
    [p.x + 0.0, p.y + 0.0]
}

fn rows(ellipse: &Ellipse) -> [[f64; 2]; 2] {
    let q = ellipse.shape();
    [0, 1].map(|row| plain(Vector::new(q[(row, 0)], q[(row, 1)])))
}
