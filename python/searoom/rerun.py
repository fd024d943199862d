"""Plans in a Rerun stream of your own: `searoom.rerun.log(plan)`.

Needs `rerun-sdk`. The command line's `--rrd` writes a whole recording with panels instead.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import rerun as rr

if TYPE_CHECKING:
    from searoom._searoom import Plan


def log(
    plan: Plan,
    path: str = "searoom",
    *,
    step_s: float = 5.0,
    recording: rr.RecordingStream | None = None,
) -> None:
    """Logs a plan and the sets that it keeps out of, every `step_s` seconds.

    The timeline is `t`. Entities are `path/desired`, `path/plan`, `path/own` and
    `path/sets/NAME`. Where there is no plan, raises `NoPlanError` and logs nothing.
    """
    samples = plan.sample()
    times = np.append(np.arange(0.0, samples.t_s[-1], step_s), samples.t_s[-1])
    along = plan.sample(times)
    waypoints = plan.document["mission"]["waypoints"]
    desired = [[w["east_m"], w["north_m"]] for w in waypoints]
    planned = np.column_stack([samples.east_m, samples.north_m])
    # Rerun's y axis points down
    down = np.array([1.0, -1.0])
    rr.log(
        f"{path}/desired",
        rr.LineStrips2D([np.array(desired) * down], colors=[128, 128, 128]),
        static=True,
        recording=recording,
    )
    rr.log(f"{path}/plan", rr.LineStrips2D([planned * down]), static=True, recording=recording)
    for index, time in enumerate(times):
        rr.set_time("t", duration=float(time), recording=recording)
        here = np.array([[along.east_m[index], along.north_m[index]]])
        rr.log(f"{path}/own", rr.Points2D(here * down, radii=rr.Radius.ui_points(5)), recording=recording)
        for name, section in plan.sections(float(time)).items():
            outline = np.vstack([section, section[:1]]) * down
            rr.log(f"{path}/sets/{name}", rr.LineStrips2D([outline]), recording=recording)
