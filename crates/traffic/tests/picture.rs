//! The picture: whether its sets hold every ship that moves within the stated bounds, and whose fix is whose.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom_geometry::frame::{Geographic, Georeference, Pose, Vector, direction, wrap};
use searoom_traffic::{
    Directions, Fix, HullSet, Identity, Interval, Kind, Note, Notes, Picture, PictureSettings,
    PositionSet, Reach, Report, Ship, Taken, VelocitySet,
};

const HERE: Geographic = Geographic {
    lat_deg: 59.0,
    lon_deg: 179.99,
};

fn plane() -> Georeference {
    Georeference::new(HERE).expect("on the earth")
}

fn exactly(number: f64) -> Interval {
    Interval::new(number, number)
}

fn report(number: u32, time: f64, at: Geographic, velocity: VelocitySet) -> Report {
    Report {
        received: time,
        source: None,
        identity: Identity::Mmsi(number),
        kind: Kind::ClassA,
        is_own: false,
        fix: Some(Fix {
            time: exactly(time),
            position: Some(PositionSet {
                at,
                half_cell_m: Vector::new(0.1, 0.1),
                radius_m: 10.0,
            }),
            velocity,
            heading: Directions::ALL,
            turn_rate: None,
        }),
        hull: None,
        status: None,
        name: None,
        call_sign: None,
        type_code: None,
        mother_ship: None,
        notes: Notes::default(),
    }
}

fn steaming(speed: f64, course: f64) -> VelocitySet {
    VelocitySet {
        speed: Interval::new(speed - 0.1, speed + 0.1),
        course: Directions {
            middle: course,
            half: 0.05,
        },
    }
}

fn resting() -> VelocitySet {
    VelocitySet {
        speed: Interval::new(0.0, 0.05),
        course: Directions::ALL,
    }
}

fn only(picture: &Picture, time: f64) -> Ship {
    let view = picture.at(time, &plane(), Reach::ALL);
    assert_eq!(view.ships.len(), 1, "{:?}", view.listed);
    view.ships.into_iter().next().expect("one")
}

/// True where the sets of a ship hold its middle and its velocity.
fn holds(ship: &Ship, place: Vector, heading: f64) -> bool {
    let track = ship.track().expect("a tracked ship");
    let places = track.kept_positions.as_ref().expect("a polygon");
    let turned = wrap(heading - track.pose.heading).abs();
    places.signed_distance(place - track.pose.position) <= 1e-6
        && turned <= track.heading_spread.expect("a spread") + 1e-9
}

