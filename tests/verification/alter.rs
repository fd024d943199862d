//! Alterations of plan documents, written as tables.
//!
//! A row is `name | edits | word`. An edit is `pointer operation value`; `;` separates edits.
//! Operations are `=` (JSON), `+`, `*` and `remove`. In a pointer, `*` is every index, `2..` every
//! index from 2 on, and `last` the last one. The word must occur in a violation; a row without a
//! word may also be refused as no plan document.

use searoom::verification::verify;
use serde_json::{Value, json};

use crate::documents::{checked, is_caught};

pub fn at<'a>(document: &'a mut Value, pointer: &str) -> &'a mut Value {
    document
        .pointer_mut(pointer)
        .unwrap_or_else(|| panic!("{pointer}"))
}

pub fn list<'a>(document: &'a mut Value, pointer: &str) -> &'a mut Vec<Value> {
    at(document, pointer).as_array_mut().expect("a list")
}

pub fn add(number: &mut Value, step: f64) {
    *number = json!(number.as_f64().expect("a number") + step);
}

pub fn scale(number: &mut Value, factor: f64) {
    *number = json!(number.as_f64().expect("a number") * factor);
}

/// Segments of the document. Samples and figures stay unchanged, so the test states which check
/// detects the alteration.
pub fn segments(document: &mut Value) -> &mut Vec<Value> {
    list(document, "/trajectory/segments")
}

pub fn give_up(document: &mut Value, kind: &str, target: &str, amount: f64) {
    let unit = match kind {
        "domain" | "arrival" => "m",
        _ => "1",
    };
    let given_up = json!({ "kind": kind, "target": target, "amount": amount, "unit": unit });
    list(document, "/relaxations").push(given_up);
}

/// Name, edits and word of each row.
pub fn rows(table: &'static str) -> impl Iterator<Item = [&'static str; 3]> {
    table
        .lines()
        .filter(|line| !line.trim().is_empty())
        .map(|line| {
            let cells: Vec<&str> = line.split('|').map(str::trim).collect();
            cells.try_into().unwrap_or_else(|_| panic!("{line}"))
        })
}

pub fn alter(document: &mut Value, edits: &str) {
    for edit in edits.split(';') {
        let mut words = edit.trim().splitn(3, ' ');
        let [pointer, operation] = [(); 2].map(|()| words.next().expect("an edit"));
        let value = words
            .next()
            .map(|text| serde_json::from_str::<Value>(text).expect(edit));
        let number = || value.as_ref().and_then(Value::as_f64).expect(edit);
        for place in places(document, pointer) {
            match operation {
                "=" => *at(document, &place) = value.clone().expect(edit),
                "+" => add(at(document, &place), number()),
                "*" => scale(at(document, &place), number()),
                "remove" => remove(document, &place),
                _ => panic!("{edit}"),
            }
        }
    }
}

fn remove(document: &mut Value, place: &str) {
    let (parent, key) = place.rsplit_once('/').expect("a pointer");
    match at(document, parent) {
        Value::Array(list) => drop(list.remove(key.parse().expect("an index"))),
        Value::Object(map) => drop(map.remove(key).expect("a key")),
        other => panic!("{place}: {other}"),
    }
}

/// Places that a pointer with patterns stands for.
fn places(document: &Value, pointer: &str) -> Vec<String> {
    let mut found = vec![String::new()];
    for token in pointer.split('/').skip(1) {
        let matching = |place: &String| {
            let count = document
                .pointer(place)
                .and_then(Value::as_array)
                .map_or(0, Vec::len);
            let range = match token {
                "*" => 0..count,
                "last" => count - 1..count,
                _ => match token.strip_suffix("..") {
                    Some(first) => first.parse().expect("an index")..count,
                    None => return vec![format!("{place}/{token}")],
                },
            };
            range.map(|index| format!("{place}/{index}")).collect()
        };
        found = found.iter().flat_map(matching).collect();
    }
    assert!(!found.is_empty(), "{pointer} is nowhere");
    found
}

/// Checks that a document is verified, and that each alteration of it is rejected with its word.
pub fn assert_rejected(original: &Value, table: &'static str) {
    let name = &original["scenario"];
    assert!(!is_caught(original), "{name}");
    for [what, edits, word] in rows(table) {
        let mut document = original.clone();
        alter(&mut document, edits);
        match verify(&document.to_string()) {
            Ok(_) => assert_word(&document, &format!("{name}, {what}"), word),
            // the set may no longer be a convex polygon
            Err(error) => assert!(word.is_empty(), "{name}, {what}: {error}"),
        }
    }
}

pub fn assert_word(document: &Value, what: &str, word: &str) {
    let found = checked(document);
    let told = found.violations.iter().any(|v| v.what.contains(word));
    assert!(!found.verified() && told, "{what}: {:#?}", found.violations);
}
