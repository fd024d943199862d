//! The tables `[simulation]` and `[targets.behaviour]`: how a scenario is sailed in the closed
//! loop. Plans do not use them.

use super::limits;
use super::plane::Plane;
use searoom_geometry::frame::{Vector, heading_from_course_deg, radians_from_deg};
use searoom_input::{Field, Range, Table, every};
use searoom_model::vessel::Hull;
use searoom_model::{BehaviourKind, SailedVessel, SensorType};

/// How a scenario is sailed. Times in seconds, lengths in metres, angles in radians.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationSettings {
    /// Step of the simulation.
    pub step: f64,
    /// Longest time from one plan to the next.
    pub replan: f64,
    /// True where an event asks for a plan before that.
    pub replan_on_events: bool,
    /// Time from the data of a plan to its start.
    pub delay: f64,
    /// Time after which the simulation ends; `None` for the horizon.
    pub duration: Option<f64>,
    /// Seed of every random number.
    pub seed: u64,
    /// Own ship's true motion; `None` for that of its planner's model.
    pub vessel: Option<VesselModel>,
    /// Motion of the water.
    pub current: Current,
    /// Sensor of own ship.
    pub sensor: Sensor,
    /// True motion of each target, in the scenario's order; constant where there is none.
    pub behaviours: Vec<Behaviour>,
    /// Fields that the reports of each target leave out, in the scenario's order; none where there
    /// is none.
    pub not_reported: Vec<NotReported>,
    /// Seconds from which own ship can see each target, in the scenario's order; from the start
    /// where there is none.
    pub seen_from: Vec<f64>,
}

/// Fields that the AIS reports of a target leave out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct NotReported {
    /// The heading: the hull may lie at any angle to the course.
    pub heading: bool,
    /// Length and beam.
    pub size: bool,
}

impl NotReported {
    /// The hull to assume of a target with a reported hull, or of `default` size. It holds the
    /// hull; without a heading it holds the hull at every heading.
    pub fn outer_hull(self, reported: Hull, default: Hull) -> Hull {
        let hull = if self.size { default } else { reported };
        if self.heading {
            let diagonal = 2.0 * hull.half_diagonal();
            return Hull::new(diagonal, diagonal);
        }
        hull
    }
}

/// Own ship's true motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VesselModel {
    /// The planners' model: lines and arcs, speed changes at once.
    Kinematic,
    /// Turn rate and speed approach the ordered ones exponentially.
    FirstOrder {
        /// Time constant of the turn rate.
        course_time: f64,
        /// Time constant of the speed.
        speed_time: f64,
    },
    /// Nomoto's first-order model, `T r' + r = K rudder`, with limits of the rudder.
    Nomoto {
        /// `K' = K L / U`.
        gain: f64,
        /// `T' = T U / L`.
        time: f64,
        /// Largest rudder angle.
        rudder: f64,
        /// Largest rate of the rudder.
        rudder_rate: f64,
        /// Time constant of the speed.
        speed_time: f64,
    },
}

/// Current: a constant and a Gauss-Markov process.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Current {
    /// m/s.
    pub mean: Vector,
    /// Standard deviation of each component, m/s.
    pub std: f64,
    /// Time constant of the process.
    pub time: f64,
    /// True where own ship's steering allows for it.
    pub known: bool,
}

impl Current {
    /// True where the water is at rest.
    pub fn is_none(&self) -> bool {
        self.mean == Vector::zeros() && self.std == 0.0
    }
}

/// Kind of sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SensorKind {
    /// The true position and velocity in every step.
    Exact,
    /// Reports of position, course and speed, of class A or B.
    Ais {
        /// Class A reports every 2 to 10 s under way, class B every 30 s.
        class_a: bool,
    },
    /// Positions alone.
    Radar,
}

/// Standard deviations of a measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Metres per axis.
    pub position: f64,
    /// Radians.
    pub course: f64,
    /// m/s.
    pub speed: f64,
}

