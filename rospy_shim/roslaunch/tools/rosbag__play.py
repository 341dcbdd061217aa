"""rosbag/play: `rosbag play` under the name that launch files know (wiki.ros.org/rosbag/Commandline)."""

from __future__ import annotations

from rosbag import _play

_play.main()
