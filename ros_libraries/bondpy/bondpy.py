"""`Bond`: one end of a bond between two nodes.

Both ends publish heartbeats with the same id on one topic. The bond is broken if the other end announces its end, or
sends no heartbeat for `heartbeat_timeout`. Callbacks are called without the lock, after the state has changed.
"""

from __future__ import annotations

import threading
import time
import uuid
from collections.abc import Callable
from typing import Any

import rospy
from bond.msg import Constants, Status

from ._states import ALIVE, DEAD, DYING, TRANSITIONS, WAITING
from ._timeout import Timeout

Callback = Callable[[], object] | None

_LOOK_UP_S = 0.1  # a waiting thread checks at this interval whether the node is to end


def as_ros_duration(d: Any) -> Any:
    """Return a rospy.Duration of one, or of seconds."""
    return d if isinstance(d, rospy.Duration) else rospy.Duration.from_sec(d)


def as_float_duration(d: Any) -> Any:
    """Return seconds of a rospy.Duration, or of seconds."""
    return d.to_sec() if isinstance(d, rospy.Duration) else d


def _timeout(event: str) -> Any:
    """Return a property that holds a time, in s or as a rospy.Duration, and makes the timer that raises an event."""

    def read(self: Bond) -> Any:
        return self._times[event]

    def write(self: Bond, dur: Any) -> None:
        assert not self._started
        self._times[event] = dur
        self._timers[event] = Timeout(as_ros_duration(dur), lambda: self._timed_out(event))

    return property(read, write)


