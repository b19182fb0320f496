"""A spring between the hands of two arms: what one does, the other feels.

    inkwell run --arms left,right python3 two_arms.py     arms with these names; with --virtual, two simulated arms
    two_arms.py ADDRESS ADDRESS                           addresses of the arms for inkwell.open()
"""

import sys

import inkwell

STIFFNESS_N_PER_M = 150

if len(sys.argv) not in (1, 3):
    sys.exit("Give the addresses of two arms, such as their serial numbers.")
left_address, right_address = sys.argv[1:] or ("left", "right")
with inkwell.open(right_address) as right, inkwell.open(left_address) as left:
    left.enable_force()
    right.enable_force()

    @left.servo
    def pull(pose):
        force_N = STIFFNESS_N_PER_M * (right.pose.position_m - pose.position_m)
        right.set_force(-force_N)
        return force_N

    input("Press Enter to end.\n")
