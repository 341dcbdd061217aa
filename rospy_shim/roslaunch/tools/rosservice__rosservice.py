"""rosservice/rosservice: the command as a node of a launch file (wiki.ros.org/rosservice)."""

from __future__ import annotations

import rosservice

rosservice.rosservicemain()
