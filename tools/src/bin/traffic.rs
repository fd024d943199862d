//! Figures of traffic: the picture under a day's feed, and the watch among a thousand ships.
//!
//! `cargo run --release -p searoom-tools --bin traffic -- watch` and `… -- day`; docs/reference/traffic.md
//! has the figures. Seeds are printed.

use std::time::Instant;

use clap::{Parser, Subcommand};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::frame::{
    Geographic, Georeference, Vector, course_deg_from_heading, direction, knots_from_mps,
};
use searoom::traffic::{Feed, Identity, PictureSettings, Settings, Watch};

const BEGIN_S: f64 = 1_700_000_000.0;

const OWN: u32 = 257_000_001;

/// Half of the side of the square in which ships move, metres.
const SQUARE_M: f64 = 30_000.0;

/// Seconds between two reports of a ship.
const INTERVAL_S: f64 = 10.0;

#[derive(Debug, Parser)]
struct Arguments {
    #[command(subcommand)]
    what: What,
    #[arg(long, global = true, default_value_t = 59)]
    seed: u64,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Own ship among many, a moment each second: the processor time of a moment
    Watch {
        #[arg(long, default_value_t = 1000)]
        ships: u32,
        #[arg(long, default_value_t = 600)]
        seconds: u32,
    },
    /// A feed at full speed through the picture: processor time and memory
    Day {
        #[arg(long, default_value_t = 20_000_000)]
        sentences: u64,
        #[arg(long, default_value_t = 10_000)]
        ships: u32,
        /// A line is cut every so many seconds, as where a connection breaks; 0 for none
        #[arg(long, default_value_t = 60)]
        broken_every_s: u32,
    },
}

fn main() {
    let Arguments { what, seed } = Arguments::parse();
    println!("seed {seed}");
    match what {
        What::Watch { ships, seconds } => watch(ships, seconds, seed),
        What::Day {
            sentences,
            ships,
            broken_every_s,
        } => day(sentences, ships, broken_every_s, seed),
    }
}

#[derive(Debug, Clone, Copy)]
struct Sailing {
    mmsi: u32,
    place: Vector,
    course: f64,
    speed: f64,
    /// Seconds after the beginning of each interval at which it reports.
    phase: f64,
}

impl Sailing {
    fn at(&self, time: f64) -> Vector {
        self.place + direction(self.course) * (self.speed * time)
    }
}

fn fleet(ships: u32, rng: &mut ChaCha8Rng) -> Vec<Sailing> {
    let mut side = || rng.random_range(-SQUARE_M..SQUARE_M);
    let places: Vec<Vector> = (0..ships).map(|_| Vector::new(side(), side())).collect();
    let ships = places.into_iter().zip(257_100_000..).map(|(place, mmsi)| {
        let is_at_rest = rng.random_range(0..5) < 3;
        Sailing {
            mmsi,
            place,
            course: rng.random_range(-3.1..3.1),
            speed: if is_at_rest {
                0.0
            } else {
                rng.random_range(2.0..10.0)
            },
            phase: rng.random_range(0.0..INTERVAL_S),
        }
    });
    ships.collect()
}

/// Message 1 of AIS with a tag block.
fn sentence(ship: &Sailing, time: f64, plane: &Georeference) -> Vec<u8> {
    let Geographic { lat_deg, lon_deg } = plane.to_geographic(ship.at(time));
    let course = course_deg_from_heading(ship.course);
    let mut bits: Vec<bool> = Vec::with_capacity(168);
    let mut put = |value: i64, size: u32| {
        bits.extend((0..size).rev().map(|bit| value >> bit & 1 == 1));
    };
    put(1, 6);
    put(0, 2);
    put(i64::from(ship.mmsi), 30);
    put(0, 4);
    put(0, 8);
    put((knots_from_mps(ship.speed) * 10.0).round() as i64, 10);
    put(1, 1);
    put((lon_deg * 600_000.0).round() as i64, 28);
    put((lat_deg * 600_000.0).round() as i64, 27);
    put((course * 10.0).round() as i64 % 3600, 12);
    put(course.round() as i64 % 360, 9);
    put((BEGIN_S + time) as i64 % 60, 6);
    put(0, 25);
    let armour = bits.chunks(6).map(|six| {
        let value = six
            .iter()
            .fold(0_u8, |value, bit| value << 1 | u8::from(*bit));
        value + if value < 40 { 48 } else { 56 }
    });
    let payload = String::from_utf8(armour.collect()).expect("armour");
    let body = format!("AIVDM,1,1,,A,{payload},0");
    let tag = format!("c:{}", (BEGIN_S + time) as i64);
    let sum = |text: &str| text.bytes().fold(0, |sum, byte| sum ^ byte);
    format!("\\{tag}*{:02X}\\!{body}*{:02X}\n", sum(&tag), sum(&body)).into_bytes()
}

/// Seconds of processor time of this thread.
fn processor_s() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

fn at(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share).round() as usize]
}

fn plane() -> Georeference {
    let origin = Geographic {
        lat_deg: 57.5,
        lon_deg: 11.0,
    };
    Georeference::new(origin).expect("on the earth")
}