/// Ships that begin anywhere in their report's sets and accelerate to any side within the bound, of every
/// age up to a minute: the hull's middle is in the set, wherever the antenna is.
#[test]
fn every_motion_within_the_bounds_is_in_the_set() {
    let mut rng = ChaCha8Rng::seed_from_u64(59);
    let settings = PictureSettings::default();
    let plane = plane();
    let mut touched = 0.0_f64;
    for case in 0..2000 {
        let at = plane.to_geographic(Vector::new(
            rng.random_range(-20e3..20e3),
            rng.random_range(-20e3..20e3),
        ));
        // north on the plane is not north there
        let north = plane.to_plane(Geographic {
            lat_deg: at.lat_deg + 1e-4,
            ..at
        }) - plane.to_plane(at);
        let north = north.normalize();
        let on_plane = |heading: f64| {
            let east = Vector::new(north.y, -north.x);
            let ahead = direction(heading);
            east * ahead.x + north * ahead.y
        };
        let (speed, course) = (rng.random_range(1.0..12.0), rng.random_range(-3.0..3.0));
        let velocity = steaming(speed, course);
        let heading = course + rng.random_range(-0.1..0.1);
        let sides: [f64; 4] = std::array::from_fn(|_| rng.random_range(1.0..150.0));
        let [ahead, astern, port, starboard] = sides;
        let mut report = report(1, 1000.0, at, velocity);
        let fix = report.fix.as_mut().expect("a fix");
        fix.time = Interval::new(999.0, 1000.0);
        fix.heading = Directions {
            middle: heading,
            half: 0.04,
        };
        report.hull = Some(HullSet {
            length: exactly(ahead + astern),
            beam: exactly(port + starboard),
            ahead: exactly(ahead),
            astern: exactly(astern),
            port: exactly(port),
            starboard: exactly(starboard),
        });
        let mut picture = Picture::new(settings.clone());
        assert_eq!(picture.take(&report, 1000.0), Taken::Fix);
        // a motion of the antenna
        let corner = |rng: &mut ChaCha8Rng| if rng.random() { 1.0 } else { -1.0 };
        let off = direction(rng.random_range(-3.2..3.2)) * 10.0;
        let off = off + Vector::new(corner(&mut rng) * 0.1, corner(&mut rng) * 0.1);
        let mut place = plane.to_plane(at) + off.x * on_plane(0.0) + off.y * north;
        let u = speed + rng.random_range(-0.1..0.1);
        let mut v = on_plane(course + rng.random_range(-0.05..0.05)) * u;
        let begun = rng.random_range(999.0..1000.0);
        let until = 1000.0 + f64::from(case % 60);
        let push = direction(rng.random_range(-3.2..3.2)) * 0.2;
        let steps = 50;
        let dt = (until - begun) / f64::from(steps);
        for _ in 0..steps {
            place += v * dt + push * (0.5 * dt * dt);
            v += push * dt;
        }
        if v.norm() > settings.fastest_mps[0] {
            continue;
        }
        let lies = on_plane(heading + rng.random_range(-0.04..0.04));
        let lies = lies.y.atan2(lies.x);
        let hull = Pose::new(place, lies);
        let middle = Vector::new(0.5 * (ahead - astern), 0.5 * (port - starboard));
        let middle = hull.world_coordinates(middle);
        let ship = only(&picture, until);
        assert!(holds(&ship, middle, lies), "case {case}");
        let track = ship.track().expect("a ship");
        let places = track.kept_positions.as_ref().expect("places");
        touched = touched.max(places.signed_distance(middle - track.pose.position));
    }
    // the set is no larger than it has to be
    assert!(touched > -5.0, "{touched}");
}

#[test]
fn two_ships_with_one_number_are_two_tracks() {
    let mut picture = Picture::new(PictureSettings::default());
    let there = plane().to_geographic(Vector::new(9000.0, 0.0));
    let there_later = plane().to_geographic(Vector::new(9050.0, 0.0));
    assert_eq!(
        picture.take(&report(7, 0.0, HERE, steaming(5.0, 0.0)), 0.0),
        Taken::Fix
    );
    assert_eq!(
        picture.take(&report(7, 5.0, there, steaming(5.0, 0.0)), 5.0),
        Taken::SecondPlace
    );
    let here_later = plane().to_geographic(Vector::new(50.0, 0.0));
    assert_eq!(
        picture.take(&report(7, 10.0, here_later, steaming(5.0, 0.0)), 10.0),
        Taken::Fix
    );
    assert_eq!(
        picture.take(&report(7, 15.0, there_later, steaming(5.0, 0.0)), 15.0),
        Taken::Fix
    );
    let view = picture.at(16.0, &plane(), Reach::ALL);
    let east = |ship: &Ship| ship.track().expect("a ship").pose.position.x;
    let places: Vec<f64> = view.ships.iter().map(east).collect();
    assert!(
        places.len() == 2 && places[0] < 200.0 && places[1] > 8900.0,
        "{places:?}"
    );
    let names: Vec<&str> = view
        .ships
        .iter()
        .map(|ship| ship.target.name.as_str())
        .collect();
    assert_ne!(names[0], names[1]);
}

/// A ship at anchor that reports every three minutes, and another one with its number that reports often:
/// each fix is the nearer one's, though the ship at anchor could have come from farther.
#[test]
fn a_fix_is_that_of_the_nearest_track() {
    let mut picture = Picture::new(PictureSettings::default());
    let at = |east: f64| plane().to_geographic(Vector::new(east, 0.0));
    picture.take(&report(7, 0.0, at(0.0), resting()), 0.0);
    picture.take(&report(7, 5.0, at(5000.0), resting()), 5.0);
    for step in 1..30 {
        let time = 5.0 + 10.0 * f64::from(step);
        assert_eq!(
            picture.take(&report(7, time, at(5000.0), resting()), time),
            Taken::Fix
        );
    }
    let east = |ship: &Ship| ship.track().expect("a ship").pose.position.x;
    let view = picture.at(300.0, &plane(), Reach::ALL);
    let places: Vec<f64> = view.ships.iter().map(east).collect();
    assert!(
        places[0].abs() < 1.0 && (places[1] - 5000.0).abs() < 1.0,
        "{places:?}"
    );
}

