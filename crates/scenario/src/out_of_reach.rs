//! Targets that cannot come near own ship before the horizon: listed, but not planned for.

use std::sync::Arc;

use super::Scenario;
use searoom_colregs::Thresholds;
use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance::SIGMAS;
use searoom_model::target::{DomainKind, Motion, Target};
use searoom_planner::Minimises;

/// Number of targets up to which every one is planned for. Below it a plan costs milliseconds, and
/// its document has all encounters.
pub const MOST_WITHOUT_SELECTION: usize = 256;

/// Room between the hulls in lengths of the longer ship, besides the distance at which there is
/// risk of collision. No default ship domain, no default threshold of the rules and no clearance of a
/// planner reaches as far; larger thresholds of a file take its place.
const ROOM_LENGTHS: f64 = 50.0;

/// Steps per m/s and per metre to which speeds and radii are rounded up, so that rows are short.
const SPEED_STEPS: f64 = 1e3;
const RADIUS_STEPS: f64 = 10.0;

/// The targets of a scenario that no plan considers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OutOfReach {
    /// Seconds: none of them comes near until then. Not before the horizon.
    pub until: f64,
    /// Lower bound of the distance between own hull and theirs until then, metres.
    pub apart: f64,
    /// In the order of the file.
    pub targets: Vec<DistantTarget>,
}

/// A target by a disc that holds its hull at t = 0 and grows with its greatest speed.
#[derive(Debug, Clone, PartialEq)]
pub struct DistantTarget {
    /// Number of the target in the scenario's file, from 0.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// Centre of the disc, metres.
    pub position: Vector,
    /// Upper bound of its speed, m/s.
    pub greatest_speed: f64,
    /// Radius of the disc at t = 0, metres: hull and position uncertainty.
    pub radius: f64,
}

impl DistantTarget {
    fn of(index: usize, target: &Target) -> Self {
        let (position, greatest_speed, radius) = match &target.motion {
            Motion::Ship(ship) => (
                ship.pose.position,
                ship.greatest_speed() + ship.speed_half_width(),
                ship.hull.half_diagonal() + SIGMAS * ship.position_std,
            ),
            Motion::Sets(sets) => {
                let center = sets.initial.center();
                let around = sets.outer_section(0.0).translated(-center);
                (center, sets.top_speed(), around.reach())
            }
        };
        let up = |value: f64, steps: f64| (value * steps).ceil() / steps;
        Self {
            index,
            name: target.name.clone(),
            position,
            greatest_speed: up(greatest_speed, SPEED_STEPS),
            radius: up(radius, RADIUS_STEPS),
        }
    }
}

/// Disc that own ship does not leave.
struct OwnReach {
    start: Vector,
    /// Radius of the disc for the centre, plus own hull and safety margin, metres.
    radius: f64,
    until: f64,
}

impl OwnReach {
    fn of(scenario: &Scenario) -> Self {
        let (own, desired) = (&scenario.own_ship, &scenario.desired);
        let thresholds = [&scenario.limits, scenario.judged_by()];
        let risk_times = thresholds.map(|limits| limits.risk_time(own.hull.length));
        // a role may rest on a closest approach that would come after the horizon
        let later = risk_times.into_iter().fold(scenario.arrival_hold, f64::max);
        let until = scenario.horizon.max(desired.duration()) + later;
        let speeds = desired.legs().iter().map(|leg| leg.speed);
        let fastest = speeds.fold(own.speed.max(own.max_speed()), f64::max);
        let start = own.pose.position;
        let waypoints = desired.waypoints();
        let waypoints = (scenario.alternatives.iter().flatten()).chain(&waypoints);
        let farthest = waypoints.map(|place| (place - start).norm());
        Self {
            start,
            radius: farthest.fold(fastest * until, f64::max)
                + own.hull.half_diagonal()
                + own.safety_margin,
            until,
        }
    }

    /// Lower bound of the distance between the hulls, less own safety margin.
    fn apart(&self, target: &DistantTarget) -> f64 {
        let reached = target.radius + target.greatest_speed * self.until;
        (target.position - self.start).norm() - self.radius - reached
    }
}

