"""As ending.cpp, through the Python package: ending.py COMMAND close|exit|kill|wait"""

import os
import signal
import sys

import inkwell

command, ending = sys.argv[1:]
arm = inkwell.open()
if command == "stop":
    arm.stop()
elif command == "disable":
    arm.enable_force(30)
    arm.disable_force()
elif command == "clear":
    arm.clear_fault()
elif command == "set":
    arm.parameters.wall_stiffness_N_per_m = 777
elif command == "store":
    arm.parameters.store()
elif command == "shapes":
    arm.place_shapes(inkwell.Sphere((0, 0, -0.5), 0.01, life_s=5))
if ending == "close":
    arm.close()
print("returned", flush=True)
if ending == "exit":
    sys.exit(0)
if ending == "kill":
    os.kill(os.getpid(), signal.SIGKILL)
if ending == "wait":
    signal.pause()
