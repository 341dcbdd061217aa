#!/usr/bin/env python3
"""Test node: a periodic timer that is shut down after ten ticks, and a one-shot timer."""

from __future__ import annotations

import rospy

TICKS = 10


def main() -> None:
    rospy.init_node("timers")
    ticks: list[rospy.timer.TimerEvent] = []
    shots: list[rospy.timer.TimerEvent] = []

    def on_tick(event: rospy.timer.TimerEvent) -> None:
        ticks.append(event)
        if len(ticks) == TICKS:
            periodic.shutdown()

    periodic = rospy.Timer(rospy.Duration(0.05), on_tick)
    rospy.Timer(rospy.Duration(0.2), shots.append, oneshot=True)
    rospy.sleep(1.0)
    expected = [round((b.current_expected - a.current_expected).to_sec(), 6) for a, b in zip(ticks, ticks[1:])]
    chained = all(b.last_expected == a.current_expected for a, b in zip(ticks, ticks[1:]))
    print(
        f"result: {len(ticks)} ticks, periods {sorted(set(expected))}, chained {chained}, "
        f"first has last {ticks[0].last_expected is not None}, {len(shots)} shot"
    )


if __name__ == "__main__":
    main()
