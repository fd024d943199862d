"""Tests of the adapters in `python/examples`. Those of another simulator need it on the path."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import searoom
from searoom import ShipState

EXAMPLES = Path(__file__).parents[1] / "examples"
OWN = {
    "length_m": 30.0,
    "beam_m": 8.0,
    "turning_radius_m": 100.0,
    "speeds_mps": [2.5, 5.0, 6.0],
    "safety_margin_m": 20.0,
    "tracking_margin_m": 10.0,
}
MISSION = [(0.0, 0.0), (1500.0, 0.0)]


@pytest.fixture(autouse=True)
def on_path(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(EXAMPLES))


def test_a_plan_from_python_takes_as_long_as_that_of_the_library() -> None:
    import overhead

    scenarios = Path(__file__).parents[2] / "scenarios" / "colregs"
    head_on = searoom.Scenario.read(scenarios / "head-on.toml")
    library, beyond = overhead.overhead(head_on, calls=50)
    assert library > 0.0 and beyond > 0.0


def sail(
    steer: Callable[[float, ShipState, ShipState], tuple[float, float]], target: ShipState
) -> tuple[float, float, list[float]]:
    """Own ship with a rate of turn and a lag, eastwards among one target: the least distance of the
    centres, the distance to the goal at the end, and the courses."""
    east, north, course, speed = 0.0, 0.0, 90.0, 5.0
    other, least, courses = target, math.inf, []
    for second in range(360):
        own = ShipState(east, north, course, speed)
        wanted, ordered = steer(float(second), own, other)
        courses.append(course)
        turn = (wanted - course + 180.0) % 360.0 - 180.0
        most = math.degrees(speed / 80.0)
        course += max(-most, min(most, turn))
        speed += (ordered - speed) / 3.0
        east += speed * math.sin(math.radians(course))
        north += speed * math.cos(math.radians(course))
        ahead = math.radians(other.course_deg)
        other = other._replace(
            east_m=other.east_m + other.speed_mps * math.sin(ahead),
            north_m=other.north_m + other.speed_mps * math.cos(ahead),
        )
        least = min(least, math.hypot(other.east_m - east, other.north_m - north))
        if math.dist((east, north), MISSION[-1]) < 30.0:
            break
    return least, math.dist((east, north), MISSION[-1]), courses


HEAD_ON = ShipState(1500.0, 0.0, 270.0, 5.0)
CROSSING = ShipState(750.0, -750.0, 0.0, 5.0)


def passes(found: tuple[float, float, list[float]]) -> None:
    least, left, courses = found
    # it alters to starboard by at least 25°, passes, and arrives
    assert least > 70.0 and left < 30.0
    assert max(courses) > 115.0


@pytest.mark.parametrize("target", [HEAD_ON, CROSSING], ids=["head-on", "crossing"])
def test_a_replanner_passes_and_arrives(target: ShipState) -> None:
    from replanner import Replanner, Target

    replanner = Replanner(OWN, spreads={"speed_spread_mps": 0.3, "course_spread_deg": 3.0})

    def steer(time: float, own: ShipState, other: ShipState) -> tuple[float, float]:
        targets = [Target("other", *other, 60.0, 12.0)]
        return replanner.steer(time, own, MISSION, [5.0], targets)

    passes(sail(steer, target))
    assert replanner.plan is not None and replanner.plan.document["memory"] is not None
    replanner.reset()
    assert replanner.steer(0.0, ShipState(0.0, 0.0, 90.0, 5.0), MISSION, [5.0], [])[0] == pytest.approx(90.0)


def test_an_agent_of_vesselnav_bench() -> None:
    base = pytest.importorskip("src.agents.base", reason="needs a clone of VesselNav-Bench")
    from vesselnav_bench import SearoomAgent

    config = SimpleNamespace(
        world=SimpleNamespace(cell_size=10.0),
        vessel=SimpleNamespace(cruise_speed=0.5, max_speed=0.8),
        simulation=SimpleNamespace(collision_radius=2.0),
    )
    agent = SearoomAgent(config)
    assert isinstance(agent, base.Agent) and agent.metadata()["name"] == "searoom"

    def cells(ship: ShipState) -> dict[str, float]:
        heading = math.radians(90.0 - ship.course_deg)
        speed = ship.speed_mps / 10.0
        return {"x": ship.east_m / 10.0, "y": ship.north_m / 10.0, "heading": heading, "speed": speed}

    def observe(time: float, own: ShipState, other: ShipState) -> Any:
        return SimpleNamespace(
            t=time,
            vessel=cells(own),
            obstacles=[{"id": 1, **cells(other)}],
            goal=(150.0, 0.0),
            position=(own.east_m / 10.0, own.north_m / 10.0),
        )

    def steer(time: float, own: ShipState, other: ShipState) -> tuple[float, float]:
        observation = observe(time, own, other)
        if time == 0.0:
            agent.reset(observation)
        decision = agent.decide(observation)
        assert isinstance(decision, base.Decision) and decision.to_record()["verdict"]
        return 90.0 - math.degrees(decision.desired_heading), 10.0 * decision.desired_speed

    passes(sail(steer, CROSSING))


def test_a_planner_of_colav_simulator(monkeypatch: pytest.MonkeyPatch) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    # its charts ask for a window
    monkeypatch.setattr(matplotlib, "use", lambda *_, **__: None)
    ci = pytest.importorskip(
        "colav_simulator.core.colav.colav_interface", reason="needs colav-simulator"
    )
    from colav_simulator_planner import SearoomPlanner

    planner = SearoomPlanner(turning_radius_m=100.0, safety_margin_m=20.0)
    assert isinstance(planner, ci.ICOLAV) and planner.get_current_plan().shape == (9, 1)
    waypoints = np.array([[n, e] for e, n in MISSION]).T

    def steer(time: float, own: ShipState, other: ShipState) -> tuple[float, float]:
        state = [own.north_m, own.east_m, math.radians(own.course_deg), own.speed_mps, 0.0, 0.0]
        course = math.radians(other.course_deg)
        velocity = [other.speed_mps * math.cos(course), other.speed_mps * math.sin(course)]
        seen = np.array([other.north_m, other.east_m, *velocity])
        references = planner.plan(
            time,
            waypoints,
            np.array([5.0, 5.0]),
            np.array(state),
            [(1, seen, np.diag([1.0, 1.0, 0.01, 0.01]), 60.0, 12.0)],
            os_length=30.0,
            os_width=8.0,
            os_draft=2.0,
        )
        assert references.shape == (9, 1)
        return math.degrees(references[2, 0]), float(references[3, 0])

    passes(sail(steer, HEAD_ON))
    plan = planner.get_current_plan()
    assert plan.shape[0] == 9 and plan.shape[1] > 10
    assert planner.get_colav_data()["nominal_trajectory"].shape[0] == 6
    planner.reset()
    assert planner.get_current_plan().shape == (9, 1)
