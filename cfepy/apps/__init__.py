"""The apps that cfepy brings along, importable wherever they lie: `cfepy.apps.hk.packets` and the like.

Nothing belongs here but the path to the folder of those apps. Missions import their layouts from here to write table
files. A running mission does not import apps from here: its loader executes them anew for every start.
"""

from __future__ import annotations

from cfepy.reading.resources import shipped

__path__ = [str(shipped("apps"))]