/// Sensor of own ship.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensor {
    /// Kind of reports.
    pub kind: SensorKind,
    /// Metres between the centres beyond which no target is seen.
    pub range: f64,
    /// Standard deviations of the reports.
    pub noise: Noise,
    /// Standard deviations that the tracker assumes.
    pub assumed: Noise,
    /// Root of the spectral density of the acceleration that the tracker assumes, m/s^1.5.
    pub acceleration: f64,
    /// Time between reports; `None` for the intervals of AIS.
    pub interval: Option<f64>,
    /// Time from a measurement to its arrival.
    pub latency: f64,
    /// Probability that a report arrives.
    pub detection: f64,
    /// Times without any report.
    pub silent: Vec<[f64; 2]>,
    /// Mean time from the end of a drop-out to the next one; infinite for none.
    pub dropout_every: f64,
    /// Mean time of a drop-out.
    pub dropout_lasts: f64,
    /// Time of reports before the start.
    pub settle: f64,
    /// A target that has not been heard of for this time is stale.
    pub stale: f64,
    /// Hull of a target that does not report its size.
    pub default_hull: Hull,
}

impl Sensor {
    /// The sensor without any error.
    pub const EXACT: Self = Self {
        kind: SensorKind::Exact,
        range: f64::INFINITY,
        noise: Noise::NONE,
        assumed: Noise::NONE,
        acceleration: 0.0,
        interval: None,
        latency: 0.0,
        detection: 1.0,
        silent: Vec::new(),
        dropout_every: f64::INFINITY,
        dropout_lasts: 0.0,
        settle: 0.0,
        stale: f64::INFINITY,
        default_hull: Hull::new(100.0, 20.0),
    };
}

impl Noise {
    /// No noise.
    pub const NONE: Self = Self {
        position: 0.0,
        course: 0.0,
        speed: 0.0,
    };
}

/// True motion of a target. The spreads are those of the target in the file.
#[derive(Debug, Clone, PartialEq)]
pub enum Behaviour {
    /// Keeps course and speed.
    Constant,
    /// Takes a random course and speed within `factor` times its spreads every so many seconds.
    Random {
        /// Seconds.
        every: f64,
        /// 1 keeps to the spreads.
        factor: f64,
    },
    /// Takes an extreme course and speed of `factor` times its spreads every so many seconds.
    Extremes {
        /// Seconds.
        every: f64,
        /// 1 keeps to the spreads.
        factor: f64,
    },
    /// Takes the course and speed within its spreads that bring it nearest to own ship.
    Pursuit {
        /// Seconds.
        every: f64,
    },
    /// Is at these places at these times, seconds, on straight lines between them.
    Track(Vec<(f64, Vector)>),
    /// Turns to starboard before the closest approach, and back when own ship is past.
    GivesWay {
        /// Radians, positive to starboard.
        turn: f64,
        /// Seconds before the closest approach of the centres.
        before: f64,
        /// Probability that it does; else it keeps course and speed.
        probability: f64,
        /// Radians per second.
        turn_rate: f64,
    },
    /// Plans as own ship does, with own ship as its only target.
    Mutual,
}

impl Behaviour {
    /// Its kind, named in files.
    pub fn kind(&self) -> BehaviourKind {
        match self {
            Self::Constant => BehaviourKind::Constant,
            Self::Random { .. } => BehaviourKind::Random,
            Self::Extremes { .. } => BehaviourKind::Extremes,
            Self::Pursuit { .. } => BehaviourKind::Pursuit,
            Self::Track(_) => BehaviourKind::Track,
            Self::GivesWay { .. } => BehaviourKind::GivesWay,
            Self::Mutual => BehaviourKind::Mutual,
        }
    }
}

impl VesselModel {
    /// Its kind, which has a word in files.
    pub fn kind(&self) -> SailedVessel {
        match self {
            Self::Kinematic => SailedVessel::Kinematic,
            Self::FirstOrder { .. } => SailedVessel::FirstOrder,
            Self::Nomoto { .. } => SailedVessel::Nomoto,
        }
    }
}

impl SensorKind {
    /// Its type, named in files.
    pub fn sensor_type(self) -> SensorType {
        match self {
            Self::Exact => SensorType::Exact,
            Self::Ais { .. } => SensorType::Ais,
            Self::Radar => SensorType::Radar,
        }
    }
}

