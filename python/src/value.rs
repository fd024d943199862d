//! Values between Python and Rust.

use std::fmt::Display;
use std::path::PathBuf;

use pyo3::Borrowed;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use searoom::document::PLAN_MEBIBYTES;
use serde::Serialize;
use toml::Value;

use crate::error::{DocumentError, InternalError, argument};
use crate::plan::Plan;

/// Deepest nesting of a dict that is a scenario.
const DEEPEST: usize = 32;

const ALLOWED: &str = "dict, list, text, number or bool";

/// A Python dict as the text of a scenario file.
pub fn toml_text(scenario: &Bound<PyDict>) -> PyResult<String> {
    let value = table(scenario, "", 0)?;
    toml::to_string(&value).map_err(|error| argument("", error, "a scenario"))
}

fn table(dict: &Bound<PyDict>, path: &str, depth: usize) -> PyResult<Value> {
    let mut found = toml::Table::new();
    for (key, value) in dict {
        let Ok(key) = key.extract::<String>() else {
            return Err(argument(path, key.repr()?, "keys that are texts"));
        };
        let inner = if path.is_empty() {
            key.clone()
        } else {
            format!("{path}.{key}")
        };
        found.insert(key, of(&value, &inner, depth + 1)?);
    }
    Ok(Value::Table(found))
}

fn of(value: &Bound<PyAny>, path: &str, depth: usize) -> PyResult<Value> {
    if depth > DEEPEST {
        let found = format!("more than {DEEPEST} levels");
        return Err(argument(path, found, "a scenario"));
    }
    // a bool is an int too
    if let Ok(found) = value.cast::<PyBool>() {
        return Ok(Value::Boolean(found.is_true()));
    }
    if let Ok(found) = value.cast::<PyInt>() {
        return match found.extract() {
            Ok(number) => Ok(Value::Integer(number)),
            Err(_) => Err(argument(path, found.repr()?, "an integer of 64 bits")),
        };
    }
    if let Ok(found) = value.cast::<PyFloat>() {
        return Ok(Value::Float(found.value()));
    }
    if let Ok(found) = value.cast::<PyString>() {
        let text = found.extract();
        return text.map(Value::String).map_err(|_| {
            let found = value.repr().map(|repr| repr.to_string());
            argument(
                path,
                found.unwrap_or_default(),
                "a text of Unicode characters",
            )
        });
    }
    if let Ok(found) = value.cast::<PyDict>() {
        return table(found, path, depth);
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let mut all = Vec::new();
        for (index, item) in value.try_iter()?.enumerate() {
            all.push(of(&item?, &format!("{path}[{index}]"), depth + 1)?);
        }
        return Ok(Value::Array(all));
    }
    // arrays and numbers of numpy
    if let Ok(plain) = value.call_method0("tolist") {
        return of(&plain, path, depth + 1);
    }
    let kind = value.get_type().name()?;
    Err(argument(
        path,
        format!("{kind}: {}", value.repr()?),
        ALLOWED,
    ))
}

/// A document as Python objects: dicts, lists, texts, numbers, bools and None.
pub fn objects<'py>(py: Python<'py>, document: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (json(document)?,))
}

/// The JSON text of a document.
pub fn json(document: &impl Serialize) -> PyResult<String> {
    searoom::document::json(document).map_err(|error| InternalError::new_err(error.to_string()))
}

/// Finite numbers from any sequence or array.
pub fn numbers(value: &Bound<PyAny>, path: &str) -> PyResult<Vec<f64>> {
    let allowed = "a list or array of finite numbers";
    let found: Vec<f64> = value
        .extract()
        .map_err(|_| argument(path, short(value), allowed))?;
    match found.iter().position(|number| !number.is_finite()) {
        Some(index) => Err(argument(format!("{path}[{index}]"), found[index], allowed)),
        None => Ok(found),
    }
}

/// Rows of finite numbers from any sequence of sequences or two-dimensional array.
pub fn rows<const N: usize>(value: &Bound<PyAny>, path: &str) -> PyResult<Vec<[f64; N]>> {
    let mut all = Vec::new();
    let given = value.try_iter();
    let given = given.map_err(|_| argument(path, short(value), format!("rows of {N} numbers")))?;
    for (index, row) in given.enumerate() {
        let (row, path) = (row?, format!("{path}[{index}]"));
        let found = numbers(&row, &path)?;
        let row = found.try_into();
        all.push(row.map_err(|found: Vec<f64>| {
            argument(
                &path,
                format!("{} numbers", found.len()),
                format!("{N} numbers"),
            )
        })?);
    }
    Ok(all)
}

/// A short text of a value for a message.
fn short(value: &Bound<PyAny>) -> String {
    const MOST: usize = 60;
    let text = value
        .repr()
        .map(|text| text.to_string())
        .unwrap_or_default();
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// A document: a plan, a dict, a text that begins with `{`, or a file.
pub enum AnyDocument<'py> {
    Plan(Bound<'py, Plan>),
    Text(String),
    File(PathBuf),
}

impl<'py> FromPyObject<'_, 'py> for AnyDocument<'py> {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(plan) = value.cast::<Plan>() {
            return Ok(Self::Plan(plan.to_owned()));
        }
        if value.is_instance_of::<PyDict>() {
            let text = value.py().import("json")?.call_method1("dumps", (value,));
            let text = text.map_err(|error| DocumentError::new_err(error.to_string()))?;
            return text.extract().map(Self::Text);
        }
        if let Ok(text) = value.extract() {
            return Ok(Self::Text(text));
        }
        value.extract().map(Self::File).map_err(|_| {
            let allowed = "a Plan, a document as dict or text, or a file";
            PyTypeError::new_err(format!("found {}; allowed: {allowed}", short(&value)))
        })
    }
}

/// The text of a document and where it is from.
pub struct DocumentText {
    file: Option<PathBuf>,
    pub text: String,
}

impl AnyDocument<'_> {
    pub fn read(self) -> PyResult<DocumentText> {
        let file = match self {
            Self::Plan(plan) => {
                return Ok(DocumentText {
                    file: None,
                    text: json(plan.get().document())?,
                });
            }
            Self::Text(text) if text.trim_start().starts_with(['{', '[']) => {
                return Ok(DocumentText { file: None, text });
            }
            Self::Text(name) => PathBuf::from(name),
            Self::File(file) => file,
        };
        let text = searoom::input::read_text(&file, PLAN_MEBIBYTES, "a document");
        let text = text.map_err(|error| DocumentError::new_err(error.to_string()))?;
        Ok(DocumentText {
            file: Some(file),
            text,
        })
    }
}

impl DocumentText {
    /// The name of the file; empty for a text.
    pub fn name(&self) -> String {
        let file = self.file.as_ref();
        file.map(|file| file.display().to_string())
            .unwrap_or_default()
    }

    pub fn error(&self, what: impl Display) -> PyErr {
        DocumentError::new_err(match &self.file {
            Some(file) => format!("{}: {what}", file.display()),
            None => what.to_string(),
        })
    }
}