class Bond:
    """One end of a bond; `start` begins it.

    Args:
        topic: topic of the heartbeats, the same at both ends.
        id: id of the bond, the same at both ends.
        on_broken: called when the bond breaks.
        on_formed: called when the other end has connected.
    """

    connect_timeout = _timeout("ConnectTimeout")
    heartbeat_timeout = _timeout("HeartbeatTimeout")
    disconnect_timeout = _timeout("DisconnectTimeout")

    def __init__(self, topic: str, id: str, on_broken: Callback = None, on_formed: Callback = None) -> None:
        self._started = False
        self._times: dict[str, Any] = {}
        self._timers: dict[str, Timeout] = {}
        self.topic, self.id = topic, id
        self.on_broken, self.on_formed = on_broken, on_formed
        self.instance_id = str(uuid.uuid4())
        self.sister_instance_id: str | None = None
        self.is_shutdown = self.sister_died_first = False
        self.pending_callbacks: list[Callable[[], object]] = []
        self._state = WAITING
        self.lock = threading.RLock()
        self.condition = threading.Condition(self.lock)
        self.connect_timeout = Constants.DEFAULT_CONNECT_TIMEOUT
        self.heartbeat_timeout = Constants.DEFAULT_HEARTBEAT_TIMEOUT
        self.disconnect_timeout = Constants.DEFAULT_DISCONNECT_TIMEOUT
        self.heartbeat_period = Constants.DEFAULT_HEARTBEAT_PERIOD
        self.sub: Any = None
        self.pub = rospy.Publisher(topic, Status, queue_size=1)

    @property
    def heartbeat_period(self) -> float:
        """Time between heartbeats, in s. You can set it as a rospy.Duration."""
        return self._period

    @heartbeat_period.setter
    def heartbeat_period(self, per: Any) -> None:
        assert not self._started
        self._period: float = as_float_duration(per)

    def get_connect_timeout(self) -> Any:
        """How long to wait for the other end."""
        return self.connect_timeout

    def set_connect_timeout(self, dur: Any) -> None:
        """Set how long to wait for the other end, before `start`."""
        self.connect_timeout = dur

    def get_heartbeat_timeout(self) -> Any:
        """Return how long the other end may be silent."""
        return self.heartbeat_timeout

    def set_heartbeat_timeout(self, dur: Any) -> None:
        """Set how long the other end may be silent, before `start`."""
        self.heartbeat_timeout = dur

    def get_disconnect_timeout(self) -> Any:
        """How long to wait for the other end to agree to break."""
        return self.disconnect_timeout

    def set_disconnect_timeout(self, dur: Any) -> None:
        """Set how long to wait for the other end to agree to break, before `start`."""
        self.disconnect_timeout = dur

    def get_heartbeat_period(self) -> float:
        """Return the time between heartbeats, in s."""
        return self.heartbeat_period

    def set_heartbeat_period(self, per: Any) -> None:
        """Set the time between heartbeats, before `start`."""
        self.heartbeat_period = per

    def set_formed_callback(self, on_formed: Callback) -> None:
        """Have something called when the other end is there."""
        with self.lock:
            self.on_formed = on_formed

    def set_broken_callback(self, on_broken: Callback) -> None:
        """Have something called when the bond breaks."""
        with self.lock:
            self.on_broken = on_broken

    # -- life ----------------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Publish heartbeats and wait for heartbeats of the other end."""
        with self.lock:
            self._timers["ConnectTimeout"].reset()
            self.sub = rospy.Subscriber(self.topic, Status, self._on_bond_status)
            self.thread = threading.Thread(target=self._publishing_thread, daemon=True)
            self.thread.start()
            self._started = True

    def wait_until_formed(self, timeout: Any = None) -> bool:
        """Wait for the other end, for a rospy.Duration or forever. Returns whether the bond was formed."""
        with self.lock:
            self._wait_while(lambda: self._state == WAITING, timeout)
            return self._state != WAITING

    def wait_until_broken(self, timeout: Any = None) -> bool:
        """Wait for the end of the bond, for a rospy.Duration or forever. Returns whether it is broken."""
        with self.lock:
            self._wait_while(lambda: self._state != DEAD, timeout)
            return self._state == DEAD

    def _wait_while(self, unchanged: Callable[[], bool], timeout: Any) -> None:
        end = time.time() + as_float_duration(timeout) if timeout else None
        while unchanged() and not rospy.is_shutdown():
            left = _LOOK_UP_S if end is None else min(_LOOK_UP_S, end - time.time())
            if left <= 0:
                return
            self.condition.wait(left)

    def is_broken(self) -> bool:
        """Return whether the bond is broken."""
        with self.lock:
            return self._state == DEAD

    def break_bond(self) -> None:
        """Break the bond and notify the other end."""
        with self.lock:
            self._handle("Die")
            self._publish(False)
        self._flush_pending_callbacks()

    def shutdown(self) -> None:
        """Break the bond and leave the topic."""
        if self.is_shutdown:
            return
        if self.sub is not None:
            self.sub.unregister()
        with self.lock:
            self.is_shutdown = True
            if self._state != DEAD:
                self.break_bond()
            self.pub.unregister()
            self.condition.notify_all()
            self._timers["ConnectTimeout"].cancel()

    def __del__(self) -> None:
        if hasattr(self, "pub"):
            self.shutdown()

    def __repr__(self) -> str:
        return f"[Bond {self.id}, Instance {self.instance_id} ({self._state})]"

    # -- events --------------------------------------------------------------------------------------------------------

    def _handle(self, event: str) -> None:
        actions, following = TRANSITIONS.get((self._state, event), ((), self._state))
        for action in actions:
            getattr(self, action)()
        self._state = following

    def _timed_out(self, event: str) -> None:
        if event == "HeartbeatTimeout" and rospy.get_param(Constants.DISABLE_HEARTBEAT_TIMEOUT_PARAM, False):
            rospy.logwarn(f"Heartbeat timeout is disabled.  Not breaking bond (topic: {self.topic}, id: {self.id})")
            return
        with self.lock:
            self._handle(event)
        self._flush_pending_callbacks()

    def _on_bond_status(self, msg: Any) -> None:
        if msg.id != self.id or msg.instance_id == self.instance_id:
            return
        with self.lock:
            self.sister_instance_id = self.sister_instance_id or msg.instance_id
            if msg.instance_id != self.sister_instance_id:
                rospy.logerr(
                    "More than two locations are trying to use a single bond"
                    f" (topic: {self.topic}, id: {self.id}).  You should only instantiate at most two bond instances"
                    " for each (topic, id) pair."
                )
                return
            self._handle("SisterAlive" if msg.active else "SisterDead")
            if not msg.active and self.sister_died_first:
                self._publish(False)  # the other end waits for this
        self._flush_pending_callbacks()

    def _publish(self, active: bool) -> None:
        msg = Status(id=self.id, instance_id=self.instance_id, active=active)
        msg.header.stamp = rospy.Time.now()
        msg.heartbeat_timeout = as_float_duration(self.heartbeat_timeout)
        msg.heartbeat_period = self.heartbeat_period
        self.pub.publish(msg)

    def _publishing_thread(self) -> None:
        with self.lock:
            while not self.is_shutdown and self._state in (WAITING, ALIVE):
                self._publish(True)
                self.condition.wait(self.heartbeat_period)
            while not self.is_shutdown and self._state == DYING:
                self._publish(False)
                self.condition.wait(Constants.DEAD_PUBLISH_PERIOD)

    def _flush_pending_callbacks(self) -> None:
        with self.lock:
            callbacks, self.pending_callbacks = self.pending_callbacks, []
        for callback in callbacks:
            callback()

    # -- actions of the table ------------------------------------------------------------------------------------------

    def Connected(self) -> None:
        """The other end is there."""
        self._timers["ConnectTimeout"].cancel()
        self.condition.notify_all()
        if self.on_formed is not None:
            self.pending_callbacks.append(self.on_formed)

    def Heartbeat(self) -> None:
        """The other end was heard."""
        self._timers["HeartbeatTimeout"].reset()

    def SisterDied(self) -> None:
        """The other end was the first to break the bond."""
        self.sister_died_first = True

    def Death(self) -> None:
        """The bond is broken."""
        self.condition.notify_all()
        self._timers["HeartbeatTimeout"].cancel()
        self._timers["DisconnectTimeout"].cancel()
        if self.on_broken is not None:
            self.pending_callbacks.append(self.on_broken)

    def StartDying(self) -> None:
        """This end breaks the bond and waits for the other one to agree."""
        self._timers["HeartbeatTimeout"].cancel()
        self._timers["DisconnectTimeout"].reset()
