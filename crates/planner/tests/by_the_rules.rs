//! Plans by the rules against a grid of the same family of manoeuvres: the slowest way that is
//! obviously right. It shares the sets' contact test and the judges with the planner, no search.

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
        _ => rng.random_range(1.2..2.2),
    };
    let speed = rng.random_range(4.0..6.0);
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

/// Back to the path from starboard of it at an angle, then on, faster while late. `None` where there is
/// no room.
fn returned(mut motion: Vec<Segment>, angle: f64) -> Option<Vec<Segment>> {
    let (pose, _) = end(&motion);
    turned(&mut motion, angle - pose.heading, FASTEST);
    let (pose, _) = end(&motion);
    let left = -pose.position.y - RADIUS * (1.0 - angle.cos());
    if !(left >= 0.0) {
        return None;
    }
    straight(&mut motion, left / angle.sin() / FASTEST, FASTEST);
    turned(&mut motion, -angle, FASTEST);
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

    /// The least cost of the grid: departures every 4 s, turns to starboard every 5°, holds every 3 s,
    /// with a parallel course or without, returns every 2 s at ten angles.
    fn least_of_grid(&self) -> f64 {
        let mut least = f64::INFINITY;
        for leave in 0..=(LATEST / 4.0) as usize {
            for turn in 0..10 {
                let turn = -(30.0 + 5.0 * f64::from(turn)).to_radians();
                for hold in 0..40 {
                    let mut out = Vec::new();
                    straight(&mut out, 4.0 * leave as f64, ORDERED);
                    turned(&mut out, turn, ORDERED);
                    // the first has no parallel course
                    if hold > 0 {
                        straight(&mut out, 3.0 * f64::from(hold), ORDERED);
                        turned(&mut out, -turn, ORDERED);
                    }
                    if self.is_clear(&out) {
                        self.returns(&out, &mut least);
                    }
                }
            }
        }
        least
    }

    fn returns(&self, out: &[Segment], least: &mut f64) {
        for after in 0..120 {
            let mut passed = out.to_vec();
            straight(&mut passed, 3.0 + 2.0 * f64::from(after), ORDERED);
            let so_far = sailed_space_time_error(&self.desired, &passed, ORDERED * ORDERED);
            if so_far >= *least || !self.is_clear(&passed) {
                break;
            }
            if !self.is_passed(&passed, ORDERED) {
                continue;
            }
            for angle in 0..10 {
                let angle = 0.2 + 0.1 * f64::from(angle);
                let Some(motion) = returned(passed.clone(), angle) else {
                    continue;
                };
                let cost = self.cost(&motion);
                if cost < *least && self.is_clear(&motion) && self.is_lawful(&motion) {
                    *least = cost;
                }
            }
        }
    }
}

#[test]
fn no_manoeuvre_of_a_dense_grid_is_much_cheaper() {
    let mut rng = ChaCha8Rng::seed_from_u64(57);
    let mut ratios = Vec::new();
    for case in 0..6 {
        let role = [Role::HeadOn, Role::GiveWay][case % 2];
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
        ratios.push(scene.cost(motion) / scene.least_of_grid());
    }
    println!("{ratios:.3?}");
    assert!(
        ratios.iter().all(|ratio| (0.8..1.02).contains(ratio)),
        "{ratios:.3?}"
    );
}
