//! Outer sets with an interior: a motion has a depth in them, while it crosses a segment at depth
//! 0.

use std::borrow::Cow;

use super::{ConvexObstacle, EllipsoidObstacle, Obstacle, PolytopeObstacle, SpaceTimeObstacle};
use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance::HALF_WIDTH_M;
use searoom_geometry::{ConvexPolygon, ConvexSet, DISC_SIDES, Ellipse, outer_disc};

impl Obstacle {
    /// An outer set that is at least a millimetre wide at every time: the set itself, the set grown
    /// by half a millimetre, or polygons around the two parts of a thin ellipsoid. A motion that is
    /// clear of it to rounding does not touch the sum of the initial set and the velocities.
    pub fn outer_with_interior(&self) -> Self {
        // the ellipse around a needle and a disc is very much wider than polygons around both
        if let Some(needle) = self.as_ellipsoid().filter(|o| o.is_thin()) {
            let [initial, velocity] =
                [needle.initial(), needle.velocity()].map(|e| e.outer_polygon(DISC_SIDES));
            let grown = outer_grown(&initial).unwrap_or(initial);
            return PolytopeObstacle::new(needle.name(), grown, velocity).into();
        }
        let grown = match &self.sets().initial {
            ConvexSet::Polygon(initial) => outer_grown(initial).map(ConvexSet::from),
            ConvexSet::Ellipse(initial) => outer_widened(initial).map(ConvexSet::from),
        };
        grown.map_or_else(|| self.clone(), |grown| self.with_initial(grown))
    }

    /// [`Obstacle::outer_with_interior`] of a set whose sections are points or segments for some
    /// time; other sets unchanged, however narrow.
    pub fn outer_where_flat(&self) -> Cow<'_, Self> {
        if self.is_flat_for_a_while() {
            Cow::Owned(self.outer_with_interior())
        } else {
            Cow::Borrowed(self)
        }
    }

    fn is_flat_for_a_while(&self) -> bool {
        let flat = |initial: &ConvexPolygon, velocity: &ConvexPolygon| {
            initial.minkowski_sum(velocity).vertices().len() < 3
        };
        // sections do not become flat again
        match self.slabs()[0].obstacle() {
            ConvexObstacle::Polytope(o) => flat(o.initial(), o.velocity()),
            ConvexObstacle::Ellipsoid(o) => {
                o.flat().is_some_and(|o| flat(o.initial(), o.velocity()))
            }
        }
    }
}

/// The set grown to sufficient width; `None` where it is wide enough.
fn outer_grown(initial: &ConvexPolygon) -> Option<ConvexPolygon> {
    // the area is at most the width times the extent
    let reach = initial.translated(-initial.centroid()).reach();
    if initial.area() > 2.0 * reach * 4.0 * HALF_WIDTH_M {
        return None;
    }
    let narrow = initial
        .normals()
        .iter()
        .any(|n| initial.support(*n) + initial.support(-n) < 2.0 * HALF_WIDTH_M);
    narrow.then(|| initial.minkowski_sum(&outer_disc(HALF_WIDTH_M, 0.0)))
}

/// [`outer_grown`] for an ellipse.
fn outer_widened(initial: &Ellipse) -> Option<Ellipse> {
    let [_, b] = initial.semi_axes();
    (b.norm() < HALF_WIDTH_M).then(|| {
        let disc = Ellipse::disc(Vector::zeros(), HALF_WIDTH_M);
        EllipsoidObstacle::new("", *initial, disc).outer_section(1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use searoom_geometry::frame::Pose;
    use searoom_model::trajectory::Segment;

    /// Own ship crosses a segment, the track of a point and a flat ellipse at right angles, and is
    /// inside none of these sets.
    #[test]
    fn what_has_no_interior_is_met_where_it_is_crossed() {
        let at = |x: f64, y: f64| Vector::new(x, y);
        let polygon = |points: &[Vector]| ConvexPolygon::hull(points).expect("finite");
        let still = polygon(&[at(0.0, 0.0)]);
        let segment = polygon(&[at(50.0, -20.0), at(50.0, 20.0)]);
        let flat = Ellipse::from_axes(at(50.0, 0.0), [at(0.0, 20.0), at(0.0, 0.0)]);
        let rest = Ellipse::from_axes(Vector::zeros(), [Vector::zeros(); 2]);
        let own = Segment::straight(Pose::new(Vector::zeros(), 0.0), 0.0, 20.0, 5.0);
        let sets: [Obstacle; 3] = [
            PolytopeObstacle::new("segment", segment, still.clone()).into(),
            PolytopeObstacle::new("point", polygon(&[at(50.0, 0.0)]), still).into(),
            EllipsoidObstacle::new("flat", flat, rest).into(),
        ];
        for set in &sets {
            assert_eq!(set.first_contact(&own, 1e-7), None, "{}", set.name());
            let grown = set.outer_with_interior();
            let met = grown.first_contact(&own, 1e-7).expect("a contact");
            assert!((met - 10.0).abs() < 1e-3, "{met}");
            assert_eq!(grown.name(), set.name());
            assert_eq!(set.outer_where_flat().first_contact(&own, 1e-7), Some(met));
            assert!(matches!(grown.outer_where_flat(), Cow::Borrowed(_)));
        }
    }
}
