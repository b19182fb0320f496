"""Samples of the board's scope as arrays."""

import dataclasses
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from . import _native


class Signal(NamedTuple):
    """A row of the signal table."""

    name: str
    """The name, which ends in the unit."""
    unit: str
    help: str


TABLE = {row[0]: Signal(*row) for row in _native.signals()}


@dataclasses.dataclass(frozen=True)
class Samples:
    """Samples of signals, one row per control period. samples["force_x_N"] returns the samples of one signal."""

    signals: tuple[str, ...]
    values: npt.NDArray[np.float32]
    """Shape (samples, signals)."""
    periods: npt.NDArray[np.int64]
    """Control period of each sample; shape (samples,). Divided by servo_rate_Hz it has the time base of Pose.time_s."""
    lost: int
    """Number of samples that were lost before and between these samples."""
    servo_rate_Hz: float
    """Control periods per second."""

    @property
    def time_s(self) -> npt.NDArray[np.float64]:
        """Time since the first sample, s; shape (samples,)."""
        return (self.periods - self.periods[:1]) / self.servo_rate_Hz

    def __getitem__(self, signal: str) -> npt.NDArray[np.float32]:
        if signal not in self.signals:
            raise KeyError(f"{signal} was not selected. Selected are: {', '.join(self.signals)}")
        return self.values[:, self.signals.index(signal)]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Samples):
            return NotImplemented
        return ((self.signals, self.lost, self.servo_rate_Hz) == (other.signals, other.lost, other.servo_rate_Hz)
                and np.array_equal(self.values, other.values, equal_nan=True)
                and np.array_equal(self.periods, other.periods))

    def __len__(self) -> int:
        return len(self.values)
