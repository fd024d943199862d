//! Scenarios with so many targets that those out of reach are listed only.

use crate::docs::documents::{PAGE, keys_of, named};
use crate::program::{Folder, document, run, says, stderr, stdout};
use crate::schemas::Schema;

/// Head-on with one ship, and 400 others 50 km away.
fn scene() -> String {
    let far = (0..400).map(|k| {
        format!(
            "[[targets]]\nname = \"far {k}\"\nposition = {{ east_m = 50000.0, north_m = {} }}\n\
             course_deg = 90.0\nspeed_mps = 5.0\nlength_m = 60.0\nbeam_m = 12.0\n",
            100 * k
        )
    });
    crate::program::HEAD_ON.to_owned() + &far.collect::<String>()
}

#[test]
fn targets_out_of_reach_are_named_in_every_output() {
    let folder = Folder::new();
    let file = folder.write("many.toml", scene());
    let shown = run(&format!("plan {file}")).success();
    says(
        &stdout(&shown),
        "400 targets out of reach, not planned for | no role, no risk | verified, safe",
    );
    let plan = document(&run(&format!("plan {file} --json")).success());
    Schema::of("plan").assert_holds(&plan, "many");
    named(PAGE, &keys_of(&["plan", &file, "--json"]));
    assert_eq!(plan["targets"].as_array().map(Vec::len), Some(1));
    let written = folder.write("many.json", plan.to_string());
    let verified = run(&format!("verify {written}")).success();
    says(&stdout(&verified), "400 targets out of reach");
    let verified = document(&run(&format!("verify {written} --json")).success());
    Schema::of("verify").assert_holds(&verified, "many");
    assert_eq!(verified["plans"][0]["out_of_reach"], 400);
    let suite = document(&run(&format!("suite {file} --json")).success());
    assert_eq!(suite["runs"][0]["targets"], 401);
}

#[test]
fn check_counts_targets_out_of_reach() {
    let folder = Folder::new();
    let file = folder.write("many.toml", scene());
    let checked = run(&format!("check {file}")).success();
    let note = "400 targets, the first of them 'far 0': never matter";
    says(&stderr(&checked), note);
    assert_eq!(stdout(&checked), format!("{file}: ok\n"));
}
