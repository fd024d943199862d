"""Tests of the package. They run from anywhere; files are those of the repository."""

from __future__ import annotations

import ast
import inspect
import json
import pickle
import signal
import subprocess
import sys
import threading
import tomllib
import xml.etree.ElementTree
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import searoom
from searoom import _searoom

ROOT = Path(__file__).parents[2]
COLREGS = sorted((ROOT / "scenarios/colregs").glob("*.toml"))
PROGRAM = ROOT / "target/release/searoom"


def scenario(name: str) -> searoom.Scenario:
    return searoom.Scenario.read(ROOT / "scenarios" / name)


def without_times(document: Any) -> Any:
    """A document without what depends on the machine."""
    if isinstance(document, dict):
        left_out = {"timing", "file"}
        return {k: without_times(v) for k, v in document.items() if k not in left_out}
    if isinstance(document, list):
        return [without_times(item) for item in document]
    return document


@pytest.mark.parametrize("file", COLREGS, ids=lambda file: file.stem)
def test_a_dict_is_the_scenario_that_its_file_is(file: Path) -> None:
    values = tomllib.loads(file.read_text())
    read = searoom.plan(searoom.Scenario.read(file))
    made = searoom.plan(searoom.Scenario.from_dict(values))
    assert read.safe
    assert without_times(made.document) == without_times(read.document)


def test_numbers_and_arrays_of_numpy_are_numbers_and_lists() -> None:
    values = tomllib.loads(COLREGS[0].read_text())
    plain = searoom.Scenario.from_dict(values)
    values["horizon_s"] = np.float64(values["horizon_s"])
    values["targets"] = tuple(values["targets"])
    speeds = np.array([2.5, 5.0])
    values["own_ship"]["speeds_mps"] = speeds
    made = searoom.Scenario.from_dict(values)
    assert made.horizon_s == plain.horizon_s
    assert tomllib.loads(made.text)["own_ship"]["speeds_mps"] == [2.5, 5.0]


@pytest.mark.parametrize("file", COLREGS, ids=lambda file: file.stem)
def test_samples_move_as_their_courses_and_speeds_say(file: Path) -> None:
    plan = searoom.plan(searoom.Scenario.read(file))
    samples = plan.sample()
    # joints are sampled, so the speed is constant between two samples, and so is the turn rate
    between = plan.sample((samples.t_s[1:] + samples.t_s[:-1]) / 2)
    along = between.speed_mps * np.diff(samples.t_s)
    course = np.radians(between.course_deg)
    assert np.diff(samples.east_m) == pytest.approx(along * np.sin(course), abs=0.02)
    assert np.diff(samples.north_m) == pytest.approx(along * np.cos(course), abs=0.02)


@pytest.mark.parametrize("file", COLREGS, ids=lambda file: file.stem)
def test_a_plan_stays_out_of_its_sets(file: Path) -> None:
    plan = searoom.plan(searoom.Scenario.read(file))
    samples = plan.sample()
    nearest = np.inf
    for t, east, north in zip(samples.t_s, samples.east_m, samples.north_m, strict=True):
        for vertices in plan.sections(t).values():
            edges = np.roll(vertices, -1, axis=0) - vertices
            outward = np.column_stack([edges[:, 1], -edges[:, 0]])
            outward /= np.linalg.norm(outward, axis=1)[:, None]
            beyond = np.einsum("ij,ij->i", outward, np.array([east, north]) - vertices)
            nearest = min(nearest, beyond.max())
    assert nearest > -1e-6
    assert nearest < 50.0


def test_times_of_a_sample_are_those_asked_for() -> None:
    plan = searoom.plan(scenario("colregs/head-on.toml"))
    every = plan.sample()
    some = plan.sample(np.array([every.t_s[7], every.t_s[-1]]))
    assert some.east_m.tolist() == [every.east_m[7], every.east_m[-1]]


def test_an_altered_document_is_rejected() -> None:
    plan = searoom.plan(scenario("colregs/head-on.toml"))
    assert searoom.verify(plan)["verified"]
    document = json.loads(plan.to_json())
    document["cost"]["length_m"] += 1.0
    checked = searoom.verify(json.dumps(document))
    assert searoom.verify(document)["violations"] == checked["violations"]
    assert not checked["verified"]
    assert "length_m" in checked["violations"][0]["what"]


