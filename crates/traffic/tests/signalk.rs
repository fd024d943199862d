//! Signal K: deltas and the full model, each path of the table in docs/reference/traffic.md.

use std::f64::consts::{FRAC_PI_2, TAU};

use searoom_geometry::frame::KNOT_MPS;
use searoom_traffic::{
    Directions, Dropped, Fix, Identity, Interval, Kind, Note, Reader, Report, Settings, Status,
    VelocitySet,
};
use serde_json::{Value, json};

const SHIP: &str = "vessels.urn:mrn:imo:mmsi:257000001";
const TIME: &str = "2022-01-03T00:00:00.500Z";
const NOW: f64 = 1_641_168_000.5;

struct Feed(Reader);

impl Feed {
    fn new() -> Self {
        Self(Reader::new(Settings::default()))
    }

    fn text(&mut self, text: &str) -> Vec<Report> {
        let mut reports = Vec::new();
        self.0
            .bytes(text.as_bytes(), 0.0, |report| reports.push(report));
        reports
    }

    fn delta(&mut self, context: &str, time: &str, values: &[(&str, Value)]) -> Vec<Report> {
        let values: Vec<Value> = values
            .iter()
            .map(|(path, value)| json!({"path": path, "value": value}))
            .collect();
        let update = json!({"$source": "ais.1", "timestamp": time, "values": values});
        self.text(&format!(
            "{}\n",
            json!({"context": context, "updates": [update]})
        ))
    }

    fn dropped(&self, why: Dropped) -> u64 {
        self.0.counts().dropped(why)
    }
}

/// The report of a ship that sends these values at one time.
fn report(values: &[(&str, Value)]) -> Report {
    let mut feed = Feed::new();
    let reports = feed.delta(SHIP, TIME, values);
    let [report] = &reports[..] else {
        panic!("{values:?} {reports:?} {}", feed.0.counts());
    };
    report.clone()
}

/// A ship of 12 kn on course 090, and these values in place of its own.
fn moving(changed: &[(&str, Value)]) -> Report {
    let mut values = vec![
        (
            "navigation.position",
            json!({"latitude": -56.50001, "longitude": 3.20001}),
        ),
        ("navigation.speedOverGround", json!(12.1 * KNOT_MPS)),
        ("navigation.courseOverGroundTrue", json!(FRAC_PI_2 + 0.0017)),
        ("navigation.headingTrue", json!(FRAC_PI_2)),
    ];
    for (path, value) in changed {
        values.retain(|(other, _)| other != path);
        values.push((path, value.clone()));
    }
    report(&values)
}

fn fix(report: &Report) -> Fix {
    report.fix.expect("a fix")
}

fn near(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= 1e-9 * (1.0 + a.abs().min(b.abs()))
}

#[test]
fn a_delta_is_a_report() {
    let report = moving(&[]);
    let fix = fix(&report);
    let set = fix.position.expect("a place");
    assert_eq!((set.at.lat_deg, set.at.lon_deg), (-56.50001, 3.20001));
    assert!(set.radius_m == 50.0 && set.half_cell_m.norm() < 0.2);
    assert_eq!(report.received, NOW);
    assert_eq!(fix.time, Interval::new(NOW - 5.0, NOW));
    let speed = fix.velocity.speed;
    assert!(near(speed.least / KNOT_MPS, 12.05) && near(speed.most / KNOT_MPS, 12.15));
    assert!(fix.velocity.course.contains(0.0) && fix.velocity.course.half < 0.04);
    assert!(fix.heading.contains(0.0) && fix.heading.half < 0.05);
    assert_eq!(report.identity, Identity::Mmsi(257_000_001));
    assert_eq!((report.kind, report.is_own), (Kind::Ship, false));
    let mut feed = Feed::new();
    let named = feed.delta(SHIP, TIME, &[("", json!({"name": "ALFA"}))]);
    assert_eq!(feed.0.source(named[0].source.expect("a source")), b"ais.1");
    assert_eq!(feed.0.counts().reports, 1);
}

