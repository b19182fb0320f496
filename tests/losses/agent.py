"""Carries out the commands of losses_test.py through one interface:

    agent.py BUILD_FOLDER c | python | hdapi | hdphantom | command-line
"""

import ctypes
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import time

BUILD = pathlib.Path(sys.argv[1])
PUSHES = 30


class Failed(Exception):
    """With the probe's x, if it is read, in front of the sentence."""


class C:
    """libinkwell through its C interface."""

    POSE_SIZE = 240
    POSITION_AT = 24

    def __init__(self):
        self.library = ctypes.CDLL(BUILD / "libinkwell.so")
        self.library.inkwell_error_text.restype = ctypes.c_char_p
        self.arm = ctypes.c_void_p()
        self.pose_bytes = ctypes.create_string_buffer(self.POSE_SIZE)

    def require(self, result):
        if result != 0:
            raise Failed(self.library.inkwell_error_text().decode())

    def open(self, address):
        self.close()
        self.require(self.library.inkwell_open(address.encode(), ctypes.byref(self.arm)))
        self.enable()

    def enable(self):
        self.require(self.library.inkwell_clear_fault(self.arm))
        self.require(self.library.inkwell_enable_force(self.arm, ctypes.c_double(30)))

    def pose(self):
        result = self.library.inkwell_get_pose(self.arm, self.pose_bytes)
        x_m = ctypes.c_double.from_buffer(self.pose_bytes, self.POSITION_AT).value
        if result != 0:
            raise Failed(f"{x_m} {self.library.inkwell_error_text().decode()}")
        return x_m

    def push(self, force_N):
        force = (ctypes.c_double * 3)(force_N, 0, 0)
        for _ in range(PUSHES):
            self.library.inkwell_wait_for_pose(self.arm, ctypes.c_double(0.05), self.pose_bytes)
            self.require(self.library.inkwell_set_force(self.arm, force))

    def close(self):
        self.require(self.library.inkwell_close(self.arm))
        self.arm = ctypes.c_void_p()


class Python:
    """The package inkwell."""

    def __init__(self):
        import inkwell
        self.inkwell = inkwell
        self.arm = None

    def _call(self, function, *arguments):
        try:
            return function(*arguments)
        except self.inkwell.Error as error:
            raise Failed(str(error)) from None

    def open(self, address):
        if self.arm:
            self.close()
        self.arm = self._call(self.inkwell.open, address)
        self.enable()

    def take_over(self, address):
        self.arm = self._call(self.inkwell.open, address)
        self._call(self.arm.take_over)

    def enable(self):
        self._call(self.arm.clear_fault)
        self._call(self.arm.enable_force, 30)

    def pose(self):
        try:
            return self.arm.pose.position_m[0]
        except self.inkwell.Disconnected as error:
            raise Failed(f"{error.last_pose.position_m[0]} {error}") from None
        except self.inkwell.Error as error:
            raise Failed(f"0 {error}") from None

    def push(self, force_N):
        for _ in range(PUSHES):
            try:
                self.arm.wait_for_pose(0.05)
            except self.inkwell.Error:
                pass
            self._call(self.arm.set_force, (force_N, 0, 0))

    def close(self):
        self._call(self.arm.close)


class Hdapi:
    """libHD: a frame in each of its ticks."""

    CURRENT_POSITION, CURRENT_FORCE, RAMPING_RATE, FORCE_OUTPUT = 0x2050, 0x2700, 0x2608, 0x4000
    CALLBACK = ctypes.CFUNCTYPE(ctypes.c_uint, ctypes.c_void_p)

    class ErrorInfo(ctypes.Structure):
        _fields_ = [("code", ctypes.c_uint), ("internal", ctypes.c_int), ("device", ctypes.c_uint)]

    def __init__(self):
        self.library = ctypes.CDLL(BUILD / "dropins/libHD.so", mode=ctypes.RTLD_GLOBAL)
        self.library.hdGetError.restype = self.ErrorInfo
        self.library.hdGetErrorString.restype = ctypes.c_char_p
        self.library.hdInitDevice.restype = ctypes.c_uint
        self.device = ctypes.c_uint(0xFFFFFFFF)
        self.x_m = 0.0

    def sentence(self):
        """Of the oldest error; empty if there is none."""
        sentence = ""
        while (error := self.library.hdGetError()).code != 0:
            sentence = self.library.hdGetErrorString(error.code).decode()
        return sentence

    def require(self):
        if sentence := self.sentence():
            raise Failed(sentence)

    def in_ticks(self, count, action):
        left = count

        def tick(_):
            nonlocal left
            action()
            left -= 1
            return 1 if left > 0 else 0

        self.library.hdScheduleSynchronous(self.CALLBACK(tick), None, ctypes.c_ushort(100))

    def frame(self, force_N=None):
        position_mm = (ctypes.c_double * 3)(1e3 * self.x_m)
        self.library.hdBeginFrame(self.device)
        self.library.hdGetDoublev(self.CURRENT_POSITION, position_mm)
        if force_N is not None:
            self.library.hdSetDoublev(self.RAMPING_RATE, (ctypes.c_double * 1)(100))
            self.library.hdSetDoublev(self.CURRENT_FORCE, (ctypes.c_double * 3)(force_N, 0, 0))
        self.library.hdEndFrame(self.device)
        self.x_m = 1e-3 * position_mm[0]

    def open(self, address):
        self.device = ctypes.c_uint(self.library.hdInitDevice(address.encode()))
        self.require()
        self.library.hdEnable(self.FORCE_OUTPUT)
        self.library.hdStartScheduler()
        self.require()

    def enable(self):
        self.library.hdEnable(self.FORCE_OUTPUT)
        self.require()

    def pose(self):
        self.in_ticks(1, self.frame)
        if sentence := self.sentence():
            raise Failed(f"{self.x_m} {sentence}")
        return self.x_m

    def push(self, force_N):
        self.in_ticks(PUSHES, lambda: self.frame(force_N))
        self.require()

    def close(self):
        self.library.hdStopScheduler()
        self.library.hdDisableDevice(self.device)
        self.require()


