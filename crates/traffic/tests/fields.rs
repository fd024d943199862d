//! Every row of the table in docs/reference/traffic.md that concerns AIS: each code and its neighbours, from
//! messages that are made bit by bit, and one ship in each quarter of the globe.

use searoom_geometry::frame::{KNOT_MPS, NAUTICAL_MILE_M, Vector, direction};
use searoom_traffic::{
    Directions, Fix, Identity, Interval, Kind, Note, Reader, Report, Settings, Status,
};

/// Time at which every message is received: a full minute.
const NOW: f64 = 1_700_000_040.0;

/// Bits of a message, the first one first.
#[derive(Clone)]
struct Message(Vec<bool>);

impl Message {
    /// A message of some length whose fields are all 0 but number and identity.
    fn new(number: u32, mmsi: u32, length: usize) -> Self {
        Self(vec![false; length])
            .with(0, 6, i64::from(number))
            .with(8, 30, i64::from(mmsi))
    }

    fn with(mut self, from: usize, bits: usize, value: i64) -> Self {
        for bit in 0..bits {
            self.0[from + bit] = value >> (bits - 1 - bit) & 1 == 1;
        }
        self
    }

    fn text(self, from: usize, text: &str) -> Self {
        text.bytes()
            .enumerate()
            .fold(self, |message, (index, byte)| {
                let code = if byte >= 64 { byte - 64 } else { byte };
                message.with(from + 6 * index, 6, i64::from(code))
            })
    }

    fn armoured(&self) -> (String, usize) {
        let fill = (6 - self.0.len() % 6) % 6;
        let mut bits = self.0.clone();
        bits.resize(bits.len() + fill, false);
        let characters = bits.chunks(6).map(|six| {
            let value = six.iter().fold(0, |value, bit| value << 1 | u8::from(*bit));
            char::from(if value < 40 { value + 48 } else { value + 56 })
        });
        (characters.collect(), fill)
    }

    fn report(&self) -> Report {
        let (armour, fill) = self.armoured();
        let half = armour.len().div_ceil(2).min(60);
        if armour.len() <= 60 {
            let line = sentence(&format!("AIVDM,1,1,,A,{armour},{fill}"));
            return only(&[line]);
        }
        let first = sentence(&format!("AIVDM,2,1,7,A,{},0", &armour[..half]));
        let second = sentence(&format!("AIVDM,2,2,7,A,{},{fill}", &armour[half..]));
        only(&[first, second])
    }
}

/// The only report of lines, which the last one completes.
fn only(lines: &[String]) -> Report {
    let mut reader = Reader::new(Settings::default());
    let mut reports = Vec::new();
    for line in lines {
        assert!(reports.is_empty());
        reader.line(line.as_bytes(), NOW, |report| reports.push(report));
    }
    let [report] = &reports[..] else {
        panic!("{lines:?} {}", reader.counts());
    };
    report.clone()
}

fn sentence(body: &str) -> String {
    format!(
        "!{body}*{:02X}",
        body.bytes().fold(0, |sum, byte| sum ^ byte)
    )
}

const SHIP: u32 = 257_000_001;
const PARTS: f64 = 600_000.0;

/// A class A report of a ship of 12 kn on course 090, in 56.5° N and 3.2° E, at second 30.
fn class_a() -> Message {
    Message::new(1, SHIP, 168)
        .with(42, 8, -128)
        .with(50, 10, 120)
        .with(60, 1, 1)
        .with(61, 28, (3.2 * PARTS) as i64)
        .with(89, 27, (56.5 * PARTS) as i64)
        .with(116, 12, 900)
        .with(128, 9, 92)
        .with(137, 6, 30)
}

fn fix(message: &Message) -> Fix {
    message.report().fix.expect("a fix")
}

fn has(message: &Message, note: Note) -> bool {
    message.report().notes.has(note)
}

fn near(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= 1e-9 * (1.0 + a.abs().min(b.abs()))
}