#[test]
fn null_and_what_is_not_sent_are_unknown_and_never_zero() {
    for value in [Value::Null, json!("12"), json!({}), json!([1])] {
        let report = moving(&[("navigation.speedOverGround", value.clone())]);
        assert_eq!(fix(&report).velocity, VelocitySet::UNKNOWN, "{value}");
        assert!(report.notes.has(Note::NoSpeed));
        let report = moving(&[("navigation.courseOverGroundTrue", value.clone())]);
        assert_eq!(fix(&report).velocity.course, Directions::ALL);
        let report = moving(&[
            ("navigation.headingTrue", value.clone()),
            ("navigation.speedOverGround", json!(2.0)),
        ]);
        assert!(fix(&report).heading == Directions::ALL && report.notes.has(Note::NoHeading));
        let report = moving(&[("navigation.position", value.clone())]);
        assert!(fix(&report).position.is_none() && report.notes.has(Note::NoPosition));
        assert_eq!(
            fix(&moving(&[("navigation.rateOfTurn", value)])).turn_rate,
            None
        );
    }
    for position in [
        json!({"latitude": null, "longitude": null}),
        json!({"latitude": 56.5}),
        json!({"latitude": 91.0, "longitude": 181.0}),
        json!({"latitude": 56.5, "longitude": 180.1}),
    ] {
        let report = moving(&[("navigation.position", position.clone())]);
        assert!(
            fix(&report).position.is_none() && report.notes.has(Note::NoPosition),
            "{position}"
        );
    }
    // null takes back what was known
    let mut feed = Feed::new();
    feed.delta(SHIP, TIME, &[("navigation.speedOverGround", json!(5.0))]);
    feed.delta(SHIP, TIME, &[("navigation.speedOverGround", Value::Null)]);
    let report = &feed.delta(
        SHIP,
        TIME,
        &[("navigation.courseOverGroundTrue", json!(1.0))],
    )[0];
    assert_eq!(fix(report).velocity, VelocitySet::UNKNOWN);
    assert_eq!(feed.dropped(Dropped::Value), 0);
    feed.delta(SHIP, TIME, &[("navigation.speedOverGround", json!("5"))]);
    assert_eq!(feed.dropped(Dropped::Value), 1);
}

#[test]
fn codes_that_leaked_are_unknown() {
    let speed = |mps: f64| {
        fix(&moving(&[("navigation.speedOverGround", json!(mps))]))
            .velocity
            .speed
    };
    assert!(speed(52.5).most.is_finite());
    for mps in [
        52.51,
        102.2 * KNOT_MPS,
        102.3 * KNOT_MPS,
        526.3,
        -0.1,
        63.0 * KNOT_MPS,
        32.41,
    ] {
        assert_eq!(speed(mps), Interval::new(0.0, f64::INFINITY), "{mps}");
    }
    for angle in [
        TAU,
        TAU + 1e-5,
        TAU - 1e-5,
        8.92,
        -0.1,
        511_f64.to_radians(),
    ] {
        let course = moving(&[("navigation.courseOverGroundTrue", json!(angle))]);
        assert_eq!(fix(&course).velocity.course, Directions::ALL, "{angle}");
        let heading = moving(&[
            ("navigation.headingTrue", json!(angle)),
            ("navigation.speedOverGround", json!(2.0)),
        ]);
        assert_eq!(fix(&heading).heading, Directions::ALL, "{angle}");
    }
    let north = moving(&[("navigation.headingTrue", json!(359_f64.to_radians()))]);
    assert!(fix(&north).heading.half < 0.05);
    // what may be of the long-range message is in its steps
    let whole = fix(&moving(&[
        ("navigation.speedOverGround", json!(12.0 * KNOT_MPS)),
        (
            "navigation.position",
            json!({"latitude": 56.5, "longitude": 3.2}),
        ),
    ]));
    assert!(near(whole.velocity.speed.most / KNOT_MPS, 12.5));
    assert!((whole.position.expect("a place").half_cell_m.y - 93.0).abs() < 1.0);
    let zeros = report(&[
        ("navigation.speedOverGround", json!(0)),
        ("navigation.courseOverGroundTrue", json!(0)),
    ]);
    assert!(zeros.notes.has(Note::ZerosForUnknown));
    assert_eq!(fix(&zeros).velocity.speed.most, f64::INFINITY);
}

