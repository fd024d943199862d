"""Tests of campaigns. The workers of Dask are processes of their own."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import searoom
from searoom import campaign

ROWS = 60
SHARDS = 12
# the columns that docs/reference/campaign-files.md names as those of the machine
OF_MACHINE = ["late", "plan_ms_median", "plan_ms_most", "cpu_s"]
SPEC = f"""
name = "tests"
seed = 3
rows = {ROWS}
horizon_s = 1000
path_length_m = 2500

[own_ship]
speed_mps = 5
length_m = 30
beam_m = 8
turning_radius_m = 100
speeds_mps = [2.5, 5, 6]
safety_margin_m = 20

[planner]
compliance = "rules"

[simulation]
duration_s = 600

[[strata]]
name = "head-on"
class = "head-on"
behaviour = {{ kind = "extremes" }}

[[strata]]
name = "give-way"
class = "give-way"
share = 2
behaviour = {{ kind = "extremes", factor = 2 }}
"""


@pytest.fixture
def spec() -> campaign.Specification:
    return campaign.Specification.parse(SPEC)


def table(folder: Path) -> bytes:
    """The rows in order without the columns of the machine, as bytes."""
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    rows = parquet.read_table(campaign.merge(folder)).sort_by("row").drop_columns(OF_MACHINE)
    assert rows["row"].to_pylist() == list(range(ROWS))
    sink = pyarrow.BufferOutputStream()
    with pyarrow.ipc.new_stream(sink, rows.schema) as stream:
        stream.write_table(rows.combine_chunks(), max_chunksize=None)
    return bytes(sink.getvalue().to_pybytes())


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The campaign sailed in this process, in one shard."""
    folder = tmp_path_factory.mktemp("plain") / "out"
    (only,) = campaign.run(campaign.Specification.parse(SPEC), out=folder)
    assert (only.number, only.of, only.rows, only.there, only.faults) == (1, 1, ROWS, 0, 0)
    assert only.path == folder and only.seconds > 0
    return folder


