//! From bytes to reports.

use crate::ais;
use crate::assembly::Assembler;
use crate::counts::{Counts, Dropped};
use crate::documents::{Documents, MOST_DOCUMENT_BYTES};
use crate::own::{self, Own, Reception};
use crate::radar::Radar;
use crate::report::{Name, Report, SourceId};
use crate::sentence::{MOST_BYTES, Sentence, sentence};
use crate::settings::Settings;
use crate::signalk::{SignalK, Sources};
use crate::table::{Cells, MissingColumn, Table};

/// Most sources that are told apart; later ones count as one.
const MOST_SOURCES: usize = 1000;

/// Letters of a source's name that tell it from others.
const MOST_LETTERS: usize = 64;

/// Longest line of a table, and of what may be the names of its columns, bytes.
const MOST_ROW_BYTES: usize = 65_536;

/// What a stream consists of. The first line that is of one of these decides.
#[derive(Debug, Default)]
pub(crate) enum Format {
    #[default]
    Unknown,
    Sentences,
    Table(Box<(Table, Cells)>),
    Json(Box<(Documents, SignalK)>),
}

/// Reads sentences, rows or documents, keeps what waits for its other parts, and counts what is dropped.
///
/// The first line decides what the stream consists of: a sentence of NMEA 0183, the names of a table's
/// columns, or a document of Signal K. A line that is none of them is dropped, and the next one decides.
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
    pub(crate) settings: Settings,
    pub(crate) format: Format,
    assembler: Assembler,
    pub(crate) counts: Counts,
    own: Own,
    radar: Radar,
    sources: Numbered,
    /// The beginning of a line whose end has not come.
    begun: Vec<u8>,
    /// True within a line that is too long.
    skips: bool,
}

