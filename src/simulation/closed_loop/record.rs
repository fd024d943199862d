//! The document of a simulation, with the judges' verdicts on what was sailed.

use super::{Simulated, Simulation};
use crate::colregs::SteadyShip;
use crate::colregs::compliance::{ComplianceReport, EncounterSamples};
use crate::document::{
    ConductDocument, CycleTimingDocument, GroundSegmentDocument, SIMULATION_FORMAT, SailedDocument,
    SailedLandDocument, SampleDocument, SimulatedTargetDocument, SimulationDocument,
    SimulationSettingsDocument, StateDocument, finite, manoeuvres, sample,
};
use crate::evaluation::{counted_error_of_segments, least_land_distance};
use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, Window};
use crate::planner::cost::{sailed_space_time_error, whole_space_time_error};
use crate::scenario::{Behaviour, BehaviourKind, VesselModel};
use crate::trajectory::{Segment, before_stay};

impl Simulation {
    /// The result so far.
    ///
    /// Both judges use the true motions. The cost is that of the plans, over the sailed motion.
    /// O(targets × seconds sailed), and with a map O(its edges × segments).
    pub fn record(&self) -> SimulationDocument {
        let own = &self.scenario.own_ship;
        let track: Vec<Segment> = self.sailed.iter().map(|s| s.track).collect();
        let judged = self.targets.iter().filter(|target| self.is_judged(target));
        let samples: Vec<EncounterSamples> = judged
            .map(|target| {
                let hull = target.truth.hull;
                EncounterSamples::of_tracks(&self.sailed, own, &target.seen_states(), hull)
            })
            .collect();
        let limits = self.scenario.judged_by();
        let reports = ComplianceReport::of_all(samples.iter(), limits);
        let reports = reports.into_iter().zip(&samples);
        let reports = reports.map(|(report, met)| report.with_ship_at_rest(met, limits));
        let reports: Vec<ComplianceReport> = reports.collect();
        let mut breaks: Vec<String> = (reports.iter())
            .flat_map(ComplianceReport::broken)
            .map(str::to_owned)
            .collect();
        breaks.sort_unstable();
        breaks.dedup();
        let most = |of: &dyn Fn(&crate::colregs::compliance::Manoeuvre) -> usize| {
            let manoeuvres = reports
                .iter()
                .filter_map(|report| report.manoeuvre.as_ref());
            manoeuvres.map(of).max().unwrap_or(0)
        };
        let land = self.sailed_land();
        let grounded = land.as_ref().is_some_and(|land| land.grounded);
        let contact = grounded || self.targets.iter().any(|t| t.clearance.is_contact());
        let conduct = &self.conduct;
        let (largest_off_plan_m, largest_off_plan_t_s) = conduct.largest_off_plan;
        let within_tracking_margin = largest_off_plan_m <= self.tracking_margin();
        let all_followed = conduct.without_plan + conduct.late_plans == 0;
        let (desired, weight) = (&self.scenario.desired, self.scenario.time_weight);
        let to_go = (self.own().pose.position - desired.end()).norm();
        let ended = self.time >= self.active.end() - super::INSTANT;
        let mut arrived =
            ended && self.active.left_out == 0.0 && self.off_plan() <= self.tracking_margin();
        // a ship that is still under way does not wait where the simulation ends
        let before_stay = match self.scenario.stay {
            Some(_) => before_stay(desired, &track),
            None => &track,
        };
        let mut cost_m2 = match arrived {
            true => whole_space_time_error(desired, before_stay, weight),
            false => sailed_space_time_error(desired, before_stay, weight),
        };
        if super::is_under_forces(&self.scenario) {
            // as in its plans, where arrival is not required
            let within = own.hull.length;
            arrived = to_go <= within;
            cost_m2 = counted_error_of_segments(&track, desired, weight, within).0;
        }
        // a sum of nothing is -0
        cost_m2 += 0.0;
        SimulationDocument {
            format: SIMULATION_FORMAT.to_owned(),
            build: env!("CARGO_PKG_VERSION").to_owned(),
            scenario: self.scenario.title.clone(),
            settings: self.settings_document(),
            safe: !contact && conduct.unsafe_plans == 0 && all_followed && within_tracking_margin,
            contact,
            arrived,
            interrupted: !self.finished(),
            ends_short: self.finished() && !arrived && self.time < self.duration - super::INSTANT,
            to_go_m: to_go,
            duration_s: self.time,
            targets: match self.sailed.is_empty() {
                true => Vec::new(),
                false => simulated_targets(self, &reports),
            },
            land,
            conduct: SailedDocument {
                cost_m2,
                breaks,
                turns: most(&|m| m.turns),
                speed_changes: most(&|m| m.speed_changes),
                manoeuvres: manoeuvres(
                    &sailed_samples(&track),
                    desired,
                    own.turning_radius,
                    self.scenario.planner.facts().follows_paths,
                ),
                within_tracking_margin,
                first_plan_cost_m2: conduct.first_plan_cost,
                replaced_manoeuvres: conduct.replaced_manoeuvres,
                side_switches: conduct.side_switches,
                lost_remainders: conduct.lost_remainders,
                without_plan: conduct.without_plan,
                unsafe_plans: conduct.unsafe_plans,
                largest_off_plan_m,
                largest_off_plan_t_s,
            },
            alarms: self.alarms.clone(),
            replans: self.replans.clone(),
            sailed: self.sailed.iter().map(GroundSegmentDocument::of).collect(),
            timing: CycleTimingDocument {
                plan_s: self.plan_seconds.clone(),
            },
        }
    }

