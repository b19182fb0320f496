"""Arms that are plugged in or removed."""

from collections.abc import Iterable

from . import _native, errors
from ._native import Device

_ATTEMPT_S = 0.2  # short, so that Ctrl-C is handled soon


def wait_for_devices(known: Iterable[Device] = (), timeout_s: float = float("inf")) -> list[Device]:
    """Waits until an arm is plugged in or removed, and returns the new list. `known` is the last list:

        arms = inkwell.devices()
        while True:
            arms = inkwell.wait_for_devices(arms)
            print(arms)

    Raises TimedOut if the list does not change within this time of the host's clock."""
    known = list(known)
    if not timeout_s >= 0:
        raise errors.BadArgument(f"The time-out is {timeout_s!r}. Give a time of 0 s or more.")
    while True:
        found = _native.wait_for_devices(known, min(timeout_s, _ATTEMPT_S))
        if found is not None:
            return found
        timeout_s -= _ATTEMPT_S
        if timeout_s <= 0:
            raise errors.TimedOut("The list of arms has not changed. Plug an arm in, or wait longer.")
