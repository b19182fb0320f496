"""What can go wrong, a class for each result of the library. The message says what is wrong and what to do."""

from __future__ import annotations

import typing

if typing.TYPE_CHECKING:
    from ._native import Pose


class Error(Exception):
    """Anything that the library or the arm refuses; the classes below say more."""

    result: int


class NoDevice(Error):
    """No arm is there, or more than one and none was named."""

    result = 1


class NoPermission(Error, PermissionError):
    """The user may not use the device."""

    result = 2


class Incompatible(Error):
    """The arm's firmware belongs to another version of this library."""

    result = 3


class Disconnected(Error, ConnectionError):
    """No poses come: the link to the arm is lost, or the arm is silent. The library looks for the same arm until it is
    back, and then goes on with it. After a lost link the force is off; enable_force() switches it on again."""

    result = 4
    last_pose: Pose | None = None
    """The last known pose."""


class InUse(Error):
    """Another program has what only one can have."""

    result = 5


class BadArgument(Error, ValueError):
    """A value that the function can not take."""

    result = 6


class Refused(Error):
    """The arm does not take it, or not now."""

    result = 7


class TimedOut(Error, TimeoutError):
    """What was waited for did not come."""

    result = 8


class Failed(Error):
    """Anything else; the message says what."""

    result = 9


class ForceLost(Error):
    """The force went off, and this program did not switch it off: a fault, another program, or a lost link."""

    result = 10


BY_RESULT = {each.result: each for each in Error.__subclasses__()}
