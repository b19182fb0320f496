"""Parameters of an arm as attributes, from the library's table."""

from collections.abc import Iterator
from typing import NamedTuple

from . import _native, errors


class Parameter(NamedTuple):
    """A row of the parameter table."""

    name: str
    """The name, which ends in the unit."""
    unit: str
    """Empty for a dimensionless number."""
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
        raise type(error)(f"{name} is {value!r}, which is not a number. Give a number.") from None


class Parameters:
    """Parameters of an arm. Reading an attribute returns the value; assigning to it sends the value to the board:

        arm.parameters.wall_stiffness_N_per_m = 500
        arm.parameters.set(wall_stiffness_N_per_m=500, wall_damping_Ns_per_m=1)   # both in one control period

    Changes are lost when the board loses power, unless store() stores them. print(arm.parameters) shows all values.
    help(inkwell.Parameters) shows units, ranges and defaults.
    """

    __slots__ = ("_arm",)

    def __init__(self, arm: _native.Arm) -> None:
        object.__setattr__(self, "_arm", arm)

    def set(self, **values: float) -> None:
        """Sets several parameters. All take effect in one control period, or none does."""
        self._arm.set_parameters([(name, _number(name, value)) for name, value in values.items()])

    def store(self) -> None:
        """Stores the current parameters on the board, so that they survive power loss. Raises Refused while the force is
        on."""
        self._arm.store_parameters()

    def restore(self) -> None:
        """Sets every parameter to its stored value. Raises Refused if nothing is stored."""
        self._arm.restore_parameters()

    def factory_reset(self) -> None:
        """Erases the stored parameters, including the calibration of the arm, and sets every parameter to its default.
        Raises Refused while the force is on."""
        self._arm.factory_reset()

    def store_state(self) -> _native.Store:
        """Returns the contents of the store, the number of values that are not stored, and the wear of the flash."""
        return self._arm.store()

    def not_stored(self) -> dict[str, float]:
        """Returns the parameters that are lost at power loss, each with its stored value."""
        if self._arm.store().not_stored == 0:
            return {}
        stored = {name: self._arm.stored_parameter(name) for name in self}
        return {name: value for name, value in stored.items() if value != self._arm.parameter(name)}

    def __iter__(self) -> Iterator[str]:
        return (row[0] for row in _native.parameters())

    def __getattr__(self, name: str) -> float:
        # Python calls this function only for names without a property below.
        if name.startswith("_"):  # Python and notebooks read such names of every object
            raise AttributeError(name)
        try:
            return self._arm.parameter(name)
        except errors.BadArgument as error:
            raise AttributeError(str(error), name=name) from None

    def __setattr__(self, name: str, value: float) -> None:
        if name in TABLE:
            super().__setattr__(name, value)
        else:
            getattr(self, name)  # raises if there is no such parameter
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
