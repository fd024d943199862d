//! Convex sets of positions and of velocities: the one conversion to their documents and back.

use nalgebra::Matrix2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use searoom_geometry::frame::Vector;
use searoom_geometry::{ConvexPolygon, ConvexSet, Ellipse, Window};
use searoom_input::Fault;

/// All keys of a set. An untagged enum is read from these so that an error names the wrong key.
#[derive(Deserialize, JsonSchema)]
struct SetKeys {
    vertices_m: Option<Vec<[f64; 2]>>,
    center_m: Option<[f64; 2]>,
    shape_m2: Option<[[f64; 2]; 2]>,
    vertices_mps: Option<Vec<[f64; 2]>>,
    center_mps: Option<[f64; 2]>,
    shape_m2_per_s2: Option<[[f64; 2]; 2]>,
}

impl SetKeys {
    fn count(&self) -> usize {
        let given = [
            self.vertices_m.is_some(),
            self.center_m.is_some(),
            self.shape_m2.is_some(),
            self.vertices_mps.is_some(),
            self.center_mps.is_some(),
            self.shape_m2_per_s2.is_some(),
        ];
        given.into_iter().filter(|given| *given).count()
    }
}

const NEITHER: &str = "found neither vertices alone nor centre and shape alone, in metres or in \
                       metres per second as the set asks; allowed: one of the two";

/// Defines the document of a set with the keys of its unit.
macro_rules! set_document {
    ($(#[$doc:meta])* $name:ident { $vertices:ident, $center:ident, $shape:ident }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(untagged, try_from = "SetKeys")]
        pub enum $name {
            Polygon {
                $vertices: Vec<[f64; 2]>,
            },
            Ellipse {
                $center: [f64; 2],
                $shape: [[f64; 2]; 2],
            },
        }

        impl TryFrom<SetKeys> for $name {
            type Error = &'static str;

            fn try_from(keys: SetKeys) -> Result<Self, Self::Error> {
                match (keys.count(), keys.$vertices, keys.$center, keys.$shape) {
                    (1, Some($vertices), ..) => Ok(Self::Polygon { $vertices }),
                    (2, _, Some($center), Some($shape)) => Ok(Self::Ellipse { $center, $shape }),
                    _ => Err(NEITHER),
                }
            }
        }

        impl From<&ConvexSet> for $name {
            fn from(set: &ConvexSet) -> Self {
                match set {
                    ConvexSet::Polygon(set) => Self::Polygon {
                        $vertices: vertices(set),
                    },
                    ConvexSet::Ellipse(set) => Self::Ellipse {
                        $center: plain(set.center()),
                        $shape: rows(set),
                    },
                }
            }
        }

        impl $name {
            /// The set; the fault has no place.
            pub fn set(&self) -> Result<ConvexSet, Fault> {
                match self {
                    Self::Polygon { $vertices } => polygon($vertices),
                    Self::Ellipse { $center, $shape } => ellipse(*$center, $shape),
                }
            }

            /// Centre and radius of a disc that contains the set, which is not checked: NaN without
            /// vertices.
            pub fn disc(&self) -> (Vector, f64) {
                match self {
                    Self::Polygon { $vertices } => {
                        let corners: Vec<Vector> = $vertices.iter().map(|p| (*p).into()).collect();
                        let around = Window::around(&corners);
                        around.map_or((Vector::repeat(f64::NAN), f64::NAN), |window| {
                            (window.center(), 0.5 * window.size().norm())
                        })
                    }
                    Self::Ellipse { $center, $shape } => {
                        let [[a, _], [_, b]] = $shape;
                        (Vector::from(*$center), (a + b).sqrt())
                    }
                }
            }
        }
    };
}

set_document! {
    /// Convex set of positions.
    InitialSetDocument { vertices_m, center_m, shape_m2 }
}

set_document! {
    /// Convex set of velocities.
    VelocitySetDocument { vertices_mps, center_mps, shape_m2_per_s2 }
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

/// The corners of a polygon, in its order.
pub fn vertices(polygon: &ConvexPolygon) -> Vec<[f64; 2]> {
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