/// The messages with a position, where it stands in them, and its parts of a degree.
fn with_positions() -> Vec<(Message, usize, usize, f64)> {
    vec![
        (class_a(), 61, 28, PARTS),
        (class_a().with(0, 6, 2), 61, 28, PARTS),
        (class_a().with(0, 6, 3), 61, 28, PARTS),
        (Message::new(4, 2_570_001, 168), 79, 28, PARTS),
        (Message::new(11, SHIP, 168), 79, 28, PARTS),
        (Message::new(9, 111_257_001, 168), 61, 28, PARTS),
        (Message::new(18, SHIP, 168), 57, 28, PARTS),
        (Message::new(19, SHIP, 312), 57, 28, PARTS),
        (Message::new(21, 992_570_001, 272), 164, 28, PARTS),
        (Message::new(27, SHIP, 96), 44, 18, 600.0),
    ]
}

#[test]
fn ships_in_each_quarter_of_the_globe_are_where_they_are() {
    for (message, from, bits, parts) in with_positions() {
        for (lon, lat) in [
            (3.2, 56.5),
            (-3.2, 56.5),
            (3.2, -56.5),
            (-179.95, -56.5),
            (0.0, 0.0),
        ] {
            let (east, north) = ((lon * parts) as i64, (lat * parts) as i64);
            let sent = message.clone().with(from, bits, east);
            let sent = sent.with(from + bits, bits - 1, north);
            let set = fix(&sent).position.expect("a place");
            assert!(
                near(set.at.lon_deg, east as f64 / parts),
                "{lon} {lat} {set:?}"
            );
            assert!(
                near(set.at.lat_deg, north as f64 / parts),
                "{lon} {lat} {set:?}"
            );
            // half a step each way, in metres on the ellipsoid
            let north_m = 0.5 / parts * 60.0 * 1852.0;
            let east_m = north_m * lat.to_radians().cos();
            let half = set.half_cell_m;
            assert!(
                half.y >= 0.99 * north_m && half.y < 1.02 * north_m,
                "{half}"
            );
            assert!(half.x >= 0.99 * east_m && half.x < 1.02 * east_m, "{half}");
        }
    }
}

#[test]
fn no_position_is_no_place() {
    for (message, from, bits, parts) in with_positions() {
        let (lon, lat) = ((181.0 * parts) as i64, (91.0 * parts) as i64);
        let (here, there) = ((3.0 * parts) as i64, (180.0 * parts) as i64);
        let cases = [
            (lon, lat, false),
            (lon, here, false),
            (here, lat, false),
            (there + 1, here, false),
            (-there - 1, here, false),
            (here, there / 2 + 1, false),
            (there, there / 2, true),
            // what one decoder takes for "no position" in the long-range message: 3° 01' E and 1° 31' N
            (
                (181.0 / 60.0 * parts) as i64,
                (91.0 / 60.0 * parts) as i64,
                true,
            ),
        ];
        for (east, north, is_place) in cases {
            let sent = message.clone().with(from, bits, east);
            let sent = sent.with(from + bits, bits - 1, north);
            assert_eq!(fix(&sent).position.is_some(), is_place, "{east} {north}");
            assert_eq!(has(&sent, Note::NoPosition), !is_place);
        }
    }
}

#[test]
fn an_accuracy_is_a_radius() {
    let settings = Settings::default();
    for (accurate, radius) in [(1, settings.accurate_m), (0, settings.inaccurate_m)] {
        let set = fix(&class_a().with(60, 1, accurate)).position;
        assert_eq!(set.expect("a place").radius_m, radius);
    }
    let set = fix(&class_a()).position.expect("a place");
    let outer = set.outer();
    for angle in 0..64 {
        let there = direction(0.1 * f64::from(angle)) * set.radius_m + set.half_cell_m;
        assert!(outer.contains(there), "{there}");
    }
    assert!(has(&class_a().with(148, 1, 1), Note::Raim));
}

