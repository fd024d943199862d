//! Any scene that a file can hold, with each planner and every setting. Places may be far from the
//! origin, budgets milliseconds, numbers of any size; there may be land and path networks.

use std::f64::consts::PI;

use rand::Rng;

use super::scene::{Scene, compass, position};

/// The planners, by their words.
pub const PLANNERS: [&str; 3] = ["space-time", "path-time", "optimal-control"];

/// Numbers that are at the ends of what is allowed, and just beyond them.
const EXTREME: &str = "0.0 -0.0 5e-324 1e-300 1e-12 1e-9 1e-7 0.001 1.0 -1.0 3.0 50.0 90.0 100.0 \
                       179.9999999 180.0 -360.0 359.999999999 1e4 1e6 1e7 -1e7";

/// A scenario file, which the program may refuse; the same arguments give the same scene. `maps` is
/// the folder of the maps.
pub fn anything(seed: u64, planner: Option<&str>, maps: &str) -> String {
    let mut scene = Scene::new(seed ^ 0x0066_757a_7a00);
    let drawn = match scene.rng.random_range(0..100) {
        // a plan by forces takes a hundred times as long
        0..3 => PLANNERS[2],
        3..50 => PLANNERS[1],
        _ => PLANNERS[0],
    };
    let planner = planner.unwrap_or(drawn);
    scene.line(format!("title = \"{planner} {seed}\""));
    scene.origin = match scene.one(&[0, 0, 0, 1, 2]) {
        0 => [0.0, 0.0],
        1 => [
            scene.rng.random_range(2e5..8e5),
            scene.rng.random_range(5e6..8e6),
        ],
        _ => [
            scene.rng.random_range(-1e4..1e4),
            scene.rng.random_range(-1e4..1e4),
        ],
    };
    match planner {
        "optimal-control" => scene.by_forces(),
        "path-time" if scene.rng.random_bool(0.5) => scene.network(),
        _ => scene.anywhere(planner, maps),
    }
    if scene.rng.random_bool(0.25) {
        for _ in 0..scene.one(&[1, 1, 2, 3]) {
            scene.alter_a_number();
        }
    }
    scene.text
}

impl Scene {
    /// One path, on which everything may be asked; among land now and then.
    fn anywhere(&mut self, planner: &str, maps: &str) {
        let free = planner == "space-time";
        let land = self.rng.random_bool(0.1);
        let length = if land {
            10.0
        } else {
            self.one(&[2.0, 10.0, 50.0, 100.0, 300.0])
        };
        if land {
            self.origin = [
                self.rng.random_range(-800.0..800.0),
                self.rng.random_range(200.0..1400.0),
            ];
            self.line("origin = { lat_deg = 63.4440, lon_deg = 10.3900 }".to_owned());
            self.line(format!("map = \"{maps}/trondheim-harbour.geojson\""));
        }
        let speed = self.rng.random_range(2.0..12.0);
        let any = self.rng.random_range(-PI..PI);
        let first = self.one(&[0.0, 0.5 * PI, PI, any]);
        let (mut course, mut way) = (first, vec![[0.0, 0.0]]);
        for _ in 0..self.one(&[1, 1, 1, 2, 3, 6]) {
            let tiny = self.rng.random_bool(0.05);
            let leg = self.rng.random_range(5.0..60.0) * if tiny { 1e-3 } else { length };
            let [x, y] = way[way.len() - 1];
            way.push([x + leg * course.cos(), y + leg * course.sin()]);
            // back along the same leg now and then
            course += match self.rng.random_bool(0.05) {
                true => PI,
                false => self.rng.random_range(-0.8..0.8),
            };
        }
        let distance = |w: &[[f64; 2]]| f64::hypot(w[1][0] - w[0][0], w[1][1] - w[0][1]);
        let time = way.windows(2).map(distance).sum::<f64>() / speed;
        let start = if free {
            let aside = match self.one(&[0, 0, 0, 1, 1, 2]) {
                0 => 0.0,
                1 => 10_f64.powf(self.rng.random_range(-12.0..-3.0)),
                _ => self.rng.random_range(-5.0..5.0) * length,
            };
            match self.rng.random_bool(0.03) {
                true => way[way.len() - 1],
                false => [-aside * first.sin(), aside * first.cos()],
            }
        } else {
            [0.0, 0.0]
        };
        let turned = match self.one(&[0, 0, 0, 1, 2]) {
            0 => 0.0,
            1 => 10_f64.powf(self.rng.random_range(-12.0..-3.0)),
            _ => self.rng.random_range(-PI..PI),
        };
        let horizon = time * self.one(&[1.0, 1.2, 1.5, 2.0, 3.0]);
        self.line(format!("horizon_s = {horizon:?}\n[own_ship]"));
        self.own_ship(start, first + turned, speed, length);
        if self.rng.random_bool(0.4) {
            let speeds = match self.one(&[0, 1, 2]) {
                0 => vec![0.0, 0.5 * speed, speed],
                1 => vec![speed],
                _ => (0..20).map(|k| speed * 0.05 * f64::from(k)).collect(),
            };
            self.line(format!("speeds_mps = {speeds:?}"));
        }
        if land {
            let margin = self.one(&[0.0, 5.0, 15.0]);
            self.line(format!("land_margin_m = {margin:?}"));
        }
        self.mission(&way, &[]);
        if self.rng.random_bool(0.1) {
            let slow = speed * self.rng.random_range(0.2..1.0);
            self.line(format!("speed_mps = {slow:?}"));
        }
        self.planner(planner);
        let targets = self.one(&[0, 1, 1, 1, 2, 2, 3, 5, 8]);
        let targets = if self.rng.random_bool(0.005) {
            100
        } else {
            targets
        };
        for index in 0..targets {
            self.target(index, length, speed, time, &way);
        }
    }

