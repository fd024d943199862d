//! Normalisation of a problem by a similarity transformation: position, direction, reflection and
//! size.
//!
//! In the normalised problem own ship starts at the origin with heading zero. The lengths and times
//! of the graph and the refinement suit harbour encounters, so other problems are scaled to that
//! size. Where both sides are equivalent, a reflection puts the first target to starboard. Numbers
//! are rounded to a grid that is coarse relative to the rounding of all this; sets are rounded
//! outward. So the same scene elsewhere is the same problem to the last digit. The plan is
//! transformed back.

use crate::clock::Clock;
use crate::space_time::proxy::{Proxy, by_obstacle, first_contact};
use crate::{
    EdgeVerdict, ExploredGraph, NoPlan, Outcome, Plan, Planned, PlannedManoeuvre, Problem,
    Tidiness, UnderWay,
};
use searoom_colregs::{Encountered, SteadyShip};
use searoom_geometry::frame::{Pose, Vector, cross, heading_of, to_port, wrap};
use searoom_geometry::tolerance;
use searoom_geometry::{ConvexPolygon, ConvexSet, Ellipse};
use searoom_model::target::{TimedVelocitySet, Uncertainty};
use searoom_model::trajectory::{DesiredTrajectory, Segment, Trajectory};
use searoom_model::vessel::{Hull, OwnShip};
use searoom_sets::{LandObstacle, Obstacle, SpaceTimeObstacle};

/// Metres at the normalised size. Sets with less room around their centre are not rounded.
const LEAST_ROOM_M: f64 = 0.33;

/// Grids at that size are powers of two, so that grid numbers are exact. They are for positions of
/// sets (0.06 mm), waypoints, on which plans must end, velocities (m/s), and times (s).
const SET_GRID_M: f64 = 1.0 / 16_384.0;
const WAYPOINT_GRID_M: f64 = 1.0 / 8_388_608.0;
const VELOCITY_GRID_MPS: f64 = 1.0 / 17_179_869_184.0;
const TIME_GRID_S: f64 = 1.0 / 1_073_741_824.0;

/// Grid of the velocities of an ellipsoid whose initial ellipse makes up for it, m/s. The smallest
/// ellipse around a polygon has fewer digits than the polygon.
const ELLIPSE_GRID_MPS: f64 = 64.0 * VELOCITY_GRID_MPS;

/// Grid of the durations of an initial motion, seconds.
const DURATION_GRID_S: f64 = 1.0 / 1_048_576.0;

/// Largest rounding of the problem's waypoints, metres of the problem.
const WAYPOINTS_OFF_M: f64 = 0.7 * tolerance::ARRIVAL_M;

/// Significant binary digits of other numbers.
const DIGITS: i32 = 40;

/// Numbers beyond this are not rounded.
const LARGEST_ON_GRID: f64 = 1e7;

/// The size by a set is a power of this times the size by the turning radius.
const STEP: f64 = std::f64::consts::SQRT_2;

/// Longest normalised path, metres. Without this limit, a tiny set on the path could require more
/// time steps than fit in memory.
const LONGEST_M: f64 = 5e5;

/// Largest scale factor in either direction.
const MAX_SCALE: f64 = 1e12;

/// Metres. A desired path within this distance of own ship's pose is moved to lead through it, so
/// that rounding adds no joining manoeuvre.
const ON_PATH_M: f64 = 1e-7;

/// Metres at the normalised size. Points this close to own ship's line ahead are on neither side.
const AHEAD_M: f64 = 1e-3;

/// Seconds. Contacts this close to one another differ by rounding.
const SIMULTANEOUS_S: f64 = 1e-6;

/// Samples of the desired trajectory.
const SAMPLES: usize = 64;

/// Similarity transformation from the normalised problem to the original one.
#[derive(Debug, Clone)]
pub(crate) struct Similarity {
    origin: Pose,
    /// Unit vector ahead.
    ahead: Vector,
    /// -1 for a reflection of port and starboard, otherwise 1.
    mirror: f64,
    /// Metres and seconds of the problem per normalised metre and second.
    length: f64,
    time: f64,
    /// Own ship's speeds, m/s.
    speeds: Vec<f64>,
    /// Indices of the obstacles within reach, and the number of all obstacles.
    within: Vec<usize>,
    all: usize,
}

