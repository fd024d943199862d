//! Exceptions: one tree, with the texts of the command line.

use std::panic::{AssertUnwindSafe, catch_unwind};

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use searoom::input::Fault;
use searoom::scenario::ScenarioError;

pyo3::create_exception!(
    searoom,
    SearoomError,
    PyValueError,
    "Something that Searoom cannot use. The text names the place, what was found and what is allowed."
);
pyo3::create_exception!(
    searoom,
    InputError,
    SearoomError,
    "A scenario or an argument that is wrong.\n\n`faults` has a dict with `path`, `found`, `allowed` and `line` for each fault."
);
pyo3::create_exception!(
    searoom,
    DocumentError,
    SearoomError,
    "A document that cannot be read, or does not fit."
);
pyo3::create_exception!(
    searoom,
    NoPlanError,
    SearoomError,
    "There is no plan. The text is the reason."
);
pyo3::create_exception!(
    searoom,
    InternalError,
    SearoomError,
    "A fault of Searoom itself. Please report it."
);

/// The exception of one argument.
pub fn argument(path: impl Into<String>, found: impl ToString, allowed: impl ToString) -> PyErr {
    let fault = Fault::new(path, found.to_string(), allowed.to_string());
    faults(None, &[fault])
}

/// The exception of faults in a text.
pub fn faults(source: Option<&str>, faults: &[Fault]) -> PyErr {
    let lines: Vec<String> = faults.iter().map(ToString::to_string).collect();
    let text = match (source, lines.as_slice()) {
        (None, _) => lines.join("\n"),
        (Some(source), [one]) => format!("{source}: {one}"),
        (Some(source), _) => format!("{source}:\n{}", lines.join("\n")),
    };
    with_faults(text, faults)
}

/// The exception of a scenario file.
pub fn scenario(error: &ScenarioError) -> PyErr {
    match error {
        ScenarioError::Faults { faults, .. } => with_faults(error.to_string(), faults),
        _ => with_faults(error.to_string(), &[]),
    }
}

fn with_faults(text: String, faults: &[Fault]) -> PyErr {
    let error = InputError::new_err(text);
    Python::attach(|py| {
        let listed = faults.iter().map(|fault| {
            let dict = PyDict::new(py);
            dict.set_item("path", &fault.path)?;
            dict.set_item("found", &fault.found)?;
            dict.set_item("allowed", &fault.allowed)?;
            dict.set_item("line", fault.line)?;
            Ok(dict)
        });
        let listed: PyResult<Vec<_>> = listed.collect();
        // without the list the text still says everything
        if let Ok(listed) = listed {
            let _ = error.value(py).setattr("faults", listed);
        }
    });
    error
}

/// Runs some work without the interpreter lock. A panic becomes an [`InternalError`].
pub fn detached<T: Send>(py: Python, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| catch_unwind(AssertUnwindSafe(work)))
        .map_err(|cause| {
            let text = cause.downcast_ref::<String>().map(String::as_str);
            let text = text.or_else(|| cause.downcast_ref::<&str>().copied());
            InternalError::new_err(format!("internal fault: {}", text.unwrap_or("unknown")))
        })
}
