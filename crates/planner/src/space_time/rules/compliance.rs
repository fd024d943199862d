//! Requirements of the collision regulations on a manoeuvre after its first alteration, toward
//! targets on their nominal tracks.

use crate::Problem;
use crate::space_time::manoeuvre::motion::until as motion_until;
use searoom_colregs::compliance::{ComplianceReport, OwnSamples};
use searoom_colregs::{
    BetweenHulls, Encountered, MOST_SMALL_TURNS, ON_COURSE, Risk, SMALL_TURN, TargetMemory,
};
use searoom_geometry::frame::{Pose, Side, Vector, cross, heading_of, wrap};
use searoom_model::target::ShipTrack;
use searoom_model::trajectory::{Mover, Segment, Trajectory};
use searoom_model::vessel::Hull;

/// Samples per segment for the position relative to a target.
const ARC_SAMPLES: u32 = 32;

/// Seconds after the closest approach of the hulls at which a target counts as passed. For the judges of a
/// plan 1.5 s are enough head-on, and save 1 % of *J*; but in the closed loop, where the target is not where
/// it was expected, more plans then break a rule (docs/reference/rules.md).
const PASSED_S: f64 = 4.0;

/// Seconds up to which the judges sample so often that this is enough; a longer trajectory has longer
/// steps.
const SAMPLED_S: f64 = 10_000.0;

/// Seconds to which the closest approach is found, and the most steps for it.
const CLOSE_S: f64 = 0.25;
const MOST_THIRDS: usize = 60;

/// Metres by which distances differ at least: parallel hulls keep theirs for some seconds.
const SAME_M: f64 = 1e-6;

/// Greatest time between two samples for the closest approach, seconds.
const NEAREST_S: f64 = 1.0;

/// True when a motion passes every target as its role requires ([`Role::duties`]).
///
/// It checks crossing ahead, the passing side, forbidden courses and small turns. `off_route` is the
/// part that begins with the turn off the route. It is empty where own ship only slows down.
///
/// [`Role::duties`]: searoom_colregs::Role::duties
pub(super) fn complies(problem: &Problem, motion: &[Segment], off_route: &[Segment]) -> bool {
    problem.encountered.iter().all(|encountered| {
        let duties = encountered.role.duties();
        if !keeps_off_bow_of(encountered, motion) {
            return false;
        }
        let nearest = Nearest::of(&problem.own.hull, encountered, motion);
        let passes = nearest.drifts_to_port || !duties.port_to_port;
        let end = motion.last().map_or(0.0, Segment::end_time);
        let until = nearest.time + passing_time(end);
        let off = |side| keeps_off(problem, off_route, side, until);
        let heads = duties.no_heading_to.is_none_or(off);
        let plain = !duties.keeps_clear || small_turns(motion, nearest.sample) <= MOST_SMALL_TURNS;
        passes && heads && plain
    })
}

/// Seconds after the closest approach of the hulls at which a target counts as passed, in a motion of some
/// seconds.
fn passing_time(duration: f64) -> f64 {
    PASSED_S * (duration / SAMPLED_S).max(1.0)
}

/// Time at which own ship on a straight course may head to any side again, seconds: [`passing_time`]
/// after the closest approach of the hulls, or at once where the target is passed already.
pub(super) fn after_nearest(
    problem: &Problem,
    encountered: &Encountered,
    pose: Pose,
    speed: f64,
    time: f64,
) -> f64 {
    let (own, ship) = (&problem.own.hull, &encountered.ship);
    let apart = ship.moved(time).pose.position - pose.position;
    let closing = pose.ahead() * speed - ship.velocity();
    // the hulls are nearest about when the centres are
    let nearest = apart.dot(&closing) / closing.norm_squared();
    let about = (own.length + encountered.hull.length) / closing.norm();
    // a NaN, without relative motion, is at once
    if !(nearest + about > 0.0) {
        return time;
    }
    let hulls = [(own, pose.ahead()), (&encountered.hull, ship.pose.ahead())];
    let distance = |after: f64| {
        let [own, target] = hulls;
        BetweenHulls::new(apart - closing * after, own, target).distance()
    };
    let nearest = closest((nearest - about).max(0.0), nearest + about, distance);
    // the motion is not known yet, and judged when it is
    time + nearest + passing_time(problem.desired.duration())
}

