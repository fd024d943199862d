//! Who is where: what is known of each ship, and its sets at a time.
//!
//! ```text
//! Report ─► Picture: own ship, and per identity its places, size, name and status ─► View: sets at a time
//! ```
//!
//! Sets, bounds and assumptions are those of docs/reference/traffic.md, section "Picture".

mod own;
mod ship;
mod track;

use std::collections::HashMap;

use searoom_geometry::frame::{Geographic, Georeference, KNOT_MPS, Vector, radians_from_deg};

use crate::fields::metres;
use crate::report::{Fix, HullSet, Identity, Kind, Name, Note, Notes, PositionSet, Report, Status};
pub use own::OwnPosition;
use own::OwnShip;
use ship::is_no_ship;
pub use ship::{Listed, OFF_PLANE, STALE, Ship, WITHOUT_PLACE};
use track::Track;

/// How ships may have moved since their last fix, what is assumed of them from now on, and what is kept.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureSettings {
    /// Greatest speed of a ship, and of a craft or a ship with AIS of class B, m/s, unless it says itself that
    /// it is faster.
    pub fastest_mps: [f64; 2],
    /// Greatest acceleration to any side since the last fix, of a ship and of a craft, m/s².
    pub acceleration_mps2: [f64; 2],
    /// A ship that is slower may be at rest, m/s.
    pub rest_mps: f64,
    /// How fast a ship at rest may drift or get under way until it is heard again, m/s.
    pub drift_mps: f64,
    /// A ship that has been at the same place for this time in seconds is lying there,
    pub lying_s: f64,
    /// and moves at most this fast, m/s.
    pub lying_mps: f64,
    /// By how much a ship may change its speed from now on, m/s.
    pub speed_spread_mps: f64,
    /// By how much it may change its course, radians.
    pub course_spread: f64,
    /// A turn that is reported goes on for this time, seconds.
    pub turning_s: f64,
    /// Age from which a fix is too old to plan with, seconds: twice the longest time between the reports of a
    /// ship.
    pub stale_s: f64,
    /// Silence after which a ship is forgotten, seconds.
    pub forgotten_s: f64,
    /// A long-range report does not count while a finer fix is younger, seconds.
    pub coarse_s: f64,
    /// Age from which own ship's position is too old, seconds.
    pub own_stale_s: f64,
    /// How far own ship's middle may be from its antenna where it does not send its size, metres.
    pub own_reach_m: f64,
    /// True where own ship is taken to be where its last fix has it, so that its error is not beside the others'
    /// sets.
    pub own_is_exact: bool,
    /// Most identities; beyond that the ones that are old and far are forgotten first.
    pub most_ships: usize,
    /// Own ship's identity, where reports of it from others are its position.
    pub own: Option<Identity>,
}

impl Default for PictureSettings {
    fn default() -> Self {
        Self {
            fastest_mps: [25.0 * KNOT_MPS, 50.0 * KNOT_MPS],
            acceleration_mps2: [0.2, 0.5],
            rest_mps: KNOT_MPS,
            drift_mps: 0.5,
            lying_s: 180.0,
            lying_mps: 0.1,
            speed_spread_mps: 0.5,
            course_spread: radians_from_deg(5.0),
            turning_s: 60.0,
            stale_s: 360.0,
            forgotten_s: 3600.0,
            coarse_s: 180.0,
            own_stale_s: 10.0,
            own_reach_m: 0.0,
            own_is_exact: false,
            most_ships: 100_000,
            own: None,
        }
    }
}

searoom_geometry::words! {
    /// What became of a report.
    pub enum Taken {
        /// A newer fix of a ship.
        Fix => "fixes",
        /// Size, name or status alone.
        Static => "reports of size and name",
        /// Own ship's position, motion or heading.
        Own => "own ship's",
        /// Own ship's position at a place where it cannot be, while another one is fresh.
        OwnElsewhere => "own ship's at a place where it cannot be",
        /// Own ship heard back as another ship.
        Echo => "echoes of own ship",
        /// A fix that is not newer than the one that is known.
        NotNewer => "fixes that are not newer",
        /// A long-range report beside a fresh finer one.
        Coarse => "long-range fixes beside finer ones",
        /// An identity at a second place: another ship with the same number, or a jump.
        SecondPlace => "fixes at a second place of the same ship",
        /// Speed, course or heading without a place, of a ship whose place is known.
        Motion => "reports of speed and heading alone",
        /// A ship without a place.
        WithoutPlace => "fixes without a place",
    }
}