#[test]
fn a_fix_is_dated_by_its_second() {
    // received at a full minute
    for (second, at) in [(59, -1.0), (30, -30.0), (31, -29.0), (0, 0.0), (2, 2.0)] {
        let fix = fix(&class_a().with(137, 6, second));
        assert_eq!(
            fix.time,
            Interval::new(NOW + at, NOW + at + 1.0),
            "{second}"
        );
    }
    // ahead of the reception: a clock, or a report that is nearly a minute late
    for second in [3, 29] {
        let late = class_a().with(137, 6, second);
        let at = NOW + second as f64;
        assert_eq!(fix(&late).time, Interval::new(at - 60.0, at + 1.0));
        assert!(has(&late, Note::AgeUnknown), "{second}");
    }
    let unknown = class_a().with(137, 6, 60);
    assert_eq!(fix(&unknown).time, Interval::new(NOW - 10.0, NOW));
    assert!(has(&unknown, Note::AgeUnknown));
    let class_b = Message::new(18, SHIP, 168).with(133, 6, 60);
    assert_eq!(fix(&class_b).time, Interval::new(NOW - 30.0, NOW));
    for second in [61, 62, 63] {
        let by_hand = class_a().with(137, 6, second);
        let set = fix(&by_hand).position.expect("a place");
        assert!(set.radius_m >= 0.5 * NAUTICAL_MILE_M && has(&by_hand, Note::NotMeasured));
    }
}

#[test]
fn a_speed_is_a_step_and_its_codes_are_no_bounds() {
    let knots = |sent: &Message| {
        let speed = fix(sent).velocity.speed;
        [speed.least / KNOT_MPS, speed.most / KNOT_MPS]
    };
    let is = |found: [f64; 2], least: f64, most: f64| {
        near(found[0], least) && (found[1] == most || near(found[1], most))
    };
    let infinite = f64::INFINITY;
    for (code, least, most) in [
        (0, 0.0, 0.05),
        (1, 0.05, 0.15),
        (120, 11.95, 12.05),
        (1021, 102.05, 102.15),
        (1022, 102.15, infinite),
        (1023, 0.0, infinite),
    ] {
        let sent = class_a().with(50, 10, code);
        assert!(is(knots(&sent), least, most), "{code} {:?}", knots(&sent));
        let class_b = Message::new(18, SHIP, 168).with(46, 10, code);
        assert!(is(knots(&class_b), least, most), "{code}");
    }
    let aircraft = |code| Message::new(9, 111_257_001, 168).with(50, 10, code);
    assert!(is(knots(&aircraft(120)), 119.5, 120.5));
    assert!(is(knots(&aircraft(1022)), 1021.5, infinite));
    assert!(is(knots(&aircraft(1023)), 0.0, infinite));
    let long_range = |code| Message::new(27, SHIP, 96).with(79, 6, code);
    assert!(is(knots(&long_range(12)), 11.5, 12.5));
    assert!(is(knots(&long_range(62)), 61.5, 62.5));
    assert!(is(knots(&long_range(63)), 0.0, infinite));
    // unless the ship's kind bounds it
    let outer = fix(&class_a().with(50, 10, 1023))
        .velocity
        .outer(25.0 * KNOT_MPS);
    assert!(near(outer.support(Vector::new(1.0, 0.0)), 25.0 * KNOT_MPS));
}

/// Encoders send that where they know nothing, and it would be a ship that lies still.
#[test]
fn zeros_without_a_heading_are_no_ship_at_rest() {
    let zeros = class_a().with(50, 10, 0).with(116, 12, 0).with(128, 9, 511);
    assert!(has(&zeros, Note::ZerosForUnknown));
    assert_eq!(fix(&zeros).velocity.speed.most, f64::INFINITY);
    let lies = zeros.with(128, 9, 92);
    assert!(fix(&lies).velocity.speed.most < 0.1 && !has(&lies, Note::ZerosForUnknown));
}