/// Latest time at which a distance that is convex in time is least, but for [`SAME_M`], to [`CLOSE_S`].
fn closest(mut from: f64, mut to: f64, distance: impl Fn(f64) -> f64) -> f64 {
    // the third with the greater distance at its inner end is cut off, the first where both are the same;
    // with hardly any relative motion a third may be less than rounding
    for _ in 0..MOST_THIRDS {
        if !(to - from > CLOSE_S) {
            break;
        }
        let third = (to - from) / 3.0;
        if distance(from + third) < distance(to - third) - SAME_M {
            to -= third;
        } else {
            from += third;
        }
    }
    to
}

/// Number of rules that both judges find broken by a motion. O(targets × seconds).
pub(crate) fn broken_rules(problem: &Problem, motion: &[Segment]) -> usize {
    let Ok(trajectory) = Trajectory::new(motion.to_vec()) else {
        return usize::MAX;
    };
    let thresholds = problem.thresholds;
    let own = OwnSamples::along(&[], &trajectory, problem.own);
    let samples = problem.encountered.iter().map(|e| {
        let track = ShipTrack {
            risk_distance: e.risk_distance,
            ..ShipTrack::exact(e.ship.pose, e.ship.speed, e.hull)
        };
        // a role that has begun before the plan is kept
        let known = (e.risk_since <= 0.0).then(|| TargetMemory {
            role: Some(Risk {
                role: e.role,
                time: e.risk_since,
                own: e.own,
                target: e.ship,
            }),
            ..TargetMemory::default()
        });
        ComplianceReport::samples(&own, &track, known.as_ref(), thresholds)
    });
    let samples: Vec<_> = samples.collect();
    let reports = ComplianceReport::of_all(samples.iter(), thresholds);
    reports.iter().map(|report| report.broken().count()).sum()
}

/// Number of turns until a time that are too small to be apparent. Consecutive turns to one side
/// count as one.
fn small_turns(motion: &[Segment], until: f64) -> usize {
    let turns = |a: &Segment, b: &Segment| a.turn_rate * b.turn_rate > 0.0;
    let before = motion_until(motion, until);
    let sums = before
        .chunk_by(turns)
        .map(|c| c.iter().map(|s| s.turn_rate * s.duration).sum::<f64>());
    sums.filter(|turn| turn.abs() > ON_COURSE && turn.abs() < SMALL_TURN)
        .count()
}

/// True when a motion never crosses the target's course line within [`Encountered::bow_room`] ahead
/// of the target, nor is slower than a target that it overtakes there.
fn keeps_off_bow_of(encountered: &Encountered, motion: &[Segment]) -> bool {
    let room = encountered.bow_room();
    if room <= 0.0 {
        return true;
    }
    let ship = &encountered.ship;
    let (drift, ahead) = (ship.velocity(), ship.pose.ahead());
    let seen = |s: &Segment, time: f64| {
        let from_target = s.pose_at(time).position - ship.pose.position - drift * time;
        Vector::new(ahead.dot(&from_target), cross(ahead, from_target))
    };
    let mut before: Option<Vector> = None;
    motion.iter().all(|s| {
        let hampers = room.is_finite() && s.speed < ship.speed;
        // seen from the target a line is one, too
        let parts = if s.is_arc() || hampers {
            ARC_SAMPLES
        } else {
            1
        };
        (0..=parts).all(|k| {
            let share = f64::from(k) / f64::from(parts);
            let here = seen(s, s.start_time + s.duration * share);
            if hampers && here.x > 0.0 && here.norm() < room {
                return false;
            }
            let from = before.replace(here).unwrap_or(here);
            if (from.y < 0.0) == (here.y < 0.0) {
                return true;
            }
            let ahead = from.x + (here.x - from.x) * from.y / (from.y - here.y);
            // a NaN counts as ahead of the bow
            ahead <= 0.0 || ahead >= room
        })
    })
}