    /// True for a target toward which there are rules: a ship that own ship has seen before the end.
    fn is_judged(&self, target: &Simulated) -> bool {
        let is_seen = |from: f64| from < self.time;
        target.set.is_none() && target.known_from.is_some_and(is_seen)
    }

    /// Own hull's least distance from the land of the map over the sailed motion.
    fn sailed_land(&self) -> Option<SailedLandDocument> {
        let map = &self.scenario.land.as_ref()?.map;
        let own = &self.scenario.own_ship.hull;
        let (least, time) = least_land_distance(map.polygons(), &self.sailed, own);
        let places = self
            .sailed
            .iter()
            .flat_map(|s| [s.track.start.position, s.track.end().position]);
        let places: Vec<Vector> = places.collect();
        // an arc is within its own length of its ends
        let length = self
            .sailed
            .iter()
            .map(|s| s.track.length())
            .fold(0.0, f64::max);
        let reach = own.half_diagonal() + length + least.max(0.0) + 1.0;
        let window = Window::around(&places).filter(|_| reach.is_finite());
        let near = window.map(|window| map.pieces_within(&window.grown(reach)));
        let corners = |piece: &ConvexPolygon| piece.vertices().iter().map(|p| [p.x, p.y]).collect();
        Some(SailedLandDocument {
            least_m: finite(least),
            least_t_s: time,
            // negated on purpose: a NaN is on land
            grounded: !(least > 0.0),
            polygons_m: near.unwrap_or_default().into_iter().map(corners).collect(),
        })
    }

    fn settings_document(&self) -> SimulationSettingsDocument {
        let (settings, own) = (self.settings(), &self.scenario.own_ship);
        SimulationSettingsDocument {
            step_s: settings.step,
            replan_s: settings.replan,
            replan_on_events: settings.replan_on_events,
            delay_s: settings.delay,
            measured_delay: self.measured_delay,
            duration_s: self.duration,
            seed: settings.seed,
            vessel: match super::is_under_forces(&self.scenario) {
                true => self.scenario.settings.optimal_control.vessel.into(),
                false => settings.vessel.unwrap_or(VesselModel::Kinematic).kind(),
            },
            current_mps: [settings.current.mean.x, settings.current.mean.y],
            current_std_mps: settings.current.std,
            current_known: settings.current.known,
            sensor: settings.sensor.kind.sensor_type(),
            sensor_range_m: finite(settings.sensor.range),
            own_length_m: own.hull.length,
            own_beam_m: own.hull.beam,
            map: self.scenario.land.is_some(),
        }
    }
}

/// The sailed motion at the start of each segment, at every second of it, and at its end.
fn sailed_samples(track: &[Segment]) -> Vec<SampleDocument> {
    let mut samples = Vec::new();
    for (index, segment) in track.iter().enumerate() {
        let mut add = |time: f64| samples.push(sample(segment.pose_at(time), time, segment.speed));
        let steps = segment.duration.ceil().max(1.0) as u32;
        (0..steps).for_each(|k| add(segment.start_time + f64::from(k)));
        if index + 1 == track.len() {
            add(segment.end_time());
        }
    }
    samples
}

