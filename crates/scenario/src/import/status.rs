//! Ships to which others give way by Rule 18.

use searoom_input::Remarks;

/// Part of a navigational status or a type in lower case without blanks, the code of the status by
/// AIS, and its meaning.
const HAMPERED: [(&str, &str, &str); 5] = [
    ("notundercommand", "2", "not under command"),
    (
        "restrictedman",
        "3",
        "restricted in its ability to manoeuvre",
    ),
    ("constrainedby", "4", "constrained by its draught"),
    ("fishing", "7", "engaged in fishing"),
    ("sailing", "8", "under sail"),
];

/// Statuses of ships to which Rule 18 gives no right.
const USUAL: [&str; 3] = ["underwayusingengine", "underway", "0"];

/// Remarks a status or type of a ship: a caution where Rule 18 would give it a right, which roles do
/// not know, and a note where the word means anything else but under way.
pub(super) fn remark(ship: &str, key: &str, word: &str, remarks: &mut Remarks) {
    let plain: String = word
        .chars()
        .filter(|letter| letter.is_alphanumeric())
        .collect();
    let plain = plain.to_lowercase();
    let is_it = |(part, code, _): &&(&str, &str, &str)| plain.contains(part) || plain == *code;
    let hampered = HAMPERED.iter().find(is_it);
    match hampered {
        Some((_, _, meaning)) => remarks.caution(
            "Rule 18",
            format_args!(
                "not applied to '{ship}', {meaning} by its {key}; roles follow from geometry alone"
            ),
        ),
        None if USUAL.contains(&plain.as_str()) => {}
        None => remarks.note(ship, format_args!("{key} \"{word}\" not used")),
    }
}
