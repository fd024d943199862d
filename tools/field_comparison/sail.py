"""Sails scenario files with one planner; writes own ship's track and the processing times as JSON.

sail.py VARIANT SCENARIOS OUT [SEAROOM [PATTERN]]: folders SCENARIOS and OUT, the program, and which
files of the folder. Tracks that are there already are left alone.
"""
import json
import logging
import math
import pathlib
import subprocess
import sys
import tempfile
import time
import tomllib

STEP = 0.5  # s, of the peers' own ship and of all samples


def own_samples(segments):
    """Samples (t, east, north, course, speed) along the lines and arcs of a simulation document."""
    for s in segments:
        start, speed, rate = s["start"], s["speed_mps"], s["turn_rate_deg_per_s"]
        times = [k * STEP for k in range(int(s["duration_s"] / STEP) + 1)]
        for t in times + [s["duration_s"]]:
            half = math.radians(rate * t / 2)
            chord = speed * t * (math.sin(half) / half if abs(half) > 1e-9 else 1.0)
            mean = math.radians(start["course_deg"]) + half
            yield (start["t_s"] + t, start["east_m"] + chord * math.sin(mean),
                   start["north_m"] + chord * math.cos(mean), start["course_deg"] + rate * t, speed)


def searoom(scenario, text, compliance, program, **_):
    """Searoom's own loop, with its defaults but for the rules that plans keep to."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "scenario.toml")
        file.write_text(f'{text}\n[planner]\ncompliance = "{compliance}"\n')
        command = [program, "simulate", file, "--json"]
        documents = [json.loads(subprocess.run(command, capture_output=True).stdout)
                     for _ in range(5)]
    # by the clock: the least of five equal runs, as other programs use the machine
    cycles = [min(times) for times in zip(*(d["timing"]["plan_s"] for d in documents))]
    document = documents[0]
    return list(own_samples(document["sailed"])), cycles, document["conduct"]["without_plan"]


class Scene:
    """Own ship of the peers, and the target on its course."""

    def __init__(self, scenario):
        own, target = scenario["own_ship"], scenario["targets"][0]
        self.speed, self.radius = own["speed_mps"], own["turning_radius_m"]
        self.path = scenario["mission"]["waypoints"][-1]["east_m"]
        self.horizon, self.target = scenario["horizon_s"], target
        course = math.radians(target["course_deg"])
        self.velocity = [target["speed_mps"] * f(course) for f in (math.sin, math.cos)]
        self.state = (0.0, 0.0, 0.0, 90.0, self.speed)

    def target_at(self, t):
        place = self.target["position"]
        return place["east_m"] + self.velocity[0] * t, place["north_m"] + self.velocity[1] * t

    def step(self, course, speed):
        """Own ship turns with its least radius at most, and changes speed at once."""
        t, east, north, old, _ = self.state
        most = math.degrees(max(speed, 0.1) / self.radius) * STEP
        turn = max(-most, min(most, (course - old + 180) % 360 - 180))
        mean = math.radians(old + turn / 2)
        self.state = (t + STEP, east + speed * STEP * math.sin(mean),
                      north + speed * STEP * math.cos(mean), old + turn, speed)

    def sail(self, plan, command, period, watch=STEP):
        """Plans every `period`; `command(t)` gives course and speed. Ends abeam of the waypoint."""
        track, cycles, t = [self.state], [], 0.0
        while self.state[1] < self.path and t < self.horizon:
            if t % watch == 0:
                before = time.process_time()
                planned = plan(self.state, self.target_at(t), t % period == 0)
                if planned:
                    cycles.append(time.process_time() - before)
            self.step(*command(t))
            track.append(self.state)
            t = self.state[0]
        return track, cycles


def colregs_planner(scenario, _, period, los, edge=7.5, **__):
    """`ColregsDPPlanner` of the package's README: own ship steers the velocity of its reference."""
    from colregs_planner.planner_api import ColregsDPPlanner
    from colregs_planner.planner_api.route import WaypointRoute

    scene = Scene(scenario)
    # the route goes on beyond the last waypoint: own ship does not slow down to stop there
    route = WaypointRoute(((0.0, 0.0), (0.0, scene.path + 5000.0)), scene.speed, arrive=False,
                          los_lookahead=los)
    planner = ColregsDPPlanner(
        "own", route, 1.0, replan_s=period, search={"edge_s": edge},
        config={"interaction": {"use_responding_filter": True, "top_k_hypotheses": 2}})
    nominal, passed = 0, False

    def plan(own, target, _due):
        nonlocal nominal, passed
        t, east, north, course, speed = own
        if passed:
            return False
        reference = planner.update(t, {
            "own": dict(north=north, east=east, course_deg=course, speed=speed),
            "target": dict(north=target[1], east=target[0], speed=scene.target["speed_mps"],
                           course_deg=scene.target["course_deg"])})
        if reference.replanned:
            # three plans of no manoeuvre and the target far astern: the route is all that is left
            relative = [a - b for a, b in zip(target, (east, north))]
            heading = math.radians(course)
            own_velocity = speed * math.sin(heading), speed * math.cos(heading)
            opening = sum(r * (v - o) for r, v, o in zip(relative, scene.velocity, own_velocity))
            far = opening > 0 and math.hypot(*relative) > 500
            nominal = nominal + 1 if far and set(reference.plan) == {"nominal"} else 0
            passed = nominal >= 3
        return reference.replanned

    def command(t):
        if passed:
            north, east = route.velocity(0, scene.state[2], scene.state[1])
        else:
            reference = planner.reference(t + STEP / 2)
            north, east = reference.vn, reference.ve
        speed = math.hypot(north, east)
        return (math.degrees(math.atan2(east, north)) if speed > 0.05 else scene.state[3]), speed

    return *scene.sail(plan, command, period, watch=1.0), 0


