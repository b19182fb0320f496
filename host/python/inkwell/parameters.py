"""The parameters of an arm as attributes, from the library's own table."""

from collections.abc import Iterator
from typing import NamedTuple

from . import _native, errors


class Parameter(NamedTuple):
    """A row of the table of parameters."""

    name: str
    """It ends in its unit."""
    unit: str
    """Empty for a pure number."""
    help: str
    minimum: float
    maximum: float
    default: float

    def describe(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.minimum:g} to {self.maximum:g}{unit}, default {self.default:g}{unit}. {self.help}"


TABLE = {row[0]: Parameter(*row) for row in _native.parameters()}


def _number(name: str, value: object) -> float:
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError) as error:
        raise type(error)(f"{name} is given as {value!r}. Give a number.") from None


class Parameters:
    """The parameters of an arm. Reading one tells its value, setting one sends it to the board:

        arm.parameters.wall_stiffness_N_per_m = 500
        arm.parameters.set(wall_stiffness_N_per_m=500, wall_damping_Ns_per_m=1)   # both at one control period

    They last until the board loses its power, unless store() keeps them. print(arm.parameters) shows all values,
    help(inkwell.Parameters) units, ranges and defaults.
    """

    __slots__ = ("_arm",)

    def __init__(self, arm: _native.Arm) -> None:
        object.__setattr__(self, "_arm", arm)

    def set(self, **values: float) -> None:
        """Sets several: all take effect at one control period, or none does."""
        self._arm.set_parameters([(name, _number(name, value)) for name, value in values.items()])

    def store(self) -> None:
        """Has the board keep its parameters as they are now, over its power. Raises Refused while the force is on."""
        self._arm.store_parameters()

    def restore(self) -> None:
        """Gives every parameter what is stored. Raises Refused if nothing is."""
        self._arm.restore_parameters()

    def factory_reset(self) -> None:
        """Has the board forget what it has stored, the calibration of its arm too; every parameter gets its default.
        Raises Refused while the force is on."""
        self._arm.factory_reset()

    def store_state(self) -> _native.Store:
        """What is stored, how many values are not, and the wear of the flash."""
        return self._arm.store()

    def not_stored(self) -> dict[str, float]:
        """The parameters that would be lost with the board's power, with the value that is stored."""
        if self._arm.store().not_stored == 0:
            return {}
        stored = {name: self._arm.stored_parameter(name) for name in self}
        return {name: value for name, value in stored.items() if value != self._arm.parameter(name)}

    def __iter__(self) -> Iterator[str]:
        return (row[0] for row in _native.parameters())

    def __getattr__(self, name: str) -> float:
        # Only what has no property below comes here: a parameter of the arm's own force law, or none.
        if name.startswith("_"):  # what Python and notebooks ask every object
            raise AttributeError(name)
        try:
            return self._arm.parameter(name)
        except errors.BadArgument as error:
            raise AttributeError(str(error), name=name) from None

    def __setattr__(self, name: str, value: float) -> None:
        if name in TABLE:
            super().__setattr__(name, value)
        else:
            getattr(self, name)  # which knows whether there is such a parameter
            self._arm.set_parameters([(name, _number(name, value))])

    def __repr__(self) -> str:
        known = (Parameter(*row) for row in _native.parameters())
        rows = (f"{row.name:38} {getattr(self, row.name):12g} {row.unit}" for row in known)
        return "\n".join(row.rstrip() for row in rows)


def _property(row: Parameter) -> property:
    def read(self: Parameters) -> float:
        return self._arm.parameter(row.name)

    def write(self: Parameters, value: float) -> None:
        self._arm.set_parameters([(row.name, _number(row.name, value))])

    return property(read, write, doc=row.describe())


for _row in TABLE.values():
    setattr(Parameters, _row.name, _property(_row))
