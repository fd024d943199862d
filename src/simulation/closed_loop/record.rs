//! The document of a simulation, with the judges' verdicts on what was sailed.

use super::{Simulated, Simulation};
use crate::colregs::compliance::{ComplianceReport, EncounterSamples};
use crate::document::{
    ConductDocument, CycleTimingDocument, SIMULATION_FORMAT, SailedDocument, SailedLandDocument,
    SampleDocument, SimulatedTargetDocument, SimulationDocument, SimulationSettingsDocument,
    finite, manoeuvres, sample, segment_document, state_document,
};
use crate::evaluation::{counted_error_of_segments, least_land_distance};
use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, Window};
use crate::planner::cost::{sailed_space_time_error, whole_space_time_error};
use crate::scenario::VesselModel;
use crate::trajectory::Segment;

impl Simulation {
    /// The result so far.
    ///
    /// Both judges use the true motions. The cost is that of the plans, over the sailed motion.
    /// O(targets × seconds sailed), and with a map O(its edges × segments).
    pub fn record(&self) -> SimulationDocument {
        let own = &self.scenario.own_ship;
        // explicit sets have no rules
        let ships = self.targets.iter().filter(|target| target.set.is_none());
        let samples: Vec<EncounterSamples> = ships
            .map(|target| {
                EncounterSamples::of_tracks(&self.sailed, own, &target.states, target.truth.hull)
            })
            .collect();
        let reports = if self.sailed.is_empty() {
            Vec::new()
        } else {
            ComplianceReport::of_all(samples.iter(), self.scenario.judged_by())
        };
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
        let late = self.replans.iter().any(|r| !r.followed);
        let within_tracking_margin = self.conduct.largest_off_plan_m <= self.tracking_margin();
        let (desired, weight) = (&self.scenario.desired, self.scenario.time_weight);
        let ended = self.time >= self.active.end() - super::INSTANT;
        let mut arrived =
            ended && self.active.document.is_some() && self.off_plan() <= self.tracking_margin();
        // a ship that is still under way does not wait where the simulation ends
        let mut cost_m2 = match arrived {
            true => whole_space_time_error(desired, &self.sailed, weight),
            false => sailed_space_time_error(desired, &self.sailed, weight),
        };
        if super::is_under_forces(&self.scenario) {
            // as in its plans, where arrival is not required
            let within = own.hull.length;
            arrived = (self.own().pose.position - desired.end()).norm() <= within;
            cost_m2 = counted_error_of_segments(&self.sailed, desired, weight, within).0;
        }
        SimulationDocument {
            format: SIMULATION_FORMAT.to_owned(),
            build: env!("CARGO_PKG_VERSION").to_owned(),
            scenario: self.scenario.title.clone(),
            settings: self.settings_document(),
            safe: !contact && self.conduct.unsafe_plans == 0 && !late && within_tracking_margin,
            contact,
            arrived,
            interrupted: !self.finished(),
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
                    &self.sailed_samples(),
                    desired,
                    own.turning_radius,
                    self.scenario.planner.facts().follows_paths,
                ),
                within_tracking_margin,
                ..self.conduct.clone()
            },
            alarms: self.alarms.clone(),
            replans: self.replans.clone(),
            sailed: self.sailed.iter().map(segment_document).collect(),
            timing: CycleTimingDocument {
                plan_s: self.plan_seconds.clone(),
            },
        }
    }

    /// The sailed motion at the start of each segment, and at every second of it.
    fn sailed_samples(&self) -> Vec<SampleDocument> {
        let times = self.sailed.iter().flat_map(|segment| {
            let steps = segment.duration.ceil().max(1.0) as u32;
            (0..steps).map(move |k| (segment, segment.start_time + f64::from(k)))
        });
        times
            .map(|(segment, time)| sample(segment.pose_at(time), time, segment.speed))
            .collect()
    }

    /// Own hull's least distance from the land of the map over the sailed motion.
    fn sailed_land(&self) -> Option<SailedLandDocument> {
        let map = &self.scenario.land.as_ref()?.map;
        let own = &self.scenario.own_ship.hull;
        let (least, time) = least_land_distance(map.polygons(), &self.sailed, own);
        let places = self
            .sailed
            .iter()
            .flat_map(|s| [s.start.position, s.end().position]);
        let places: Vec<Vector> = places.collect();
        // an arc is within its own length of its ends
        let length = self.sailed.iter().map(Segment::length).fold(0.0, f64::max);
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
                true => self.scenario.settings.optimal_control.vessel.word(),
                false => settings.vessel.unwrap_or(VesselModel::Kinematic).word(),
            }
            .to_owned(),
            current_mps: [settings.current.mean.x, settings.current.mean.y],
            current_std_mps: settings.current.std,
            current_known: settings.current.known,
            sensor: settings.sensor.kind.word().to_owned(),
            own_length_m: own.hull.length,
            own_beam_m: own.hull.beam,
            map: self.scenario.land.is_some(),
        }
    }
}

fn simulated_targets(
    simulation: &Simulation,
    reports: &[ComplianceReport],
) -> Vec<SimulatedTargetDocument> {
    let mut reports = reports.iter();
    let targets = simulation.targets.iter().enumerate();
    let targets = targets.map(|(index, target)| {
        let report = match target.set {
            None => reports.next(),
            Some(_) => None,
        };
        simulated(simulation, index, target, report)
    });
    targets.collect()
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
        behaviour: behaviour.map_or("constant", |b| b.word()).to_owned(),
        length_m: target.truth.hull.length,
        beam_m: target.truth.hull.beam,
        least_clearance_m: finite(clearance.metres),
        least_clearance_t_s: clearance.time,
        contact_t_s: clearance.contact,
        outside_sets: target.outside_sets,
        track: (target.states.iter())
            .map(|(time, ship)| state_document(*time, ship))
            .collect(),
        set_m: target.set.as_ref().map(|sets| {
            let outline = super::outline(sets);
            outline.vertices().iter().map(|p| [p.x, p.y]).collect()
        }),
        conduct: report.map(ConductDocument::of).unwrap_or_default(),
    }
}
