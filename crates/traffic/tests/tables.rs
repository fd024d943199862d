//! Tables: MarineCadastre in both layouts, and the Danish authority's.

use std::fmt::Write;

use searoom_geometry::frame::KNOT_MPS;
use searoom_traffic::{
    Directions, Dropped, Identity, Interval, Kind, Note, Reader, Report, Settings, Status,
};

const OLD: &str = "MMSI,BaseDateTime,LAT,LON,SOG,COG,Heading,VesselName,IMO,CallSign,VesselType,\
                   Status,Length,\
                   Width,Draft,Cargo,TransceiverClass";
const NEW: &str = "mmsi,base_date_time,longitude,latitude,sog,cog,heading,vessel_name,imo,call_sign,\
                   vessel_type,\
                   status,length,width,draft,cargo,transceiver";
const DANISH: &str = "# Timestamp,Type of mobile,MMSI,Latitude,Longitude,Navigational status,ROT,\
                   SOG,COG,Heading,\
                      IMO,Callsign,Name,Ship type,Cargo type,Width,Length,\
                      Type of position fixing device,Draught,\
                      Destination,ETA,Data source type,A,B,C,D";

/// 2022-01-03 00:00:00 UTC.
const TIME: f64 = 1_641_168_000.0;

fn read(file: &str) -> (Vec<Report>, Reader) {
    let mut reader = Reader::new(Settings::default());
    let mut reports = Vec::new();
    reader.bytes(file.as_bytes(), 0.0, |report| reports.push(report));
    reader.finish(0.0, |report| reports.push(report));
    (reports, reader)
}

fn only(file: &str) -> Report {
    let (reports, reader) = read(file);
    let [report] = &reports[..] else {
        panic!("{file} {reports:?} {}", reader.counts());
    };
    report.clone()
}

/// A row of the old layout: these cells, and the others as they are.
fn old(changed: &[(&str, &str)]) -> Report {
    let row = "366725230,2022-01-03T00:00:00,40.66947,-74.01732,12.0,090.0,92,FRANKLIN,IMO8987462,\
    WCW8832,31,0,30,8,\
               3.3,52,A";
    let cells = OLD.split(',').zip(row.split(',')).map(|(name, cell)| {
        let change = changed.iter().find(|(changed, _)| *changed == name);
        change.map_or(cell, |(_, cell)| cell)
    });
    let row: Vec<&str> = cells.collect();
    only(&format!("{OLD}\n{}\n", row.join(",")))
}

fn near(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= 1e-9 * (1.0 + a.abs().min(b.abs()))
}

#[test]
fn both_layouts_say_the_same() {
    let new = "366725230,2022-01-03 00:00:00,-74.01732,40.66947,12.0,90.0,92.0,FRANKLIN,IMO8987462,\
    WCW8832,31,0.0,\
               30.0,8.0,3.3,52.0,A";
    let report = old(&[]);
    assert_eq!(only(&format!("\u{feff}{NEW}\r\n{new}\r\n")), report);
    let fix = report.fix.expect("a fix");
    let set = fix.position.expect("a place");
    assert!(near(set.at.lat_deg, 40.66947) && near(set.at.lon_deg, -74.01732));
    assert_eq!(set.radius_m, 50.0);
    assert!((0.5..0.8).contains(&set.half_cell_m.norm()), "{set:?}");
    assert_eq!(report.received, TIME);
    assert_eq!(fix.time, Interval::new(TIME - 5.0, TIME + 1.0));
    assert!(fix.velocity.course.contains(0.0) && fix.velocity.course.half < 0.1);
    assert_eq!(
        (report.kind, report.status),
        (Kind::ClassA, Some(Status::UnderWay))
    );
    assert_eq!(report.name.expect("a name").as_str(), "FRANKLIN");
    assert_eq!(report.call_sign.expect("a call sign").as_str(), "WCW8832");
    assert_eq!(report.type_code, Some(31));
    // the place of the antenna is not in the table
    let hull = report.hull.expect("a size");
    assert!(report.notes.has(Note::NoAntenna));
    assert_eq!([hull.ahead, hull.astern], [Interval::new(0.0, 30.5); 2]);
    assert_eq!([hull.port, hull.starboard], [Interval::new(0.0, 8.5); 2]);
}