#[test]
fn a_rate_of_turn_has_its_side() {
    let rate = |per_minute: f64| {
        let rate = per_minute.to_radians() / 60.0;
        let set = fix(&moving(&[("navigation.rateOfTurn", json!(rate))])).turn_rate?;
        Some([set.least, set.most].map(|rate| rate.to_degrees() * 60.0))
    };
    // starboard is positive in Signal K, and negative in the plane
    for (sent, side) in [(17.86, -1.0), (-17.86, 1.0)] {
        let [least, most] = rate(sent).expect("a rate");
        assert!(least <= -sent && -sent <= most && least * side > 0.0 && most * side > 0.0);
    }
    let [least, most] = rate(0.0).expect("a rate");
    assert!(least < 0.0 && most > 0.0 && most < 0.1);
    // AIS's codes 126 and 127, and -128 read as a number
    let per_minute = |code: f64| (code / 4.733_f64).powi(2);
    assert_eq!(
        rate(per_minute(126.0)).expect("a rate")[0],
        f64::NEG_INFINITY
    );
    let [least, most] = rate(-per_minute(127.0)).expect("a side");
    assert!(near(least, 10.0) && most == f64::INFINITY);
    assert_eq!(rate(-per_minute(128.0)), None);
    assert_eq!(rate(127.0 * 60.0), None);
}

#[test]
fn a_magnetic_heading_is_no_true_one() {
    let mut feed = Feed::new();
    let reports = feed.delta(SHIP, TIME, &[("navigation.headingMagnetic", json!(1.0))]);
    assert!(reports.is_empty() && feed.dropped(Dropped::Magnetic) == 1);
    let reports = feed.delta(
        SHIP,
        TIME,
        &[
            ("navigation.headingMagnetic", json!(1.0)),
            ("navigation.speedOverGround", json!(2.0)),
        ],
    );
    assert_eq!(fix(&reports[0]).heading, Directions::ALL);
}

#[test]
fn values_of_one_context_join_within_a_few_seconds() {
    let later = |seconds: f64| format!("2022-01-03T00:00:{:06.3}Z", 0.5 + seconds);
    for (seconds, is_joined) in [(0.0, true), (2.9, true), (3.1, false)] {
        let mut feed = Feed::new();
        let speed = feed.delta(SHIP, TIME, &[("navigation.speedOverGround", json!(5.05))]);
        assert!(fix(&speed[0]).position.is_none() && !speed[0].notes.has(Note::NoPosition));
        assert_eq!(fix(&speed[0]).velocity.course, Directions::ALL);
        let course = feed.delta(
            SHIP,
            &later(seconds),
            &[("navigation.courseOverGroundTrue", json!(1.0))],
        );
        let joined = fix(&course[0]);
        assert_eq!(joined.velocity.course.half < 0.1, is_joined, "{seconds}");
        assert_eq!(joined.velocity.speed.most.is_finite(), is_joined);
        // the time covers both
        let least = if is_joined { NOW } else { NOW + seconds };
        assert!(near(joined.time.least, least - 5.0) && near(joined.time.most, NOW + seconds));
        // but not of another ship
        let other = feed.delta(
            "vessels.urn:mrn:imo:mmsi:2",
            TIME,
            &[("navigation.courseOverGroundTrue", json!(1.0))],
        );
        assert_eq!(fix(&other[0]).velocity, VelocitySet::UNKNOWN);
    }
    // a place is in its own report alone
    let mut feed = Feed::new();
    feed.delta(
        SHIP,
        TIME,
        &[(
            "navigation.position",
            json!({"latitude": 56.5, "longitude": 3.2}),
        )],
    );
    let speed = feed.delta(SHIP, TIME, &[("navigation.speedOverGround", json!(5.0))]);
    assert!(fix(&speed[0]).position.is_none());
    // a name alone has no fix
    assert!(
        feed.delta(SHIP, TIME, &[("name", json!("ALFA"))])[0]
            .fix
            .is_none()
    );
}

