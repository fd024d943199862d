#!/bin/bash
# DNV's trafficgen writes the speed of a leg as `leg.sog` and does not read it: positions along a
# track come from `leg.data.sog.value`, else from the initial speed. Asked for an own ship with one
# waypoint, it gives a speed to the first waypoint, where no leg ends, and none to the second.
#
# Guess of an engineer: `leg.sog`, "speed reference for the waypoint leg", moves the ship, and each leg
# has one. A reader has to take the first waypoint's speed where no leg has one.
#
# Exit status: 0 while this is so, 1 when it has changed, 2 when the package cannot be installed.
set -u
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv" &&
    "$folder/venv/bin/pip" install --quiet trafficgen==0.9.1 || exit 2
cat > "$folder/look.py" <<'PYTHON'
import importlib.metadata
import math
import sys

from trafficgen import encounter, types, utils

print("trafficgen", importlib.metadata.version("trafficgen"))
KNOT = 1852.0 / 3600.0


def place(lat_deg, lon_deg=10.0):
    return types.GeoPosition(lat=math.radians(lat_deg), lon=math.radians(lon_deg))


def waypoint(lat_deg, leg):
    return types.Waypoint(position=place(lat_deg), leg=leg)


def metres(leg):
    """Way made north in 600 s on one leg, from an initial speed of 10 knots."""
    track = [waypoint(59.0, None), waypoint(60.0, leg)]
    there = utils.calculate_position_along_track_using_waypoints(track, 10.0 * KNOT, 600.0)
    return (there.lat - track[0].position.lat) * 6_366_000.0


plain = metres(types.Leg(sog=5.0 * KNOT))
point = types.DataPoint(value=5.0 * KNOT, interp_start=0.0, interp_end=0.0)
data = metres(types.Leg(data=types.RouteData(sog=point)))
print("a leg of 5 knots after an initial 10 knots, way made in 600 s:")
print(f"  speed as leg.sog             {plain:.0f} m, {plain / 600.0 / KNOT:.1f} knots")
print(f"  speed as leg.data.sog.value  {data:.0f} m, {data / 600.0 / KNOT:.1f} knots")

situation = types.SituationInput(
    title="one waypoint",
    description="one waypoint",
    own_ship=types.OwnShipInitial(
        initial=types.Initial(position=place(59.0), sog=10.0 * KNOT, cog=0.0, heading=0.0),
        waypoints=[types.Waypoint(position=place(59.1))],
    ),
    encounters=[],
)
settings = None  # not used where own ship has a waypoint
static = types.create_ship_static_example()
ship = encounter.define_own_ship(situation, static, settings, place(59.0))
speeds = [None if w.leg is None else w.leg.sog for w in ship.waypoints]
print("own ship asked for with one waypoint; leg.sog of the waypoints written, m/s:", speeds)
as_seen = (
    abs(plain / 600.0 / KNOT - 10.0) < 0.1
    and abs(data / 600.0 / KNOT - 5.0) < 0.1
    and speeds == [10.0 * KNOT, None]
)
print("as seen before" if as_seen else "CHANGED")
sys.exit(0 if as_seen else 1)
PYTHON
"$folder/venv/bin/python" "$folder/look.py"
