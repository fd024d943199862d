"""A Gymnasium environment: an agent commands course and speed of own ship among other ships.

>>> import gymnasium, searoom.gym
>>> env = gymnasium.make("searoom/Encounters-v0", encounters="spec.toml")
>>> observation, info = env.reset(seed=1)
>>> mask = env.unwrapped.action_masks()

Needs `gymnasium`.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from searoom._searoom import InputError, Scenario, Simulation, Specification
from searoom._views import ShipState

__all__ = ["Encounters"]

FAR_M = 5000.0
FAST_MPS = 20.0
OWN = 10
EACH = 5


class Encounters(gymnasium.Env[NDArray[np.float32], np.int64]):
    """Own ship among the targets of a scenario, or of the rows of a campaign's specification.

    **Episode.** `reset` draws a row of the specification, or new random numbers of the scenario,
    from its seed; `options={"row": i}` chooses the row. It ends where hulls touch or own ship
    touches land (`terminated`), and at the end of the simulation (`truncated`), which is
    `duration_s`, or the horizon.

    **Actions**, one every `decision_s` seconds. 0 holds on to the last command. The others are a
    course and a speed, the rows of `alterations`: degrees to starboard of the desired course, and
    a fraction of own ship's largest speed. Own ship turns at its turning radius.

    **Observation**, numbers from -1 to 1. Ahead and starboard are those of the desired course.
    Distances are in units of 5,000 m, speeds of 20 m/s, own speeds of own ship's largest, and
    what is beyond 1 is cut off.

    - 0, 1: own ship from its desired place, ahead and to starboard;
    - 2, 3, 4: sine and cosine of its course from the desired one, and its speed;
    - 5, 6, 7: those of the last command;
    - 8: the desired speed; 9: the part of the episode that has passed;
    - five for each of `targets`, the nearest first, as own ship's sensors have them: 1 if there is
      one, its place from own ship ahead and to starboard, its velocity ahead and to starboard.

    **Reward** of a step of t seconds in an episode of T: minus t/T times the squared distance from
    the desired place at its end, in km², at most 1, and minus 1 for a contact. The sum is within
    -2 and 0, and a contact is never better than none.

    **Shield.** `action_masks()` is false for actions that would enter a hard set of a target, or
    land, before the end of the episode: those whose course and speed are in a velocity obstacle,
    seen from the end of the turn to them, and those whose turn enters a set. As long as targets
    keep to their sets, are seen exactly, and own ship follows its commands exactly, an action that
    is allowed may be held to the end. So an agent that obeys has no contact, once there was an
    allowed action. `info["shielded"]` says whether there was; without one the mask allows
    action 0 alone.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        encounters: Scenario | Specification | str | os.PathLike[str],
        *,
        decision_s: float = 10.0,
        courses_deg: Sequence[float] = tuple(range(-90, 91, 15)),
        speeds: Sequence[float] = (0.5, 0.75, 1.0),
        targets: int = 4,
    ) -> None:
        """`encounters` is a scenario, a specification, or the file of a specification.
        `courses_deg` and `speeds` make the actions, `targets` is how many are observed."""
        if not isinstance(encounters, Scenario | Specification):
            encounters = Specification.read(encounters)
        self._encounters = encounters
        self._decision_s = _within("decision_s", decision_s, 0.1, 3600.0)
        courses = [_within("courses_deg", c, -180.0, 180.0) for c in courses_deg]
        fractions = [_within("speeds", s, 0.0, 1.0) for s in speeds]
        self._targets = int(_within("targets", targets, 0, 1000))
        self.alterations = np.array([(c, s) for c in courses for s in fractions]).reshape(-1, 2)
        """Courses and speeds of the actions from 1 on."""
        self.action_space = gymnasium.spaces.Discrete(1 + len(self.alterations))
        size = OWN + EACH * self._targets
        self.observation_space = gymnasium.spaces.Box(-1.0, 1.0, (size,), np.float32)
        self._simulation: Simulation | None = None
        self._command = (0.0, 0.0)

    @property
    def simulation(self) -> Simulation:
        """The simulation of this episode; its `record()` is the simulation document."""
        if self._simulation is None:
            raise InputError("simulation: found none; allowed: after reset()")
        return self._simulation

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        super().reset(seed=seed)
        row = None
        if isinstance(self._encounters, Specification):
            row = int(self.np_random.integers(self._encounters.rows))
            row = (options or {}).get("row", row)
            self._simulation = self._encounters.simulation(row, commanded=True)
        else:
            drawn = self._encounters.replace(seed=int(self.np_random.integers(2**52)))
            self._simulation = Simulation(drawn, commanded=True)
        own = self._simulation.own
        self._command = (own.course_deg, own.speed_mps)
        info = {"row": row, "shielded": bool(self._clear().any())}
        return self._observation(), info

    def step(
        self, action: np.int64 | int
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        simulation = self.simulation
        if not self.action_space.contains(np.int64(action)):
            raise InputError(f"action: found {action!r}; allowed: 0 to {len(self.alterations)}")
        if action > 0:
            self._command = self._commands()[int(action) - 1]
            simulation.command(*self._command)
        begun = simulation.time_s
        end = begun + self._decision_s - 1e-6
        contact = False
        while not (simulation.finished or contact or simulation.time_s >= end):
            before = simulation.time_s
            simulation.step()
            contact = simulation.contact(before)
        off = self._off_desired() / 1000.0
        part = (simulation.time_s - begun) / simulation.duration_s
        reward = -part * min(float(off @ off), 1.0) - float(contact)
        over = simulation.finished and not contact
        clear = not (contact or over) and bool(self._clear().any())
        info = {"contact": contact, "shielded": clear, "t_s": simulation.time_s}
        return self._observation(), reward, contact, over, info

    def action_masks(self) -> NDArray[np.bool_]:
        """For each action: true where it is allowed (see the class). Of the name that
        `sb3_contrib.MaskablePPO` asks for."""
        clear = self._clear()
        clear[0] |= not clear.any()
        return clear

    def _clear(self) -> NDArray[np.bool_]:
        return self.simulation.clear_commands(self._commands())

    def _commands(self) -> list[tuple[float, float]]:
        course, most = self.simulation.desired.course_deg, self.simulation.max_speed_mps
        return [(course + float(off), most * float(part)) for off, part in self.alterations]

    def _off_desired(self) -> NDArray[np.float64]:
        own, desired = self.simulation.own, self.simulation.desired
        return np.array([own.east_m - desired.east_m, own.north_m - desired.north_m])

    def _observation(self) -> NDArray[np.float32]:
        simulation = self.simulation
        own, desired, most = simulation.own, simulation.desired, simulation.max_speed_mps
        course = math.radians(desired.course_deg)
        ahead = np.array([math.sin(course), math.cos(course)])
        axes = np.array([ahead, [ahead[1], -ahead[0]]])
        values = [*(axes @ self._off_desired() / FAR_M)]
        for moving, speed in ((own.course_deg, own.speed_mps), self._command):
            turn = math.radians(moving) - course
            values += [math.sin(turn), math.cos(turn), speed / most]
        values += [desired.speed_mps / most, simulation.time_s / simulation.duration_s]

        def from_own(ship: ShipState) -> NDArray[np.float64]:
            return np.array([ship.east_m - own.east_m, ship.north_m - own.north_m])

        others = sorted(
            simulation.estimates.values(), key=lambda ship: float(np.linalg.norm(from_own(ship)))
        )
        for ship in others[: self._targets]:
            moving = math.radians(ship.course_deg)
            velocity = ship.speed_mps * np.array([math.sin(moving), math.cos(moving)])
            values += [1.0, *(axes @ from_own(ship) / FAR_M), *(axes @ velocity / FAST_MPS)]
        observation = np.zeros(self.observation_space.shape or 0, np.float32)
        observation[: len(values)] = np.clip(values, -1.0, 1.0)
        return observation


def _within(name: str, value: float, least: float, most: float) -> float:
    # negated so that a NaN is refused
    if not least <= value <= most:
        raise InputError(f"{name}: found {value!r}; allowed: {least:g} to {most:g}")
    return value


gymnasium.register(id="searoom/Encounters-v0", entry_point="searoom.gym:Encounters")