def test_a_changed_dict_changes_no_plan() -> None:
    plan = searoom.plan(scenario("colregs/head-on.toml"))
    before = plan.cost
    plan.document["safe"] = False
    plan.document.pop("cost")
    assert plan.safe and plan.cost == before and json.loads(plan.to_json())["safe"]


def test_a_saved_plan_is_the_previous_one(tmp_path: Path) -> None:
    first = searoom.plan(scenario("colregs/give-way.toml"))
    file = tmp_path / "plan.json"
    first.save(file)
    values = tomllib.loads((ROOT / "scenarios/colregs/give-way.toml").read_text())
    values["time_s"] = values.get("time_s", 0.0) + 30.0
    own = first.sample([30.0])
    values["own_ship"]["position"] = {"east_m": own.east_m[0], "north_m": own.north_m[0]}
    values["own_ship"]["course_deg"] = own.course_deg[0]
    for target in values["targets"]:
        course = np.radians(target["course_deg"])
        way = 30.0 * target["speed_mps"] * np.array([np.sin(course), np.cos(course)])
        position = target["position"]
        target["position"] = {
            "east_m": position["east_m"] + way[0],
            "north_m": position["north_m"] + way[1],
        }
    later = searoom.Scenario.from_dict(values)
    from_memory = searoom.plan(later, previous=first)
    from_file = searoom.plan(later, previous=file)
    assert from_memory.document["memory"] is not None
    assert without_times(from_memory.document) == without_times(from_file.document)
    # own ship is in its turn to starboard and goes on with it
    assert own.course_deg[0] > 95.0
    then, now = first.sample([50.0]), from_memory.sample([20.0])
    assert now.course_deg == pytest.approx(then.course_deg)
    assert now.east_m == pytest.approx(then.east_m)
    with pytest.raises(searoom.DocumentError, match='a plan of "Give-way"'):
        searoom.plan(scenario("colregs/head-on.toml"), previous=from_file)


def test_threads_plan_what_one_does() -> None:
    files = COLREGS * 4
    alone = [without_times(searoom.plan(searoom.Scenario.read(f)).document) for f in files]
    with ThreadPoolExecutor(4) as pool:
        plans = pool.map(lambda file: searoom.plan(searoom.Scenario.read(file)), files)
        assert [without_times(plan.document) for plan in plans] == alone


def test_the_lock_is_released_while_planning() -> None:
    several = scenario("paper/figure_8_overtaking.toml").replace(planner="optimal-control")
    counted = 0
    done = threading.Event()

    def plan() -> None:
        try:
            searoom.plan(several)
        finally:
            done.set()

    thread = threading.Thread(target=plan)
    thread.start()
    while not done.wait(0.001):
        counted += 1
    thread.join()
    assert counted > 3


def test_a_scenario_is_its_dict_again() -> None:
    for file in COLREGS:
        read = searoom.Scenario.read(file)
        assert read.to_dict() == tomllib.loads(file.read_text())
        made = searoom.Scenario.from_dict(read.to_dict())
        assert without_times(searoom.plan(made).document) == without_times(searoom.plan(read).document)


def test_other_targets_keep_the_settings() -> None:
    asked = scenario("colregs/head-on.toml").replace(compliance="none", max_risk=0.1)
    [target] = asked.to_dict()["targets"]
    others = [target | {"name": name} for name in ("first", "second")]
    found = asked.with_targets(others)
    assert found.targets == ["first", "second"]
    assert found.compliance == "none"
    assert searoom.plan(found).document["max_risk"] == 0.1
    assert asked.with_targets([]).targets == []
    with pytest.raises(searoom.InputError, match="targets"):
        asked.with_targets([target | {"length_m": -1.0}])


def test_a_notebook_shows_a_plan() -> None:
    renamed = scenario("colregs/give-way.toml")
    [target] = renamed.to_dict()["targets"]
    plan = searoom.plan(renamed.with_targets([target | {"name": "<b> & co"}]))
    html = plan._repr_html_()
    chart = xml.etree.ElementTree.fromstring(html)
    titles = [title.text for title in chart.iter("title")]
    assert any(title is not None and title.startswith("<b> & co at ") for title in titles)
    assert plan.verdict in html
    # own ship's track lies within the frame
    svg = chart.find("svg")
    assert svg is not None
    width, height = map(float, svg.attrib["viewBox"].split()[2:])
    *_, track = svg.iter("polyline")
    places = [tuple(map(float, place.split(","))) for place in track.attrib["points"].split()]
    assert len(places) > 100
    assert all(0 < east < width and 0 < south < height for east, south in places)
    # the way begins in the west and ends in the east
    assert places[0][0] < places[-1][0]