/// True unless own ship heads to a side both of its course before the departure and of the path's
/// course there, until a time.
fn keeps_off(problem: &Problem, off_route: &[Segment], side: Side, until: f64) -> bool {
    let before = match problem.under_way {
        Some(begun) => begun.first_heading,
        None => off_route.first().map_or(0.0, |s| s.start.heading),
    };
    motion_until(off_route, until).iter().all(|s| {
        [s.start, s.end()].iter().all(|pose| {
            let at = problem
                .desired
                .nearest(pose.position, s.start_time, problem.time_weight);
            let path = heading_of(problem.desired.legs()[at.leg].direction);
            let beyond = |course: f64| side.turn_sign() * wrap(pose.heading - course) > ON_COURSE;
            !(beyond(before) && beyond(path))
        })
    })
}

/// Metres from the centre of a hull to its farthest point in a direction.
fn reach(hull: &Hull, ahead: Vector, toward: Vector) -> f64 {
    0.5 * (hull.length * ahead.dot(&toward).abs() + hull.beam * cross(ahead, toward).abs())
}

/// Closest approach of the hulls on a motion to a target that holds course and speed.
#[derive(Debug)]
struct Nearest {
    /// Time of the nearest sample, seconds.
    sample: f64,
    /// Latest time of the least distance between the samples beside it on its segment, seconds.
    time: f64,
    /// True when the target then moves from starboard to port as seen from own ship.
    drifts_to_port: bool,
}

