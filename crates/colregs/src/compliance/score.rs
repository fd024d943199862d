//! Scores in `[0, 1]` and rule violations, as evaluators of collision avoidance compute them
//! (docs/reference/colregs.md 2).

use std::f64::consts::FRAC_PI_2;

#[cfg(doc)]
use super::ComplianceReport;
use super::role_intervals::{RoleInterval, meets_ship_at_rest};
use super::samples::{
    EncounterSample, EncounterSamples, alterations, speed_changed, speed_changes,
};
use super::{Manoeuvre, RuleViolation};
use crate::{APPARENT_SPEED, MayAct, Paragraph, Role, Situation, Thresholds};
use searoom_geometry::frame::{Side, deg_from_radians, wrap};

/// Scores of own ship toward one target; 1 is best. `None` if the rule does not apply.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Scores {
    /// Distance and pose at the closest approach; 0 after a collision, as every other score then.
    pub safety: f64,
    /// Rule 8: readily apparent, no succession of small alterations, and a safe distance.
    pub rule_8: Option<f64>,
    /// Rule 13: overtaking.
    pub rule_13: Option<f64>,
    /// Rule 14: head-on.
    pub rule_14: Option<f64>,
    /// Rule 15: crossing, the target on own starboard side.
    pub rule_15: Option<f64>,
    /// Rule 16: early and substantial action to keep well clear.
    pub rule_16: Option<f64>,
    /// Rule 17: the stand-on and the overtaken ship.
    pub rule_17: Option<f64>,
}

impl Scores {
    /// The least score.
    pub fn least(&self) -> f64 {
        self.by_name()
            .into_iter()
            .map(|(_, s)| s)
            .fold(1.0, f64::min)
    }

    /// Scores that apply, by their names in documents.
    pub fn by_name(&self) -> Vec<(&'static str, f64)> {
        let rules = [
            ("safety", Some(self.safety)),
            ("rule_8", self.rule_8),
            ("rule_13", self.rule_13),
            ("rule_14", self.rule_14),
            ("rule_15", self.rule_15),
            ("rule_16", self.rule_16),
            ("rule_17", self.rule_17),
        ];
        rules
            .into_iter()
            .filter_map(|(n, s)| s.map(|s| (n, s)))
            .collect()
    }
}

fn unit(x: f64) -> f64 {
    // negated on purpose: a NaN scores nothing
    if !(x > 0.0) { 0.0 } else { x.min(1.0) }
}

/// Own ship from the beginning of its role to the closest approach.
struct Act<'a> {
    t: &'a Thresholds,
    role: Role,
    /// Length of the longer ship, metres.
    length: f64,
    own_length: f64,
    ordered_speed: f64,
    /// Seconds from which on own ship need not hold its course because of another target.
    excused_from: f64,
    /// Seconds from which on the target is past and clear.
    until: f64,
    /// At least one.
    samples: &'a [EncounterSample],
    /// From the closest approach on.
    after: &'a [EncounterSample],
    target_length: f64,
}

impl<'a> Act<'a> {
    /// From the beginning of an interval to the closest approach of the hulls. O(samples).
    fn within(
        encounter: &'a EncounterSamples,
        interval: RoleInterval,
        excused_from: f64,
        t: &'a Thresholds,
    ) -> Self {
        let all = encounter.samples();
        let begin = all.partition_point(|s| s.time < interval.from);
        let begin = begin.min(all.len() - 1);
        // negated on purpose: a NaN is the nearest
        let nearest = (begin..all.len()).fold(begin, |best, k| {
            if !(all[k].apart >= all[best].apart) {
                k
            } else {
                best
            }
        });
        Self {
            t,
            role: interval.role,
            length: encounter.length(),
            own_length: encounter.own_length(),
            ordered_speed: encounter.ordered_speed(),
            excused_from,
            until: interval.until,
            samples: &all[begin..=nearest],
            after: &all[nearest..],
            target_length: encounter.target_length(),
        }
    }

    fn first(&self) -> &EncounterSample {
        &self.samples[0]
    }

    fn closest(&self) -> &EncounterSample {
        &self.samples[self.samples.len() - 1]
    }

