//! Messages in several parts.

use crate::bits::Bits;
use crate::counts::{Counts, Dropped};
use crate::report::SourceId;
use crate::sentence::Part;

/// Seconds within which all parts of a message come.
const WITHIN_S: f64 = 3.0;

/// Messages that may wait for parts at a time.
const MOST_WAITING: usize = 64;

/// Most parts of a message: their number has one digit.
const MOST_PARTS: usize = 9;

/// Longest armour of one part, bytes.
const MOST_ARMOUR: usize = 82;

/// A whole message.
pub(crate) struct Message {
    pub received: f64,
    pub source: Option<SourceId>,
    pub is_own: bool,
    pub bits: Bits,
}

/// A message of which parts are missing.
#[derive(Debug)]
struct Waiting {
    /// Of the reader's clock.
    arrived: f64,
    /// Of the tag block, where a part has had one.
    time: Option<f64>,
    source: Option<SourceId>,
    group: Option<u32>,
    channel: Option<u8>,
    sequence: Option<u8>,
    is_own: bool,
    count: u8,
    parts: [Option<Armour>; MOST_PARTS],
}

#[derive(Debug, Clone, Copy)]
struct Armour {
    bytes: [u8; MOST_ARMOUR],
    length: u8,
    fill: u8,
}

/// Puts the parts of messages together, of as many at a time as [`MOST_WAITING`].
#[derive(Debug, Default)]
pub(crate) struct Assembler {
    waiting: Vec<Waiting>,
}

/// True where two times are of one message, as far as both are known.
fn is_within(a: Option<f64>, b: Option<f64>) -> bool {
    a.zip(b).is_none_or(|(a, b)| (a - b).abs() <= WITHIN_S)
}

/// True where two keys may be of one message: a later part may lack what the first one says.
fn may_be_same<T: PartialEq>(a: Option<T>, b: Option<T>) -> bool {
    a.is_none() || b.is_none() || a == b
}

impl Waiting {
    fn is_of(&self, part: &Part, source: Option<SourceId>) -> bool {
        // the source of a group stands with its first part alone
        let same_group = self.group.is_some() && self.group == part.tag.group;
        let same_source = self.source == source || same_group && may_be_same(self.source, source);
        same_source
            && self.group == part.tag.group
            && self.count == part.count
            && self.is_own == part.is_own
            && self.sequence == part.sequence
            && may_be_same(self.channel, part.channel)
    }

    fn is_fresh(&self, part: &Part, now: f64) -> bool {
        is_within(Some(self.arrived), Some(now)) && is_within(self.time, part.tag.time)
    }
}

impl Assembler {
    /// The message that a part completes.
    pub fn add(
        &mut self,
        part: &Part,
        (source, now): (Option<SourceId>, f64),
        counts: &mut Counts,
    ) -> Option<Message> {
        if part.count == 1 {
            let mut bits = Bits::new();
            if !bits.push(part.armoured, part.fill) {
                counts.drop(Dropped::Armour);
                return None;
            }
            return Some(Message {
                received: part.tag.time.unwrap_or(now),
                source,
                is_own: part.is_own,
                bits,
            });
        }
        if part.armoured.len() > MOST_ARMOUR {
            counts.drop(Dropped::Fields);
            return None;
        }
        let slot = usize::from(part.number - 1);
        let found = self.fitting(part, source);
        // the same part again, or one that comes late, is that of a new message
        let found = found.filter(|at| {
            let waiting = &self.waiting[*at];
            let fits = waiting.parts[slot].is_none() && waiting.is_fresh(part, now);
            if !fits {
                self.waiting.remove(*at);
                counts.drop(Dropped::LateParts);
            }
            fits
        });
        let at = found.unwrap_or_else(|| {
            if self.waiting.len() >= MOST_WAITING {
                self.waiting.remove(0);
                counts.drop(Dropped::TooManyParts);
            }
            self.waiting.push(Waiting {
                arrived: now,
                time: part.tag.time,
                source,
                group: part.tag.group,
                channel: part.channel,
                sequence: part.sequence,
                is_own: part.is_own,
                count: part.count,
                parts: [None; MOST_PARTS],
            });
            self.waiting.len() - 1
        });
        let waiting = &mut self.waiting[at];
        waiting.source = waiting.source.or(source);
        waiting.channel = waiting.channel.or(part.channel);
        waiting.time = waiting.time.or(part.tag.time);
        let mut armour = Armour {
            bytes: [0; MOST_ARMOUR],
            length: part.armoured.len() as u8,
            fill: part.fill,
        };
        armour.bytes[..part.armoured.len()].copy_from_slice(part.armoured);
        waiting.parts[slot] = Some(armour);
        let count = usize::from(part.count);
        if waiting.parts[..count].iter().any(Option::is_none) {
            return None;
        }
        let whole = self.waiting.remove(at);
        let mut bits = Bits::new();
        let mut parts = whole.parts[..count].iter().flatten();
        let is_sound =
            parts.all(|armour| bits.push(&armour.bytes[..usize::from(armour.length)], armour.fill));
        if !is_sound {
            counts.drop(Dropped::Armour);
            return None;
        }
        Some(Message {
            received: whole.time.unwrap_or(whole.arrived),
            source: whole.source,
            is_own: whole.is_own,
            bits,
        })
    }

    /// The message that a part belongs to. Where a part that lacks a source or a channel may be of several,
    /// it is of none.
    fn fitting(&self, part: &Part, source: Option<SourceId>) -> Option<usize> {
        let is_exact = |w: &&Waiting| w.source == source && w.channel == part.channel;
        let index = |of: &Waiting| self.waiting.iter().position(|w| std::ptr::eq(w, of));
        let mut fitting = self.waiting.iter().filter(|w| w.is_of(part, source));
        let exact = fitting.clone().find(is_exact);
        match (exact, fitting.next(), fitting.next()) {
            (Some(exact), ..) => index(exact),
            (None, Some(only), None) => index(only),
            _ => None,
        }
    }

    /// Ends what waits, and counts it.
    pub fn finish(&mut self, counts: &mut Counts) {
        self.waiting
            .drain(..)
            .for_each(|_| counts.drop(Dropped::LateParts));
    }
}
