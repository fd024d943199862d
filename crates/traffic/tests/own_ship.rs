//! Own ship's sentences: each code of the table in docs/reference/traffic.md.

use searoom_geometry::frame::{KNOT_MPS, NAUTICAL_MILE_M};
use searoom_traffic::{
    Directions, Dropped, Fix, Identity, Interval, Note, Reader, Report, Settings,
};

/// 2026-11-29 12:00:10 UTC.
const NOW: f64 = 1_795_910_400.0 + 43_210.0;

fn sentence(body: &str) -> String {
    let sum = body.bytes().fold(0, |sum, byte| sum ^ byte);
    format!("${body}*{sum:02X}")
}

fn read(body: &str) -> (Vec<Report>, Reader) {
    let mut reader = Reader::new(Settings::default());
    let mut reports = Vec::new();
    reader.line(sentence(body).as_bytes(), NOW, |report| {
        reports.push(report)
    });
    (reports, reader)
}

fn report(body: &str) -> Report {
    let (reports, reader) = read(body);
    let [report] = &reports[..] else {
        panic!("{body}: {reports:?} {}", reader.counts());
    };
    assert!(report.is_own && report.identity == Identity::Own);
    report.clone()
}

fn fix(body: &str) -> Fix {
    report(body).fix.expect("a fix")
}

fn has(body: &str, note: Note) -> bool {
    report(body).notes.has(note)
}

fn dropped(body: &str, why: Dropped) -> bool {
    let (reports, reader) = read(body);
    reports.is_empty() && reader.counts().dropped(why) == 1
}

fn near(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= 1e-9 * (1.0 + a.abs().min(b.abs()))
}

const RMC: &str = "GPRMC,120009.00,A,5630.0000,N,00312.0000,E,12.0,090.0,291126,,,A";

#[test]
fn a_position_is_in_its_quarter_of_the_globe() {
    for (letters, lat, lon) in [
        ("N E", 56.5, 3.2),
        ("N W", 56.5, -3.2),
        ("S E", -56.5, 3.2),
        ("S W", -56.5, -3.2),
    ] {
        let (north, east) = letters.split_once(' ').expect("two letters");
        let place = format!("5630.0000,{north},00312.0000,{east}");
        for body in [
            format!("GPRMC,120009.00,A,{place},12.0,090.0,291126,,,A"),
            format!("GPGGA,120009.00,{place},1,08,0.9,12.0,M,46.9,M,,"),
            format!("GNGNS,120009.00,{place},AA,13,0.9,12.0,46.9,,"),
            format!("GPGLL,{place},120009.00,A,A"),
            format!("GPGLL,{place}"),
        ] {
            let set = fix(&body).position.expect("a place");
            assert!(
                near(set.at.lat_deg, lat) && near(set.at.lon_deg, lon),
                "{body} {set:?}"
            );
            // half a step of the last decimal, as in AIS
            assert!((set.half_cell_m.y - 0.093).abs() < 0.002, "{set:?}");
            assert!((set.half_cell_m.x - 0.093 * lat.to_radians().cos()).abs() < 0.002);
        }
    }
    // the date line, and a sentence without decimals
    let edge = fix("GPGLL,0000.00,N,18000.00,W,120009,A,A").position;
    assert!(near(edge.expect("a place").at.lon_deg, -180.0));
    let whole = fix("GPGLL,5630,N,00312,E,120009,A,A").position;
    assert!((whole.expect("a place").half_cell_m.y - 930.0).abs() < 10.0);
}

#[test]
fn a_void_position_is_none() {
    let place = "5630.0000,N,00312.0000,E";
    for (body, note) in [
        (RMC.replace(",A,5630", ",V,5630"), Note::NoPosition),
        (RMC.replace(",,,A", ",,,N"), Note::NoPosition),
        (RMC.replace(",A,5630", ",,5630"), Note::NoPosition),
        (RMC.replace("5630.0000", ""), Note::NoPosition),
        (RMC.replace("5630.0000,N", "9000.0001,N"), Note::NoPosition),
        (
            RMC.replace("00312.0000,E", "18000.0001,E"),
            Note::NoPosition,
        ),
        (RMC.replace(",,,A", ",,,S"), Note::Simulated),
        (
            format!("GPGGA,120009,{place},0,00,99.9,,M,,M,,"),
            Note::NoPosition,
        ),
        (
            format!("GPGGA,120009,{place},,00,99.9,,M,,M,,"),
            Note::NoPosition,
        ),
        (
            format!("GPGGA,120009,{place},8,08,0.9,,M,,M,,"),
            Note::Simulated,
        ),
        (format!("GNGNS,120009,{place},NN,00,,,,,"), Note::NoPosition),
        (format!("GNGNS,120009,{place},,00,,,,,"), Note::NoPosition),
        (format!("GNGNS,120009,{place},SN,00,,,,,"), Note::Simulated),
        (format!("GPGLL,{place},120009,V,A"), Note::NoPosition),
        (format!("GPGLL,{place},120009,A,N"), Note::NoPosition),
        ("GPRMC,,V,,,,,,,,,,N".to_owned(), Note::NoPosition),
    ] {
        let report = report(&body);
        assert!(report.fix.expect("a fix").position.is_none(), "{body}");
        assert!(report.notes.has(note), "{body} {:?}", report.notes);
    }
    assert_eq!(
        fix(&RMC.replace(",A,5630", ",V,5630")).velocity.speed.most,
        f64::INFINITY
    );
    // the navigational status of version 4.1 says nothing of the position
    let with_status = RMC.replace(",,,A", ",,,A,V");
    assert!(fix(&with_status).position.is_some());
    // before version 2.3 there was no mode
    assert!(
        fix("GPRMC,120009,A,5630.0,N,00312.0,E,12.0,090.0,291126,,")
            .position
            .is_some()
    );
}