    /// The greatest departure from the first course, radians, to starboard and to port.
    fn departure(&self) -> [f64; 2] {
        let from = self.first().own.pose.heading;
        let turned = |s: &EncounterSample| wrap(s.own.pose.heading - from);
        let greatest = |sign: f64| {
            self.samples
                .iter()
                .map(|s| sign * turned(s))
                .fold(0.0, f64::max)
        };
        [greatest(-1.0), greatest(1.0)]
    }

    fn greatest_departure(&self) -> f64 {
        let [starboard, port] = self.departure();
        starboard.max(port)
    }

    /// The least and the greatest speed in multiples of the ordered one.
    fn speeds(&self) -> [f64; 2] {
        let ratios = (self.samples.iter()).map(|s| s.own.speed / self.ordered_speed);
        ratios.fold([1.0, 1.0], |[low, high], r| [r.min(low), r.max(high)])
    }

    /// Time of the first alteration of course or speed, seconds.
    fn onset(&self) -> Option<f64> {
        let s = &self.t.score;
        let turned = alterations(self.samples, s.turn_rate, s.steady);
        let slowed = speed_changed(self.samples, self.ordered_speed, s.steady_speed);
        let times = turned.first().map(|a| a.from).into_iter().chain(slowed);
        times.min_by(f64::total_cmp)
    }

    /// Score of a distance of the hulls.
    fn range_score(&self, apart: f64) -> f64 {
        let s = &self.t.score;
        let r = apart / self.length;
        let part = |from: f64, to: f64| unit((from - r) / (from - to));
        unit(
            1.0 - s.weight_least * part(s.preferred_lengths, s.least_lengths)
                - s.weight_near_miss * part(s.least_lengths, s.near_miss_lengths)
                - s.weight_collision * part(s.near_miss_lengths, s.collision_lengths),
        )
    }

    fn safety(&self) -> f64 {
        let closest = self.closest();
        // negated on purpose: a NaN is a collision
        if !(closest.apart > self.t.score.collision_lengths * self.length) {
            return 0.0;
        }
        let cut = |angle: f64| 1.0 - angle.abs().min(FRAC_PI_2).cos();
        let pose = cut(closest.aspect()) * cut(closest.bearing());
        0.5 * self.range_score(closest.apart) + 0.5 * pose
    }

    /// Seconds from a sample to the closest approach if own ship kept its course there, and the
    /// ordered speed.
    fn undisturbed_tcpa(&self, sample: &EncounterSample) -> f64 {
        sample.at_speed(self.ordered_speed).ahead().time
    }

    /// The sample from which on waiting is delay: the first that is not in ample time.
    fn no_longer_ample(&self) -> &EncounterSample {
        let ample = self.t.ample_time(self.own_length);
        let due = |s: &&EncounterSample| !(self.undisturbed_tcpa(s) >= ample);
        self.samples.iter().find(due).unwrap_or(self.closest())
    }

    /// Delay of action: 0 in ample time. Without an alteration 1 if it would pass within a length,
    /// else 0.
    fn delay(&self) -> f64 {
        let Some(onset) = self.onset() else {
            let near = self.first().ahead().distance < self.t.score.least_lengths * self.length;
            return f64::from(u8::from(near));
        };
        let then = self.samples.iter().find(|s| s.time >= onset);
        let due = self.no_longer_ample();
        if onset <= due.time {
            return 0.0;
        }
        let (first, last) = (due.range(), self.closest().range());
        then.map_or(1.0, |s| {
            if first > last {
                unit((first - s.range()) / (first - last))
            } else {
                0.0
            }
        })
    }

    /// 0 for a readily apparent course change, 0.5 for none.
    fn unapparent_turn(&self) -> f64 {
        let fraction = self.greatest_departure() / self.t.score.apparent;
        0.5 * (1.0 - fraction * fraction).max(0.0)
    }

