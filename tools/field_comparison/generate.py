"""Random meetings with one target as scenario files, modelled on the campaigns' generator."""
import math
import pathlib
import random
import sys

OWN_SPEED, OWN_DIAGONAL, MARGIN = 5.0, math.hypot(15, 4), 20.0
# bearing sector (degrees, clockwise), speeds (m/s)
KINDS = {
    "head-on": ((-10, 10), (2.5, 7.5)),
    "give-way": ((10, 112.5), (2.5, 7.5)),
    "stand-on": ((-112.5, -10), (2.5, 7.5)),
    "overtaking": ((-20, 20), (1.8, 3.5)),
    "overtaken": ((160, 200), (6.5, 8.2)),
}
# time of the closest approach, path length, horizon
SETS = {"near": ((100, 220), 2500, 1000), "far": ((300, 500), 4000, 1800)}

TEMPLATE = """title = "{title}"
horizon_s = {horizon:.1f}

[own_ship]
position = {{ east_m = 0.0, north_m = 0.0 }}
course_deg = 90.0
speed_mps = 5.0
length_m = 30.0
beam_m = 8.0
turning_radius_m = 100.0
safety_margin_m = 20.0

[mission]
waypoints = [{{ east_m = 0.0, north_m = 0.0 }}, {{ east_m = {path:.1f}, north_m = 0.0 }}]

[[targets]]
name = "target"
position = {{ east_m = {east!r}, north_m = {north!r} }}
course_deg = {course!r}
speed_mps = {speed!r}
length_m = {length!r}
beam_m = {beam!r}
speed_spread_mps = 0.5
course_spread_deg = 5.0
"""


def wrap(degrees):
    return (degrees + 180) % 360 - 180


def kind_of(own, target, course):
    """The encounter by the sectors of docs/reference/colregs.md; own ship steers east."""
    to_target = math.degrees(math.atan2(target[0] - own, target[1]))
    bearing, aspect = wrap(to_target - 90), wrap(to_target + 180 - course)
    along = abs(wrap(course - 90)) <= 15
    if abs(bearing) > 112.5 or abs(aspect) > 112.5:
        if abs(bearing) > 112.5 and abs(aspect) > 112.5 or not along:
            return None
        return "overtaken" if abs(bearing) > 112.5 else "overtaking"
    if max(abs(bearing), abs(aspect)) <= 10:
        return "head-on"
    if bearing * aspect >= 0:
        return None
    return "give-way" if bearing > 0 else "stand-on"


def draw(kind, times, rng):
    """One target, or None where the draw is of another kind."""
    sector, speeds = KINDS[kind]
    meeting, speed = rng.uniform(*times), rng.uniform(*speeds)
    bearing = math.radians(90 + rng.uniform(*sector))
    length = rng.uniform(30, 100)
    beam, miss = length / rng.uniform(4, 7), rng.uniform(-0.5, 0.5) * length
    sight = math.sin(bearing), math.cos(bearing)
    point = OWN_SPEED * meeting
    half = sight[0] * point
    square = half**2 - point**2 + (speed * meeting) ** 2
    if square < 0:
        return None
    reach = half + math.copysign(math.sqrt(square), rng.random() - 0.5)
    if reach <= math.hypot(length, beam) / 2 + OWN_DIAGONAL + MARGIN:
        return None
    v = (point - sight[0] * reach) / meeting, -sight[1] * reach / meeting
    relative = OWN_SPEED - v[0], -v[1]
    norm = math.hypot(*relative)
    at = sight[0] * reach - relative[1] / norm * miss, sight[1] * reach + relative[0] / norm * miss
    course = math.degrees(math.atan2(*v)) % 360
    for t in (-30, 0):
        if kind_of(OWN_SPEED * t, (at[0] + v[0] * t, at[1] + v[1] * t), course) != kind:
            return None
    return dict(east=at[0], north=at[1], course=course, speed=speed, length=length, beam=beam)


count, folder = int(sys.argv[1]), pathlib.Path(sys.argv[2])
for name, (times, path, horizon) in SETS.items():
    (folder / name).mkdir(parents=True, exist_ok=True)
    for kind in KINDS:
        for i in range(count):
            rng = random.Random(f"{name} {kind} {i}")
            target = next(t for t in iter(lambda: draw(kind, times, rng), 0) if t)
            text = TEMPLATE.format(title=f"{name} {kind} {i}", path=path, horizon=horizon, **target)
            (folder / name / f"{kind}-{i:02}.toml").write_text(text)
