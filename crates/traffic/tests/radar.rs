//! Radar targets: units, letters, states, and that the true place and velocity are within the sets.

use rand::{Rng, SeedableRng};
use searoom_geometry::frame::{
    Geographic, Georeference, KNOT_MPS, NAUTICAL_MILE_M, Vector, direction, heading_from_course_deg,
};
use searoom_traffic::{
    Directions, Dropped, Identity, Interval, Kind, Note, PositionSet, Reader, RelativeMotion,
    Report, Settings, VelocitySet,
};

/// 2026-11-29 12:00:10 UTC.
const NOW: f64 = 1_795_910_400.0 + 43_210.0;

const OWN: Geographic = Geographic::new(56.5, 3.2);

/// Own ship at its place, with 10 kn to the north-east, heading 045.
const RMC: &str = "GPRMC,120010,A,5630.0000,N,00312.0000,E,10.0,045.0,291126,,,D";
const HDT: &str = "HEHDT,045.0,T";

fn sentence(body: &str) -> String {
    let sum = body.bytes().fold(0, |sum, byte| sum ^ byte);
    format!("${body}*{sum:02X}")
}

struct Feed {
    reader: Reader,
    now: f64,
}

impl Feed {
    fn new(settings: Settings) -> Self {
        Self {
            reader: Reader::new(settings),
            now: NOW,
        }
    }

    /// With own ship's place and heading.
    fn with_own() -> Self {
        let mut feed = Self::new(Settings::default());
        feed.send(RMC);
        feed.send(HDT);
        feed
    }

    fn send(&mut self, body: &str) -> Vec<Report> {
        let mut reports = Vec::new();
        let line = sentence(body);
        self.reader
            .line(line.as_bytes(), self.now, |report| reports.push(report));
        reports
    }

    fn dropped(&self, why: Dropped) -> u64 {
        self.reader.counts().dropped(why)
    }
}

fn target(body: &str) -> Report {
    let mut feed = Feed::with_own();
    let reports = feed.send(body);
    let [report] = &reports[..] else {
        panic!("{body} {reports:?} {}", feed.reader.counts());
    };
    assert!(report.kind == Kind::Radar && !report.is_own);
    report.clone()
}

fn position(body: &str) -> PositionSet {
    target(body).fix.expect("a fix").position.expect("a place")
}

fn velocity(body: &str) -> VelocitySet {
    target(body).fix.expect("a fix").velocity
}

/// Metres to the east and north of own ship.
fn from_own(at: Geographic) -> Vector {
    Georeference::new(OWN).expect("a plane").to_plane(at)
}

fn near(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= 1e-9 * (1.0 + a.abs().min(b.abs()))
}

const TTM: &str = "RATTM,07,4.00,120.0,T,12.0,270.0,T,0.5,10.0,N,,T,,120010.00,A";

#[test]
fn one_letter_is_the_unit_of_distance_and_speed() {
    for (unit, metres, mps) in [
        ("N", NAUTICAL_MILE_M, KNOT_MPS),
        ("K", 1000.0, 1.0 / 3.6),
        ("S", 1609.344, 0.44704),
    ] {
        let body = TTM.replace(",N,", &format!(",{unit},"));
        let there = from_own(position(&body).at);
        let exact = direction(heading_from_course_deg(120.0)) * 4.0 * metres;
        assert!((there - exact).norm() < 5.0, "{unit} {there} {exact}");
        assert!(velocity(&body).speed.contains(12.0 * mps), "{unit}");
        assert!(near(
            0.5 * (velocity(&body).speed.least + velocity(&body).speed.most),
            12.0 * mps
        ));
    }
    for wrong in ["", "M", "NN"] {
        let mut feed = Feed::with_own();
        assert!(
            feed.send(&TTM.replace(",N,", &format!(",{wrong},")))
                .is_empty()
        );
        assert_eq!(feed.dropped(Dropped::Fields), 1, "{wrong}");
    }
}