/// Normalised problem.
pub(crate) struct NormalisedProblem {
    own: OwnShip,
    desired: DesiredTrajectory,
    obstacles: Vec<Obstacle>,
    land_obstacle: Option<LandObstacle>,
    encountered: Vec<Encountered>,
    under_way: Option<UnderWay>,
    horizon: f64,
    time_weight: f64,
    tidy: Option<Tidiness>,
}

impl Similarity {
    /// Transformation of a problem, given the proxies within reach. Problems with land or rules are
    /// not scaled: these contain lengths and times of their own.
    pub(crate) fn of(problem: &Problem, proxies: &[Proxy]) -> Self {
        let own = problem.own;
        let mut of = Self {
            origin: own.pose,
            ahead: own.pose.ahead(),
            mirror: 1.0,
            length: 1.0,
            time: 1.0,
            speeds: own.speeds.clone(),
            within: by_obstacle(proxies).map(|h| h[0].obstacle).collect(),
            all: problem.obstacles.len(),
        };
        let rules = !problem.encountered.is_empty() || problem.under_way.is_some();
        if !problem.land_obstacle.is_empty() || rules {
            return of;
        }
        (of.length, of.time) = size(problem, proxies);
        if problem.first_turn.is_none() {
            of.mirror = of.mirror_sign(problem, proxies);
        }
        of
    }

    /// Same position and direction without scaling.
    pub(crate) fn without_scaling(self) -> Option<Self> {
        let is_scaled = self.length != 1.0 || self.time != 1.0;
        is_scaled.then_some(Self {
            length: 1.0,
            time: 1.0,
            ..self
        })
    }

    /// Sign of the reflection: -1 where the first object off the line ahead is to port. These are the place and
    /// the drift of the target that is met on schedule, then the bends of the route, then the other targets,
    /// because one that is never near should not decide how another is passed.
    fn mirror_sign(&self, problem: &Problem, proxies: &[Proxy]) -> f64 {
        let met = met_on_schedule(problem.desired, proxies);
        let (met, others): (Vec<&Proxy>, Vec<&Proxy>) =
            proxies.iter().partition(|h| Some(h.obstacle) == met);
        let size = &problem.settings.size;
        let aside = |proxies: Vec<&Proxy>| {
            let places = proxies.iter().filter_map(|h| h.disc_at(h.start()));
            let places = places.map(|(centre, _)| self.place(centre).y);
            let drifts = proxies.iter().map(|h| self.velocity(h.drift()).y);
            let drifts = drifts.map(|drift| drift * size.turn_m / size.speed_mps);
            places.chain(drifts).find(|y| y.abs() > AHEAD_M)
        };
        let bend = || {
            let bends = problem.desired.waypoints().into_iter();
            bends.map(|w| self.place(w).y).find(|y| y.abs() > AHEAD_M)
        };
        let first = aside(met).or_else(bend).or_else(|| aside(others));
        first.map_or(1.0, |y| -y.signum())
    }

    fn speed(&self) -> f64 {
        self.length / self.time
    }

    fn turned(&self, v: Vector) -> Vector {
        Vector::new(self.ahead.dot(&v), self.mirror * cross(self.ahead, v))
    }

    fn place(&self, place: Vector) -> Vector {
        self.turned(place - self.origin.position) / self.length
    }

    fn velocity(&self, velocity: Vector) -> Vector {
        self.turned(velocity) / self.speed()
    }

    fn pose(&self, pose: Pose) -> Pose {
        let heading = self.mirror * wrap(pose.heading - self.origin.heading);
        Pose::new(self.place(pose.position), heading)
    }

    fn polygon(&self, set: &ConvexPolygon, to: impl Fn(Vector) -> Vector) -> ConvexPolygon {
        let mut vertices: Vec<Vector> = set.vertices().iter().map(|p| to(*p)).collect();
        if self.mirror < 0.0 {
            vertices.reverse();
        }
        ConvexPolygon::from_ccw(vertices)
    }

