//! Plans by the rules against a dense search of the same family of manoeuvres, the slowest way that is
//! obviously right: a grid, whose best are improved by random steps. It shares the sets' contact test and
//! the judges with the planner, no search.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom_colregs::compliance::{ComplianceReport, EncounterSamples};
use searoom_colregs::{Encountered, Role, SteadyShip, Thresholds};
use searoom_geometry::frame::{Pose, Vector, direction};
use searoom_geometry::{ConvexPolygon, outer_disc};
use searoom_model::target::ShipTrack;
use searoom_model::trajectory::{DesiredTrajectory, Segment, Trajectory};
use searoom_model::vessel::{Hull, OwnShip};
use searoom_planner::cost::sailed_space_time_error;
use searoom_planner::{PlanMethod, Problem, space_time, whole_space_time_error};
use searoom_sets::{Obstacle, PolytopeObstacle, contact};

const RADIUS: f64 = 100.0;
const ORDERED: f64 = 5.0;
const FASTEST: f64 = 6.0;
const LENGTH: f64 = 2_500.0;
const HORIZON: f64 = 1_000.0;
/// Seconds of the latest departure: the risk exists at t = 0.
const LATEST: f64 = 20.0;
const LATEST_OVERTAKING: f64 = 10.0;
/// Manoeuvres of the grid that are improved, and steps of each.
const BEST: usize = 12;
const STEPS: usize = 400;

fn own() -> OwnShip {
    OwnShip {
        pose: Pose::new(Vector::zeros(), 0.0),
        speed: ORDERED,
        hull: Hull::new(30.0, 8.0),
        turning_radius: RADIUS,
        speeds: vec![2.5, ORDERED, FASTEST],
        safety_margin: 20.0,
        tracking_margin: 0.0,
    }
}

/// A ship that would meet own ship after two to three minutes, and its set.
fn target(role: Role, rng: &mut ChaCha8Rng) -> (Encountered, PolytopeObstacle) {
    let time = rng.random_range(120.0..200.0);
    let heading = match role {
        Role::HeadOn => std::f64::consts::PI + rng.random_range(-0.05..0.05),
        Role::Overtaking => rng.random_range(-0.2..0.2),
        _ => rng.random_range(1.2..2.2),
    };
    let speed = match role {
        Role::Overtaking => rng.random_range(1.0..2.0),
        _ => rng.random_range(4.0..6.0),
    };
    let position = Vector::new(ORDERED * time, 0.0) - direction(heading) * (speed * time);
    let ship = SteadyShip::new(Pose::new(position, heading), speed);
    let hull = Hull::new(rng.random_range(40.0..90.0), 12.0);
    let around = outer_disc(30.0 + own().hull.half_diagonal(), heading);
    let initial = hull.polygon(&ship.pose).minkowski_sum(&around);
    let velocities = [0.0, 1.6, 3.1, 4.7].map(|at| ship.velocity() + direction(at) * 0.3);
    let velocity = ConvexPolygon::hull(&velocities).expect("finite");
    let encountered = Encountered {
        role,
        ship,
        hull,
        risk_distance: 0.0,
        own: SteadyShip::new(own().pose, ORDERED),
        risk_since: 0.0,
        tcpa: time,
    };
    (
        encountered,
        PolytopeObstacle::new("ship", initial, velocity),
    )
}

/// Appends an arc (turn to port in radians) or a line (seconds).
fn turned(motion: &mut Vec<Segment>, turn: f64, speed: f64) {
    let (pose, time) = end(motion);
    let seconds = turn.abs() * RADIUS / speed;
    if seconds > 0.0 {
        motion.push(Segment::new(pose, time, seconds, speed, turn / seconds));
    }
}

fn straight(motion: &mut Vec<Segment>, seconds: f64, speed: f64) {
    let (pose, time) = end(motion);
    if seconds > 0.0 {
        motion.push(Segment::straight(pose, time, seconds, speed));
    }
}

fn end(motion: &[Segment]) -> (Pose, f64) {
    motion
        .last()
        .map_or((own().pose, 0.0), |s| (s.end(), s.end_time()))
}

/// Back to the path from a side of it (1 to port) at an angle, then on, faster while late. `None` where
/// there is no room.
fn returned(mut motion: Vec<Segment>, side: f64, angle: f64) -> Option<Vec<Segment>> {
    let (pose, _) = end(&motion);
    turned(&mut motion, -side * angle - pose.heading, FASTEST);
    let (pose, _) = end(&motion);
    let left = side * pose.position.y - RADIUS * (1.0 - angle.cos());
    if !(left >= 0.0) {
        return None;
    }
    straight(&mut motion, left / angle.sin() / FASTEST, FASTEST);
    turned(&mut motion, side * angle, FASTEST);
    let (pose, time) = end(&motion);
    let late = ORDERED * time - pose.position.x;
    let to_go = LENGTH - pose.position.x;
    if !(to_go >= 0.0) {
        return None;
    }
    let catching_up = (late / (FASTEST - ORDERED)).clamp(0.0, to_go / FASTEST);
    straight(&mut motion, catching_up, FASTEST);
    let (pose, _) = end(&motion);
    straight(&mut motion, (LENGTH - pose.position.x) / ORDERED, ORDERED);
    (end(&motion).1 <= HORIZON).then_some(motion)
}