#[test]
fn a_quality_is_a_radius() {
    let settings = Settings::default();
    let (fine, coarse, typed) = (
        settings.accurate_m,
        settings.inaccurate_m,
        0.5 * NAUTICAL_MILE_M,
    );
    let place = "5630.0000,N,00312.0000,E";
    let gga = |quality: u32, dilution: &str| {
        format!("GPGGA,120009,{place},{quality},08,{dilution},,M,,M,,")
    };
    let gns = |modes: &str| format!("GNGNS,120009,{place},{modes},08,0.9,,,,");
    let rmc = |mode: &str| RMC.replace(",,,A", &format!(",,,{mode}"));
    for (body, radius) in [
        (gga(1, "0.9"), coarse),
        (gga(2, "0.9"), fine),
        (gga(3, "0.9"), fine),
        (gga(4, "0.9"), fine),
        (gga(5, "0.9"), fine),
        (gga(6, "0.9"), typed),
        (gga(7, "0.9"), typed),
        // few satellites, badly placed
        (gga(2, "9.0"), 90.0),
        (gga(1, "9.0"), 90.0),
        (gga(1, ""), coarse),
        (gns("AA"), coarse),
        (gns("AD"), fine),
        (gns("NR"), fine),
        (gns("EN"), typed),
        (gns("AE"), coarse),
        (rmc("A"), coarse),
        (rmc("D"), fine),
        (rmc("F"), fine),
        (rmc("R"), fine),
        (rmc("P"), fine),
        (rmc("E"), typed),
        (rmc("M"), typed),
    ] {
        assert_eq!(
            fix(&body).position.expect("a place").radius_m,
            radius,
            "{body}"
        );
        assert_eq!(has(&body, Note::NotMeasured), radius == typed, "{body}");
    }
    // a reckoned velocity may be one through the water
    assert_eq!(fix(&rmc("E")).velocity.speed.most, f64::INFINITY);
}

#[test]
fn date_and_time_date_the_fix() {
    let at = |time: f64| Interval::new(time, time);
    assert_eq!(fix(RMC).time, at(NOW - 1.0));
    // with the date of RMC, whatever the reception
    assert_eq!(
        fix(&RMC.replace("291126", "030122")).time,
        at(1_641_168_000.0 + 43_209.0)
    );
    assert_eq!(fix(&RMC.replace("291126", "")).time, at(NOW - 1.0));
    // a time alone is of the day that is nearest to the reception, 12:00:10
    let gga = |time: &str| fix(&format!("GPGGA,{time},5630.0,N,00312.0,E,1,08,0.9,,M,,M,,")).time;
    assert_eq!(gga("120009.50"), at(NOW - 0.5));
    assert_eq!(gga("120015"), at(NOW + 5.0));
    // the nearer of two midnights
    assert_eq!(gga("235959"), at(NOW + 43_189.0));
    assert_eq!(gga("000011"), at(NOW - 43_199.0));
    let none = gga("");
    assert!(none.most == NOW && none.least < NOW);
    for wrong in ["250000", "12000a", "1200"] {
        let body = format!("GPGGA,{wrong},5630.0,N,00312.0,E,1,08,0.9,,M,,M,,");
        assert!(dropped(&body, Dropped::Fields), "{wrong}");
    }
    assert!(dropped(&RMC.replace("291126", "310226"), Dropped::Fields));
}

