//! Signal K: deltas and the full model (signalk.org, specification 1.7), in SI units and radians.
//!
//! A delta says what has changed, often a single value. Course, speed, heading and rate of turn of one
//! context are of one fix where their times are near one another ([`Settings::join_s`]); the time of the fix
//! then covers them all. A position is in the report of its own delta alone.

mod known;

use std::collections::HashMap;

use serde_json::Value;

use known::{Known, Update};

use crate::counts::{Counts, Dropped};
use crate::fields::contradiction;
use crate::report::{Identity, Kind, Notes, Report, SourceId};
use crate::settings::Settings;
use crate::time;

/// Most contexts whose last values are kept. Half of them leave together, those that are silent for longest.
const MOST_CONTEXTS: usize = 10_000;

/// What a path says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Path {
    Position,
    Course,
    Speed,
    Heading,
    TurnRate,
    State,
    Length,
    Beam,
    FromBow,
    FromCenter,
    Class,
    Type,
    Name,
    Mmsi,
    CallSign,
    Time,
    Virtual,
    OffPosition,
    Magnetic,
}

const PATHS: &[(&str, Path)] = &[
    ("navigation.position", Path::Position),
    ("navigation.courseOverGroundTrue", Path::Course),
    ("navigation.speedOverGround", Path::Speed),
    ("navigation.headingTrue", Path::Heading),
    ("navigation.rateOfTurn", Path::TurnRate),
    ("navigation.state", Path::State),
    ("design.length", Path::Length),
    ("design.beam", Path::Beam),
    ("sensors.ais.fromBow", Path::FromBow),
    ("sensors.ais.fromCenter", Path::FromCenter),
    ("sensors.ais.class", Path::Class),
    ("design.aisShipType", Path::Type),
    ("name", Path::Name),
    ("mmsi", Path::Mmsi),
    ("communication.callsignVhf", Path::CallSign),
    ("navigation.datetime", Path::Time),
    ("virtual", Path::Virtual),
    ("offPosition", Path::OffPosition),
    ("navigation.headingMagnetic", Path::Magnetic),
];

/// Kinds of contexts: what stands before the identity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Group {
    Vessels,
    Marks,
    Aircraft,
    Distress,
}

const GROUPS: &[(&str, Group)] = &[
    ("vessels", Group::Vessels),
    ("atons", Group::Marks),
    ("aircraft", Group::Aircraft),
    ("sar", Group::Distress),
];

/// One value of an update with its path.
struct Leaf<'v> {
    time: Option<f64>,
    path: Path,
    value: &'v Value,
}

/// Where and when documents come from.
#[derive(Debug, Clone, Copy)]
struct Origin {
    received: f64,
    source: Option<SourceId>,
}

/// The last values of each context, and own ship's identity.
#[derive(Debug, Default)]
pub(crate) struct SignalK {
    own: Option<Identity>,
    known: HashMap<Identity, Known>,
    updates: u64,
}

/// Numbers a source by its name.
pub(crate) trait Sources {
    fn number(&mut self, name: &[u8]) -> SourceId;
}

