//! The document of a simulation, with the judges' verdicts on what was sailed.

use super::vessel::Vessel;
use super::{Simulated, Simulation};
use crate::colregs::compliance::{ComplianceReport, EncounterSamples};
use crate::document::{
    ConductDocument, CycleTimingDocument, SIMULATION_FORMAT, SailedDocument,
    SimulatedTargetDocument, SimulationDocument, SimulationSettingsDocument, finite,
    segment_document, state_document,
};
use crate::planner::cost::{sailed_space_time_error, whole_space_time_error};

impl Simulation {
    /// The result so far.
    ///
    /// Both judges use the true motions. The cost is that of the plans, over the sailed motion.
    /// O(targets × seconds sailed).
    pub fn record(&self) -> SimulationDocument {
        let own = &self.scenario.own_ship;
        let samples: Vec<EncounterSamples> = (self.targets.iter())
            .map(|target| {
                let hulls = (own.hull, own.speed);
                EncounterSamples::of_tracks(&self.sailed, hulls, &target.states, target.truth.hull)
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
        let contact = self.targets.iter().any(|t| t.clearance.is_contact());
        let unsafe_plans = self
            .replans
            .iter()
            .filter(|r| r.cost_m2.is_some() && !r.safe)
            .count();
        let without_plan = self.replans.iter().filter(|r| r.cost_m2.is_none()).count();
        let late = self.replans.iter().any(|r| !r.followed);
        let within_tracking_margin = self.farthest_off.0 <= self.tracking_margin();
        let arrived = self.time >= self.active.end() - super::INSTANT
            && self.active.document.is_some()
            && self.off_plan() <= self.tracking_margin();
        // a ship that is still under way does not wait where the simulation ends
        let error = match arrived {
            true => whole_space_time_error,
            false => sailed_space_time_error,
        };
        SimulationDocument {
            format: SIMULATION_FORMAT.to_owned(),
            build: env!("CARGO_PKG_VERSION").to_owned(),
            scenario: self.scenario.title.clone(),
            settings: self.settings_document(),
            safe: !contact && unsafe_plans == 0 && !late && within_tracking_margin,
            contact,
            arrived,
            interrupted: !self.finished(),
            duration_s: self.time,
            targets: (self.targets.iter().enumerate())
                .filter_map(|(index, target)| {
                    Some(simulated(self, index, target, reports.get(index)?))
                })
                .collect(),
            conduct: SailedDocument {
                cost_m2: error(
                    &self.scenario.desired,
                    &self.sailed,
                    self.scenario.time_weight,
                ),
                first_plan_cost_m2: self.first_cost,
                breaks,
                turns: most(&|m| m.turns),
                speed_changes: most(&|m| m.speed_changes),
                replaced_manoeuvres: self.replaced,
                side_switches: self.side_switches,
                lost_remainders: self.lost_remainders,
                without_plan,
                unsafe_plans,
                largest_off_plan_m: self.farthest_off.0,
                largest_off_plan_t_s: self.farthest_off.1,
                within_tracking_margin,
            },
            alarms: self.alarms.clone(),
            replans: self.replans.clone(),
            sailed: self.sailed.iter().map(segment_document).collect(),
            timing: CycleTimingDocument {
                plan_s: self.plan_seconds.clone(),
            },
        }
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
            vessel: Vessel::new(settings.vessel, own).model.word().to_owned(),
            current_mps: [settings.current.mean.x, settings.current.mean.y],
            current_std_mps: settings.current.std,
            current_known: settings.current.known,
            sensor: settings.sensor.kind.word().to_owned(),
            own_length_m: own.hull.length,
            own_beam_m: own.hull.beam,
        }
    }
}

fn simulated(
    simulation: &Simulation,
    index: usize,
    target: &Simulated,
    report: &ComplianceReport,
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
        conduct: ConductDocument::of(report),
    }
}
