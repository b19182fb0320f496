"""A ball that moves from side to side and pushes the hand.

    moving_ball.py [ADDRESS]     of the arm, as inkwell.open() takes it
"""

import math
import sys
import threading

import inkwell

WAY_M = 0.02
TURNS_RAD_PER_S = 2 * math.pi * 0.5

with inkwell.open(*sys.argv[1:]) as arm:
    ball = arm.scene.add_sphere(0.015, position_m=(0, 0, -0.03), material="rubber")
    arm.enable_force()
    print("Press Enter to end.", flush=True)
    enter = threading.Thread(target=sys.stdin.readline, daemon=True)
    enter.start()
    while enter.is_alive():
        arm.sleep(0.01)
        phase_rad = TURNS_RAD_PER_S * arm.pose.time_s
        # The velocity moves the ball evenly between two calls.
        ball.move((WAY_M * math.sin(phase_rad), 0, -0.03),
                  velocity_m_per_s=(WAY_M * TURNS_RAD_PER_S * math.cos(phase_rad), 0, 0))
