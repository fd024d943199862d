//! Document of a comparison.

use std::collections::BTreeSet;

use super::{ComparedMotion, Entry, Inapplicable};
use crate::colregs::compliance::EncounterSamples;
use crate::document::{
    CandidateOutcome, CollisionDocument, Compared, EntryDocument, HeldVelocityDocument,
    InapplicableDocument, PositionDocument, TrackPointDocument, cost_of, departure,
    departure_until, finite, minimised, objective, samples, search_stats, timing,
};
use crate::evaluation::{Safety, least_land_distance, outcome_word, without_rules};
use crate::frame::course_deg_from_heading;
use crate::obstacle::LAND;
use crate::pipeline::Run;
use crate::scenario::Scenario;
use crate::trajectory::Segment;

/// Time step of a track in seconds, and the maximum number of steps. Longer motions use longer
/// steps.
const TRACK_STEP: f64 = 5.0;
const MOST_STEPS: f64 = 1000.0;

/// Why a baseline has no motion.
const NO_VELOCITY: &str = "no constant velocity is out of every velocity obstacle";

impl Compared<Entry, Inapplicable> for Scenario {
    fn title(&self) -> String {
        self.title.clone()
    }

    fn inapplicable(&self, method: &Inapplicable) -> InapplicableDocument {
        InapplicableDocument {
            method: method.method.to_string(),
            reason: method.reason.clone(),
        }
    }

    fn entry(&self, entry: &Entry) -> EntryDocument {
        let scenario = self;
        let (run, motion) = (entry.run.as_deref(), entry.motion.as_ref());
        let plan = run.and_then(|run| run.planned.outcome.plan());
        let verified = motion.is_some_and(|motion| motion.evaluation.verified());
        let max_risk = entry.candidate.max_risk;
        let largest_risk = entry.largest_risk();
        let outcome = match (run, motion) {
            (Some(run), _) => run.outcome().into(),
            (None, None) => CandidateOutcome::Infeasible,
            _ if !verified => CandidateOutcome::Collides,
            // clear of the level sets alone
            _ if max_risk > 0.0 && largest_risk > 0.0 => CandidateOutcome::Relaxed,
            _ => CandidateOutcome::Clear,
        };
        let is_along_path = run.is_some_and(|run| run.planned.path_time.is_some());
        let radius = scenario.own_ship.turning_radius;
        let is_forced = run.is_some_and(|run| run.planned.control.is_some());
        let departure = motion.and_then(|motion| {
            let samples = samples(&motion.trajectory);
            let counted = match is_forced {
                true => departure_until(&samples, motion.evaluation.counted.until),
                false => &samples,
            };
            departure(counted, &scenario.desired, radius, is_along_path)
        });
        let conduct = entry.conduct(scenario);
        let broken: BTreeSet<&str> = conduct.iter().flat_map(|c| c.broken()).collect();
        let broken = broken.into_iter().map(str::to_owned).collect();
        EntryDocument {
            method: entry.name(),
            max_risk,
            objective: run.map(|run| objective(&run.scenario)),
            outcome,
            verdict: without_rules(
                outcome_word(outcome, entry.safety(), largest_risk),
                run.is_some_and(Run::gives_up_rules),
            ),
            reason: match (run, motion) {
                (Some(run), _) => run.reason(),
                (None, Some(_)) => None,
                (None, None) => Some(NO_VELOCITY.to_owned()),
            },
            verified,
            safe: entry.safety() == Some(Safety::Safe),
            cost: motion.map(|motion| {
                // a baseline has no other objective
                let found = &motion.evaluation;
                let run = entry.run.as_ref();
                let objective = run.zip(plan).map_or(found.space_time_error, |(run, plan)| {
                    minimised(&run.scenario, plan, found)
                });
                let mut cost = cost_of(found, objective, motion.arrived, &motion.risks);
                cost.delay_s = cost.delay_s.filter(|_| cost.arrived);
                cost
            }),
            lower_bound: entry.lower_bound,
            departure,
            velocity: velocity(entry),
            breaks: (!conduct.is_empty()).then_some(broken),
            collision: collision(scenario, entry),
            search_stats: run.map(|run| search_stats(run.planned.stats)),
            timing: run.map(timing),
            track: track(entry),
        }
    }
}

