//! Lines with the points that it takes to draw them.

use crate::frame::Vector;
use crate::geometry::ConvexPolygon;

/// Of what a view shows: how far a line may be drawn from where it is, half a pixel of a view of 1500.
pub const FINENESS: f64 = 1.0 / 3000.0;

/// The first, the last, and of those between as many as keep every other one as near to the line as its own tolerance. From each point
/// on the next is the last to which the straight line passes near all between. O(points times points between two that are kept).
pub fn thinned(line: &[Vector], tolerance: impl Fn(&Vector) -> f64) -> Vec<Vector> {
    let mut kept: Vec<Vector> = line.first().copied().into_iter().collect();
    let mut from = 0;
    while from + 1 < line.len() {
        let mut to = from + 1;
        while to + 1 < line.len()
            && line[from + 1..=to]
                .iter()
                .all(|p| off(*p, line[from], line[to + 1]) <= tolerance(p))
        {
            to += 1;
        }
        kept.push(line[to]);
        from = to;
    }
    kept
}

/// The closed boundary of a polygon, thinned.
pub fn thinned_ring(polygon: &ConvexPolygon, tolerance: f64) -> Vec<Vector> {
    let vertices = polygon.vertices();
    let ring: Vec<Vector> = vertices.iter().chain(vertices.first()).copied().collect();
    thinned(&ring, |_| tolerance)
}

/// Metres from a point to the stretch between two others.
fn off(p: Vector, a: Vector, b: Vector) -> f64 {
    let way = b - a;
    let along = if way.norm_squared() > 0.0 {
        ((p - a).dot(&way) / way.norm_squared()).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (a + way * along - p).norm()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::direction;

    #[test]
    fn fewer_points_draw_the_same_line() {
        let circle: Vec<Vector> = (0..=200)
            .map(|k| direction(0.0314159 * f64::from(k)))
            .collect();
        let kept = thinned(&circle, |_| 0.01);
        assert!(kept.len() < 30 && kept.len() > 15, "{}", kept.len());
        assert_eq!((kept[0], kept[kept.len() - 1]), (circle[0], circle[200]));
        for p in &circle {
            let least = kept.windows(2).map(|w| off(*p, w[0], w[1]));
            assert!(least.fold(f64::INFINITY, f64::min) <= 0.01);
        }
        assert_eq!(thinned(&circle, |_| 0.0).len(), circle.len());
        let far = thinned(&circle, |p| if p.x > 0.0 { 0.0 } else { 2.0 });
        assert!(far.len() > 95 && far.len() < 105, "{}", far.len());
    }

    #[test]
    fn a_spike_and_a_return_stay() {
        let points = [
            (0.0, 0.0),
            (5.0, 0.0),
            (5.0, 8.0),
            (5.0, 0.0),
            (9.0, 0.0),
            (1.0, 0.0),
        ];
        let line = points.map(|(x, y)| Vector::new(x, y));
        assert_eq!(thinned(&line, |_| 0.1), line);
        assert_eq!(thinned(&line[..1], |_| 0.1), line[..1]);
        assert!(thinned(&[], |_| 0.1).is_empty());
    }
}
