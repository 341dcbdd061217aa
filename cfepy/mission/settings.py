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
OF_ROS = ("/use_sim_time",)
"""Parameters that every mission can have."""


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
            notes += _almost(name, own, nodes[app].params)
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


def _almost(name: str, own: str, params: Mapping[str, Any]) -> list[str]:
    """Return a note if a node has no parameter of a name in the mission, but a similar one."""
    hint = "" if own.split("/")[0] in params else did_you_mean(own, params)
    return [f"{OPTION} {name}: the mission has no such parameter; {hint}"] if hint else []


def _doubts(name: str, nodes: Mapping[str, NodeConfig], params: Mapping[str, Any]) -> list[str]:
    """Return a note if the mission has neither the parameter nor a node of its name."""
    first = name.strip("/").split("/")[0]
    if first in params or name in OF_ROS:
        return []
    if "/" not in name[1:]:
        hint = did_you_mean(name, [f"/{each}" for each in params], before="; ")
        return [f"{OPTION} {name}: the mission has no such parameter, so only a node that reads it sees it{hint}"]
    if any(node.name is None for node in nodes.values()):
        return []
    known = [_full_name(node) for node in nodes.values()]
    hint = did_you_mean(f"/{first}", known, before="; ")
    return [] if not known else [f"{OPTION} {name}: unknown node /{first}{hint}"]
