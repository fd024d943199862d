"""Own ship in a simulator of somebody else: plans again and again, and says where to steer.

`vesselnav_bench.py` and `colav_simulator_planner.py` beside it use this.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import searoom


class Target(NamedTuple):
    """A ship as a tracker has it: metres, degrees clockwise from north, m/s."""

    name: str
    east_m: float
    north_m: float
    course_deg: float
    speed_mps: float
    length_m: float
    beam_m: float
    position_std_m: float = 0.0


class Replanner:
    """Plans every `period_s` seconds, each plan going on from the last one.

    `own_ship` has the keys of `[own_ship]` in a scenario file that do not change, `spreads` those
    of a target's uncertainty, `planner` those of `[planner]`.
    """

    def __init__(
        self,
        own_ship: dict[str, Any],
        *,
        spreads: dict[str, float],
        planner: dict[str, Any] | None = None,
        period_s: float = 20.0,
        ahead_s: float = 10.0,
    ) -> None:
        self.own_ship, self.spreads = own_ship, spreads
        self.planner = planner or {"compliance": "rules"}
        self.period_s, self.ahead_s = period_s, ahead_s
        self.reset()

    def reset(self) -> None:
        self.plan: searoom.Plan | None = None
        self.made_s = -math.inf
        self.tried_s = -math.inf

    def steer(
        self,
        time_s: float,
        own: searoom.ShipState,
        waypoints: Sequence[Sequence[float]],
        speeds_mps: Sequence[float],
        targets: Sequence[Target],
    ) -> tuple[float, float]:
        """The course in degrees and the speed in m/s that bring own ship to its plan.

        `waypoints` are east and north of the whole mission, which begins at 0 s; `speeds_mps` has
        one speed for each leg. Without any plan own ship keeps its course at the first speed.
        """
        if time_s >= self.tried_s + self.period_s - 1e-6:
            self.tried_s = time_s
            self._plan(time_s, own, waypoints, speeds_mps, targets)
        if self.plan is None:
            return own.course_deg, speeds_mps[0]
        end = float(self.plan.sample().t_s[-1])
        there = self.plan.sample([min(time_s - self.made_s + self.ahead_s, end)])
        east, north = there.east_m[0] - own.east_m, there.north_m[0] - own.north_m
        most = max(self.own_ship["speeds_mps"])
        speed = min(math.hypot(east, north) / self.ahead_s, 1.1 * most)
        return math.degrees(math.atan2(east, north)) % 360.0, speed

    def _plan(
        self,
        time_s: float,
        own: searoom.ShipState,
        waypoints: Sequence[Sequence[float]],
        speeds_mps: Sequence[float],
        targets: Sequence[Target],
    ) -> None:
        legs = zip(waypoints, waypoints[1:], speeds_mps, strict=False)
        duration = sum(math.dist(a, b) / speed for a, b, speed in legs)
        scenario = searoom.Scenario.from_dict(
            {
                "title": "own ship",
                "time_s": time_s,
                "horizon_s": max(duration - time_s, 0.0) * 1.5 + 600.0,
                "own_ship": {
                    **self.own_ship,
                    "position": {"east_m": own.east_m, "north_m": own.north_m},
                    "course_deg": own.course_deg,
                    "speed_mps": speeds_mps[0],
                },
                "mission": {
                    "start_s": 0.0,
                    "waypoints": [{"east_m": e, "north_m": n} for e, n in waypoints],
                    "leg_speeds_mps": list(speeds_mps[: len(waypoints) - 1]),
                },
                "planner": self.planner,
                "targets": [
                    {
                        "name": target.name,
                        "position": {"east_m": target.east_m, "north_m": target.north_m},
                        "course_deg": target.course_deg,
                        "speed_mps": target.speed_mps,
                        "length_m": target.length_m,
                        "beam_m": target.beam_m,
                        "position_std_m": target.position_std_m,
                        **self.spreads,
                    }
                    for target in targets
                ],
            }
        )
        try:
            plan = searoom.plan(scenario, previous=self.plan)
        except searoom.DocumentError:
            # too far off the last plan to go on from it
            plan = searoom.plan(scenario)
        # without a new plan the last one is followed
        if plan.cost is not None:
            self.plan, self.made_s = plan, time_s
