"""Records two seconds of movement at every control period, and says how far and how fast the hand went.

    recording.py FILE.npz [ADDRESS]     of the arm, as inkwell.open() takes it
"""

import sys

import inkwell
import numpy as np

AXES = "position_x_m", "position_y_m", "position_z_m"

if len(sys.argv) < 2:
    sys.exit("Give the file that the movement goes to, such as movement.npz.")
with inkwell.open(*sys.argv[2:]) as arm:
    print("Move the stylus.", flush=True)
    movement = arm.capture(*AXES, duration_s=2.0)

np.savez(sys.argv[1], time_s=movement.time_s, position_m=movement.values)
every_ms = movement.values[::20]
path_m = np.linalg.norm(np.diff(every_ms, axis=0), axis=1)
print(f"{len(movement)} samples, {movement.lost} lost: {path_m.sum() * 1000:.0f} mm of path, "
      f"at most {path_m.max() * 1000:.2f} m/s")
