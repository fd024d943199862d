//! The first judge: scores in `[0, 1]` and hard rules, as evaluators of collision avoidance compute them (docs/colregs.md 2).

use std::f64::consts::FRAC_PI_2;

use super::Breach;
use super::alteration::{alterations, speed_changed};
use super::latch::RoleSpell;
use super::meeting::{Meeting, Sight};
use super::thresholds::Thresholds;
use crate::colregs::Role;
use crate::frame::{deg_from_radians, wrap};

/// How well own ship behaved toward one target; 1 is best. `None` where the rule asks nothing of her.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::colregs::conduct::{Scores, Thresholds};
///
/// let scenario = Scenario::read("scenarios/colregs/stand-on.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let thresholds = Thresholds::standard();
/// let toward_the_ferry = run.conduct(thresholds).remove(0).expect("a plan among ships");
/// let scores: &Scores = &toward_the_ferry.scores;
/// assert!(scores.safety > 0.9 && scores.rule_15.is_none(), "Rule 15 asks nothing of a stand-on ship");
/// assert_eq!(scores.by_name().len(), 2, "safety and Rule 17");
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
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
    /// Rule 15: crossing, the target on her starboard side.
    pub rule_15: Option<f64>,
    /// Rule 16: early and substantial action to keep well clear.
    pub rule_16: Option<f64>,
    /// Rule 17: stand-on, and of the overtaken ship.
    pub rule_17: Option<f64>,
}

impl Scores {
    /// The worst.
    pub fn least(&self) -> f64 {
        self.by_name()
            .into_iter()
            .map(|(_, s)| s)
            .fold(1.0, f64::min)
    }

    /// Those that apply, by the names of documents.
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

/// Own ship from the beginning of her role to the closest approach.
struct Act<'a> {
    t: &'a Thresholds,
    role: Role,
    length: f64,
    /// At least one.
    sights: &'a [Sight],
    /// From the closest approach on.
    after: &'a [Sight],
    target_length: f64,
}

