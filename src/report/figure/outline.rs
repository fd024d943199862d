//! Drawable curves and areas of sets.

use kuva::plot::{BandPlot, LinePlot, ScatterPlot};
use kuva::render::plots::Plot;

use crate::frame::{Vector, cross};
use crate::geometry::{ConvexPolygon, ConvexSet, Ellipse};
use crate::obstacle::{EllipsoidObstacle, Obstacle};
use crate::study::compare::Stroke;
use crate::tolerance::ELLIPSE_SIDES;

/// Number of points on the boundary of an ellipse.
const ELLIPSE_POINTS: usize = 96;

/// Boundary of a section, counter-clockwise; ellipses are sampled.
pub fn sampled_boundary(section: &ConvexSet) -> Vec<Vector> {
    match section {
        ConvexSet::Polygon(polygon) => polygon.vertices().to_vec(),
        ConvexSet::Ellipse(ellipse) => ellipse.sampled_boundary(ELLIPSE_POINTS),
    }
}

/// Draws a polyline, closed on request.
pub fn curve(points: &[Vector], closed: bool, stroke: Stroke) -> Plot {
    let first = points.first().filter(|_| closed);
    let all = bends(points)
        .into_iter()
        .chain(first.copied())
        .map(|p| (p.x, p.y));
    let line = LinePlot::new()
        .with_data(all)
        .with_color(stroke.colour)
        .with_stroke_width(stroke.width);
    Plot::Line(if stroke.dashed {
        line.with_dashed()
    } else {
        line
    })
}

/// The points of a polyline without those on the straight way between their neighbours. The points
/// left out were within this fraction of the way.
pub(super) fn bends(points: &[Vector]) -> Vec<Vector> {
    const STRAIGHT: f64 = 1e-4;
    let mut kept: Vec<Vector> = Vec::with_capacity(points.len());
    for (index, point) in points.iter().enumerate() {
        let next = kept.last().zip(points.get(index + 1));
        let is_bend = next.is_none_or(|(last, next)| {
            let (here, on) = (point - last, next - point);
            // negated so that a NaN is kept
            !(cross(here, on).abs() <= STRAIGHT * here.norm() * on.norm() && here.dot(&on) > 0.0)
        });
        if is_bend {
            kept.push(*point);
        }
    }
    kept
}

/// Draws a point.
pub fn mark(at: Vector, colour: &str) -> Plot {
    dots(&[at], colour, 4.5)
}

pub(super) fn marks(at: &[Vector], colour: &str) -> Plot {
    dots(at, colour, 4.0)
}

/// Dots of a radius in pixels.
pub(super) fn dots(at: &[Vector], colour: &str, radius: f64) -> Plot {
    let points = ScatterPlot::new().with_data(at.iter().map(|p| (p.x, p.y)));
    Plot::Scatter(points.with_color(colour).with_size(radius))
}

/// Draws a filled convex polygon as the band between its lower and upper chain. `None` if its area
/// is zero.
pub fn area(polygon: &ConvexPolygon, colour: &str, opacity: f64) -> Option<Plot> {
    let vertices = polygon.vertices();
    let mut xs: Vec<f64> = vertices.iter().map(|v| v.x).collect();
    xs.sort_by(f64::total_cmp);
    xs.dedup();
    if vertices.len() < 3 || xs.len() < 2 {
        return None;
    }
    let chain = |upper: bool| -> Vec<f64> {
        xs.iter()
            .map(|x| {
                let mut best: Option<f64> = None;
                for (a, b) in polygon.edges() {
                    if (x < &a.x.min(b.x)) || (x > &a.x.max(b.x)) {
                        continue;
                    }
                    let (low, high) = if a.x == b.x {
                        (a.y.min(b.y), a.y.max(b.y))
                    } else {
                        let y = a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x));
                        (y, y)
                    };
                    best = Some(match best {
                        None if upper => high,
                        None => low,
                        Some(y) if upper => y.max(high),
                        Some(y) => y.min(low),
                    });
                }
                best.unwrap_or(f64::NAN)
            })
            .collect()
    };
    let (lower, upper) = (chain(false), chain(true));
    let band = BandPlot::new(xs, lower, upper)
        .with_color(colour)
        .with_opacity(opacity);
    Some(Plot::Band(band))
}