#[test]
fn a_course_is_a_sector_or_all_directions() {
    let course = |sent: &Message| fix(sent).velocity.course;
    let degrees = |directions: Directions| directions.half.to_degrees();
    assert!(near(degrees(course(&class_a())), 2.05));
    // east
    assert!(course(&class_a()).contains(0.0));
    for code in [3600, 3601, 4095] {
        let sent = class_a().with(116, 12, code);
        assert!(course(&sent) == Directions::ALL && has(&sent, Note::NoCourse));
    }
    assert!(!has(&class_a().with(116, 12, 3599), Note::NoCourse));
    // too slow for a course
    for (speed, is_all) in [(10, true), (11, false)] {
        let sent = class_a().with(50, 10, speed);
        assert_eq!(course(&sent) == Directions::ALL, is_all, "{speed}");
    }
    let long_range = |code| Message::new(27, SHIP, 96).with(79, 6, 12).with(85, 9, code);
    assert!(near(degrees(course(&long_range(90))), 2.5));
    for code in [360, 511] {
        assert_eq!(course(&long_range(code)), Directions::ALL);
    }
}

#[test]
fn the_velocities_of_a_report_are_within_their_polygon() {
    for (speed, course) in [(120, 900), (120, 3600), (3, 900), (1023, 10)] {
        let sent = class_a().with(50, 10, speed).with(116, 12, course);
        let velocity = fix(&sent).velocity;
        let outer = velocity.outer(13.0);
        let most = velocity.speed.most.min(13.0);
        for (part, turn) in (0..=20).flat_map(|p| (0..=20).map(move |t| (p, t))) {
            let half = velocity.course.half;
            let heading = velocity.course.middle - half + 0.1 * half * f64::from(turn);
            let least = velocity.speed.least;
            let speed = least + 0.05 * (most - least) * f64::from(part);
            assert!(
                outer.contains(direction(heading) * (speed * (1.0 - 1e-12))),
                "{sent:?} {heading}",
                sent = speed
            );
        }
    }
}

#[test]
fn a_heading_is_a_sector_or_all_directions() {
    let heading = |sent: &Message| fix(sent).heading;
    assert!(near(heading(&class_a()).half.to_degrees(), 2.5));
    assert!(heading(&class_a().with(128, 9, 359)).half < 0.1);
    for code in [360, 456, 510, 511] {
        // at 12 kn the course stands for it, wider
        let sent = class_a().with(128, 9, code);
        assert!(near(heading(&sent).half.to_degrees(), 17.05), "{code}");
        assert!(has(&sent, Note::NoHeading) && has(&sent, Note::HeadingFromCourse));
        // below 5 kn it does not
        let slow = sent.with(50, 10, 50);
        assert!(heading(&slow) == Directions::ALL && !has(&slow, Note::HeadingFromCourse));
    }
}

#[test]
fn a_rate_of_turn_has_its_side() {
    let rate = |code: i64| fix(&class_a().with(42, 8, code)).turn_rate;
    let per_minute = |rate: f64| rate.to_degrees() * 60.0;
    assert_eq!(rate(-128), None);
    // to starboard is clockwise, and so negative
    for (code, size) in [(20, 17.86), (-20, 17.86), (1, 0.045), (125, 697.5)] {
        let turn = rate(code).expect("a rate");
        let [least, most] = [per_minute(turn.least), per_minute(turn.most)];
        let exact = -size * (code.signum() as f64);
        assert!(least <= exact && exact <= most, "{code} {least} {most}");
        assert!(least * most >= 0.0, "{code}");
    }
    assert!(rate(0).expect("a rate").contains(0.0));
    let [starboard, port] = [127, -127].map(|code| rate(code).expect("a side"));
    assert!(near(per_minute(starboard.most), -10.0) && starboard.least == f64::NEG_INFINITY);
    assert!(near(per_minute(port.least), 10.0) && port.most == f64::INFINITY);
    let more = rate(-126).expect("708 or more");
    assert!(per_minute(more.least) < 708.1 && more.most == f64::INFINITY);
}