    /// Paths that share places of a small grid, and pass some of them twice.
    fn network(&mut self) {
        let step = self.one(&[200.0, 200.0, 20.0, 1.0]);
        let place = |scene: &mut Self| {
            let aside = match scene.rng.random_bool(0.03) {
                true => 10_f64.powf(scene.rng.random_range(-9.0..-1.0)),
                false => 0.0,
            };
            let (east, north) = (scene.one(&[0, 1, 2, 3]), scene.one(&[0, 1, 2]));
            [
                step * f64::from(east) + aside,
                0.75 * step * f64::from(north),
            ]
        };
        let path = |scene: &mut Self, first: Option<[f64; 2]>| {
            let mut path: Vec<[f64; 2]> = first.into_iter().collect();
            for _ in 0..scene.one(&[2, 2, 3, 4]) {
                let next = place(scene);
                if path.last() != Some(&next) {
                    path.push(next);
                }
            }
            path
        };
        let way = path(self, Some([0.0, 0.0]));
        let mut shared = way.clone();
        let mut others = Vec::new();
        for _ in 0..self.one(&[0, 1, 1, 2, 3]) {
            let first = self.one(&shared);
            let mut other = path(self, Some(first));
            let last = self.one(&shared);
            if other.last() != Some(&last) {
                other.push(last);
            }
            shared.extend(&other);
            others.push(other);
        }
        let (speed, length) = (5.0, 0.025 * step);
        let time = 3.0 * step / speed;
        let horizon = time * self.one(&[2.0, 5.0, 15.0]);
        self.line(format!("horizon_s = {horizon:?}\n[own_ship]"));
        let course = self.one(&[0.0, 0.0, 0.5 * PI, 0.3]);
        self.own_ship([0.0, 0.0], course, speed, length);
        self.mission(&way, &others);
        self.planner("path-time");
        for index in 0..self.one(&[1, 1, 2, 3]) {
            self.target(index, length, speed, time, &way);
        }
    }

    /// The model ship, or the ship, among sets of its own size.
    fn by_forces(&mut self) {
        let (vessel, length, speed) =
            self.one(&[("cybership2", 1.255, 0.2), ("cybership2-full", 87.85, 2.0)]);
        let course = self.rng.random_range(-PI..PI);
        let leg = self.rng.random_range(4.0..15.0) * length;
        let way = [[0.0, 0.0], [leg * course.cos(), leg * course.sin()]];
        let time = leg / speed;
        if vessel == "cybership2" {
            // ships have spreads of metres
            self.kinds = &["sets", "ellipses", "intervals"];
        }
        let horizon = time * self.one(&[1.0, 1.3, 2.0]);
        self.line(format!("horizon_s = {horizon:?}\n[own_ship]"));
        self.own_ship([0.0, 0.0], course, speed, length);
        self.mission(&way, &[]);
        self.planner("optimal-control");
        let intervals = self.one(&[4, 8, 12, 20]);
        self.line(format!(
            "[planner.optimal_control]\nvessel = \"{vessel}\"\nintervals = {intervals}"
        ));
        for index in 0..self.one(&[1, 1, 2, 3]) {
            self.target(index, length, speed, time, &way);
        }
    }