    /// Set of positions at t = 0, enlarged by more than the grids remove until the horizon. It is
    /// unchanged where it has too little room, or own ship has.
    fn places(&self, set: &ConvexPolygon, horizon: f64) -> ConvexPolygon {
        let exact = self.polygon(set, |p| self.place(p));
        let middle = on_grid(exact.centroid(), SET_GRID_M);
        let room = -exact.signed_distance(middle);
        // negated on purpose: a NaN is no room
        if !(room >= LEAST_ROOM_M) {
            return exact;
        }
        let grown = 1.0 + rounding_loss(horizon / self.time) / room;
        let vertex = |p: &Vector| on_grid(middle + (p - middle) * grown, SET_GRID_M);
        let vertices: Vec<Vector> = exact.vertices().iter().map(vertex).collect();
        match ConvexPolygon::hull(&vertices) {
            Ok(outer) if !outer.contains(Vector::zeros()) => outer,
            _ => exact,
        }
    }

    fn ellipse(&self, set: &Ellipse, centre: Vector, unit: f64) -> Ellipse {
        Ellipse::from_axes(centre, set.semi_axes().map(|a| self.turned(a) / unit))
    }

    /// [`Self::places`] for an ellipse, and the grid of its velocities.
    fn elliptic_places(&self, set: &Ellipse, horizon: f64) -> (Ellipse, f64) {
        let exact = self.ellipse(set, self.place(set.center()), self.length);
        let room = exact.semi_axes()[1].norm();
        // negated on purpose: a NaN is no room
        if !(room >= LEAST_ROOM_M) {
            return (exact, VELOCITY_GRID_MPS);
        }
        let loss = SET_GRID_M + ELLIPSE_GRID_MPS * horizon / self.time;
        let grown = exact.scaled_about_center(1.0 + 2.0 * loss / room);
        let outer = ellipse_on_grid(&grown, SET_GRID_M);
        if outer.contains(Vector::zeros()) {
            return (exact, VELOCITY_GRID_MPS);
        }
        (outer, ELLIPSE_GRID_MPS)
    }

    fn velocities(&self, set: &ConvexPolygon) -> ConvexPolygon {
        let exact = self.polygon(set, |v| self.velocity(v));
        let vertex = |v: &Vector| on_grid(*v, VELOCITY_GRID_MPS);
        let vertices: Vec<Vector> = exact.vertices().iter().map(vertex).collect();
        ConvexPolygon::hull(&vertices).unwrap_or(exact)
    }

    /// Normalised problem; `None` where no digits would remain, or the time is up.
    pub(crate) fn normalised(&self, problem: &Problem, clock: Clock) -> Option<NormalisedProblem> {
        let (own, speed, horizon) = (problem.own, self.speed(), problem.horizon);
        let legs = problem.desired.legs().iter();
        let speeds: Vec<f64> = legs.map(|l| rounded(l.speed / speed)).collect();
        // the clock is read for each: hundreds of sets that change with time take tens of
        // milliseconds
        let obstacles = self.within.iter().map(|i| {
            let obstacle = &problem.obstacles[*i];
            (!clock.is_up()).then(|| self.obstacle(obstacle, horizon))?
        });
        let ship = |e: &Encountered| Encountered {
            ship: SteadyShip {
                pose: self.pose(e.ship.pose),
                ..e.ship
            },
            own: SteadyShip {
                pose: self.pose(e.own.pose),
                ..e.own
            },
            ..*e
        };
        Some(NormalisedProblem {
            own: OwnShip {
                pose: Pose::new(Vector::zeros(), 0.0),
                speed: rounded(own.speed / speed),
                hull: Hull::new(own.hull.length / self.length, own.hull.beam / self.length),
                turning_radius: rounded(own.turning_radius / self.length),
                speeds: own.speeds.iter().map(|u| rounded(u / speed)).collect(),
                safety_margin: own.safety_margin / self.length,
                tracking_margin: 0.0,
            },
            desired: DesiredTrajectory::new(&self.waypoints(problem), &speeds).ok()?,
            obstacles: obstacles.collect::<Option<_>>()?,
            land_obstacle: (!problem.land_obstacle.is_empty()).then(|| {
                problem
                    .land_obstacle
                    .mapped(|block| self.places(block, horizon))
            }),
            encountered: problem.encountered.iter().map(ship).collect(),
            // nothing is scaled or mirrored then
            under_way: problem.under_way.map(|begun| UnderWay {
                first_heading: wrap(begun.first_heading - self.origin.heading),
                heading: wrap(begun.heading - self.origin.heading),
                ..begun
            }),
            horizon: rounded(horizon / self.time) * (1.0 - 2.0_f64.powi(-DIGITS)),
            time_weight: rounded(problem.time_weight / (speed * speed)),
            tidy: problem.tidy.map(|tidy| Tidiness {
                speed_time: rounded(tidy.speed_time / self.time),
                segment_time: rounded(tidy.segment_time / self.time),
            }),
        })
    }

