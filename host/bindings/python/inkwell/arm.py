"""An open arm."""

import atexit
import contextlib
import dataclasses
import json
import math
import os
import time
import types
import warnings
import weakref
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from . import _native, errors
from ._native import Abilities, ArmState, Driver, ForceMode, Information, Losses, Pose, TestItem
from .parameters import Parameters
from .scene import Scene
from .scope import Samples
from .shapes import Plane, Solid

Vector = Sequence[float] | npt.NDArray[np.floating]
"""Three numbers along the workspace axes."""
Servo = TypeVar("Servo", bound=Callable[[Pose], Vector | None])


def _call(function: Callable[..., Any], *arguments: object, wants: str) -> Any:
    """Calls the library. Describes arguments of a wrong type in a sentence."""
    try:
        return function(*arguments)
    except TypeError:
        given = ", ".join(repr(each) for each in arguments)
        raise TypeError(f"The argument is {given}. Give {wants}.") from None


# A servo call of this duration is reported.
_SLOW_CALL_S = 0.02
_SECONDS = "seconds, a number"
_FORCE = "three numbers, the force in N along x, y and z"

_open: "weakref.WeakSet[Arm]" = weakref.WeakSet()
# This set prevents the garbage collection of driving arms.
_driving: "set[Arm]" = set()


@atexit.register
def _close_all() -> None:
    # Closes all arms, because servos must not run while the interpreter exits.
    for arm in list(_open):
        with contextlib.suppress(Exception):
            arm.close()


class VirtualHand:
    """The simulated hand of an arm that was opened as "virtual", or of any virtual board after connect()."""

    def __init__(self, arm: _native.Arm) -> None:
        self._arm = arm

    def connect(self, control: str) -> None:
        """Connects the hand of a virtual board that was opened as "usbip:...". `control` is the address of the board's
        control socket, "HOST:PORT" or "unix:PATH"."""
        _call(self._arm.connect_virtual_hand, control, wants="the address of the control socket as text")

    def move(self, target_m: Vector, stiffness_N_per_m: float = 300.0, damping_Ns_per_m: float | None = None) -> None:
        """Lifts the stylus out of the inkwell and pulls the probe to `target_m` (m) with a spring. By default, the damping
        in Ns/m is a hundredth of the stiffness."""
        wants = "three numbers, the position in m along x, y and z, the stiffness in N/m, and the damping in Ns/m"
        if damping_Ns_per_m is None:
            _call(self._arm.move_virtual_hand, target_m, stiffness_N_per_m, wants=wants)
        else:
            _call(self._arm.hold_virtual_hand, target_m, stiffness_N_per_m, damping_Ns_per_m, wants=wants)

    def follow(self, path: Sequence[tuple[float, Vector]]) -> None:
        """Moves the target of a hand that holds the stylus smoothly through these points. Each point is the board time from
        now on (s) and the target (m)."""
        _call(self._arm.move_virtual_hand_along, path, wants="points: a time in s and three numbers in m each")

    def truth(self) -> dict[str, Any]:
        """The true values of the simulation, such as the force on the hand."""
        return json.loads(self._arm.virtual_truth())

    def release(self) -> None:
        """Releases the stylus, and the arm falls like a real arm."""
        self._arm.release_virtual_hand()

    def press(self, button_1: bool = False, button_2: bool = False) -> None:
        """Presses the buttons that are True and releases the others."""
        _call(self._arm.press_virtual_buttons, button_1, button_2, wants="True or False for each button")


@dataclasses.dataclass
class Recording:
    """Result of a recording, which is valid after its end."""

    path: str
    samples: int = 0
    """Control periods in the file."""
    lost: int = 0
    """Control periods that were lost."""
    complete: bool = False
    """True if nothing is missing: no sample was lost, and the link was not lost."""


