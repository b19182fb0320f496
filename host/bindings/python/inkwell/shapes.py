"""Shapes that the board renders at its full rate."""

import dataclasses
import math
import typing
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
    viscosity_Ns_per_m: float = 0.0
    """Tangential force per sliding speed, Ns/m. The tangential force is at most the normal force."""
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


@dataclasses.dataclass(frozen=True, kw_only=True)
class Solid(Surface):
    """Base class of the solids, which the probe does not enter. The probe is a point."""

    quaternion: Sequence[float] = (0.0, 0.0, 0.0, 1.0)
    """Rotation of the solid: x, y, z, w; shape (4,)."""


@dataclasses.dataclass(frozen=True)
class Sphere(Solid):
    """A sphere."""

    centre_m: Sequence[float]
    """Center, m; shape (3,)."""
    radius_m: float
    """Radius, m."""
    _shape: typing.ClassVar[int] = 0

    @property
    def _size_m(self) -> tuple[float, float, float]:
        return self.radius_m, 0.0, 0.0


@dataclasses.dataclass(frozen=True)
class Capsule(Solid):
    """All points within the radius of a segment along z."""

    centre_m: Sequence[float]
    """Center, m; shape (3,)."""
    radius_m: float
    """Radius, m."""
    half_length_m: float
    """Half length of the segment, m."""
    _shape: typing.ClassVar[int] = 1

    @property
    def _size_m(self) -> tuple[float, float, float]:
        return self.radius_m, self.half_length_m, 0.0


@dataclasses.dataclass(frozen=True)
class Cylinder(Solid):
    """A cylinder along z."""

    centre_m: Sequence[float]
    """Center, m; shape (3,)."""
    radius_m: float
    """Radius, m."""
    half_length_m: float
    """Half length, m."""
    _shape: typing.ClassVar[int] = 2

    @property
    def _size_m(self) -> tuple[float, float, float]:
        return self.radius_m, self.half_length_m, 0.0


@dataclasses.dataclass(frozen=True)
class Box(Solid):
    """A box with edges along the axes."""

    centre_m: Sequence[float]
    """Center, m; shape (3,)."""
    half_size_m: Sequence[float]
    """Half lengths along x, y and z, m; shape (3,)."""
    _shape: typing.ClassVar[int] = 3

    @property
    def _size_m(self) -> Sequence[float]:
        return self.half_size_m