impl Default for SimulationSettings {
    fn default() -> Self {
        Self {
            step: 0.5,
            replan: 20.0,
            replan_on_events: false,
            delay: 1.0,
            duration: None,
            seed: 1,
            vessel: None,
            current: Current {
                mean: Vector::zeros(),
                std: 0.0,
                time: 600.0,
                known: false,
            },
            sensor: Sensor::EXACT,
            behaviours: Vec::new(),
            not_reported: Vec::new(),
            seen_from: Vec::new(),
        }
    }
}

pub(super) const STEP: Range = Range::between(0.01, 10.0);
pub(super) const DELAY: Range = Range::between(0.0, 1e6);
pub(super) const SEED: Range = Range::between(0.0, 9e15);
pub(super) const TIME_CONSTANT: Range = Range::between(0.01, 1e6);
pub(super) const NOMOTO: Range = Range::between(0.01, 100.0);
pub(super) const RUDDER_DEG: Range = Range::between(1.0, 90.0);
pub(super) const CURRENT: Range = Range::between(0.0, 20.0);
pub(super) const ANGLE_STD_DEG: Range = Range::between(0.0, 90.0);
pub(super) const DETECTION: Range = Range::between(0.01, 1.0);
pub(super) const PROBABILITY: Range = Range::between(0.0, 1.0);
pub(super) const FACTOR: Range = Range::between(0.0, 10.0);
pub(super) const TURN_DEG: Range = Range::within(180.0);
pub(super) const SILENT_TIMES: usize = 1000;

/// The table `[simulation]`, which may be absent; `targets` are the keys of the targets for it.
pub(super) fn simulation(root: &mut Table, targets: Vec<SimulatedTarget>) -> SimulationSettings {
    let mut standard = SimulationSettings::default();
    for target in targets {
        standard.behaviours.push(target.behaviour);
        standard.not_reported.push(target.not_reported);
        standard.seen_from.push(target.seen_from);
    }
    let field = root.take("simulation");
    let Some(mut table) = field.and_then(|field| field.table("a table")) else {
        return standard;
    };
    let settings = SimulationSettings {
        step: table.number_or("step_s", STEP, standard.step),
        replan: table.number_or("replan_s", limits::DURATION, standard.replan),
        replan_on_events: table.read_or("replan", standard.replan_on_events, |field| {
            field.choice(&[("period", false), ("events", true)])
        }),
        delay: table.number_or("delay_s", DELAY, standard.delay),
        duration: table.number("duration_s", limits::DURATION),
        seed: table.read_or("seed", standard.seed, |field| {
            field.whole_number(SEED).map(|seed| seed as u64)
        }),
        vessel: table.take("vessel").and_then(|field| vessel(&field)),
        current: table.read_or("current", standard.current, |field| {
            current(field, standard.current)
        }),
        sensor: table.read_or("sensor", standard.sensor, sensor),
        ..standard
    };
    table.finish();
    settings
}

fn vessel(field: &Field) -> Option<VesselModel> {
    type Read = fn(&mut Table) -> VesselModel;
    const KINDS: [(&str, Read); 3] = [
        (SailedVessel::Kinematic.word(), |_| VesselModel::Kinematic),
        (SailedVessel::FirstOrder.word(), |table| {
            VesselModel::FirstOrder {
                course_time: table.number_or("course_time_s", TIME_CONSTANT, 3.0),
                speed_time: table.number_or("speed_time_s", TIME_CONSTANT, 5.0),
            }
        }),
        (SailedVessel::Nomoto.word(), |table| VesselModel::Nomoto {
            gain: table.number_or("gain", NOMOTO, 1.0),
            time: table.number_or("time", NOMOTO, 1.0),
            rudder: radians_from_deg(table.number_or("rudder_deg", RUDDER_DEG, 35.0)),
            rudder_rate: radians_from_deg(table.number_or(
                "rudder_rate_deg_per_s",
                RUDDER_DEG,
                5.0,
            )),
            speed_time: table.number_or("speed_time_s", TIME_CONSTANT, 5.0),
        }),
    ];
    let mut table = field.table("a table with the key kind")?;
    let kind = table
        .require_first("kind", "\"kinematic\", \"first-order\" or \"nomoto\"")?
        .choice(&KINDS)?;
    let model = kind(&mut table);
    table.finish();
    Some(model)
}