    /// 0 for a readily apparent alteration of course or speed, 1 for none.
    fn unapparent(&self) -> f64 {
        // below this penalty, one of the two is apparent
        const LITTLE: f64 = 0.3;
        // product of the two penalties without action
        const NOTHING: f64 = 0.25;
        let turn = self.unapparent_turn();
        let slower = 0.5 * unit((self.speeds()[0] - APPARENT_SPEED) / (1.0 - APPARENT_SPEED));
        if turn < LITTLE || slower < LITTLE {
            0.0
        } else {
            turn * slower / NOTHING
        }
    }

    /// Time of the first of too many turns that are not readily apparent, seconds.
    fn succession(&self) -> Option<f64> {
        let s = &self.t.score;
        let mut small = alterations(self.samples, s.turn_rate, s.steady);
        small.retain(|a| a.turn.abs() < self.t.monitor.turn);
        (small.len() > s.small_turns).then(|| small[s.small_turns].from)
    }

    fn rule_8(&self) -> f64 {
        if self.succession().is_some() {
            return 0.0;
        }
        unit(self.range_score(self.closest().apart) * (1.0 - self.unapparent()))
    }

    fn rule_16(&self) -> f64 {
        unit(self.safety() * (1.0 - self.delay()) * (1.0 - self.unapparent()))
    }

    /// Time at which own ship crosses the target's course line too close ahead, seconds.
    fn crosses_ahead(&self) -> Option<f64> {
        let s = &self.t.score;
        let all = self.samples.iter().chain(self.after.iter().skip(1));
        let places: Vec<_> = all
            .map(|s| (s.time, s.target.speed, s.seen_from_target()))
            .collect();
        places.windows(2).find_map(|w| {
            let [(_, _, a), (time, speed, b)] = [w[0], w[1]];
            if (a.y < 0.0) == (b.y < 0.0) {
                return None;
            }
            let ahead = a.x + (b.x - a.x) * a.y / (a.y - b.y);
            let allowed = s.room_ahead(self.target_length, speed);
            (ahead > 0.0 && ahead < allowed).then_some(time)
        })
    }

    fn rule_13(&self) -> f64 {
        let ahead = f64::from(u8::from(self.closest().aspect().abs() < FRAC_PI_2 / 2.0));
        unit(self.rule_16() - self.t.score.weight_ahead_overtaking * ahead)
    }

    fn rule_14(&self) -> f64 {
        let s = &self.t.score;
        let closest = self.closest();
        let port_to_port =
            (1.0 - closest.aspect().sin()) / 2.0 * ((1.0 - closest.bearing().sin()) / 2.0);
        let little = 1.0 - (self.departure()[0] / s.starboard).min(1.0).powi(4);
        let lost = s.weight_starboard * little
            + s.weight_delay * self.delay()
            + s.weight_side * (1.0 - port_to_port);
        if self.safety() > 0.0 {
            unit(1.0 - lost) * (1.0 - self.unapparent_turn())
        } else {
            0.0
        }
    }

    fn rule_15(&self) -> f64 {
        let ahead = f64::from(u8::from(self.crosses_ahead().is_some()));
        unit(self.rule_16() - self.t.score.weight_ahead_crossing * ahead)
    }

    /// How much an alteration of a stand-on ship counts: 1 up to stage 3, 0 from stage 4 on.
    fn early(&self) -> f64 {
        let s = &self.t.score;
        let onset = self.onset().unwrap_or(self.first().time);
        let then = self.samples.iter().find(|sample| sample.time >= onset);
        let lengths = then.unwrap_or(self.first()).range() / self.length;
        // a NaN counts in full
        ((lengths - s.stage_4_lengths) / (s.stage_3_lengths - s.stage_4_lengths)).clamp(0.0, 1.0)
    }

    fn rule_17(&self) -> f64 {
        let s = &self.t.score;
        let early = self.early();
        let turn = self.greatest_departure();
        let course = if turn < s.steady {
            0.0
        } else {
            0.5 * unit((turn - s.steady) / (s.apparent - s.steady))
        };
        let [low, high] = self.speeds();
        let faster = if high - 1.0 > s.steady_speed {
            (1.0 / high).powi(2)
        } else {
            1.0
        };
        let slower = if 1.0 - low > s.steady_speed {
            0.5 * (1.0 - low)
        } else {
            0.0
        };
        if self.safety() > 0.0 {
            unit((self.safety() - early * course) * faster - early * slower)
        } else {
            0.0
        }
    }