def test_a_specification_says_what_it_is(
    spec: campaign.Specification, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert (spec.name, spec.seed, spec.rows, spec.strata) == ("tests", 3, ROWS, ["head-on", "give-way"])
    (tmp_path / "spec.toml").write_text(SPEC)
    monkeypatch.chdir(tmp_path)
    read = campaign.Specification.read("spec.toml")
    # workers run elsewhere
    assert read._folder == tmp_path
    again = pickle.loads(pickle.dumps(read))
    assert again.hash == read.hash == spec.hash and len(spec.hash) == 64
    assert again.text == SPEC and repr(again) == "<searoom.campaign.Specification \"tests\", 60 rows>"


def test_documents_are_those_of_the_command(plain: Path) -> None:
    counted = campaign.summarise(plain)
    assert counted["format"].startswith("searoom-campaign") and counted["rows_there"] == ROWS
    assert counted["all"]["rows"] == ROWS and counted["all"]["contact"]["exact"][1] > 0
    row = counted["worst"][0]["row"]
    again = campaign.replay(plain, row)
    assert again.differing == [] and again.document["format"].startswith("searoom-simulation")
    least = again.document["targets"][0]["least_clearance_m"]
    assert least == counted["worst"][0]["clearance_m"]


def test_a_second_run_sails_exactly_what_is_missing(
    spec: campaign.Specification, plain: Path, tmp_path: Path
) -> None:
    shards = list(campaign.run(spec, out=tmp_path, shards=SHARDS, threads=1))
    assert [shard.number for shard in shards] == list(range(1, SHARDS + 1))
    assert {shard.rows for shard in shards} == {ROWS // SHARDS}
    before = {part: part.stat().st_mtime_ns for part in (tmp_path / "parts").iterdir()}
    gone = sorted(before)[4]
    gone.unlink()
    assert campaign.replay(tmp_path, 21).differing is None
    again = list(campaign.run(spec, out=tmp_path, shards=SHARDS))
    assert [shard.number for shard in again if shard.rows] == [5]
    assert sum(shard.there for shard in again) == ROWS - ROWS // SHARDS
    after = {part: part.stat().st_mtime_ns for part in (tmp_path / "parts").iterdir()}
    assert after.keys() == before.keys()
    assert [part for part in after if after[part] != before[part]] == [gone]
    assert table(tmp_path) == table(plain)


def test_a_damaged_part_is_said_and_sailed_again(spec: campaign.Specification, tmp_path: Path) -> None:
    list(campaign.run(spec, out=tmp_path, shards=SHARDS))
    part = sorted((tmp_path / "parts").iterdir())[0]
    part.write_bytes(part.read_bytes()[:-9])
    with pytest.raises(searoom.SearoomError, match=part.name):
        campaign.summarise(tmp_path)
    with pytest.warns(RuntimeWarning, match="sailed again"):
        again = list(campaign.run(spec, out=tmp_path, shards=SHARDS))
    assert [shard.number for shard in again if shard.rows] == [1]


def test_ctrl_c_keeps_what_was_sailed(plain: Path, tmp_path: Path) -> None:
    file = tmp_path / "spec.toml"
    file.write_text(SPEC.replace(f"rows = {ROWS}", "rows = 100000"))
    shards = campaign.run(file, out=tmp_path / "out", threads=1)
    timer = threading.Timer(0.7, os.kill, [os.getpid(), signal.SIGINT])
    timer.start()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        next(shards)
    assert time.monotonic() - begun < 5.0
    there = campaign.summarise(tmp_path / "out")["rows_there"]
    assert 0 < there < 1000


def test_the_lock_is_released_while_sailing(spec: campaign.Specification, tmp_path: Path) -> None:
    counted = 0
    thread = threading.Thread(target=lambda: list(campaign.run(spec, out=tmp_path)))
    thread.start()
    while thread.is_alive():
        time.sleep(0.001)
        counted += 1
    assert counted > 50


def test_dask_is_not_imported_by_the_package() -> None:
    code = "import sys, searoom.campaign; print('dask' in sys.modules, 'distributed' in sys.modules)"
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, text=True)
    assert printed.stdout == "False False\n"


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"shards": 0}, f"shards: found 0; allowed: a whole number from 1 to {ROWS}"),
    ({"shards": ROWS + 1}, "shards: found 61; allowed"),
    ({"shards": 2.5}, "shards: found 2.5; allowed"),
    ({"threads": 0}, "threads: found 0; allowed"),
    ({"threads": True}, "threads: found True; allowed"),
]


@pytest.mark.parametrize(("given", "text"), WRONG, ids=[text for _, text in WRONG])
def test_what_is_wrong_is_named_before_anything_is_sailed(
    spec: campaign.Specification, tmp_path: Path, given: dict[str, Any], text: str
) -> None:
    with pytest.raises(searoom.InputError, match=text) as caught:
        campaign.run(spec, out=tmp_path / "out", **given)
    assert caught.value.faults[0]["path"] in text
    assert not (tmp_path / "out").exists()


def test_errors_are_those_of_the_command(plain: Path, tmp_path: Path) -> None:
    with pytest.raises(searoom.InputError, match="seed: found nothing") as caught:
        campaign.Specification.parse('name = 3\nrows = 0\n[[strata]]\nclass = "ferry"')
    assert len(caught.value.faults) >= 4
    other = campaign.Specification.parse(SPEC.replace("seed = 3", "seed = 4"))
    with pytest.raises(searoom.InputError, match="or another folder for --out"):
        campaign.run(other, out=plain)
    for call in (campaign.summarise, campaign.merge, lambda folder: campaign.replay(folder, 0)):
        with pytest.raises(searoom.SearoomError, match="campaign.json: cannot be read"):
            call(tmp_path / "nowhere")
    with pytest.raises(searoom.InputError, match=f"row: found {ROWS}; allowed: a row from 0 to"):
        campaign.replay(plain, ROWS)
    part = next(campaign.run(campaign.Specification.parse(SPEC), out=tmp_path / "some", shards=6))
    assert part.rows == 10
    with pytest.raises(searoom.InputError, match="found no rows 10 to 59"):
        campaign.merge(tmp_path / "some")


