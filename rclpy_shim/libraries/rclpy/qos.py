"""Quality of service (rclpy.qos)."""

from __future__ import annotations

import warnings
from enum import Enum, IntEnum
from typing import Any

from rclpy import _seam
from rclpy.duration import Duration, Infinite


class InvalidQoSProfileException(Exception):
    """A profile contradicts itself."""

    def __init__(self, *args: object) -> None:
        super().__init__(*args)


class QoSPolicyEnum(IntEnum):
    """Base of the policies."""

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the names in small letters."""
        return [name.lower() for name in cls.__members__ if not name.startswith("RMW")]

    @classmethod
    def get_from_short_key(cls, name: str) -> int:
        """Return the value of a name in small letters."""
        return cls[name.upper()].value

    @property
    def short_key(self) -> str:
        """The name in small letters.

        Raises:
            AttributeError: the policy is unknown.
        """
        return self.name.lower()


class HistoryPolicy(QoSPolicyEnum):
    """Which messages are kept."""

    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3


class ReliabilityPolicy(QoSPolicyEnum):
    """Whether messages may be lost on their way."""

    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class DurabilityPolicy(QoSPolicyEnum):
    """Whether late subscriptions get earlier messages."""

    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class LivelinessPolicy(QoSPolicyEnum):
    """How a publisher shows that it is alive."""

    SYSTEM_DEFAULT = 0
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3
    UNKNOWN = 4
    BEST_AVAILABLE = 5


QoSHistoryPolicy, QoSReliabilityPolicy = HistoryPolicy, ReliabilityPolicy
QoSDurabilityPolicy, QoSLivelinessPolicy = DurabilityPolicy, LivelinessPolicy
QOS_UNLIMITED = Duration(nanoseconds=0)


class QoSPolicyKind(Enum):
    """Names of the policies, as events have them."""

    RMW_QOS_POLICY_INVALID = 1
    RMW_QOS_POLICY_DURABILITY = 2
    RMW_QOS_POLICY_DEADLINE = 4
    RMW_QOS_POLICY_LIVELINESS = 8
    RMW_QOS_POLICY_RELIABILITY = 16
    RMW_QOS_POLICY_HISTORY = 32
    RMW_QOS_POLICY_LIFESPAN = 64
    RMW_QOS_POLICY_DEPTH = 128
    RMW_QOS_POLICY_LIVELINESS_LEASE_DURATION = 256

    def __str__(self) -> str:
        return f"rmw_qos_policy_kind_t.{self.name}"


def qos_policy_name_from_kind(policy_kind: Any) -> str:
    """Return the short name of a policy, such as "RELIABILITY"."""
    return QoSPolicyKind(getattr(policy_kind, "value", policy_kind)).name.removeprefix("RMW_QOS_POLICY_")


class QoSProfile:
    """A profile: the policies of a publisher, a subscription, a service or a client."""

    __slots__ = (
        *("history", "depth", "reliability", "durability", "lifespan", "deadline", "liveliness"),
        *("liveliness_lease_duration", "avoid_ros_namespace_conventions"),
    )

    def __init__(self, **policies: Any) -> None:
        """Make a profile.

        Args:
            policies: `history`, `depth`, `reliability`, `durability`, `lifespan`, `deadline`, `liveliness`,
                `liveliness_lease_duration` and `avoid_ros_namespace_conventions`.

        Raises:
            TypeError: an unknown policy.
            InvalidQoSProfileException: neither history nor depth is given, or KEEP_LAST without a depth.
        """
        unknown = [name for name in policies if name not in self.__slots__]
        if unknown:
            raise TypeError(f"QoSProfile.__init__() got an unexpected keyword argument '{unknown[0]}'")
        history = policies.get("history")
        if history is None and "depth" not in policies:
            raise InvalidQoSProfileException("History and/or depth settings are required.")
        self.history = HistoryPolicy.KEEP_LAST if history is None else HistoryPolicy(history)
        if self.history is HistoryPolicy.KEEP_LAST and "depth" not in policies:
            raise InvalidQoSProfileException("History set to KEEP_LAST without a depth setting.")
        self.depth = int(policies.get("depth", 10))
        if self.depth < 0:
            raise ValueError("depth must be greater than or equal to zero")
        if self.history is HistoryPolicy.KEEP_LAST and self.depth == 0:
            warnings.warn(
                "A zero depth with KEEP_LAST doesn't make sense; no data could be stored. "
                "This will be interpreted as SYSTEM_DEFAULT",
                stacklevel=2,
            )
        self.reliability = ReliabilityPolicy(policies.get("reliability", ReliabilityPolicy.RELIABLE))
        self.durability = DurabilityPolicy(policies.get("durability", DurabilityPolicy.VOLATILE))
        self.lifespan = policies.get("lifespan", Duration())
        self.deadline = policies.get("deadline", Duration())
        self.liveliness = LivelinessPolicy(policies.get("liveliness", LivelinessPolicy.SYSTEM_DEFAULT))
        self.liveliness_lease_duration = policies.get("liveliness_lease_duration", Duration())
        self.avoid_ros_namespace_conventions = bool(policies.get("avoid_ros_namespace_conventions", False))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, QoSProfile):
            return False
        return all(getattr(self, name) == getattr(other, name) for name in self.__slots__)

    __hash__ = None  # type: ignore[assignment]  # as in rclpy

    def __str__(self) -> str:
        return f"QoSProfile({', '.join(f'{name}={getattr(self, name)}' for name in self.__slots__)})"

    def quality(self) -> Any:
        """Return it as the seam has it."""
        return _seam.Quality(
            depth=max(self.depth, 1),
            is_reliable=self.reliability is not ReliabilityPolicy.BEST_EFFORT,
            is_kept=self.durability is DurabilityPolicy.TRANSIENT_LOCAL,
            keeps_all=self.history is HistoryPolicy.KEEP_ALL,
            deadline_ns=_limit(self.deadline),
            lifespan_ns=_limit(self.lifespan),
            is_manual=self.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC,
            lease_ns=_limit(self.liveliness_lease_duration),
        )


def _limit(time: Duration) -> int:
    """Return a time in ns; 0 for one without a limit."""
    return 0 if time == Infinite else int(time.nanoseconds)


qos_profile_default = QoSProfile(depth=10)
qos_profile_system_default = QoSProfile(
    history=HistoryPolicy.SYSTEM_DEFAULT,
    depth=0,
    reliability=ReliabilityPolicy.SYSTEM_DEFAULT,
    durability=DurabilityPolicy.SYSTEM_DEFAULT,
)
qos_profile_sensor_data = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
qos_profile_services_default = QoSProfile(depth=10)
qos_profile_parameters = QoSProfile(depth=1000)
qos_profile_parameter_events = QoSProfile(depth=1000)


class QoSPresetProfiles(Enum):
    """The profiles by name."""

    UNKNOWN = None
    DEFAULT = qos_profile_default
    SYSTEM_DEFAULT = qos_profile_system_default
    SENSOR_DATA = qos_profile_sensor_data
    SERVICES_DEFAULT = qos_profile_services_default
    PARAMETERS = qos_profile_parameters
    PARAMETER_EVENTS = qos_profile_parameter_events

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the names in small letters."""
        return [name.lower() for name in cls.__members__ if name != "UNKNOWN"]

    @classmethod
    def get_from_short_key(cls, name: str) -> Any:
        """Return the profile of a name in small letters."""
        return cls[name.upper()].value


def profile_of(value: QoSProfile | int) -> QoSProfile:
    """Return a profile from a profile or a depth.

    Raises:
        TypeError: it is neither.
        ValueError: a negative depth.
    """
    if isinstance(value, QoSProfile):
        return value
    if not isinstance(value, int):
        raise TypeError(f"Expected QoSProfile or int, but received {type(value)!r}")
    if value < 0:
        raise ValueError("history depth must be greater than or equal to zero")
    return QoSProfile(depth=value)
