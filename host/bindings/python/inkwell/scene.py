"""Objects that the hand can feel."""

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _native, errors
from ._native import Contact, Event

_Vector = Sequence[float] | npt.NDArray[np.floating]
_ORIGIN = (0.0, 0.0, 0.0)
_NOT_TURNED = (0.0, 0.0, 0.0, 1.0)
_SPHERE, _CAPSULE, _CYLINDER, _BOX, _MESH, _HALF_SPACE = range(6)
_PLACEMENT = ("a placement: three numbers for a position or a velocity, and a quaternion of four numbers x, y, z, w")


@dataclasses.dataclass(frozen=True, kw_only=True)
class Material:
    """Properties of the surface of an object."""

    stiffness_N_per_m: float = 500.0
    """Spring constant, N/m, at most 3000."""
    damping_Ns_per_m: float = 0.0
    """Damping constant, Ns/m."""
    static_friction: float = 0.0
    """Limit of the tangential force while the tip sticks, relative to the normal force."""
    dynamic_friction: float = 0.0
    """The same while the tip slides; at most static_friction."""
    viscosity_Ns_per_m: float = 0.0
    """Tangential force per sliding speed, Ns/m. The tangential force is at most the normal force."""

    @classmethod
    def named(cls, name: str) -> "Material":
        """Returns a material: wood, rubber, glass, steel, stone, ice, skin, sponge or smooth."""
        return cls(**dict(zip((field.name for field in dataclasses.fields(cls)), _native.find_material(name))))


def _material(given: Material | str | None) -> tuple[float, ...]:
    material = Material() if given is None else Material.named(given) if isinstance(given, str) else given
    if not isinstance(material, Material):
        raise TypeError(f"The material is {given!r}. Give an inkwell.Material or the name of a material.")
    return dataclasses.astuple(material)


def _rows_of_three(given: npt.ArrayLike, kinds: str, types: Sequence[type], things: str) -> npt.NDArray[Any]:
    """The array itself if the library can read it, otherwise a copy."""
    array = np.asarray(given)
    if array.size and array.dtype.kind not in kinds:
        raise TypeError(f"The {things} have the type {array.dtype}. Give {'whole ' if 'f' not in kinds else ''}numbers.")
    if array.ndim != 2 or array.shape[1] != 3:
        raise errors.BadArgument(f"The {things} have the shape {array.shape}. Give an array with the shape (n, 3).")
    if array.dtype not in types:
        array = array.astype(types[-1])
    return np.ascontiguousarray(array)


class SceneObject:
    """An object in a scene."""

    def __init__(self, arm: _native.Arm, number: int) -> None:
        self._arm = arm
        self._number = number

    @property
    def number(self) -> int:
        """Number of the object, as in Contact.object."""
        return self._number

    def move(self, position_m: _Vector, quaternion: _Vector = _NOT_TURNED, velocity_m_per_s: _Vector = _ORIGIN,
             angular_velocity_rad_per_s: _Vector = _ORIGIN) -> None:
        """Moves the object's origin, and turns the object (x, y, z, w). From then on, the object moves with these
        velocities for at most 20 ms. To move an object evenly, call this function each frame with its velocity."""
        _call(self._arm.scene_move, self._number, (position_m, quaternion, velocity_m_per_s, angular_velocity_rad_per_s))

    def set_material(self, material: Material | str) -> None:
        """Changes the surface."""
        self._arm.scene_set_material(self._number, _material(material))

    def remove(self) -> None:
        """Removes the object from the scene."""
        self._arm.scene_remove(self._number)

    def __repr__(self) -> str:
        return f"<inkwell.SceneObject {self._number}>"


def _call(function: Any, *arguments: object) -> Any:
    try:
        return function(*arguments)
    except TypeError:
        raise TypeError(f"An argument has a wrong type. Give {_PLACEMENT}.") from None