impl Reader {
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            format: Format::Unknown,
            assembler: Assembler::default(),
            counts: Counts::default(),
            own: Own::default(),
            radar: Radar::default(),
            sources: Numbered::default(),
            begun: Vec::new(),
            skips: false,
        }
    }

    pub fn counts(&self) -> &Counts {
        &self.counts
    }

    /// Names of the table's columns that are not read; empty for sentences.
    pub fn unread_columns(&self) -> &[String] {
        self.table().map_or(&[], Table::unread)
    }

    /// The column whose lack makes every row of the table be dropped.
    pub fn missing_column(&self) -> Option<&MissingColumn> {
        self.table().and_then(Table::missing)
    }

    fn table(&self) -> Option<&Table> {
        match &self.format {
            Format::Table(of) => Some(&of.0),
            _ => None,
        }
    }

    /// The name of a source: what can be seen of it, up to 64 characters.
    pub fn source(&self, source: SourceId) -> &[u8] {
        let known = self.sources.0.get(usize::from(source.0));
        known.map_or(b"others", Vec::as_slice)
    }

    /// Reads the next bytes of a stream, which may begin and end within a line. Lines without a time are
    /// dated
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
            let most = match self.format {
                Format::Sentences => MOST_BYTES,
                Format::Json(_) => MOST_DOCUMENT_BYTES,
                _ if self.begun.trim_ascii_start().first() == Some(&b'{') => MOST_DOCUMENT_BYTES,
                _ => MOST_ROW_BYTES,
            };
            if self.begun.len() > most {
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
        if let Format::Json(of) = &mut self.format
            && of.0.finish()
        {
            self.counts.drop(Dropped::Document);
        }
        self.assembler.finish(&mut self.counts);
    }

    /// Reads a whole line: its reports, or that of the message that it completes.
    pub fn line(&mut self, line: &[u8], now: f64, found: impl FnMut(Report)) {
        // a document that goes over many lines is indented
        let line = line.trim_ascii_end();
        let (indented, line) = (line, line.trim_ascii_start());
        if line.is_empty() {
            return;
        }
        self.counts.lines += 1;
        let read = match self.format {
            Format::Sentences => self.of_sentences(line, now, found),
            _ => self.of_another(indented, now, found),
        };
        if let Err(why) = read {
            self.counts.drop(why);
        }
    }

    fn of_sentences(
        &mut self,
        line: &[u8],
        now: f64,
        found: impl FnMut(Report),
    ) -> Result<(), Dropped> {
        match line.len() > MOST_BYTES {
            true => Err(Dropped::TooLong),
            false => self.sentence(&sentence(line)?, now, found),
        }
    }

    /// Reads a line of a table or of a document, or one that decides what the stream consists of.
    #[inline(never)]
    fn of_another(
        &mut self,
        indented: &[u8],
        now: f64,
        mut found: impl FnMut(Report),
    ) -> Result<(), Dropped> {
        let line = indented.trim_ascii_start();
        if let Format::Unknown = self.format {
            match begins(line) {
                // the names of columns
                Some(format @ Format::Table(_)) => {
                    self.format = format;
                    return Ok(());
                }
                Some(format) => self.format = format,
                None => {}
            }
        }
        match &mut self.format {
            Format::Table(of) => {
                let (table, cells) = &mut **of;
                row(line, table, cells, &self.settings).map(|report| {
                    report.into_iter().for_each(|report| {
                        self.counts.reports += 1;
                        found(report);
                    });
                })
            }
            Format::Json(of) => {
                let (documents, signal_k) = &mut **of;
                let counts = &mut self.counts;
                if let Some(document) = documents.add(indented, |why| counts.drop(why)) {
                    let about = (&self.settings, &mut self.sources);
                    let own = &mut self.own;
                    signal_k.read(&document, now, about, counts, |report| {
                        own.keep(&report);
                        found(report);
                    });
                }
                Ok(())
            }
            _ => self.of_sentences(line, now, found),
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
            let source = part.tag.source.map(|name| self.sources.number(name));
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
        self.sensor(formatter, sentence, now, found)
    }

    /// Reads a sentence of own ship's sensors or of its radar; apart, so that AIS, of which there is most, stays
    /// fast.
    #[inline(never)]
    fn sensor(
        &mut self,
        formatter: &[u8; 3],
        sentence: &Sentence,
        now: f64,
        mut found: impl FnMut(Report),
    ) -> Result<(), Dropped> {
        let fields = sentence.fields()?;
        let source = sentence.tag.source.map(|name| self.sources.number(name));
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
}

/// The sources that are told apart, by their names.
#[derive(Debug, Default)]
struct Numbered(Vec<Vec<u8>>);

impl Numbered {
    fn index(&self, name: &[u8]) -> Option<usize> {
        self.0.iter().position(|known| known == name)
    }
}

impl Sources for Numbered {
    fn number(&mut self, name: &[u8]) -> SourceId {
        let index = self.index(name).unwrap_or_else(|| {
            let name = Name::printable(&String::from_utf8_lossy(name), MOST_LETTERS);
            let known = self.index(name.as_bytes());
            if known.is_none() && self.0.len() < MOST_SOURCES {
                self.0.push(name.into_bytes());
                return self.0.len() - 1;
            }
            known.unwrap_or(MOST_SOURCES)
        });
        SourceId(index as u16)
    }
}

/// What a stream consists of that begins with a line; `None` where the line is of nothing that is read.
fn begins(line: &[u8]) -> Option<Format> {
    if line.len() > MOST_ROW_BYTES && line[0] != b'{' {
        return None;
    }
    // a mark of the order of bytes
    let line = line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line);
    match line.first()? {
        b'!' | b'$' | b'\\' => Some(Format::Sentences),
        b'{' => Some(Format::Json(Box::default())),
        _ => {
            let mut cells = Cells::default();
            let table = Table::new(cells.of(str::from_utf8(line).ok()?)?)?;
            Some(Format::Table(Box::new((table, cells))))
        }
    }
}

/// The report of a line of a table.
fn row(
    line: &[u8],
    table: &mut Table,
    cells: &mut Cells,
    settings: &Settings,
) -> Result<Option<Report>, Dropped> {
    if line.len() > MOST_ROW_BYTES {
        return Err(Dropped::TooLong);
    }
    let line = String::from_utf8_lossy(line);
    table.report(cells.of(&line).ok_or(Dropped::Row)?, settings)
}
