"""ROS parameters of a run that override those of its mission: `--set /left/rate=50`.

A private parameter of a node is changed in the mission's section `nodes:`, because a node gets that when it starts. Any
other parameter is changed in the initial tree of the master.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from cfepy.mission.parameter_files import checked, merged
from cfepy.mission.spec import MissionSpec
from cfepy.nodes import NodeConfig
from cfepy.reading.plain_yaml import YamlError, plain_yaml
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

OPTION = "--set"


def with_settings(spec: MissionSpec, settings: Sequence[tuple[str, str]]) -> MissionSpec:
    """Return a mission with other values of parameters.

    Args:
        spec: the mission.
        settings: full name of a parameter, such as "/left/rate", and its value in YAML; later ones win.

    Raises:
        UsageError: for an invalid name, or a value that ROS cannot carry.
    """
    nodes, params, notes = dict(spec.ros.nodes), dict(spec.ros.params), list(spec.notes)
    for name, text in settings:
        value = _value(name, text)
        owners = [app for app, node in nodes.items() if _within(name, node)]
        for app in owners:
            own = name.removeprefix(f"{_full_name(nodes[app])}/")
            nodes[app] = replace(nodes[app], params=merged(nodes[app].params, _tree(own, value)))
        if not owners:
            notes += _doubts(name, nodes, params)
            params = merged(params, _tree(name, value))
    return replace(spec, ros=replace(spec.ros, nodes=nodes, params=params), notes=tuple(notes))


def _value(name: str, text: str) -> Any:
    if not name.startswith("/") or not all(name[1:].split("/")):
        raise UsageError(f"invalid parameter name {name!r}; expected a full name such as /arm/rate", field=OPTION)
    try:
        return checked(plain_yaml(text))
    except (YamlError, UsageError) as error:
        said = error.text if isinstance(error, YamlError) else str(error)
        raise UsageError(f"invalid value {text!r} of {name}: {said}", field=OPTION) from None


def _full_name(node: NodeConfig) -> str:
    return f"{node.namespace.rstrip('/')}/{node.name}"


def _within(name: str, node: NodeConfig) -> bool:
    return node.name is not None and name.startswith(f"{_full_name(node)}/")


def _tree(name: str, value: Any) -> dict[str, Any]:
    """Return a value below its namespaces."""
    for part in reversed(name.strip("/").split("/")):
        value = {part: value}
    tree: dict[str, Any] = value
    return tree


def _doubts(name: str, nodes: Mapping[str, NodeConfig], params: Mapping[str, Any]) -> list[str]:
    """Return a note if no node of the mission has the name of the parameter and the mission has no similar one."""
    first = name.strip("/").split("/")[0]
    if "/" not in name[1:] or first in params or any(node.name is None for node in nodes.values()):
        return []
    known = [_full_name(node) for node in nodes.values()]
    hint = did_you_mean(f"/{first}", known, before="; ")
    return [] if not known else [f"{OPTION} {name}: unknown node /{first}{hint}"]