def timespace(scenario, _, period, spread, faster=1.0, **__):
    """`TimeSpaceColav` as in `COLAVEnv.step` and the package's examples."""
    from colav.obstacles import MovingShip
    from colav.path.pwl import PWLPath
    from colav.planner import TimeSpaceColav

    logging.disable(logging.CRITICAL)
    scene = Scene(scenario)
    target = scene.target
    path = PWLPath([(0.0, 0.0), (scene.path + 5000.0, 0.0)])
    planner = TimeSpaceColav(desired_speed=scene.speed, max_speed=faster * scene.speed,
                             max_course_rate=1, colregs=True, max_iter=20, speed_factor=0.9,
                             abort_colregs_after_iter=5)
    uncertain = dict(du=target["speed_spread_mps"], dchi=target["course_spread_deg"])
    answer, since, without = None, 0.0, []

    def plan(own, at, due):
        nonlocal answer, since
        if due:
            t, east, north, course, _ = own
            ship = MovingShip.from_body(at, target["course_deg"], target["speed_mps"], 0,
                                        target["length_m"], target["beam_m"], degrees=True,
                                        mmsi=123456789, **(uncertain if spread else {}))
            ahead = path.get_lookahead_position(east, north, 1000.0)
            try:
                answer, _ = planner.get((east, north), ahead, [ship.buffer(50.0)], heading=course)
            except (AttributeError, ValueError):  # own ship within two footprints: no plan
                answer = None
            without.append(answer is None)
            since = t
        return due

    def command(t):
        if answer is None:  # as COLAVEnv does
            return scene.state[3], 0.0
        after = t + STEP / 2 - since
        return answer.get_heading(after, degrees=True), answer.get_speed(after)

    return *scene.sail(plan, command, period), sum(without)


VARIANTS = {
    "searoom-rules": (searoom, dict(compliance="rules")),
    "searoom-shape": (searoom, dict(compliance="shape")),
    "searoom-none": (searoom, dict(compliance="none")),
    "colregs-planner-5s": (colregs_planner, dict(period=5.0, los=100.0)),
    "colregs-planner-20s": (colregs_planner, dict(period=20.0, los=100.0)),
    "colregs-planner-20s-long": (colregs_planner, dict(period=20.0, los=100.0, edge=30.0)),
    "colregs-planner-5s-parallel": (colregs_planner, dict(period=5.0, los=None)),
    "timespace-2s": (timespace, dict(period=2.0, spread=True)),
    "timespace-20s": (timespace, dict(period=20.0, spread=True)),
    "timespace-20s-faster": (timespace, dict(period=20.0, spread=True, faster=1.5)),
    "timespace-2s-exact": (timespace, dict(period=2.0, spread=False)),
}

if __name__ == "__main__":
    name, folder, out = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    sail, settings = VARIANTS[name]
    settings["program"] = sys.argv[4] if len(sys.argv) > 4 else "searoom"
    (out / name).mkdir(parents=True, exist_ok=True)
    pattern = sys.argv[5] if len(sys.argv) > 5 else "*"
    for file in sorted(folder.glob(f"{pattern}.toml"), key=lambda f: (f.stem[-2:], f.stem)):
        target_file = out / name / f"{file.stem}.json"
        if target_file.exists():
            continue
        text = file.read_text()
        track, cycles, without = sail(tomllib.loads(text), text, **settings)
        run = {"track": track, "cycle_s": cycles, "without_plan": without}
        target_file.write_text(json.dumps(run))