#[test]
fn codes_for_unknown_are_unknown() {
    let knots = |cell: &str| {
        let speed = old(&[("SOG", cell)]).fix.expect("a fix").velocity.speed;
        [speed.least / KNOT_MPS, speed.most / KNOT_MPS]
    };
    for (cell, least, most) in [
        ("0.0", 0.0, 0.05),
        ("12.0", 11.95, 12.05),
        ("12", 11.5, 12.5),
        ("102.1", 102.05, 102.15),
        ("102.2", 102.15, f64::INFINITY),
        ("102.3", 0.0, f64::INFINITY),
        ("-0.1", 0.0, f64::INFINITY),
        ("", 0.0, f64::INFINITY),
        ("fast", 0.0, f64::INFINITY),
        ("inf", 0.0, f64::INFINITY),
    ] {
        let found = knots(cell);
        assert!(
            near(found[0], least) && (found[1] == most || near(found[1], most)),
            "{cell} {found:?}"
        );
    }
    let course = |cell: &str| old(&[("COG", cell)]).fix.expect("a fix").velocity.course;
    for cell in ["360.0", "409.5", "-51.2", "", "Unknown"] {
        assert_eq!(course(cell), Directions::ALL, "{cell}");
    }
    assert!(course("359.9").half < 0.1);
    let slow = old(&[("SOG", "0.9")]);
    assert!(
        slow.fix.expect("a fix").velocity.course == Directions::ALL
            && slow.notes.has(Note::SlowCourse)
    );
    for cell in ["511.0", "511", "360", "456", "", "-1"] {
        let report = old(&[("Heading", cell), ("SOG", "2.0")]);
        assert!(
            report.fix.expect("a fix").heading == Directions::ALL
                && report.notes.has(Note::NoHeading)
        );
    }
    assert!(old(&[("Heading", "359")]).fix.expect("a fix").heading.half < 0.1);
    let zeros = old(&[("SOG", "0.0"), ("COG", "0.0"), ("Heading", "511")]);
    assert!(zeros.notes.has(Note::ZerosForUnknown));
    assert_eq!(zeros.fix.expect("a fix").velocity.speed.most, f64::INFINITY);
    for (column, cell) in [
        ("LAT", "91.0"),
        ("LON", "181.0"),
        ("LAT", ""),
        ("LON", "Unknown"),
        ("LAT", "nan"),
    ] {
        let report = old(&[(column, cell)]);
        assert!(
            report.fix.expect("a fix").position.is_none() && report.notes.has(Note::NoPosition)
        );
    }
    // beside Greenwich, where Python writes an exponent
    let beside = old(&[("LON", "5e-05")])
        .fix
        .expect("a fix")
        .position
        .expect("a place");
    assert!(near(beside.at.lon_deg, 5e-5));
    for (changed, note, most) in [
        ([("Length", ""), ("Width", "8")], Note::NoSize, 500.0),
        ([("Length", "0"), ("Width", "8")], Note::NoSize, 500.0),
        ([("Length", "30"), ("Width", "")], Note::NoSize, 500.0),
        ([("Length", "8"), ("Width", "30")], Note::WrongSize, 31.0),
        ([("Length", "501"), ("Width", "30")], Note::WrongSize, 502.0),
    ] {
        let report = old(&changed);
        assert!(report.notes.has(note), "{changed:?}");
        assert_eq!(report.hull.expect("a size").ahead.most, most, "{changed:?}");
    }
    // a ship of class B is no larger than its class
    let small = old(&[("TransceiverClass", "B"), ("Length", ""), ("Status", "")]);
    assert_eq!((small.kind, small.status), (Kind::ClassB, None));
    assert_eq!(small.hull.expect("a size").ahead.most, 50.0);
    assert_eq!(old(&[("TransceiverClass", "")]).kind, Kind::Ship);
    let mark = [("TransceiverClass", ""), ("MMSI", "993669001")];
    assert_eq!(
        [old(&mark).kind, old(&mark[1..]).kind],
        [Kind::Mark, Kind::ClassA]
    );
    // the number of a mother ship is no size
    let craft = old(&[("MMSI", "982570001")]);
    assert!(craft.kind == Kind::Craft && craft.notes.has(Note::NoSize));
    assert!(
        old(&[("Status", "5")])
            .notes
            .has(Note::StatusContradictsSpeed)
    );
    assert_eq!(old(&[("Status", "15")]).status, None);
    assert_eq!(old(&[("VesselType", "1024")]).type_code, None);
}