#[test]
fn own_ship_has_one_identity() {
    let speed = [("navigation.speedOverGround", json!(5.0))];
    let mut feed = Feed::new();
    const UUID: u128 = 0xc0d7_9334_4e25_4245_8892_54e8_ccc8_021d;
    let own = "vessels.urn:mrn:signalk:uuid:c0d79334-4e25-4245-8892-54e8ccc8021d";
    let before = feed.delta(own, TIME, &speed);
    assert_eq!(before[0].identity, Identity::Uuid(UUID.to_be_bytes()));
    let hello =
        json!({"name": "signalk-server", "version": "2.19.0", "self": own, "roles": ["main"]});
    assert!(feed.text(&format!("{hello}\n")).is_empty());
    for context in [own, "vessels.self"] {
        let report = &feed.delta(context, TIME, &speed)[0];
        assert!(
            report.is_own && report.identity == Identity::Own,
            "{context}"
        );
    }
    // a delta without a context is own ship's
    let delta =
        json!({"updates": [{"values": [{"path": "navigation.speedOverGround", "value": 1}]}]});
    let reports = feed.text(&format!("{delta}\n"));
    assert!(reports[0].is_own && reports[0].received == 0.0);
    // the time of its receiver dates the fix
    let dated = feed.delta(
        own,
        TIME,
        &[
            ("navigation.datetime", json!("2022-01-02T23:59:50Z")),
            ("navigation.speedOverGround", json!(5.0)),
        ],
    );
    assert!(near(fix(&dated[0]).time.most, NOW - 10.5) && dated[0].received == NOW);
    assert!(fix(&dated[0]).velocity.speed.most.is_finite());
    assert_eq!(feed.dropped(Dropped::OtherDocument), 0);
}

#[test]
fn contexts_are_identities() {
    let mut feed = Feed::new();
    let place = [(
        "navigation.position",
        json!({"latitude": 56.5, "longitude": 3.2}),
    )];
    for (context, identity, kind) in [
        (SHIP, 257_000_001, Kind::Ship),
        ("atons.urn:mrn:imo:mmsi:992570001", 992_570_001, Kind::Mark),
        (
            "aircraft.urn:mrn:imo:mmsi:111257001",
            111_257_001,
            Kind::Aircraft,
        ),
        (
            "sar.urn:mrn:imo:mmsi:970257001",
            970_257_001,
            Kind::Distress,
        ),
        (
            "vessels.urn:mrn:imo:mmsi:972257001",
            972_257_001,
            Kind::Distress,
        ),
        (
            "vessels.urn:mrn:imo:mmsi:982570001",
            982_570_001,
            Kind::Craft,
        ),
    ] {
        let reports = feed.delta(context, TIME, &place);
        assert_eq!(
            (reports[0].identity, reports[0].kind),
            (Identity::Mmsi(identity), kind)
        );
    }
    let mark = |values: &[(&str, Value)]| {
        let mut values = values.to_vec();
        values.push(place[0].clone());
        Feed::new().delta("atons.urn:mrn:imo:mmsi:992570001", TIME, &values)[0].clone()
    };
    assert_eq!(fix(&mark(&[])).velocity.speed, Interval::new(0.0, 0.0));
    assert_eq!(mark(&[("virtual", json!(true))]).kind, Kind::VirtualMark);
    let off = mark(&[("offPosition", json!(true))]);
    assert!(off.notes.has(Note::OffPosition) && fix(&off).velocity == VelocitySet::UNKNOWN);
    assert_eq!(
        mark(&[("sensors.ais.class", json!("BASE"))]).kind,
        Kind::BaseStation
    );
    // a ship that is known by another number, and says its own
    let uuid = "vessels.urn:mrn:signalk:uuid:c0d79334-4e25-4245-8892-54e8ccc8021d";
    let named = feed.delta(uuid, TIME, &[("", json!({"mmsi": "257000009"}))]);
    assert_eq!(named[0].identity, Identity::Mmsi(257_000_009));
    for (index, context) in [
        "vessels",
        "vessels.urn:mrn:imo:mmsi:",
        "vessels.urn:mrn:imo:mmsi:2570000011",
        "vessels.urn:mrn:imo:mmsi:+2570000",
        "vessels.urn:mrn:signalk:uuid:c0d79334",
        "vessels.http://example.org",
        "meteo.urn:mrn:imo:mmsi:002570001",
    ]
    .into_iter()
    .enumerate()
    {
        assert!(feed.delta(context, TIME, &place).is_empty(), "{context}");
        assert_eq!(feed.dropped(Dropped::Context), index as u64 + 1);
    }
}

