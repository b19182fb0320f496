"""Virtual boards that tests start beside the program under test or inside it, and their hands."""

import json
import math
import pathlib
import re
import socket
import subprocess
import time
from collections.abc import Callable, Sequence

import inkwell

FREE_POINT_M = (0.0, 0.0, -0.03)  # the middle of the box
AXES = "xyz"


def be_patient(arm: inkwell.Arm) -> None:
    """On a busy computer the programs are late, which is not what is tested."""
    arm.parameters.set(host_timeout_s=2, program_force_expiry_s=0.5)


def wait_until(arm: inkwell.Arm, condition: Callable[[inkwell.Pose], bool], limit_s: float = 10.0) -> inkwell.Pose:
    """The first pose that fulfils the condition, within so much board time."""
    begin_s = arm.pose.time_s
    while True:
        pose = arm.wait_for_pose(10)
        if condition(pose):
            return pose
        if pose.time_s > begin_s + limit_s:
            raise AssertionError(f"within {limit_s} s it did not come to this; last: {pose}")


def make_active(arm: inkwell.Arm) -> None:
    be_patient(arm)
    wait_until(arm, lambda pose: pose.state == inkwell.State.READY)
    arm.virtual_hand.move(FREE_POINT_M)
    wait_until(arm, lambda pose: math.hypot(*pose.position_m[:2]) < 0.004)
    arm.enable_force(30)


class VirtualBoard:
    """Ends at the end of `with`. Times are those of the board. Unless its stylus is in the inkwell at first, the board
    does not know where it is."""

    def __init__(self, build: pathlib.Path, seed: int = 1, elf: str = "inkwell.elf", in_inkwell: bool = True) -> None:
        self._process = subprocess.Popen(
            [build / "virtual-board", "--elf", build.parent / "board" / elf, "--real-time", "--paused", "--seed", str(seed)],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        ready = self._process.stdout.readline()
        ports = re.fullmatch(r"ready usbip=(\d+) control=(\d+)\n", ready)
        assert ports, f"the virtual board did not start: {ready!r}"
        self.address = f"usbip:127.0.0.1:{ports[1]}"
        self.control_address = f"127.0.0.1:{ports[2]}"
        self._control = socket.create_connection(("127.0.0.1", int(ports[2])))
        self._replies = self._control.makefile()
        self.call("dock", docked=in_inkwell)
        self.call("resume")
        self.let_pass(0.5)  # until the board is enumerated on USB

    def __enter__(self) -> "VirtualBoard":
        return self

    def __exit__(self, *_: object) -> None:
        self._replies.close()
        self._control.close()
        self._process.terminate()
        self._process.wait()
        self._process.stdout.close()

    def call(self, command: str, **arguments: object) -> dict:
        self._control.sendall(json.dumps({"command": command, **arguments}).encode() + b"\n")
        reply = json.loads(self._replies.readline())
        assert reply["ok"], reply
        return reply

    def truth(self) -> dict:
        return self.call("truth")

    def position_m(self) -> list[float]:
        now = self.truth()
        return [now[f"true_position_{axis}_m"] for axis in AXES]

    def hold(self, target_m: Sequence[float], stiffness_N_per_m: float = 300.0) -> None:
        """The hand takes the stylus out of the inkwell and pulls the probe to `target_m` as a spring does."""
        self.call("hand", holds=True, target_m=list(target_m), stiffness_N_per_m=stiffness_N_per_m,
                  damping_Ns_per_m=0.01 * stiffness_N_per_m)
        self.call("dock", docked=False)

    def wait_until(self, condition: Callable[[dict], bool], limit_s: float = 10.0) -> dict:
        """The first truth that fulfils the condition, within so much board time."""
        begin_s = self.truth()["board_time_s"]
        while True:
            now = self.truth()
            if condition(now):
                return now
            if now["board_time_s"] > begin_s + limit_s:
                raise AssertionError(f"within {limit_s} s it did not come to this; last: {now}")
            time.sleep(0.005)  # each answer stops the board for a short time

    def let_pass(self, duration_s: float) -> None:
        end_s = self.truth()["board_time_s"] + duration_s
        self.wait_until(lambda now: now["board_time_s"] >= end_s, duration_s + 10)

    def take_to(self, point_m: Sequence[float], stiffness_N_per_m: float = 300.0) -> None:
        """Lets the arm find out where it is, then holds the stylus at a point and waits until it rests there."""
        self.let_pass(max(0.0, 1.0 - self.truth()["board_time_s"]))
        with inkwell.open(self.address) as arm:
            be_patient(arm)
        self.hold(point_m, stiffness_N_per_m)
        self.wait_until(rests_at_x(point_m[0]))


def rests_at_x(x_m: float, tolerance_m: float = 0.001) -> Callable[[dict], bool]:
    return lambda now: (abs(now["true_position_x_m"] - x_m) < tolerance_m
                        and abs(now["true_velocity_x_m_s"]) < 0.005)