#[test]
fn the_real_samples() {
    let samples = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/");
    let file = std::fs::read_to_string(format!("{samples}new-york-first-200.csv")).expect("a file");
    let (reports, reader) = read(&file);
    let counts = reader.counts();
    assert_eq!((counts.lines, counts.reports), (201, 200), "{counts}");
    assert_eq!(reader.unread_columns(), ["imo", "draft", "cargo"]);
    for report in &reports {
        let at = report.fix.expect("a fix").position.expect("a place").at;
        assert!((40.45..40.8).contains(&at.lat_deg) && (-74.3..-73.85).contains(&at.lon_deg));
    }
    let file = std::fs::read_to_string(format!("{samples}danish-layout.csv")).expect("a file");
    let (reports, reader) = read(&file);
    let counts = reader.counts();
    assert_eq!((counts.lines, counts.reports), (7, 5), "{counts}");
    assert_eq!(counts.dropped(Dropped::Again), 1);
    assert!(reader.unread_columns().contains(&"ROT".to_owned()));
    let kinds: Vec<Kind> = reports.iter().map(|report| report.kind).collect();
    let [a, b] = [Kind::ClassA, Kind::ClassB];
    assert_eq!(kinds, [a, b, a, Kind::BaseStation, b]);
    assert_eq!(reports[1].status, None);
}

#[test]
fn rows_of_the_danish_authority() {
    let row = |kind: &str, status: &str, sides: &str| {
        only(&format!(
            "{DANISH}\n03/01/2022 00:00:00,{kind},219000001,56.03,12.64,{status},0.0,11.8,348.0,347,\
             Unknown,,\"SMITH, JOHN\",\
             Passenger,,28,111,GPS,5.4,Unknown,,AIS,{sides}\n"
        ))
    };
    let ship = row("Class A", "Under way using engine", "60,51,14,14");
    assert_eq!((ship.received, ship.kind), (TIME, Kind::ClassA));
    assert_eq!(ship.name.expect("a name").as_str(), "SMITH, JOHN");
    assert_eq!(ship.hull.expect("a size").ahead, Interval::new(59.5, 60.5));
    assert!(!ship.notes.has(Note::Sides) && ship.call_sign.is_none());
    // which side is which is not sure
    let hull = row("Class A", "Moored", "60,51,4,24");
    assert!(hull.notes.has(Note::Sides) && hull.notes.has(Note::StatusContradictsSpeed));
    let hull = hull.hull.expect("a size");
    assert_eq!([hull.port, hull.starboard], [Interval::new(3.5, 24.5); 2]);
    // no antenna
    let hull = row("Class A", "Unknown value", "0,111,0,28");
    assert!(hull.notes.has(Note::NoAntenna) && hull.status.is_none());
    let hull = row("Class A", "Unknown value", ",,,");
    assert!(hull.notes.has(Note::NoAntenna));
    assert_eq!(hull.hull.expect("a size").ahead, Interval::new(0.0, 111.5));
    for (word, status) in [
        ("At anchor", Status::Anchored),
        ("Not under command", Status::NotUnderCommand),
        ("Restricted maneuverability", Status::Restricted),
        ("Constrained by her draught", Status::ConstrainedByDraught),
        ("Moored", Status::Moored),
        ("Aground", Status::Aground),
        ("Engaged in fishing", Status::Fishing),
        ("Under way sailing", Status::Sailing),
    ] {
        assert_eq!(row("Class A", word, ",,,").status, Some(status), "{word}");
    }
    for (word, kind) in [
        ("Base Station", Kind::BaseStation),
        ("AtoN", Kind::Mark),
        ("SAR Airborne", Kind::Aircraft),
        ("Search and Rescue Transponder", Kind::Distress),
        ("Man Overboard Device", Kind::Distress),
        ("Class B", Kind::ClassB),
        ("Unknown", Kind::Ship),
    ] {
        assert_eq!(row(word, "Unknown value", ",,,").kind, kind, "{word}");
    }
}

