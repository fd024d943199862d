"""Campaigns: many random encounters sailed in the closed loop, in this process or by Dask.

>>> from searoom import campaign
>>> for shard in campaign.run("spec.toml", shards=400, out="sailed", client=client):
...     print(shard.number, shard.rows, shard.seconds)
>>> campaign.summarise("sailed")["all"]["contact"]

`docs/guide/campaigns.md` describes campaigns, `docs/reference/campaign-files.md` keys and columns.
A row is the same wherever it is sailed. A run goes on where another one ended: rows that are there
are not sailed again.
"""

from __future__ import annotations

import operator
import os
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from searoom import _searoom
from searoom._searoom import InputError, SearoomError, Specification, merge, summarise

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["Replay", "Shard", "Specification", "merge", "replay", "run", "summarise"]


@dataclass(frozen=True, slots=True)
class Shard:
    """A shard that has ended."""

    number: int
    """From 1 to `of`."""
    of: int
    """How many shards there are."""
    rows: int
    """Rows that were sailed."""
    there: int
    """Rows that were there before."""
    faults: int
    """Sailed rows at which the program failed; `replay` shows why."""
    seconds: float
    """From its beginning to its end, in seconds."""
    path: Path
    """The folder of the campaign, which has the parts."""


class Replay(NamedTuple):
    """A row that was sailed again."""

    document: dict[str, Any]
    """The simulation document."""
    differing: list[str] | None
    """The columns that are not as in the campaign. Those of the machine are not compared. None
    where the row is not in the campaign."""


def replay(folder: str | os.PathLike[str], row: int) -> Replay:
    """Sails a row of a campaign again, from 0 on, and compares it with the one that is there."""
    return Replay(*_searoom._replay(folder, row))


def run(
    spec: Specification | str | os.PathLike[str],
    *,
    out: str | os.PathLike[str],
    shards: int = 1,
    client: Client | str | os.PathLike[str] | None = None,
    threads: int | None = None,
) -> Iterator[Shard]:
    """Sails a campaign into the folder `out`, and yields each shard as it ends.

    `spec` is a specification or its file. A shard should take 1 to 10 minutes.

    Without a client the shards are sailed in this process, one after another as they are asked
    for, each on `threads` cores, by default all. Ctrl-C finishes the rows that are under way, and
    keeps them.

    With a `distributed.Client`, or a scheduler file, each shard is one task of Dask, and all begin
    at once. All workers have to see `out`. A worker of n threads sails n shards, each on one core,
    or on `threads`. A shard of a worker that is lost is given to another worker, which does what
    is missing. Where the iterator ends early, shards that have not begun are cancelled.
    """
    if not isinstance(spec, Specification):
        spec = Specification.read(spec)
    shards = _count("shards", shards, spec.rows)
    threads = None if threads is None else _count("threads", threads, 1024)
    folder = Path(out).absolute()
    if client is None:
        spec._prepare(folder)
        return (_here(spec, n, shards, folder, threads) for n in range(1, shards + 1))
    return _distributed(spec, shards, folder, client, threads or 1)


def _refused(path: str, found: object, allowed: str) -> InputError:
    error = InputError(f"{path}: found {found}; allowed: {allowed}")
    error.faults = [{"path": path, "found": str(found), "allowed": allowed, "line": None}]
    return error


def _count(name: str, value: int, most: int) -> int:
    try:
        found = operator.index(value)
    except TypeError:
        found = 0
    if isinstance(value, bool) or not 1 <= found <= most:
        raise _refused(name, repr(value), f"a whole number from 1 to {most}")
    return found


def _here(spec: Specification, number: int, of: int, out: Path, threads: int | None) -> Shard:
    begun = time.perf_counter()
    done = spec._sail(number, of, out, threads)
    return Shard(number, of, **done, seconds=time.perf_counter() - begun, path=out)


def _on_worker(arguments: tuple[Any, ...]) -> Shard:
    """One task. The worker has to have the package and the folder."""
    (text, beside, digest), number, of, out, threads = arguments
    spec = Specification.parse(text, beside)
    if spec.hash != digest:
        raise _refused(
            str(beside),
            "scenario files, maps or routes that are others than where the campaign was begun",
            "the same files on all workers",
        )
    if not (out / "campaign.json").exists():
        raise _refused("out", f"{out}, which has no campaign.json", "a folder that all workers see")
    return _here(spec, number, of, out, threads)


def _task() -> Callable[[tuple[Any, ...], str], Any]:
    """The function of a task, which travels by its code: a worker without the package, and a
    scheduler, can read it."""

    def sail(arguments: tuple[Any, ...], version: str) -> Any:
        import socket

        try:
            import searoom
            from searoom import campaign
        except ImportError as error:
            return f"{socket.gethostname()}: cannot import searoom ({error})"
        if searoom.__version__ != version:
            return f"{socket.gethostname()}: searoom {searoom.__version__}"
        return campaign._on_worker(arguments)

    return sail


def _distributed(
    spec: Specification,
    shards: int,
    out: Path,
    client: Client | str | os.PathLike[str],
    threads: int,
) -> Iterator[Shard]:
    try:
        import distributed
    except ImportError as error:
        raise SearoomError(f"client: needs dask, `pip install 'searoom[dask]'` ({error})") from None
    is_own = not isinstance(client, distributed.Client)
    connected: Any = _connected(client) if is_own else client
    if connected.status != "running":
        raise _refused("client", f"one that is {connected.status}", "one with a scheduler")
    try:
        spec._prepare(out)
        place = (spec.text, spec._folder, spec.hash)
        tasks = [(place, n, shards, out, threads) for n in range(1, shards + 1)]
        # the same shard of a later run is another task: it looks again for what is missing
        futures = connected.map(_task(), tasks, version=_searoom.__version__, pure=False)
    except BaseException:
        if is_own:
            connected.close()
        raise
    return _ended(connected, futures, is_own)


def _connected(file: Any) -> Client:
    import distributed

    allowed = "a distributed.Client, or a file that `dask scheduler --scheduler-file` wrote"
    if not isinstance(file, str | os.PathLike):
        raise _refused("client", repr(file), allowed)
    if not Path(file).is_file():
        raise _refused("client", f"{os.fspath(file)}, which is not there", allowed)
    try:
        return distributed.Client(scheduler_file=os.fspath(file), set_as_default=False)
    except (OSError, ValueError, KeyError) as error:
        raise _refused("client", f"{os.fspath(file)}: {error}", "a scheduler that runs") from error


def _ended(client: Client, futures: list[Any], is_own: bool) -> Iterator[Shard]:
    import distributed

    lost = "the same call goes on with what is missing"
    try:
        for future in distributed.as_completed(futures):
            try:
                shard = future.result()
            except distributed.KilledWorker as error:
                raise SearoomError(f"client: a shard ended its workers: {error}; {lost}") from error
            except (OSError, distributed.CancelledError) as error:
                raise SearoomError(f"client: found it cut off from its scheduler; {lost}") from error
            if not isinstance(shard, Shard):
                raise _refused("worker", shard, f"searoom {_searoom.__version__} on every worker")
            yield shard
    finally:
        if client.status == "running":
            client.cancel(futures)
        if is_own:
            client.close()