fn current(field: &Field, standard: Current) -> Option<Current> {
    let mut table = field.table("a table")?;
    let speed = table.speed("speed", CURRENT).unwrap_or(0.0);
    let toward = table.number_or("toward_deg", limits::COURSE, 0.0);
    let current = Current {
        mean: searoom_geometry::frame::direction(heading_from_course_deg(toward)) * speed,
        std: table.number_or("std_mps", CURRENT, standard.std),
        time: table.number_or("time_s", TIME_CONSTANT, standard.time),
        known: table.read_or("known", false, |field| {
            field.choice(&[("yes", true), ("no", false)])
        }),
    };
    table.finish();
    Some(current)
}

fn noise(table: &mut Table, standard: Noise) -> Noise {
    Noise {
        position: table.number_or("position_std_m", limits::DISTANCE, standard.position),
        course: table.read_or("course_std_deg", standard.course, |field| {
            field.number(ANGLE_STD_DEG).map(radians_from_deg)
        }),
        speed: table.number_or("speed_std_mps", limits::SPEED, standard.speed),
    }
}

fn sensor(field: &Field) -> Option<Sensor> {
    let mut table = field.table("a table with the key kind")?;
    let mut kind = match table
        .require_first("kind", "\"exact\", \"ais\" or \"radar\"")?
        .choice(SensorType::WORDS)?
    {
        SensorType::Exact => SensorKind::Exact,
        SensorType::Ais => SensorKind::Ais { class_a: true },
        SensorType::Radar => SensorKind::Radar,
    };
    let range = table.number_or("range_m", limits::LENGTH, Sensor::EXACT.range);
    let mut default_hull = Sensor::EXACT.default_hull;
    let (interval, standard) = match kind {
        SensorKind::Exact => {
            table.finish();
            return Some(Sensor {
                range,
                ..Sensor::EXACT
            });
        }
        SensorKind::Ais { .. } => {
            let Hull { length, beam } = &mut default_hull;
            *length = table.number_or("default_length_m", limits::SHIP_LENGTH, *length);
            *beam = table.number_or("default_beam_m", limits::SHIP_LENGTH, *beam);
            let class_a = table.choice("class", &[("a", true), ("b", false)]);
            let class_a = class_a.unwrap_or(true);
            kind = SensorKind::Ais { class_a };
            let standard = Noise {
                position: 10.0,
                course: radians_from_deg(2.0),
                speed: 0.3,
            };
            (table.number("interval_s", TIME_CONSTANT), standard)
        }
        SensorKind::Radar => {
            let position = 20.0;
            let standard = Noise {
                position,
                ..Noise::NONE
            };
            let interval = table.number_or("interval_s", TIME_CONSTANT, 3.0);
            (Some(interval), standard)
        }
    };
    let found = noise(&mut table, standard);
    let assumed = table.read_or("assumed", found, |field| {
        let mut table = field.table("a table")?;
        let assumed = noise(&mut table, found);
        table.finish();
        Some(assumed)
    });
    let acceleration = table.number_or("acceleration", CURRENT, 0.02);
    let latency = table.number_or("latency_s", DELAY, 0.0);
    let detection = table.number_or("detection", DETECTION, 1.0);
    let silent = table.read_or("silent_s", Vec::new(), silent);
    let never = (f64::INFINITY, 0.0);
    let (dropout_every, dropout_lasts) = table.read_or("dropout", never, |field| {
        let mut table = field.table("a table")?;
        let every = table.required_number("every_s", TIME_CONSTANT);
        let lasts = table.required_number("lasts_s", TIME_CONSTANT);
        table.finish();
        every.zip(lasts)
    });
    let sensor = Sensor {
        kind,
        range,
        noise: found,
        assumed,
        acceleration,
        interval,
        latency,
        detection,
        silent,
        dropout_every,
        dropout_lasts,
        settle: table.number_or("settle_s", DELAY, 60.0),
        stale: table.number_or("stale_s", TIME_CONSTANT, 180.0),
        default_hull,
    };
    table.finish();
    Some(sensor)
}

fn silent(field: &Field) -> Option<Vec<[f64; 2]>> {
    let times = field.list(0..=SILENT_TIMES, "pairs of seconds, from and until")?;
    let pairs = times.iter().map(|pair| pair.pair(limits::HOLD));
    every(pairs.map(|pair| pair.map(|pair| [pair.x, pair.y])))
}