#[test]
fn a_size_says_where_the_antenna_is_or_that_it_does_not() {
    let sent = |[bow, stern, port, starboard]: [i64; 4]| {
        let message = Message::new(5, SHIP, 424)
            .with(240, 9, bow)
            .with(249, 9, stern);
        message.with(258, 6, port).with(264, 6, starboard)
    };
    let hull = |sides: [i64; 4]| sent(sides).report().hull.expect("a size");
    let most = |sides: [i64; 4]| {
        let hull = hull(sides);
        [hull.ahead, hull.astern, hull.port, hull.starboard].map(|side| side.most)
    };
    assert_eq!(most([60, 51, 14, 15]), [60.5, 51.5, 14.5, 15.5]);
    // nothing is known
    assert_eq!(most([0, 0, 0, 0]), [500.0, 500.0, 130.0, 130.0]);
    assert!(has(&sent([0, 0, 0, 0]), Note::NoSize));
    // length and beam alone
    assert_eq!(most([0, 200, 0, 30]), [200.5, 200.5, 30.5, 30.5]);
    assert!(has(&sent([0, 200, 0, 30]), Note::NoAntenna));
    // at the bow, or at the rail
    for sides in [
        [0, 200, 15, 15],
        [100, 100, 0, 30],
        [200, 0, 15, 15],
        [100, 100, 30, 0],
    ] {
        assert!(!has(&sent(sides), Note::NoAntenna), "{sides:?}");
        assert!(most(sides).contains(&0.5), "{sides:?}");
    }
    // this or more
    assert_eq!(most([511, 20, 20, 20])[0], 511.0);
    assert_eq!(most([200, 200, 63, 20])[2], 130.0);
    assert!(has(&sent([511, 20, 20, 20]), Note::SizeOrMore));
    // typed in wrongly: in all directions
    for sides in [[5, 5, 30, 30], [300, 201, 20, 20]] {
        assert!(has(&sent(sides), Note::WrongSize), "{sides:?}");
        let all = most(sides);
        assert!(
            all.iter().all(|side| *side == all[0] && *side >= 60.0),
            "{all:?}"
        );
    }
    assert!(hull([60, 51, 14, 15]).reach() > 62.0);
}

#[test]
fn static_messages_have_names_and_types() {
    let sent = Message::new(5, SHIP, 424).with(232, 8, 70);
    let report = sent.text(112, "NORDIC STAR").text(70, "LAXY").report();
    assert_eq!(report.name.expect("a name").as_str(), "NORDIC STAR");
    assert_eq!(report.call_sign.expect("a call sign").as_str(), "LAXY");
    assert_eq!((report.type_code, report.kind), (Some(70), Kind::ClassA));
    // real units leave out the spare bits
    assert!(!Message::new(5, SHIP, 422).report().notes.has(Note::Short));
    for length in [160, 168] {
        let part_a = Message::new(24, SHIP, length).text(40, "YACHT");
        assert_eq!(part_a.report().name.expect("a name").as_str(), "YACHT");
    }
    let class_b = Message::new(19, SHIP, 312)
        .text(143, "SMALL")
        .with(271, 9, 6)
        .with(280, 9, 6);
    let class_b = class_b.with(289, 6, 2).with(295, 6, 2).report();
    assert_eq!(class_b.name.expect("a name").as_str(), "SMALL");
    assert_eq!(class_b.hull.expect("a size").ahead.most, 6.5);
}

/// The bits of the size are the number of the mother ship.
#[test]
fn a_craft_has_the_number_of_its_mother_ship_and_no_size() {
    let part_b = |mmsi| {
        Message::new(24, mmsi, 168)
            .with(38, 2, 1)
            .with(132, 30, 257_000_009)
    };
    let craft = part_b(982_570_001).report();
    assert_eq!(craft.mother_ship, Some(Identity::Mmsi(257_000_009)));
    assert!(craft.notes.has(Note::NoSize) && craft.kind == Kind::Craft);
    let none = part_b(982_570_001).with(132, 30, 0).report();
    assert!(none.mother_ship.is_none());
    let ship = part_b(SHIP).report();
    assert!(ship.mother_ship.is_none() && ship.hull.is_some());
}