fn simulated_targets(
    simulation: &Simulation,
    reports: &[ComplianceReport],
) -> Vec<SimulatedTargetDocument> {
    let mut reports = reports.iter();
    let targets = simulation.targets.iter().enumerate();
    let targets = targets.map(|(index, target)| {
        let is_judged = simulation.is_judged(target);
        let report = is_judged.then(|| reports.next()).flatten();
        simulated(simulation, index, target, report)
    });
    targets.collect()
}

impl Simulated {
    /// The true states from when own ship saw it first.
    fn seen_states(&self) -> Vec<(f64, SteadyShip)> {
        let from = self.known_from.unwrap_or(f64::INFINITY);
        let before = self.states.partition_point(|(time, _)| *time <= from);
        let first = before.checked_sub(1).map(|index| self.states[index]);
        let first = first.map(|(time, ship)| (from, ship.moved(from - time)));
        first
            .into_iter()
            .chain(self.states[before..].iter().copied())
            .collect()
    }
}

fn simulated(
    simulation: &Simulation,
    index: usize,
    target: &Simulated,
    report: Option<&ComplianceReport>,
) -> SimulatedTargetDocument {
    let behaviour = simulation.settings().behaviours.get(index);
    let clearance = target.clearance.settled();
    SimulatedTargetDocument {
        name: target.name.clone(),
        behaviour: behaviour.map_or(BehaviourKind::Constant, Behaviour::kind),
        length_m: target.truth.hull.length,
        beam_m: target.truth.hull.beam,
        least_clearance_m: finite(clearance.metres),
        least_clearance_t_s: clearance.time,
        contact_t_s: clearance.contact,
        outside_sets: target.outside_sets,
        unknown_until_s: target.known_from.unwrap_or(simulation.time),
        track: (target.states.iter())
            .map(|(time, ship)| StateDocument::of(*time, ship))
            .collect(),
        set_m: target.set.as_ref().map(|sets| {
            let outline = super::outline(sets);
            outline.vertices().iter().map(|p| [p.x, p.y]).collect()
        }),
        conduct: report.map(ConductDocument::of).unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Departure;
    use crate::frame::{Side, heading_of};
    use crate::scenario::Scenario;

    /// A current and a rudder: the courses from place to place have the manoeuvres.
    #[test]
    fn sailed_manoeuvres_are_those_of_the_track() {
        let file = "scenarios/closed-loop/overtaking-rudder.toml";
        let scenario = Scenario::read(file.as_ref()).expect("valid");
        let mut simulation = Simulation::new(scenario, false).expect("a closed loop");
        while !simulation.finished() {
            simulation.step();
        }
        let track: Vec<Segment> = simulation.sailed.iter().map(|s| s.track).collect();
        // degrees to port of the path, which leads east
        let course = |from: f64, until: f64| {
            let at = |time: f64| {
                let after = track.partition_point(|s| s.start_time < time);
                track[after.min(track.len() - 1)].start.position
            };
            heading_of(at(until) - at(from)).to_degrees()
        };
        let manoeuvres = simulation.record().conduct.manoeuvres;
        let first = manoeuvres.first().expect("a manoeuvre");
        let Departure::Course {
            side,
            turn_deg,
            from_s,
        } = first.departure
        else {
            panic!("{first:?}");
        };
        let returns_s = first.returns_s.expect("the way back");
        assert_eq!(side, Side::Port);
        let within = (0..).map(f64::from).take_while(|time| *time < returns_s);
        let greatest = within
            .map(|time| course(time, time + 2.0))
            .fold(0.0, f64::max);
        assert!((greatest - turn_deg).abs() < 1.0, "{greatest} {turn_deg}");
        assert!(course(0.0, from_s.max(0.5)).abs() < 5.0, "{from_s}");
        assert!(course(returns_s - 10.0, returns_s).abs() < 5.0);
        assert!(course(returns_s + 5.0, returns_s + 15.0) < -10.0);
        // the current sets a slow ship to port; later it is on its course
        for later in &manoeuvres[1..] {
            let from_s = later.departure.begins_s();
            let mut times = (0..60).map(|k| from_s + f64::from(k));
            let to_port = match later.departure {
                Departure::Course {
                    side: Side::Port, ..
                } => 1.0,
                _ => -1.0,
            };
            let is_seen = times.any(|time| to_port * course(time, time + 2.0) > 5.0);
            assert!(is_seen, "{later:?}");
        }
    }
}
