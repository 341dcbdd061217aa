"""rosnode/rosnode: the command as a node of a launch file (wiki.ros.org/rosnode)."""

from __future__ import annotations

import rosnode

rosnode.rosnodemain()