class HdPhantom:
    """libhdPhantom, through which CHAI3D drives: its y is the arm's x."""

    def __init__(self):
        ctypes.CDLL(BUILD / "dropins/libHD.so", mode=ctypes.RTLD_GLOBAL)
        self.library = ctypes.CDLL(BUILD / "dropins/libhdPhantom.so", mode=ctypes.RTLD_GLOBAL)

    def require(self, result, *values):
        if result < 0:
            raise Failed(" ".join(map(str, values)))

    def open(self, _):
        self.library.hdPhantomGetNumDevices()
        self.require(self.library.hdPhantomOpen(0))

    def enable(self):
        self.require(self.library.hdPhantomOpen(0))

    def pose(self):
        position = [ctypes.c_double(math.nan) for _ in range(3)]
        turn = [ctypes.c_double(math.nan) for _ in range(9)]
        result, turned = 0, -1
        for _ in range(3):  # a loss may begin or end between the two calls
            result = self.library.hdPhantomGetPosition(0, *map(ctypes.byref, position))
            turned = self.library.hdPhantomGetRotation(0, *map(ctypes.byref, turn))
            if (result < 0) == (turned < 0):
                break
        assert (result < 0) == (turned < 0)
        assert abs(math.hypot(*(each.value for each in turn[:3])) - 1) < 1e-3, [each.value for each in turn]
        self.require(result, position[1].value)
        return position[1].value

    def push(self, force_N):
        force, none = ctypes.c_double(force_N), ctypes.c_double(0)
        for _ in range(PUSHES):
            self.require(self.library.hdPhantomSetForce(0, ctypes.byref(none), ctypes.byref(force), ctypes.byref(none)))

    def close(self):
        self.require(self.library.hdPhantomClose(0))


class CommandLine:
    """`inkwell force on` drives for as long as it runs, `inkwell watch` reads poses. Neither sends a force: the hand
    feels a wall of the box."""

    def __init__(self):
        self.server = ""
        self.force = self.watch = None
        self.force_error = ""  # error of the last `force on`
        self.x_m = 0.0

    def start(self, *words):
        return subprocess.Popen([BUILD / "inkwell", *words, "--usbip", self.server],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def fail(self, sentence):
        raise Failed(f"{self.x_m} {sentence.strip()}")

    def open(self, address):
        self.close()
        self.server = address.removeprefix("usbip:")
        self.enable()

    def enable(self):
        if self.force and self.force.poll() is None:
            return
        subprocess.run([BUILD / "inkwell", "fault", "clear", "--usbip", self.server], capture_output=True)
        self.force, self.force_error = self.start("force", "on"), ""
        if not self.force.stdout.readline():
            self.force_error = self.force.communicate()[1]
            self.fail(self.force_error)

    def pose(self):
        """The position in the next line of a running `watch`."""
        self.watch = self.watch or self.start("watch", "--json", "--rate", "20")
        line = self.watch.stdout.readline()
        if not line:
            watch, self.watch = self.watch, None
            self.fail(watch.communicate()[1])
        self.x_m = json.loads(line)["position_m"][0]
        return self.x_m

    def push(self, _):
        if self.force is None:
            self.fail("No command has the force on.")
        time.sleep(0.03)
        if self.force.poll() is not None:
            self.force_error = self.force_error or self.force.stderr.read()
            self.fail(self.force_error)

    def close(self):
        for program in filter(None, (self.force, self.watch)):
            program.send_signal(signal.SIGINT)
            program.wait(60)
        self.force = self.watch = None


INTERFACES = {"command-line": CommandLine, "c": C, "python": Python, "hdapi": Hdapi, "hdphantom": HdPhantom}


def main():
    interface = INTERFACES[sys.argv[2]]()
    for line in sys.stdin:
        name, *words = line.split()
        arguments = [float(word) for word in words] if name == "push" else words
        try:
            answer = getattr(interface, name)(*arguments)
            print("ok" if answer is None else f"ok {answer}", flush=True)
        except Failed as failure:
            print("error", failure, flush=True)
    if isinstance(interface, CommandLine):
        interface.close()
    os._exit(0)


if __name__ == "__main__":
    main()