/// Most places of one identity.
const MOST_PLACES: usize = 4;

/// A fix that is ahead of the clock by more was dated by a clock that is wrong, seconds.
const AHEAD_S: f64 = 2.0;

/// How much earlier such a fix may be, seconds.
const WRONG_CLOCK_S: f64 = 60.0;

/// Share of the identities that are forgotten at once where there are too many.
const FORGOTTEN_SHARE: f64 = 0.1;

/// Metres from own ship within which ships are the last to be forgotten.
const NEAR_M: f64 = 30_000.0;

/// Seconds between two searches for ships to be forgotten.
const SWEEP_S: f64 = 60.0;

/// All that is known of one identity.
#[derive(Debug, Clone)]
struct Known {
    kind: Kind,
    hull: Option<(HullSet, Notes)>,
    name: Option<Name>,
    type_code: Option<u8>,
    status: Option<Status>,
    /// When it was heard last, seconds.
    heard: f64,
    /// Its places: one, unless two ships have the same number.
    tracks: Vec<Track>,
    /// Places that it has had, so that each keeps its number.
    places: u32,
    /// Places that were forgotten because there were too many.
    left: u64,
}

/// The last known state of own ship and of every ship that was heard.
///
/// Memory is bounded: at most [`PictureSettings::most_ships`] identities with four places each. A report
/// costs one look-up.
///
/// ```
/// use searoom_geometry::frame::{Geographic, Georeference};
/// use searoom_traffic::{Picture, PictureSettings, Reader, Settings};
///
/// let (mut reader, mut picture) = (Reader::new(Settings::default()), Picture::new(PictureSettings::default()));
/// let line = b"\\c:1565218798*53\\!BSVDM,1,1,,A,13mb9U0P00PRk8fT5nw>4?wj2006,0*5D\n";
/// reader.bytes(line, 0.0, |report| {
///     picture.take(&report, report.received);
/// });
/// let plane = Georeference::new(Geographic { lat_deg: 63.1, lon_deg: 9.4 }).expect("on the earth");
/// let view = picture.at(1565218800.0, &plane, searoom_traffic::Reach::ALL);
/// assert_eq!(view.ships.len(), 1);
/// ```
#[derive(Debug, Clone)]
pub struct Picture {
    settings: PictureSettings,
    known: HashMap<Identity, Known>,
    own: OwnShip,
    taken: [u64; Taken::WORDS.len()],
    forgotten: u64,
    crowded_out: u64,
    swept: f64,
}

/// Which ships matter: those that may come within a distance of own ship in a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// How far own ship comes in this time, metres, and what is kept clear around it.
    pub own_m: f64,
    /// Seconds.
    pub within_s: f64,
}

impl Reach {
    /// Every ship.
    pub const ALL: Self = Self {
        own_m: f64::INFINITY,
        within_s: 0.0,
    };
}

/// The picture at a time, on a plane.
#[derive(Debug, Clone)]
pub struct View {
    /// Seconds of Unix time.
    pub time: f64,
    /// Own ship, where its position is not too old.
    pub own: Option<OwnPosition>,
    /// Ships to keep clear of, in order of identity: those whose sets may come within the reach that was asked
    /// for.
    pub ships: Vec<Ship>,
    /// Number of ships beyond it.
    pub beyond: usize,
    /// Ships that are in no set: not heard for too long, heard without a place, and what is no ship.
    pub listed: Vec<Listed>,
}

impl Picture {
    pub fn new(settings: PictureSettings) -> Self {
        Self {
            own: OwnShip::new(settings.own),
            settings,
            known: HashMap::new(),
            taken: [0; _],
            forgotten: 0,
            crowded_out: 0,
            swept: f64::NEG_INFINITY,
        }
    }

    pub fn settings(&self) -> &PictureSettings {
        &self.settings
    }

    /// Number of identities that are known.
    pub fn ships(&self) -> usize {
        self.known.len()
    }

    /// Number of reports by what became of them.
    pub fn taken(&self, what: Taken) -> u64 {
        self.taken[what as usize]
    }

    /// Number of ships that were forgotten after a long silence, and of those that left because there were too
    /// many.
    pub fn forgotten(&self) -> [u64; 2] {
        [self.forgotten, self.crowded_out]
    }

    /// The identities of own ship that were heard, in order of time; more than one is a fault of the feed.
    pub fn own_identities(&self) -> &[Identity] {
        self.own.identities()
    }

    /// Own ship's last known place, however old.
    pub fn own_place(&self) -> Option<Geographic> {
        self.own.place()
    }

