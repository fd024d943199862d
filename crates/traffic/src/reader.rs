//! From bytes to reports.

use crate::ais;
use crate::assembly::Assembler;
use crate::counts::{Counts, Dropped};
use crate::own::{self, Own, Reception};
use crate::radar::Radar;
use crate::report::{Report, SourceId};
use crate::sentence::{MOST_BYTES, Sentence, sentence};
use crate::settings::Settings;

/// Most sources that are told apart; later ones count as one.
const MOST_SOURCES: usize = 1000;

/// Reads sentences, keeps what waits for its other parts, and counts what is dropped.
///
/// ```
/// use searoom_traffic::{Reader, Settings};
///
/// let mut reader = Reader::new(Settings::default());
/// let line = b"\\c:1565218798*53\\!BSVDM,1,1,,A,13mb9U0P00PRk8fT5nw>4?wj2006,0*5D";
/// reader.line(line, 0.0, |report| {
///     let place = report.fix.and_then(|fix| fix.position).expect("a place").at;
///     assert!((place.lat_deg - 63.0746).abs() < 1e-4 && report.received == 1565218798.0);
/// });
/// assert_eq!(reader.counts().reports, 1);
/// ```
#[derive(Debug)]
pub struct Reader {
    settings: Settings,
    assembler: Assembler,
    counts: Counts,
    own: Own,
    radar: Radar,
    sources: Vec<Vec<u8>>,
    /// The beginning of a line whose end has not come.
    begun: Vec<u8>,
    /// True within a line that is too long.
    skips: bool,
}

impl Reader {
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            assembler: Assembler::default(),
            counts: Counts::default(),
            own: Own::default(),
            radar: Radar::default(),
            sources: Vec::new(),
            begun: Vec::new(),
            skips: false,
        }
    }

    pub fn counts(&self) -> &Counts {
        &self.counts
    }

    /// The name of a source, as it was sent.
    pub fn source(&self, source: SourceId) -> &[u8] {
        let known = self.sources.get(usize::from(source.0));
        known.map_or(b"others", Vec::as_slice)
    }

    /// Reads the next bytes of a stream, which may begin and end within a line. Lines without a time are dated
    /// `now`, in seconds of Unix time.
    pub fn bytes(&mut self, mut bytes: &[u8], now: f64, mut found: impl FnMut(Report)) {
        while let Some(end) = bytes.iter().position(|byte| *byte == b'\n') {
            let (line, rest) = (&bytes[..end], &bytes[end + 1..]);
            bytes = rest;
            match (self.skips, self.begun.is_empty()) {
                (true, _) => {}
                (false, true) => self.line(line, now, &mut found),
                (false, false) => {
                    let mut whole = std::mem::take(&mut self.begun);
                    whole.extend_from_slice(line);
                    self.line(&whole, now, &mut found);
                    whole.clear();
                    self.begun = whole;
                }
            }
            self.skips = false;
        }
        if !self.skips {
            self.begun.extend_from_slice(bytes);
            if self.begun.len() > MOST_BYTES {
                self.counts.lines += 1;
                self.counts.drop(Dropped::TooLong);
                (self.begun, self.skips) = (Vec::new(), true);
            }
        }
    }

    /// Reads the line at the end of a stream that has no line end, and ends messages that wait for parts.
    pub fn finish(&mut self, now: f64, found: impl FnMut(Report)) {
        self.skips = false;
        let line = std::mem::take(&mut self.begun);
        self.line(&line, now, found);
        self.assembler.finish(&mut self.counts);
    }

    /// Reads a whole line: its reports, or that of the message that it completes.
    pub fn line(&mut self, line: &[u8], now: f64, found: impl FnMut(Report)) {
        let line = line.trim_ascii();
        if line.is_empty() {
            return;
        }
        self.counts.lines += 1;
        let read = match line.len() > MOST_BYTES {
            true => Err(Dropped::TooLong),
            false => sentence(line),
        };
        let read = read.and_then(|sentence| self.sentence(&sentence, now, found));
        if let Err(why) = read {
            self.counts.drop(why);
        }
    }

    fn sentence(
        &mut self,
        sentence: &Sentence,
        now: f64,
        mut found: impl FnMut(Report),
    ) -> Result<(), Dropped> {
        if let Some(why) = sentence.ignored {
            self.counts.drop(why);
        }
        let formatter = sentence.formatter().ok_or(Dropped::OtherSentence)?;
        let is_own = formatter == b"VDO";
        if is_own || formatter == b"VDM" {
            let part = sentence.part(is_own)?;
            let source = part.tag.source.map(|name| self.source_of(name));
            let message = self.assembler.add(&part, (source, now), &mut self.counts);
            let Some(message) = message else {
                return Ok(());
            };
            self.counts.message(message.bits.unsigned(0, 6) as u8);
            let report = ais::report(&message, &self.settings)?;
            self.counts.reports += 1;
            if is_own {
                self.own.keep(&report);
            }
            found(report);
            return Ok(());
        }
        let fields = sentence.fields()?;
        let source = sentence.tag.source.map(|name| self.source_of(name));
        let received = sentence.tag.time.unwrap_or(now);
        let reception = Reception { received, source };
        if let Some(report) = own::report(formatter, &fields, reception, &self.settings) {
            let report = report?;
            self.own.keep(&report);
            self.counts.reports += 1;
            found(report);
            return Ok(());
        }
        let mut reports = 0;
        let is_of_radar = self.radar.read(
            formatter,
            &fields,
            reception,
            (&self.own, &self.settings),
            &mut self.counts,
            |report| {
                reports += 1;
                found(report);
            },
        );
        self.counts.reports += reports;
        match is_of_radar {
            true => Ok(()),
            false => Err(Dropped::OtherSentence),
        }
    }

    fn source_of(&mut self, name: &[u8]) -> SourceId {
        let known = self.sources.iter().position(|known| known == name);
        let index = known.unwrap_or_else(|| {
            if self.sources.len() < MOST_SOURCES {
                self.sources.push(name.to_vec());
                self.sources.len() - 1
            } else {
                MOST_SOURCES
            }
        });
        SourceId(index as u16)
    }
}