def test_a_chart_is_framed_by_the_ships_and_not_by_the_land() -> None:
    pytest.importorskip("matplotlib").use("agg")
    plan = searoom.plan(scenario("harbour/munkholmen.toml"))
    assert plan.document["land"]
    axes = searoom.plot(plan)
    samples = plan.sample()
    width = np.ptp(axes.get_xlim())
    extent = max(np.ptp(samples.east_m), np.ptp(samples.north_m))
    assert width < 3 * extent


def test_a_pickled_scenario_is_the_same() -> None:
    asked = scenario("harbour/munkholmen.toml").replace(compliance="shape", seed=7)
    read = pickle.loads(pickle.dumps(asked))
    assert read.compliance == "shape" and read.__reduce__() == asked.__reduce__()
    assert without_times(searoom.plan(read).document) == without_times(searoom.plan(asked).document)


def test_a_simulation_steps_as_it_runs() -> None:
    begun = scenario("colregs/give-way.toml")
    stepped = searoom.Simulation(begun)
    places = []
    while not stepped.finished:
        places.append((stepped.time_s, stepped.own))
        stepped.step()
    ran = searoom.simulate(begun)
    assert without_times(stepped.record()) == without_times(ran)
    assert ran["safe"] and ran["arrived"] and len(places) > 100
    times = [time for time, _ in places]
    assert times == sorted(set(times))
    target = stepped.targets["target"]
    assert isinstance(target, searoom.ShipState) and target.speed_mps == pytest.approx(5.0)


def test_seeds_decide_what_is_measured() -> None:
    noisy = ROOT / "scenarios/closed-loop/head-on-radar.toml"
    begun = searoom.Scenario.read(noisy)
    one, again, other = (searoom.simulate(begun, seed=seed) for seed in (1, 1, 2))
    assert without_times(one) == without_times(again)
    assert without_times(one)["sailed"] != without_times(other)["sailed"]


def test_a_signal_ends_a_simulation_between_two_steps() -> None:
    simulation = searoom.Simulation(scenario("closed-loop/harbour-ferries.toml"))
    seen: list[float] = []

    def interrupt(*_: object) -> None:
        seen.append(simulation.time_s)
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.005)
        with pytest.raises(KeyboardInterrupt):
            simulation.run()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert not simulation.finished
    assert simulation.record()["duration_s"] == seen[0] == simulation.time_s
    simulation.run()
    assert simulation.finished


def test_situations_of_others_are_read() -> None:
    cases = searoom.Scenario.read_all(ROOT / "scenarios/imazu/imazu.json", margin_m=500.0)
    assert len(cases) == 22 and cases[0].notes
    again = searoom.Scenario.parse(cases[4].text)
    assert again.targets == cases[4].targets


def test_an_assessment_answers_every_question() -> None:
    found = searoom.assess(
        scenario("colregs/head-on.toml"),
        points=[[750.0, 0.0, 150.0]],
        velocities=np.array([[5.0, 0.0], [0.0, 5.0]]),
        sections_s=[0.0, 60.0],
    )
    assert found["points"][0]["targets"][0]["risk"] == pytest.approx(1.0)
    assert len(found["velocities"]) == 2
    assert len(found["targets"][0]["sections"]) == 2


def test_a_comparison_has_every_method() -> None:
    found = searoom.compare(scenario("colregs/head-on.toml"))
    outcomes = {entry["method"]: entry["outcome"] for entry in found["entries"]}
    assert outcomes["space-time, by the rules"] == "solved"
    assert outcomes["hold course"] == "collides"


def test_plans_of_a_comparison_are_no_better_than_their_bounds() -> None:
    found = searoom.compare(scenario("colregs/give-way.toml"), bound=True)
    bounded = [entry for entry in found["entries"] if "lower_bound" in entry]
    error = "space_time_error_m2"
    assert bounded and all(0.0 < e["lower_bound"][error] <= e["cost"][error] for e in bounded)
    plain = searoom.compare(scenario("colregs/give-way.toml"))
    assert not any("lower_bound" in entry for entry in plain["entries"])