impl Scenario {
    /// Moves the targets that cannot come near own ship before the horizon from [`Self::targets`]
    /// to [`Self::out_of_reach`], where there are more than [`MOST_WITHOUT_SELECTION`] targets.
    ///
    /// A target is out of reach if a disc around it that grows with its greatest speed stays clear
    /// of the disc that own ship can reach at its own greatest speed. The room between the two
    /// exceeds the risk distance, ship domains and clearances. Such a target has no role and no
    /// risk, so a plan is the same without it. A target with a role from before stays. Motions
    /// under forces have no greatest speed, so there every target stays. O(targets).
    pub fn set_aside_out_of_reach(&mut self) {
        let under_forces = matches!(self.planner.facts().minimises, Minimises::Own(_))
            && !self.planner.facts().follows_paths;
        let is_done = !self.out_of_reach.targets.is_empty();
        if self.targets.len() <= MOST_WITHOUT_SELECTION || under_forces || is_done {
            return;
        }
        let reach = OwnReach::of(self);
        let mut apart = f64::INFINITY;
        let mut distant = Vec::new();
        let mut stays = Vec::with_capacity(self.targets.len());
        for (index, target) in self.targets.iter().enumerate() {
            let known = self.memory.target(index);
            let found = DistantTarget::of(index, target);
            let clear = reach.apart(&found);
            let has_role = known.is_some_and(|known| known.role.is_some());
            let is_far = clear > self.room(target) && clear.is_finite() && !has_role;
            stays.push(!is_far);
            if is_far {
                apart = apart.min(clear);
                distant.push(found);
            }
        }
        if distant.is_empty() {
            return;
        }
        retain(&mut self.targets, &stays);
        retain(&mut self.memory.targets, &stays);
        retain(&mut self.simulation.behaviours, &stays);
        retain(&mut self.simulation.not_reported, &stays);
        retain(&mut self.simulation.seen_from, &stays);
        self.out_of_reach = Arc::new(OutOfReach {
            until: reach.until,
            apart,
            targets: distant,
        });
    }

    /// Metres between the hulls beyond which a target has no effect on a plan.
    fn room(&self, target: &Target) -> f64 {
        let (own, Some(ship)) = (&self.own_ship, target.ship()) else {
            return ROOM_LENGTHS * self.own_ship.hull.length;
        };
        let thresholds = [&self.limits, self.judged_by()];
        let distances = thresholds.map(|limits| {
            limits
                .risk
                .distance(&own.hull, own.safety_margin, &ship.hull)
        });
        let risk = distances.into_iter().fold(ship.risk_distance, f64::max);
        let domain = match ship.domain {
            DomainKind::Custom {
                fore,
                aft,
                port,
                starboard,
            } => fore.max(aft) + port.max(starboard),
            DomainKind::Colregs | DomainKind::Paper | DomainKind::Hull => 0.0,
        };
        let lengths = thresholds.map(farthest_lengths);
        let lengths = lengths.into_iter().fold(ROOM_LENGTHS, f64::max);
        let ahead = thresholds.map(|limits| limits.score.ahead_time * ship.greatest_speed());
        let ahead = ahead.into_iter().fold(0.0, f64::max);
        risk + domain + ahead + lengths * own.hull.length.max(ship.hull.length)
    }
}

/// The largest threshold in ship lengths.
fn farthest_lengths(limits: &Thresholds) -> f64 {
    let (risk, score) = (&limits.risk, &limits.score);
    [
        risk.lengths,
        risk.release_lengths,
        score.near_miss_lengths,
        score.preferred_lengths,
        score.ahead_lengths,
        score.stage_3_lengths,
        score.stage_4_lengths,
        score.overtaken_lengths,
    ]
    .into_iter()
    .fold(0.0, f64::max)
}

/// Keeps the marked entries of a list with one entry for each target, or none at all.
fn retain<T>(list: &mut Vec<T>, stays: &[bool]) {
    let mut stays = stays.iter();
    list.retain(|_| *stays.next().unwrap_or(&true));
}
