//! Points and velocities from the command line and from CSV files.

use std::path::Path;

use searoom::input::{abbreviated, read_text};
use searoom::report::counted;
use searoom::scenario::{Fault, ScenarioError};

/// Maximum size of a CSV file in mebibytes.
const FILE_MEBIBYTES: u64 = 16;

/// Maximum number of rows of a CSV file: an answer takes some kilobytes per row.
const ROWS: usize = 100_000;

/// Column: its name, which includes the unit, and its valid range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    name: &'static str,
    low: f64,
    high: f64,
}

impl Column {
    const fn new(name: &'static str, low: f64, high: f64) -> Self {
        Self { name, low, high }
    }

    fn allowed(&self) -> String {
        format!("a number from {} to {}", self.low, self.high)
    }

    /// Parses a number; the error describes the text found.
    fn number(&self, text: &str) -> Result<f64, String> {
        if text.is_empty() {
            return Err("nothing".to_owned());
        }
        match text.parse::<f64>() {
            Ok(number) if number >= self.low && number <= self.high => Ok(number),
            // shortest form: 1e308 has 309 digits
            Ok(number) => Err(format!("{number:?}").trim_end_matches(".0").to_owned()),
            Err(_) => Err(format!("the text {}", abbreviated(text))),
        }
    }
}

pub const POINT: [Column; 3] = [
    Column::new("east_m", -1e7, 1e7),
    Column::new("north_m", -1e7, 1e7),
    Column::new("t_s", 0.0, 1e6),
];

pub const VELOCITY: [Column; 2] = [
    Column::new("east_mps", -100.0, 100.0),
    Column::new("north_mps", -100.0, 100.0),
];

/// Parses the comma-separated numbers of one option.
pub fn option<const N: usize>(text: &str, columns: &[Column; N]) -> Result<[f64; N], String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    if parts.len() != N {
        let allowed = format_args!("{N}: {}", header(columns));
        return Err(Fault::new("", counted(parts.len(), "value"), allowed).to_string());
    }
    let mut row = [0.0; N];
    for ((number, column), part) in row.iter_mut().zip(columns).zip(parts) {
        *number = column
            .number(part)
            .map_err(|found| Fault::new(column.name, found, column.allowed()).to_string())?;
    }
    Ok(row)
}

/// Reads the rows of a CSV file with a header line. At least one row is required; the columns may
/// be in any order. The error lists every fault with its line and field.
pub fn read<const N: usize>(
    file: &Path,
    columns: &[Column; N],
) -> Result<Vec<[f64; N]>, ScenarioError> {
    let text = read_text(file, FILE_MEBIBYTES, "a file of rows")?;
    let mut faults = Vec::new();
    let rows = rows(&text, columns, &mut faults);
    if faults.is_empty() {
        return Ok(rows);
    }
    Err(ScenarioError::faults(file, faults))
}

/// Reads lines of values between commas, which may be in quotation marks; blank lines are skipped.
fn rows<const N: usize>(
    text: &str,
    columns: &[Column; N],
    faults: &mut Vec<Fault>,
) -> Vec<[f64; N]> {
    let names = header(columns);
    let mut order: Option<[usize; N]> = None;
    let mut rows = Vec::new();
    let text = text.trim_start_matches('\u{feff}');
    let lines = text.lines().enumerate();
    for (line, text) in lines.filter(|(_, text)| !text.trim().is_empty()) {
        let line = line + 1;
        let trimmed = |cell: &'_ str| -> String { cell.trim().trim_matches('"').to_owned() };
        let record: Vec<String> = text.split(',').map(trimmed).collect();
        let Some(order) = order else {
            order = columns_of(&record, columns, line, faults);
            if order.is_none() {
                return rows;
            }
            continue;
        };
        if record.len() > N {
            let found = counted(record.len(), "value");
            faults.push(Fault::new("", found, format_args!("{N}: {names}")).at_line(line));
            continue;
        }
        if rows.len() == ROWS {
            let found = format_args!("more than {ROWS} rows");
            faults.push(Fault::new("", found, format_args!("at most {ROWS}")).at_line(line));
            return rows;
        }
        let mut row = [0.0; N];
        for ((number, column), at) in row.iter_mut().zip(columns).zip(order) {
            let read = match record.get(at) {
                Some(text) => column.number(text),
                None => Err(format!("no value: the row has {} of {N}", record.len())),
            };
            match read {
                Ok(value) => *number = value,
                Err(found) => {
                    faults.push(Fault::new(column.name, found, column.allowed()).at_line(line));
                }
            }
        }
        rows.push(row);
    }
    let wanted = format!("a header line {names} and at least one row");
    if order.is_none() {
        faults.push(Fault::new("", "an empty file", &wanted).at_line(1));
    } else if rows.is_empty() && faults.is_empty() {
        faults.push(Fault::new("", "no rows", &wanted));
    }
    rows
}