/// Bearing and closest approach follow from where a ship is by its course and speed, however old its fix.
#[test]
fn a_ship_is_where_its_course_leads() {
    let mut picture = Picture::new(PictureSettings::default());
    picture.take(&report(7, 0.0, HERE, steaming(5.0, 0.0)), 0.0);
    for time in [0.0, 10.0, 60.0, 240.0] {
        let ship = only(&picture, time);
        let off = ship.track().expect("a ship").pose.position - Vector::new(5.0 * time, 0.0);
        assert!(off.norm() < 1.0, "{time}: {off}");
    }
}

/// A static message whose number is that of an aircraft makes no aircraft of a ship that has a place.
#[test]
fn a_ship_stays_a_ship() {
    let mut picture = Picture::new(PictureSettings::default());
    picture.take(&report(111_234_567, 0.0, HERE, steaming(5.0, 0.0)), 0.0);
    let mut named = report(111_234_567, 1.0, HERE, steaming(5.0, 0.0));
    (named.kind, named.fix) = (Kind::Aircraft, None);
    picture.take(&named, 1.0);
    assert_eq!(only(&picture, 2.0).kind, Kind::ClassA);
    // beyond the plane it is listed, and not too far to matter
    let far = Georeference::new(Geographic {
        lat_deg: 57.0,
        ..HERE
    })
    .expect("on the earth");
    let view = picture.at(2.0, &far, Reach::ALL);
    assert!(view.ships.is_empty() && view.beyond == 0 && view.listed.len() == 1);
}

/// North on the plane is not north 100 km east of its origin.
#[test]
fn courses_are_turned_to_the_plane() {
    let origin = Geographic {
        lat_deg: 70.0,
        lon_deg: 10.0,
    };
    let plane = Georeference::new(origin).expect("on the earth");
    let at = plane.to_geographic(Vector::new(100e3, 0.0));
    let ahead = Geographic {
        lat_deg: at.lat_deg + 1e-3,
        ..at
    };
    let north = plane.to_plane(ahead) - plane.to_plane(at);
    let mut picture = Picture::new(PictureSettings::default());
    picture.take(
        &report(7, 0.0, at, steaming(5.0, std::f64::consts::FRAC_PI_2)),
        0.0,
    );
    let view = picture.at(0.0, &plane, Reach::ALL);
    let course = view.ships[0].track().expect("a ship").pose.heading;
    assert!((course - north.y.atan2(north.x)).abs() < 1e-4);
    assert!((course - std::f64::consts::FRAC_PI_2).abs() > 0.04);
}

/// 60 m east of here the longitude is beyond 180°.
#[test]
fn a_ship_crosses_the_date_line() {
    let mut picture = Picture::new(PictureSettings::default());
    for step in 0..100 {
        let time = 10.0 * f64::from(step);
        let at = plane().to_geographic(Vector::new(10.0 * time, 0.0));
        assert_eq!(
            picture.take(&report(7, time, at, steaming(10.0, 0.0)), time),
            Taken::Fix
        );
    }
    let ship = only(&picture, 990.0);
    assert!((ship.track().expect("a ship").pose.position - Vector::new(9900.0, 0.0)).norm() < 20.0);
}

#[test]
fn long_range_fixes_count_where_nothing_finer_is_fresh() {
    let mut picture = Picture::new(PictureSettings::default());
    let coarse = |time: f64| {
        let mut report = report(7, time, HERE, resting());
        report.kind = Kind::Ship;
        let fix = report.fix.as_mut().expect("a fix");
        fix.position.as_mut().expect("a place").half_cell_m = Vector::new(50.0, 93.0);
        report
    };
    assert_eq!(picture.take(&coarse(0.0), 0.0), Taken::Fix);
    assert_eq!(
        picture.take(&report(7, 10.0, HERE, resting()), 10.0),
        Taken::Fix
    );
    assert_eq!(picture.take(&coarse(100.0), 100.0), Taken::Coarse);
    assert_eq!(picture.take(&coarse(189.0), 189.0), Taken::Coarse);
    assert_eq!(picture.take(&coarse(190.0), 190.0), Taken::Fix);
}