impl SignalK {
    /// Reports of a document: a delta, a full model, or the greeting of a server.
    pub fn read(
        &mut self,
        document: &[u8],
        now: f64,
        (settings, sources): (&Settings, &mut impl Sources),
        counts: &mut Counts,
        mut found: impl FnMut(Report),
    ) {
        let Ok(document) = serde_json::from_slice::<Value>(document) else {
            counts.drop(Dropped::Document);
            return;
        };
        if let Some(own) = document.get("self").and_then(Value::as_str) {
            self.own = identity(own.strip_prefix("vessels.").unwrap_or(own));
        }
        let is_model = GROUPS.iter().any(|(name, _)| document.get(*name).is_some());
        if let Some(updates) = document.get("updates").and_then(Value::as_array) {
            let context = document.get("context").and_then(Value::as_str);
            let Some((group, identity)) = self.context(context.unwrap_or("vessels.self")) else {
                counts.drop(Dropped::Context);
                return;
            };
            for update in updates {
                let source = source(update).map(|name| sources.number(name.as_bytes()));
                let received = timestamp(update).unwrap_or(now);
                let mut leaves = Vec::new();
                let values = update.get("values").and_then(Value::as_array);
                if values.is_none() {
                    counts.drop(Dropped::Path);
                }
                for entry in values.into_iter().flatten() {
                    let path = entry.get("path").and_then(Value::as_str);
                    let before = leaves.len();
                    if let (Some(path), Some(value)) = (path, entry.get("value")) {
                        collect(path, value, None, &mut leaves);
                    }
                    if leaves.len() == before {
                        counts.drop(Dropped::Path);
                    }
                }
                let origin = Origin { received, source };
                self.update(
                    (group, identity),
                    &leaves,
                    origin,
                    settings,
                    counts,
                    &mut found,
                );
            }
        } else if is_model {
            self.model(&document, now, settings, counts, found);
        } else if document.get("self").is_none() {
            counts.drop(Dropped::OtherDocument);
        }
    }

    /// The values of a full model, each with its own time.
    fn model(
        &mut self,
        document: &Value,
        now: f64,
        settings: &Settings,
        counts: &mut Counts,
        mut found: impl FnMut(Report),
    ) {
        for (name, _) in GROUPS {
            let contexts = document.get(*name).and_then(Value::as_object);
            for (id, node) in contexts.into_iter().flatten() {
                let Some(context) = self.context(&format!("{name}.{id}")) else {
                    counts.drop(Dropped::Context);
                    continue;
                };
                let mut leaves = Vec::new();
                collect("", node, None, &mut leaves);
                let time = |leaf: &Leaf| leaf.time.unwrap_or(f64::NEG_INFINITY);
                leaves.sort_by(|a, b| time(a).total_cmp(&time(b)));
                // values without a time, such as the name, go with the first ones that have one
                let mut rest = &leaves[..];
                while let Some(first) = rest.iter().find_map(|leaf| leaf.time).or(Some(now))
                    && !rest.is_empty()
                {
                    let is_near = |leaf: &Leaf| time(leaf) <= first + settings.join_s;
                    let (these, later) = rest.split_at(rest.partition_point(is_near).max(1));
                    let received = these
                        .iter()
                        .filter_map(|leaf| leaf.time)
                        .fold(first, f64::max);
                    let origin = Origin {
                        received,
                        source: None,
                    };
                    self.update(context, these, origin, settings, counts, &mut found);
                    rest = later;
                }
            }
        }
    }

    /// Group and identity of a context; own ship has one identity, however it is called.
    fn context(&self, context: &str) -> Option<(Group, Identity)> {
        let (group, id) = context.split_once('.')?;
        let (_, group) = GROUPS.iter().find(|(name, _)| *name == group)?;
        let identity = identity(id)?;
        let is_own = *group == Group::Vessels && self.own == Some(identity);
        Some((*group, if is_own { Identity::Own } else { identity }))
    }

