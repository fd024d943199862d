//! A stream of reports on its way into the picture.

use searoom_traffic::{
    Fix, Identity, MissingColumn, Picture, PictureSettings, Reader, Settings, Taken,
};

/// Seconds by which a report may be off the feed's clock. One that is farther off moves the clock only where
/// [`AGREE`] in a row agree: a wrong time must not make every ship old.
const JUMP_S: f64 = 60.0;

/// Reports in a row that move the clock.
const AGREE: u32 = 10;

/// No date of real traffic is before this, 9 September 2001: a time of day without a date is.
const DATED: f64 = 1e9;

/// The reader of a stream, the picture that it draws, and its clock.
///
/// Live, the clock is that of the machine. Otherwise it is the time of the latest report, so that a file is
/// read as it was sent.
#[derive(Debug)]
pub struct Feed {
    /// One per source, because each may end within a line.
    readers: Vec<Reader>,
    picture: Picture,
    clock: FeedClock,
    /// Reports after it are left out.
    until: f64,
    left_out: u64,
    undated: u64,
}

#[derive(Debug, Clone, Copy)]
struct FeedClock {
    time: f64,
    /// Another time, on which so many reports in a row agree.
    other: (f64, u32),
    /// Seconds by which the clock was set, until that is told.
    set_by: f64,
}

impl FeedClock {
    const UNKNOWN: Self = Self {
        time: f64::NAN,
        other: (f64::NAN, 0),
        set_by: 0.0,
    };

    /// Hears a time. True where the clock goes back.
    fn hear(&mut self, time: f64) -> bool {
        let off = time - self.time;
        // the first time is taken as it is
        if off.is_nan() || off.abs() <= JUMP_S {
            self.time = self.time.max(time);
            self.other = (f64::NAN, 0);
            return false;
        }
        let (other, count) = self.other;
        let agrees = (time - other).abs() <= JUMP_S;
        self.other = (time, if agrees { count + 1 } else { 1 });
        if self.other.1 < AGREE {
            return false;
        }
        self.set_by += off;
        self.time = time;
        self.other = (f64::NAN, 0);
        off < 0.0
    }
}

impl Feed {
    /// A feed of some sources without reports after a time, seconds of Unix time.
    pub fn new(settings: &Settings, sources: usize, picture: PictureSettings, until: f64) -> Self {
        Self {
            readers: (0..sources)
                .map(|_| Reader::new(settings.clone()))
                .collect(),
            picture: Picture::new(picture),
            clock: FeedClock::UNKNOWN,
            until,
            left_out: 0,
            undated: 0,
        }
    }

    /// Reads the next bytes of a file, dated by their own times. Lines without one are taken to be of the time
    /// of the line before.
    pub fn recorded(&mut self, source: usize, bytes: &[u8]) {
        for line in bytes.split_inclusive(|byte| *byte == b'\n') {
            self.recorded_line(source, line);
        }
    }

    fn recorded_line(&mut self, source: usize, line: &[u8]) {
        // no report of real traffic is of this time
        const UNDATED: f64 = 0.0;
        let now = match self.clock.time.is_nan() {
            true => UNDATED,
            false => self.clock.time,
        };
        let Self {
            picture,
            clock,
            left_out,
            undated,
            until,
            ..
        } = self;
        let Some(reader) = self.readers.get_mut(source) else {
            return;
        };
        reader.bytes(line, now, |report| {
            // own ship's receiver has a clock of its own, where the lines have none
            let is_dated = |fix: &Fix| fix.time.most > DATED;
            let own = report
                .fix
                .filter(|fix| report.is_own && report.received == now && is_dated(fix));
            let time = own.map_or(report.received, |fix| fix.time.most.max(report.received));
            if time == UNDATED {
                *undated += 1;
            } else if time > *until {
                *left_out += 1;
            } else {
                if clock.hear(time) {
                    picture.set_back(clock.time);
                }
                picture.take(&report, clock.time);
            }
        });
    }