    fn scores(&self) -> Scores {
        let duties = self.role.duties();
        let clears = |rule: u8| duties.keeps_clear && duties.rule == Some(rule);
        Scores {
            safety: self.safety(),
            rule_8: duties.keeps_clear.then(|| self.rule_8()),
            rule_13: clears(13).then(|| self.rule_13()),
            rule_14: clears(14).then(|| self.rule_14()),
            rule_15: clears(15).then(|| self.rule_15()),
            rule_16: (clears(13) || clears(15)).then(|| self.rule_16()),
            rule_17: duties.stands_on.then(|| self.rule_17()),
        }
    }

    fn manoeuvre(&self) -> Manoeuvre {
        // a smaller change of speed is rounding, or the last bit of a schedule
        const SPEED_SHARE: f64 = 0.02;
        let s = &self.t.score;
        let turns = alterations(self.samples, s.turn_rate, s.steady);
        let onset = self.onset();
        let then = (self.samples.iter()).find(|sample| Some(sample.time) >= onset);
        Manoeuvre {
            lead: onset.and(then).map(|sample| self.undisturbed_tcpa(sample)),
            turns: turns.len(),
            smallest_turn: turns.iter().map(|a| a.turn.abs()).min_by(f64::total_cmp),
            speed_changes: speed_changes(
                self.samples,
                self.ordered_speed,
                SPEED_SHARE * self.ordered_speed,
            )
            .len(),
        }
    }

    /// The first sample more than `least` radians off the first course, to either side.
    fn turned(&self, least: f64) -> Option<&EncounterSample> {
        let turned = |side| self.turned_to(least, side);
        let sides = Side::BOTH.into_iter().filter_map(turned);
        sides.min_by(|a, b| a.time.total_cmp(&b.time))
    }

    /// The first sample more than `least` radians off the first course, to a side.
    fn turned_to(&self, least: f64, side: Side) -> Option<&EncounterSample> {
        let from = self.first().own.pose.heading;
        let turn = |s: &EncounterSample| side.turn_sign() * wrap(s.own.pose.heading - from);
        self.samples.iter().find(|s| turn(s) > least)
    }

    /// First time at which a ship that stands on may act: from stage 3 on, Rule 17(a)(ii), in
    /// extremis, and where another target excuses it.
    fn may_act_from(&self) -> f64 {
        let s = &self.t.score;
        let first = self.first();
        let stage_3 = |sample: &EncounterSample| match self.role.duties().may_act {
            MayAct::BeforeClosestApproach => {
                self.undisturbed_tcpa(first) - (sample.time - first.time)
                    <= s.overtaken_lengths * self.length / self.ordered_speed
            }
            MayAct::WithinRange => sample.range() <= s.stage_3_lengths * self.length,
        };
        let extremis = self.t.monitor.manoeuvre * self.t.time_factor(self.own_length);
        let mut may =
            (self.samples.iter()).filter(|sample| stage_3(sample) || sample.meets_in <= extremis);
        let may = may.next().map_or(f64::INFINITY, |sample| sample.time);
        may.min(self.excused_from)
    }