    /// The report of some values of a context that are of one time.
    fn update(
        &mut self,
        (group, identity): (Group, Identity),
        leaves: &[Leaf],
        origin: Origin,
        settings: &Settings,
        counts: &mut Counts,
        mut found: impl FnMut(Report),
    ) {
        if leaves.is_empty() {
            return;
        }
        self.updates += 1;
        if self.known.len() >= MOST_CONTEXTS && !self.known.contains_key(&identity) {
            let mut heard: Vec<u64> = self.known.values().map(|known| known.heard).collect();
            let (_, middle, _) = heard.select_nth_unstable(MOST_CONTEXTS / 2);
            self.known.retain(|_, known| known.heard > *middle);
            for _ in self.known.len()..MOST_CONTEXTS {
                counts.drop(Dropped::TooManyContexts);
            }
        }
        let known = self.known.entry(identity).or_default();
        known.heard = self.updates;
        // the time of own ship's receiver
        let dated = leaves.iter().find(|leaf| leaf.path == Path::Time);
        let dated = dated.and_then(|leaf| time::of_timestamp(leaf.value.as_str()?));
        let mut update = Update::default();
        for leaf in leaves {
            let at = dated.or(leaf.time).unwrap_or(origin.received);
            known.read(leaf, at, &mut update, counts);
        }
        if !update.is_used {
            return;
        }
        let at = dated.unwrap_or(origin.received);
        let identity = match (identity, known.mmsi) {
            (Identity::Uuid(_), Some(mmsi)) => Identity::Mmsi(mmsi),
            _ => identity,
        };
        let kind = known.kind(group, identity);
        let mut notes = Notes::default();
        let fix = update
            .has_motion
            .then(|| known.fix(&update, at, settings, &mut notes));
        let fix = fix.map(|fix| match kind {
            Kind::Mark | Kind::VirtualMark => known.resting(fix, &mut notes),
            _ => fix,
        });
        if let Some(fix) = &fix {
            contradiction(update.status, fix, &mut notes);
        }
        let hull = (update.has_size).then(|| known.hull(kind, settings, &mut notes));
        counts.reports += 1;
        found(Report {
            is_own: identity == Identity::Own,
            fix,
            hull,
            status: update.status,
            name: update.name,
            call_sign: update.call_sign,
            type_code: update.type_code,
            notes,
            ..Report::new(origin.received, origin.source, identity, kind)
        });
    }
}

/// Adds the values at and below a path whose paths are read.
fn collect<'v>(path: &str, node: &'v Value, time: Option<f64>, leaves: &mut Vec<Leaf<'v>>) {
    let (value, time) = match node.get("value") {
        Some(value) => (value, timestamp(node).or(time)),
        None => (node, time),
    };
    if let Some((_, path)) = PATHS.iter().find(|(known, _)| *known == path) {
        leaves.push(Leaf {
            time,
            path: *path,
            value,
        });
        return;
    }
    let is_above = |known: &str| match path {
        "" => true,
        _ => known
            .strip_prefix(path)
            .is_some_and(|rest| rest.starts_with('.')),
    };
    if !PATHS.iter().any(|(known, _)| is_above(known)) {
        return;
    }
    for (key, value) in value.as_object().into_iter().flatten() {
        let below = if path.is_empty() {
            key.clone()
        } else {
            format!("{path}.{key}")
        };
        collect(&below, value, time, leaves);
    }
}

fn timestamp(node: &Value) -> Option<f64> {
    node.get("timestamp")
        .and_then(Value::as_str)
        .and_then(time::of_timestamp)
}

fn source(update: &Value) -> Option<&str> {
    let label = || update.get("source")?.get("label");
    update.get("$source").or_else(label)?.as_str()
}

/// The identity in a context, after its group.
fn identity(id: &str) -> Option<Identity> {
    if id == "self" {
        return Some(Identity::Own);
    }
    if let Some(mmsi) = id.strip_prefix("urn:mrn:imo:mmsi:") {
        return mmsi_of(mmsi).map(Identity::Mmsi);
    }
    let uuid = id.strip_prefix("urn:mrn:signalk:uuid:")?;
    let digits: String = uuid.chars().filter(|digit| *digit != '-').collect();
    let is_uuid = digits.len() == 32 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let uuid = u128::from_str_radix(&digits, 16).ok().filter(|_| is_uuid)?;
    Some(Identity::Uuid(uuid.to_be_bytes()))
}

fn mmsi_of(digits: &str) -> Option<u32> {
    let is_number =
        (1..=9).contains(&digits.len()) && digits.bytes().all(|digit| digit.is_ascii_digit());
    is_number.then(|| digits.parse().ok()).flatten()
}
