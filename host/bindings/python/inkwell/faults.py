"""Causes of State.FAULT."""

import enum

from . import _native

Fault = enum.IntEnum("Fault", {name.upper(): code for code, name in _native.faults()})
Fault.__doc__ = """Value of Pose.fault; Pose.fault_text has its text. Fault.NONE is 0."""