    /// Waypoints of the desired path, moved through own ship's pose where they miss it by a
    /// rounding.
    fn waypoints(&self, problem: &Problem) -> Vec<Vector> {
        let mut waypoints = problem.desired.waypoints();
        for w in &mut waypoints {
            *w = self.place(*w);
        }
        let step = waypoints[1] - waypoints[0];
        let along = step.normalize();
        let beside = cross(along, waypoints[0]);
        let reach = waypoints.iter().map(|w| w.norm()).fold(0.0, f64::max);
        let moved = (beside.abs() + heading_of(along).abs() * reach) * self.length;
        if moved <= ON_PATH_M {
            for w in &mut waypoints {
                *w = Vector::new(along.dot(w), cross(along, *w) - beside);
            }
        }
        // a plan must end on the problem's last waypoint
        let coarse = WAYPOINT_GRID_M * self.length / WAYPOINTS_OFF_M;
        let grid = WAYPOINT_GRID_M / coarse.max(1.0).log2().ceil().exp2();
        waypoints.into_iter().map(|w| on_grid(w, grid)).collect()
    }

    fn obstacle(&self, obstacle: &Obstacle, horizon: f64) -> Option<Obstacle> {
        let sets = obstacle.sets();
        let (initial, grid): (ConvexSet, f64) = match &sets.initial {
            ConvexSet::Polygon(set) => (self.places(set, horizon).into(), VELOCITY_GRID_MPS),
            ConvexSet::Ellipse(set) => {
                let (outer, grid) = self.elliptic_places(set, horizon);
                (outer.into(), grid)
            }
        };
        let velocities = sets.velocities.iter().map(|timed| {
            let until = number_on_grid(timed.until / self.time, TIME_GRID_S);
            match &timed.velocities {
                ConvexSet::Polygon(set) => TimedVelocitySet::new(until, self.velocities(set)),
                ConvexSet::Ellipse(set) => {
                    let exact = self.ellipse(set, self.velocity(set.center()), self.speed());
                    TimedVelocitySet::new(until, ellipse_on_grid(&exact, grid))
                }
            }
        });
        let velocities = velocities.collect();
        Obstacle::new(obstacle.name(), Uncertainty::new(initial, velocities)).ok()
    }

    /// Motion in the normalised problem, rounded: an initial guess, not a plan.
    pub(crate) fn motion(&self, motion: &[Segment]) -> Vec<Segment> {
        let segment = |s: &Segment| {
            Segment::new(
                self.pose(s.start),
                s.start_time / self.time,
                number_on_grid(s.duration / self.time, DURATION_GRID_S),
                rounded(s.speed / self.speed()),
                self.mirror * s.turn_rate * self.time,
            )
        };
        motion.iter().map(segment).collect()
    }