#[test]
fn a_relative_bearing_is_from_own_heading() {
    let relative = position(&TTM.replace("120.0,T", "075.0,R"));
    let absolute = position(TTM);
    assert!((from_own(relative.at) - from_own(absolute.at)).norm() < 10.0);
    // with the error of the heading
    assert!(relative.half_cell_m.norm() > 1.5 * absolute.half_cell_m.norm());
    // a heading that is gone, or old
    let mut blind = Feed::new(Settings::default());
    blind.send(RMC);
    assert!(blind.send(&TTM.replace("120.0,T", "075.0,R")).is_empty());
    assert_eq!(blind.dropped(Dropped::NoOwnHeading), 1);
    assert_eq!(blind.send(TTM).len(), 1);
    for (age, count) in [(2.9, 1), (3.1, 0)] {
        let mut feed = Feed::with_own();
        feed.now += age;
        assert_eq!(
            feed.send(&TTM.replace("120.0,T", "075.0,R")).len(),
            count,
            "{age}"
        );
        assert_eq!(feed.dropped(Dropped::NoOwnHeading), 1 - count as u64);
    }
    for wrong in ["120.0,", "120.0,M", ",T", "361.0,T"] {
        let mut feed = Feed::with_own();
        assert!(
            feed.send(&TTM.replace("120.0,T", wrong)).is_empty(),
            "{wrong}"
        );
        assert_eq!(feed.dropped(Dropped::Fields), 1, "{wrong}");
    }
    // a heading that is not known serves for none
    let mut feed = Feed::new(Settings::default());
    feed.send(RMC);
    feed.send("HETHS,045.0,V");
    feed.send("HCHDG,045.0,,,,");
    assert!(feed.send(&TTM.replace("120.0,T", "075.0,R")).is_empty());
}

#[test]
fn own_position_serves_for_ten_seconds() {
    let mut none = Feed::new(Settings::default());
    assert!(none.send(TTM).is_empty());
    assert_eq!(none.dropped(Dropped::NoOwnPosition), 1);
    none.send(&RMC.replace(",A,", ",V,"));
    assert!(none.send(TTM).is_empty());
    let fresh = position(TTM);
    for (age, count) in [(9.9, 1), (10.1, 0)] {
        let mut feed = Feed::with_own();
        feed.now += age;
        let reports = feed.send(TTM);
        assert_eq!(reports.len(), count, "{age}");
        if let [report] = &reports[..] {
            // own ship has sailed since
            let set = report.fix.expect("a fix").position.expect("a place");
            assert!(set.radius_m >= fresh.radius_m + 9.9 * 10.0 * KNOT_MPS);
        }
    }
    // own ship's own message of AIS serves as well
    let mut feed = Feed::new(Settings::default());
    let vdo = b"!AIVDO,1,1,,A,13mb9U0P00PRk8fT5nw>4?wj2006,0*46";
    let mut own = None;
    feed.reader.line(vdo, NOW, |report| own = Some(report));
    assert!(own.expect("own ship").is_own);
    assert_eq!(feed.send(TTM).len(), 1);
}

/// The definition: range within 1 % or 30 m, bearing within 1°, heading within its set, own ship within its.
#[test]
fn every_place_that_the_radar_may_mean_is_within_the_set() {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    let settings = Settings::default();
    for round in 0..2000 {
        let range = 0.01 * f64::from(rng.random_range(1..2400_u16));
        let bearing = match round % 3 {
            0 => 90.0 * f64::from(rng.random_range(0..4_u16)),
            _ => 0.1 * f64::from(rng.random_range(0..3600_u16)),
        };
        let heading_error = match round % 2 {
            0 => 0.0,
            _ => settings.heading_error,
        };
        let (letter, from) = if round % 2 == 0 {
            ("T", 0.0)
        } else {
            ("R", 45.0)
        };
        let body = format!("RATTM,07,{range:.2},{bearing:.1},{letter},12.0,270.0,T,,,N,,T,,,A");
        let set = position(&body);
        let part =
            |rng: &mut rand_chacha::ChaCha8Rng| [-1.0, 1.0][usize::from(rng.random_bool(0.5))];
        let metres = range * NAUTICAL_MILE_M;
        let off = (0.01 * metres).max(30.0);
        let there = (metres + off * part(&mut rng)).max(0.0);
        let error = settings.bearing_error + heading_error;
        let heading = heading_from_course_deg(bearing + from) + error * rng.random_range(-1.0..1.0);
        let shift = match round % 5 {
            0 => rng.random_range(-3.1..3.1),
            _ => heading,
        };
        let exact = direction(heading) * there + direction(shift) * (settings.accurate_m + 20.0);
        let outer = set.outer();
        let relative = exact - from_own(set.at);
        assert!(outer.contains(relative * (1.0 - 1e-9)), "{body} {relative}");
        // and no larger than it has to be
        let extent = set.half_cell_m.norm() + set.radius_m;
        assert!(
            extent < 200.0 + 1.5 * off + 1.5 * metres * (error + 0.02),
            "{body} {set:?}"
        );
    }
    // a ring around own ship's mast
    let close = position("RATTM,07,0.01,120.0,T,12.0,270.0,T,,,N,,T,,,A");
    assert!(close.outer().contains(-from_own(close.at)));
}