/// A manoeuvre of the family: a turn, a line, the turn back and a parallel course, a return.
#[derive(Debug, Clone, Copy)]
struct Numbers {
    /// 1 to port, and the speed until the return.
    side: f64,
    speed: f64,
    /// Seconds of the departure, radians of the turn, seconds of the line (0: no parallel course) and of
    /// the course after it, radians of the return.
    values: [f64; 5],
}

impl Numbers {
    /// The motion until the return.
    fn passing(&self) -> Vec<Segment> {
        let [leave, turn, hold, after, _] = self.values;
        let mut motion = Vec::new();
        straight(&mut motion, leave, ORDERED);
        turned(&mut motion, self.side * turn, self.speed);
        if hold > 0.0 {
            straight(&mut motion, hold, self.speed);
            turned(&mut motion, -self.side * turn, self.speed);
        }
        straight(&mut motion, after, self.speed);
        motion
    }

    fn motion(&self) -> Option<Vec<Segment>> {
        returned(self.passing(), self.side, self.values[4])
    }

    fn is_of_the_family(&self) -> bool {
        let [leave, turn, hold, after, angle] = self.values;
        (leave == 0.0 || leave >= 3.0)
            && leave <= LATEST
            && (30.0_f64.to_radians()..3.0).contains(&turn)
            && (hold == 0.0 || hold >= 3.0)
            && after >= 3.0
            && (0.1..1.4).contains(&angle)
    }
}

struct Scene {
    encountered: Encountered,
    set: PolytopeObstacle,
    /// A length around the nominal hull.
    length: PolytopeObstacle,
    desired: DesiredTrajectory,
}

impl Scene {
    fn new(role: Role, rng: &mut ChaCha8Rng) -> Self {
        let (encountered, set) = target(role, rng);
        let (ship, hull) = (encountered.ship, encountered.hull);
        let around = own().hull.half_diagonal() + own().hull.length.max(hull.length);
        let initial = hull.polygon(&ship.pose);
        let initial = initial.minkowski_sum(&outer_disc(around, ship.pose.heading));
        let length = PolytopeObstacle::new("", initial, ConvexPolygon::point(ship.velocity()));
        let path = [Vector::zeros(), Vector::new(LENGTH, 0.0)];
        let desired = DesiredTrajectory::new(&path, &[ORDERED]).expect("a path");
        Self {
            encountered,
            set,
            length,
            desired,
        }
    }

    fn is_clear(&self, motion: &[Segment]) -> bool {
        let meets = |s| contact::meets(&self.set, s, 1e-7) || contact::meets(&self.length, s, 1e-7);
        !motion.iter().any(meets)
    }

    /// Past and clear on the first course and on this one.
    fn is_passed(&self, motion: &[Segment], speed: f64) -> bool {
        let (pose, time) = end(motion);
        let ship = self.encountered.ship;
        let apart = ship.moved(time).pose.position - pose.position;
        let courses = [self.encountered.own.velocity(), pose.ahead() * speed];
        courses
            .iter()
            .all(|course| apart.dot(&(course - ship.velocity())) <= 0.0)
    }

    fn is_lawful(&self, motion: &[Segment]) -> bool {
        let trajectory = Trajectory::new(motion.to_vec()).expect("joined");
        let ship = self.encountered.ship;
        let track = ShipTrack::exact(ship.pose, ship.speed, self.encountered.hull);
        let samples = EncounterSamples::along(&trajectory, &own(), &track);
        let report = ComplianceReport::judge(&samples, Thresholds::standard());
        report.broken().next().is_none()
    }

    fn cost(&self, motion: &[Segment]) -> f64 {
        whole_space_time_error(&self.desired, motion, ORDERED * ORDERED)
    }

