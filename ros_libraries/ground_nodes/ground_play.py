"""The node behind `cfepy run --play`: plays a bag. It is executed in a node's universe, with the node's own rospy."""

from __future__ import annotations

from rosbag import _play

_play.main()