#[test]
fn a_state_is_a_report_a_place_or_nothing() {
    let tracked = velocity(TTM);
    assert!(tracked.speed.most < 13.0 * KNOT_MPS && tracked.course.half < 0.1);
    assert!(tracked.course.contains(heading_from_course_deg(270.0)));
    for state in ["Q", ""] {
        let body = TTM.replace("N,,T,", &format!("N,,{state},"));
        assert_eq!(velocity(&body), VelocitySet::UNKNOWN, "{body}");
        assert!(target(&body).notes.has(Note::Acquiring));
        assert_eq!(position(&body), position(TTM));
    }
    let mut feed = Feed::with_own();
    assert!(feed.send(&TTM.replace("N,,T,", "N,,L,")).is_empty());
    assert_eq!(feed.dropped(Dropped::Lost), 1);
    assert!(feed.send(&TTM.replace("N,,T,", "N,,X,")).is_empty());
    assert_eq!(feed.dropped(Dropped::Fields), 1);
}

#[test]
fn speed_and_course_of_a_target_have_the_errors_of_a_tracker() {
    let set = velocity(TTM);
    assert!(near(set.speed.least / KNOT_MPS, 11.45) && near(set.speed.most / KNOT_MPS, 12.55));
    assert!(near(set.course.half.to_degrees(), 5.05));
    for (body, note) in [
        (TTM.replace("12.0,270.0,T", ",270.0,T"), Note::NoSpeed),
        (TTM.replace("12.0,270.0,T", "12.0,,T"), Note::NoCourse),
        (TTM.replace("12.0,270.0,T", "1.0,270.0,T"), Note::SlowCourse),
    ] {
        assert_eq!(velocity(&body).course, Directions::ALL, "{body}");
        assert!(target(&body).notes.has(note), "{body}");
    }
    assert!(velocity(&TTM.replace("12.0,270.0,T", "12.0,,T")).speed.most < 13.0 * KNOT_MPS);
    assert_eq!(
        velocity(&TTM.replace("12.0,270.0,T", ",270.0,T")),
        VelocitySet::UNKNOWN
    );
}

/// A target of 12 kn on course 270, as both kinds of radars send it with `R`.
#[test]
fn a_relative_course_is_both_readings_or_the_one_that_is_set() {
    let course =
        |degrees: f64, knots: f64| direction(heading_from_course_deg(degrees)) * (knots * KNOT_MPS);
    let exact = course(270.0, 12.0);
    let moved = exact - course(45.0, 10.0);
    let degrees = (90.0 - moved.y.atan2(moved.x).to_degrees()).rem_euclid(360.0);
    let from_motion = format!("{:.1},{degrees:.1},R", moved.norm() / KNOT_MPS);
    let from_heading = "12.0,225.0,R".to_owned();
    let read = |sent: &str, relative: RelativeMotion, with_own: bool| {
        let settings = Settings {
            relative,
            ..Settings::default()
        };
        let mut feed = Feed::new(settings);
        feed.send(&if with_own {
            RMC.to_owned()
        } else {
            RMC.replace("10.0,045.0", ",")
        });
        feed.send(HDT);
        let reports = feed.send(&TTM.replace("12.0,270.0,T", sent));
        let report = reports.first().expect("a report");
        (report.fix.expect("a fix").velocity, report.notes)
    };
    for (sent, relative, is_set) in [
        (&from_motion, RelativeMotion::Unknown, false),
        (&from_heading, RelativeMotion::Unknown, false),
        (&from_motion, RelativeMotion::FromMotion, true),
        (&from_heading, RelativeMotion::FromHeading, true),
    ] {
        let (set, notes) = read(sent, relative, true);
        let (speed, heading) = (exact.norm(), exact.y.atan2(exact.x));
        assert!(
            set.speed.contains(speed) && set.course.contains(heading),
            "{relative} {set:?}"
        );
        assert_eq!(notes.has(Note::RelativeCourse), !is_set);
        assert!(
            set.speed.most < 40.0 * KNOT_MPS && (set.course.half < 0.3) == is_set,
            "{set:?}"
        );
        // without own ship's motion the union has no bound
        let (blind, _) = read(sent, relative, false);
        assert!(blind.speed.contains(speed) && blind.course.contains(heading));
        let is_known = relative == RelativeMotion::FromHeading;
        assert_eq!(blind.speed.most.is_finite(), is_known, "{relative}");
    }
}

