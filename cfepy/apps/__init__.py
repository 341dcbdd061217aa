"""The apps that cfepy brings along, importable wherever they lie: `cfepy.apps.hk.packets` and the like.

Missions use their layouts to write table files. A running mission does not import apps from here: it executes them
anew for every start.
"""

from __future__ import annotations

from cfepy.resources import shipped

__path__ = [str(shipped("apps"))]