#[test]
fn a_size_says_where_the_antenna_is_or_that_it_does_not() {
    let size = |bow: Option<f64>, center: Option<f64>| {
        let mut values = vec![
            ("design.length", json!({"overall": 200.0})),
            ("design.beam", json!(30.0)),
        ];
        values.extend(bow.map(|bow| ("sensors.ais.fromBow", json!(bow))));
        values.extend(center.map(|center| ("sensors.ais.fromCenter", json!(center))));
        let report = report(&values);
        let hull = report.hull.expect("a size");
        let most = [hull.ahead, hull.astern, hull.port, hull.starboard].map(|side| side.most);
        (most, report.notes.has(Note::NoAntenna))
    };
    let nowhere = ([200.5, 200.5, 30.5, 30.5], true);
    // as one server sends A = C = 0, and as another does
    assert_eq!(size(None, Some(-15.0)), nowhere);
    assert_eq!(size(Some(0.0), None), nowhere);
    assert_eq!(size(Some(0.0), Some(15.0)), nowhere);
    assert_eq!(size(None, None), nowhere);
    assert_eq!(
        size(Some(60.0), Some(0.0)),
        ([60.5, 140.5, 15.5, 15.5], false)
    );
    // whichever side it is on
    for center in [5.0, -5.0] {
        assert_eq!(
            size(Some(60.0), Some(center)),
            ([60.5, 140.5, 20.5, 20.5], false)
        );
    }
    assert_eq!(size(Some(60.0), None), ([60.5, 140.5, 30.5, 30.5], true));
    assert_eq!(
        size(Some(0.0), Some(0.0)),
        ([0.5, 200.5, 15.5, 15.5], false)
    );
    // not on the hull
    assert_eq!(size(Some(201.0), Some(0.0)), nowhere);
    assert_eq!(size(Some(60.0), Some(16.0)).0, [60.5, 140.5, 30.5, 30.5]);
    for values in [json!(-200.0), json!({"overall": -200.0}), json!(0)] {
        let values = [("design.length", values), ("design.beam", json!(30.0))];
        assert!(report(&values).notes.has(Note::NoSize), "{values:?}");
    }
    // the size comes in pieces
    let mut feed = Feed::new();
    let long = feed.delta(SHIP, TIME, &[("design.length", json!({"overall": 200}))]);
    assert!(long[0].notes.has(Note::NoSize) && long[0].fix.is_none());
    let whole = feed.delta(SHIP, TIME, &[("design.beam", json!(30))]);
    assert_eq!(whole[0].hull.expect("a size").port.most, 30.5);
    let class_b = report(&[("sensors.ais.class", json!("B")), ("design.beam", json!(4))]);
    assert_eq!(
        (class_b.kind, class_b.hull.expect("a size").ahead.most),
        (Kind::ClassB, 50.0)
    );
    let craft = "vessels.urn:mrn:imo:mmsi:982570001";
    let craft = feed.delta(craft, TIME, &[("design.length", json!({"overall": 283}))]);
    assert!(craft[0].notes.has(Note::NoSize));
}