/// Fields of a target in the file that only the simulation uses.
#[derive(Debug)]
pub struct SimulatedTarget {
    /// How it moves.
    pub behaviour: Behaviour,
    /// What it does not report of itself.
    pub not_reported: NotReported,
    /// Time before which own ship does not see it, seconds.
    pub seen_from: f64,
}

impl SimulatedTarget {
    /// Their keys.
    pub const KEYS: [&str; 3] = ["behaviour", "not_reported", "seen_from_s"];
}

impl Default for SimulatedTarget {
    fn default() -> Self {
        Self {
            behaviour: Behaviour::Constant,
            not_reported: NotReported::default(),
            seen_from: 0.0,
        }
    }
}

/// The keys of a target for the simulation, all of which may be absent.
pub(super) fn simulated(target: &mut Table, plane: &Plane) -> SimulatedTarget {
    let [behaves, leaves_out, seen] = SimulatedTarget::KEYS;
    SimulatedTarget {
        behaviour: target.read_or(behaves, Behaviour::Constant, |field| {
            behaviour(field, plane)
        }),
        not_reported: target.read_or(leaves_out, NotReported::default(), not_reported),
        seen_from: target.number_or(seen, limits::HOLD, 0.0),
    }
}

fn not_reported(field: &Field) -> Option<NotReported> {
    let words = field.list(0..=2, "\"heading\" or \"size\"")?;
    let mut found = NotReported::default();
    for word in words {
        match word.choice(&[("heading", true), ("size", false)])? {
            true => found.heading = true,
            false => found.size = true,
        }
    }
    Some(found)
}

fn behaviour(field: &Field, plane: &Plane) -> Option<Behaviour> {
    let mut table = field.table("a table with the key kind")?;
    let kind = table
        .require_first("kind", "a behaviour, such as \"constant\"")?
        .choice(BehaviourKind::WORDS)?;
    let behaviour = match kind {
        BehaviourKind::Constant => Behaviour::Constant,
        BehaviourKind::Random => {
            let (every, factor) = every_and_factor(&mut table);
            Behaviour::Random { every, factor }
        }
        BehaviourKind::Extremes => {
            let (every, factor) = every_and_factor(&mut table);
            Behaviour::Extremes { every, factor }
        }
        BehaviourKind::Pursuit => {
            let every = table.number_or("every_s", TIME_CONSTANT, 5.0);
            Behaviour::Pursuit { every }
        }
        BehaviourKind::Track => {
            let field = table.require_first("points", "a list of tables with t_s and position")?;
            let points = field.list(1..=limits::TRACK_POINTS, "tables with t_s and position")?;
            Behaviour::Track(track(&points, plane)?)
        }
        BehaviourKind::GivesWay => {
            let mut number = |key, range, default| table.number_or(key, range, default);
            Behaviour::GivesWay {
                turn: radians_from_deg(number("turn_deg", TURN_DEG, 40.0)),
                before: number("before_cpa_s", limits::DURATION, 240.0),
                probability: number("probability", PROBABILITY, 1.0),
                turn_rate: radians_from_deg(number("turn_rate_deg_per_s", limits::TURN_RATE, 2.0)),
            }
        }
        BehaviourKind::Mutual => Behaviour::Mutual,
    };
    table.finish();
    Some(behaviour)
}

fn every_and_factor(table: &mut Table) -> (f64, f64) {
    let every = table.number_or("every_s", TIME_CONSTANT, 20.0);
    (every, table.number_or("factor", FACTOR, 1.0))
}

fn track(points: &[Field], plane: &Plane) -> Option<Vec<(f64, Vector)>> {
    let mut found: Vec<(f64, Vector)> = Vec::with_capacity(points.len());
    for point in points {
        let mut table = point.table("a table with t_s and position")?;
        let time = table.required_number("t_s", limits::DURATION);
        let position = plane.required_position(&mut table);
        table.finish();
        let (time, position) = (time?, position?);
        if found.last().is_some_and(|(before, _)| time <= *before) {
            return point.reject(
                format_args!("t_s = {time}, not after the one before"),
                "increasing times",
            );
        }
        found.push((time, position));
    }
    Some(found)
}