#[test]
fn speed_and_course_are_sets() {
    let knots = |body: &str| {
        let speed = fix(body).velocity.speed;
        [speed.least / KNOT_MPS, speed.most / KNOT_MPS]
    };
    let [least, most] = knots(RMC);
    assert!(near(least, 11.95) && near(most, 12.05));
    assert!(fix(RMC).velocity.course.contains(0.0));
    assert!(near(fix(RMC).velocity.course.half.to_degrees(), 2.05));
    let vtg = "GPVTG,090.0,T,,M,12.0,N,22.2,K,A";
    let found = fix(vtg);
    assert!(found.position.is_none() && !has(vtg, Note::NoPosition));
    assert_eq!(found.velocity, fix(RMC).velocity);
    let [least, most] = knots("GPVTG,090.0,T,,M,,N,18.52,K,A");
    assert!(near(least, 10.0 - 0.005 / 1.852) && near(most, 10.0 + 0.005 / 1.852));
    // unknown
    for body in [
        "GPVTG,,T,,M,,N,,K,N",
        "GPVTG,090.0,T,,M,12.0,N,22.2,K,N",
        "GPVTG,090.0,T,,M,12.0,N,22.2,K,S",
        "GPVTG,090.0,T,,M,12.0,N,22.2,K,E",
        &RMC.replace("12.0", ""),
        &RMC.replace("12.0", "102.3"),
    ] {
        let velocity = fix(body).velocity;
        assert!(
            velocity.speed == Interval::new(0.0, f64::INFINITY),
            "{body}"
        );
        assert!(velocity.course == Directions::ALL && has(body, Note::NoSpeed));
    }
    // too slow for a course, or none
    assert_eq!(
        fix("GPVTG,090.0,T,,M,1.0,N,,K,A").velocity.course,
        Directions::ALL
    );
    assert!(fix("GPVTG,090.0,T,,M,1.1,N,,K,A").velocity.course.half < 0.1);
    for course in ["", "360.0", "-1.0"] {
        let body = RMC.replace("090.0", course);
        assert!(fix(&body).velocity.course == Directions::ALL && has(&body, Note::NoCourse));
    }
    // the magnetic course is in another field, and the oldest form has no letters to tell
    assert_eq!(
        fix("GPVTG,,T,090.0,M,12.0,N,,K,A").velocity.course,
        Directions::ALL
    );
    assert!(dropped("GPVTG,090.0,095.0,12.0,22.2", Dropped::Fields));
}

#[test]
fn a_heading_is_true_or_none() {
    let settings = Settings::default();
    let half = |body: &str| fix(body).heading.half;
    for body in ["HEHDT,090.0,T", "HETHS,090.0,A", "GPHDT,090.0,T"] {
        assert!(
            near(half(body), settings.heading_error + 0.05_f64.to_radians()),
            "{body}"
        );
        assert!(fix(body).heading.contains(0.0));
        assert!(fix(body).position.is_none() && !has(body, Note::NoPosition));
        assert_eq!(fix(body).velocity.speed.most, f64::INFINITY);
    }
    for mode in ["E", "M"] {
        let body = format!("HETHS,090.0,{mode}");
        assert!(half(&body) > 15.0_f64.to_radians() && has(&body, Note::HeadingNotMeasured));
    }
    assert!(
        fix("HETHS,090.0,S").heading == Directions::ALL && has("HETHS,090.0,S", Note::Simulated)
    );
    for body in ["HETHS,090.0,V", "HETHS,,V", "HETHS,090.0,"] {
        assert!(
            fix(body).heading == Directions::ALL && has(body, Note::NoHeading),
            "{body}"
        );
    }
    for body in [
        "HEHDT,,T",
        "HEHDT,090.0,M",
        "HEHDT,361.0,T",
        "HEHDT,511,T",
        "HEHDT,nan,T",
    ] {
        assert!(dropped(body, Dropped::Fields), "{body}");
    }
    // never taken as true
    for body in ["HCHDG,090.0,,,1.0,E", "HCHDM,090.0,M"] {
        assert!(dropped(body, Dropped::Magnetic), "{body}");
    }
    // a maker's own sentence
    assert!(dropped("PXHDT,090.0,T", Dropped::OtherSentence));
}

#[test]
fn wrong_fields_are_dropped() {
    for body in [
        &RMC.replace("5630.0000", "5660.0000"),
        &RMC.replace("5630.0000", "-5630.0000"),
        &RMC.replace("5630.0000", "1e3"),
        &RMC.replace("5630.0000,N", "5630.0000,"),
        &RMC.replace("5630.0000,N", "5630.0000,E"),
        &RMC.replace("5630.0000,N", "5630.0000,North"),
        &RMC.replace("12.0", "inf"),
        &format!("{RMC}{}", ",".repeat(60)),
    ] {
        assert!(dropped(body, Dropped::Fields), "{body}");
    }
}
