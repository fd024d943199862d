//! Contacts in space-time against parry's distances and casts.

use parry2d_f64::math::Vector as Point;
use parry2d_f64::query::ShapeCastOptions;
use parry2d_f64::query::details::cast_shapes_support_map_support_map;
use parry2d_f64::shape::SupportMap;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom_geometry::frame::{Pose, Vector, heading_of};
use searoom_geometry::{ConvexPolygon, shortest_between};
use searoom_model::trajectory::Segment;

use crate::PolytopeObstacle;
use crate::contact::{Interval, arc_contacts, line_contact};
use crate::geometry_fixtures::{random_points, random_polygon, random_vector};

/// Units of parry in a metre: it takes two points for one that are nearer than 5e-8 units.
const UNITS: f64 = 1_048_576.0;

fn point(v: Vector) -> Point {
    Point::new(v.x, v.y)
}

/// A convex set given by its farthest point in a direction.
struct Farthest<F>(F);

impl<F: Fn(Vector) -> Vector> SupportMap for Farthest<F> {
    fn local_support_point(&self, direction: Point) -> Point {
        point((self.0)(Vector::new(direction.x, direction.y)) * UNITS)
    }
}

fn farthest(set: &ConvexPolygon) -> impl Fn(Vector) -> Vector {
    let vertices = set.vertices().to_vec();
    move |n| {
        let reach = |p: &&Vector| n.dot(p);
        *(vertices.iter().max_by(|a, b| reach(a).total_cmp(&reach(b)))).expect("a vertex")
    }
}

/// A moving set and how far own ship is from it at a time, by parry: the farthest point of `O_0 + t
/// V` is one of each.
fn gap(initial: &ConvexPolygon, velocity: &ConvexPolygon, own: &Segment, time: f64) -> f64 {
    let (still, moving) = (farthest(initial), farthest(velocity));
    let here = own.pose_at(time).position;
    let section = |n: Vector| still(n) + moving(n) * time;
    let found = shortest_between(section, |_| here, Vector::zeros());
    found.expect("an answer").shortest.norm()
}

/// The times during which own ship is in a moving set are those at which parry finds no distance;
/// and where the set only moves and the way is straight, they begin when its linear cast hits.
#[test]
fn contacts_in_space_time_are_those_of_parry() {
    let mut rng = ChaCha8Rng::seed_from_u64(903);
    let (mut met, mut clear, mut cast) = (0, 0, 0);
    for case in 0..700 {
        let initial = random_polygon(&mut rng, 30.0);
        let velocity = if case % 2 == 0 {
            ConvexPolygon::point(random_points(&mut rng, 1.0)[0])
        } else {
            random_polygon(&mut rng, 0.7)
        };
        let at = random_vector(&mut rng, 300.0);
        let toward = heading_of(initial.centroid() - at);
        let start = Pose::new(at, toward + rng.random_range(-0.6..0.6));
        let mut own = Segment::straight(start, 0.0, 120.0, rng.random_range(0.0..8.0));
        if case % 3 == 0 {
            own.turn_rate = rng.random_range(-0.03..0.03);
        }
        let body = PolytopeObstacle::new("set", initial.clone(), velocity.clone());
        let inside = if own.is_arc() {
            arc_contacts(&body, &own, 0.0)
        } else {
            line_contact(&body, &own, 0.0).into_iter().collect()
        };
        let gap = |time: f64| gap(&initial, &velocity, &own, time);
        for contact in &inside {
            let middle = 0.5 * (contact.start + contact.end);
            let times = [contact.start, middle, contact.end];
            assert!(times.iter().all(|time| gap(*time) < 1e-6), "{contact:?}");
        }
        let far = |time: f64| {
            let off = |c: &Interval| (c.start - time).max(time - c.end);
            inside.iter().map(off).fold(f64::INFINITY, f64::min) > 1e-6
        };
        for time in (0..=240).map(|k| 0.5 * f64::from(k)) {
            assert!(!far(time) || gap(time) > 0.0, "{time} {inside:?}");
        }
        // a little before and after, own ship is outside
        for time in inside.iter().flat_map(|c| [c.start - 1e-3, c.end + 1e-3]) {
            let looked_at = time > own.start_time && time < own.end_time() && far(time);
            assert!(!looked_at || gap(time) > 0.0, "{time} {inside:?}");
        }
        met += usize::from(!inside.is_empty());
        clear += usize::from(inside.is_empty());
        let ([carried], false) = (velocity.vertices(), own.is_arc()) else {
            continue;
        };
        let relative = own.start.ahead() * own.speed - carried;
        let (a, b) = (Farthest(farthest(&initial)), Farthest(|_| at));
        let options = ShapeCastOptions::with_max_time_of_impact(own.duration);
        let (here, way) = (parry2d_f64::math::Pose::identity(), point(relative * UNITS));
        let hit = cast_shapes_support_map_support_map(&here, way, &a, &b, options);
        let theirs = hit.map(|h| h.time_of_impact);
        let ours = inside.first().map(|c| c.start);
        // a graze is a hit for the one and none for the other
        let long = inside.first().is_some_and(|c| c.end - c.start > 1e-3);
        if long {
            cast += 1;
            let off = theirs.zip(ours).map(|(a, b)| (a - b).abs());
            assert!(off.is_some_and(|off| off < 1e-6), "{theirs:?} {ours:?}");
        }
    }
    let enough = met > 200 && clear > 100 && cast > 50;
    assert!(enough, "{met} {clear} {cast}");
}