    /// The least costs of a grid, one for each departure and turn: departures every 4 s, turns every 5°,
    /// holds every 3 s, with a parallel course or without, returns every 2 s at ten angles.
    fn grid(&self) -> Vec<(f64, Numbers)> {
        let ways: &[(f64, f64)] = match self.encountered.role {
            Role::Overtaking => &[
                (1.0, ORDERED),
                (-1.0, ORDERED),
                (1.0, FASTEST),
                (-1.0, FASTEST),
            ],
            _ => &[(-1.0, ORDERED)],
        };
        let mut found = Vec::new();
        for &(side, speed) in ways {
            for leave in 0..=(self.latest() / 4.0) as usize {
                for turn in 0..14 {
                    let turn = (30.0 + 5.0 * f64::from(turn)).to_radians() + 1e-9;
                    let mut least: Option<(f64, Numbers)> = None;
                    for hold in 0..40 {
                        // the first has no parallel course
                        let hold = 3.0 * f64::from(hold);
                        let values = [4.0 * leave as f64, turn, hold, 3.0, 0.2];
                        self.returns(
                            Numbers {
                                side,
                                speed,
                                values,
                            },
                            &mut least,
                        );
                    }
                    found.extend(least);
                }
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    }

    fn returns(&self, mut numbers: Numbers, least: &mut Option<(f64, Numbers)>) {
        for after in 0..120 {
            numbers.values[3] = 3.0 + 2.0 * f64::from(after);
            let passed = numbers.passing();
            let so_far = sailed_space_time_error(&self.desired, &passed, ORDERED * ORDERED);
            let most = least.map_or(f64::INFINITY, |(cost, _)| cost);
            if so_far >= most || !self.is_clear(&passed) {
                break;
            }
            for angle in 0..10 {
                numbers.values[4] = 0.2 + 0.1 * f64::from(angle);
                let most = least.map_or(f64::INFINITY, |(cost, _)| cost);
                if let Some(cost) = self.cost_below(&numbers, most) {
                    *least = Some((cost, numbers));
                }
            }
        }
    }

    /// The cost of a lawful manoeuvre that is clear, where it is less.
    fn cost_below(&self, numbers: &Numbers, most: f64) -> Option<f64> {
        let cost = self.cost(&numbers.motion()?);
        let good = || {
            let motion = numbers.motion()?;
            let passed = self.is_passed(&numbers.passing(), numbers.speed);
            (passed && self.is_clear(&motion) && self.is_lawful(&motion)).then_some(cost)
        };
        if cost < most { good() } else { None }
    }

    /// The least cost that random steps find from the best manoeuvres of the grid. Steps shrink where
    /// few are better.
    fn least(&self, rng: &mut ChaCha8Rng) -> f64 {
        let mut least = f64::INFINITY;
        for (mut cost, mut numbers) in self.grid().into_iter().take(BEST) {
            let mut scale = 1.0;
            for _ in 0..STEPS {
                let mut next = numbers;
                for (value, step) in next.values.iter_mut().zip([4.0, 0.08, 3.0, 2.0, 0.1]) {
                    // a number without a parallel course keeps none, and a bound is often best
                    if *value > 0.0 && rng.random_range(0..3) > 0 {
                        *value += scale * step * rng.random_range(-1.0..1.0);
                    }
                }
                next.values[0] = next.values[0].clamp(0.0, self.latest());
                next.values[1] = next.values[1].max(30.0_f64.to_radians() + 1e-9);
                let found = next
                    .is_of_the_family()
                    .then(|| self.cost_below(&next, cost));
                match found.flatten() {
                    Some(better) => {
                        (cost, numbers) = (better, next);
                        scale = (scale * 1.5_f64).min(1.0);
                    }
                    None => scale = (scale * 0.97).max(1e-3),
                }
            }
            least = least.min(cost);
        }
        least
    }

    /// Seconds of the latest departure.
    fn latest(&self) -> f64 {
        match self.encountered.role {
            Role::Overtaking => LATEST_OVERTAKING,
            _ => LATEST,
        }
    }
}

/// Ratios of the costs of plans to the least costs of the family.
fn ratios(role: Role, seed: u64, scenes: usize) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut ratios = Vec::new();
    for case in 0..scenes {
        let scene = Scene::new(role, &mut rng);
        let (own, encountered) = (own(), [scene.encountered]);
        let sets: [Obstacle; 1] = [scene.set.clone().into()];
        let problem = Problem {
            encountered: &encountered,
            ..Problem::new(&own, &scene.desired, &sets, HORIZON)
        };
        let planned = space_time::plan(&problem);
        let plan = planned.outcome.plan().expect("there is room");
        assert_eq!(plan.method, PlanMethod::Rules);
        let motion = plan.trajectory.segments();
        assert!(scene.is_clear(motion) && scene.is_lawful(motion), "{case}");
        ratios.push(scene.cost(motion) / scene.least(&mut rng));
    }
    ratios.sort_by(f64::total_cmp);
    ratios
}

#[test]
fn no_manoeuvre_of_a_dense_search_is_much_cheaper() {
    for (role, seed) in [(Role::HeadOn, 57), (Role::GiveWay, 58)] {
        let ratios = ratios(role, seed, 2);
        println!("{role:?} {ratios:.3?}");
        let near = ratios.iter().all(|ratio| (0.8..1.05).contains(ratio));
        assert!(near, "{role:?} {ratios:.3?}");
    }
}

/// The table of docs/reference/rules.md.
#[test]
#[ignore = "some minutes"]
fn plans_and_dense_search_of_many_scenes() {
    for (role, seed) in [
        (Role::HeadOn, 570),
        (Role::GiveWay, 571),
        (Role::Overtaking, 572),
    ] {
        let ratios = ratios(role, seed, 25);
        let [median, most] = [ratios[12], ratios[23]];
        println!(
            "{role:?}: median {median:.3}, 95 % {most:.3}, worst {:.3}",
            ratios[24]
        );
    }
}
