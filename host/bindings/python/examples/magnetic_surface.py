"""A plane at x = 0 that draws the stylus to itself, from 10 mm away on; who pulls hard enough gets free.

    magnetic_surface.py [ADDRESS]     of the arm, as inkwell.open() takes it
"""

import math
import sys

import inkwell

STIFFNESS_N_PER_M = 200
REACH_M = 0.010


def attraction_N(distance_m):
    """Grows as a spring's up to half of the reach, then falls to nothing, so that it never jumps."""
    return STIFFNESS_N_PER_M * max(0.0, min(distance_m, REACH_M - distance_m))


with inkwell.open(*sys.argv[1:]) as arm:
    arm.enable_force()

    @arm.servo
    def magnet(pose):
        x_m = pose.position_m[0]
        return -math.copysign(attraction_N(abs(x_m)), x_m), 0.0, 0.0

    input("Press Enter to end.\n")