#[test]
fn names_types_and_states_are_read() {
    let named = report(&[
        (
            "",
            json!({"name": "NORDIC\u{1b}[2J", "communication": {"callsignVhf": "LAXY"}}),
        ),
        ("design.aisShipType", json!({"id": 70, "name": "Cargo"})),
        ("sensors.ais.class", json!("A")),
    ]);
    assert_eq!(named.name.expect("a name").as_str(), "NORDIC[2J");
    assert_eq!(named.call_sign.expect("a call sign").as_str(), "LAXY");
    assert_eq!((named.type_code, named.kind), (Some(70), Kind::ClassA));
    for (state, status) in [
        ("motoring", Some(Status::UnderWay)),
        ("anchored", Some(Status::Anchored)),
        ("not under command", Some(Status::NotUnderCommand)),
        ("restricted manouverability", Some(Status::Restricted)),
        (
            "restricted manouverability towing < 200m",
            Some(Status::Restricted),
        ),
        ("constrained by draft", Some(Status::ConstrainedByDraught)),
        ("moored", Some(Status::Moored)),
        ("aground", Some(Status::Aground)),
        ("fishing", Some(Status::Fishing)),
        ("trawling-hauling", Some(Status::Fishing)),
        ("sailing", Some(Status::Sailing)),
        ("towing > 200m", Some(Status::TowingAstern)),
        ("pushing", Some(Status::Pushing)),
        ("ais-sart", Some(Status::Distress)),
        ("default", None),
        ("", None),
    ] {
        assert_eq!(
            report(&[("navigation.state", json!(state))]).status,
            status,
            "{state}"
        );
    }
    let moored = moving(&[("navigation.state", json!("moored"))]);
    assert!(moored.notes.has(Note::StatusContradictsSpeed));
    assert_eq!(fix(&moored), fix(&moving(&[])));
}

#[test]
fn a_full_model_has_a_time_for_each_value() {
    let leaf =
        |value: Value, time: &str| json!({"value": value, "$source": "a", "timestamp": time});
    let model = json!({
        "version": "1.7.0",
        "self": "vessels.urn:mrn:imo:mmsi:257000005",
        "vessels": {
            "urn:mrn:imo:mmsi:257000005": {
                "name": "OWN",
                "navigation": {"speedOverGround": leaf(json!(4.0), TIME)},
            },
            "urn:mrn:imo:mmsi:257000001": {
                "mmsi": "257000001",
                "name": "ALFA",
                "communication": {"callsignVhf": "LAXY"},
                "navigation": {
                    "position": leaf(json!({"latitude": 56.5, "longitude": 3.2}), TIME),
                    "speedOverGround": leaf(json!(5.05), "2022-01-03T00:00:10Z"),
                    "courseOverGroundTrue": leaf(json!(1.0), "2022-01-03T00:00:11Z"),
                    "headingTrue": leaf(Value::Null, "2022-01-03T00:00:11Z"),
                },
                "design": {
                    "length": leaf(json!({"overall": 30.0}), TIME),
                    "beam": leaf(json!(8.0), TIME),
                },
            },
            "urn:mrn:imo:mmsi:x": {},
        },
        "sources": {},
    });
    let pretty = serde_json::to_string_pretty(&model).expect("a text");
    let mut feed = Feed::new();
    let reports = feed.text(&format!("{pretty}\n"));
    assert_eq!(reports, Feed::new().text(&format!("{model}\n")));
    let own: Vec<&Report> = reports.iter().filter(|report| report.is_own).collect();
    assert_eq!((own.len(), own[0].identity), (1, Identity::Own));
    let others: Vec<&Report> = reports.iter().filter(|report| !report.is_own).collect();
    let [place, motion] = others[..] else {
        panic!("{others:?}");
    };
    // what is ten seconds apart is of two reports
    assert_eq!(place.received, NOW);
    assert!(fix(place).position.is_some() && fix(place).velocity == VelocitySet::UNKNOWN);
    assert_eq!(place.name.expect("a name").as_str(), "ALFA");
    assert_eq!(place.hull.expect("a size").ahead.most, 30.5);
    assert!(near(motion.received, NOW + 10.5) && fix(motion).position.is_none());
    assert!(fix(motion).velocity.course.half < 0.1);
    assert!(near(fix(motion).time.least, NOW + 9.5 - 5.0));
    assert_eq!(feed.dropped(Dropped::Context), 1);
}

