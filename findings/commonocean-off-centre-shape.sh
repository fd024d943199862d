#!/bin/bash
# CommonOcean's library turns the shape of an obstacle about the shape's own middle, not about the
# position of the ship: a middle ahead of the position stays east of it, whatever the heading, and a
# polygon turns about its centroid.
#
# Guess of an engineer: shapes are in the body frame, so a bridge or an antenna that is off the middle
# of the hull is turned with the ship. A reader is safe with a hull that holds both readings.
#
# Exit status: 0 while this is so, 1 when it has changed, 2 when the packages cannot be installed.
set -u
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv" &&
    "$folder/venv/bin/pip" install --quiet commonocean-io==2025.1 || exit 2
cat > "$folder/look.py" <<'PYTHON'
import importlib.metadata
import math
import sys

import numpy as np
from commonocean.scenario.obstacle import DynamicObstacle, ObstacleType
from commonocean.scenario.state import InitialState
from commonroad.geometry.shape import Polygon, Rectangle

for package in ("commonocean-io", "commonroad-io"):
    print(package, importlib.metadata.version(package))
south = InitialState(
    position=np.array([0.0, 2000.0]), orientation=-math.pi / 2, velocity=5.0, time_step=0
)


def middle(shape):
    ship = DynamicObstacle(1, ObstacleType.CARGOSHIP, shape, south)
    placed = ship.occupancy_at_time(0).shape
    return placed.center if isinstance(placed, Rectangle) else placed.shapely_object.centroid.coords[0]


box = middle(Rectangle(90.0, 15.0, np.array([30.0, 0.0]), 0.0))
hull = [[-45, -7.5], [30, -7.5], [45, 0], [30, 7.5], [-45, 7.5]]
body = Polygon(np.array(hull)).shapely_object.centroid.x
pointed = middle(Polygon(np.array(hull)))
print("a ship at (0, 2000) heads south; its box has its middle 30 m ahead of the position")
print("  turned with the ship the middle would be at   (0.0, 1970.0)")
print(f"  the library has it at                         ({box[0]:.1f}, {box[1]:.1f})")
print(f"a pointed hull has its centroid {-body:.2f} m astern of the position")
print(f"  turned with the ship it would be at           (0.00, {2000 - body:.2f})")
print(f"  the library has it at                         ({pointed[0]:.2f}, {pointed[1]:.2f})")
as_seen = np.allclose(box, [30.0, 2000.0]) and np.allclose(pointed, [body, 2000.0])
print("as seen before" if as_seen else "CHANGED")
sys.exit(0 if as_seen else 1)
PYTHON
"$folder/venv/bin/python" "$folder/look.py"
