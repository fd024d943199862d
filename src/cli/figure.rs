//! Where a figure goes.

use std::fs;
use std::path::Path;

use anyhow::{Context, bail};
use searoom::report::figure::{FigureError, FigureFormat};

/// Refuses a name of another format, and makes the folder.
pub fn prepare(path: &Path) -> anyhow::Result<()> {
    if FigureFormat::of(path).is_none() {
        let file = path.to_owned();
        bail!("--figure: {}", FigureError::Format { file });
    }
    if path.is_dir() {
        bail!("--figure: {}: a folder; name a file", path.display());
    }
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => fs::create_dir_all(folder)
            .with_context(|| format!("{}: the folder cannot be made", folder.display())),
        _ => Ok(()),
    }
}
