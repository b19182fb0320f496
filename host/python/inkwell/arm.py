"""An open arm."""

import atexit
import contextlib
import math
import os
import time
import types
import weakref
from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from . import _native, errors
from ._native import Driver, ForceMode, Information, Pose, TestItem
from .parameters import Parameters
from .scope import Samples
from .shapes import Plane, Sphere

Vector = Sequence[float] | npt.NDArray[np.floating]
"""Three numbers along the axes of the workspace."""
Servo = TypeVar("Servo", bound=Callable[[Pose], Vector | None])


def _call(function: Callable[..., Any], *arguments: object, wants: str) -> Any:
    """Calls the library, and says in a sentence what it can not take."""
    try:
        return function(*arguments)
    except TypeError:
        given = ", ".join(repr(each) for each in arguments)
        raise TypeError(f"What was given is {given}. Give {wants}.") from None


_SECONDS = "seconds, a number"
_FORCE = "three numbers, the force in N along x, y and z"

_open: "weakref.WeakSet[Arm]" = weakref.WeakSet()
# An arm that drives stays open, even if no name is left for it.
_driving: "set[Arm]" = set()


@atexit.register
def _close_all() -> None:
    # A servo that is called while the interpreter ends would find none.
    for arm in list(_open):
        with contextlib.suppress(Exception):
            arm.close()


class VirtualHand:
    """The simulated hand of an arm that was opened as "virtual"."""

    def __init__(self, arm: _native.Arm) -> None:
        self._arm = arm

    def move(self, target_m: Vector, stiffness_N_per_m: float = 300.0) -> None:
        """Takes the stylus out of the inkwell and pulls the probe to `target_m` (m) as a spring does, with a hundredth
        of its stiffness as damping."""
        _call(self._arm.move_virtual_hand, target_m, stiffness_N_per_m,
              wants="three numbers, the place in m along x, y and z, and the stiffness in N/m")

    def release(self) -> None:
        """Lets go, so that the arm falls as a real one would."""
        self._arm.release_virtual_hand()

    def press(self, button_1: bool = False, button_2: bool = False) -> None:
        """Presses the buttons that are True and lets go of the others."""
        _call(self._arm.press_virtual_buttons, button_1, button_2, wants="True or False for each button")