/// Finds the position of each column in the file.
fn columns_of<const N: usize>(
    found: &[String],
    columns: &[Column; N],
    line: usize,
    faults: &mut Vec<Fault>,
) -> Option<[usize; N]> {
    let names = header(columns);
    let before = faults.len();
    for (i, name) in found.iter().enumerate() {
        if !columns.iter().any(|c| c.name == *name) {
            let what = format_args!("an unknown column {}", abbreviated(name));
            faults.push(Fault::new("", what, &names).at_line(line));
        } else if found.iter().take(i).any(|earlier| earlier == name) {
            faults.push(Fault::new(name, "the column twice", "once").at_line(line));
        }
    }
    let mut order = [0; N];
    for (at, column) in order.iter_mut().zip(columns) {
        match found.iter().position(|name| name == column.name) {
            Some(place) => *at = place,
            None => {
                let allowed = format_args!("a header line {names}");
                faults.push(Fault::new(column.name, "no such column", allowed).at_line(line));
            }
        }
    }
    (faults.len() == before).then_some(order)
}

fn header<const N: usize>(columns: &[Column; N]) -> String {
    columns.map(|c| c.name).join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(text: &str) -> Vec<String> {
        let mut faults = Vec::new();
        rows(text, &POINT, &mut faults);
        faults.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn columns_may_stand_in_any_order() {
        let mut faults = Vec::new();
        let text = "\u{feff}t_s, \"north_m\" ,east_m\r\n\r\n3,2,\"1\"\r\n 6 ,5,-4e0";
        let read = rows(text, &POINT, &mut faults);
        assert_eq!(
            (read, faults),
            (vec![[1.0, 2.0, 3.0], [-4.0, 5.0, 6.0]], vec![])
        );
    }

    #[test]
    fn too_many_rows_are_one_fault() {
        let mut text = "east_m,north_m,t_s\n".to_owned();
        text.push_str(&"0,0,0\n".repeat(ROWS));
        assert!(faults(&text).is_empty());
        text.push_str("0,0,0\nx,y,z\n");
        assert_eq!(
            faults(&text),
            ["line 100002: found more than 100000 rows; allowed: at most 100000"]
        );
    }

    #[test]
    fn every_fault_has_its_line_and_its_field() {
        let text = "east_m,north_m,t_s\n\n1,2,-3\n\n4,5\n,2,inf\n1,2,3,4\nx,1e8,3\n";
        assert_eq!(
            faults(text),
            [
                "line 3: t_s: found -3; allowed: a number from 0 to 1000000",
                "line 5: t_s: found no value: the row has 2 of 3; allowed: a number from 0 to 1000000",
                "line 6: east_m: found nothing; allowed: a number from -10000000 to 10000000",
                "line 6: t_s: found inf; allowed: a number from 0 to 1000000",
                "line 7: found 4 values; allowed: 3: east_m,north_m,t_s",
                "line 8: east_m: found the text \"x\"; allowed: a number from -10000000 to 10000000",
                "line 8: north_m: found 100000000; allowed: a number from -10000000 to 10000000",
            ]
        );
        assert_eq!(faults("").len(), 1);
        assert_eq!(faults("\n\n \n").len(), 1);
        assert_eq!(faults("east_m,north_m,t_s\n").len(), 1);
        assert_eq!(faults("east_m,east_m,t_s\n1,2,3").len(), 2);
    }

    #[test]
    fn an_option_is_one_row() {
        assert_eq!(option("-1, 2,3e1", &POINT), Ok([-1.0, 2.0, 30.0]));
        for (text, found) in [
            ("1,2", "found 2 values"),
            ("1", "found 1 value;"),
            ("1e308,0,0", "east_m: found 1e308;"),
            ("1,2,-1", "t_s: found -1"),
            ("1,,1", "north_m: found nothing"),
            ("nan,0,0", "east_m: found NaN"),
        ] {
            assert!(option(text, &POINT).expect_err(text).starts_with(found));
        }
    }
}