class Arm:
    """An open arm, from inkwell.open(). Closes at the end of `with`.

    Lengths are in meters, forces in newtons, angles in radians, times in seconds. Positions and forces are in the
    workspace axes. On the Omni x points to the right, y up, z to the user. Any thread may use the arm; calls that wait
    let other threads run. Errors are raised as inkwell.Error.
    """

    def __init__(self, address: str | None = None, timeout_s: float | None = None) -> None:
        text = "" if address is None else address
        if timeout_s is None:
            self._native = _call(_native.Arm, text, wants="the address as text, or None")
        else:
            self._native = _call(_native.Arm, text, timeout_s,
                                 wants="the address as text or None, and the time-out in seconds")
        self._signals: tuple[str, ...] = ()
        self._servo_rate_Hz = self._native.information().servo_rate_Hz
        self._reported_call_s = _SLOW_CALL_S
        self._process_id = os.getpid()
        self.parameters = Parameters(self._native)
        self.scene = Scene(self._native)
        self.virtual_hand = VirtualHand(self._native)
        _open.add(self)

    def close(self) -> None:
        """Stops the servo, fades this program's force and closes the arm. Raises the exception of the servo, or any other
        cause that has stopped it."""
        self._report_slow_servo()
        try:
            self._native.close()
        finally:
            if self._native.is_closed():
                _driving.discard(self)
                _open.discard(self)

    def __enter__(self) -> "Arm":
        return self

    def __exit__(self, kind: type[BaseException] | None, raised: BaseException | None,
                 _: types.TracebackType | None) -> None:
        try:
            self.close()
        except Exception as error:
            if raised is None:
                raise
            if str(error) != str(raised):
                raised.add_note(f"The servo had stopped with {type(error).__name__}: {error}")

    @property
    def information(self) -> Information:
        """Identity and counters, read from the arm."""
        return self._native.information()

    @property
    def board_name(self) -> str:
        """The board that the arm's firmware was built for, such as "omni_driver", read from the arm. Empty if the firmware
        does not report it."""
        return self._native.board_name()

    def self_test(self, only_last: bool = False) -> list[TestItem]:
        """Runs the board's self-test of motors, bridges, sensors and wires with small pulses. Returns result, figure and
        remedy of each item. With `only_last` it returns the results of the last test, without a new test. Raises Refused
        while the force is on or the board reports a fault."""
        return self._native.last_self_test() if only_last else self._native.self_test()

    # ---- pose ------------------------------------------------------------------------------------------------

    @property
    def is_referenced(self) -> bool:
        """True while the encoders are referenced. They are referenced when the stylus rests in the inkwell, until encoder
        counts may have been lost. Otherwise the newest pose has no valid position, joints and rotation. Its velocity is
        0."""
        return self._native.is_referenced()

    @property
    def pose(self) -> Pose:
        """The newest pose, without waiting. Raises Disconnected, with the last known pose, while no poses arrive."""
        return self._native.pose()

    def wait_for_pose(self, timeout_s: float = 10.0) -> Pose:
        """Waits for the next pose that this thread has not read. Raises TimedOut, and Disconnected while the link is lost.
        If the library has stopped the servo, it raises the cause once."""
        return _call(self._native.wait_for_pose, timeout_s, wants=_SECONDS)

    def sleep(self, duration_s: float) -> None:
        """Waits until this board time has passed. Use it instead of time.sleep(): a virtual board's time differs from the
        PC's clock. Raises TimedOut if no pose arrives for 2 s."""
        _call(self._native.sleep, duration_s, wants=_SECONDS)

    def poses(self, duration_s: float = float("inf")) -> Iterator[Pose]:
        """Yields the next pose for this board time. Poses that arrive while the loop body runs are skipped."""
        pose = first = self.wait_for_pose()
        while pose.time_s - first.time_s <= duration_s:
            yield pose
            pose = self.wait_for_pose()

    # ---- state, abilities ------------------------------------------------------------------------------------

    @property
    def state(self) -> ArmState:
        """The newest pose with its validity, joint speeds, angular velocity and the host's time of its arrival. Raises
        Disconnected while no poses arrive."""
        return self._native.state()

    @property
    def abilities(self) -> Abilities:
        """Workspace, forces, torques and joint stops, read from the arm."""
        return self._native.abilities()

    def forward_kinematics(self, joint_rad: Vector) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Returns the probe's position (m; shape (3,)) and Jacobian (m/rad; shape (3, 3)) for these joint angles.

        On the Omni, joint 1 is positive to the left, and joint 2 is the elevation of link 2. Joint 3 is the direction of
        link 3, measured from the base; at 0 link 3 points straight down. The angle of link 3 relative to link 2 is joint 3
        minus joint 2."""
        position_m, jacobian = _call(self._native.forward_kinematics, joint_rad, wants="three joint angles in rad")
        return np.array(position_m), np.array(jacobian).reshape(3, 3)

    def force_of_torques(self, joint_rad: Vector, torque_Nm: Vector) -> npt.NDArray[np.float64]:
        """Returns the force at the probe that requires these joint torques. Raises Refused if the arm is stretched or
        folded."""
        return np.array(_call(self._native.force_of_torques, joint_rad, torque_Nm,
                              wants="three joint angles in rad and three torques in Nm"))

    # ---- force -----------------------------------------------------------------------------------------------

    def claim(self) -> None:
        """Claims the arm without a force. Raises InUse while another program drives the arm."""
        self._native.claim()

    def release(self) -> None:
        """Reduces the force to zero, removes the shapes and ends the claim. The arm stays open."""
        self._native.release()

    def set_joint_torques(self, torque_Nm: Vector) -> None:
        """Sets the force that requires these joint torques (Nm; shape (3,)) at the newest pose, as set_force() does."""
        _call(self._native.set_joint_torques, torque_Nm, wants="three numbers, the joint torques in Nm")

    def set_thread_priority(self, priority: int) -> None:
        """Schedules the arm's threads with SCHED_FIFO and this priority, 1 to 99; 0 selects normal scheduling. Raises
        NoPermission if the user may not set real-time priorities."""
        _call(self._native.set_thread_priority, priority, wants="a whole number from 0 to 99")

    def enable_force(self, timeout_s: float = 5.0) -> None:
        """Switches the force on and waits until it is on. From here on the hand may feel a force. Raises Refused with the
        remedy, for example if the encoders are not referenced. Raises InUse while another program drives the arm. The
        faults USB_GONE and HOST_SILENT of a previous driver, or from before a lost link, are cleared first."""
        _call(self._native.enable_force, timeout_s, wants=_SECONDS)

    def disable_force(self) -> None:
        """Reduces the force to zero within soft_landing_s, and returns when the force is off. Raises InUse while another
        program drives the arm."""
        self._native.disable_force()

    def stop(self) -> None:
        """Switches the force off immediately, whichever program drives the arm, and returns when the force is off."""
        self._native.stop()

    def take_over(self) -> None:
        """Takes the arm over from the program that drives it. That program's force fades, and its shapes are
        removed."""
        self._native.take_over()

    @property
    def driver(self) -> Driver:
        """The program that drives the arm."""
        return self._native.driver()

    def clear_fault(self) -> None:
        """Clears a fault whose cause is gone, and waits 0.2 s to confirm that it does not recur. Raises Refused with the
        remedy if the cause is still present."""
        self._native.clear_fault()

    def set_force_mode(self, mode: ForceMode) -> None:
        """Sets how this program's forces combine with the board's walls. The default is INSTEAD_OF_WALLS."""
        _call(self._native.set_force_mode, mode, wants="one of inkwell.ForceMode")

    def set_force(self, force_N: Vector) -> None:
        """Sets the force on the hand (N; shape (3,)) until the next call. Without another call it fades after
        program_force_expiry_s. Raises InUse if another program drives the arm. After a fault, another program or a lost
        link has switched the force off, it raises ForceLost until the force is on again. In a servo, return the force
        instead."""
        _call(self._native.set_force, force_N, wants=_FORCE)

    def servo(self, function: Servo) -> Servo:
        """Decorates the function that is called at each pose, 1000 times per second. It returns the force on the hand
        (N; shape (3,)) or None:

            @arm.servo
            def spring(pose):
                return -100 * (pose.position_m - [0, 0, -0.03])

        The function is called in a separate thread until stop_servo() or the end of `with`, which raise its exception.
        The servo also stops when the force or the poses are lost. ForceLost, Disconnected or InUse is then raised once, by
        the next call of wait_for_pose(), poses(), wait_for_servo(), stop_servo() or servo(), or at the end of `with`.
        The function shares the interpreter with the other threads, so keep it short.
        """
        if not callable(function):
            raise TypeError(f"{function!r} cannot be called. Give a function that accepts a pose and returns a force.")
        self._native.start_servo(function)
        _driving.add(self)
        return function

    def stop_servo(self) -> None:
        """Stops the servo and waits until its last call has returned. In a servo it stops the servo after this call. Raises
        the exception of the servo, or any other cause that has stopped it."""
        try:
            self._native.stop_servo()
        finally:
            self._report_slow_servo()
            if not self._native.is_closed() and not self._native.servo_is_running():
                _driving.discard(self)

    def _report_slow_servo(self) -> None:
        if self._native.is_closed() or not self._native_is_here():
            return
        longest_s = self._native.losses().longest_servo_call_s
        if longest_s > self._reported_call_s:
            self._reported_call_s = longest_s
            warnings.warn(f"A call of the servo took {1000 * longest_s:.0f} ms. The force did not change meanwhile, and a "
                          "real arm's poses were missed. Keep each call below 1 ms; Arm.losses counts the slow calls.",
                          RuntimeWarning, stacklevel=3)

    def _native_is_here(self) -> bool:
        return self._process_id == os.getpid()

    @property
    def losses(self) -> Losses:
        """Lost poses and slow calls of the servo since the arm was opened."""
        return self._native.losses()

    def send_test_pulse(self, motor: int, *, voltage_V: float | None = None, current_A: float | None = None,
                        duration_s: float = 0.005) -> None:
        """Sends a pulse of 0 to 0.1 s to motor 1, 2 or 3 in the state READY: a voltage, with the current loop off, or a
        current. Returns when the board has started it; the arm then rests for the same time. Select the signals
        current_1_A and duty_1 first, or record them. A current is sampled at the start of its control period, and a duty
        acts from the next period on."""
        if (voltage_V is None) == (current_A is None):
            raise errors.BadArgument("A pulse needs either a voltage or a current. Give voltage_V or current_A.")
        unit, amplitude = ("A", current_A) if voltage_V is None else ("V", voltage_V)
        _call(self._native.send_test_pulse, motor, unit, amplitude, duration_s,
              wants="the number of the motor, volts or amperes, and seconds")

    @property
    def servo_is_running(self) -> bool:
        """True while the servo is being called."""
        return self._native.servo_is_running()

    def wait_for_servo(self, timeout_s: float = float("inf")) -> bool:
        """Waits until the servo stops by itself, for at most this board time. Returns whether it stopped. Raises the
        exception of the servo, or any other cause that has stopped it."""
        waited_s = 0.0
        while self.servo_is_running:
            if waited_s > timeout_s:
                return False
            try:
                self.sleep(0.01)
                waited_s += 0.01
            except errors.TimedOut:
                waited_s += 2.0
            except errors.Disconnected:
                time.sleep(0.01)  # a lost link stops the servo
        self.stop_servo()
        return True

    def place_shapes(self, *shapes: Plane | Solid) -> None:
        """Replaces all shapes by up to eight planes and sixteen solids (Sphere, Capsule, Cylinder, Box), in one control
        period and without a jump of the force. Without arguments it removes all shapes."""
        planes = [shape for shape in shapes if isinstance(shape, Plane)]
        solids = [shape for shape in shapes if isinstance(shape, Solid)]
        if len(planes) + len(solids) < len(shapes):
            raise TypeError("A shape has a wrong type. Give an inkwell.Plane, Sphere, Capsule, Cylinder or Box.")
        try:
            self._native.place_shapes(planes, solids)
        except RuntimeError:  # a value cannot be converted
            raise TypeError("A value of a shape has a wrong type. Give three numbers for a point, a normal or a center, "
                            "four for a quaternion, and one number for each other value.") from None

    # ---- scope, recording ----------------------------------------------------------------------------------

    def select_signals(self, *names: str) -> None:
        """Starts to stream these signals at every control period; inkwell.signals() lists them. Without names it stops the
        stream. Of more than 32 signals, those after the 32nd in the order of the list are updated at 1250 Hz."""
        _call(self._native.select_signals, names, wants="signal names as text; inkwell.signals() lists them")
        self._signals = names

    def read_scope(self, rows: int = 4096, timeout_s: float = 1.0) -> Samples:
        """Waits for samples of the selected signals, and returns at most `rows` of them. After a time-out it returns no
        samples."""
        return self._samples(rows, timeout_s, False)

    def capture(self, *names: str, duration_s: float, timeout_s: float = 10.0) -> Samples:
        """Selects these signals, records all their samples for `duration_s` of board time, and stops the stream. Raises
        TimedOut if no sample arrives for `timeout_s`."""
        try:
            is_a_time = math.isfinite(duration_s) and duration_s > 0
        except TypeError:
            is_a_time = False
        if not is_a_time:
            raise errors.BadArgument(f"The duration is {duration_s!r}. Give a time of more than 0 s.")
        if not names:
            raise errors.BadArgument("No signal is given. Give at least one. inkwell.signals() lists all signals.")
        self.select_signals(*names)
        try:
            return self._samples(max(1, round(duration_s * self._servo_rate_Hz)), timeout_s, True)
        finally:
            self.select_signals()

    def _samples(self, rows: int, timeout_s: float, fill: bool) -> Samples:
        signals = self._signals
        values, periods, lost = _call(self._native.read_scope, rows, timeout_s, fill,
                                      wants="the number of rows, 0 or more, and the time-out in seconds")
        return Samples(signals, values, periods, lost, self._servo_rate_Hz)

    @contextlib.contextmanager
    def record(self, path: str | os.PathLike[str], *names: str, name: str = "", note: str = "") -> Iterator[Recording]:
        """Records these signals to a file (.h5 or .csv) until the end of `with`:

            with arm.record("push.h5", "position_x_m", "force_x_N", name="subject 7") as recording:
                arm.mark("stimulus")
                arm.sleep(5)
            print(recording.samples, recording.lost, recording.complete)

        The file also holds marks, buttons, force sources, shapes, faults, losses and parameter changes with board time.
        If the library has stopped the servo meanwhile, the end of `with` raises the cause.
        """
        recording = Recording(os.fspath(path))
        self.select_signals(*names)
        try:
            _call(self._native.describe_recordings, name, note, wants="name and note as text")
            self._native.start_recording(recording.path)
            try:
                yield recording
            finally:
                recording.samples, recording.lost, recording.complete = self._native.finish_recording()
        finally:
            self.select_signals()
        self._native.check_servo()

    def mark(self, text: str) -> None:
        """Marks the newest pose in the running recording. Raises Refused without a recording."""
        _call(self._native.mark, text, wants="the text of the mark")


def open(address: str | None = None, *, seed: int | None = None, arm: str | os.PathLike[str] | None = None,
         elf: str | os.PathLike[str] | None = None, timeout_s: float | None = None) -> Arm:
    """Opens an arm; its force is off.

    address: None           the address in the environment variable INKWELL_DEVICE, otherwise the only arm on USB
             serial number  the arm on USB with this number
             name           the arm with this name, such as "left"; inkwell.names() returns all names
             "usbip:HOST:PORT"  the arm of a USB/IP server, such as a running virtual board;
                            "usbip:unix:PATH" for a Unix socket
             "virtual"      a new virtual board, which exits with the arm

    timeout_s: time of the host's clock for the first pose; by default 60 s. Afterwards TimedOut is raised.

    Options of a new virtual board:

    seed:    seed of the noise. Board time then passes only while a call of this package, such as sleep(), waits for the
             board. The same program therefore returns the same samples each time.
    arm:     file with the arm description; by default the Omni
    elf:     firmware image, such as an image with a force law; by default the firmware of this installation

    The address "virtual:FILE" also selects an arm description, and "virtual?seed=7&arm=FILE&elf=FILE" all three.
    """
    options: dict[str, str] = {}
    if seed is not None:
        if not isinstance(seed, int) or seed < 0:
            raise errors.BadArgument(f"The seed is {seed!r}. Give a whole number of 0 or more.")
        options["seed"] = str(int(seed))
    for name, file in (("arm", arm), ("elf", elf)):
        if file is not None:
            options[name] = _file_name(name, file)
    if not options:
        return Arm(address, timeout_s)
    if not isinstance(address, str) or not (address == "virtual" or address.startswith(("virtual:", "virtual?"))):
        raise errors.BadArgument(f'The option {next(iter(options))} requires a virtual board, not {address!r}. '
                                 'Open "virtual".')
    kind, _, given = address.partition("?")
    if kind != "virtual":
        given = "arm=" + address.removeprefix("virtual:")
    for each in filter(None, given.split("&")):
        name = each.partition("=")[0]
        if name in options:
            raise errors.BadArgument(f"The option {name} is given twice, also in the address {address!r}. Give it once.")
    return Arm("virtual?" + "&".join(filter(None, [given, *(f"{name}={value}" for name, value in options.items())])),
               timeout_s)


def _file_name(option: str, file: str | os.PathLike[str]) -> str:
    if not isinstance(file, (str, os.PathLike)):
        raise TypeError(f"The option {option} is {file!r}. Give the name of a file.")
    name = os.fspath(file)
    if not isinstance(name, str) or not name or "&" in name:
        raise errors.BadArgument(f"The option {option} is {name!r}. Give the name of a file as text without the character &.")
    return name
