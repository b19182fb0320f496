"""A spring between the hands of two arms: what one does, the other feels.

    two_arms.py ADDRESS ADDRESS     of the arms, as inkwell.open() takes them
"""

import sys

import inkwell

STIFFNESS_N_PER_M = 150

if len(sys.argv) != 3:
    sys.exit("Give the addresses of two arms, such as their serial numbers.")
with inkwell.open(sys.argv[2]) as right, inkwell.open(sys.argv[1]) as left:
    left.enable_force()
    right.enable_force()

    @left.servo
    def pull(pose):
        force_N = STIFFNESS_N_PER_M * (right.pose.position_m - pose.position_m)
        right.set_force(-force_N)
        return force_N

    input("Press Enter to end.\n")