    /// Own ship's name, where it was heard.
    pub fn own_name(&self) -> Option<&str> {
        self.own.name().map(Name::as_str)
    }

    /// Takes in a report at a time of the picture's clock, seconds of Unix time. A fix that is dated later than
    /// `now` was dated by a wrong clock: it may be a minute old.
    pub fn take(&mut self, report: &Report, now: f64) -> Taken {
        let what = self.taken_as(report, now);
        self.taken[what as usize] += 1;
        if now - self.swept >= SWEEP_S {
            self.swept = now;
            self.forget(now);
        }
        what
    }

    fn taken_as(&mut self, report: &Report, now: f64) -> Taken {
        let fix = report.fix.map(|mut fix| {
            if !(fix.time.most <= now + AHEAD_S) {
                fix.time.most = now;
                fix.time.least = fix.time.least.min(now - WRONG_CLOCK_S);
            }
            fix
        });
        if let Some(what) = self.own.take(report, fix) {
            // what was heard of it before was no other ship
            self.known.remove(&report.identity);
            return what;
        }
        if !self.known.contains_key(&report.identity)
            && self.known.len() >= self.settings.most_ships
        {
            self.make_room();
        }
        let known = (self.known.entry(report.identity)).or_insert_with(|| Known::new(report.kind));
        known.learn(report, now);
        let Some(fix) = fix else {
            return Taken::Static;
        };
        let Some(position) = fix.position else {
            // a sensor of speed or heading alone says nothing of the place
            return match report.notes.has(Note::NoPosition) {
                true => Taken::WithoutPlace,
                false => known.steady(&fix),
            };
        };
        known.place(fix, position, report.notes, &self.settings)
    }

    /// Forgets what is dated after a time, because the clock was wrong until then.
    pub fn set_back(&mut self, now: f64) {
        for known in self.known.values_mut() {
            known.heard = known.heard.min(now);
            (known.tracks).retain(|track| track.fix.time.least <= now + AHEAD_S);
        }
        self.own.set_back(now + AHEAD_S);
        self.swept = self.swept.min(now);
    }

    /// Forgets ships that were not heard for long.
    fn forget(&mut self, now: f64) {
        let (before, longest) = (self.known.len(), self.settings.forgotten_s);
        self.known.retain(|_, known| now - known.heard <= longest);
        self.forgotten += (before - self.known.len()) as u64;
        for known in self.known.values_mut() {
            let places = known.tracks.len();
            (known.tracks).retain(|track| now - track.fix.time.most <= longest);
            self.forgotten += (places - known.tracks.len()) as u64;
            self.crowded_out += std::mem::take(&mut known.left);
        }
    }

    /// Forgets a share of the ships: those heard longest ago, and of these the farthest from own ship first.
    fn make_room(&mut self) {
        let own = self.own.place();
        let far = |known: &Known| match (own, known.tracks.last()) {
            (Some(own), Some(track)) => metres(own, track.position.at).norm(),
            _ => f64::INFINITY,
        };
        let mut ages: Vec<(bool, i64, f64, Identity)> = self
            .known
            .iter()
            .map(|(identity, known)| {
                let far = far(known);
                (
                    far <= NEAR_M,
                    (known.heard / SWEEP_S) as i64,
                    -far,
                    *identity,
                )
            })
            .collect();
        ages.sort_by(|a, b| {
            (a.0.cmp(&b.0))
                .then(a.1.cmp(&b.1))
                .then(a.2.total_cmp(&b.2))
                .then(a.3.cmp(&b.3))
        });
        let leave = ((FORGOTTEN_SHARE * ages.len() as f64) as usize).max(1);
        for (.., identity) in &ages[..leave.min(ages.len())] {
            self.known.remove(identity);
            self.crowded_out += 1;
        }
    }

