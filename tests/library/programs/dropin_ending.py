"""As ending.cpp, through the drop-ins, whose commands switch the force off:

    dropin_ending.py BUILD_FOLDER hdapi      disable|stop_scheduler|close_device  exit|kill|wait
    dropin_ending.py BUILD_FOLDER hdphantom  stop_scheduler|close_device          exit|kill|wait
"""

import ctypes
import os
import pathlib
import signal
import sys

folder, interface, command, ending = sys.argv[1:]
dropins = pathlib.Path(folder) / "dropins"


class ErrorInfo(ctypes.Structure):
    _fields_ = [("code", ctypes.c_uint), ("internal", ctypes.c_int), ("device", ctypes.c_uint)]


hd = ctypes.CDLL(dropins / "libHD.so", mode=ctypes.RTLD_GLOBAL)
TICKS = 500  # time for the force to rise
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
    commands = {"disable": lambda: hd.hdDisable(FORCE_OUTPUT),
                "stop_scheduler": hd.hdStopScheduler,
                "close_device": lambda: hd.hdDisableDevice(device)}
    commands[command]()
    hd.hdGetError.restype = ErrorInfo
    assert hd.hdGetError().code == 0
else:
    phantom = ctypes.CDLL(dropins / "libhdPhantom.so")
    zero = ctypes.c_double(0)
    assert phantom.hdPhantomGetNumDevices() == 1
    assert phantom.hdPhantomOpen(0) == 0
    for _ in range(TICKS):
        phantom.hdPhantomSetForce(0, ctypes.byref(zero), ctypes.byref(zero), ctypes.byref(zero))
    if command == "stop_scheduler":
        phantom.hdPhantomStopServo()
    else:
        assert phantom.hdPhantomClose(0) == 0
print("returned", flush=True)
if ending == "exit":
    sys.exit(0)
if ending == "kill":
    os.kill(os.getpid(), signal.SIGKILL)
if ending == "wait":
    signal.pause()
