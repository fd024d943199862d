"""Types of the native part."""

from collections.abc import Iterable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, final

import numpy as np
import pandas
import xarray
from numpy.typing import ArrayLike, NDArray

from searoom._views import Samples, ShipState

__all__ = [
    "DocumentError",
    "InputError",
    "InternalError",
    "NoPlanError",
    "Plan",
    "Scenario",
    "SearoomError",
    "Simulation",
    "Specification",
    "__version__",
    "_replay",
    "assess",
    "compare",
    "merge",
    "plan",
    "summarise",
    "verify",
]

__version__: str

class SearoomError(ValueError):
    """Something that Searoom cannot use. The text names the place, what was found and what is
    allowed."""

class InputError(SearoomError):
    """A scenario or an argument that is wrong.

    `faults` has a dict with `path`, `found`, `allowed` and `line` for each fault.
    """

    faults: list[dict[str, Any]]

class DocumentError(SearoomError):
    """A document that cannot be read, or does not fit."""

class NoPlanError(SearoomError):
    """There is no plan. The text is the reason."""

class InternalError(SearoomError):
    """A fault of Searoom itself. Please report it."""

@final
class Scenario:
    """A checked scenario. It never changes; `replace` makes another."""

    @staticmethod
    def read(file: str | PathLike[str], **assumed: float) -> Scenario:
        """Reads a scenario file, or a file of another program with one situation.

        `assumed` are values that such files do not have: `speed_spread_mps`,
        `course_spread_deg`, `margin_m`, `length_m`, `beam_m`.
        """
    @staticmethod
    def read_all(file: str | PathLike[str], **assumed: float) -> list[Scenario]:
        """Reads every situation of a file."""
    @staticmethod
    def parse(text: str, folder: str | PathLike[str] | None = None) -> Scenario:
        """Reads the text of a scenario file. Its map is searched from `folder`, by default
        from where the program runs."""
    @staticmethod
    def from_dict(values: dict[str, Any], folder: str | PathLike[str] | None = None) -> Scenario:
        """A scenario of a dict with the keys of a scenario file. Arrays count as lists."""
    def replace(
        self,
        *,
        planner: str | None = None,
        search: str | None = None,
        compliance: str | None = None,
        max_risk: float | None = None,
        deadline_s: float | None = None,
        seed: int | None = None,
    ) -> Scenario:
        """The scenario with other settings, as the options of the command line do it."""
    def to_dict(self) -> dict[str, Any]:
        """The scenario as a dict with the keys of a scenario file, without the settings of `replace`: what
        `from_dict` reads."""
    def with_targets(self, targets: Iterable[dict[str, Any]]) -> Scenario:
        """The scenario with these targets in place of its own, each a dict with the keys of a scenario file,
        and with the settings of `replace`."""
    def __reduce__(self) -> tuple[Any, tuple[str, Path, dict[str, Any], list[str]]]: ...
    @staticmethod
    def _restored(text: str, folder: str | PathLike[str], notes: list[str]) -> Scenario:
        """The scenario of a pickle."""
    @property
    def text(self) -> str:
        """The scenario as the text of a scenario file, without the settings of `replace`."""
    @property
    def title(self) -> str: ...
    @property
    def planner(self) -> str: ...
    @property
    def compliance(self) -> str: ...
    @property
    def horizon_s(self) -> float: ...
    @property
    def targets(self) -> list[str]:
        """The names of the targets."""
    @property
    def notes(self) -> list[str]:
        """The assumptions made for an imported file."""

@final
class Plan:
    """The answer of a planner, with its independent check. It never changes."""

    @property
    def scenario(self) -> Scenario: ...
    @property
    def document(self) -> dict[str, Any]:
        """The plan document. A new dict each time."""
    @property
    def outcome(self) -> str: ...
    @property
    def verdict(self) -> str:
        """The word for the outcome: `solved`, `relaxed`, `at risk 0.20`, `NOT SAFE`, …"""
    @property
    def reason(self) -> str | None: ...
    @property
    def verified(self) -> bool:
        """True where the document is what it claims."""
    @property
    def safe(self) -> bool:
        """True where no hard set, hull or land is entered from start to arrival."""
    @property
    def plan_s(self) -> float:
        """Seconds that planning took."""
    @property
    def _library_s(self) -> float:
        """Seconds of the library for this plan, its check and its document."""
    @property
    def cost(self) -> dict[str, Any] | None: ...
    @property
    def relaxations(self) -> list[dict[str, Any]]: ...
    @property
    def encounters(self) -> list[dict[str, Any]]: ...
    def sample(self, times_s: ArrayLike | None = None) -> Samples:
        """Own ship at these times, by default every second and at every joint.

        Raises `NoPlanError` without a plan.
        """
    def sections(self, time_s: float) -> dict[str, NDArray[np.float64]]:
        """The sets that were planned against at a time: target → vertices, shape (n, 2), metres,
        counter-clockwise. Ellipses are given by a polygon around them."""
    def to_json(self) -> str:
        """The plan document as the command line writes it."""
    def save(self, file: str | PathLike[str]) -> None:
        """Writes the plan document. The file is whole or unchanged."""
    def _repr_html_(self) -> str:
        """For notebooks: a chart from above, and the text."""
    def to_dataframe(self) -> pandas.DataFrame:
        """The samples as a table, indexed by time. Needs pandas."""
    def to_xarray(self) -> xarray.Dataset:
        """The samples as a dataset with units. Needs xarray."""