def test_without_a_plan_there_are_no_samples() -> None:
    values = tomllib.loads(COLREGS[0].read_text())
    values["horizon_s"] = 20.0
    plan = searoom.plan(searoom.Scenario.from_dict(values))
    assert plan.outcome == "infeasible" and plan.cost is None and not plan.safe
    with pytest.raises(searoom.NoPlanError, match="horizon"):
        plan.sample()


def own(**changes: Any) -> dict[str, Any]:
    values = tomllib.loads(COLREGS[0].read_text())
    values["own_ship"].update(changes)
    return values


def nested() -> dict[str, Any]:
    values: dict[str, Any] = {}
    values["again"] = values
    return values


HEAD_ON = scenario("colregs/head-on.toml")
WRONG: list[tuple[Any, str]] = [
    (lambda: searoom.Scenario.read("nowhere.toml"), "nowhere.toml: cannot be read"),
    (lambda: searoom.Scenario.parse("title = 3"), "title: found 3"),
    (lambda: searoom.Scenario.from_dict(own(speed_mps=-1.0)), "own_ship.speed_mps: found -1"),
    (lambda: searoom.Scenario.from_dict(own(speed_mps=float("nan"))), "own_ship.speed_mps: found"),
    (lambda: searoom.Scenario.from_dict(own(speed_mps=None)), "own_ship.speed_mps: found None"),
    (lambda: searoom.Scenario.from_dict(own(speed_mps={1})), "own_ship.speed_mps: found set"),
    (lambda: searoom.Scenario.from_dict(own(speed_mps=2**70)), "an integer of 64 bits"),
    (lambda: searoom.Scenario.from_dict({1: 2}), "keys that are texts"),
    (lambda: searoom.Scenario.from_dict(nested()), "more than 32 levels"),
    (lambda: HEAD_ON.replace(planner="best"), 'planner: found "best"; allowed: space-time'),
    (lambda: HEAD_ON.replace(max_risk=1.5), "max_risk: found 1.5"),
    (lambda: HEAD_ON.replace(deadline_s=float("nan")), "deadline_s: found NaN"),
    (lambda: HEAD_ON.replace(seed=-1), "seed: found -1"),
    (lambda: searoom.Scenario.read(COLREGS[0], margin=3.0), 'assumption: found "margin"'),
    (lambda: searoom.Scenario.read(COLREGS[0], margin_m="wide"), "margin_m: found 'wide'"),
    (lambda: searoom.plan(HEAD_ON).sample([-1.0]), r"times_s\[0\]: found -1; allowed: 0 to"),
    (lambda: searoom.plan(HEAD_ON).sample("now"), "times_s: found 'now'"),
    (lambda: searoom.plan(HEAD_ON).sample(3.0), "times_s: found 3.0; allowed: a list or array"),
    (lambda: searoom.Scenario.from_dict({"title": "\ud800"}), "title: found .*Unicode"),
    (lambda: searoom.verify("[1]"), "allowed: a plan document|searoom-plan"),
    (lambda: searoom.verify({}), "format: found none"),
    (lambda: searoom.plan(HEAD_ON).sections(float("nan")), "time_s: found NaN; allowed: 0 to"),
    (lambda: searoom.plan(HEAD_ON).save(ROOT / "nowhere" / "plan.json"), "nowhere"),
    (lambda: searoom.assess(HEAD_ON, points=[[1.0, 2.0]]), r"points\[0\]: found 2 numbers"),
    (lambda: searoom.assess(HEAD_ON, points=3), "points: found 3; allowed: rows of 3 numbers"),
    (lambda: searoom.assess(HEAD_ON, sections_s=[-1.0]), "found -1; allowed: times from 0 to"),
    (lambda: searoom.assess(HEAD_ON, points=[[1e300, 0.0, 0.0]]), "points: found 1e"),
    (lambda: searoom.verify({"a": np.zeros(2)}), "not JSON serializable"),
    (lambda: searoom.compare(HEAD_ON, max_risks=[2.0]), "max_risks: found 2"),
    (lambda: searoom.verify("{}"), "format: found none"),
    (lambda: searoom.verify("nowhere.json"), "nowhere.json: cannot be read"),
    (lambda: searoom.plan(HEAD_ON, previous="{}"), "format: found none"),
]


