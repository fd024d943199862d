use super::*;
use rand::{Rng, SeedableRng};

fn turning_ship(rng: &mut rand_chacha::ChaCha8Rng) -> ShipTrack {
    ShipTrack {
        speed_spread: rng.random_range(0.0..3.0),
        course_spread: rng.random_range(0.0..1.0),
        // a third of them turn to either side
        starboard_turn: [0.0, 1.0, -1.0][rng.random_range(0..3)] * rng.random_range(0.0..1.0),
        ..ShipTrack::exact(
            Pose::new(Vector::zeros(), rng.random_range(-3.0..3.0)),
            rng.random_range(0.0..10.0),
            Hull::new(50.0, 10.0),
        )
    }
}

#[test]
fn a_ship_that_turns_stays_within_the_set_of_the_moment() {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(4);
    for _ in 0..200 {
        let ship = ShipTrack {
            course_spread: rng.random_range(0.0..3.5),
            ..turning_ship(&mut rng)
        };
        // a third of them do not turn: one set
        let rate = rng.random_range(-0.025_f64..0.05).max(0.0);
        let horizon = rng.random_range(1.0..400.0);
        let sets = ship.outer_velocity_sets(rate, horizon);
        assert!(sets.windows(2).all(|w| w[0].until < w[1].until));
        for _ in 0..100 {
            let t = rng.random_range(0.0..500.0);
            let turned = ship.course_spread + rate * t;
            let [starboard, port] = [1.0, -1.0].map(|s| (s * ship.starboard_turn).max(0.0));
            let off = rng.random_range(-turned - starboard..=turned + port);
            let course = ship.pose.heading + off;
            let speed = (ship.speed + rng.random_range(-1.0..=1.0) * ship.speed_spread).max(0.0);
            let now = sets.iter().find(|s| t <= s.until).expect("a last one");
            let v = direction(course) * speed;
            let now = now.velocities.as_polygon().expect("a polygon");
            assert!(now.signed_distance(v) <= 1e-9, "{ship:?} {t}");
            if t < horizon {
                let half = ship.course_half_width() + rate * t;
                let widest = ship.outer_velocities_within(half + TURN_PER_INTERVAL + 1e-9);
                for v in now.vertices() {
                    assert!(widest.signed_distance(*v) <= 0.005 * v.norm() + 1e-9);
                }
            }
        }
    }
    let ship = turning_ship(&mut rng);
    assert_eq!(ship.outer_velocity_sets(0.0, 100.0).len(), 1);
    for rate in [f64::NAN, f64::INFINITY] {
        let all = ship.outer_velocity_sets(rate, 100.0);
        assert_eq!(all.len(), 1);
        assert!(all[0].velocities.support(-ship.pose.ahead()) >= ship.speed);
    }
}

/// The sets of a ship that turns share their normals, so their sums have few corners: two for
/// each 5° of turn to either side, and those of the sets that hold every course.
#[test]
fn sums_of_the_sets_of_a_turning_ship_stay_small() {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(11);
    for _ in 0..50 {
        let ship = ShipTrack {
            course_spread: rng.random_range(0.0..0.6),
            starboard_turn: 0.0,
            ..turning_ship(&mut rng)
        };
        let mut sum = ConvexPolygon::point(Vector::zeros());
        for set in ship.outer_velocity_sets(0.005, 700.0) {
            let set = set.velocities.outer_polygon(DISC_SIDES);
            sum = sum.minkowski_sum(&set.scaled(10.0));
        }
        assert!(sum.vertices().len() <= 160, "{}", sum.vertices().len());
    }
}