impl Act<'_> {
    fn first(&self) -> &Sight {
        &self.sights[0]
    }

    fn closest(&self) -> &Sight {
        &self.sights[self.sights.len() - 1]
    }

    /// The greatest departure from the first course, radians, to starboard and to port.
    fn departure(&self) -> [f64; 2] {
        let from = self.first().own.pose.heading;
        let turned = |s: &Sight| wrap(s.own.pose.heading - from);
        let greatest = |sign: f64| {
            self.sights
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

    /// The least and the greatest speed in multiples of the first.
    fn speeds(&self) -> [f64; 2] {
        let first = self.first().own.speed;
        let ratios = self.sights.iter().map(|s| s.own.speed / first);
        ratios.fold([1.0, 1.0], |[low, high], r| [r.min(low), r.max(high)])
    }

    /// When she first altered course or speed, seconds.
    fn onset(&self) -> Option<f64> {
        let s = &self.t.score;
        let turned = alterations(self.sights, s.turn_rate, s.steady);
        let slowed = speed_changed(self.sights, s.steady_speed);
        let times = turned.first().map(|a| a.from).into_iter().chain(slowed);
        times.min_by(f64::total_cmp)
    }

    /// By the distance of the hulls, in multiples of the longer ship's length.
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

    /// 0 for action at once, 1 for none.
    fn delay(&self) -> f64 {
        let Some(onset) = self.onset() else {
            let near = self.first().ahead().distance < self.t.score.least_lengths * self.length;
            return f64::from(u8::from(near));
        };
        let then = self.sights.iter().find(|s| s.time >= onset);
        let (first, last) = (self.first().range(), self.closest().range());
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
        let share = self.greatest_departure() / self.t.score.apparent;
        0.5 * (1.0 - share * share).max(0.0)
    }

    /// 0 where course or speed is readily altered, 1 where nothing is done.
    fn unapparent(&self) -> f64 {
        // half the penalty of no action
        const LITTLE: f64 = 0.3;
        // of both together where nothing is done
        const NOTHING: f64 = 0.25;
        let turn = self.unapparent_turn();
        let slower = 0.5 * unit((self.speeds()[0] - 0.5) / 0.5);
        if turn < LITTLE || slower < LITTLE {
            0.0
        } else {
            turn * slower / NOTHING
        }
    }

    /// True when more turns than allowed are too small to be readily apparent.
    fn succession(&self) -> Option<f64> {
        let s = &self.t.score;
        let mut small = alterations(self.sights, s.turn_rate, s.steady);
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

    /// When own ship crosses the target's course line ahead of her, nearer than allowed, seconds.
    fn crosses_ahead(&self) -> Option<f64> {
        let s = &self.t.score;
        let all = self.sights.iter().chain(self.after.iter().skip(1));
        let places: Vec<_> = all
            .map(|s| (s.time, s.target.speed, s.seen_from_target()))
            .collect();
        places.windows(2).find_map(|w| {
            let [(_, _, a), (time, speed, b)] = [w[0], w[1]];
            if (a.y < 0.0) == (b.y < 0.0) {
                return None;
            }
            let ahead = a.x + (b.x - a.x) * a.y / (a.y - b.y);
            let allowed = (s.ahead_lengths * self.target_length).max(s.ahead_time * speed);
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

    fn rule_17(&self) -> f64 {
        let s = &self.t.score;
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
            unit((self.safety() - course) * faster - slower)
        } else {
            0.0
        }
    }

    fn scores(&self) -> Scores {
        let keeps_clear = matches!(
            self.role,
            Role::GiveWay | Role::BothGiveWay | Role::Overtaking
        );
        let head_on = matches!(self.role, Role::HeadOn | Role::PortToPort);
        let of = |applies: bool, score: &dyn Fn() -> f64| applies.then(score);
        Scores {
            safety: self.safety(),
            rule_8: of(keeps_clear || head_on, &|| self.rule_8()),
            rule_13: of(self.role == Role::Overtaking, &|| self.rule_13()),
            rule_14: of(head_on, &|| self.rule_14()),
            rule_15: of(
                matches!(self.role, Role::GiveWay | Role::BothGiveWay),
                &|| self.rule_15(),
            ),
            rule_16: of(keeps_clear, &|| self.rule_16()),
            rule_17: of(
                matches!(self.role, Role::StandOn | Role::Overtaken),
                &|| self.rule_17(),
            ),
        }
    }

    fn turned(&self, least: f64, port_alone: bool) -> Option<&Sight> {
        let from = self.first().own.pose.heading;
        self.sights.iter().find(|s| {
            let turn = wrap(s.own.pose.heading - from);
            if port_alone {
                turn > least
            } else {
                turn.abs() > least
            }
        })
    }

    /// Every rule that is broken, in order of time.
    fn breaches(&self) -> Vec<Breach> {
        let (s, closest) = (&self.t.score, self.closest());
        let mut found = Vec::new();
        let mut breach = |rule: &'static str, time: f64, what: String| {
            found.push(Breach { rule, time, what });
        };
        let port_turn = |rule: &'static str, breach: &mut dyn FnMut(&'static str, f64, String)| {
            if let Some(sight) = self.turned(s.steady, true) {
                breach(
                    rule,
                    sight.time,
                    "heads to port of her first course before she has passed".to_owned(),
                );
            }
        };
        let passing = self.onset().is_some() || !(closest.apart > s.least_lengths * self.length);
        match self.role {
            Role::HeadOn | Role::PortToPort => {
                port_turn("14(a)", &mut breach);
                // negated on purpose: what is not known to be to port is not
                if passing && !(closest.bearing() < 0.0 && closest.aspect() < 0.0) {
                    let what = "does not pass on the port side of the other".to_owned();
                    breach("14(a)", closest.time, what);
                }
            }
            Role::GiveWay | Role::BothGiveWay => {
                if let Some(time) = self.crosses_ahead() {
                    breach("15", time, "crosses ahead of the other".to_owned());
                    port_turn("15", &mut breach);
                }
            }
            Role::Overtaking => {
                if let Some(time) = self.crosses_ahead() {
                    breach(
                        "13",
                        time,
                        "crosses ahead of the ship it overtakes".to_owned(),
                    );
                }
            }
            Role::StandOn | Role::Overtaken => {
                let near = s.stage_3_lengths * self.length;
                if let Some(sight) = self.turned(s.hold, false).filter(|s| s.range() > near) {
                    let hold = deg_from_radians(s.hold);
                    let what = format!("does not hold her course within {hold:.0} deg");
                    breach("17(a)(i)", sight.time, what);
                }
                if self.role == Role::StandOn {
                    port_turn("17(c)", &mut breach);
                }
                // negated on purpose: a NaN is a collision
                if !(closest.apart > 0.0) {
                    let what = "holds on into a collision".to_owned();
                    breach("17(b)", closest.time, what);
                }
            }
            Role::None | Role::Static => {}
        }
        if !matches!(self.role, Role::StandOn | Role::Overtaken) {
            if let Some(time) = self.succession() {
                let what = "makes a succession of small alterations".to_owned();
                breach("8(b)", time, what);
            }
            let least = s.least_lengths * self.length;
            if !(closest.apart >= least) {
                let apart = closest.apart;
                let what = format!("passes at {apart:.0} m, less than {least:.0} m");
                breach("8(d)", closest.time, what);
            }
        }
        found.sort_by(|a, b| a.time.total_cmp(&b.time));
        found
    }
}

/// The scores of own ship in a role, and the rules that she breaks: from the beginning of the role to the closest approach of
/// the hulls, whether a line is crossed ahead also after it. O(sights).
pub fn scores(meeting: &Meeting, spell: &RoleSpell, t: &Thresholds) -> (Scores, Vec<Breach>) {
    let all = meeting.sights();
    let begin = all
        .partition_point(|s| s.time < spell.from)
        .min(all.len() - 1);
    // negated on purpose: a NaN is the nearest
    let nearest = (begin..all.len()).fold(begin, |best, k| {
        if !(all[k].apart >= all[best].apart) {
            k
        } else {
            best
        }
    });
    let act = Act {
        t,
        role: spell.role,
        length: meeting.length(),
        sights: &all[begin..=nearest],
        after: &all[nearest..],
        target_length: meeting.target_length(),
    };
    (act.scores(), act.breaches())
}

/// Of a target that own ship has no role toward: safety alone.
pub fn safety(meeting: &Meeting, t: &Thresholds) -> Scores {
    let spell = RoleSpell {
        role: Role::None,
        from: meeting.sights()[0].time,
        until: meeting.sights()[0].time,
    };
    scores(meeting, &spell, t).0
}