@pytest.mark.parametrize(("call", "text"), WRONG, ids=[text for _, text in WRONG])
def test_what_is_wrong_is_named(call: Any, text: str) -> None:
    with pytest.raises(searoom.SearoomError, match=text):
        call()


def test_every_fault_is_listed() -> None:
    with pytest.raises(searoom.InputError) as caught:
        searoom.Scenario.from_dict(own(speed_mps=-1.0, length_m=0.0))
    faults = {fault["path"] for fault in caught.value.faults}
    assert faults == {"own_ship.speed_mps", "own_ship.length_m"}
    assert all(fault["line"] is None for fault in caught.value.faults)


@pytest.mark.parametrize("call", [searoom.plan, searoom.verify, searoom.assess])
def test_a_wrong_type_is_a_type_error(call: Any) -> None:
    with pytest.raises(TypeError):
        call(3)


def test_tables_have_the_samples() -> None:
    pytest.importorskip("pandas")
    xarray = pytest.importorskip("xarray")
    plan = searoom.plan(HEAD_ON)
    samples = plan.sample()
    assert plan.to_dataframe()["north_m"].tolist() == samples.north_m.tolist()
    dataset = plan.to_xarray()
    assert isinstance(dataset, xarray.Dataset) and dataset.speed_mps.units == "m s-1"


def test_a_plan_is_drawn() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    ax = searoom.plot(searoom.plan(HEAD_ON))
    assert ax.get_title() == "Head-on: solved"
    assert "plan" in [text.get_text() for text in ax.get_legend().get_texts()]


def test_a_plan_is_logged(tmp_path: Path) -> None:
    rerun = pytest.importorskip("rerun")
    import searoom.rerun

    stream = rerun.RecordingStream("searoom-test")
    stream.save(tmp_path / "plan.rrd")
    searoom.rerun.log(searoom.plan(HEAD_ON), recording=stream)
    stream.flush()
    assert (tmp_path / "plan.rrd").stat().st_size > 1000


@pytest.mark.skipif(not PROGRAM.exists(), reason="the program is not built")
@pytest.mark.parametrize("file", COLREGS, ids=lambda file: file.stem)
def test_the_package_and_the_program_agree(file: Path) -> None:
    printed = subprocess.run([PROGRAM, "plan", file, "--json"], capture_output=True, check=True)
    plan = searoom.plan(searoom.Scenario.read(file))
    assert without_times(json.loads(printed.stdout)) == without_times(plan.document)


def test_the_notebook_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    monkeypatch.chdir(ROOT)
    notebook = json.loads((ROOT / "python/tutorial.ipynb").read_text())
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert len(cells) == 10
    names: dict[str, Any] = {}
    for cell in cells:
        exec("".join(cell["source"]), names)


def described() -> list[tuple[Any, str]]:
    """What the stubs describe, with its text."""
    stubs = ast.parse(Path(_searoom.__file__).with_name("_searoom.pyi").read_text())
    found = []
    for node in stubs.body:
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            thing = getattr(_searoom, node.name)
            found.append((thing, ast.get_docstring(node)))
            inner = node.body if isinstance(node, ast.ClassDef) else []
            for method in inner:
                if isinstance(method, ast.FunctionDef) and ast.get_docstring(method):
                    found.append((getattr(thing, method.name), ast.get_docstring(method)))
    return [(thing, text) for thing, text in found if text]


def test_stubs_and_help_say_the_same() -> None:
    every = described()
    assert len(every) > 25
    for thing, text in every:
        assert " ".join((inspect.getdoc(thing) or "").split()) == " ".join(text.split()), thing


def test_stubs_are_those_of_the_module(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    settings = str(ROOT / "python/pyproject.toml")
    stubs = ["mypy.stubtest", "searoom._searoom", "--mypy-config-file", settings]
    for command in (stubs, ["mypy", "--config-file", settings, "-p", "searoom"]):
        checked = subprocess.run(
            [sys.executable, "-m", *command],
            capture_output=True,
            text=True,
            check=False,
            cwd=tmp_path,  # the package as it is installed
        )
        assert checked.returncode == 0, checked.stdout + checked.stderr
