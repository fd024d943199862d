//! The tables of `suite` and `compare`: in a terminal, as CSV, Markdown and LaTeX.

use std::fs;

use super::program::{Folder, HEAD_ON, command, document, list, number, run, says, stdout};

/// Rows of the tables of a text: the lines between the double rule and the single one after it.
fn rows(text: &str) -> Vec<&str> {
    let mut lines = text.lines();
    let mut rows = Vec::new();
    while lines.any(|line| line.starts_with('═')) {
        rows.extend(lines.by_ref().take_while(|line| !line.starts_with('─')));
    }
    rows
}

/// One line for each method of each scenario, with broken rules by number; what they mean is below.
#[test]
fn a_comparison_has_a_line_for_each_method_in_160_columns() {
    let folder = Folder::new();
    let csv = folder.at("rows.csv");
    for asked in ["scenarios --planner path-time", "scenarios/colregs"] {
        let words = format!("compare {asked} --csv {csv}");
        let mut command = command(&words.split(' ').collect::<Vec<_>>());
        let text = stdout(&command.env("COLUMNS", "160").assert());
        let wide = text.lines().find(|line| line.chars().count() > 160);
        assert_eq!(wide, None);
        let mut records = csv::Reader::from_path(&csv).expect("rows");
        let names = records.headers().expect("columns").clone();
        let column = |name: &str| names.iter().position(|n| n == name).expect("a column");
        let records: Vec<_> = records
            .records()
            .map(|record| record.expect("a row"))
            .collect();
        let rows = rows(&text);
        assert_eq!(rows.len(), records.len(), "{text}");
        for (row, record) in rows.iter().zip(&records) {
            assert!(
                row.starts_with(&format!("{} ", &record[column("method")])),
                "{row}"
            );
            let broken = record[column("breaks")].replace(' ', ", ");
            let is_none = row.ends_with("none") || row.ends_with('–');
            assert!(
                row.ends_with(&broken) && (!broken.is_empty() || is_none),
                "{row}"
            );
        }
    }
    let text = stdout(&run("compare scenarios/colregs --planner path-time"));
    let (table, below) = text.rsplit_once('─').expect("a table");
    says(table, " 8(d), R1, R4, S\n");
    says(below, "S: the hulls touch; R1: holds a collision course");
    // methods with the same plan
    let both = stdout(&run(
        "compare scenarios/colregs/give-way.toml --compliance shape",
    ));
    let of = |name: &str| {
        rows(&both)
            .into_iter()
            .filter(|row| row.starts_with(name))
            .count()
    };
    assert_eq!(
        [of("space-time, A* "), of("space-time, Dijkstra ")],
        [1, 1],
        "{both}"
    );
}

/// Cells of a line of Markdown.
fn markdown_cells(line: &str) -> Vec<String> {
    let line = line.replace("\\\\", "\u{1}").replace("\\|", "\u{0}");
    let line = ["<", "*", "_", "`"]
        .iter()
        .fold(line, |line, c| line.replace(&format!("\\{c}"), c));
    let cells = line.trim_matches('|').split('|');
    cells
        .map(|cell| cell.trim().replace('\u{0}', "|").replace('\u{1}', "\\"))
        .collect()
}

/// Text of a cell of LaTeX; an error where it has a command, or a brace, that is none of an escape.
fn tex_text(cell: &str) -> Result<String, String> {
    let mut text = cell.to_owned();
    for (escape, plain) in [
        ("\\textbackslash{}", "\u{1}"),
        ("\\textasciitilde{}", "\u{2}"),
        ("\\textasciicircum{}", "\u{3}"),
        ("\\textless{}", "<"),
        ("\\textgreater{}", ">"),
        ("\\textbar{}", "|"),
        ("$^2$", "²"),
        ("$^\\circ$", "°"),
        ("$-$", "-"),
        ("{}[", "["),
    ] {
        text = text.replace(escape, plain);
    }
    let placed = [
        ("\\{", '\u{4}'),
        ("\\}", '\u{5}'),
        ("\\&", '\u{6}'),
        ("\\%", '\u{7}'),
        ("\\_", '\u{e}'),
        ("\\#", '\u{f}'),
        ("\\$", '\u{10}'),
    ];
    for (escape, place) in placed {
        text = text.replace(escape, &place.to_string());
    }
    if text.contains(['\\', '{', '}', '&', '%', '_', '#', '$', '~', '^']) {
        return Err(format!("{cell:?} has a character that is not escaped"));
    }
    for (escape, place) in placed {
        text = text.replace(place, &escape[1..]);
    }
    let text = text.replace("--", "–");
    Ok(text
        .replace('\u{1}', "\\")
        .replace('\u{2}', "~")
        .replace('\u{3}', "^"))
}

