"""rosparam/rosparam: the command as a node of a launch file (wiki.ros.org/rosparam)."""

from __future__ import annotations

import rosparam

rosparam.yamlmain()