class Scene:
    """Objects that the hand feels while this program drives the arm and the force is on. The library finds the contacts at
    each pose, and the board renders them at its full rate. The tip is a sphere with the radius sphere_radius_m, at least
    0.5 mm. A scene has at most 64 objects with 16 different materials. Changes do not stop the servo.

    All functions that add an object have the arguments position_m (m) and quaternion (x, y, z, w) of the object's frame,
    and material: an inkwell.Material or a name for Material.named()."""

    def __init__(self, arm: _native.Arm) -> None:
        self._arm = arm
        self._lost_events = 0

    def _add(self, shape: int, size_m: _Vector, position_m: _Vector, quaternion: _Vector,
             material: Material | str | None, vertices: object = None, faces: object = None,
             smooth: bool = False) -> SceneObject:
        placement = (position_m, quaternion, _ORIGIN, _ORIGIN)
        number = _call(self._arm.scene_add, shape, size_m, vertices, faces, placement, _material(material), smooth)
        return SceneObject(self._arm, number)

    def add(self, vertices: npt.ArrayLike, faces: npt.ArrayLike, *, position_m: _Vector = _ORIGIN,
            quaternion: _Vector = _NOT_TURNED, material: Material | str | None = None, smooth: bool = False) -> SceneObject:
        """Adds a mesh. `vertices` are x, y and z in m, shape (n, 3). `faces` are the rows of the corners of each triangle,
        counter-clockwise as seen from outside, shape (m, 3). The library reads float32, float64, and integers of 32 and
        64 bits from C-contiguous arrays without a copy in Python. The call prepares the mesh, which
        lasts a few seconds for a million triangles. An open mesh is a surface with two sides. `smooth` hides facets; a smoothed surface can supply
        energy."""
        points = _rows_of_three(vertices, "fiu", (np.float32, np.float64), "vertices")
        corners = _rows_of_three(faces, "iu", (np.int32, np.uint32, np.uint64, np.int64), "faces")
        return self._add(_MESH, _ORIGIN, position_m, quaternion, material, points, corners, smooth)

    def add_sphere(self, radius_m: float, *, position_m: _Vector = _ORIGIN, quaternion: _Vector = _NOT_TURNED,
                   material: Material | str | None = None) -> SceneObject:
        """Adds a sphere."""
        return self._add(_SPHERE, (radius_m, 0.0, 0.0), position_m, quaternion, material)

    def add_capsule(self, radius_m: float, half_length_m: float, *, position_m: _Vector = _ORIGIN,
                    quaternion: _Vector = _NOT_TURNED, material: Material | str | None = None) -> SceneObject:
        """Adds all points within the radius of a segment along z."""
        return self._add(_CAPSULE, (radius_m, half_length_m, 0.0), position_m, quaternion, material)

    def add_cylinder(self, radius_m: float, half_length_m: float, *, position_m: _Vector = _ORIGIN,
                     quaternion: _Vector = _NOT_TURNED, material: Material | str | None = None) -> SceneObject:
        """Adds a cylinder along z."""
        return self._add(_CYLINDER, (radius_m, half_length_m, 0.0), position_m, quaternion, material)

    def add_box(self, half_size_m: _Vector, *, position_m: _Vector = _ORIGIN, quaternion: _Vector = _NOT_TURNED,
                material: Material | str | None = None) -> SceneObject:
        """Adds a box with these half lengths along x, y and z, m."""
        return self._add(_BOX, half_size_m, position_m, quaternion, material)

    def add_half_space(self, *, position_m: _Vector = _ORIGIN, quaternion: _Vector = _NOT_TURNED,
                       material: Material | str | None = None) -> SceneObject:
        """Adds all points below the plane z = 0."""
        return self._add(_HALF_SPACE, _ORIGIN, position_m, quaternion, material)

    def clear(self) -> None:
        """Removes all objects."""
        self._arm.scene_clear()

    @property
    def contacts(self) -> list[Contact]:
        """The present contacts, at most three."""
        return self._arm.scene_contacts()

    def events(self) -> list[Event]:
        """The touches and buttons since the last call, oldest first. The library stores 1024 events."""
        events, lost = self._arm.scene_events()
        self._lost_events += lost
        return events

    @property
    def lost_events(self) -> int:
        """Events that were lost because the program did not call events() in time."""
        return self._lost_events