impl Nearest {
    /// About the nearest of the samples every [`NEAREST_S`] seconds, and at the ends of the segments.
    fn of(own: &Hull, encountered: &Encountered, motion: &[Segment]) -> Self {
        let ship = &encountered.ship;
        let drift = ship.velocity();
        let apart = |s: &Segment, time: f64| {
            (s.pose_at(time).position - ship.pose.position - drift * time).norm()
        };
        let steps = |s: &Segment| (s.duration / NEAREST_S).ceil().max(1.0);
        let sample = |s: &Segment, k: f64| s.start_time + s.duration * (k / steps(s));
        // least range of a segment's samples: on a line of the one nearest to the closest approach,
        // on an arc a lower bound
        let centres_on = |s: &Segment| {
            if s.is_arc() {
                let (from, to) = (apart(s, s.start_time), apart(s, s.end_time()));
                let closing = s.speed + ship.speed;
                return 0.5 * (from + to - closing * s.duration);
            }
            let offset = s.start.position - ship.pose.position - drift * s.start_time;
            let relative = s.velocity_at(s.start_time) - drift;
            let ahead = -offset.dot(&relative) / relative.norm_squared();
            // a NaN, without relative motion, is the first
            let k = (ahead / s.duration * steps(s)).round().max(0.0);
            apart(s, sample(s, k.min(steps(s))))
        };
        let ends = |s: &Segment| apart(s, s.start_time).min(apart(s, s.end_time()));
        let centres = (motion.iter())
            .map(|s| if s.is_arc() { ends(s) } else { centres_on(s) })
            .fold(f64::INFINITY, f64::min);
        // hulls may be nearest where the centres are not: they are no nearer than the range less
        // `long`, and no farther than the range less `wide`
        let long = own.half_diagonal() + encountered.hull.half_diagonal();
        let wide = [own, &encountered.hull].map(|hull| 0.5 * hull.length.min(hull.beam));
        let most = centres + long - wide.iter().sum::<f64>();
        let course = ship.pose.ahead();
        let hulls_apart = |from_target: Vector, ahead: Vector| {
            let target = (&encountered.hull, course);
            BetweenHulls::new(-from_target, (own, ahead), target).distance()
        };
        let (mut least, mut nearest) = (f64::INFINITY, None);
        let mut add = |s: &Segment, (time, from_target): (f64, Vector), hulls: f64| {
            if hulls < least {
                nearest = Some((*s, time, from_target));
                least = hulls;
            }
            least
        };
        let near = |s: &&Segment| centres_on(s) <= most;
        // lines first, because they leave few samples of arcs
        let (arcs, lines): (Vec<&Segment>, Vec<&Segment>) =
            motion.iter().filter(near).partition(|s| s.is_arc());
        let mut so_far = f64::INFINITY;
        for s in lines {
            // the heading is that of its start, and the distance of the hulls convex in time
            let (ahead, velocity) = (s.start.ahead(), s.velocity_at(s.start_time));
            let from_target = |k: usize| {
                let time = sample(s, k as f64);
                let place = s.start.position + velocity * (time - s.start_time);
                (time, place - ship.pose.position - drift * time)
            };
            let hulls = |k: usize| hulls_apart(from_target(k).1, ahead);
            let (mut first, mut last) = (0, steps(s) as usize);
            while first < last {
                let middle = (first + last) / 2;
                match hulls(middle) <= hulls(middle + 1) {
                    true => last = middle,
                    false => first = middle + 1,
                }
            }
            so_far = add(s, from_target(first), hulls(first));
        }
        for s in arcs {
            let mover = Mover::new(s);
            // metres by which the hulls come nearer from one sample to the next, at most
            let turning = s.turn_rate.abs() * own.half_diagonal();
            let step = (s.speed + ship.speed + turning) * s.duration / steps(s);
            // from the nearer end, because the others are left out by what is found there
            let (steps, begins) = (steps(s), apart(s, s.start_time) < apart(s, s.end_time()));
            let mut along = 0.0;
            while along <= steps {
                let time = sample(s, if begins { along } else { steps - along });
                let from_target = mover.position_at(time) - ship.pose.position - drift * time;
                let range = from_target.norm();
                let (to_own, ahead) = (from_target / range, mover.velocity_at(time) / s.speed);
                // no hulls are nearer than along the line between their centres
                let reaches = reach(own, ahead, to_own) + reach(&encountered.hull, course, to_own);
                let mut hulls = range - reaches;
                // negated on purpose: a NaN, at no range, is not far
                if !(hulls >= so_far) {
                    hulls = hulls_apart(from_target, ahead);
                    so_far = add(s, (time, from_target), hulls);
                }
                along += ((hulls - so_far) / step).floor().max(1.0);
            }
        }
        let Some((s, time, from_target)) = nearest else {
            return Self {
                sample: 0.0,
                time: 0.0,
                drifts_to_port: false,
            };
        };
        let hulls = |time: f64| {
            let pose = s.pose_at(time);
            let from_target = pose.position - ship.pose.position - drift * time;
            hulls_apart(from_target, pose.ahead())
        };
        let step = s.duration / steps(&s);
        let from = (time - step).max(s.start_time);
        let relative = s.velocity_at(time) - drift;
        Self {
            sample: time,
            time: closest(from, (time + step).min(s.end_time()), hulls),
            drifts_to_port: cross(relative, from_target) < 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::geometry_fixtures::random_vector;
    use crate::ship_fixtures::chain;
    use searoom_colregs::{Role, SteadyShip};
    use searoom_geometry::frame::{direction, to_port};

    /// Distance of the hulls, time and drift to port, every second of a motion.
    fn every_sample(own: &Hull, e: &Encountered, motion: &[Segment]) -> Vec<(f64, f64, bool)> {
        let samples = motion.iter().flat_map(|s| {
            let steps = (s.duration / NEAREST_S).ceil().max(1.0);
            (0..=steps as usize).map(move |k| {
                let time = s.start_time + s.duration * (k as f64 / steps);
                let (pose, target) = (s.pose_at(time), e.ship.moved(time).pose);
                let sum = (e.hull.polygon(&target)).minkowski_sum(&own.polygon(&pose).negated());
                let relative = s.velocity_at(time) - e.ship.velocity();
                let drift = cross(relative, pose.position - target.position) < 0.0;
                (sum.signed_distance(Vector::zeros()), time, drift)
            })
        });
        samples.collect()
    }

    fn one_of(rng: &mut ChaCha8Rng, values: &[f64]) -> f64 {
        values[rng.random_range(0..values.len())]
    }

    /// Lines, circles and waits past targets that are crossed, followed or passed more than once.
    #[test]
    fn the_nearest_sample_is_that_of_all_samples() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        for case in 0..1_000 {
            let mut hull = || {
                let length = one_of(&mut rng, &[1.0, 6.0, 30.0, 120.0]);
                Hull::new(length, length * rng.random_range(0.1..3.0))
            };
            let (own, hull) = (hull(), hull());
            let parts = (0..rng.random_range(1..7)).map(|_| {
                let speed = one_of(&mut rng, &[0.0, 3.0, 5.0, 15.0]);
                let turn = one_of(&mut rng, &[0.0, 0.06, -0.06]) * f64::from(speed > 0.0);
                (rng.random_range(0.5..80.0), speed, turn)
            });
            let motion = chain(Pose::new(Vector::zeros(), 0.0), &parts.collect::<Vec<_>>());
            let met = motion[rng.random_range(0..motion.len())];
            let time = met.start_time + met.duration * rng.random_range(0.0..1.0);
            let there = met.pose_at(time);
            let heading = [there.heading, rng.random_range(-3.0..3.0)][case % 2];
            let place = there.position + random_vector(&mut rng, [1.0, 20.0, 120.0][case % 3]);
            let speed = one_of(&mut rng, &[0.0, 1.0, 5.0, 20.0]);
            let ship = SteadyShip::new(Pose::new(place, heading), speed).moved(-time);
            let encountered = Encountered {
                role: Role::GiveWay,
                ship,
                hull,
                risk_distance: 0.0,
                own: ship,
                risk_since: 0.0,
                tcpa: 0.0,
            };
            let mut all = every_sample(&own, &encountered, &motion);
            let least = all.iter().fold(f64::INFINITY, |least, s| least.min(s.0));
            all.retain(|(distance, ..)| *distance <= least + 1e-9);
            let found = Nearest::of(&own, &encountered, &motion);
            let same = |s: &(_, f64, bool)| (s.1, s.2) == (found.sample, found.drifts_to_port);
            assert!(all.iter().any(same), "{case}: {found:?}, {all:?}");
            let near = motion
                .iter()
                .filter(|s| s.start_time <= found.time && found.time <= s.end_time());
            let apart = near.map(|s| {
                let (pose, target) = (
                    s.pose_at(found.time),
                    encountered.ship.moved(found.time).pose,
                );
                let sum = hull
                    .polygon(&target)
                    .minkowski_sum(&own.polygon(&pose).negated());
                sum.signed_distance(Vector::zeros())
            });
            // within [`CLOSE_S`] of a sample or of a nearer place between two
            let closing = (speed + 15.0 + 0.06 * own.half_diagonal()) * CLOSE_S;
            let apart = apart.fold(f64::INFINITY, f64::min);
            assert!(apart <= least + closing + 1e-9, "{case}: {apart} {least}");
        }
    }

    /// Ships on parallel courses are nearest for as long as their hulls are beside each other.
    #[test]
    fn the_closest_approach_of_parallel_courses_is_the_latest() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        for _ in 0..2_000 {
            let course = rng.random_range(-3.0..3.0);
            let (ahead, beam) = (direction(course), to_port(direction(course)));
            let (own, target) = (Hull::new(40.0, 8.0), Hull::new(90.0, 12.0));
            let meets = rng.random_range(30.0..60.0);
            let apart = |time: f64| {
                let offset = ahead * (10.0 * (meets - time)) + beam * 50.0;
                BetweenHulls::new(offset, (&own, ahead), (&target, -ahead)).distance()
            };
            let (half, found) = (0.5 * (40.0 + 90.0) / 10.0, closest(0.0, 100.0, apart));
            assert!(
                (found - meets - half).abs() < 2.0 * CLOSE_S,
                "{found} {meets}"
            );
        }
    }
}
