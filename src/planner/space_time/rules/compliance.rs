//! Requirements of the collision regulations on a manoeuvre after its first alteration, toward
//! targets on their nominal tracks.

use crate::colregs::compliance::{ComplianceReport, OwnSamples};
use crate::colregs::{Encountered, MOST_SMALL_TURNS, ON_COURSE, Risk, SMALL_TURN, TargetMemory};
use crate::frame::{Pose, Side, Vector, cross, heading_of, wrap};
use crate::planner::Problem;
use crate::planner::space_time::motion::until as motion_until;
use crate::target::ShipTrack;
use crate::trajectory::{Segment, Trajectory};
use crate::vessel::Hull;

/// Samples per segment for the position relative to a target.
const ARC_SAMPLES: u32 = 32;

/// Seconds after the closest approach of the hulls at which a target counts as passed: more than
/// the step of the samples that it is found by, and of those of the judges.
const PASSED_S: f64 = 3.0;

/// Greatest time between two samples for the closest approach, seconds.
const NEAREST_S: f64 = 1.0;

/// True when a motion passes every target as its role requires ([`Role::duties`]).
///
/// It checks crossing ahead, the passing side, forbidden courses and small turns. `off_route` is the
/// part that begins with the turn off the route. It is empty where own ship only slows down.
///
/// [`Role::duties`]: crate::colregs::Role::duties
pub(super) fn complies(problem: &Problem, motion: &[Segment], off_route: &[Segment]) -> bool {
    problem.encountered.iter().all(|encountered| {
        let duties = encountered.role.duties();
        if !keeps_off_bow_of(encountered, motion) {
            return false;
        }
        let nearest = Nearest::of(&problem.own.hull, encountered, motion);
        let passes = nearest.drifts_to_port || !duties.port_to_port;
        let until = nearest.time + PASSED_S;
        let off = |side| keeps_off(problem, off_route, side, until);
        let heads = duties.no_heading_to.is_none_or(off);
        let plain = !duties.keeps_clear || small_turns(motion, nearest.time) <= MOST_SMALL_TURNS;
        passes && heads && plain
    })
}

/// Number of rules that both judges find broken by a motion. O(targets × seconds).
pub(super) fn broken_rules(problem: &Problem, motion: &[Segment]) -> usize {
    let Ok(trajectory) = Trajectory::new(motion.to_vec()) else {
        return usize::MAX;
    };
    let thresholds = problem.thresholds;
    let own = OwnSamples::along(&[], &trajectory, problem.own);
    let samples = problem.encountered.iter().map(|e| {
        let track = ShipTrack::exact(e.ship.pose, e.ship.speed, e.hull);
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

/// True when a motion keeps off the bows of all targets. Where its beginning does not, the whole
/// does not (up to sampling).
pub(super) fn keeps_off_bows(problem: &Problem, motion: &[Segment]) -> bool {
    let mut all = problem.encountered.iter();
    all.all(|encountered| keeps_off_bow_of(encountered, motion))
}

/// True when a motion never crosses the target's course line within [`Encountered::bow_room`] ahead
/// of the target, nor is slower than a target that it overtakes there.
fn keeps_off_bow_of(encountered: &Encountered, motion: &[Segment]) -> bool {
    let room = encountered.bow_room();
    if room <= 0.0 {
        return true;
    }
    let ship = &encountered.ship;
    let seen = |s: &Segment, time: f64| {
        let target = Pose {
            position: ship.pose.position + ship.velocity() * time,
            ..ship.pose
        };
        target.body_coordinates(s.pose_at(time).position)
    };
    let mut before: Option<Vector> = None;
    motion.iter().all(|s| {
        let hampers = room.is_finite() && s.speed < ship.speed;
        (0..=ARC_SAMPLES).all(|k| {
            let share = f64::from(k) / f64::from(ARC_SAMPLES);
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

/// Closest approach of the hulls on a motion to a target that holds course and speed.
#[derive(Debug)]
struct Nearest {
    time: f64,
    /// True when the target then moves from starboard to port as seen from own ship.
    drifts_to_port: bool,
}

impl Nearest {
    /// By samples every [`NEAREST_S`] seconds, and at the ends of the segments.
    fn of(own: &Hull, encountered: &Encountered, motion: &[Segment]) -> Self {
        let ship = &encountered.ship;
        let at = |s: &Segment, time: f64| {
            let target = ship.pose.position + ship.velocity() * time;
            (s.pose_at(time), target)
        };
        let apart = |s: &Segment, time: f64| {
            let (pose, target) = at(s, time);
            (pose.position - target).norm()
        };
        // a lower bound on each segment, exact on lines
        let centres_on = |s: &Segment| {
            let (from, to) = (apart(s, s.start_time), apart(s, s.end_time()));
            if s.is_arc() {
                let closing = s.speed + ship.speed;
                return 0.5 * (from + to - closing * s.duration);
            }
            let offset = s.start.position - ship.pose.position - ship.velocity() * s.start_time;
            let relative = s.velocity_at(s.start_time) - ship.velocity();
            let ahead = -offset.dot(&relative) / relative.norm_squared();
            let within = ahead > 0.0 && ahead < s.duration;
            let there = if within {
                apart(s, s.start_time + ahead)
            } else {
                from
            };
            there.min(from).min(to)
        };
        let ends = |s: &Segment| apart(s, s.start_time).min(apart(s, s.end_time()));
        let centres = (motion.iter())
            .map(|s| if s.is_arc() { ends(s) } else { centres_on(s) })
            .fold(f64::INFINITY, f64::min);
        // hulls may be nearest where the centres are not
        let (long, wide) = (
            own.half_diagonal() + encountered.hull.half_diagonal(),
            0.5 * (own.beam + encountered.hull.beam),
        );
        let (mut least, mut nearest) = (f64::INFINITY, None);
        let origin = |heading| Pose::new(Vector::zeros(), heading);
        let hull = encountered.hull.polygon(&origin(ship.pose.heading));
        let both = |heading| hull.minkowski_sum(&own.polygon(&origin(heading)).negated());
        for s in motion {
            if centres_on(s) > centres + long - wide {
                continue;
            }
            // on a line the heading is that of its start
            let on_line = (!s.is_arc()).then(|| both(s.start.heading));
            let steps = (s.duration / NEAREST_S).ceil().max(1.0);
            for k in 0..=steps as usize {
                let time = s.start_time + s.duration * (k as f64 / steps);
                let (pose, target) = at(s, time);
                let from_target = pose.position - target;
                let range = from_target.norm();
                // the hulls are no nearer than the range less `long`
                if range > centres + long - wide || range - long >= least {
                    continue;
                }
                let hulls = match &on_line {
                    Some(sum) => sum.signed_distance(from_target),
                    None => both(pose.heading).signed_distance(from_target),
                };
                if hulls < least {
                    let relative = s.velocity_at(time) - ship.velocity();
                    least = hulls;
                    nearest = Some(Self {
                        time,
                        drifts_to_port: cross(relative, from_target) < 0.0,
                    });
                }
            }
        }
        nearest.unwrap_or(Self {
            time: 0.0,
            drifts_to_port: false,
        })
    }
}
