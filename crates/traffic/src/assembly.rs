//! Messages in several parts.

use crate::bits::Bits;
use crate::counts::{Counts, Dropped};
use crate::report::SourceId;
use crate::sentence::Part;

/// Seconds within which all parts of a message come.
const WITHIN_S: f64 = 3.0;

/// Messages that may wait for parts at a time.
const MOST_WAITING: usize = 64;

/// Most parts of a message that is kept: five slots fit into five sentences.
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
    since: f64,
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
}

impl Assembler {
    /// The message that a part completes.
    pub fn add(
        &mut self,
        part: &Part,
        (source, received): (Option<SourceId>, f64),
        counts: &mut Counts,
    ) -> Option<Message> {
        if part.count == 1 {
            let mut bits = Bits::new();
            if !bits.push(part.armoured, part.fill) {
                counts.drop(Dropped::Armour);
                return None;
            }
            return Some(Message {
                received,
                source,
                is_own: part.is_own,
                bits,
            });
        }
        let before = self.waiting.len();
        // a clock that was set back ends what waits, too
        let is_fresh = |w: &Waiting| (received - w.since).abs() <= WITHIN_S;
        self.waiting.retain(is_fresh);
        (self.waiting.len()..before).for_each(|_| counts.drop(Dropped::LateParts));
        if part.armoured.len() > MOST_ARMOUR {
            counts.drop(Dropped::Fields);
            return None;
        }
        let slot = usize::from(part.number - 1);
        let found = self.waiting.iter().position(|w| w.is_of(part, source));
        // the same part again is that of a new message
        let found = found.filter(|at| {
            let is_new = self.waiting[*at].parts[slot].is_none();
            if !is_new {
                self.waiting.remove(*at);
                counts.drop(Dropped::LateParts);
            }
            is_new
        });
        let at = found.unwrap_or_else(|| {
            if self.waiting.len() >= MOST_WAITING {
                self.waiting.remove(0);
                counts.drop(Dropped::TooManyParts);
            }
            self.waiting.push(Waiting {
                since: received,
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
            received: whole.since,
            source: whole.source,
            is_own: whole.is_own,
            bits,
        })
    }
}
