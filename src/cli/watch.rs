//! `searoom watch`: own ship in live or recorded traffic.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use anyhow::{Context, bail};
use searoom::document::PlanDocument;
use searoom::input::InputError;
use searoom::report::{watch_text, write_atomically};
use searoom::scenario::FILE_MEBIBYTES;
use searoom::traffic::{Arrival, Feed, Identity, Moment, PictureSettings, Settings, Source, Watch};

use super::args::WatchArgs;
use super::input::files;
use super::output::{Output, json, json_line};
use super::runner::guarded;
use super::simulate::catch_interrupt;
use super::status::ExitStatus;

/// Arrivals that wait for being read; a source that sends more waits.
const WAITING: usize = 1024;

/// Longest line that is read at once, bytes.
const LINE: u64 = 1 << 16;

/// Seconds without reports after which a recorded feed goes on from the next one.
const GAP_S: f64 = 600.0;

/// Watches until the traffic ends, the time is over, or Ctrl-C.
pub fn watch(args: &WatchArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    let name = files::name(&args.scenario);
    let text = files::text(&args.scenario, FILE_MEBIBYTES, "a scenario file")?;
    let folder = args.scenario.parent().unwrap_or(Path::new(""));
    let watch = match Watch::new(&text, folder, args.compliance) {
        Ok(watch) => watch,
        Err(faults) => return Ok(output.refuse(&InputError::faults(&name, faults))),
    };
    let picture = PictureSettings {
        own: args.own.map(Identity::Mmsi),
        own_reach_m: watch.own_reach(),
        ..PictureSettings::default()
    };
    let mut view = Viewer {
        args,
        output,
        watch,
        feed: Feed::new(
            &Settings::default(),
            args.listen.len(),
            picture,
            f64::INFINITY,
        ),
        events: Vec::new(),
        status: ExitStatus::Good,
    };
    let interrupted = catch_interrupt(output);
    match args.listen.as_slice() {
        [Source::File(file)] => replay(&mut view, file, &interrupted)?,
        sources
            if sources
                .iter()
                .any(|source| matches!(source, Source::File(_))) =>
        {
            let found = "a file beside another source";
            bail!("--listen: found {found}; allowed: one file alone, or sources that are live");
        }
        _ if args.speed != 1.0 => bail!(
            "--speed: found {}; allowed: with one file alone",
            args.speed
        ),
        sources => live(&mut view, sources, &interrupted)?,
    }
    let counted = view.feed.counted();
    if view.feed.reports() == 0 && matches!(args.listen.as_slice(), [Source::File(_)]) {
        let name = args.listen[0].name();
        let counted = counted.join(", ");
        return Ok(output.refuse(&format_args!(
            "{name}: found no report of a ship ({counted}); allowed: sentences of NMEA 0183, CSV of AIS \
             reports, or Signal K deltas"
        )));
    }
    output.notes(None, &[("traffic".to_owned(), counted)]);
    Ok(view.status)
}

/// What shows the moments.
struct Viewer<'a> {
    args: &'a WatchArgs,
    output: &'a Output,
    watch: Watch,
    feed: Feed,
    events: Vec<String>,
    status: ExitStatus,
}

impl Viewer<'_> {
    fn show(&mut self, time: f64) -> anyhow::Result<()> {
        let begun = Instant::now();
        let found = guarded(|| self.watch.at(self.feed.picture(), time));
        let mut moment = match found {
            Ok(moment) => moment,
            Err(fault) => {
                self.status = self.status.max(self.output.fault(&fault));
                return Ok(());
            }
        };
        moment.document.took_s = begun.elapsed().as_secs_f64();
        moment.document.events.splice(0..0, self.events.drain(..));
        let shown = match self.args.json {
            true => self.output.print(&json_line(&moment.document)?),
            false => self
                .output
                .screen(&watch_text(&moment.document, self.output.display)),
        };
        if moment.document.took_s > self.args.every_s {
            let took = moment.document.took_s;
            self.events.push(format!(
                "the last moment took {took:.1} s, more than there is between two"
            ));
        }
        let kept = self.keep_plan(&moment)?;
        self.status = self.status.max(shown).max(kept);
        Ok(())
    }

    /// Writes the newest plan; it stays where there is no newer one.
    fn keep_plan(&self, moment: &Moment) -> anyhow::Result<ExitStatus> {
        let (Some(file), Some(run)) = (&self.args.plan, &moment.run) else {
            return Ok(ExitStatus::Good);
        };
        let text = json(&PlanDocument::of(run.as_ref()))?;
        Ok(match write_atomically(file, text.as_bytes()) {
            Ok(()) => ExitStatus::Good,
            Err(error) => self.output.refuse(&error),
        })
    }
}

