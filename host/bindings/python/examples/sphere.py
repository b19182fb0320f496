"""A sphere in the middle of the box. The board renders it at its full rate; this program only places it anew before its
life is over, so that it goes when the program goes.

    sphere.py [ADDRESS]     of the arm, as inkwell.open() takes it
"""

import sys
import threading

import inkwell

SPHERE = inkwell.Sphere(centre_m=(0, 0, -0.03), radius_m=0.02, stiffness_N_per_m=800, static_friction=0.2,
                        dynamic_friction=0.15, life_s=5)

with inkwell.open(*sys.argv[1:]) as arm:
    arm.enable_force()
    print("Press Enter to end.", flush=True)
    enter = threading.Thread(target=sys.stdin.readline, daemon=True)
    enter.start()
    while enter.is_alive():
        arm.place_shapes(SPHERE)
        enter.join(1.0)