    fn own_ship(&mut self, start: [f64; 2], heading: f64, speed: f64, length: f64) {
        let radius = self.one(&[0.5, 1.0, 4.0, 8.0]) * length;
        let margin = self.one(&[0.0, 0.0, 0.2, 1.0, 3.0]) * length;
        let place = self.place(&start);
        self.line(format!(
            "position = {place}\ncourse_deg = {:?}\nspeed_mps = {speed:?}\nlength_m = {length:?}\nbeam_m = {:?}",
            compass(heading),
            length / 6.0
        ));
        self.line(format!(
            "turning_radius_m = {radius:?}\nsafety_margin_m = {margin:?}"
        ));
    }

    fn mission(&mut self, way: &[[f64; 2]], others: &[Vec<[f64; 2]>]) {
        let list = |path: &[[f64; 2]]| {
            let places: Vec<String> = path.iter().map(|p| self.place(p)).collect();
            format!("[{}]", places.join(", "))
        };
        let (way, others): (String, Vec<String>) =
            (list(way), others.iter().map(|path| list(path)).collect());
        self.line(format!("[mission]\nwaypoints = {way}"));
        if !others.is_empty() {
            self.line(format!("alternatives = [{}]", others.join(", ")));
        }
    }

    fn planner(&mut self, planner: &str) {
        self.line(format!("[planner]\nkind = \"{planner}\""));
        let compliances = match planner {
            "space-time" => &["shape", "none", "rules"][..],
            _ => &["shape", "none"],
        };
        let compliance = self.one(compliances);
        let deadlines = match planner {
            "optimal-control" => &[0.003, 0.1, 0.5, 1.0][..],
            _ => &[0.001, 0.01, 0.1, 0.1, 1.0],
        };
        let deadline = self.one(deadlines);
        let search = self.one(&["a-star", "a-star", "thorough", "dijkstra"]);
        let risk = self.one(&[0.0, 0.0, 0.0, 0.05, 0.3, 0.8]);
        self.line(format!(
            "compliance = \"{compliance}\"\ndeadline_s = {deadline:?}\nsearch = \"{search}\"\nmax_risk = {risk:?}"
        ));
        if planner == "path-time" {
            let objective = self.one(&["space-time-error", "time", "length", "length-risk"]);
            self.line(format!("objective = \"{objective}\""));
            if objective == "length-risk" {
                let weight = self.one(&[0.0, 10.0, 1000.0]);
                self.line(format!("risk_weight_m = {weight:?}"));
            }
        }
        if self.rng.random_bool(0.1) {
            let weight = self.one(&[0.0, 0.05, 1e4]);
            self.line(format!("time_weight_m2_per_s2 = {weight:?}"));
        }
        if self.rng.random_bool(0.2) {
            let tidy = self.one(&[
                "tidy = false",
                "tidy = true",
                "min_speed_time_s = 0",
                "min_speed_time_s = 300",
            ]);
            self.line(tidy.to_owned());
        }
    }

    fn place(&self, [east, north]: &[f64; 2]) -> String {
        position(&[east + self.origin[0], north + self.origin[1]])
    }

    /// Puts another number in the place of one: an extreme one, one that is nearly the same, or one
    /// of another place. The budget stays short.
    fn alter_a_number(&mut self) {
        let numbers: Vec<(usize, usize)> = numbers(&self.text);
        let Some((from, to)) = (!numbers.is_empty()).then(|| self.one(&numbers)) else {
            return;
        };
        let choice = self.rng.random_range(0..4);
        let old = &self.text[from..to];
        let new = match choice {
            0 => {
                let (from, to) = self.one(&numbers);
                self.text[from..to].to_owned()
            }
            1 => old
                .parse()
                .map_or(old.to_owned(), |old: f64| format!("{:?}", old.next_up())),
            _ => {
                let extreme: Vec<&str> = EXTREME.split(' ').collect();
                self.one(&extreme).to_owned()
            }
        };
        self.text.replace_range(from..to, &new);
    }
}

/// Where the numbers of a text begin and end, but for those of texts in it and the budget.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut begin = 0;
    for line in text.split_inclusive('\n') {
        let is_number = |word: &str| word.starts_with(|c: char| c == '-' || c.is_ascii_digit());
        let skipped = line.contains('"') || line.starts_with("deadline_s");
        let mut at = begin;
        for word in line.split_inclusive([' ', ',', ']', '[', '\n']) {
            let number = word.trim_end_matches([' ', ',', ']', '[', '\n']);
            if !skipped && is_number(number) {
                found.push((at, at + number.len()));
            }
            at += word.len();
        }
        begin += line.len();
    }
    found
}