/// Places and speeds of a route of up to four legs, its first along the ship's course.
fn routed_ship(rng: &mut rand_chacha::ChaCha8Rng) -> ShipTrack {
    let ship = ShipTrack {
        speed_spread: rng.random_range(0.0..1.0),
        course_spread: rng.random_range(0.0..0.3),
        position_std: rng.random_range(0.0..20.0),
        time_spread: rng.random_range(0.0..20.0),
        ..ShipTrack::exact(
            Pose::new(Vector::new(200.0, -50.0), 0.0),
            5.0,
            Hull::new(rng.random_range(10.0..60.0), 10.0),
        )
    };
    let (mut place, mut heading) = (ship.pose.position, rng.random_range(-3.0..3.0));
    let legs = (0..rng.random_range(1..5)).map(|_| {
        place += direction(heading) * rng.random_range(100.0..800.0);
        heading += rng.random_range(-2.0..2.0);
        KnownLeg {
            to: place,
            speed: rng.random_range(2.0..8.0),
        }
    });
    let legs = legs.collect();
    ship.with_route(legs)
}

#[test]
fn the_nominal_motion_of_a_route_passes_its_places_in_time() {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(8);
    for _ in 0..100 {
        let ship = routed_ship(&mut rng);
        let (mut place, mut time) = (ship.pose.position, 0.0);
        assert_eq!(ship.pose_at(-1.0).position, place - ship.velocity());
        for leg in &ship.route {
            let way = leg.to - place;
            let middle = ship.nominal_at(time + 0.5 * way.norm() / leg.speed);
            assert!((middle.0.position - place - way * 0.5).norm() < 1e-6);
            assert!((middle.0.ahead() - way.normalize()).norm() < 1e-9);
            assert_eq!(middle.1, leg.speed);
            (place, time) = (leg.to, time + way.norm() / leg.speed);
            assert!((ship.pose_at(time).position - place).norm() < 1e-6);
        }
        let on = ship.nominal_at(time + 10.0);
        assert!((on.0.position - place - on.0.ahead() * (10.0 * on.1)).norm() < 1e-6);
    }
}

/// Ships that keep to the assumption, each with a speed and an error of course of its own that
/// change at random, and turns on a radius of its own. Their places and hulls are in the sets.
#[test]
fn a_ship_on_its_route_stays_within_its_sets() {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(9);
    let mut turned = 0;
    for _ in 0..300 {
        let ship = routed_ship(&mut rng);
        let sets = ship.outer_velocity_sets(0.0, 600.0);
        assert!(sets.windows(2).all(|w| w[0].until < w[1].until));
        let places = ship.outer_positions().translated(ship.pose.position);
        let sets = Uncertainty::new(places, sets);
        let hull = ship.outer_hull(600.0).translated(-ship.pose.position);
        let radius = rng.random_range(0.0..TURN_LENGTHS) * ship.hull.length;
        // it begins ahead or astern of the estimate, and turns early or late
        let off = rng.random_range(-1.0..=1.0) * SIGMAS * ship.position_std;
        let early = rng.random_range(-1.0..=1.0) * ship.time_spread;
        let (mut place, mut leg) = (ship.pose.position + ship.pose.ahead() * off, 0);
        let mut made_good = off + ship.speed * early;
        let (mut speed, mut error, mut since) = (0.0, 0.0, f64::INFINITY);
        let starts: Vec<Vector> = std::iter::once(ship.pose.position)
            .chain(ship.route.iter().map(|l| l.to))
            .collect();
        let ways: Vec<Vector> = starts.windows(2).map(|w| w[1] - w[0]).collect();
        let step = 0.25;
        for k in 0..2400 {
            if since >= 20.0 {
                speed = rng.random_range(-1.0..=1.0) * ship.speed_spread;
                error = rng.random_range(-1.0..=1.0) * ship.course_spread;
                since = 0.0;
            }
            since += step;
            let length = ways[leg].norm();
            let mut course = heading_of(ways[leg]);
            let mut own = ship.route[leg].speed;
            // a turn on an arc that fits: it begins before the place and ends after it
            if let Some(next) = ways.get(leg + 1) {
                let turn = wrap(heading_of(*next) - course);
                let room = 0.5 * length.min(next.norm());
                let ahead = (radius * (0.5 * turn.abs()).tan()).min(room);
                let arc = ahead / (0.5 * turn.abs()).tan() * turn.abs();
                let over = made_good - (length - ahead);
                if over >= arc {
                    (leg, made_good) = (leg + 1, ahead + (over - arc));
                    turned += 1;
                    course = heading_of(*next);
                    own = ship.route[leg].speed;
                } else if over > 0.0 {
                    course += turn * over / arc;
                }
            }
            let now = (own + speed).max(0.0);
            place += direction(course + error) * (now * step);
            made_good += now * error.cos() * step;
            let time = step * f64::from(k + 1);
            let reached = sets.outer_section(time);
            // a step over a joint of the legs
            assert!(
                reached.signed_distance(place) <= 10.0 * step,
                "{ship:?} {time}"
            );
            let lies = ship
                .hull
                .polygon(&Pose::new(Vector::zeros(), course + error));
            assert!(
                lies.vertices()
                    .iter()
                    .all(|p| hull.signed_distance(*p) < 1e-9)
            );
        }
    }
    assert!(turned > 300, "{turned}");
}