    /// Sets of all ships at a time that may come within reach of own ship, or of the plane's origin where own
    /// ship is not known. Ships are in order of their identities. O(ships).
    pub fn at(&self, time: f64, plane: &Georeference, reach: Reach) -> View {
        let own = self.own.at(time, plane, &self.settings);
        let about = own
            .as_ref()
            .map_or(Vector::zeros(), |own| own.pose.position);
        let own_error = own.as_ref().map_or(0.0, |own| own.radius_m);
        let beside = if self.settings.own_is_exact {
            0.0
        } else {
            own_error
        };
        let mut view = View {
            time,
            own,
            ships: Vec::new(),
            beyond: 0,
            listed: Vec::new(),
        };
        let mut identities: Vec<&Identity> = self.known.keys().collect();
        identities.sort_unstable();
        for identity in identities {
            let known = &self.known[identity];
            if let Some(why) = known.is_no_ship() {
                view.listed.push(known.listed(*identity, why, time));
                continue;
            }
            if known.tracks.is_empty() {
                view.listed
                    .push(known.listed(*identity, ship::WITHOUT_PLACE, time));
            }
            for track in &known.tracks {
                let age = time - track.fix.time.least;
                if !(age <= self.settings.stale_s) {
                    view.listed.push(known.listed(*identity, ship::STALE, time));
                    continue;
                }
                match known.ship(*identity, track, (time, beside), plane, &self.settings) {
                    None => view
                        .listed
                        .push(known.listed(*identity, ship::OFF_PLANE, time)),
                    Some(ship) if ship.is_within(about, reach) => view.ships.push(ship),
                    Some(_) => view.beyond += 1,
                }
            }
        }
        ship::name_apart(&mut view.ships);
        view
    }
}

impl Known {
    fn new(kind: Kind) -> Self {
        Self {
            kind,
            hull: None,
            name: None,
            type_code: None,
            status: None,
            heard: f64::NEG_INFINITY,
            tracks: Vec::new(),
            places: 0,
            left: 0,
        }
    }

    /// What a report says beside its fix.
    fn learn(&mut self, report: &Report, now: f64) {
        self.heard = self.heard.max(now);
        // a long-range message does not tell the class, and a number that a ship's position had is a ship's
        let is_ship = !self.tracks.is_empty() && self.is_no_ship().is_none();
        if report.kind != Kind::Ship && !(is_ship && is_no_ship(report.kind).is_some()) {
            self.kind = report.kind;
        }
        if let Some(hull) = report.hull {
            // a size that was sent is not replaced by none
            let is_none = report.notes.has(Note::NoSize);
            if !is_none || self.hull.is_none_or(|(_, notes)| notes.has(Note::NoSize)) {
                self.hull = Some((hull, report.notes));
            }
        }
        self.name = report.name.or(self.name);
        self.type_code = report.type_code.or(self.type_code);
        self.status = report.status.or(self.status);
    }

    /// Puts a fix to the place that it may come from.
    fn place(
        &mut self,
        fix: Fix,
        position: PositionSet,
        notes: Notes,
        settings: &PictureSettings,
    ) -> Taken {
        let fastest = self.fastest(settings);
        let new = Track::new(fix, position, notes);
        let may_be = (self.tracks.iter().enumerate())
            .filter(|(_, track)| new.apart(track, fastest) <= 0.0)
            .map(|(index, track)| (index, metres(track.position.at, position.at).norm()));
        if let Some((index, _)) = may_be.min_by(|a, b| a.1.total_cmp(&b.1)) {
            let track = &mut self.tracks[index];
            if !(new.fix.time.most > track.fix.time.most) {
                return Taken::NotNewer;
            }
            if new.is_coarse()
                && !track.is_coarse()
                && new.fix.time.most - track.fix.time.most < settings.coarse_s
            {
                return Taken::Coarse;
            }
            track.follow(new, settings.rest_mps);
            return Taken::Fix;
        }
        self.places += 1;
        let is_second = !self.tracks.is_empty();
        if self.tracks.len() >= MOST_PLACES {
            let oldest = (self.tracks.iter().enumerate())
                .min_by(|a, b| a.1.fix.time.most.total_cmp(&b.1.fix.time.most));
            let oldest = oldest.map_or(0, |(index, _)| index);
            self.tracks.remove(oldest);
            self.left += 1;
        }
        let mut track = new;
        track.number = self.places;
        self.tracks.push(track);
        match is_second {
            true => Taken::SecondPlace,
            false => Taken::Fix,
        }
    }

    /// Speed, course and heading alone are those of the newest place.
    fn steady(&mut self, fix: &Fix) -> Taken {
        let newest = self.tracks.iter_mut();
        match newest.max_by(|a, b| a.fix.time.most.total_cmp(&b.fix.time.most)) {
            Some(track) => {
                track.steady(fix);
                Taken::Motion
            }
            None => Taken::WithoutPlace,
        }
    }

    fn is_craft(&self) -> bool {
        // a ship of an unknown class may be a craft
        matches!(
            self.kind,
            Kind::ClassB | Kind::Craft | Kind::Distress | Kind::Radar | Kind::Ship
        )
    }

    fn fastest(&self, settings: &PictureSettings) -> f64 {
        settings.fastest_mps[usize::from(self.is_craft())]
    }
}
