//! Two ships that meet, sight after sight: all that the judges see.

use super::super::role::SteadyShip;
use crate::frame::{Vector, relative_bearing};
use crate::geometry::ConvexPolygon;
use crate::target::ShipTrack;
use crate::trajectory::Trajectory;
use crate::vessel::Hull;

/// Seconds between two sights; the joints of a trajectory are sights, too.
const STEP_S: f64 = 1.0;

/// Steps at most: those of a longer trajectory are longer.
const MOST_SIGHTS: u32 = 20_000;

/// m/s. Below this relative speed two ships keep their distance.
const NO_RELATIVE_SPEED: f64 = 1e-9;

/// Both ships at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// Seconds.
    pub time: f64,
    /// Own ship.
    pub own: SteadyShip,
    /// The target.
    pub target: SteadyShip,
    /// Between the hulls, metres, negative in overlap.
    pub apart: f64,
    /// Seconds until the hulls meet if both hold course and speed; infinite where they never do.
    pub meets_in: f64,
}

/// Where two ships that hold course and speed will be nearest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ahead {
    /// Metres between the centres.
    pub distance: f64,
    /// Seconds from now; negative when it is past, 0 when the distance does not change.
    pub time: f64,
}

impl Sight {
    fn offset(&self) -> Vector {
        self.target.pose.position - self.own.pose.position
    }

    /// Metres between the centres.
    pub fn range(&self) -> f64 {
        self.offset().norm()
    }

    /// How fast the range grows, m/s; a NaN where the centres coincide.
    pub fn opening(&self) -> f64 {
        let relative = self.target.velocity() - self.own.velocity();
        self.offset().dot(&relative) / self.range()
    }

    /// Of the target from own ship, radians clockwise from ahead.
    pub fn bearing(&self) -> f64 {
        relative_bearing(&self.own.pose, self.target.pose.position)
    }

    /// Of own ship from the target, radians clockwise from ahead.
    pub fn aspect(&self) -> f64 {
        relative_bearing(&self.target.pose, self.own.pose.position)
    }

    /// If both hold course and speed.
    pub fn ahead(&self) -> Ahead {
        let relative = self.own.velocity() - self.target.velocity();
        let square = relative.norm_squared();
        if !(square > NO_RELATIVE_SPEED * NO_RELATIVE_SPEED) {
            return Ahead {
                distance: self.range(),
                time: 0.0,
            };
        }
        let time = self.offset().dot(&relative) / square;
        Ahead {
            distance: (self.offset() - relative * time.max(0.0)).norm(),
            time,
        }
    }

    /// Own ship from the target: metres ahead of her, and to port.
    pub fn seen_from_target(&self) -> Vector {
        self.target.pose.body_coordinates(self.own.pose.position)
    }
}

/// All sights of own ship and one target, in order of time.
///
/// # Examples
///
/// ```
/// use searoom::colregs::conduct::Meeting;
/// use searoom::comparison;
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let ferry = scenario.targets[0].ship().expect("a ship");
/// let held = comparison::hold_course(&scenario).trajectory;
/// let meeting = Meeting::along(&held, scenario.own_ship.hull, ferry);
/// assert_eq!((meeting.length(), meeting.target_length()), (60.0, 60.0), "metres: the longer ship is hers");
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Meeting {
    sights: Vec<Sight>,
    own: Hull,
    target: Hull,
}

impl Meeting {
    /// From the start of a trajectory to its end, the target on her nominal track. O(duration). Own ship's heading is
    /// taken for her course: a drift is not seen.
    pub fn along(trajectory: &Trajectory, own: Hull, target: &ShipTrack) -> Self {
        let sights = trajectory
            .sample_times(STEP_S, MOST_SIGHTS)
            .into_iter()
            .map(|time| {
                let ships = [
                    SteadyShip {
                        pose: trajectory.pose_at(time),
                        speed: trajectory.speed_at(time),
                    },
                    SteadyShip {
                        pose: target.pose_at(time),
                        speed: target.speed,
                    },
                ];
                let between = between(&own, &ships[0], &target.hull, &ships[1]);
                let apart = between.signed_distance(Vector::zeros());
                let closing = ships[0].velocity() - ships[1].velocity();
                // negated on purpose: a NaN is a meeting
                let meets_in = if !(apart > 0.0) {
                    0.0
                } else {
                    seconds_to(&between, closing)
                };
                Sight {
                    time,
                    own: ships[0],
                    target: ships[1],
                    apart,
                    meets_in,
                }
            })
            .collect();
        Self {
            sights,
            own,
            target: target.hull,
        }
    }

    /// In order of time, at least one.
    pub(crate) fn sights(&self) -> &[Sight] {
        &self.sights
    }

    /// Of the longer ship, metres.
    pub fn length(&self) -> f64 {
        self.own.length.max(self.target.length)
    }

    /// Of the target, metres.
    pub fn target_length(&self) -> f64 {
        self.target.length
    }
}

/// Where own ship's centre meets the target's hull, about the target's centre less own ship's.
fn between(own: &Hull, a: &SteadyShip, target: &Hull, b: &SteadyShip) -> ConvexPolygon {
    target
        .polygon(&b.pose)
        .minkowski_sum(&own.polygon(&a.pose).negated())
}

/// Seconds until a point that leaves the origin at a velocity is in a set; infinite where it never is.
fn seconds_to(set: &ConvexPolygon, velocity: Vector) -> f64 {
    let (mut from, mut until) = (0.0_f64, f64::INFINITY);
    for normal in set.normals() {
        let (rate, room) = (normal.dot(&velocity), set.support(normal));
        if rate > 0.0 {
            until = until.min(room / rate);
        } else if rate < 0.0 {
            from = from.max(room / rate);
        } else if room < 0.0 {
            return f64::INFINITY;
        }
    }
    if from > until { f64::INFINITY } else { from }
}