    /// Rule violations in order of time.
    fn violations(&self) -> Vec<RuleViolation> {
        let (s, closest, duties) = (&self.t.score, self.closest(), self.role.duties());
        let mut found = Vec::new();
        let mut violation = |rule: Paragraph, time: f64, what: String| {
            found.push(RuleViolation { rule, time, what });
        };
        if duties.stands_on {
            let freed = self.may_act_from();
            let must_hold = |sample: &&EncounterSample| sample.time < freed;
            if let Some(sample) = self.turned(s.hold).filter(must_hold) {
                let hold = deg_from_radians(s.hold);
                let what = format!("does not hold its course within {hold:.0} deg");
                violation(Paragraph::Rule17AI, sample.time, what);
            }
            let changed = speed_changed(self.samples, self.ordered_speed, s.steady_speed);
            if let Some(time) = changed.filter(|time| *time < freed) {
                let share = 100.0 * s.steady_speed;
                let what = format!("does not hold its speed within {share:.0} %");
                violation(Paragraph::Rule17AI, time, what);
            }
        }
        if let Some(rule) = duties.paragraph {
            let crossed = (duties.crossing_ahead_counts)
                .then(|| self.crosses_ahead())
                .flatten();
            if let Some(time) = crossed {
                let what = match duties.situation {
                    Some(Situation::Overtaking) => "crosses ahead of the ship it overtakes",
                    _ => "crosses ahead of the other",
                };
                violation(rule, time, what.to_owned());
            }
            // a crossing ship's turn to port is forbidden only where it leads ahead of the other
            let port = (crossed.is_some() && duties.situation == Some(Situation::Crossing))
                .then_some(Side::Port);
            let turned = (duties.no_heading_to.or(port))
                .and_then(|side| self.turned_to(s.steady, side))
                .filter(|sample| sample.time < self.until);
            if let Some(sample) = turned {
                let what = match rule {
                    Paragraph::Rule19DII => "turns toward a ship abeam or abaft the beam",
                    _ => "heads to port of its first course before the other has passed",
                };
                violation(rule, sample.time, what.to_owned());
            }
            let passing =
                self.onset().is_some() || !(closest.apart > s.least_lengths * self.length);
            // negated on purpose: what is not known to be to port is not
            let to_port = closest.bearing() < 0.0 && closest.aspect() < 0.0;
            if duties.port_to_port && passing && !to_port {
                let what = "does not pass on the port side of the other".to_owned();
                violation(rule, closest.time, what);
            }
        }
        // negated on purpose: a NaN is a collision
        if duties.stands_on && !(closest.apart > 0.0) {
            let what = "holds on into a collision".to_owned();
            violation(Paragraph::Rule17B, closest.time, what);
        }
        if duties.keeps_clear {
            if let Some(time) = self.succession() {
                let what = "makes a succession of small alterations".to_owned();
                violation(Paragraph::Rule8B, time, what);
            }
            let least = s.least_lengths * self.length;
            if !(closest.apart >= least) {
                let apart = closest.apart;
                let what = format!("passes at {apart:.0} m, less than {least:.0} m");
                violation(Paragraph::Rule8D, closest.time, what);
            }
        }
        found.sort_by(|a, b| a.time.total_cmp(&b.time));
        found
    }
}

/// Own ship's alterations from the first risk of meeting a ship at rest to the closest approach of
/// the hulls; `None` without that risk. O(samples).
pub(super) fn around_ship_at_rest(
    encounter: &EncounterSamples,
    t: &Thresholds,
) -> Option<Manoeuvre> {
    let interval = RoleInterval {
        role: Role::Static,
        from: meets_ship_at_rest(encounter, t)?,
        until: f64::INFINITY,
    };
    Some(Act::within(encounter, interval, f64::INFINITY, t).manoeuvre())
}

/// Scores, rule violations and the manoeuvre toward one target.
pub(super) struct Judged {
    pub scores: Scores,
    pub violations: Vec<RuleViolation>,
    pub manoeuvre: Option<Manoeuvre>,
}

/// Scores, rule violations and the manoeuvre of own ship in a role, from its beginning to the
/// closest approach of the hulls; crossing ahead is also judged after it. Without a role, the
/// safety alone. `excused_from` as in [`ComplianceReport::of_all`]. O(samples).
pub(super) fn scores(
    encounter: &EncounterSamples,
    interval: Option<&RoleInterval>,
    excused_from: f64,
    t: &Thresholds,
) -> Judged {
    let all = encounter.samples();
    let interval_or_all = interval.copied().unwrap_or(RoleInterval {
        role: Role::None,
        from: all[0].time,
        until: f64::INFINITY,
    });
    let act = Act::within(encounter, interval_or_all, excused_from, t);
    Judged {
        scores: act.scores(),
        violations: act.violations(),
        manoeuvre: interval.map(|_| act.manoeuvre()),
    }
}
