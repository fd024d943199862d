//! Comparison of a part of a document with the same part made from what was verified.

use super::figures::near_to;
use super::mismatch;
use searoom_evaluation::Violation;
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Additional rounding of a number by its place, such as `cost.min_clearance_m`, in its unit.
pub(super) type Rounding = BTreeMap<String, f64>;

/// Every place at which two documents differ, with what each says: `claimed` is of the document,
/// `verified` was made from what is proven.
///
/// Numbers may differ as [`near_to`] says; counts, words and lengths of lists may not. A number
/// that is not finite is nothing, as in a file, so that `verified` must hold none that is required.
pub(super) fn differences<T: Serialize>(
    claimed: &T,
    verified: &T,
    rounding: &Rounding,
) -> Vec<Violation> {
    let values = [claimed, verified].map(serde_json::to_value);
    let [Ok(claimed), Ok(verified)] = &values else {
        return vec![Violation::new("a document that is no JSON".to_owned(), 0.0)];
    };
    let mut found = Vec::new();
    compare("", claimed, verified, rounding, &mut found);
    found
}

/// Adds the differences at a place and below it.
fn compare(
    place: &str,
    claimed: &Value,
    verified: &Value,
    rounding: &Rounding,
    found: &mut Vec<Violation>,
) {
    match (claimed, verified) {
        (Value::Object(a), Value::Object(b)) => {
            let keys: BTreeSet<&String> = a.keys().chain(b.keys()).collect();
            for key in keys {
                let place = match place {
                    "" => key.clone(),
                    place => format!("{place}.{key}"),
                };
                let [a, b] = [a, b].map(|object| object.get(key).unwrap_or(&Value::Null));
                compare(&place, a, b, rounding, found);
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            for (index, (a, b)) in a.iter().zip(b).enumerate() {
                compare(&format!("{place}[{index}]"), a, b, rounding, found);
            }
        }
        (Value::Array(a), Value::Array(b)) => {
            found.push(mismatch(&format!("{place}, length"), a.len(), b.len()));
        }
        _ if is_same(place, claimed, verified, rounding) => {}
        _ => found.push(mismatch(place, text(claimed), text(verified))),
    }
}

/// True for equal values, and for numbers that are near one another. Whole numbers are counts.
fn is_same(place: &str, claimed: &Value, verified: &Value, rounding: &Rounding) -> bool {
    let are_counts = claimed.is_u64() && verified.is_u64();
    match (claimed.as_f64(), verified.as_f64()) {
        (Some(claimed), Some(verified)) if !are_counts => near_to(
            claimed,
            verified,
            // one that is not finite would allow any number
            (rounding.get(place).copied())
                .filter(|rounding| rounding.is_finite())
                .unwrap_or(0.0),
        ),
        _ => claimed == verified,
    }
}

/// A value in a message.
fn text(value: &Value) -> String {
    match value {
        Value::Null => "nothing".to_owned(),
        Value::String(text) if text.is_empty() => "nothing".to_owned(),
        Value::String(text) => text.clone(),
        // without the `.0` of a whole number
        other => match other.as_f64() {
            Some(number) => number.to_string(),
            None => other.to_string(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn found(claimed: Value, verified: Value) -> Vec<String> {
        let rounding = Rounding::from([("b[1]".to_owned(), 0.5)]);
        let found = differences(&claimed, &verified, &rounding);
        found.into_iter().map(|violation| violation.what).collect()
    }

    #[test]
    fn differences_are_named_by_their_place() {
        let document = json!({ "a": { "c": 1.5 }, "b": [1.0, 2.0], "d": "x", "e": true, "n": 3 });
        assert_eq!(found(document.clone(), document.clone()), [""; 0]);
        for (pointer, value, expected) in [
            ("/a/c", json!(1.6), "a.c: the document says 1.6, it is 1.5"),
            (
                "/a/c",
                json!(-1.5),
                "a.c: the document says -1.5, it is 1.5",
            ),
            (
                "/a/c",
                json!(null),
                "a.c: the document says nothing, it is 1.5",
            ),
            ("/a", json!({}), "a.c: the document says nothing, it is 1.5"),
            (
                "/a",
                json!({ "c": 1.5, "x": 1 }),
                "a.x: the document says 1, it is nothing",
            ),
            ("/b/0", json!(1.4), "b[0]: the document says 1.4, it is 1"),
            ("/b/1", json!(2.6), "b[1]: the document says 2.6, it is 2"),
            (
                "/b",
                json!([1.0]),
                "b, length: the document says 1, it is 2",
            ),
            (
                "/b",
                json!(null),
                "b: the document says nothing, it is [1.0,2.0]",
            ),
            ("/d", json!(""), "d: the document says nothing, it is x"),
            ("/e", json!(false), "e: the document says false, it is true"),
            ("/n", json!(4), "n: the document says 4, it is 3"),
        ] {
            let mut claimed = document.clone();
            *claimed.pointer_mut(pointer).expect(pointer) = value;
            assert_eq!(found(claimed, document.clone()), [expected]);
        }
    }

    #[test]
    fn numbers_may_differ_by_their_rounding_and_counts_may_not() {
        let far = 1e9;
        assert_eq!(
            found(json!({ "b": [0.0, 2.4] }), json!({ "b": [0.0, 2.0] })),
            [""; 0]
        );
        assert_eq!(
            found(json!({ "a": far }), json!({ "a": far + 1.0 })),
            [""; 0]
        );
        // a rounding without an end would allow any number
        let [claimed, verified] = [json!({ "a": 5.5 }), json!({ "a": 1.5 })];
        for endless in [f64::INFINITY, f64::NAN] {
            let rounding = Rounding::from([("a".to_owned(), endless)]);
            assert_eq!(differences(&claimed, &verified, &rounding).len(), 1);
        }
        let counts = [json!({ "a": 1_000_000_000 }), json!({ "a": 1_000_000_001 })];
        let [claimed, verified] = counts;
        assert_eq!(found(claimed, verified).len(), 1);
        // what is not finite is nothing, and no number
        assert_eq!(
            found(json!({ "a": f64::NAN }), json!({ "a": 1.0 })).len(),
            1
        );
        assert_eq!(
            found(json!({ "a": 1.0 }), json!({ "a": f64::NAN })).len(),
            1
        );
    }
}
