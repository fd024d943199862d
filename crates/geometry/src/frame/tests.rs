use super::*;

#[test]
fn courses_and_headings_are_inverse_and_canonical() {
    for (course, heading) in [
        (0.0, PI / 2.0),
        (90.0, 0.0),
        (180.0, -PI / 2.0),
        (270.0, PI),
    ] {
        assert!((heading_from_course_deg(course) - heading).abs() < 1e-15);
        assert!((course_deg_from_heading(heading) - course).abs() < 1e-12);
    }
    for i in 0..720 {
        let course = f64::from(i) * 0.5;
        let back = course_deg_from_heading(heading_from_course_deg(course));
        assert!((back - course).abs() < 1e-9 || (back - course).abs() > 359.999);
        assert!((0.0..360.0).contains(&back));
    }
}

#[test]
fn wrapping_lands_in_its_half_open_interval() {
    for i in -40..40 {
        let a = f64::from(i) * PI / 4.0;
        assert!(wrap(a) > -PI && wrap(a) <= PI);
        assert!((0.0..TAU).contains(&wrap_positive(a)));
    }
    assert!((wrap_positive(-1e-18)).abs() < 1e-15);
    assert!(wrap(f64::NAN).is_nan());
}

#[test]
fn bearings_are_positive_to_starboard() {
    let ship = Pose::new(Vector::new(3.0, 4.0), heading_from_course_deg(0.0));
    let east = relative_bearing(&ship, Vector::new(13.0, 4.0));
    assert!((east - PI / 2.0).abs() < 1e-12);
    let astern = relative_bearing(&ship, Vector::new(3.0, -4.0));
    assert!((astern.abs() - PI).abs() < 1e-12);
}

#[test]
fn body_coordinates_round_trip() {
    let ship = Pose::new(Vector::new(-7.0, 2.0), 0.7);
    let p = Vector::new(12.0, -5.0);
    assert!((ship.world_coordinates(ship.body_coordinates(p)) - p).norm() < 1e-12);
    assert!(
        ship.body_coordinates(ship.position + to_port(ship.ahead()))
            .y
            > 0.99
    );
}

const TRONDHEIM: Geographic = Geographic::new(63.44, 10.399);

#[test]
fn places_and_points_are_inverse() {
    for (lat_deg, lon_deg) in [(0.0, 0.0), (63.44, 10.399), (-45.0, 179.99), (88.9, -120.0)] {
        let earth = Georeference::new(Geographic { lat_deg, lon_deg }).expect("valid");
        assert!(earth.to_plane(earth.origin()).norm() < 1e-8);
        for i in 0..100 {
            let k = f64::from(i);
            let point = Vector::new((k * 1.7).sin(), (k * 0.9).cos()) * (k * 1000.0);
            let back = earth.to_plane(earth.to_geographic(point));
            assert!((back - point).norm() < 1e-6, "{point:?} {back:?}");
        }
    }
    for (lat_deg, lon_deg) in [(89.5, 0.0), (0.0, 181.0), (f64::NAN, 0.0)] {
        assert!(Georeference::new(Geographic { lat_deg, lon_deg }).is_none());
    }
}

/// Geodesics from the origin, computed by another library, end within 0.1 m of the point with their
/// length and bearing on the plane.
#[test]
fn the_plane_keeps_distances_and_bearings_from_the_origin() {
    use geographiclib_rs::{DirectGeodesic, Geodesic, InverseGeodesic};
    let wgs84 = Geodesic::wgs84();
    for lat_deg in [-63.44, -12.0, 0.0, 40.7, 63.44, 78.0] {
        let origin = Geographic::new(lat_deg, 10.399);
        let earth = Georeference::new(origin).expect("valid");
        for i in 0..72 {
            let azimuth = f64::from(i) * 5.0;
            for distance in [10.0, 3_000.0, 30_000.0] {
                let (lat_deg, lon_deg): (f64, f64) =
                    wgs84.direct(origin.lat_deg, origin.lon_deg, azimuth, distance);
                let found = earth.to_plane(Geographic { lat_deg, lon_deg });
                let expected = direction(heading_from_course_deg(azimuth)) * distance;
                assert!((found - expected).norm() < 0.1, "{lat_deg} {azimuth}");
            }
        }
    }
    // along the meridian the projection is exact except for its scale, nearly so between any two
    // points
    let earth = Georeference::new(TRONDHEIM).expect("valid");
    for i in 0..50 {
        let k = f64::from(i);
        let place = |k: f64| {
            Geographic::new(
                63.44 + 0.2 * (k * 0.7).sin(),
                10.399 + 0.4 * (k * 1.1).cos(),
            )
        };
        let (a, b) = (place(k), place(k + 0.3));
        let north = Geographic {
            lon_deg: 10.399,
            ..a
        };
        let length: f64 = wgs84.inverse(63.44, 10.399, north.lat_deg, north.lon_deg);
        let found = earth.to_plane(north);
        assert!((found.norm() - CENTRAL_SCALE * length).abs() < 1e-6 && found.x.abs() < 1e-9);
        let length: f64 = wgs84.inverse(a.lat_deg, a.lon_deg, b.lat_deg, b.lon_deg);
        let found = (earth.to_plane(a) - earth.to_plane(b)).norm();
        assert!((found / length - 1.0).abs() < 1e-5, "{found} {length}");
    }
}
