//! Sentences a second on one core, beside the crate aivdm: `cargo bench -p searoom-traffic`.
//!
//! Both read the Norwegian sample over and over: ours makes sets, theirs decodes fields. The answers are
//! checked first.

use std::hint::black_box;
use std::time::Instant;

use aivdm::nmea::{FragmentAssembler, Sentence};
use searoom_traffic::{Reader, Settings};

const FILE: &[u8] = include_bytes!("../tests/data/kystverket-1000-lines.nm4");
const ROUNDS: usize = 300;

/// Reports of the file, read so many times.
fn ours(rounds: usize) -> usize {
    let mut reader = Reader::new(Settings::default());
    let mut reports = 0;
    for _ in 0..rounds {
        reader.bytes(FILE, 0.0, |report| {
            black_box(&report);
            reports += 1;
        });
        reader.finish(0.0, |_| reports += 1);
    }
    reports
}

/// Messages of the file, decoded so many times.
fn theirs(rounds: usize) -> usize {
    let text = str::from_utf8(FILE).expect("text");
    let mut assembler = FragmentAssembler::<1024>::new();
    let mut messages = 0;
    for line in (0..rounds).flat_map(|_| text.lines()) {
        let Ok(sentence) = Sentence::parse(line) else {
            continue;
        };
        let whole = match sentence.fragment_count {
            1 => aivdm::decode_payload(sentence.payload, sentence.fill_bits).ok(),
            _ => match assembler.push(&sentence) {
                Ok(Some(whole)) => aivdm::decode_payload(whole.armored, whole.fill_bits).ok(),
                _ => None,
            },
        };
        messages += usize::from(black_box(whole).is_some());
    }
    messages
}

fn main() {
    assert_eq!((ours(1), theirs(1)), (877, 877));
    for round in 1..=3 {
        for (name, read) in [
            ("searoom-traffic", ours as fn(usize) -> usize),
            ("aivdm 0.3.0", theirs),
        ] {
            let begun = Instant::now();
            black_box(read(ROUNDS));
            let seconds = begun.elapsed().as_secs_f64();
            let lines = (ROUNDS * FILE.split(|byte| *byte == b'\n').count()) as f64;
            println!(
                "{round} {name}: {:.2} million sentences a second",
                1e-6 * lines / seconds
            );
        }
    }
}