#[test]
fn old_and_repeated_fixes_are_left_out() {
    let mut picture = Picture::new(PictureSettings::default());
    let taken = [10.0, 20.0, 20.0, 15.0, 21.0]
        .map(|time| picture.take(&report(7, time, HERE, resting()), 30.0));
    assert_eq!(
        taken,
        [
            Taken::Fix,
            Taken::Fix,
            Taken::NotNewer,
            Taken::NotNewer,
            Taken::Fix
        ]
    );
}

/// A fix that a wrong clock dates ahead may be a minute old, so the set of a ship that moves is wider.
#[test]
fn a_fix_from_the_future_is_widened() {
    let reach = |ahead: f64| {
        let mut picture = Picture::new(PictureSettings::default());
        picture.take(&report(7, 1000.0 + ahead, HERE, steaming(5.0, 0.0)), 1000.0);
        let ship = only(&picture, 1000.0);
        ship.track()
            .expect("a ship")
            .kept_positions
            .as_ref()
            .expect("places")
            .reach()
    };
    assert!(
        reach(3600.0) > reach(0.0) + 100.0,
        "{} {}",
        reach(3600.0),
        reach(0.0)
    );
    assert_eq!(reach(1.0), reach(0.0));
}

#[test]
fn own_ship_is_never_a_target() {
    let mut picture = Picture::new(PictureSettings::default());
    let mut own = report(1, 0.0, HERE, steaming(5.0, 0.5));
    own.is_own = true;
    assert_eq!(picture.take(&own, 0.0), Taken::Own);
    own.is_own = false;
    assert_eq!(picture.take(&own, 0.0), Taken::Echo);
    own.is_own = true;
    own.identity = Identity::Mmsi(2);
    // another ship, whatever it says: in doubt a target
    assert_eq!(picture.take(&own, 0.0), Taken::Fix);
    assert_eq!(picture.own_identities().len(), 2);
    let view = picture.at(1.0, &plane(), Reach::ALL);
    assert_eq!(view.ships.len(), 1);
    let known = view.own.expect("own ship");
    assert!((known.pose.position - direction(0.5) * 5.0).norm() < 0.1 && known.radius_m > 10.0);
    assert!(picture.at(11.0, &plane(), Reach::ALL).own.is_none());

    // another ship with own ship's number is far off
    let far = plane().to_geographic(Vector::new(9000.0, 0.0));
    assert_eq!(
        picture.take(&report(1, 1.0, far, steaming(5.0, 0.0)), 1.0),
        Taken::Fix
    );

    // without its own sentences, by the number that is asked for
    let given = PictureSettings {
        own: Some(Identity::Mmsi(1)),
        ..PictureSettings::default()
    };
    let mut picture = Picture::new(given);
    assert_eq!(
        picture.take(&report(1, 0.0, HERE, steaming(5.0, 0.5)), 0.0),
        Taken::Own
    );
    assert!(picture.at(1.0, &plane(), Reach::ALL).own.is_some());
}

/// What own ship does not know of its own place is beside every other ship's.
#[test]
fn the_error_of_own_ship_is_added() {
    let reach = |radius: f64| {
        let mut picture = Picture::new(PictureSettings::default());
        let mut own = report(1, 0.0, HERE, steaming(5.0, 0.5));
        own.is_own = true;
        own.fix
            .as_mut()
            .expect("a fix")
            .position
            .as_mut()
            .expect("a place")
            .radius_m = radius;
        picture.take(&own, 0.0);
        picture.take(&report(7, 0.0, HERE, steaming(5.0, 0.0)), 0.0);
        let ship = only(&picture, 0.0);
        ship.track()
            .expect("a ship")
            .kept_positions
            .as_ref()
            .expect("places")
            .reach()
    };
    let more = reach(110.0) - reach(10.0);
    assert!((100.0..103.0).contains(&more), "{more}");
}

