"""Searoom as an agent of VesselNav-Bench (github.com/captv89/autonomous-vessel-navigation).

Run it in a clone of that repository, with this folder on `PYTHONPATH`:

    python main.py benchmark --suite benchmarks/v1.yaml --agent vesselnav_bench:SearoomAgent

For open water: the land of a world is not given to the planner. The agent is told the true places
of all ships and no sizes; two ships collide at 20 m between centres.
"""

from __future__ import annotations

import math
from typing import Any

from replanner import Replanner, Target
from src.agents.base import Agent, Decision

from searoom import ShipState

LENGTH_M, BEAM_M = 30.0, 10.0


class SearoomAgent(Agent):
    name = "searoom"

    def __init__(self, config: Any) -> None:
        self.cell_m = config.world.cell_size
        self.speed_mps = config.vessel.cruise_speed * self.cell_m
        fast = config.vessel.max_speed * self.cell_m
        self.replanner = Replanner(
            {
                "length_m": LENGTH_M,
                "beam_m": BEAM_M,
                # 35° of rudder turn at 68 m
                "turning_radius_m": 100.0,
                "speeds_mps": [0.5 * self.speed_mps, self.speed_mps, fast],
                "safety_margin_m": config.simulation.collision_radius * self.cell_m + 10.0,
                "tracking_margin_m": 10.0,
            },
            spreads={"speed_spread_mps": 0.2, "course_spread_deg": 2.0},
        )

    def reset(self, obs: Any) -> None:
        self.replanner.reset()
        self.start, self.begun = self._place(*obs.position), obs.t

    def decide(self, obs: Any) -> Decision:
        vessel = obs.vessel
        own = self._state(vessel)
        targets = [
            Target(str(ship["id"]), *self._state(ship), LENGTH_M, BEAM_M) for ship in obs.obstacles
        ]
        mission = [self.start, self._place(*obs.goal)]
        course, speed = self.replanner.steer(
            obs.t - self.begun, own, mission, [self.speed_mps], targets
        )
        plan = self.replanner.plan
        return Decision(
            desired_heading=math.radians(90.0 - course),
            desired_speed=speed / self.cell_m,
            explanation={
                "verdict": plan.verdict if plan else "no plan",
                "encounters": plan.encounters if plan else [],
            },
        )

    def _place(self, x: float, y: float) -> tuple[float, float]:
        return x * self.cell_m, y * self.cell_m

    def _state(self, ship: dict[str, float]) -> ShipState:
        # x is east, y north, headings counter-clockwise from east in radians
        course = 90.0 - math.degrees(ship["heading"])
        return ShipState(*self._place(ship["x"], ship["y"]), course, ship["speed"] * self.cell_m)
