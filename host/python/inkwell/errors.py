"""What can go wrong, a class for each result of the library. The message says what is wrong and what to do."""


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
    """The arm was there and is gone."""

    result = 4


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


BY_RESULT = {each.result: each for each in Error.__subclasses__()}
