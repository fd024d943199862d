//! A stream of reports on its way into the picture.

use searoom_traffic::{Identity, Picture, PictureSettings, Reader, Settings, Taken};

/// Seconds by which a report may be ahead of the feed's clock. A report that is farther ahead moves the clock
/// only where the next one agrees with it: one wrong time must not make every ship old.
const JUMP_S: f64 = 60.0;

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
    /// Farther ahead, until another report agrees.
    ahead: f64,
}

impl FeedClock {
    fn hear(&mut self, time: f64) {
        let is_near = |from: f64| (time - from).abs() <= JUMP_S;
        // the first time is taken as it is
        if self.time.is_nan() || is_near(self.time) || is_near(self.ahead) {
            self.time = self.time.max(time);
            self.ahead = f64::NAN;
        } else if time > self.time {
            self.ahead = time;
        }
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
            clock: FeedClock {
                time: f64::NAN,
                ahead: f64::NAN,
            },
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
            let own = report
                .fix
                .filter(|_| report.is_own && report.received == now);
            let time = own.map_or(report.received, |fix| fix.time.most.max(report.received));
            if time == UNDATED {
                *undated += 1;
            } else if time > *until {
                *left_out += 1;
            } else {
                clock.hear(time);
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

    /// What is known of own ship and the others.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Time of the clock, seconds of Unix time; NaN before the first report.
    pub fn time(&self) -> f64 {
        self.clock.time
    }

    /// Number of reports after the end that was asked for.
    pub fn left_out(&self) -> u64 {
        self.left_out
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
    fn one_wrong_time_does_not_move_the_clock() {
        let mut clock = FeedClock {
            time: f64::NAN,
            ahead: f64::NAN,
        };
        let after = |time: f64, clock: &mut FeedClock| {
            clock.hear(time);
            clock.time
        };
        let times = [
            100.0, 110.0, 105.0, 9e9, 120.0, 3000.0, 3010.0, 50.0, 3020.0,
        ];
        let expected = [
            100.0, 110.0, 110.0, 110.0, 120.0, 120.0, 3010.0, 3010.0, 3020.0,
        ];
        assert_eq!(times.map(|time| after(time, &mut clock)), expected);
    }
}