/// Reads a file at the pace at which it was recorded, times the speed that was asked for.
fn replay(view: &mut Viewer, file: &Path, interrupted: &AtomicBool) -> anyhow::Result<()> {
    let opened = File::open(file).map_err(|error| InputError::unread(file, error))?;
    let mut lines = BufReader::new(opened);
    let (every, speed) = (view.args.every_s, view.args.speed);
    let mut line = Vec::new();
    let mut next = f64::NAN;
    let mut first = f64::NAN;
    let begun = Instant::now();
    loop {
        line.clear();
        let read = (&mut lines).take(LINE).read_until(b'\n', &mut line);
        if read.with_context(|| format!("{}: cannot be read on", file.display()))? == 0 {
            break;
        }
        view.feed.recorded(0, &line);
        let time = view.feed.time();
        let set_by = view.feed.clock_set_by();
        if set_by != 0.0 {
            view.events.push(format!(
                "the times of the reports go on {set_by:.0} s from before"
            ));
            if set_by < 0.0 {
                (first, next) = (first + set_by, time);
            }
        }
        if time.is_nan() {
            continue;
        }
        if next.is_nan() {
            (first, next) = (time, time.floor() + every);
        }
        if time - next > GAP_S {
            let gap = time - next;
            view.events.push(format!("no reports for {gap:.0} s"));
            next = time;
        }
        while next <= time {
            if interrupted.load(Ordering::Relaxed) || is_over(view, next - first) {
                return Ok(());
            }
            let due = Duration::try_from_secs_f64((next - first) / speed).unwrap_or_default();
            if wait(due.saturating_sub(begun.elapsed()), interrupted) {
                return Ok(());
            }
            view.show(next)?;
            next += every;
        }
    }
    view.feed.finish(0);
    if !next.is_nan() && !is_over(view, next - first) {
        view.show(next)?;
    }
    Ok(())
}

/// Takes in what arrives from all sources, and shows a moment at each time that is due.
fn live(view: &mut Viewer, sources: &[Source], interrupted: &AtomicBool) -> anyhow::Result<()> {
    let (sender, arrivals) = mpsc::sync_channel(WAITING);
    for (index, source) in sources.iter().enumerate() {
        (source.clone().open(index, sender.clone()))
            .with_context(|| format!("--listen {}", source.name()))?;
        view.events.push(format!("listening: {}", source.name()));
    }
    drop(sender);
    let clock = Clock::begun();
    let mut next = clock.at(Instant::now()) + view.args.every_s;
    let first = clock.wall;
    let mut open = sources.len();
    while !interrupted.load(Ordering::Relaxed) {
        let due = Duration::try_from_secs_f64(next - clock.at(Instant::now())).unwrap_or_default();
        match arrivals.recv_timeout(due.min(SLICE)) {
            Ok(Arrival::Bytes(source, bytes, when)) => {
                view.feed.live(source, &bytes, clock.at(when));
            }
            Ok(Arrival::Event(event)) => view.events.push(event),
            Ok(Arrival::End(source)) => {
                view.feed.live(source, b"\n", clock.at(Instant::now()));
                open -= 1;
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => open = 0,
        }
        let time = clock.at(Instant::now());
        if time >= next || open == 0 {
            view.show(time)?;
            // moments that were missed are not made up for
            next = (next + view.args.every_s).max(clock.at(Instant::now()));
        }
        if open == 0 || is_over(view, time - first) {
            break;
        }
    }
    Ok(())
}

/// The machine's clock at the beginning, and time since: a clock that is set in between moves no moment.
struct Clock {
    /// Seconds of Unix time.
    wall: f64,
    begun: Instant,
}

impl Clock {
    fn begun() -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Self {
            wall: since.map_or(0.0, |since| since.as_secs_f64()),
            begun: Instant::now(),
        }
    }

    fn at(&self, when: Instant) -> f64 {
        self.wall + when.saturating_duration_since(self.begun).as_secs_f64()
    }
}

/// Longest time without a look at Ctrl-C.
const SLICE: Duration = Duration::from_millis(200);

/// Waits; true where Ctrl-C ends that.
fn wait(time: Duration, interrupted: &AtomicBool) -> bool {
    let until = Instant::now() + time;
    loop {
        if interrupted.load(Ordering::Relaxed) {
            return true;
        }
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return false;
        }
        std::thread::sleep(left.min(SLICE));
    }
}

fn is_over(view: &Viewer, elapsed: f64) -> bool {
    view.output.is_closed() || view.args.duration_s.is_some_and(|most| elapsed > most)
}