# with Dask


def test_a_worker_that_sees_other_files_is_named(spec: campaign.Specification, tmp_path: Path) -> None:
    place = (spec.text, spec._folder, spec.hash)
    with pytest.raises(searoom.InputError, match="out: found .*a folder that all workers see"):
        campaign._on_worker((place, 1, 2, tmp_path, 1))
    with pytest.raises(searoom.InputError, match="the same files on all workers"):
        campaign._on_worker(((spec.text, spec._folder, "0" * 64), 1, 2, tmp_path, 1))


@pytest.fixture
def cluster() -> Iterator[Any]:
    """A scheduler and two worker processes with one thread each."""
    distributed = pytest.importorskip("distributed")
    dask = pytest.importorskip("dask")
    settings = {
        "distributed.worker.multiprocessing-method": "spawn",
    }
    with (
        dask.config.set(settings),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
    ):
        yield cluster


def test_a_killed_worker_loses_no_row(
    cluster: Any, spec: campaign.Specification, plain: Path, tmp_path: Path
) -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.Client(cluster) as client:
        pids = client.run(os.getpid)
        assert len(set(pids.values())) == 2 and os.getpid() not in pids.values()
        shards = campaign.run(spec, out=tmp_path, shards=SHARDS, client=client)
        ended = [next(shards), next(shards)]
        os.kill(next(iter(pids.values())), signal.SIGKILL)
        ended += list(shards)
        assert sorted(shard.number for shard in ended) == list(range(1, SHARDS + 1))
        # a shard whose worker is killed after the part is written has its rows twice over
        assert all(shard.rows + shard.there == ROWS // SHARDS for shard in ended)
        assert table(tmp_path) == table(plain)
        gone = sorted((tmp_path / "parts").iterdir())[7]
        gone.unlink()
        again = list(campaign.run(spec, out=tmp_path, shards=SHARDS, client=client))
        assert [shard.number for shard in again if shard.rows] == [8]
        assert table(tmp_path) == table(plain)


def test_what_is_wrong_with_a_cluster_is_named(
    cluster: Any, spec: campaign.Specification, tmp_path: Path
) -> None:
    distributed = pytest.importorskip("distributed")

    def refused(text: str, client: Any, out: Path = tmp_path / "out") -> None:
        with pytest.raises(searoom.SearoomError, match=text):
            list(campaign.run(spec, out=out, shards=2, client=client))

    refused("scheduler.json, which is not there; allowed:", tmp_path / "scheduler.json")
    refused("client: found 3; allowed: a distributed.Client", 3)
    (tmp_path / "old.json").write_text('{"address": "tcp://127.0.0.1:1"}')
    with pytest.importorskip("dask").config.set({"distributed.comm.timeouts.connect": "1s"}):
        refused("old.json: .*allowed: a scheduler that runs", tmp_path / "old.json")
    with distributed.Client(cluster) as client:
        # as on a worker without the package
        client.run(lambda: sys.modules.update({"searoom": None}))
        refused("worker: found .*cannot import searoom", client)
        client.run(lambda: sys.modules.pop("searoom"))
        client.run(lambda: setattr(__import__("searoom"), "__version__", "0.0.1"))
        refused(r"worker: found .*searoom 0\.0\.1; allowed: searoom", client)
    refused("client: found one that is closed", client)


def test_a_scheduler_that_goes_away_is_named(
    cluster: Any, spec: campaign.Specification, tmp_path: Path
) -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.Client(cluster) as client:
        shards = campaign.run(spec, out=tmp_path, shards=SHARDS, client=client)
        next(shards)
        client.close()
        with pytest.raises(searoom.SearoomError, match="the same call goes on"):
            list(shards)
