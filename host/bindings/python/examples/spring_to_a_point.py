"""A spring between the stylus and a point in the middle of the box.

    spring_to_a_point.py [ADDRESS]     of the arm, as inkwell.open() takes it
"""

import sys

import inkwell
import numpy as np

POINT_M = np.array([0.0, 0.0, -0.03])
STIFFNESS_N_PER_M = 100

with inkwell.open(*sys.argv[1:]) as arm:
    arm.enable_force()

    @arm.servo
    def spring(pose):
        return STIFFNESS_N_PER_M * (POINT_M - pose.position_m)

    input("Press Enter to end.\n")
