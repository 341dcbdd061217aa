"""A mission whose files lie below a folder that stands for the root of another computer: what is where.

The mission itself must not see it, so its parameters, arguments and environment have the paths of the other computer.
May import cfepy.mission and its neighbours in cfepy.journal.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from cfepy.attachment import Attachment
from cfepy.journal.journal import Header
from cfepy.mission.mission import Mission
from cfepy.mission.run_plan import LAUNCH, NODE, RunPlan
from cfepy.mission.spec import MissionSpec
from cfepy.nodes.config import NodeConfig


def moved_plan(header: Header, root: str) -> RunPlan:
    """The plan of a run, with the paths that its files have below a root."""
    plan = header.plan
    files: dict[str, Any] = {
        name: _moved(getattr(plan, name), header.cwd, root) for name in ("script", "faults", "play", "board")
    }
    return replace(plan, words=(root + header.startup, *_arguments(header)), **files)


def _arguments(header: Header) -> tuple[str, ...]:
    """What follows the mission, launch file or script on the command line."""
    words = header.plan.words
    if header.plan.command == LAUNCH:
        return tuple(word for word in words if ":=" in word)
    if header.plan.command == NODE:
        is_file = Path(words[0]).name == Path(header.startup).name
        return words[1:] if is_file else words[2:]
    return ()


def _moved(path: str | None, cwd: str, root: str) -> str | None:
    """Where a file is now that a command line names; what is no file stays."""
    if path is None:
        return None
    whole = os.path.normpath(os.path.join(cwd, path))
    return next((place for place in (root + whole, whole) if os.path.isfile(place)), path)


def moved_environ(environ: Mapping[str, str], root: str) -> dict[str, str]:
    """Environment variables in which folders that are below the root are those."""
    return {name: os.pathsep.join(map(_folder_in(root), value.split(os.pathsep))) for name, value in environ.items()}


def _folder_in(root: str) -> Any:
    return lambda word: root + word if root and word.startswith(os.sep) and os.path.isdir(root + word) else word


def settled(spec: MissionSpec, root: str) -> MissionSpec:
    """A mission that was read below a root, and does not see it."""
    if not root:
        return spec
    nodes = {app: _settled_node(node, root) for app, node in spec.ros.nodes.items()}
    return replace(spec, ros=replace(spec.ros, nodes=nodes, params=_without(spec.ros.params, root), root=root))


def _settled_node(node: NodeConfig, root: str) -> NodeConfig:
    return replace(
        node, args=_without(node.args, root), env=_without(node.env, root), params=_without(node.params, root)
    )


def _without(value: Any, root: str) -> Any:
    """A value in which no text has the root."""
    if isinstance(value, str):
        return value.replace(root, "")
    if isinstance(value, Mapping):
        return {name: _without(each, root) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(_without(each, root) for each in value)
    return value


class HiddenRoot(Attachment):
    """Takes the root out of what the console shows, such as tracebacks.

    Args:
        root: the folder.
    """

    def __init__(self, root: str) -> None:
        self._root = root

    def begin(self, mission: Mission) -> None:
        """See `Attachment.begin`."""
        console, root = mission.console, self._root
        for name in ("record", "sink"):
            show = getattr(console, name)
            if show is not None:
                setattr(console, name, lambda line, show=show: show(line.replace(root, "")))
