"""Results as tuples, tables and figures."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import matplotlib.axes
    import pandas
    import xarray

    from searoom._searoom import Plan, Scenario


class Samples(NamedTuple):
    """Own ship along a plan: arrays of equal length."""

    t_s: NDArray[np.float64]
    east_m: NDArray[np.float64]
    north_m: NDArray[np.float64]
    course_deg: NDArray[np.float64]
    speed_mps: NDArray[np.float64]


class ShipState(NamedTuple):
    """A ship at one time; course and speed are over ground."""

    east_m: float
    north_m: float
    course_deg: float
    speed_mps: float


def simulate(
    scenario: Scenario, *, seed: int | None = None, measured_delay: bool = False
) -> dict[str, Any]:
    """Sails a scenario in the closed loop and returns the simulation document.

    Own ship plans again and again from what its sensors report, and follows its plans. `seed`
    replaces the scenario's. Ctrl-C ends it; use `Simulation` to keep what was sailed so far.
    """
    from searoom._searoom import Simulation

    asked = scenario if seed is None else scenario.replace(seed=seed)
    simulation = Simulation(asked, measured_delay=measured_delay)
    simulation.run()
    return simulation.record()


def restored(text: str, folder: Path, settings: dict[str, Any], notes: list[str]) -> Scenario:
    """The scenario of a pickle."""
    from searoom._searoom import Scenario

    return Scenario._restored(text, folder, notes).replace(**settings)


def with_targets(scenario: Scenario, targets: Iterable[dict[str, Any]]) -> Scenario:
    """The scenario with other targets, and with its settings."""
    from searoom._searoom import Scenario

    _, (_, folder, settings, _) = scenario.__reduce__()
    values = scenario.to_dict() | {"targets": list(targets)}
    return Scenario.from_dict(values, folder).replace(**settings)


def html(plan: Plan) -> str:
    """A plan as a notebook shows it: a chart from above with the sets at the closest approach, and the text.
    Without a plan the text alone."""
    from searoom._searoom import NoPlanError

    text = f"<pre>{escape(str(plan))}</pre>"
    try:
        samples = plan.sample()
    except NoPlanError:
        return text
    time = min(max(closest_approach(plan), 0.0), float(samples.t_s[-1]))
    now = plan.sample([time])
    sections = plan.sections(time)
    ways = plan.document["mission"]["waypoints"]
    way = np.array([[w["east_m"], w["north_m"]] for w in ways])
    track = np.column_stack([samples.east_m, samples.north_m])
    low, high = frame([way, track, *sections.values()])
    size = high - low

    def points(rows: NDArray[np.float64]) -> str:
        # north is up
        return " ".join(f"{east - low[0]:.1f},{high[1] - north:.1f}" for east, north in rows)

    line = 'fill="none" vector-effect="non-scaling-stroke"'
    shapes = [f'<polyline points="{points(way)}" {line} stroke="gray" stroke-dasharray="6 4"/>']
    for name, section in sections.items():
        title = f"<title>{escape(name)} at {time:.0f} s</title>"
        shapes.append(f'<polygon points="{points(section)}" fill="crimson" opacity="0.4">{title}</polygon>')
    shapes.append(f'<polyline points="{points(track)}" {line} stroke="royalblue" stroke-width="2"/>')
    here = points(np.column_stack([now.east_m, now.north_m])).split(",")
    dot = f'r="{0.01 * float(size.max()):.1f}" fill="royalblue"'
    shapes.append(
        f'<circle cx="{here[0]}" cy="{here[1]}" {dot}><title>own ship at {time:.0f} s</title></circle>'
    )
    box = f"0 0 {size[0]:.1f} {size[1]:.1f}"
    style = "max-width: 100%; max-height: 30em"
    chart = f'<svg viewBox="{box}" width="600" style="{style}">{"".join(shapes)}</svg>'
    return f"<div>{chart}{text}</div>"


def frame(
    shapes: Iterable[NDArray[np.float64]],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The south-west and the north-east corner around points, with a margin of a twentieth."""
    rows = np.vstack([shape for shape in shapes if len(shape)])
    low, high = rows.min(axis=0), rows.max(axis=0)
    margin = max(0.05 * float((high - low).max()), 1.0)
    return low - margin, high + margin


def dataframe(samples: Samples) -> pandas.DataFrame:
    """The samples as a table, indexed by time."""
    import pandas

    return pandas.DataFrame(samples._asdict()).set_index("t_s")


def dataset(samples: Samples, title: str) -> xarray.Dataset:
    """The samples as a dataset over time, with units."""
    import xarray

    units = {"east_m": "m", "north_m": "m", "course_deg": "degree", "speed_mps": "m s-1"}
    columns = samples._asdict()
    variables = {
        name: ("t_s", columns[name], {"units": unit}) for name, unit in units.items()
    }
    coords = {"t_s": ("t_s", samples.t_s, {"units": "s"})}
    return xarray.Dataset(variables, coords=coords, attrs={"title": title})


def plot(
    plan: Plan, ax: matplotlib.axes.Axes | None = None, *, at_s: float | None = None
) -> matplotlib.axes.Axes:
    """Draws a plan in the plane with matplotlib, and returns the axes.

    The desired path is dashed, the plan solid. The sets are those at `at_s`, by default the time
    of the closest approach; own ship is marked at that time. New axes are framed by the path, the plan and
    the sets, and not by the land. Raises `NoPlanError` without a plan.
    """
    import matplotlib.pyplot as plt

    is_new = ax is None
    if ax is None:
        ax = plt.subplots(layout="constrained")[1]
    document = plan.document
    way = np.array([[w["east_m"], w["north_m"]] for w in document["mission"]["waypoints"]])
    ax.plot(way[:, 0], way[:, 1], "--", color="0.5", label="desired path")
    for land in document["land"]:
        ax.fill(*np.array(land).T, color="0.85")
    samples = plan.sample()
    ax.plot(samples.east_m, samples.north_m, color="C0", label="plan")
    end = float(samples.t_s[-1])
    time = closest_approach(plan) if at_s is None else at_s
    time = min(max(time, 0.0), end)
    now = plan.sample([time])
    ax.plot(now.east_m, now.north_m, "o", color="C0", label=f"own ship at {time:.0f} s")
    sections = plan.sections(time)
    for index, (name, section) in enumerate(sections.items()):
        ax.fill(*section.T, alpha=0.3, color=f"C{1 + index % 9}", label=f"{name} at {time:.0f} s")
    ax.set(title=f"{document['scenario']}: {plan.verdict}", xlabel="east, m", ylabel="north, m")
    ax.set_aspect("equal", adjustable="box" if is_new else "datalim")
    if is_new:
        track = np.column_stack([samples.east_m, samples.north_m])
        low, high = frame([way, track, *sections.values()])
        ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    ax.legend()
    return ax


def closest_approach(plan: Plan) -> float:
    """Time in seconds at which own ship is nearest to a target that keeps course and speed."""
    meetings = [e for e in plan.encounters if e["dcpa_m"] is not None]
    nearest = min(meetings, key=lambda e: float(e["dcpa_m"]), default=None)
    return 0.0 if nearest is None else float(nearest["tcpa_s"])
