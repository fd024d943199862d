"""Plans how a ship keeps clear of others when nobody knows exactly what they will do.

>>> import searoom
>>> scenario = searoom.Scenario.read("scenarios/colregs/head-on.toml")
>>> plan = searoom.plan(scenario)
>>> plan.safe, plan.verdict
(True, 'solved')

Positions are east and north in metres, times seconds from the scenario's present, courses degrees
clockwise from north, speeds m/s. Documents are dicts with the keys of the command line's JSON
documents. Every error is a `SearoomError`.
"""

from searoom._searoom import (
    DocumentError,
    InternalError,
    NoPlanError,
    Plan,
    Scenario,
    InputError,
    SearoomError,
    Simulation,
    __version__,
    assess,
    compare,
    plan,
    verify,
)
from searoom._views import Samples, ShipState, plot, simulate

__all__ = [
    "DocumentError",
    "InternalError",
    "NoPlanError",
    "Plan",
    "Samples",
    "Scenario",
    "InputError",
    "SearoomError",
    "ShipState",
    "Simulation",
    "__version__",
    "assess",
    "compare",
    "plan",
    "plot",
    "simulate",
    "verify",
]
