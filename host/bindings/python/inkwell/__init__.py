"""Haptic arm for Python programs.

    import inkwell

    with inkwell.open() as arm:            # or open("virtual") for a simulated arm
        arm.enable_force()

        @arm.servo
        def spring(pose):                  # 1000 times per second
            return -100 * (pose.position_m - [0, 0, -0.03])

        input("Press Enter to stop. ")

Lengths are in meters, forces in newtons, angles in radians, times in seconds. Errors are raised as inkwell.Error.
"""

from . import _requirements

_requirements.check()

from ._native import (Abilities, ArmState, Contact, Device, Driver, Event, EventKind, ForceMode, Information, Losses, Pose,
                      State, Store, Stored, Test, TestItem, devices, names)
from ._native import version as _version
from .arm import Arm, Recording, VirtualHand, open
from .device_list import wait_for_devices
from .errors import (BadArgument, Disconnected, Error, Failed, ForceLost, Incompatible, InUse, NoDevice, NoPermission,
                     Refused, TimedOut)
from .faults import Fault
from .parameters import Parameter, Parameters
from .parameters import TABLE as _parameters
from .scene import Material, Scene, SceneObject
from .scope import Samples, Signal
from .scope import TABLE as _signals
from .shapes import Box, Capsule, Cylinder, Plane, Solid, Sphere, Surface

__version__ = _version()
__all__ = [
    "Abilities", "Arm", "ArmState", "BadArgument", "Box", "Capsule", "Contact", "Cylinder", "Device", "Disconnected", "Driver",
    "Error", "Event", "EventKind", "Failed", "Fault", "ForceLost", "ForceMode", "InUse", "Incompatible", "Information", "Losses",
    "Material", "NoDevice", "NoPermission", "Parameter", "Parameters", "Plane", "Pose", "Recording", "Refused", "Samples", "Scene",
    "SceneObject", "Signal", "Solid", "Sphere", "State", "Store", "Stored", "Surface", "Test", "TestItem", "TimedOut",
    "VirtualHand", "devices", "names", "open", "parameters_table", "signals", "wait_for_devices",
]


def signals() -> list[Signal]:
    """Returns the signals that can be recorded, with unit and help."""
    return list(_signals.values())


def parameters_table() -> list[Parameter]:
    """Returns the parameters of every arm, with unit, range, default and help."""
    return list(_parameters.values())