#[test]
fn a_long_range_position_is_a_cell_and_old() {
    let fresh = Message::new(27, SHIP, 96)
        .with(44, 18, 192)
        .with(62, 17, 3390);
    let set = fix(&fresh).position.expect("a place");
    assert!((set.half_cell_m.y - 93.0).abs() < 1.0, "{set:?}");
    assert!((set.half_cell_m.x - 93.0).abs() < 1.0, "{set:?}");
    assert_eq!(fix(&fresh).time, Interval::new(NOW - 5.0, NOW));
    let late = fresh.with(94, 1, 1);
    assert!(fix(&late).time.least <= NOW - 60.0 && has(&late, Note::Latent));
    assert_eq!(late.report().kind, Kind::Ship);
    // 96 bits or a whole slot
    assert!(Message::new(27, SHIP, 168).report().fix.is_some());
}

#[test]
fn a_status_makes_no_set_smaller() {
    let sent = |code| class_a().with(38, 4, code);
    let words = (0..16).map(|code| sent(code).report().status.map(Status::word));
    let words: Vec<_> = words.map(|word| word.unwrap_or("–")).collect();
    assert_eq!(words[0], "under way");
    assert_eq!([words[9], words[10], words[13], words[15]], ["–"; 4]);
    for code in [1, 5, 6] {
        assert!(has(&sent(code), Note::StatusContradictsSpeed), "{code}");
        assert_eq!(fix(&sent(code)), fix(&sent(0)));
        assert!(!has(
            &sent(code).with(50, 10, 9),
            Note::StatusContradictsSpeed
        ));
    }
    for mmsi in [970_257_001, 972_257_001, 974_257_001] {
        let distress = sent(14).with(8, 30, mmsi).report();
        assert_eq!(
            (distress.kind, distress.status),
            (Kind::Distress, Some(Status::Distress))
        );
        let test = sent(15).with(8, 30, mmsi).report();
        assert_eq!(test.status, Some(Status::DistressTest));
    }
}

#[test]
fn what_is_no_ship_says_so() {
    let kind = |message: Message| message.report().kind;
    assert_eq!(kind(Message::new(4, 2_570_001, 168)), Kind::BaseStation);
    assert_eq!(kind(Message::new(11, SHIP, 168)), Kind::ClassA);
    assert_eq!(kind(Message::new(9, 111_257_001, 168)), Kind::Aircraft);
    let mark = Message::new(21, 992_570_001, 272).with(253, 6, 30);
    assert_eq!(kind(mark.clone()), Kind::Mark);
    assert_eq!(kind(mark.clone().with(269, 1, 1)), Kind::VirtualMark);
    assert_eq!(fix(&mark).velocity.speed, Interval::new(0.0, 0.0));
    let off = mark.with(259, 1, 1);
    // adrift
    assert_eq!(fix(&off).velocity.speed.most, f64::INFINITY);
    assert!(has(&off, Note::OffPosition) && !has(&off.with(253, 6, 60), Note::OffPosition));
    // a ship with a default number, or with an aircraft's, is no station and no aircraft
    for mmsi in [0, 1_193_046, 111_257_001] {
        assert_eq!(kind(class_a().with(8, 30, mmsi)), Kind::ClassA, "{mmsi}");
        let class_b = Message::new(18, SHIP, 168).with(8, 30, mmsi);
        assert_eq!(kind(class_b), Kind::ClassB, "{mmsi}");
    }
    assert_eq!(kind(Message::new(5, 111_257_001, 424)), Kind::Aircraft);
    assert_eq!(kind(Message::new(24, 992_570_001, 168)), Kind::Mark);
    // a ship that answers has a place and no velocity
    let answer = fix(&Message::new(11, SHIP, 168));
    assert_eq!(answer.velocity.speed.most, f64::INFINITY);
}
