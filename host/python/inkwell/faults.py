"""Why an arm is in State.FAULT."""

import enum

from . import _native

Fault = enum.IntEnum("Fault", {name.upper(): code for code, name in _native.faults()})
Fault.__doc__ = """What Pose.fault is; Pose.fault_text says it in words. Fault.NONE is 0."""
