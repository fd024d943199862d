//! Lines, tag blocks, parts of messages, and what is dropped.

use rand::{Rng, SeedableRng};
use searoom_traffic::{Dropped, Identity, Reader, Report, Settings};

const NOW: f64 = 1_700_000_000.0;

fn sum(body: &str) -> u8 {
    body.bytes().fold(0, |sum, byte| sum ^ byte)
}

fn sentence(body: &str) -> String {
    format!("!{body}*{:02X}", sum(body))
}

fn tagged(tag: &str, body: &str) -> String {
    format!("\\{tag}*{:02X}\\{}", sum(tag), sentence(body))
}

fn reader() -> Reader {
    Reader::new(Settings::default())
}

/// Two parts of a static message of a ship, with these fields before the armour of each.
const ALFA: [&str; 2] = [
    "55Mg8KP298lIL=OSS?8I84pdhTr18DTp5DE8000O1p?4400008@000000000",
    "00000000000",
];
const BRAVO: [&str; 2] = [
    "53mb9U02>d<PTL=GC@05<PE=@tp4000000000016>PE<;5WO0:R0@@Dh8888",
    "88888888880",
];

fn part(armour: &str, number: usize, sequence: &str, channel: &str) -> String {
    let fill = if number == 2 { 2 } else { 0 };
    format!("AIVDM,2,{number},{sequence},{channel},{armour},{fill}")
}

fn identities(reports: &[Report]) -> Vec<u32> {
    let mut all: Vec<u32> = reports
        .iter()
        .map(|report| match report.identity {
            Identity::Mmsi(mmsi) => mmsi,
            other => panic!("{other:?}"),
        })
        .collect();
    all.sort_unstable();
    all.dedup();
    all
}

fn read(reader: &mut Reader, lines: &[String]) -> Vec<Report> {
    let mut reports = Vec::new();
    for line in lines {
        reader.line(line.as_bytes(), NOW, |report| reports.push(report));
    }
    reports
}

/// The report of a line, where it has one.
fn report(reader: &mut Reader, line: impl AsRef<[u8]>, now: f64) -> Option<Report> {
    let mut found = None;
    reader.line(line.as_ref(), now, |report| found = Some(report));
    found
}

#[test]
fn parts_of_two_ships_that_alternate_become_two_messages() {
    // own sequence numbers
    let own = [
        sentence(&part(ALFA[0], 1, "1", "A")),
        sentence(&part(BRAVO[0], 1, "2", "A")),
        sentence(&part(ALFA[1], 2, "1", "A")),
        sentence(&part(BRAVO[1], 2, "2", "A")),
    ];
    // one sequence number from two receivers
    let sources = [("r1", ALFA), ("r2", BRAVO)];
    let of_source = |index: usize| {
        let lines = sources.iter();
        lines.map(move |(source, ship)| {
            tagged(
                &format!("s:{source}"),
                &part(ship[index], index + 1, "1", "A"),
            )
        })
    };
    let of_sources: Vec<String> = of_source(0).chain(of_source(1)).collect();
    // groups, whose source and time stand with the first part alone
    let groups = [
        tagged("g:1-2-41,s:r1,c:1565218798", &part(ALFA[0], 1, "1", "A")),
        tagged("g:1-2-42,s:r1,c:1565218798", &part(BRAVO[0], 1, "1", "A")),
        tagged("g:2-2-42", &part(BRAVO[1], 2, "1", "")),
        tagged("g:2-2-41", &part(ALFA[1], 2, "1", "")),
    ];
    // the second part first
    let turned = [
        own[2].clone(),
        own[0].clone(),
        own[3].clone(),
        own[1].clone(),
    ];
    for (index, lines) in [&own[..], &of_sources, &turned].into_iter().enumerate() {
        let mut reader = reader();
        let reports = read(&mut reader, lines);
        assert_eq!(identities(&reports).len(), 2, "{index} {}", reader.counts());
    }
    let mut reader = reader();
    // replayed later, by a clock that stands
    let reports = read(&mut reader, &groups);
    assert_eq!(identities(&reports).len(), 2, "{}", reader.counts());
    assert!(
        reports
            .iter()
            .all(|report| report.received == 1_565_218_798.0)
    );
}

#[test]
fn a_part_that_comes_late_or_twice_begins_another_message() {
    let parts = [1, 2].map(|number| sentence(&part(ALFA[number - 1], number, "1", "A")));
    let mut late = reader();
    assert!(report(&mut late, &parts[0], NOW).is_none());
    assert!(report(&mut late, &parts[1], NOW + 3.1).is_none());
    assert_eq!(late.counts().dropped(Dropped::LateParts), 1);
    late.finish(NOW, |report| panic!("{report:?}"));
    assert_eq!(late.counts().dropped(Dropped::LateParts), 2);
    // a station whose clock is wrong ends no message of another
    let mut clocks = reader();
    let wrong = tagged("s:r2,c:9999999999", &part(BRAVO[0], 1, "1", "A"));
    let lines = [
        tagged("s:r1,c:1700000000", &part(ALFA[0], 1, "1", "A")),
        wrong,
        tagged("s:r1,c:1700000000", &part(ALFA[1], 2, "1", "A")),
    ];
    assert_eq!(read(&mut clocks, &lines).len(), 1);
    // the other ship's first part with the same key starts anew
    let other = sentence(&part(BRAVO[0], 1, "1", "A"));
    let mut twice = reader();
    let lines = [parts[0].clone(), other, parts[1].clone()];
    let reports = read(&mut twice, &lines);
    assert_eq!(identities(&reports).len(), 1);
    assert_ne!(
        identities(&reports),
        identities(&read(&mut reader(), &parts))
    );
    assert_eq!(twice.counts().dropped(Dropped::LateParts), 1);
}

