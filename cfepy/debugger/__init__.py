"""The debugger: it stops a run at breakpoints, goes on in steps, and opens Python's debugger in an application's task.

What belongs here stops a run and asks its user (`debugger`), says where a run may be stopped (`breakpoints`), or goes
back in it (`journey`, `keepers`). What
watches a run without stopping it belongs to `cfepy.monitors`, what draws a run afterwards to `cfepy.reports`.
"""

from __future__ import annotations

from cfepy.debugger.debugger import Debugger
from cfepy.debugger.gdb import GdbSession
from cfepy.debugger.journey import Journey
from cfepy.debugger.keepers import Keepers

__all__ = ["Debugger", "GdbSession", "Journey", "Keepers"]