class Recording:
    """What a recording has, once it is over."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.samples = 0
        """Control periods in the file."""
        self.lost = 0
        """Control periods that did not reach it."""


class Arm:
    """An open arm, from inkwell.open(). Closes at the end of `with`.

    Lengths are in metres, forces in newtons, angles in radians, times in seconds; positions and forces are in the
    workspace's axes, on the Omni x to the right, y up, z to the user. Any thread may use it; what waits lets the other
    threads run. What goes wrong is an inkwell.Error.
    """

    def __init__(self, address: str | None = None) -> None:
        self._native = _call(_native.Arm, "" if address is None else address, wants="the address as text, or None")
        self._signals: tuple[str, ...] = ()
        self._servo_rate_Hz = self._native.information().servo_rate_Hz
        self.parameters = Parameters(self._native)
        self.virtual_hand = VirtualHand(self._native)
        _open.add(self)

    def close(self) -> None:
        """Ends the servo, lets this program's force fade and forgets the arm. Raises what the servo raised, or what else
        has ended it."""
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
                raised.add_note(f"The servo had ended with {type(error).__name__}: {error}")

    @property
    def information(self) -> Information:
        """What the arm says of itself and has counted; asks it."""
        return self._native.information()

    @property
    def board_name(self) -> str:
        """The board that the arm's firmware is for, such as "omni_driver"; empty if it tells none. Asks it."""
        return self._native.board_name()

    def self_test(self, only_last: bool = False) -> list[TestItem]:
        """Has the board test its motors, bridges, sensors and wires, by small pulses; each item's result, figure and
        remedy. With `only_last` what the newest test has found, without a new one. Raises Refused while the force is on
        or a fault is shown."""
        return self._native.last_self_test() if only_last else self._native.self_test()

    # ---- pose ------------------------------------------------------------------------------------------------

    @property
    def is_referenced(self) -> bool:
        """Whether the arm knows where it is: since the stylus rested in the inkwell, and until counts may have been
        lost. Otherwise the newest pose's position, joints and rotation mean nothing, and its velocity is 0."""
        return self._native.is_referenced()

    @property
    def pose(self) -> Pose:
        """The newest pose, without waiting. Raises Disconnected, which has the last known one, while no poses come."""
        return self._native.pose()

    def wait_for_pose(self, timeout_s: float = 10.0) -> Pose:
        """The next pose that this thread has not seen. Raises TimedOut; Disconnected while the link is lost; and once
        what has ended the servo, if neither the program nor the servo itself did."""
        return _call(self._native.wait_for_pose, timeout_s, wants=_SECONDS)

    def sleep(self, duration_s: float) -> None:
        """Waits until so much board time has passed. Use it instead of time.sleep(): a virtual board's time is not that
        of the PC's clock. Raises TimedOut if no pose comes for 2 s."""
        _call(self._native.sleep, duration_s, wants=_SECONDS)

    def poses(self, duration_s: float = float("inf")) -> Iterator[Pose]:
        """Each next pose, for so much board time; those that come while the loop's body runs are passed over."""
        pose = first = self.wait_for_pose()
        while pose.time_s - first.time_s <= duration_s:
            yield pose
            pose = self.wait_for_pose()

    # ---- force -----------------------------------------------------------------------------------------------

    def enable_force(self, timeout_s: float = 5.0) -> None:
        """Switches the force on: here the program says that a hand may feel it. Waits for the device, which has to know
        where it is. Raises Refused with the remedy, and InUse while another program drives the arm. The faults USB_GONE and
        HOST_SILENT of a program that drove before this one, or before a lost link, are cleared first."""
        _call(self._native.enable_force, timeout_s, wants=_SECONDS)

    def disable_force(self) -> None:
        """Lets the force fall to nothing within soft_landing_s, and returns once it is off. Raises InUse while another
        program drives the arm."""
        self._native.disable_force()

    def stop(self) -> None:
        """Takes the force away at once, whichever program drives the arm, and returns once it is off."""
        self._native.stop()

    def take_over(self) -> None:
        """Takes the arm over from the program that drives it. That program's force fades and its shapes end."""
        self._native.take_over()

    @property
    def driver(self) -> Driver:
        """The program that drives the arm."""
        return self._native.driver()

    def clear_fault(self) -> None:
        """Clears a fault whose cause is gone, and waits for a fifth of a second whether it stays away. Raises Refused with
        the remedy if its cause is still there."""
        self._native.clear_fault()

    def set_force_mode(self, mode: ForceMode) -> None:
        """How this program's forces and the board's walls go together; INSTEAD_OF_WALLS unless it is set."""
        _call(self._native.set_force_mode, mode, wants="one of inkwell.ForceMode")

    def set_force(self, force_N: Vector) -> None:
        """The force on the hand (N; shape (3,)) until the next call. Without another call it fades after
        program_force_expiry_s. Raises InUse if another program drives the arm, and ForceLost once a fault, another
        program or a lost link has switched the force off, until it is on again. In a servo, return the force instead."""
        _call(self._native.set_force, force_N, wants=_FORCE)

    def servo(self, function: Servo) -> Servo:
        """Decorates the function that is called at each pose, a thousand times a second, and returns the force on the
        hand (N; shape (3,)) or None:

            @arm.servo
            def spring(pose):
                return -100 * (pose.position_m - [0, 0, -0.03])

        It is called in a thread of its own until stop_servo() or the end of `with`, which raise what it raised. It also
        ends with a lost force or lost poses: ForceLost, Disconnected or InUse comes once out of the next call of
        wait_for_pose(), poses(), wait_for_servo(), stop_servo(), servo(), or out of the end of `with`. It shares the
        interpreter with the other threads, so let it be short.
        """
        if not callable(function):
            raise TypeError(f"{function!r} can not be called. Give a function that takes a pose and returns a force.")
        self._native.start_servo(function)
        _driving.add(self)
        return function

    def stop_servo(self) -> None:
        """Waits until the servo is not called any more; in a servo, ends it after this call. Raises what it raised, or
        what else has ended it."""
        try:
            self._native.stop_servo()
        finally:
            if not self._native.is_closed() and not self._native.servo_is_running():
                _driving.discard(self)

    @property
    def servo_is_running(self) -> bool:
        """True while the servo is being called."""
        return self._native.servo_is_running()

    def wait_for_servo(self, timeout_s: float = float("inf")) -> bool:
        """Waits until the servo ends by itself, for so much board time, and returns whether it did. Raises what it
        raised, or what else has ended it."""
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
                time.sleep(0.01)  # which ends the servo
        self.stop_servo()
        return True

    def place_shapes(self, *shapes: Plane | Sphere) -> None:
        """Places up to eight planes and one sphere instead of all shapes, at one control period and without a jump of
        the force. Without arguments, takes them away."""
        spheres = [shape for shape in shapes if isinstance(shape, Sphere)]
        planes = [shape for shape in shapes if isinstance(shape, Plane)]
        if len(spheres) + len(planes) < len(shapes):
            raise TypeError("A shape is an inkwell.Plane or an inkwell.Sphere.")
        if len(spheres) > 1:
            raise errors.BadArgument(f"{len(spheres)} spheres are too many. Give the nearest.")
        try:
            self._native.place_shapes(planes, spheres[0] if spheres else None)
        except RuntimeError:  # of a value that can not be converted
            raise TypeError("A value of a shape has a wrong type. Give three numbers for a point, a normal or a centre, "
                            "and one for each of the others.") from None

    # ---- scope and recording ---------------------------------------------------------------------------------

    def select_signals(self, *names: str) -> None:
        """Streams these signals (inkwell.signals() lists them) at every control period from now on; none stops it."""
        _call(self._native.select_signals, names, wants="names of signals as text, which inkwell.signals() lists")
        self._signals = names

    def read_scope(self, rows: int = 4096, timeout_s: float = 1.0) -> Samples:
        """Samples of the selected signals that have come: waits until there are some, and takes at most `rows`. After a
        time-out there are none."""
        return self._samples(rows, timeout_s, False)

    def capture(self, *names: str, duration_s: float, timeout_s: float = 10.0) -> Samples:
        """Selects these signals, takes samples for `duration_s` of board time, all that there are, and selects none
        again. Raises TimedOut if none comes for `timeout_s`."""
        try:
            is_a_time = math.isfinite(duration_s) and duration_s > 0
        except TypeError:
            is_a_time = False
        if not is_a_time:
            raise errors.BadArgument(f"The duration is {duration_s!r}. Give seconds, more than 0.")
        if not names:
            raise errors.BadArgument("No signal is named. Give one at least; inkwell.signals() lists them.")
        self.select_signals(*names)
        try:
            return self._samples(max(1, round(duration_s * self._servo_rate_Hz)), timeout_s, True)
        finally:
            self.select_signals()

    def _samples(self, rows: int, timeout_s: float, fill: bool) -> Samples:
        signals = self._signals
        values, periods, lost = _call(self._native.read_scope, rows, timeout_s, fill,
                                      wants="how many rows, from 0 on, and the time-out in seconds")
        return Samples(signals, values, periods, lost, self._servo_rate_Hz)

    @contextlib.contextmanager
    def record(self, path: str | os.PathLike[str], *names: str) -> Iterator[Recording]:
        """Records these signals into a file (.h5, or .csv) until the end of `with`:

            with arm.record("push.h5", "position_x_m", "force_x_N") as recording:
                arm.sleep(5)
            print(recording.samples, recording.lost)

        Raises at its end what has ended the servo meanwhile, if neither the program nor the servo itself did.
        """
        recording = Recording(os.fspath(path))
        self.select_signals(*names)
        try:
            self._native.start_recording(recording.path)
            try:
                yield recording
            finally:
                recording.samples, recording.lost = self._native.stop_recording()
        finally:
            self.select_signals()
        self._native.check_servo()