/// Rows of the tables of a LaTeX file, each with its header, without the comments.
fn tex_rows(text: &str) -> Vec<Vec<String>> {
    let mut lines = text
        .lines()
        .filter(|line| !line.starts_with('%') && !line.is_empty());
    let mut rows = Vec::new();
    while let Some(begin) = lines.next() {
        let columns = begin
            .strip_prefix("\\begin{tabular}{")
            .and_then(|c| c.strip_suffix('}'));
        let columns = columns.expect(begin).len();
        assert_eq!(lines.next(), Some("  \\toprule"));
        let mut row = |line: &str| {
            let cells = line
                .strip_prefix("  ")
                .and_then(|line| line.strip_suffix(" \\\\"));
            // an escaped & has no blank before it
            let cells = cells.expect(line).split(" & ").map(tex_text);
            let cells: Vec<String> = cells.collect::<Result<_, _>>().expect("a row");
            assert_eq!(cells.len(), columns, "{line}");
            rows.push(cells);
        };
        row(lines.next().expect("a header"));
        assert_eq!(lines.next(), Some("  \\midrule"));
        lines
            .by_ref()
            .take_while(|line| *line != "  \\bottomrule")
            .for_each(row);
        assert_eq!(lines.next(), Some("\\end{tabular}"));
    }
    rows
}

/// One table in every format: the cells are the same, whatever a name has in it.
#[test]
fn suite_and_compare_write_one_table_in_three_formats() {
    let folder = Folder::new();
    let odd = "[R&D] 50%_#1 {$x} ~^ a\\|b <c|d>.toml";
    let odd = folder.write(
        odd,
        HEAD_ON.replace("\"Head-on\"", "'Head-on, 50% \\ | {x}'"),
    );
    let name = "[R&D] 50%_#1 {$x} ~^ a\\|b <c|d>.toml";
    for (asked, key) in [("suite", "runs"), ("compare", "comparisons")] {
        let [csv, md, tex] = ["a.csv", "new/a.md", "a.tex"].map(|file| folder.at(file));
        let words = [asked, &odd, "scenarios/colregs", "--json"];
        let files = ["--csv", &csv, "--md", &md, "--tex", &tex];
        let found = command(&[words.as_slice(), &files].concat())
            .assert()
            .success();
        found.get_output();
        let [md, tex] = [md, tex].map(|file| fs::read_to_string(file).expect("a table"));
        let mut records = csv::Reader::from_path(&csv).expect("rows");
        let names = records.headers().expect("columns").clone();
        // a row of another number of columns is an error
        let records: Vec<_> = records
            .records()
            .map(|record| record.expect("a row"))
            .collect();

        let found = document(&found);
        let entries: Vec<_> = match asked {
            "suite" => list(&found[key]).iter().collect(),
            _ => (list(&found[key]).iter())
                .flat_map(|c| list(&c["entries"]))
                .collect(),
        };
        assert_eq!(records.len(), entries.len());
        let column = |name: &str| names.iter().position(|n| n == name).expect("a column");
        for (record, entry) in records.iter().zip(entries) {
            assert_eq!(
                &record[column("outcome")],
                entry["outcome"].as_str().expect("a word")
            );
            let error: f64 = record[column("space_time_error_m2")]
                .parse()
                .expect("a number");
            assert_eq!(error, number(&entry["cost"]["space_time_error_m2"]));
        }
        assert_eq!(&records[0][column("file")], odd);
        assert_eq!(&records[0][column("scenario")], "Head-on, 50% \\ | {x}");

        let of_tex = tex_rows(&tex);
        let lines = md.lines().filter(|line| line.starts_with("| "));
        let of_md: Vec<Vec<String>> = lines.map(markdown_cells).collect();
        assert_eq!(of_md, of_tex);
        let headers = if asked == "suite" { 1 } else { 5 };
        assert_eq!(of_md.len(), records.len() + headers);
        let first = if asked == "suite" {
            name
        } else {
            &records[0][column("method")]
        };
        assert_eq!(of_md[1][0], first);
        says(&md, "- clearance: own hull to any hull");
        says(&tex, "% clearance: own hull to any hull | J [m$^2$] & ");
    }
    assert!(
        fs::read_to_string(folder.at("a.tex"))
            .expect("a table")
            .contains(" & $-$")
    );
}

