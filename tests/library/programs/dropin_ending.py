"""As ending.cpp, through the drop-ins, whose only command that returns with its effect ends the device:

    dropin_ending.py BUILD_FOLDER hdapi | hdphantom  disable  exit|kill|wait
"""

import ctypes
import os
import pathlib
import signal
import sys

folder, interface, _, ending = sys.argv[1:]
dropins = pathlib.Path(folder) / "dropins"
hd = ctypes.CDLL(dropins / "libHD.so", mode=ctypes.RTLD_GLOBAL)
TICKS = 500  # in which the force comes on
if interface == "hdapi":
    FORCE_OUTPUT = 0x4000
    left = TICKS

    @ctypes.CFUNCTYPE(ctypes.c_uint, ctypes.c_void_p)
    def tick(_):
        global left
        left -= 1
        return 1 if left > 0 else 0

    hd.hdInitDevice.restype = ctypes.c_uint
    device = ctypes.c_uint(hd.hdInitDevice(None))
    assert device.value != 0xFFFFFFFF
    hd.hdEnable(FORCE_OUTPUT)
    hd.hdStartScheduler()
    hd.hdScheduleSynchronous(tick, None, ctypes.c_ushort(100))
    hd.hdDisableDevice(device)
else:
    phantom = ctypes.CDLL(dropins / "libhdPhantom.so")
    zero = ctypes.c_double(0)
    assert phantom.hdPhantomGetNumDevices() == 1
    assert phantom.hdPhantomOpen(0) == 0
    for _ in range(TICKS):
        phantom.hdPhantomSetForce(0, ctypes.byref(zero), ctypes.byref(zero), ctypes.byref(zero))
    assert phantom.hdPhantomClose(0) == 0
print("returned", flush=True)
if ending == "exit":
    sys.exit(0)
if ending == "kill":
    os.kill(os.getpid(), signal.SIGKILL)
if ending == "wait":
    signal.pause()
