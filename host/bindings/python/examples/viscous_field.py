"""The stylus moves as if through honey: the force is against the velocity and in proportion to it.

    viscous_field.py [ADDRESS]     of the arm, as inkwell.open() takes it
"""

import sys

import inkwell

DAMPING_NS_PER_M = 4

with inkwell.open(*sys.argv[1:]) as arm:
    arm.enable_force()

    @arm.servo
    def honey(pose):
        return -DAMPING_NS_PER_M * pose.velocity_m_s

    input("Press Enter to end.\n")
