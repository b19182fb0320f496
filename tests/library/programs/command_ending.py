"""As ending.cpp, by a command of the command line, which ends by itself: command_ending.py BUILD_FOLDER COMMAND exit|wait"""

import os
import signal
import subprocess
import sys

folder, command, ending = sys.argv[1:]
words = {"stop": ["force", "off"],
         "disable": ["force", "on", "--seconds", "0.1"],
         "clear": ["fault", "clear"],
         "set": ["parameters", "set", "wall_stiffness_N_per_m=777"],
         "store": ["parameters", "store"]}[command]
server = os.environ["INKWELL_DEVICE"].removeprefix("usbip:")
subprocess.run([folder + "/inkwell", *words, "--usbip", server], check=True, stdout=subprocess.DEVNULL)
print("returned", flush=True)
if ending == "wait":
    signal.pause()