/// The velocity of a baseline, which is one segment.
fn velocity(entry: &Entry) -> Option<HeldVelocityDocument> {
    let held = entry.trajectory().filter(|_| entry.run.is_none())?;
    let held = held.segments().first()?;
    Some(HeldVelocityDocument {
        course_deg: course_deg_from_heading(held.start.heading),
        speed_mps: held.speed,
    })
}

/// The first contact of own ship's hull: with a ship that keeps to its expected motion, or with land.
fn collision(scenario: &Scenario, entry: &Entry) -> Option<CollisionDocument> {
    let motion = entry.motion.as_ref()?;
    if motion.safety != Safety::Collides {
        return None;
    }
    let passages = scenario.targets.iter().zip(&motion.evaluation.passages);
    let met = passages.filter_map(|(target, passage)| {
        let ship = target.ship().filter(|_| passage.dcpa < 0.0)?;
        let way = EncounterSamples::along(&motion.trajectory, &scenario.own_ship, ship);
        let first = way.samples().iter().find(|sample| sample.apart < 0.0);
        // fast ships may meet between two samples
        let t_s = finite(first.map_or(passage.tcpa, |sample| sample.time))?;
        let with = target.name.clone();
        Some(CollisionDocument { with, t_s })
    });
    let aground = first_aground(scenario, motion).map(|t_s| CollisionDocument {
        with: LAND.to_owned(),
        t_s,
    });
    met.chain(aground).min_by(|a, b| a.t_s.total_cmp(&b.t_s))
}

/// Seconds at which own ship's hull first touches land, to a second; `None` where it keeps off.
fn first_aground(scenario: &Scenario, motion: &ComparedMotion) -> Option<f64> {
    let segments = motion.trajectory.segments();
    let land = scenario.land.as_ref()?.map.polygons();
    let touches = |until: f64| {
        let sailed = segments.iter().filter(|s| s.start_time <= until);
        let sailed = sailed.map(|s| s.between(s.start_time, s.end_time().min(until)));
        let sailed: Vec<Segment> = sailed.collect();
        least_land_distance(land, &sailed, &scenario.own_ship.hull).0 < 0.0
    };
    let found = &motion.evaluation;
    let mut aground =
        finite(found.min_land_distance_time).filter(|_| found.min_land_distance < 0.0)?;
    let mut afloat = motion.trajectory.start_time();
    while aground - afloat > 1.0 {
        let middle = 0.5 * (afloat + aground);
        match touches(middle) {
            true => aground = middle,
            false => afloat = middle,
        }
    }
    Some(aground)
}

fn track(entry: &Entry) -> Vec<TrackPointDocument> {
    let Some(trajectory) = entry.trajectory() else {
        return Vec::new();
    };
    let end = trajectory.end_time();
    let step = TRACK_STEP.max(end / MOST_STEPS);
    let steps = (end / step).ceil().clamp(1.0, MOST_STEPS) as usize;
    (0..=steps)
        .map(|k| if k == steps { end } else { k as f64 * step })
        .filter_map(|time| Some((finite(time)?, entry.position_at(time)?)))
        .map(|(t_s, at)| TrackPointDocument {
            t_s,
            position: PositionDocument::of(at),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_track_has_no_more_than_its_thousandth_parts() {
        for (way, expected) in [(1000.0, 5.0), (200_000.0, 40.0)] {
            let text = format!(
                r#"title = "long"
                horizon_s = 100000.0
                own_ship = {{ position = {{ east_m = 0, north_m = 0 }}, course_deg = 90, speed_mps = 5, length_m = 30, beam_m = 8,
                    turning_radius_m = 100 }}
                mission = {{ waypoints = [{{ east_m = 0, north_m = 0 }}, {{ east_m = {way}, north_m = 0 }}] }}"#
            );
            let scenario = Scenario::parse(&text).expect("valid");
            let entries = super::super::compare(&scenario, &[0.0]);
            let tracks: Vec<_> = entries
                .iter()
                .map(track)
                .filter(|t| !t.is_empty())
                .collect();
            assert!(!tracks.is_empty());
            let direct = tracks.iter().find(|t| t[t.len() - 1].t_s < way / 5.0 + 1.0);
            let direct = direct.expect("one that arrives");
            assert!((direct[1].t_s - expected).abs() < 1e-6, "{:?}", direct[1]);
            for t in tracks {
                assert!(t.len() <= MOST_STEPS as usize + 1 && t.is_sorted_by_key(|p| p.t_s));
            }
        }
    }
}