#[test]
fn one_ship_at_one_time_and_place_is_one_report() {
    let row = |time: &str, lat: &str| format!("366725230,2022-01-03T00:0{time}:00,{lat},-74.0\n");
    let head = "mmsi,basedatetime,lat,lon\n";
    let (reports, reader) = read(&format!(
        "{head}{}{}{}{}{head}{}",
        row("0", "40.0"),
        row("1", "40.0"),
        row("0", "40.0"),
        // another ship with the same number
        row("0", "40.1"),
        row("1", "40.0005"),
    ));
    assert_eq!(reports.len(), 3, "{}", reader.counts());
    assert_eq!(reader.counts().dropped(Dropped::Again), 2);
    // bounded
    let mut file = head.to_owned();
    for mmsi in 0..200_000 {
        writeln!(file, "{mmsi},2022-01-03T00:00:00,40.0,-74.0").expect("written");
    }
    assert_eq!(read(&file).0.len(), 200_000);
}

#[test]
fn a_table_that_lacks_a_column_says_so() {
    for (head, field, allowed) in [
        ("mmsi,lat,lon,sog", "time", "basedatetime"),
        ("time,base_date_time,lat,lon", "identity", "mmsi"),
        ("mmsi,base_date_time,lon,sog", "latitude", "latitude"),
        ("mmsi,base_date_time,lat,x\u{1b}[2J", "longitude", "lon"),
    ] {
        let (reports, reader) = read(&format!("{head}\n1,2022-01-03T00:00:00,1,1\n"));
        let missing = reader.missing_column().expect("a missing column");
        assert_eq!(missing.field, field);
        assert!(missing.allowed.contains(&allowed) && missing.found.len() == 4);
        let message = missing.to_string();
        assert!(
            message.contains(field) && !message.contains('\u{1b}'),
            "{message}"
        );
        assert!(reports.is_empty() && reader.counts().dropped(Dropped::NoColumn) == 1);
    }
    // unknown columns are listed and not guessed
    let (reports, reader) =
        read("mmsi,timestamp,lat,lon,speed,lat\n1,2022-01-03 00:00:00,1,1,5,2\n");
    assert_eq!(reader.unread_columns(), ["speed", "lat"]);
    assert_eq!(
        reports[0].fix.expect("a fix").velocity.speed.most,
        f64::INFINITY
    );
}

#[test]
fn wrong_rows_are_counted() {
    let head = "mmsi,timestamp,lat,lon,vesselname\n";
    for row in [
        "1,2022-01-03 00:00:00,1,1",
        "1,2022-01-03 00:00:00,1,1,A,B",
        "1,2022-01-03 00:00:00,1,1,\"A",
        "1,2022-01-03 00:00:00,1,1,A\rB",
        "x,2022-01-03 00:00:00,1,1,A",
        "1.5,2022-01-03 00:00:00,1,1,A",
        "1000000000,2022-01-03 00:00:00,1,1,A",
        "1,soon,1,1,A",
        "1,,1,1,A",
    ] {
        let (reports, reader) = read(&format!("{head}{row}\n2,2022-01-03 00:00:00,1,1,B\n"));
        assert_eq!(reports.len(), 1, "{row}");
        assert_eq!(
            reader.counts().dropped(Dropped::Row),
            1,
            "{row} {}",
            reader.counts()
        );
    }
    let name = |cell: &str| {
        let report = only(&format!("{head}1,2022-01-03 00:00:00,1,1,{cell}\n"));
        report.name.map(|name| name.as_str().to_owned())
    };
    assert_eq!(name("A\u{1b}[2JB\u{202e}C").as_deref(), Some("A[2JBC"));
    assert_eq!(name("\"A \"\"B\"\"\"").as_deref(), Some("A \"B\""));
    assert_eq!(name(&"Ø".repeat(30)).as_deref(), Some("ØØØØØØØØØØ"));
    assert_eq!(name("\u{200b}"), None);
}

#[test]
fn noise_before_the_first_line_decides_nothing() {
    let (reports, reader) =
        read("noise\n\n1,2,3\nmmsi,timestamp,lat,lon\n1,2022-01-03 00:00:00,1,1\n");
    assert_eq!(reports.len(), 1);
    assert_eq!(reader.counts().dropped(Dropped::NoSentence), 2);
    assert_eq!(reports[0].identity, Identity::Mmsi(1));
    // a file without a line end
    assert_eq!(
        read("mmsi,timestamp,lat,lon\n1,2022-01-03 00:00:00,1,1")
            .0
            .len(),
        1
    );
}