#[test]
fn silent_ships_are_listed_then_forgotten_with_a_count() {
    let settings = PictureSettings::default();
    let mut picture = Picture::new(settings.clone());
    picture.take(&report(7, 0.0, HERE, steaming(5.0, 0.0)), 0.0);
    let view = |picture: &Picture, time: f64| picture.at(time, &plane(), Reach::ALL);
    assert_eq!(view(&picture, settings.stale_s).ships.len(), 1);
    let stale = view(&picture, settings.stale_s + 1.0);
    assert!(stale.ships.is_empty() && stale.listed.len() == 1 && stale.listed[0].silent_s == 361.0);
    for time in [1800.0, 3599.0, 3700.0] {
        picture.take(&report(8, time, HERE, steaming(5.0, 0.0)), time);
    }
    assert_eq!((picture.ships(), picture.forgotten()), (1, [1, 0]));

    let mut without = report(9, 3700.0, HERE, steaming(5.0, 0.0));
    without.fix.as_mut().expect("a fix").position = None;
    assert_eq!(picture.take(&without, 3700.0), Taken::WithoutPlace);
    let listed = view(&picture, 3700.0).listed;
    assert_eq!(
        listed.iter().map(|ship| ship.why).collect::<Vec<_>>(),
        ["heard without a place"]
    );
}

#[test]
fn memory_is_bounded_and_old_distant_ships_leave_first() {
    let settings = PictureSettings {
        most_ships: 100,
        ..PictureSettings::default()
    };
    let mut picture = Picture::new(settings);
    let mut own = report(1, 0.0, HERE, steaming(5.0, 0.5));
    own.is_own = true;
    picture.take(&own, 0.0);
    for number in 0..150 {
        let at = plane().to_geographic(Vector::new(100.0 * f64::from(150 - number), 0.0));
        picture.take(&report(1000 + number, 0.0, at, steaming(5.0, 0.0)), 0.0);
    }
    assert!(picture.ships() <= 100 && picture.forgotten()[1] >= 50);
    let view = picture.at(1.0, &plane(), Reach::ALL);
    let farthest = view
        .ships
        .iter()
        .map(|ship| ship.track().expect("a ship").pose.position.x);
    assert!(farthest.fold(0.0, f64::max) < 11_000.0);
}

/// A unit that sends zeros for what it does not know is at rest only after some minutes at one place.
#[test]
fn zeros_do_not_make_a_ship_at_rest() {
    let mut picture = Picture::new(PictureSettings::default());
    let zeros = |time: f64, at: Geographic| {
        let mut report = report(7, time, at, VelocitySet::UNKNOWN);
        report.notes.add(Note::ZerosForUnknown);
        report
    };
    let spread =
        |picture: &Picture, time: f64| only(picture, time).track().expect("a ship").speed_spread;
    picture.take(&zeros(0.0, HERE), 0.0);
    assert!(spread(&picture, 0.0) > 12.0);
    picture.take(&zeros(100.0, HERE), 100.0);
    assert!(spread(&picture, 100.0) > 12.0);
    picture.take(&zeros(200.0, HERE), 200.0);
    assert!((0.1..0.11).contains(&spread(&picture, 200.0)));
    assert!(only(&picture, 200.0).is_lying);
    // it was elsewhere: under way
    let off = plane().to_geographic(Vector::new(100.0, 0.0));
    picture.take(&zeros(300.0, off), 300.0);
    assert!(spread(&picture, 300.0) > 12.0);
}

/// A turn that is reported may go on to that side alone.
#[test]
fn a_turn_goes_on_to_its_side() {
    let turning = |least: f64, most: f64| {
        let mut picture = Picture::new(PictureSettings::default());
        let mut report = report(7, 0.0, HERE, steaming(5.0, 0.0));
        report.fix.as_mut().expect("a fix").turn_rate = Some(Interval::new(least, most));
        picture.take(&report, 0.0);
        let ship = only(&picture, 0.0);
        let ship = ship.track().expect("a ship");
        (ship.starboard_turn, ship.course_spread)
    };
    let steady = turning(-1e-6, 1e-6);
    let (to_starboard, spread) = turning(-0.01, -0.009);
    assert!((to_starboard - 0.6).abs() < 1e-9 && spread == steady.1 && steady.0 == 0.0);
    assert!((turning(0.002, f64::INFINITY).0 + std::f64::consts::FRAC_PI_2).abs() < 1e-9);
}