    /// Transforms a result back.
    pub(crate) fn restored(&self, planned: Planned, horizon: f64) -> Planned {
        let outcome = match planned.outcome {
            Outcome::Solved(plan) => self
                .plan(plan)
                .map_or(Outcome::Infeasible(NoPlan::NoTrajectory), Outcome::Solved),
            Outcome::Deadline(plan) => Outcome::Deadline(plan.and_then(|p| self.plan(p))),
            Outcome::Infeasible(reason) => Outcome::Infeasible(self.reason(reason, horizon)),
        };
        let restored = |manoeuvre: PlannedManoeuvre| PlannedManoeuvre {
            first_heading: wrap(manoeuvre.first_heading + self.origin.heading),
            ..manoeuvre
        };
        Planned {
            outcome,
            manoeuvres: planned.manoeuvres.into_iter().map(restored).collect(),
            explored: self.explored(planned.explored),
            ..planned
        }
    }

    fn cost(&self, cost: f64) -> f64 {
        cost * (self.length * self.length)
    }

    fn restored_pose(&self, pose: Pose) -> Pose {
        let (along, port) = (self.ahead, to_port(self.ahead) * self.mirror);
        let from = (along * pose.position.x + port * pose.position.y) * self.length;
        Pose::new(
            self.origin.position + from,
            self.origin.heading + self.mirror * pose.heading,
        )
    }

    fn segment(&self, s: &Segment) -> Segment {
        let speed = s.speed * self.speed();
        // exactly one of own ship's speeds
        let known = self.speeds.iter().copied();
        let known = known.min_by(|a, b| (a - speed).abs().total_cmp(&(b - speed).abs()));
        Segment::new(
            self.restored_pose(s.start),
            s.start_time * self.time,
            s.duration * self.time,
            known.unwrap_or(speed),
            self.mirror * s.turn_rate / self.time,
        )
    }

    fn plan(&self, plan: Plan) -> Option<Plan> {
        let segments = plan.trajectory.segments().iter();
        Some(Plan {
            trajectory: Trajectory::new(segments.map(|s| self.segment(s)).collect()).ok()?,
            cost: self.cost(plan.cost),
            method: plan.method,
            graph_cost: plan.graph_cost.map(|c| self.cost(c)),
            to_go: plan.to_go * self.length,
        })
    }

    fn explored(&self, mut explored: ExploredGraph) -> ExploredGraph {
        for node in explored.node_weights_mut() {
            node.pose = self.restored_pose(node.pose);
            node.time *= self.time;
            node.cost = self.cost(node.cost);
        }
        for edge in explored.edge_weights_mut() {
            edge.cost = self.cost(edge.cost);
            if let EdgeVerdict::Blocked { obstacle } = &mut edge.verdict {
                *obstacle = self.within.get(*obstacle).copied().unwrap_or(self.all);
            }
            for segment in &mut edge.segments {
                *segment = self.segment(segment);
            }
        }
        explored
    }

    fn reason(&self, reason: NoPlan, horizon: f64) -> NoPlan {
        match reason {
            NoPlan::StartInside { target, depth } => NoPlan::StartInside {
                target,
                depth: depth * self.length,
            },
            NoPlan::HorizonTooShort { earliest, .. } => NoPlan::HorizonTooShort {
                earliest: earliest * self.time,
                horizon,
            },
            NoPlan::EndCovered { target, earliest } => NoPlan::EndCovered {
                target,
                earliest: earliest * self.time,
            },
            NoPlan::NoCandidate { target, time } => NoPlan::NoCandidate {
                target,
                time: time * self.time,
            },
            // cases with land or rules, which are not scaled, of other planners, or without a
            // length
            other => other,
        }
    }
}

impl NormalisedProblem {
    /// Normalised problem as a [`Problem`]; fields without length or position are the original's.
    pub(crate) fn problem<'a>(&'a self, of: &Problem<'a>) -> Problem<'a> {
        Problem {
            own: &self.own,
            desired: &self.desired,
            obstacles: &self.obstacles,
            land_obstacle: self.land_obstacle.as_ref().unwrap_or(of.land_obstacle),
            encountered: &self.encountered,
            under_way: self.under_way,
            horizon: self.horizon,
            time_weight: self.time_weight,
            tidy: self.tidy,
            ..*of
        }
    }
}

