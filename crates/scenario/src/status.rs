//! Navigational status of ships, from the words and codes of other formats, and what it means for plans.

use searoom_input::Remarks;
use searoom_model::target::Status;

/// Statuses and types of ships as other formats have them, without blanks and case, and their code by
/// AIS. A word is known by such a part of it.
const KNOWN: [(&str, &str, Status); 11] = [
    ("notundercommand", "2", Status::NotUnderCommand),
    ("restrictedman", "3", Status::Restricted),
    ("constrainedby", "4", Status::ConstrainedByDraught),
    ("fishing", "7", Status::Fishing),
    ("sailing", "8", Status::Sailing),
    ("underway", "0", Status::UnderWay),
    ("anchor", "1", Status::Anchored),
    ("moored", "5", Status::Moored),
    ("aground", "6", Status::Aground),
    ("towing", "11", Status::TowingAstern),
    ("pushing", "12", Status::Pushing),
];

/// The status that a word or a code of another format means.
pub(crate) fn of_word(word: &str) -> Option<Status> {
    let plain: String = word
        .chars()
        .filter(|letter| letter.is_alphanumeric())
        .collect();
    let plain = plain.to_lowercase();
    let is_it = |(part, code, _): &&(&str, &str, Status)| plain.contains(part) || plain == *code;
    KNOWN.iter().find(is_it).map(|(_, _, status)| *status)
}

/// What the status of a ship means for a plan: a caution where Rule 18 would give it a right, which
/// roles do not know, and a note for a distress transmitter.
pub(crate) fn remark(ship: &str, status: Status, remarks: &mut Remarks) {
    match status {
        Status::NotUnderCommand
        | Status::Restricted
        | Status::ConstrainedByDraught
        | Status::Fishing
        | Status::Sailing => remarks.caution(
            "Rule 18",
            format_args!(
                "not applied to '{ship}', {status} by its status; roles follow from geometry alone"
            ),
        ),
        Status::UnderWay | Status::Anchored | Status::Moored | Status::DistressTest => {}
        Status::Aground | Status::TowingAstern | Status::Pushing | Status::Distress => {
            remarks.note(ship, format_args!("{status}; no plan uses its status"));
        }
    }
}