/// Velocities that come within `distance` metres of a target, as convex polygons up to `limit` m/s
/// east and north. At distance 0, this is the velocity obstacle. Polygons are exact at distance 0.
/// At other distances they are widened by a disc of 64 sides, 0.1 % too large. Ellipses are outer
/// approximations.
pub fn outer_velocities_within(
    target: &Obstacle,
    approach: &Approaching,
    distance: f64,
    limit: f64,
) -> Vec<ConvexPolygon> {
    let Approaching { position, horizon } = *approach;
    let disc = Ellipse::disc(Vector::zeros(), distance);
    let wider = |set: &ConvexPolygon| {
        if distance > 0.0 {
            set.minkowski_sum(&disc.outer_polygon(ELLIPSE_SIDES))
        } else {
            set.clone()
        }
    };
    let regions = match target.as_ellipsoid() {
        Some(ellipsoid) => vec![ellipsoid.outer_velocities_within(position, horizon, distance)],
        None => {
            let wide = match &target.sets().initial {
                ConvexSet::Polygon(initial) => target.with_initial(wider(initial)),
                ConvexSet::Ellipse(initial) => {
                    let wide = EllipsoidObstacle::new("", *initial, disc);
                    target.with_initial(wide.outer_section(1.0))
                }
            };
            wide.outer_velocity_obstacles(position, horizon)
        }
    };
    regions.iter().filter_map(|r| r.clipped(limit)).collect()
}

/// Own ship's position at t = 0 and the time for which it holds its velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approaching {
    /// Position in metres.
    pub position: Vector,
    /// Time in seconds.
    pub horizon: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::obstacle::{PolytopeObstacle, SpaceTimeObstacle};
    use crate::target::{TimedVelocitySet, Uncertainty};

    /// Compares the drawn regions with the exact closest approach.
    #[test]
    fn the_velocities_drawn_are_those_that_come_so_near() {
        let (place, way) = (Vector::new(300.0, 80.0), Vector::new(-2.0, -0.5));
        let timed = [(70.0, 0.2), (f64::INFINITY, 0.9)].map(|(until, wide)| {
            TimedVelocitySet::new(until, ConvexPolygon::rectangle(way, wide, wide))
        });
        let changing =
            Uncertainty::new(ConvexPolygon::rectangle(place, 30.0, 10.0), timed.to_vec());
        let ellipse = |center: Vector, a: f64, b: f64| {
            Ellipse::from_axes(center, [Vector::new(a, 0.0), Vector::new(0.0, b)])
        };
        let targets: [Obstacle; 3] = [
            PolytopeObstacle::new(
                "",
                ConvexPolygon::rectangle(place, 30.0, 10.0),
                ConvexPolygon::rectangle(way, 0.4, 0.2),
            )
            .into(),
            EllipsoidObstacle::new("", ellipse(place, 30.0, 10.0), ellipse(way, 0.4, 0.2)).into(),
            Obstacle::new("", changing).expect("increasing"),
        ];
        let (position, limit) = (Vector::new(-10.0, 5.0), 12.0);
        for horizon in [200.0, f64::INFINITY] {
            let approach = Approaching { position, horizon };
            for (target, distance) in targets
                .iter()
                .flat_map(|t| [0.0, 25.0, 120.0].map(|d| (t, d)))
            {
                let drawn = outer_velocities_within(target, &approach, distance, limit);
                for i in 0..61 * 61 {
                    let v = Vector::new(f64::from(i % 61) - 30.0, f64::from(i / 61) - 30.0) * 0.2;
                    let nearest = target.closest_approach(position, v, horizon);
                    let beyond = drawn.iter().map(|d| d.signed_distance(v));
                    let beyond = beyond.fold(f64::INFINITY, f64::min);
                    let near = nearest.distance <= distance * 1.002 + 1e-6;
                    assert!(beyond > -0.01 || near, "{distance} {v:?} {nearest:?}");
                    let far = nearest.distance >= distance - 1e-6;
                    assert!(beyond < 0.01 || far, "{distance} {v:?} {nearest:?}");
                }
            }
        }
    }

    #[test]
    fn a_polyline_keeps_its_bends() {
        let at = |x: f64, y: f64| Vector::new(x, y);
        let straight: Vec<Vector> = (0..50)
            .map(|k| at(f64::from(k), 2.0 * f64::from(k)))
            .collect();
        assert_eq!(bends(&straight), [straight[0], straight[49]]);
        let there_and_back = [at(0.0, 0.0), at(1.0, 0.0), at(2.0, 0.0), at(1.0, 0.0)];
        assert_eq!(
            bends(&there_and_back),
            [at(0.0, 0.0), at(2.0, 0.0), at(1.0, 0.0)]
        );
        let arc: Vec<Vector> = (0..90)
            .map(|k| crate::frame::direction(0.01 * f64::from(k)))
            .collect();
        assert!(bends(&arc).len() > 80);
        assert!(bends(&[]).is_empty());
    }

    #[test]
    fn an_area_is_the_polygon_that_it_fills() {
        let Some(Plot::Band(band)) = area(
            &ConvexPolygon::rectangle(Vector::zeros(), 2.0, 1.0),
            "#000000",
            1.0,
        ) else {
            panic!("a band");
        };
        assert_eq!(band.x, [-2.0, 2.0]);
        assert_eq!((band.y_lower, band.y_upper), (vec![-1.0; 2], vec![1.0; 2]));
        assert!(area(&ConvexPolygon::point(Vector::zeros()), "#000000", 1.0).is_none());
    }
}
