//! Lines with fewer points that look the same.

use crate::frame::Vector;

/// Largest error of a drawn line as a fraction of the view: half a pixel of a view of 1500.
pub const TOLERANCE: f64 = 1.0 / 3000.0;

/// Drops points of a line; every dropped point stays within its own `tolerance` of the new line.
///
/// Greedy: from each point that stays, the next is the last one to which the straight line passes
/// within tolerance of all points between. O(n k) with k points between two that stay.
pub fn simplified(line: &[Vector], tolerance: impl Fn(&Vector) -> f64) -> Vec<Vector> {
    let mut kept: Vec<Vector> = line.first().copied().into_iter().collect();
    let mut from = 0;
    while from + 1 < line.len() {
        let mut to = from + 1;
        while to + 1 < line.len()
            && line[from + 1..=to]
                .iter()
                .all(|p| distance(*p, line[from], line[to + 1]) <= tolerance(p))
        {
            to += 1;
        }
        kept.push(line[to]);
        from = to;
    }
    kept
}

/// Distance of a point from a line segment, metres.
fn distance(p: Vector, a: Vector, b: Vector) -> f64 {
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
        let kept = simplified(&circle, |_| 0.01);
        assert!(kept.len() < 30 && kept.len() > 15, "{}", kept.len());
        assert_eq!((kept[0], kept[kept.len() - 1]), (circle[0], circle[200]));
        for p in &circle {
            let least = kept.windows(2).map(|w| distance(*p, w[0], w[1]));
            assert!(least.fold(f64::INFINITY, f64::min) <= 0.01);
        }
        assert_eq!(simplified(&circle, |_| 0.0).len(), circle.len());
        let far = simplified(&circle, |p| if p.x > 0.0 { 0.0 } else { 2.0 });
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
        assert_eq!(simplified(&line, |_| 0.1), line);
        assert_eq!(simplified(&line[..1], |_| 0.1), line[..1]);
        assert!(simplified(&[], |_| 0.1).is_empty());
    }
}