/// A tanker, a ferry and a raft: at every possible heading the hull is inside the outer hull, which
/// is only slightly larger.
#[test]
fn the_outer_hull_holds_the_hull_on_every_heading() {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(6);
    for case in 0..400 {
        let mut ship = turning_ship(&mut rng);
        ship.pose.position = Vector::new(rng.random_range(-1e2..1e2), 50.0);
        ship.hull.length = 10.0_f64.powf(rng.random_range(0.0..3.0));
        ship.hull.beam = ship.hull.length * rng.random_range(0.01..1.2);
        // from nearly none to every heading
        ship.course_spread = match case % 4 {
            0 => 10.0_f64.powf(rng.random_range(-12.0..-3.0)),
            _ => rng.random_range(0.0..1.0),
        };
        ship.turn_rate = [0.0, 0.003, 0.1][case % 3];
        let time = rng.random_range(0.0..100.0);
        let hull = ship.outer_hull(time);
        let spread = ship.course_spread + ship.turn_rate * time;
        let turned = |turn: f64| {
            let pose = Pose::new(ship.pose.position, ship.pose.heading + turn);
            ship.hull.polygon(&pose)
        };
        let mut all = Vec::new();
        for k in 0..=200 {
            let [starboard, port] = [1.0, -1.0].map(|s| (s * ship.starboard_turn).max(0.0));
            let share = f64::from(k) / 200.0;
            let heading = turned((spread + port) * (1.0 - share) - (spread + starboard) * share);
            all.extend_from_slice(heading.vertices());
        }
        assert!(all.iter().all(|p| hull.signed_distance(*p) < 1e-9));
        let swept = ConvexPolygon::hull(&all).expect("finite");
        let excess = hull.vertices().iter().map(|p| swept.signed_distance(*p));
        let excess = excess.fold(0.0, f64::max) / ship.hull.half_diagonal();
        assert!(excess < 0.021, "{excess} {ship:?}");
        let around = searoom_geometry::outer_disc(40.0, ship.middle_course());
        assert!(hull.minkowski_sum(&around).vertices().len() <= DISC_SIDES);
    }
    // headings apart from the courses: a ship that drifts to any side lies in one direction, for ever
    let mut lying = turning_ship(&mut rng);
    (lying.course_spread, lying.turn_rate) = (std::f64::consts::PI, 0.0);
    lying.heading_spread = Some(0.1);
    assert_eq!(lying.headings(f64::INFINITY), (lying.pose.heading, 0.1));
    lying.turn_rate = 0.01;
    assert_eq!(lying.headings(20.0).1, 0.1 + 0.2);
    assert_eq!(lying.headings(f64::INFINITY).1, std::f64::consts::PI);
    lying.heading_spread = Some(f64::NAN);
    assert_eq!(lying.headings(0.0).1, std::f64::consts::PI);
    let mut known = turning_ship(&mut rng);
    (known.course_spread, known.starboard_turn) = (0.0, 0.0);
    assert_eq!(known.outer_hull(100.0), known.hull.polygon(&known.pose));
    known.speed_spread = 0.0;
    assert_eq!(known.outer_velocity_set().vertices().len(), 1);
}