const SCENARIO: &str = r#"
title = "Among many"
horizon_s = 900.0
origin = { lat_deg = 57.5, lon_deg = 11.0 }
[own_ship]
position = { east_m = 0, north_m = 0 }
course_deg = 90.0
speed_mps = 7.0
length_m = 100.0
beam_m = 18.0
turning_radius_m = 300.0
speeds_mps = [3.5, 7.0]
[mission]
waypoints = [{ east_m = 0, north_m = 0 }, { east_m = 6000, north_m = 0 }]
speed_mps = 7.0
"#;

fn watch(ships: u32, seconds: u32, seed: u64) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (fleet, plane) = (fleet(ships, &mut rng), plane());
    let mut own = Sailing {
        mmsi: OWN,
        place: Vector::zeros(),
        course: 0.0,
        speed: 7.0,
        phase: 0.0,
    };
    let picture = PictureSettings {
        own: Some(Identity::Mmsi(OWN)),
        ..PictureSettings::default()
    };
    let mut feed = Feed::new(&Settings::default(), 1, picture, f64::INFINITY);
    let mut watch = Watch::new(SCENARIO, "".as_ref(), None).expect("a scenario");
    let (mut times, mut with_plan, mut dangerous, mut near) = (Vec::new(), 0, 0, 0);
    let mut not_safe = 0;
    for second in 0..seconds {
        let time = f64::from(second);
        let mut lines = sentence(&own, time, &plane);
        for ship in &fleet {
            if (time - ship.phase).rem_euclid(INTERVAL_S) < 1.0 {
                lines.extend(sentence(ship, time, &plane));
            }
        }
        let written = processor_s();
        feed.recorded(0, &lines);
        let moment = watch.at(feed.picture(), BEGIN_S + time);
        let took = processor_s() - written;
        // own ship sails its plan, or else its mission
        let (place, course, speed) = match moment
            .run
            .as_ref()
            .and_then(|run| run.planned.outcome.plan())
        {
            Some(plan) => {
                let pose = plan.trajectory.pose_at(1.0);
                let speed = (pose.position - plan.trajectory.pose_at(0.0).position).norm();
                (pose.position, pose.heading, speed)
            }
            None => (
                own.at(time) + direction(own.course) * own.speed,
                own.course,
                own.speed,
            ),
        };
        own = Sailing {
            place: place - direction(course) * (speed * (time + 1.0)),
            course,
            speed,
            ..own
        };
        not_safe += u32::from(second >= INTERVAL_S as u32)
            * u32::from(moment.document.plan.as_ref().is_some_and(|plan| !plan.safe));
        if second >= INTERVAL_S as u32 {
            times.push(1e3 * took);
            with_plan += u32::from(moment.document.plan.is_some());
            dangerous += moment.document.dangerous.len();
            near += moment.document.ships;
        }
    }
    times.sort_by(f64::total_cmp);
    let moments = times.len();
    println!(
        "{ships} ships, {moments} moments, {with_plan} with a plan, {not_safe} not safe; {:.1} ships near and {:.1} dangerous in the mean",
        near as f64 / moments as f64,
        dangerous as f64 / moments as f64
    );
    println!(
        "processor time of a second, sentences included: median {:.1} ms, 99 % {:.1} ms, most {:.1} ms",
        at(&times, 0.5),
        at(&times, 0.99),
        at(&times, 1.0)
    );
}

fn day(sentences: u64, ships: u32, broken_every_s: u32, seed: u64) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (fleet, plane) = (fleet(ships, &mut rng), plane());
    let whole = || {
        Feed::new(
            &Settings::default(),
            1,
            PictureSettings::default(),
            f64::INFINITY,
        )
    };
    let (mut feed, mut second, mut read, mut taken) = (whole(), 0.0_f64, 0, 0.0);
    let begun = Instant::now();
    let mut memory = Vec::new();
    while read < sentences {
        let due = fleet
            .iter()
            .filter(|ship| (second - ship.phase).rem_euclid(INTERVAL_S) < 1.0);
        // an hour's way and back, so that the ships stay where they are
        let time = (second % 7200.0 - 3600.0).abs();
        let mut lines = Vec::new();
        for ship in due {
            let shifted = Sailing {
                place: ship.at(time),
                speed: ship.speed,
                ..*ship
            };
            let there = Sailing {
                place: shifted.place - direction(ship.course) * (ship.speed * second),
                ..shifted
            };
            lines.extend(sentence(&there, second, &plane));
            read += 1;
        }
        if broken_every_s > 0 && (second as u32).is_multiple_of(broken_every_s) {
            lines.truncate(lines.len().saturating_sub(20));
            lines.push(b'\n');
        }
        let before = processor_s();
        feed.recorded(0, &lines);
        taken += processor_s() - before;
        if (second as u64).is_multiple_of(3600) {
            memory.push(resident_mb());
        }
        second += 1.0;
    }
    println!(
        "{read} sentences of {ships} ships in {:.0} s of traffic: {taken:.1} s of processor time, {:.2} million a second; {:.0} s with writing them",
        second,
        1e-6 * read as f64 / taken,
        begun.elapsed().as_secs_f64()
    );
    println!("memory of the process each hour of traffic, MB: {memory:.0?}");
    println!(
        "{} ships in the picture\n{}",
        feed.picture().ships(),
        feed.counted().join("\n")
    );
}

/// Resident memory of this process, megabytes; NaN where the system does not tell.
fn resident_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kilobytes = line.and_then(|rest| rest.split_whitespace().next()?.parse::<f64>().ok());
    kilobytes.map_or(f64::NAN, |kilobytes| kilobytes / 1e3)
}
