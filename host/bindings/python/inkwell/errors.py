"""Errors: one class for each result of the library. The message states what is wrong and what to do."""

from __future__ import annotations

import typing

if typing.TYPE_CHECKING:
    from ._native import Pose


class Error(Exception):
    """Base class of all errors of the library and the arm."""

    result: int


class NoDevice(Error):
    """No arm is connected, or the address does not select one of several."""

    result = 1


class NoPermission(Error, PermissionError):
    """The user has no permission to open the device."""

    result = 2


class Incompatible(Error):
    """The arm's firmware belongs to another version of this library."""

    result = 3


class Disconnected(Error, ConnectionError):
    """No poses arrive: the link to the arm is lost, or the arm is silent. The library searches for the same arm and
    connects to it again. After a lost link the force is off; enable_force() switches it on again."""

    result = 4
    last_pose: Pose | None = None
    """The last known pose."""


class InUse(Error):
    """Another program has exclusive use of the arm or the scope."""

    result = 5


class BadArgument(Error, ValueError):
    """The function does not accept a value."""

    result = 6


class Refused(Error):
    """The arm does not accept the request in its present state."""

    result = 7


class TimedOut(Error, TimeoutError):
    """The expected event did not occur in time."""

    result = 8


class Failed(Error):
    """Any other error; the message describes it."""

    result = 9


class ForceLost(Error):
    """A fault, another program or a lost link has switched the force off."""

    result = 10


BY_RESULT = {each.result: each for each in Error.__subclasses__()}
