//! The parts of a random scene: targets of every kind, their domains and sets.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

pub struct Scene {
    pub rng: ChaCha8Rng,
    pub text: String,
    /// Metres, added to every place.
    pub origin: [f64; 2],
    /// Targets to choose from.
    pub kinds: &'static [&'static str],
}

impl Scene {
    pub fn new(seed: u64) -> Self {
        Self {
            rng: ChaCha8Rng::seed_from_u64(seed),
            text: String::new(),
            origin: [0.0, 0.0],
            kinds: &[
                "ship",
                "ship",
                "turning",
                "sets",
                "ellipses",
                "intervals",
                "at rest",
                "around",
            ],
        }
    }

    pub fn one<T: Copy>(&mut self, of: &[T]) -> T {
        *of.choose(&mut self.rng).expect("some")
    }

    pub fn line(&mut self, line: String) {
        writeln!(self.text, "{line}").expect("text grows");
    }

    pub fn target(&mut self, index: usize, length: f64, speed: f64, time: f64, way: &[[f64; 2]]) {
        let kind = self.one(self.kinds);
        let end = way[way.len() - 1];
        let course = self.rng.random_range(-PI..PI);
        let share = self.rng.random_range(0.1..1.05);
        let fast = self.one(&[0.3, 1.0, 1.5]) * speed * self.rng.random_range(0.3..1.0);
        let (meets, share, fast) = match kind {
            "at rest" => (end, 0.0, 0.0),
            "around" => ([0.0, 0.0], 0.0, fast),
            _ => ([end[0] * share, end[1] * share], share, fast),
        };
        let back = fast * share * time;
        let [east, north] = self.origin;
        let mut beside = || self.rng.random_range(-1.0..1.0) * length;
        let place = [
            meets[0] - back * course.cos() + beside() + east,
            meets[1] - back * course.sin() + beside() + north,
        ];
        let velocity = [fast * course.cos(), fast * course.sin()];
        self.line(format!("[[targets]]\nname = \"{index} {kind}\""));
        match kind {
            "sets" => {
                let initial = self.polygon(place, 2.0 * length);
                let spread = self.one(&[0.05, 0.2, 1e-7]);
                let velocities = self.polygon(velocity, spread * speed);
                self.line(format!("initial_set = {{ vertices_m = {initial} }}\nvelocity_set = {{ vertices_mps = {velocities} }}"));
            }
            "ellipses" => {
                let (initial, spread) = (self.matrix(2.0 * length), self.matrix(0.1 * speed));
                self.line(format!("initial_set = {{ center_m = {place:?}, shape_m2 = {initial} }}\nvelocity_set = {{ center_mps = {velocity:?}, shape_m2_per_s2 = {spread} }}"));
            }
            "intervals" => {
                let initial = self.polygon(place, 2.0 * length);
                self.line(format!("initial_set = {{ vertices_m = {initial} }}"));
                let last = self.one(&[2, 3, 5]);
                let sets: Vec<String> = (1..=last)
                    .map(|k| {
                        let turned = self.rng.random_range(-0.3..0.3) + course;
                        let velocity = [fast * turned.cos(), fast * turned.sin()];
                        let velocities = self.polygon(velocity, 0.1 * speed);
                        let until =
                            time * (k as f64 - self.rng.random_range(0.0..0.9)) / last as f64;
                        let until = if k == last {
                            String::new()
                        } else {
                            format!("until_s = {until:?}, ")
                        };
                        format!("{{ {until}vertices_mps = {velocities} }}")
                    })
                    .collect();
                self.line(format!("velocity_sets = [{}]", sets.join(", ")));
            }
            _ => {
                let long = length * self.rng.random_range(0.3..2.0);
                let spreads = [
                    self.one(&[0.0, 0.1, 0.5, 1.5]),
                    self.one(&[0.0, 2.0, 5.0, 20.0]),
                    self.one(&[0.0, 0.0, 5.0, 20.0]),
                ];
                let domain = self.one(&["colregs", "colregs", "paper", "hull", "custom"]);
                self.line(format!(
                    "position = {}\ncourse_deg = {:?}\nspeed_mps = {fast:?}\nlength_m = {long:?}\nbeam_m = {:?}",
                    position(&place),
                    compass(course),
                    long / 6.0
                ));
                let [speed_spread, course_spread, deviation] = spreads;
                self.line(format!(
                    "speed_spread_mps = {speed_spread:?}\ncourse_spread_deg = {course_spread:?}\nposition_std_m = {deviation:?}"
                ));
                self.domain(domain, long);
                let starboard_turn = self.one(&[0.0, 0.0, 0.0, 45.0, 180.0]);
                self.line(format!("starboard_turn_deg = {starboard_turn:?}"));
                if kind == "turning" {
                    let rate = self.one(&[0.01, 0.1, 0.5]);
                    self.line(format!("turn_rate_deg_per_s = {rate:?}"));
                } else {
                    let representation = self.one(&["polytope", "polytope", "ellipsoid"]);
                    self.line(format!("representation = \"{representation}\""));
                }
            }
        }
    }

    /// A named domain, or one of four distances.
    fn domain(&mut self, name: &str, length: f64) {
        if name != "custom" {
            self.line(format!("domain = \"{name}\""));
            return;
        }
        let [fore, aft, port, starboard] =
            [(); 4].map(|()| self.one(&[0.0, 0.5, 2.0, 5.0]) * length);
        self.line(format!(
            "domain = {{ fore_m = {fore:?}, aft_m = {aft:?}, port_m = {port:?}, starboard_m = {starboard:?} }}"
        ));
    }

    /// Corners on a circle: points and segments too.
    fn polygon(&mut self, [x, y]: [f64; 2], radius: f64) -> String {
        let count = self.one(&[1, 2, 3, 4, 5, 8]);
        let mut angles: Vec<f64> = (0..count)
            .map(|_| self.rng.random_range(0.0..TAU))
            .collect();
        angles.sort_by(f64::total_cmp);
        let corner = |a: &f64| format!("[{:?}, {:?}]", x + radius * a.cos(), y + radius * a.sin());
        let corners: Vec<String> = angles.iter().map(corner).collect();
        format!("[{}]", corners.join(", "))
    }

    /// A A' of a random A.
    fn matrix(&mut self, size: f64) -> String {
        let [a, b, c, d] = [(); 4].map(|()| self.rng.random_range(-size..size));
        let across = a * c + b * d;
        format!(
            "[[{:?}, {across:?}], [{across:?}, {:?}]]",
            a * a + b * b,
            c * c + d * d
        )
    }
}

pub fn position(p: &[f64; 2]) -> String {
    format!("{{ east_m = {:?}, north_m = {:?} }}", p[0], p[1])
}

/// Degrees clockwise from north of a heading in radians from east.
pub fn compass(heading: f64) -> f64 {
    (90.0 - heading.to_degrees()).rem_euclid(360.0)
}