/// Whatever cannot be written is told before anything is planned.
#[test]
fn a_table_needs_the_name_of_a_file() {
    let folder = Folder::new();
    folder.write("file", "");
    folder.refuses(
        "
        compare scenarios/colregs --quiet --csv DIR | --csv: DIR: a folder; name a file
        suite scenarios/colregs --quiet --md DIR/new/ | --md: DIR/new/: a folder; name a file
        suite scenarios/colregs --quiet --tex - | --tex: found -; allowed: a file, or /dev/stdout
        compare scenarios/colregs --quiet --tex DIR/file/a.tex | DIR/file: the folder cannot be made
        suite scenarios/colregs --lint --csv DIR/a.csv | cannot be used with
        ",
    );
    assert_eq!(folder.names("."), ["file"]);
    // what is read, or written by another option, is not overwritten
    folder.write("in.toml", HEAD_ON);
    folder.refuses(
        "
        suite DIR/in.toml --quiet --csv DIR/in.toml | --csv: DIR/in.toml: a scenario file
        compare DIR --quiet --md DIR/./in.toml | a scenario file, which would be overwritten
        suite DIR --quiet --csv DIR/a --md DIR/a | --md: DIR/a: written by --csv, too; name another
        suite DIR --quiet --csv DIR/a --tex DIR/./a | --tex: DIR/./a: written by --csv, too
        ",
    );
    let kept = fs::read_to_string(folder.at("in.toml")).expect("the scenario");
    assert_eq!(kept, HEAD_ON);
    assert_eq!(folder.names("."), ["file", "in.toml"]);
    let printed = stdout(&run("suite scenarios/colregs --quiet --csv /dev/stdout").success());
    assert!(
        printed.starts_with("file,scenario,planner,outcome,"),
        "{printed}"
    );
    assert_eq!(printed.lines().count(), 1 + 4);
}

/// No option writes what another one writes, in a folder or on standard output.
#[test]
fn two_outputs_are_two_files() {
    let folder = Folder::new();
    let scenario = "scenarios/colregs/head-on.toml";
    let table = "
        suite HEAD_ON --plans DIR/pl --csv DIR/pl/head-on.json | --plans: DIR/pl/head-on.json: written by --csv, too
        suite HEAD_ON --md DIR/x.svg --figure DIR/x.svg | --figure: DIR/x.svg: written by --md, too; name another
        compare HEAD_ON --md DIR/x.svg --figure DIR/x.svg | --figure: DIR/x.svg: written by --md, too
        suite HEAD_ON --report DIR/r --md DIR/r/index.html | --report: DIR/r/index.html: written by --md, too
        suite HEAD_ON --json --csv /dev/stdout | --csv: /dev/stdout: written by --json, too
        compare HEAD_ON --json --md /dev/stdout | --md: /dev/stdout: written by --json, too
        ";
    let table = table.replace("HEAD_ON", scenario);
    folder.refuses(&table);
    // nor is one that is read, also where a link leads there
    for (name, from) in [
        ("in.csv", scenario),
        ("before.csv", "scenarios/colregs/give-way.toml"),
    ] {
        std::fs::copy(from, folder.at(name)).expect("copied");
    }
    std::os::unix::fs::symlink(folder.at("in.csv"), folder.at("link.svg")).expect("a link");
    folder.refuses(
        "
        plan DIR/in.csv --route DIR/in.csv | --route: DIR/in.csv: a file that is read, which would be overwritten
        plan DIR/in.csv --figure DIR/link.svg | --figure: DIR/link.svg: a file that is read
        plan DIR/in.csv --previous DIR/before.csv --route DIR/before.csv | --route: DIR/before.csv: a file that is read",
    );
    // results beside one another are no clash
    let [all, csv] = ["all", "all/rows.csv"].map(|name| folder.at(name));
    let words = [
        "suite", scenario, "--plans", &all, "--report", &all, "--csv", &csv,
    ];
    command(&[&words[..], &["--figure", &format!("{all}/"), "--json"]].concat())
        .assert()
        .success();
}

/// A file that cannot be read has a row with its fault, and no values.
#[test]
fn a_broken_file_has_a_row() {
    let folder = Folder::new();
    let broken = folder.write("broken.toml", "horizon_s = 1.0");
    let csv = folder.at("rows.csv");
    for asked in ["suite", "compare --planner path-time"] {
        let words = format!("{asked} {broken} scenarios/colregs/head-on.toml --csv {csv}");
        run(&words).code(2);
        let mut records = csv::Reader::from_path(&csv).expect("rows");
        let names = records.headers().expect("columns").clone();
        let rows: Vec<_> = records.records().map(|row| row.expect("a row")).collect();
        let of = |row: usize, name: &str| {
            let column = names.iter().position(|n| n == name).expect("a column");
            rows[row][column].to_owned()
        };
        assert_eq!(of(0, "file"), broken);
        assert_eq!([of(0, "outcome"), of(0, "verdict")], ["unreadable"; 2]);
        says(&of(0, "reason"), "broken.toml: ");
        assert_eq!([of(0, "arrived"), of(0, "safe")], [""; 2]);
        assert!(["true", "false"].contains(&of(1, "arrived").as_str()));
        assert_ne!(of(1, "verdict"), "");
    }
}

#[test]
fn a_name_is_no_markup_in_markdown() {
    let folder = Folder::new();
    let title = "<b>*a*_b_`c`|d";
    let file = HEAD_ON.replace("\"Head-on\"", &format!("'{title}'"));
    let (file, md) = (folder.write("_a_.toml", file), folder.at("a.md"));
    run(&format!("compare {file} --md {md} --planner path-time")).code(1);
    let text = fs::read_to_string(&md).expect("a table");
    says(&text, "# \\<b>\\*a\\*\\_b\\_\\`c\\`\\|d\n");
}
