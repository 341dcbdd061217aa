"""rostopic/rostopic: the command as a node of a launch file (wiki.ros.org/rostopic)."""

from __future__ import annotations

import rostopic

rostopic.rostopicmain()
