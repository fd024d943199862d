//! Random and altered input of every format: no panic, sound sets, printable names, and every line counted.

use std::f64::consts::PI;
use std::time::Instant;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom_traffic::{Dropped, HullSet, Interval, Name, Reader, Report, Settings};

const NOW: f64 = 1_795_910_400.0;

/// Altered lines of each format.
const ROUNDS: usize = 100_000;

const SENTENCES: &str = include_str!("data/kystverket-1000-lines.nm4");

const OTHERS: &[&str] = &[
    "$GPRMC,120010,A,5630.0000,N,00312.0000,E,10.0,045.0,291126,,,D",
    "$GPGGA,120010,5630.0000,N,00312.0000,E,1,08,0.9,12.0,M,46.9,M,,",
    "$GNGNS,120010,5630.0000,N,00312.0000,E,AAN,13,0.9,12.0,46.9,,",
    "$GPGLL,5630.0000,N,00312.0000,E,120010,A,A",
    "$GPVTG,090.0,T,,M,12.0,N,22.2,K,A",
    "$HEHDT,045.0,T",
    "$HETHS,045.0,A",
    "$RATTM,07,4.00,120.0,R,12.0,270.0,R,0.5,10.0,N,TUG,T,,120010.00,A",
    "$RATLL,12,5630.000,N,00318.000,E,TUG,120010.00,T,",
    "$RATLB,7,PILOT,8,,9,FERRY",
    "!AIVDO,1,1,,A,13mb9U0P00PRk8fT5nw>4?wj2006,0",
];

const ROWS: &str = include_str!("data/danish-layout.csv");

const DELTAS: &[&str] = &[
    r#"{"name":"signalk-server","self":"vessels.urn:mrn:imo:mmsi:257000005"}"#,
    r#"{"context":"vessels.self","updates":[{"timestamp":"2022-01-03T00:00:00Z","$source":"a","values":[{"path":"navigation.position","value":{"latitude":56.5,"longitude":3.2}},{"path":"navigation.speedOverGround","value":5.1}]}]}"#,
    r#"{"context":"vessels.urn:mrn:imo:mmsi:257000001","updates":[{"values":[{"path":"navigation.courseOverGroundTrue","value":1.0},{"path":"navigation.headingTrue","value":null},{"path":"navigation.rateOfTurn","value":-0.01},{"path":"design.length","value":{"overall":200}},{"path":"design.beam","value":30},{"path":"sensors.ais.fromBow","value":60},{"path":"sensors.ais.fromCenter","value":-5}]}]}"#,
    r#"{"context":"atons.urn:mrn:imo:mmsi:992570001","updates":[{"values":[{"path":"","value":{"name":"BUOY","mmsi":"992570001"}},{"path":"virtual","value":true}]}]}"#,
    r#"{"version":"1.7.0","vessels":{"urn:mrn:imo:mmsi:257000002":{"navigation":{"speedOverGround":{"value":4.0,"timestamp":"2022-01-03T00:00:00Z"}}}}}"#,
];

/// Some bytes become others, go, or come twice.
fn altered(rng: &mut ChaCha8Rng, line: &str) -> Vec<u8> {
    let mut line = line.as_bytes().to_vec();
    for _ in 0..rng.random_range(0..4) {
        let at = rng.random_range(0..line.len().max(1)).min(line.len());
        match rng.random_range(0..4) {
            0 if at < line.len() => line[at] = rng.random(),
            // one digit or sign for another reaches farther than noise
            1 if at < line.len() => {
                line[at] = b"0123456789-.,\"{}[]eENSTR"[rng.random_range(0..23)]
            }
            2 => line.truncate(at),
            _ => {
                let to = (at + rng.random_range(0..9)).min(line.len());
                let again = line[at..to].to_vec();
                line.splice(at..at, again);
            }
        }
    }
    line.retain(|byte| *byte != b'\n');
    line
}

/// A sentence whose check sum is right again, after its tag block.
fn summed(mut line: Vec<u8>) -> Vec<u8> {
    let Some(begin) = line.iter().rposition(|byte| matches!(byte, b'!' | b'$')) else {
        return line;
    };
    let end = line.iter().rposition(|byte| *byte == b'*');
    line.truncate(end.filter(|end| *end > begin).unwrap_or(line.len()));
    let sum = line[begin + 1..].iter().fold(0, |sum, byte| sum ^ byte);
    line.extend(format!("*{sum:02X}").bytes());
    line
}

fn is_sound(set: Interval) -> bool {
    set.least <= set.most && !set.least.is_nan()
}

fn is_printable(name: Option<Name>) -> bool {
    name.is_none_or(|name| !name.as_str().is_empty() && !name.as_str().contains(char::is_control))
}

