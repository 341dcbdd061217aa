"""The debugger: stops a run at breakpoints, steps through it, and opens Python's debugger in an application's task.

Code that stops a run and asks its user (`debugger`), defines where a run may stop (`breakpoints`), or goes back in it
(`journey`, `keepers`) belongs here. Observers that do not stop a run belong to `cfepy.monitors`, pictures of a finished
run to `cfepy.extra.reports`. The central file is `cfepy/extra/debugger/debugger.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.debugger.debugger import Debugger
    from cfepy.extra.debugger.gdb import GdbSession
    from cfepy.extra.debugger.journey import Journey
    from cfepy.extra.debugger.keepers import Keepers

__all__ = ["Debugger", "GdbSession", "Journey", "Keepers"]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".debugger": ("Debugger",),
            ".gdb": ("GdbSession",),
            ".journey": ("Journey",),
            ".keepers": ("Keepers",),
        },
    )
