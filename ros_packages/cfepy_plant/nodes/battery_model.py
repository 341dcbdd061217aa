"""A battery: charge, voltage and current under a load."""

from __future__ import annotations

SECONDS_AN_HOUR = 3600.0


class BatteryModel:
    """A battery whose voltage falls in a straight line from full to empty.

    Args:
        capacity: energy of the full battery in Wh.
        charge: part of it at the beginning, 0 to 1.
        full, empty: voltage without a load in V.
        resistance: inner resistance in ohm.

    Attributes:
        energy: the energy that is left, in Wh.
        current: that it gave in the last step, in A.
    """

    def __init__(
        self,
        capacity: float = 20.0,
        charge: float = 1.0,
        full: float = 12.6,
        empty: float = 10.5,
        resistance: float = 0.1,
    ) -> None:
        self.capacity = capacity
        self.energy = capacity * charge
        self.current = 0.0
        self._full = full
        self._empty = empty
        self._resistance = resistance

    @property
    def charge(self) -> float:
        """The part that is left, 0 to 1."""
        return self.energy / self.capacity

    @property
    def open_voltage(self) -> float:
        """Voltage without a load in V."""
        return self._empty + (self._full - self._empty) * self.charge

    @property
    def voltage(self) -> float:
        """Voltage under the load of the last step in V."""
        return self.open_voltage - self.current * self._resistance

    @property
    def capacity_ah(self) -> float:
        """Capacity in Ah, at the mean voltage."""
        return self.capacity / ((self._full + self._empty) / 2)

    def give(self, power: float, seconds: float) -> None:
        """Give a power in W for a time. An empty battery gives nothing."""
        self.current = power / self.open_voltage if self.energy > 0 else 0.0
        loss = self._resistance * self.current * self.current
        used = (power + loss) * seconds / SECONDS_AN_HOUR if self.energy > 0 else 0.0
        self.energy = max(0.0, self.energy - used)
