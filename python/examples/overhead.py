"""How much longer `searoom.plan` takes than the library does for the same plan, in microseconds.

    python python/examples/overhead.py scenarios/colregs/*.toml
"""

from __future__ import annotations

import sys
import time
from statistics import median

import searoom

CALLS = 600


def overhead(scenario: searoom.Scenario, calls: int = CALLS) -> tuple[float, float]:
    """Medians in seconds: of the library in a call, and of what the call takes beyond it."""
    library, beyond = [], []
    for _ in range(calls):
        begun = time.perf_counter()
        plan = searoom.plan(scenario)
        library.append(plan._library_s)
        beyond.append(time.perf_counter() - begun - plan._library_s)
        del plan
    return median(library), median(beyond)


if __name__ == "__main__":
    print(f"medians of {CALLS} calls")
    for file in sys.argv[1:]:
        library, beyond = overhead(searoom.Scenario.read(file))
        print(f"{file}: library {1e6 * library:.0f} µs, Python {1e6 * beyond:.1f} µs more")