#[test]
fn times_of_tag_blocks_are_seconds_or_milliseconds() {
    let body = "AIVDM,1,1,,A,13mb9U0P00PRk8fT5nw>4?wj2006,0";
    for (tag, time) in [
        ("c:1565218798", 1_565_218_798.0),
        ("c:1565218798500", 1_565_218_798.5),
        ("c:1565218798.5", 1_565_218_798.5),
        ("c:soon", NOW),
        ("s:r1", NOW),
    ] {
        let found = report(&mut reader(), tagged(tag, body), NOW);
        assert_eq!(found.expect("a report").received, time, "{tag}");
    }
    let mut reader = reader();
    let wrong = format!("\\c:1565218798*00\\{}", sentence(body));
    let found = report(&mut reader, wrong, NOW);
    assert_eq!(found.expect("a report").received, NOW);
    assert_eq!(reader.counts().dropped(Dropped::TagCheckSum), 1);
}

#[test]
fn what_is_dropped_is_counted_by_its_reason() {
    let body = "AIVDM,1,1,,A,13mb9U0P00PRk8fT5nw>4?wj2006,0";
    let long = "A".repeat(600);
    for (line, why) in [
        ("noise".to_owned(), Dropped::NoSentence),
        ("\\c:1\\".to_owned(), Dropped::NoSentence),
        (format!("!{body}*00"), Dropped::CheckSum),
        (format!("!{body}"), Dropped::CheckSum),
        (sentence("GPGSV,1,1,00"), Dropped::OtherSentence),
        (
            sentence("AIVDM,1,2,,A,13mb9U0P00PRk8fT5nw>4?wj2006,0"),
            Dropped::Fields,
        ),
        (
            sentence("AIVDM,1,1,,A,13mb9U0P00PRk8fT5nw>4?wj2006,9"),
            Dropped::Fields,
        ),
        (
            sentence("AIVDM,1,1,,A,13mb~U0P00PRk8fT5nw>4?wj2006,0"),
            Dropped::Armour,
        ),
        (sentence("AIVDM,1,1,,A,13mb9U0P00,0"), Dropped::TooShort),
        (
            sentence("AIVDM,1,1,,A,63mb9U0P00PRk8fT5nw>4?wj2006,0"),
            Dropped::OtherMessage,
        ),
        (long, Dropped::TooLong),
    ] {
        let mut reader = reader();
        assert!(report(&mut reader, &line, NOW).is_none(), "{line}");
        assert_eq!(
            reader.counts().dropped(why),
            1,
            "{line} {}",
            reader.counts()
        );
        assert!(reader.counts().to_string().contains(why.word()));
    }
    // own ship's own message
    let own = sentence(&body.replace("VDM", "VDO"));
    assert!(report(&mut reader(), own, NOW).expect("a report").is_own);
}

/// Every line becomes a report, waits, or is counted.
#[test]
fn random_and_altered_lines_neither_panic_nor_vanish() {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(59);
    let body = "AIVDM,1,1,,A,13mb9U0P00PRk8fT5nw>4?wj2006,0";
    let mut reader = reader();
    for round in 0..200_000_u32 {
        let mut line = match round % 4 {
            0 => tagged("s:r1,c:1565218798", body),
            1 => sentence(&part(ALFA[0], 1, "1", "A")),
            2 => sentence(&part(BRAVO[1], 2, "1", "B")),
            _ => sentence(body),
        }
        .into_bytes();
        for _ in 0..rng.random_range(0..4) {
            let at = rng.random_range(0..line.len());
            line[at] = rng.random();
        }
        if rng.random_bool(0.1) {
            line.truncate(rng.random_range(0..line.len()));
        }
        if rng.random_bool(0.5) {
            // with a right check sum
            let begins = line.iter().position(|byte| *byte == b'!');
            let ends = line.iter().rposition(|byte| *byte == b'*');
            if let (Some(begins), Some(ends)) = (begins, ends)
                && begins < ends
            {
                let sum = line[begins + 1..ends]
                    .iter()
                    .fold(0, |sum, byte| sum ^ byte);
                line.truncate(ends);
                line.extend(format!("*{sum:02X}").bytes());
            }
        }
        reader.line(&line, NOW + f64::from(round) * 0.01, |_| {});
    }
    let counts = reader.counts();
    assert!(counts.reports > 10_000, "{counts}");
}

/// A stream may break anywhere.
#[test]
fn a_stream_in_pieces_gives_the_same_reports() {
    let file: String = (0..200)
        .map(|index| match index % 3 {
            0 => sentence(&part(ALFA[0], 1, "1", "A")) + "\r\n",
            1 => sentence(&part(ALFA[1], 2, "1", "A")) + "\n",
            _ => {
                tagged(
                    "c:1700000000",
                    "AIVDM,1,1,,A,13mb9U0P00PRk8fT5nw>4?wj2006,0",
                ) + "\r\n"
            }
        })
        .collect();
    let mut whole = Vec::new();
    reader().bytes(file.as_bytes(), NOW, |report| whole.push(report));
    assert_eq!(whole.len(), 133);
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
    for _ in 0..50 {
        let (mut pieces, mut rest) = (reader(), file.as_bytes());
        let mut found = Vec::new();
        while !rest.is_empty() {
            let (now, then) = rest.split_at(rng.random_range(1..=rest.len().min(90)));
            pieces.bytes(now, NOW, |report| found.push(report));
            rest = then;
        }
        pieces.finish(NOW, |report| found.push(report));
        assert_eq!(found, whole);
    }
}
