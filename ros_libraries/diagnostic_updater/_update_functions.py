"""Ready-made tasks: frequency of events, age of stamps, and whether the node is alive."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from typing import Any

import rospy

from ._diagnostic_status_wrapper import ERROR, OK, WARN
from ._diagnostic_updater import DiagnosticTask


class FrequencyStatusParam:
    """Parameters of a FrequencyStatus.

    Args:
        freq_bound: "min" and, if there is one, "max", in Hz; read at each run.
        tolerance: the fraction of the bounds by which they may be missed.
        window_size: number of runs over which events are counted.
    """

    def __init__(self, freq_bound: Mapping[str, float], tolerance: float = 0.1, window_size: int = 5) -> None:
        self.freq_bound, self.tolerance, self.window_size = freq_bound, tolerance, window_size

    @property
    def lowest(self) -> float:
        """Lowest frequency that will do, in Hz."""
        return self.freq_bound["min"] * (1 - self.tolerance)

    @property
    def highest(self) -> float | None:
        """Highest acceptable frequency in Hz, or None for any."""
        return self.freq_bound["max"] * (1 + self.tolerance) if "max" in self.freq_bound else None


class FrequencyStatus(DiagnosticTask):
    """Whether something happens often enough."""

    def __init__(self, params: FrequencyStatusParam, name: str = "FrequencyStatus") -> None:
        super().__init__(name)
        self.params = params
        self.lock = threading.Lock()
        self.clear()

    def clear(self) -> None:
        """Begin anew."""
        with self.lock:
            self.count = 0
            self.times = [rospy.Time.now()] * self.params.window_size
            self.seq_nums = [0] * self.params.window_size
            self.hist_indx = 0

    def tick(self) -> None:
        """It happened."""
        with self.lock:
            self.count += 1

    def run(self, stat: Any) -> Any:
        """Compare with the run that is the window's size back."""
        with self.lock:
            now, at = rospy.Time.now(), self.hist_indx
            events = self.count - self.seq_nums[at]
            window = (now - self.times[at]).to_sec()
            self.seq_nums[at], self.times[at] = self.count, now
            self.hist_indx = (at + 1) % self.params.window_size
            frequency = events / window if window else 0.0
            stat.summary(*self._verdict(events, frequency))
            self._add_values(stat, events, window, frequency)
        return stat

    def _verdict(self, events: int, frequency: float) -> tuple[int, str]:
        if events == 0:
            return ERROR, "No events recorded."
        if frequency < self.params.lowest:
            return WARN, "Frequency too low."
        if self.params.highest is not None and frequency > self.params.highest:
            return WARN, "Frequency too high."
        return OK, "Desired frequency met"

    def _add_values(self, stat: Any, events: int, window: float, frequency: float) -> None:
        bounds = self.params.freq_bound
        stat.add("Events in window", f"{events}")
        stat.add("Events since startup", f"{self.count}")
        stat.add("Duration of window (s)", f"{window:f}")
        stat.add("Actual frequency (Hz)", f"{frequency:f}")
        if bounds.get("max") == bounds["min"]:
            stat.add("Target frequency (Hz)", f"{bounds['min']:f}")
        if bounds["min"] > 0:
            stat.add("Minimum acceptable frequency (Hz)", f"{self.params.lowest:f}")
        if self.params.highest is not None:
            stat.add("Maximum acceptable frequency (Hz)", f"{self.params.highest:f}")


class TimeStampStatusParam:
    """Parameters of a TimeStampStatus.

    Args:
        min_acceptable: minimum age of a stamp, in s; a negative age lies in the future.
        max_acceptable: maximum age, in s.
    """

    def __init__(self, min_acceptable: float = -1, max_acceptable: float = 5) -> None:
        self.min_acceptable, self.max_acceptable = min_acceptable, max_acceptable


_ALWAYS = TimeStampStatusParam()


class TimeStampStatus(DiagnosticTask):
    """Whether the stamps of messages are near the present."""

    def __init__(self, params: TimeStampStatusParam = _ALWAYS, name: str = "Timestamp Status") -> None:
        super().__init__(name)
        self.params = params
        self.lock = threading.Lock()
        self.early_count = self.late_count = self.zero_count = 0
        self._forget()

    def _forget(self) -> None:
        self.max_delta = self.min_delta = 0.0
        self.deltas_valid = self.zero_seen = False

    def tick(self, stamp: Any) -> None:
        """A stamp came: a Time, or s as a float."""
        seconds = stamp if isinstance(stamp, float) else stamp.to_sec()
        with self.lock:
            if seconds == 0:
                self.zero_seen = True
                return
            age = rospy.Time.now().to_sec() - seconds
            self.max_delta = max(self.max_delta, age) if self.deltas_valid else age
            self.min_delta = min(self.min_delta, age) if self.deltas_valid else age
            self.deltas_valid = True

    def run(self, stat: Any) -> Any:
        """Judge the stamps since the last run."""
        with self.lock:
            self._judge(stat)
            stat.add("Earliest timestamp delay:", f"{self.min_delta:f}")
            stat.add("Latest timestamp delay:", f"{self.max_delta:f}")
            stat.add("Earliest acceptable timestamp delay:", f"{self.params.min_acceptable:f}")
            stat.add("Latest acceptable timestamp delay:", f"{self.params.max_acceptable:f}")
            stat.add("Late diagnostic update count:", f"{self.late_count}")
            stat.add("Early diagnostic update count:", f"{self.early_count}")
            stat.add("Zero seen diagnostic update count:", f"{self.zero_count}")
            self._forget()
        return stat

    def _judge(self, stat: Any) -> None:
        stat.summary(OK, "Timestamps are reasonable.")
        if not self.deltas_valid:
            stat.summary(WARN, "No data since last update.")
            return
        if self.min_delta < self.params.min_acceptable:
            stat.summary(ERROR, "Timestamps too far in future seen.")
            self.early_count += 1
        if self.max_delta > self.params.max_acceptable:
            stat.summary(ERROR, "Timestamps too far in past seen.")
            self.late_count += 1
        if self.zero_seen:
            stat.summary(ERROR, "Zero timestamp seen.")
            self.zero_count += 1


class Heartbeat(DiagnosticTask):
    """Says that the node is alive."""

    def __init__(self) -> None:
        super().__init__("Heartbeat")

    def run(self, stat: Any) -> Any:
        """Report that all is well."""
        stat.summary(OK, "Alive")
        return stat
