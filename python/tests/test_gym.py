"""Tests of the Gymnasium environment."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import searoom
from searoom import campaign

gymnasium = pytest.importorskip("gymnasium")

import searoom.gym  # noqa: E402  it needs gymnasium

ROOT = Path(__file__).parents[2]
GIVE_WAY = ROOT / "scenarios/colregs/give-way.toml"
# targets that use all that their sets allow, seen exactly
SPEC = """
name = "shielded"
seed = 11
rows = 1000
horizon_s = 1000
path_length_m = 2500
own_ship = { speed_mps = 5, length_m = 30, beam_m = 8, turning_radius_m = 100, speeds_mps = [2.5, 5, 6], safety_margin_m = 20 }
simulation = { duration_s = 500 }
strata = [
    { name = "head-on", class = "head-on", behaviour = { kind = "extremes" } },
    { name = "give-way", class = "give-way", behaviour = { kind = "extremes" } },
    { name = "stand-on", class = "stand-on", behaviour = { kind = "pursuit" } },
    { name = "overtaking", class = "overtaking", behaviour = { kind = "extremes" } },
    { name = "overtaken", class = "overtaken", behaviour = { kind = "extremes" } },
]
"""
EPISODES = 300


def environment(**settings: Any) -> searoom.gym.Encounters:
    return searoom.gym.Encounters(campaign.Specification.parse(SPEC), **settings)


def sail(env: searoom.gym.Encounters, row: int, masked: bool) -> dict[str, Any]:
    """An agent that chooses at random among what is allowed, or among everything."""
    chooses = np.random.default_rng(row)
    _, info = env.reset(seed=row, options={"row": row})  # a scenario has no rows
    shielded, total, over = info["shielded"], 0.0, False
    while not over:
        allowed = env.action_masks() if masked else np.ones(1 + len(env.alterations), bool)
        # an action is held for a while, as agents do
        action = chooses.choice(np.flatnonzero(allowed)) if chooses.random() < 0.3 else 0
        if not allowed[action]:
            action = chooses.choice(np.flatnonzero(allowed))
        _, reward, contact, truncated, _ = env.step(action)
        total += reward
        over = contact or truncated
        # an action that was allowed may be held
        assert not (masked and shielded) or over or env.action_masks()[0]
    assert -2.0 <= total <= 0.0 and (total <= -1.0) >= contact
    return {"contact": contact, "shielded": shielded, "record": env.simulation.record()}


def test_an_agent_that_obeys_has_no_contact_and_one_that_does_not_has() -> None:
    env = environment()
    obeys = [sail(env, row, masked=True) for row in range(EPISODES)]
    assert sum(one["shielded"] for one in obeys) > 0.95 * EPISODES
    for one in obeys:
        if one["shielded"]:
            (target,) = one["record"]["targets"]
            assert target["outside_sets"] == 0
            assert target["least_clearance_m"] >= 20.0 - 1e-6 and not one["contact"]
            assert one["record"]["contact"] is False and one["record"]["safe"]
    free = [sail(env, row, masked=False) for row in range(EPISODES)]
    assert sum(one["contact"] for one in free) >= 3
    assert all(one["contact"] == one["record"]["contact"] for one in free)


def test_the_environment_is_one_of_gymnasium() -> None:
    from gymnasium.utils.env_checker import check_env

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*not have a render_mode.*|.*spec.*|.*render.*")
        check_env(environment(), skip_render_check=True)
        check_env(searoom.gym.Encounters(searoom.Scenario.read(GIVE_WAY)), skip_render_check=True)
        made = gymnasium.make(
            "searoom/Encounters-v0", encounters=campaign.Specification.parse(SPEC), targets=2
        )
        check_env(made.unwrapped, skip_render_check=True)
    assert made.observation_space.shape == (20,)


def test_seeds_decide_the_episode() -> None:
    env = environment()
    rows = [env.reset(seed=seed)[1]["row"] for seed in (1, 1, 2)]
    assert rows[0] == rows[1] != rows[2]
    assert env.reset()[1]["row"] != rows[2]
    noisy = searoom.gym.Encounters(
        searoom.Scenario.read(ROOT / "scenarios/closed-loop/head-on-radar.toml")
    )
    first, again, other = (noisy.reset(seed=seed)[0] for seed in (1, 1, 2))
    assert (first == again).all() and (first != other).any()


def test_observations_and_rewards_are_as_documented() -> None:
    env = searoom.gym.Encounters(searoom.Scenario.read(GIVE_WAY), targets=2)
    seen, _ = env.reset(seed=0)
    simulation = env.simulation
    own, target = simulation.own, simulation.targets["target"]
    assert seen[:2] == pytest.approx([0.0, 0.0], abs=1e-9)
    assert seen[2:8] == pytest.approx([0, 1, own.speed_mps / simulation.max_speed_mps] * 2, abs=1e-6)
    assert own.course_deg == 90.0  # so ahead is east and starboard is south
    assert seen[11:13] == pytest.approx([target.east_m / 5e3, -target.north_m / 5e3], abs=1e-6)
    course = np.radians(target.course_deg)
    moving = target.speed_mps * np.array([np.sin(course), -np.cos(course)]) / 20
    assert seen[10] == 1.0 and seen[13:15] == pytest.approx(moving, abs=1e-6)
    assert (seen[15:] == 0.0).all()
    index = 1 + np.flatnonzero((env.alterations == [90.0, 1.0]).all(axis=1))[0]
    seen, reward, _, _, info = env.step(index)
    assert simulation.time_s == info["t_s"] == 10.0
    own, desired = simulation.own, simulation.desired
    off = np.array([own.east_m - desired.east_m, own.north_m - desired.north_m])
    assert seen[:2] == pytest.approx([off[0] / 5e3, -off[1] / 5e3], abs=1e-6)
    assert reward == pytest.approx(-(off @ off) / 1e6 * 10 / simulation.duration_s)
    assert seen[5:8] == pytest.approx([1.0, 0.0, 1.0], abs=1e-6)
    assert own.speed_mps == simulation.max_speed_mps
    # it turns at its turning radius
    way = 10 * own.speed_mps / 100.0
    assert own.course_deg == pytest.approx(90.0 + np.degrees(way), abs=1e-6)


def test_masks_are_those_of_the_sets() -> None:
    env = searoom.gym.Encounters(searoom.Scenario.read(GIVE_WAY))
    env.reset(seed=0)
    mask = env.action_masks()
    straight_on = 1 + np.flatnonzero((env.alterations == [0.0, 1.0]).all(axis=1))[0]
    assert mask.shape == (1 + len(env.alterations),) and mask.any()
    assert not mask[0] and not mask[straight_on]


def test_what_is_wrong_is_named() -> None:
    values = {
        "decision_s: found nan; allowed: 0.1 to 3600": {"decision_s": float("nan")},
        "courses_deg: found 200": {"courses_deg": [200]},
        r"speeds: found 1.5; allowed: 0 to 1": {"speeds": [1.5]},
        "targets: found -1": {"targets": -1},
    }
    for text, settings in values.items():
        with pytest.raises(searoom.InputError, match=text):
            environment(**settings)
    env = environment()
    with pytest.raises(searoom.InputError, match="allowed: after reset"):
        env.step(0)
    env.reset(seed=0)
    with pytest.raises(searoom.InputError, match="action: found 40; allowed: 0 to 39"):
        env.step(40)
    with pytest.raises(searoom.InputError, match="row: found 1000; allowed"):
        env.reset(options={"row": 1000})
    simulation = env.simulation
    for wrong in ([np.nan, 1.0], [0.0, -1.0], [0.0, 99.0]):
        with pytest.raises(searoom.InputError, match="allowed"):
            simulation.command(*wrong)
    with pytest.raises(searoom.InputError, match=r"commands\[0\]: found 1 numbers"):
        simulation.clear_commands([[1.0]])
    planned = searoom.Simulation(searoom.Scenario.read(GIVE_WAY))
    with pytest.raises(searoom.InputError, match="found one that plans"):
        planned.command(0.0, 1.0)


def test_land_is_kept_clear_of_too() -> None:
    file = ROOT / "scenarios/harbour/munkholmen.toml"
    env = searoom.gym.Encounters(searoom.Scenario.read(file), courses_deg=[-90, 0, 90])
    obeys = sail(env, 0, masked=True)
    assert obeys["shielded"] and not obeys["contact"] and obeys["record"]["land"]["least_m"] > 0.0
    env.reset(seed=0)
    port = 3
    assert env.alterations[port - 1].tolist() == [-90.0, 1.0] and not env.action_masks()[port]
    over = contact = False
    while not over:
        _, _, contact, truncated, _ = env.step(port)
        over = contact or truncated
    assert contact and env.simulation.record()["land"]["grounded"]