#[test]
fn what_is_broken_costs_itself_alone() {
    let values = [json!({"path": "name", "value": "{\"}\\"})];
    let update = json!({"timestamp": TIME, "values": values});
    let delta = json!({"context": SHIP, "updates": [update]}).to_string();
    let pretty = "{\n  \"context\": \"vessels.self\",\n  \"updates\": [\n";
    for (broken, why) in [
        (&delta[..40], Dropped::Document),
        ("{]}", Dropped::Document),
        ("{\"a\": 1e999}", Dropped::Document),
        (pretty, Dropped::Document),
        ("noise", Dropped::Document),
        ("{}", Dropped::OtherDocument),
        (
            "{\"requestId\": 1, \"state\": \"COMPLETED\"}",
            Dropped::OtherDocument,
        ),
    ] {
        let mut feed = Feed::new();
        let reports = feed.text(&format!("{delta}\n{broken}\n{delta}\n"));
        assert_eq!(reports.len(), 2, "{broken} {}", feed.0.counts());
        assert_eq!(feed.dropped(why), 1, "{broken} {}", feed.0.counts());
    }
    // cut off at the end
    let mut feed = Feed::new();
    feed.text(&format!("{delta}\n{}", &delta[..40]));
    feed.0.finish(0.0, |_| {});
    assert_eq!(feed.dropped(Dropped::Document), 1);
    // a document of too many levels, or too long
    feed.text(&format!("{}{}\n", "{\"a\":".repeat(1000), "}".repeat(1000)));
    assert_eq!(feed.dropped(Dropped::Document), 2);
    for _ in 0..10 {
        feed.text(&format!("{{\"a\": \"{}", "a".repeat(1 << 20)));
    }
    assert_eq!(feed.dropped(Dropped::TooLong), 1);
    assert_eq!(feed.text(&format!("\n{delta}\n")).len(), 1);
    // other paths
    let before = feed.dropped(Dropped::Path);
    feed.delta(
        SHIP,
        TIME,
        &[
            ("environment.wind.speedTrue", json!(5)),
            ("navigation", json!(5)),
            ("name", json!("A")),
        ],
    );
    feed.text(&format!("{}\n", json!({"updates": [{"meta": []}]})));
    assert_eq!(feed.dropped(Dropped::Path), before + 3);
}

#[test]
fn memory_is_bounded() {
    let mut feed = Feed::new();
    for mmsi in 1..=25_000 {
        let context = format!("vessels.urn:mrn:imo:mmsi:{mmsi}");
        let reports = feed.delta(
            &context,
            TIME,
            &[("navigation.speedOverGround", json!(5.0))],
        );
        assert_eq!(reports.len(), 1);
    }
    assert!((15_000..=20_000).contains(&feed.dropped(Dropped::TooManyContexts)));
    // those that are silent for longest leave
    let mut feed = Feed::new();
    let context = |mmsi: u32| format!("vessels.urn:mrn:imo:mmsi:{mmsi}");
    let speed = [("navigation.speedOverGround", json!(5.0))];
    for mmsi in 1..=10_001 {
        feed.delta(&context(mmsi), TIME, &speed);
    }
    let course = [("navigation.courseOverGroundTrue", json!(1.0))];
    for (mmsi, is_known) in [(1, false), (4_999, false), (5_002, true), (10_000, true)] {
        let report = &feed.delta(&context(mmsi), TIME, &course)[0];
        assert_eq!(fix(report).velocity.course.half < 0.1, is_known, "{mmsi}");
    }
}