    /// Reads the next bytes of a live stream at a time of the machine's clock.
    pub fn live(&mut self, source: usize, bytes: &[u8], now: f64) {
        self.clock.time = now;
        let picture = &mut self.picture;
        let Some(reader) = self.readers.get_mut(source) else {
            return;
        };
        reader.bytes(bytes, now, |report| {
            picture.take(&report, now);
        });
    }

    /// The end of a source: what waits for its other parts has none.
    pub fn finish(&mut self, source: usize) {
        self.recorded(source, b"\n");
        let (picture, time) = (&mut self.picture, self.clock.time);
        if let Some(reader) = self.readers.get_mut(source)
            && !time.is_nan()
        {
            reader.finish(time, |report| {
                picture.take(&report, time);
            });
        }
    }

    /// Seconds by which the clock of a recorded feed was set since this was asked, because many reports in a
    /// row had another time; zero where it was not.
    pub fn clock_set_by(&mut self) -> f64 {
        std::mem::take(&mut self.clock.set_by)
    }

    /// What a table lacks, where it is one that cannot be read.
    pub fn missing_columns(&self) -> impl Iterator<Item = (usize, &MissingColumn)> {
        let readers = self.readers.iter().enumerate();
        readers.filter_map(|(index, reader)| Some((index, reader.missing_column()?)))
    }

    /// Number of reports of all sources.
    pub fn reports(&self) -> u64 {
        self.readers
            .iter()
            .map(|reader| reader.counts().reports)
            .sum()
    }

    /// What is known of own ship and the others.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Time of the clock, seconds of Unix time; NaN before the first report.
    pub fn time(&self) -> f64 {
        self.clock.time
    }

    /// What was read, and what became of it, a line each; only what there is.
    pub fn counted(&self) -> Vec<String> {
        let counts = self
            .readers
            .iter()
            .map(|reader| reader.counts().to_string());
        let mut lines: Vec<String> = counts
            .flat_map(|text| text.lines().map(str::to_owned).collect::<Vec<_>>())
            .collect();
        let taken = Taken::WORDS
            .iter()
            .map(|(word, what)| (self.picture.taken(*what), *word));
        let [forgotten, crowded_out] = self.picture.forgotten();
        let more = [
            (self.left_out, "reports after the time that was asked for"),
            (self.undated, "reports before any time was known"),
            (forgotten, "ships forgotten after a long silence"),
            (crowded_out, "ships forgotten because there were too many"),
        ];
        let counted = taken.chain(more).filter(|(count, _)| *count > 0);
        lines.extend(counted.map(|(count, word)| format!("{count} {word}")));
        let own = self.picture.own_identities();
        if own.len() > 1 {
            let own: Vec<String> = own.iter().map(Identity::to_string).collect();
            lines.push(format!(
                "more than one own ship: {}; the first is taken",
                own.join(", ")
            ));
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_time_does_not_move_the_clock_and_ten_do() {
        let mut clock = FeedClock::UNKNOWN;
        let after = |time: f64, clock: &mut FeedClock| {
            clock.hear(time);
            clock.time
        };
        let times = [100.0, 110.0, 105.0, 9e9, 120.0, 3000.0, 3010.0, 50.0, 119.0];
        let expected = [
            100.0, 110.0, 110.0, 110.0, 120.0, 120.0, 120.0, 120.0, 120.0,
        ];
        assert_eq!(times.map(|time| after(time, &mut clock)), expected);
        for step in 0..9 {
            assert!(!clock.hear(3000.0 + f64::from(step)) && clock.time == 120.0);
        }
        assert!(!clock.hear(3010.0) && clock.time == 3010.0);
        // and back, after a first line that was a day ahead
        for _ in 0..9 {
            assert!(!clock.hear(500.0));
        }
        assert!(clock.hear(501.0) && clock.time == 501.0);
        assert_eq!(clock.set_by, 501.0 - 120.0);
    }
}