fn check(report: &Report) {
    assert!(report.received.is_finite(), "{report:?}");
    assert!(
        is_printable(report.name) && is_printable(report.call_sign),
        "{report:?}"
    );
    if let Some(fix) = report.fix {
        assert!(
            is_sound(fix.time) && fix.time.most - fix.time.least < 1e3,
            "{report:?}"
        );
        for directions in [fix.velocity.course, fix.heading] {
            assert!(directions.middle.is_finite(), "{report:?}");
            assert!((0.0..=PI).contains(&directions.half), "{report:?}");
        }
        let speed = fix.velocity.speed;
        assert!(
            is_sound(speed) && speed.least >= 0.0 && speed.least.is_finite(),
            "{report:?}"
        );
        assert!(fix.turn_rate.is_none_or(is_sound), "{report:?}");
        if let Some(set) = fix.position {
            assert!(set.at.is_on_earth() && set.radius_m >= 0.0, "{report:?}");
            let half = set.half_cell_m;
            assert!(
                half.x >= 0.0 && half.y > 0.0 && half.norm().is_finite(),
                "{report:?}"
            );
        }
        assert!(fix.velocity.outer(13.0).vertices().len() >= 3, "{report:?}");
    }
    if let Some(HullSet {
        length,
        beam,
        ahead,
        astern,
        port,
        starboard,
    }) = report.hull
    {
        for side in [length, beam, ahead, astern, port, starboard] {
            assert!(
                is_sound(side) && side.least >= 0.0 && side.most.is_finite(),
                "{report:?}"
            );
        }
    }
}

/// Reads altered lines, and says how fast.
fn read(name: &str, first: &str, mut line: impl FnMut(&mut ChaCha8Rng) -> Vec<u8>) -> Reader {
    let mut rng = ChaCha8Rng::seed_from_u64(59);
    let mut reader = Reader::new(Settings::default());
    reader.line(first.as_bytes(), NOW, |report| check(&report));
    let lines: Vec<Vec<u8>> = (0..ROUNDS).map(|_| line(&mut rng)).collect();
    let begun = Instant::now();
    for (index, line) in lines.iter().enumerate() {
        reader.line(line, NOW + 0.01 * index as f64, |report| check(&report));
    }
    let rate = ROUNDS as f64 / begun.elapsed().as_secs_f64();
    eprintln!(
        "{name}: {rate:.0} altered lines a second\n{}",
        reader.counts()
    );
    reader.finish(NOW, |report| check(&report));
    assert!(
        reader.counts().reports > ROUNDS as u64 / 20,
        "{name} {}",
        reader.counts()
    );
    reader
}

#[test]
fn altered_sentences() {
    let lines: Vec<&str> = SENTENCES.lines().chain(OTHERS.iter().copied()).collect();
    read("sentences", lines[0], |rng| {
        let line = match rng.random_bool(0.5) {
            true => lines[rng.random_range(0..lines.len())],
            false => OTHERS[rng.random_range(0..OTHERS.len())],
        };
        let line = altered(rng, line);
        if rng.random_bool(0.9) {
            summed(line)
        } else {
            line
        }
    });
}

#[test]
fn altered_rows() {
    let lines: Vec<&str> = ROWS.lines().collect();
    let mut minute = 0;
    read("rows", lines[0], |rng| {
        minute += 1;
        let line = lines[rng.random_range(1..lines.len())];
        // each at its own time, so that not all are there twice
        let time = format!("2026 {:02}:{:02}:", minute / 60 % 24, minute % 60);
        let at = line.find("2026 ").expect("a time");
        altered(rng, &format!("{}{time}{}", &line[..at], &line[at + 11..]))
    });
}

#[test]
fn altered_documents() {
    let reader = read("documents", DELTAS[0], |rng| {
        let delta = DELTAS[rng.random_range(0..DELTAS.len())];
        altered(rng, delta)
    });
    assert!(reader.counts().dropped(Dropped::Document) > 1000);
}

#[test]
fn noise() {
    let mut rng = ChaCha8Rng::seed_from_u64(60);
    for round in 0..2000 {
        let mut reader = Reader::new(Settings::default());
        for _ in 0..8 {
            let length = rng.random_range(0..2000);
            let mut bytes: Vec<u8> = (0..length).map(|_| rng.random()).collect();
            if round % 2 == 0 {
                bytes.insert(0, b"!$\\{m"[rng.random_range(0..5)]);
            }
            reader.bytes(&bytes, NOW, |report| check(&report));
        }
        reader.finish(NOW, |report| check(&report));
    }
}

/// A stream may break anywhere, whatever it holds.
#[test]
fn streams_in_pieces_give_the_same_reports() {
    let mut rng = ChaCha8Rng::seed_from_u64(61);
    let sentences: String = SENTENCES
        .lines()
        .take(50)
        .map(|line| format!("{line}\n"))
        .collect();
    let pretty =
        "{\n \"vessels\": {\n  \"urn:mrn:imo:mmsi:1\": {\n   \"name\": \"A\"\n  }\n }\n}\n";
    for file in [
        sentences,
        ROWS.to_owned(),
        DELTAS.join("\r\n") + "\n" + pretty,
    ] {
        let mut whole = Vec::new();
        let mut reader = Reader::new(Settings::default());
        reader.bytes(file.as_bytes(), NOW, |report| whole.push(report));
        reader.finish(NOW, |report| whole.push(report));
        assert!(whole.len() > 3);
        for _ in 0..50 {
            let (mut pieces, mut rest) = (Reader::new(Settings::default()), file.as_bytes());
            let mut found = Vec::new();
            while !rest.is_empty() {
                let (now, then) = rest.split_at(rng.random_range(1..=rest.len().min(90)));
                pieces.bytes(now, NOW, |report| found.push(report));
                rest = then;
            }
            pieces.finish(NOW, |report| found.push(report));
            assert_eq!(found, whole);
            assert_eq!(pieces.counts(), reader.counts());
        }
    }
}
