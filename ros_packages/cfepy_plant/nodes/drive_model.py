"""Physics of a robot with two driven wheels: motion, wheel encoders and the power of the motors.

Speeds are in m/s and rad/s, lengths in m. Each wheel follows its command as fast as the acceleration permits, and a
step moves the robot along an exact arc of a circle.
"""

from __future__ import annotations

import math
import random
from typing import NamedTuple

GRAVITY = 9.80665  # m/s^2
STRAIGHT = 1e-9  # turns of less than this are straight lines, in rad


class Pose(NamedTuple):
    """A place on the floor and a direction: m, m, rad."""

    x: float = 0.0
    y: float = 0.0
    yaw: float = 0.0

    def moved(self, distance: float, turn: float) -> Pose:
        """Return the pose after an arc of this length and this change of direction."""
        if abs(turn) < STRAIGHT:
            middle = self.yaw + turn / 2
            return Pose(
                self.x + distance * math.cos(middle), self.y + distance * math.sin(middle), normal(self.yaw + turn)
            )
        radius, yaw = distance / turn, self.yaw + turn
        return Pose(
            self.x + radius * (math.sin(yaw) - math.sin(self.yaw)),
            self.y - radius * (math.cos(yaw) - math.cos(self.yaw)),
            normal(yaw),
        )


def normal(angle: float) -> float:
    """Return an angle between -pi and pi."""
    return math.remainder(angle, 2 * math.pi)


class DriveModel:
    """The robot and its motors.

    Args:
        pose: where it begins.
        separation: distance between the wheels in m.
        acceleration: largest change of a wheel's speed in m/s^2.
        max_speed: largest speed of a wheel in m/s.
        mass: in kg.
        rolling: rolling resistance as a part of the weight.
        efficiency: of the motors, 0 to 1.

    Attributes:
        pose: where it is.
        left, right: speeds of the wheels in m/s.
        power: electrical power of the motors in the last step, in W.
    """

    def __init__(
        self,
        pose: Pose,
        separation: float = 0.3,
        acceleration: float = 1.0,
        max_speed: float = 0.6,
        mass: float = 8.0,
        rolling: float = 0.03,
        efficiency: float = 0.6,
    ) -> None:
        self.pose = pose
        self.separation = separation
        self.left = self.right = self.power = 0.0
        self._acceleration = acceleration
        self._max_speed = max_speed
        self._mass = mass
        self._rolling = rolling
        self._efficiency = efficiency

    @property
    def speed(self) -> float:
        """Speed forwards in m/s."""
        return (self.left + self.right) / 2

    @property
    def turn(self) -> float:
        """Turn to the left in rad/s."""
        return (self.right - self.left) / self.separation

    def step(self, speed: float, turn: float, seconds: float) -> Pose:
        """Drive towards a commanded speed and turn for a time, and return the new pose without taking it."""
        before = self.left, self.right
        half = turn * self.separation / 2
        self.left = self._followed(self.left, speed - half, seconds)
        self.right = self._followed(self.right, speed + half, seconds)
        self.power = sum(self._power(old, new, seconds) for old, new in zip(before, (self.left, self.right)))
        return self.pose.moved(self.speed * seconds, self.turn * seconds)

    def block(self) -> None:
        """Stop the wheels, because the robot pushes against a wall."""
        self.left = self.right = 0.0

    def _followed(self, now: float, wanted: float, seconds: float) -> float:
        wanted = min(self._max_speed, max(-self._max_speed, wanted))
        most = self._acceleration * seconds
        return now + min(most, max(-most, wanted - now))

    def _power(self, old: float, new: float, seconds: float) -> float:
        """Return the power of one wheel, which carries half of the robot; braking gives nothing back."""
        force = self._mass / 2 * ((new - old) / seconds)
        force += self._rolling * self._mass / 2 * GRAVITY * ((new > 0) - (new < 0))
        return max(0.0, force * new) / self._efficiency


class WheelEncoders:
    """Odometry: the pose that follows from the counts of the wheels' encoders.

    Args:
        separation: distance between the wheels in m.
        step: travel of a wheel for one tick in m; 0 for encoders without steps.
        noise: standard deviation of the travel, as a part of it.
        seed: of the noise.
    """

    def __init__(self, separation: float, step: float = 0.0, noise: float = 0.0, seed: int = 0) -> None:
        self.pose = Pose()
        self._separation = separation
        self._step = step
        self._noise = noise
        self._random = random.Random(seed)
        self._rest = [0.0, 0.0]

    def add(self, left: float, right: float) -> None:
        """Count the travel of both wheels in m."""
        counted = [self._counted(wheel, travel) for wheel, travel in enumerate((left, right))]
        self.pose = self.pose.moved(sum(counted) / 2, (counted[1] - counted[0]) / self._separation)

    def _counted(self, wheel: int, travel: float) -> float:
        if self._noise:
            travel *= 1 + self._noise * self._random.gauss(0, 1)
        if not self._step:
            return travel
        self._rest[wheel] += travel
        ticks = int(self._rest[wheel] / self._step)
        self._rest[wheel] -= ticks * self._step
        return ticks * self._step