@final
class Simulation:
    """A scenario that is sailed step by step in the closed loop.

    With `commanded` own ship does not plan: it holds course and speed until `command`.
    """

    def __new__(
        cls, scenario: Scenario, *, measured_delay: bool = False, commanded: bool = False
    ) -> Simulation: ...
    @property
    def finished(self) -> bool: ...
    @property
    def time_s(self) -> float: ...
    @property
    def own(self) -> ShipState: ...
    @property
    def targets(self) -> dict[str, ShipState]:
        """The true states of the targets."""
    @property
    def estimates(self) -> dict[str, ShipState]:
        """The states of the targets as own ship's sensors and tracker have them."""
    @property
    def desired(self) -> ShipState:
        """Where the desired trajectory has own ship now."""
    @property
    def duration_s(self) -> float:
        """The end of the simulation."""
    @property
    def max_speed_mps(self) -> float:
        """The largest speed of a command."""
    def contact(self, since_s: float = 0.0) -> bool:
        """True where own hull has touched a target's, or land since `since_s`."""
    def command(self, course_deg: float, speed_mps: float) -> None:
        """From now on own ship turns to a course, the shorter way at its turning radius, and holds
        course and speed. Only where `commanded`. The speed changes at once, as in plans."""
    def clear_commands(self, commands: ArrayLike) -> NDArray[np.bool_]:
        """For the command that own ship follows, and for each row of a course and a speed: true
        where it keeps own ship clear of the hard set of every target, and of land, to the end of
        the simulation. The first entry is that of the command that is followed."""
    def step(self) -> None:
        """Moves all ships on to the next step or event. Without effect once finished."""
    def run(self) -> None:
        """Steps until it is finished. Ctrl-C interrupts between two steps."""
    def record(self) -> dict[str, Any]:
        """The simulation document so far."""

@final
class Specification:
    """A checked specification of a campaign. It never changes."""

    @staticmethod
    def read(file: str | PathLike[str]) -> Specification:
        """Reads a specification file (docs/guide/campaigns.md). The error has every fault."""
    @staticmethod
    def parse(text: str, folder: str | PathLike[str] | None = None) -> Specification:
        """Reads the text of a specification. Its scenario files are searched from `folder`, by
        default from where the program runs."""
    @property
    def name(self) -> str: ...
    @property
    def seed(self) -> int: ...
    @property
    def rows(self) -> int: ...
    @property
    def hash(self) -> str:
        """SHA-256 of its text and of all that it names, in hexadecimal digits."""
    @property
    def text(self) -> str: ...
    @property
    def strata(self) -> list[str]:
        """The names of the strata."""
    @property
    def _folder(self) -> Path:
        """Where its scenario files are."""
    def simulation(self, row: int, *, commanded: bool = False) -> Simulation:
        """The simulation of a row, from 0 on. `commanded` is that of `Simulation`."""
    def _prepare(self, out: str | PathLike[str]) -> None:
        """Makes the folder of a campaign, or checks that it is of this specification."""
    def _sail(
        self, number: int, of: int, out: str | PathLike[str], threads: int | None
    ) -> dict[str, int]:
        """Sails the rows of a shard that are not in the folder yet. Ctrl-C finishes the rows under
        way."""

def plan(scenario: Scenario, *, previous: Plan | dict[str, Any] | str | PathLike[str] | None = None) -> Plan:
    """Plans a scenario.

    `previous` is the plan that own ship follows: a plan, its document as dict or text, or a file.
    The roles, sets and manoeuvres that it began go on.
    """

def verify(document: Plan | dict[str, Any] | str | PathLike[str]) -> dict[str, Any]:
    """Checks a plan or simulation document from its own content, without the planner."""

def assess(
    scenario: Scenario,
    *,
    points: ArrayLike | Sequence[Sequence[float]] | None = None,
    velocities: ArrayLike | Sequence[Sequence[float]] | None = None,
    sections_s: ArrayLike | None = None,
    domains: bool = False,
) -> dict[str, Any]:
    """Risk, closest approach and the least alteration, without planning.

    `points` are rows of east, north and time, `velocities` rows of east and north, `sections_s`
    times of the sets. With `domains` the sets include the ship domains.
    """

def compare(
    scenario: Scenario, *, max_risks: ArrayLike | None = None, bound: bool = False
) -> dict[str, Any]:
    """Every planner that applies and two baselines on one scenario, at each accepted risk.

    With `bound` each plan also has a lower bound of J around the sets of its method, which takes
    some seconds.
    """

def summarise(
    folder: str | PathLike[str], *, allow_other_builds: bool = False
) -> dict[str, Any]:
    """Counts the rows of a campaign that are there, with bounds on each probability.

    `folder` is that of the campaign. Returns the document of `searoom campaign summarise --json`.
    """

def merge(folder: str | PathLike[str], *, allow_other_builds: bool = False) -> Path:
    """Joins all parts of a campaign as `campaign.parquet` in its folder, and returns that file.

    Damaged, foreign, missing and double rows are refused; the error names them.
    """

def _replay(folder: str | PathLike[str], row: int) -> tuple[dict[str, Any], list[str] | None]:
    """The simulation document of a row that is sailed again, and the columns of the kept row from
    which it differs."""
