"""Shapes that the board renders at its full rate."""

import dataclasses
import math
from collections.abc import Sequence


@dataclasses.dataclass(frozen=True, kw_only=True)
class Surface:
    """Surface properties of a shape."""

    stiffness_N_per_m: float = 800.0
    """Spring constant, N/m."""
    damping_Ns_per_m: float = 2.0
    """Damping constant while the probe touches, Ns/m."""
    static_friction: float = 0.0
    """Limit of the tangential force while the probe sticks, relative to the normal force."""
    dynamic_friction: float = 0.0
    """The same while the probe slides; at most static_friction."""
    life_s: float = math.inf
    """The board removes the shape after this time, s, at most 10, unless it is placed again. By default the shape lasts as
    long as the program drives the arm."""


@dataclasses.dataclass(frozen=True)
class Plane(Surface):
    """A plane that the probe does not pass. The probe is a point."""

    point_m: Sequence[float]
    """A point on the plane, m; shape (3,)."""
    normal: Sequence[float]
    """Normal into the free space, of any length except 0; shape (3,)."""


@dataclasses.dataclass(frozen=True)
class Sphere(Surface):
    """A sphere that the probe does not enter. The probe is a point."""

    centre_m: Sequence[float]
    """Center, m; shape (3,)."""
    radius_m: float
    """Radius, m; the free space is outside."""