#[test]
fn a_time_of_the_target_dates_it() {
    let time = |body: &str| target(body).fix.expect("a fix").time;
    assert_eq!(time(TTM), Interval::new(NOW, NOW));
    assert_eq!(
        time(&TTM.replace("120010.00", "115958")),
        Interval::new(NOW - 12.0, NOW - 12.0)
    );
    assert_eq!(
        time(&TTM.replace("120010.00", "")),
        Interval::new(NOW - 3.0, NOW)
    );
}

#[test]
fn a_position_of_a_target_has_its_letters() {
    for (letters, lat, lon) in [
        ("N E", 56.5, 3.3),
        ("N W", 56.5, -3.3),
        ("S E", -56.5, 3.3),
        ("S W", -56.5, -3.3),
    ] {
        let (north, east) = letters.split_once(' ').expect("two letters");
        let body = format!("RATLL,12,5630.000,{north},00318.000,{east},TUG,120010.00,T,");
        let report = target(&body);
        let set = position(&body);
        assert!(
            near(set.at.lat_deg, lat) && near(set.at.lon_deg, lon),
            "{set:?}"
        );
        assert_eq!(
            report.identity,
            Identity::Radar {
                source: None,
                number: 12
            }
        );
        assert_eq!(report.name.expect("a name").as_str(), "TUG");
        assert_eq!(velocity(&body), VelocitySet::UNKNOWN);
    }
    let body = "RATLL,12,5630.000,N,00318.000,E,,120010.00,T,";
    // own ship is 3.3 nm away: 1 % and 1° of it, and own ship's error
    assert!(
        (150.0..300.0).contains(&position(body).radius_m),
        "{}",
        position(body).radius_m
    );
    let mut blind = Feed::new(Settings::default());
    let set = blind.send(body)[0]
        .fix
        .expect("a fix")
        .position
        .expect("a place");
    assert!(set.radius_m > 24.0 * NAUTICAL_MILE_M * 0.027);
    assert!(blind.send(&body.replace(",T,", ",L,")).is_empty());
    assert_eq!(blind.dropped(Dropped::Lost), 1);
    assert!(
        target(&body.replace(",T,", ",Q,"))
            .notes
            .has(Note::Acquiring)
    );
    for wrong in [
        body.replace(",N,", ",,"),
        body.replace(",E,", ",N,"),
        body.replace("12,5", "x,5"),
    ] {
        assert!(blind.send(&wrong).is_empty());
    }
    assert_eq!(blind.dropped(Dropped::Fields), 3);
    assert!(
        target(&body.replace("5630.000", ""))
            .notes
            .has(Note::NoPosition)
    );
}

#[test]
fn a_name_goes_with_later_reports_until_the_target_is_lost() {
    let mut feed = Feed::with_own();
    let named = feed.send("RATLB,7,PILOT,8,,9,FERRY\u{1b}[2J\u{202e}");
    let names: Vec<_> = named
        .iter()
        .map(|report| report.name.map(|name| name.as_str().to_owned()))
        .collect();
    assert_eq!(
        names,
        [Some("PILOT".to_owned()), None, Some("FERRY[2J".to_owned())]
    );
    assert!(named.iter().all(|report| report.fix.is_none()));
    let name = |feed: &mut Feed| feed.send(TTM)[0].name.map(|name| name.as_str().to_owned());
    assert_eq!(name(&mut feed).as_deref(), Some("PILOT"));
    feed.send("RATLB,7,");
    assert_eq!(name(&mut feed), None);
    feed.send("RATLB,7,PILOT");
    feed.send(&TTM.replace("N,,T,", "N,,L,"));
    assert_eq!(name(&mut feed), None);
    // bounded
    for number in 0..2000 {
        feed.send(&format!("RATLB,{number},N{number}"));
    }
    assert_eq!(feed.dropped(Dropped::TooManyNames), 1000);
    // two radars have their own numbers
    let line = format!(
        "\\s:r1*{:02X}\\{}",
        "s:r1".bytes().fold(0, |sum, byte| sum ^ byte),
        sentence(TTM)
    );
    let mut other = None;
    feed.reader
        .line(line.as_bytes(), NOW, |report| other = Some(report));
    assert_ne!(
        other.expect("a report").identity,
        feed.send(TTM)[0].identity
    );
}
