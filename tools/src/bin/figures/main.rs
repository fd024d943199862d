//! Draws figures 1 to 9 of the paper: all of them into the current folder, or one into a file.
//!
//! ```text
//! cargo figures [figure1 [FILE.svg|FILE.png|FILE.pdf]]
//! ```

mod scenes;
mod sets;

use std::error::Error;
use std::path::PathBuf;

use searoom::report::figure::Figure;

type Draw = fn() -> Result<Figure, Box<dyn Error>>;

/// Name of each figure, which is also the stem of its file, and what draws it.
const FIGURES: [(&str, Draw); 9] = [
    ("figure1", sets::polytope),
    ("figure2", sets::ellipsoid),
    ("figure3", sets::risk),
    ("figure4", sets::closest_approach),
    ("figure5", sets::along_a_path),
    ("figure6", scenes::speeds_along_a_path),
    ("figure7", scenes::explored_motions),
    ("figure8", scenes::encounters),
    ("figure9", scenes::optimal_control),
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1);
    let (wanted, file) = (arguments.next(), arguments.next());
    let is_wanted = |name: &str| wanted.as_ref().is_none_or(|wanted| wanted == name);
    let drawn: Vec<_> = FIGURES.iter().filter(|(name, _)| is_wanted(name)).collect();
    if drawn.is_empty() || arguments.next().is_some() {
        return Err(
            "found other arguments; allowed: nothing, or figure1 to figure9 and a file".into(),
        );
    }
    for (name, draw) in drawn {
        let file = file
            .clone()
            .map_or_else(|| format!("{name}.svg").into(), PathBuf::from);
        draw()?.write(&file)?;
    }
    Ok(())
}
