"""A ball of triangles in the middle of the box.

    mesh.py [ADDRESS]     of the arm, as inkwell.open() takes it
"""

import sys

import inkwell
import numpy as np

RADIUS_M = 0.02
AROUND, RINGS = 48, 24

# A vertex at each pole, and rings of vertices between the poles.
height, turn = np.meshgrid(np.pi * np.arange(1, RINGS) / RINGS, 2 * np.pi * np.arange(AROUND) / AROUND, indexing="ij")
rings = np.stack([np.sin(height) * np.cos(turn), np.sin(height) * np.sin(turn), np.cos(height)], axis=-1)
vertices_m = RADIUS_M * np.vstack([rings.reshape(-1, 3), [[0, 0, 1], [0, 0, -1]]])
TOP, BOTTOM = len(vertices_m) - 2, len(vertices_m) - 1

faces = []
for this in range(AROUND):
    following = (this + 1) % AROUND
    faces.append((TOP, this, following))
    for upper in range(0, AROUND * (RINGS - 2), AROUND):
        a, b, c, d = upper + this, upper + following, upper + AROUND + this, upper + AROUND + following
        faces += [(a, c, d), (a, d, b)]
    faces.append((BOTTOM, AROUND * (RINGS - 2) + following, AROUND * (RINGS - 2) + this))

with inkwell.open(*sys.argv[1:]) as arm:
    arm.scene.add(vertices_m, np.array(faces), position_m=(0, 0, -0.03), material="wood")
    arm.enable_force()
    input("Press Enter to end.\n")
    for event in arm.scene.events():
        if event.kind == inkwell.EventKind.TOUCHED:
            print(f"{event.time_s:.3f} s: touched triangle {event.contact.triangle}")
