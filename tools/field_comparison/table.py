"""Figures of sailed tracks, the same for every planner: table.py SCENARIOS TRACKS [KINDS]."""
import json
import math
import pathlib
import sys
import tomllib

import numpy as np
import shapely

OWN_SPEED, OWN_HULL = 5.0, (30.0, 8.0)
KEEPS_CLEAR = ("head-on", "give-way", "overtaking")


def hulls(east, north, course, hull):
    """Rectangles as polygons."""
    ahead = np.stack([np.sin(np.radians(course)), np.cos(np.radians(course))], -1)
    abeam = np.stack([ahead[..., 1], -ahead[..., 0]], -1)
    middle = np.stack([east, north], -1)
    corners = [middle + a * hull[0] / 2 * ahead + b * hull[1] / 2 * abeam
               for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
    return shapely.polygons(np.stack(corners, 1))


def clearance(t, own, target, d_speed=0.0, d_course=0.0):
    """Least distance of the hulls over the samples, 0 where they touch."""
    course = math.radians(target["course_deg"] + d_course)
    speed = target["speed_mps"] + d_speed
    place = target["position"]
    east = place["east_m"] + speed * math.sin(course) * t
    north = place["north_m"] + speed * math.cos(course) * t
    hull = target["length_m"], target["beam_m"]
    distance = np.hypot(own[:, 0] - east, own[:, 1] - north)
    near = distance <= distance.min() + math.hypot(*hull) + math.hypot(*OWN_HULL)
    theirs = hulls(east[near], north[near], np.full(near.sum(), math.degrees(course)), hull)
    ours = hulls(own[near, 0], own[near, 1], own[near, 2], OWN_HULL)
    return shapely.distance(ours, theirs).min()


def alterations(t, values, least, rate, pause=5.0):
    """Changes of one sign by `least` or more; shorter pauses than `pause` do not divide them."""
    slopes = np.diff(values) / np.maximum(np.diff(t), 1e-9)
    count, total, sign, last = 0, 0.0, 0, -math.inf
    for start, end, slope, change in zip(t[:-1], t[1:], slopes, np.diff(values)):
        if abs(slope) < rate:
            continue
        if np.sign(slope) != sign or start - last > pause:
            count += abs(total) >= least
            total, sign = 0.0, np.sign(slope)
        total, last = total + change, end
    return count + (abs(total) >= least)


def space_time_error(t, east, north, length):
    """J of docs/reference/theory.md, section 7, for the straight path to the east."""
    duration = length / OWN_SPEED
    if t[-1] < duration:  # at the last waypoint until then
        rest = np.arange(t[-1], duration, 0.1)
        t, east, north = (np.append(a, b) for a, b in ((t, rest), (east, rest * 0 + length),
                                                       (north, rest * 0)))
    along = np.clip((east + OWN_SPEED * t) / 2, 0, length)
    error = (east - along) ** 2 + north**2 + OWN_SPEED**2 * (t - along / OWN_SPEED) ** 2
    return np.trapezoid(error, t) / duration


def figures(scenario, run):
    """Of one sailed track."""
    target = scenario["targets"][0]
    length = scenario["mission"]["waypoints"][-1]["east_m"]
    rows = np.array(run["track"])
    t = np.arange(0.0, rows[-1, 0], 0.1)
    east, north, course, speed = (np.interp(t, rows[:, 0], rows[:, i]) for i in range(1, 5))
    own = np.stack([east, north, course], 1)
    angle = math.radians(target["course_deg"])
    velocity = np.array([math.sin(angle), math.cos(angle)]) * target["speed_mps"] - [OWN_SPEED, 0]
    place = np.array([target["position"]["east_m"], target["position"]["north_m"]])
    cpa = -place @ velocity / (velocity @ velocity)
    acts = np.flatnonzero((abs(course - 90) >= 5) | (speed <= 0.8 * OWN_SPEED))
    spreads = [(s, c) for s in (-0.5, -0.25, 0, 0.25, 0.5) for c in (-5, -2.5, 0, 2.5, 5)]
    arrived = rows[-1, 1] >= length - 5
    return dict(
        clearance=clearance(t, own, target),
        lead=cpa - t[acts[0]] if len(acts) else math.nan,
        turns=alterations(rows[:, 0], rows[:, 3], 5.0, 0.1),
        speeds=alterations(rows[:, 0], rows[:, 4], 0.5, 0.005),
        cost=space_time_error(t, east, north, length),
        arrived=arrived,
        on_path=arrived and abs(rows[-1, 2]) <= 20,
        meets=any(clearance(t, own, target, *d) <= 0 for d in spreads),
        cycles=run["cycle_s"],
        without=run.get("without_plan", 0),
    )


def row(name, runs):
    """One line of the table."""
    clear = np.array([r["clearance"] for r in runs])
    get = lambda key: np.array([r[key] for r in runs], dtype=float)
    lead = np.array([r["lead"] for r in runs if r["kind"] in KEEPS_CLEAR])
    hold = np.array([r["lead"] for r in runs if r["kind"] not in KEEPS_CLEAR])
    cycles = 1000 * np.concatenate([r["cycles"] for r in runs])
    median = lambda a: f"{np.nanmedian(a):.0f}" if np.isfinite(a).any() else "–"
    share = lambda a: f"{np.isfinite(a).sum()}/{len(a)}"
    ms = lambda p: f"{np.percentile(cycles, p):.3g}"
    return [name, len(runs), int((clear <= 0).sum()),
            f"{clear.min():.0f} / {np.percentile(clear, 5):.0f} / {np.median(clear):.0f}",
            f"{median(lead)} ({share(lead)})", f"{median(hold)} ({share(hold)})",
            f"{np.median(get('turns')):.0f} / {get('turns').max():.0f}",
            f"{np.median(get('speeds')):.0f} / {get('speeds').max():.0f}",
            f"{np.median(get('cost')):,.0f} / {np.percentile(get('cost'), 95):,.0f}",
            f"{int(get('on_path').sum())}", f"{int(get('meets').sum())}",
            f"{int(get('without').sum())} of {len(cycles)}", f"{ms(50)} / {ms(99)}"]


HEAD = ["planner", "runs", "contacts", "least clearance, m: least / 5 % / median",
        "acts before CPA, s, keeping clear", "the same, standing on or overtaken",
        "turns: median / most", "changes of speed", "J, m²: median / 95 %", "ends on the path",
        "tracks that meet a target of the spreads", "no plan", "a plan, ms: median / 99 %"]

scenes, tracks = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
print("| " + " | ".join(HEAD) + " |\n|" + " --- |" * len(HEAD))
for folder in sorted(tracks.iterdir()):
    runs = []
    for file in sorted(folder.glob("*.json")):
        scenario = tomllib.loads((scenes / f"{file.stem}.toml").read_text())
        runs.append(figures(scenario, json.loads(file.read_text())) | dict(kind=file.stem[:-3]))
    groups = sorted({r["kind"] for r in runs}) if len(sys.argv) > 3 else [None]
    for kind in groups:
        chosen = [r for r in runs if kind in (None, r["kind"])]
        if chosen:
            print("| " + " | ".join(map(str, row(kind or folder.name, chosen))) + " |")