/// Metres and seconds of a problem per normalised metre and second. They follow from own ship's
/// turning radius and desired speed. Where the first set met is very small or large relative to the
/// turning circle, they follow from that set.
fn size(problem: &Problem, proxies: &[Proxy]) -> (f64, f64) {
    let (desired, settings) = (problem.desired, &problem.settings.size);
    let by_turn = problem.own.turning_radius / settings.turn_m;
    let usual = settings.smallest_m..=settings.largest_m;
    let radius = radius_met(desired, proxies).map(|radius| radius / by_turn);
    let radius = radius.filter(|r| *r > 0.0 && !usual.contains(r));
    let longer = (desired.length() / by_turn / LONGEST_M).max(1.0);
    let larger = radius.map_or(1.0, |r| r / settings.set_m).max(longer);
    let length = by_turn * STEP.powf(larger.log(STEP).round());
    let time = length * settings.speed_mps / desired.legs()[0].speed;
    let sound = |x: f64| x > 1.0 / MAX_SCALE && x < MAX_SCALE;
    if sound(length) && sound(time) {
        (length, time)
    } else {
        (1.0, 1.0)
    }
}

/// Largest reduction of a set by rounding until a time, metres: of its vertices, its velocities,
/// and the times of their changes.
fn rounding_loss(time: f64) -> f64 {
    SET_GRID_M + VELOCITY_GRID_MPS * time
}

fn on_grid(v: Vector, grid: f64) -> Vector {
    v.map(|x| number_on_grid(x, grid))
}

/// Ellipse whose triangular factor, which does not depend on the choice of the axes, is on a grid.
/// Its support changes by less than twice the grid.
fn ellipse_on_grid(set: &Ellipse, grid: f64) -> Ellipse {
    let [a, b] = set.semi_axes();
    let first = a.x.hypot(b.x);
    let columns = if first > 0.0 {
        let below = (a.x * a.y + b.x * b.y) / first;
        let last = cross(a, b).abs() / first;
        [Vector::new(first, below), Vector::new(0.0, last)]
    } else {
        [Vector::new(0.0, a.y.hypot(b.y)), Vector::zeros()]
    };
    let columns = columns.map(|c| on_grid(c, grid));
    Ellipse::from_axes(on_grid(set.center(), grid), columns)
}

/// Nearest number on a grid; never -0.
fn number_on_grid(x: f64, grid: f64) -> f64 {
    if x.abs() < LARGEST_ON_GRID {
        (x / grid).round() * grid + 0.0
    } else {
        x
    }
}

/// Number rounded to a fixed count of binary digits.
fn rounded(x: f64) -> f64 {
    let unit = 2.0_f64.powi(x.abs().max(f64::MIN_POSITIVE).log2().floor() as i32 - DIGITS);
    if unit > 0.0 && x.is_finite() {
        (x / unit).round() * unit
    } else {
        x
    }
}

/// The obstacle that own ship meets first on schedule; of several at about the same time the first in the file.
fn met_on_schedule(desired: &DesiredTrajectory, proxies: &[Proxy]) -> Option<usize> {
    let legs = desired.legs().iter();
    let schedule: Vec<Segment> = legs
        .map(|leg| {
            let start = Pose::new(leg.start, heading_of(leg.direction));
            Segment::straight(start, leg.start_time, leg.length / leg.speed, leg.speed)
        })
        .collect();
    let contacts: Vec<(usize, f64)> = by_obstacle(proxies)
        .filter_map(|of_one| first_contact(of_one, &schedule))
        .collect();
    let least = contacts.iter().map(|c| c.1).fold(f64::INFINITY, f64::min);
    let first = contacts.iter().find(|c| c.1 <= least + SIMULTANEOUS_S);
    first.map(|c| c.0)
}

/// Radius of the disc around the section that first contains own ship on schedule, metres.
fn radius_met(desired: &DesiredTrajectory, proxies: &[Proxy]) -> Option<f64> {
    (0..=SAMPLES).find_map(|index| {
        let time = desired.duration() * index as f64 / SAMPLES as f64;
        let place = desired.position_at(time);
        let met = proxies.iter().filter_map(|h| {
            let (centre, radius) = h.disc_at(time)?;
            ((place - centre).norm() <= radius).then_some(radius)
        });
        met.max_by(f64::total_cmp)
    })
}
