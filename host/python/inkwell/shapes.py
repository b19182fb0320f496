"""Shapes that the board renders at its full rate."""

import dataclasses
import math
from collections.abc import Sequence


@dataclasses.dataclass(frozen=True, kw_only=True)
class Surface:
    """How a shape feels."""

    stiffness_N_per_m: float = 800.0
    """Spring constant, N/m."""
    damping_Ns_per_m: float = 2.0
    """Damping constant while the probe touches, Ns/m."""
    static_friction: float = 0.0
    """Bound of the tangential force while it sticks, as a part of the normal force."""
    dynamic_friction: float = 0.0
    """The same while it slides; at most the static one."""
    life_s: float = math.inf
    """The board forgets the shape after this time, s, at most 10, unless it is placed again. By default the shape lasts as
    long as the program drives the arm."""


@dataclasses.dataclass(frozen=True)
class Plane(Surface):
    """A plane that the probe, a point, does not pass."""

    point_m: Sequence[float]
    """A point of the plane, m; shape (3,)."""
    normal: Sequence[float]
    """Into the free space, of any length but 0; shape (3,)."""


@dataclasses.dataclass(frozen=True)
class Sphere(Surface):
    """A sphere that the probe, a point, does not enter."""

    centre_m: Sequence[float]
    """Its centre, m; shape (3,)."""
    radius_m: float
    """Its radius, m; the free space is outside."""
