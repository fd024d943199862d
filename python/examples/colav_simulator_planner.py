"""Searoom as a planner of colav-simulator (github.com/NTNU-TTO/colav-simulator).

    simulator.run([scenario_data], colav_systems=[(0, SearoomPlanner())])

For open water: the chart is not given to the planner. Velocities of a tracker have errors, which
`spreads` has to hold.
"""

from __future__ import annotations

import math
from typing import Any

import colav_simulator.core.colav.colav_interface as ci
import numpy as np
from replanner import Replanner, Target

from searoom import ShipState


class SearoomPlanner(ci.ICOLAV):
    def __init__(
        self,
        *,
        turning_radius_m: float = 150.0,
        safety_margin_m: float = 50.0,
        spreads: dict[str, float] | None = None,
    ) -> None:
        self._own = {
            "turning_radius_m": turning_radius_m,
            "safety_margin_m": safety_margin_m,
            "tracking_margin_m": 0.5 * safety_margin_m,
        }
        self._spreads = spreads or {"speed_spread_mps": 0.5, "course_spread_deg": 5.0}
        self._replanner: Replanner | None = None
        self._references = np.zeros((9, 1))

    def reset(self) -> None:
        self._replanner = None
        self._references = np.zeros((9, 1))

    def plan(
        self,
        t: float,
        waypoints: np.ndarray,
        speed_plan: np.ndarray,
        ownship_state: np.ndarray,
        do_list: list[tuple[int, np.ndarray, np.ndarray, float, float]],
        enc: Any = None,
        goal_state: np.ndarray | None = None,
        w: Any = None,
        **kwargs: Any,
    ) -> np.ndarray:
        """References of course (row 2) and speed (row 3), as the guidance by line of sight gives."""
        speeds = [max(float(speed), 0.1) for speed in speed_plan[: waypoints.shape[1] - 1]]
        if self._replanner is None:
            own = {
                **self._own,
                "length_m": float(kwargs.get("os_length", 30.0)),
                "beam_m": float(kwargs.get("os_width", 8.0)),
                "speeds_mps": sorted({0.5 * speeds[0], *speeds}),
            }
            self._replanner = Replanner(own, spreads=self._spreads)
            self._begun = t
        # states have x north, y east, angles clockwise from north
        north, east, heading, surge, sway, _ = ownship_state[:6]
        course = math.degrees(heading + math.atan2(sway, surge))
        own_state = ShipState(float(east), float(north), course, math.hypot(surge, sway))
        targets = [
            Target(
                str(identity),
                float(state[1]),
                float(state[0]),
                math.degrees(math.atan2(state[3], state[2])),
                math.hypot(state[2], state[3]),
                float(length),
                float(width),
                math.sqrt(max(np.linalg.eigvalsh(covariance[:2, :2])[-1], 0.0)),
            )
            for identity, state, covariance, length, width in do_list
        ]
        mission = [(float(e), float(n)) for n, e in waypoints.T]
        course, speed = self._replanner.steer(t - self._begun, own_state, mission, speeds, targets)
        self._references = np.zeros((9, 1))
        self._references[2:4, 0] = math.radians(course), speed
        return self._references

    def get_current_plan(self) -> np.ndarray:
        """The places, courses and speeds of the whole plan, every second."""
        if self._replanner is None or self._replanner.plan is None:
            return self._references
        own = self._replanner.plan.sample()
        plan = np.zeros((9, own.t_s.size))
        plan[:4] = own.north_m, own.east_m, np.radians(own.course_deg), own.speed_mps
        return plan

    def get_colav_data(self) -> dict[str, Any]:
        plan = self._replanner.plan if self._replanner else None
        return {
            "nominal_trajectory": self.get_current_plan()[:6],
            "nominal_inputs": np.zeros((3, 1)),
            "params": plan.document if plan else {},
            "t": self._replanner.made_s if self._replanner else 0.0,
        }

    def plot_results(self, ax_map: Any, enc: Any, plt_handles: dict, **kwargs: Any) -> dict:
        return plt_handles