def open(address: str | None = None, *, seed: int | None = None) -> Arm:
    """Opens an arm; its force is off.

    address: None           what the environment's INKWELL_DEVICE says, else the only arm on USB
             serial number  the arm on USB that has it
             "usbip:HOST:PORT"  that of a USB/IP server, such as a virtual board that runs already;
                            "usbip:unix:PATH" at a Unix socket
             "virtual"      a virtual board of its own, which ends with the arm; "virtual:FILE" with the arm that FILE
                            describes, "virtual?arm=FILE&elf=FILE" with another firmware too
    seed:    for a virtual board: the seed of its noise. Its time then passes only while a call of this package waits for
             it, such as sleep(), so the same program gives the same samples each time.
    """
    if seed is None:
        return Arm(address)
    if not isinstance(seed, int) or seed < 0:
        raise errors.BadArgument(f"The seed is {seed!r}. Give a whole number from 0 on.")
    if address is None or not (address == "virtual" or address.startswith(("virtual:", "virtual?"))):
        raise errors.BadArgument(f'A seed is for a virtual board, not for {address!r}. Open "virtual".')
    kind, _, options = address.partition("?")
    if kind != "virtual":
        options = "arm=" + address.removeprefix("virtual:")
    return Arm("&".join(filter(None, [f"virtual?seed={seed}", options])))
