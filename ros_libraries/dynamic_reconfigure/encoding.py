"""Conversion between dicts in programs and the messages of servers and clients.

A *description* is the `config_description` of a generated module: a tree of groups with their parameters, in which
`groups` is a list. A description that a client gets from a message has a dict of groups by name instead.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from dynamic_reconfigure.msg import (
    BoolParameter,
    ConfigDescription,
    DoubleParameter,
    Group,
    GroupState,
    IntParameter,
    ParamDescription,
    StrParameter,
)
from dynamic_reconfigure.msg import Config as ConfigMsg

from ._config_dict import Config

_LISTS = {int: ("ints", IntParameter), bool: ("bools", BoolParameter), str: ("strs", StrParameter)}
_LISTS[float] = ("doubles", DoubleParameter)


def encode_description(descr: Any) -> Any:
    """ConfigDescription of a generated `...Config` module."""
    return ConfigDescription(
        groups=encode_groups(None, descr.config_description),
        max=encode_config(descr.max),
        min=encode_config(descr.min),
        dflt=encode_config(descr.defaults),
    )


def encode_groups(parent: Any, group: Mapping[str, Any]) -> list[Any]:
    """Return the group messages of a description, each before those inside it. `parent` is not used, as in ROS."""
    fields = ("name", "type", "level", "description", "edit_method")
    parameters = [ParamDescription(*(each[field] for field in fields)) for each in group["parameters"]]
    made = Group(group["name"], group["type"], parameters, group["parent"], group["id"])
    return [made, *(deeper for each in group["groups"] for deeper in encode_groups(made, each))]


def encode_config(config: Mapping[str, Any], flat: bool = True) -> Any:
    """Return a Config message from values by name.

    Args:
        config: ints, floats, bools and strs; a tree of groups under "groups". Values of other types are left out.
        flat: with False, "groups" holds an iterable of groups and not a tree.
    """
    msg = ConfigMsg()
    for name, value in config.items():
        if type(value) in _LISTS:
            field, kind = _LISTS[type(value)]
            getattr(msg, field).append(kind(name, value))
        elif isinstance(value, Config) or type(value) is dict:
            if flat:
                msg.groups += [_state(value), *map(_state, _below(value))]
            else:
                msg.groups = [_state(group) for group in value]
    return msg


def _state(group: Any) -> Any:
    return GroupState(group["name"], group["state"], group["id"], group["parent"])


def _below(group: Any) -> Iterator[Any]:
    """Yield the groups inside a group, each behind those inside itself."""
    for inner in group["groups"].values():
        yield from _below(inner)
        yield inner


def group_dict(group: Any) -> Config:
    """Return a group as a dict, from a Group or a GroupState message."""
    return Config(
        id=group.id,
        parent=group.parent,
        name=group.name,
        type=getattr(group, "type", ""),
        state=getattr(group, "state", True),
        groups=Config(),
        parameters=Config(),
    )


def decode_description(msg: Any) -> Config:
    """Return the description in a ConfigDescription. Each parameter has its min, max and default."""
    low, high, default = (decode_config(each) for each in (msg.min, msg.max, msg.dflt))

    def parameter(param: Any) -> dict[str, Any]:
        name = param.name
        limits = {"min": low[name], "max": high[name], "default": default[name]}
        return {"name": name, **limits, **{key: getattr(param, key) for key in _DESCRIBED}}

    def with_parameters(group: Any) -> Config:
        made = group_dict(group)
        made["parameters"] = [parameter(each) for each in group.parameters]
        return made

    return _tree(msg.groups, with_parameters)


_DESCRIBED = ("type", "level", "description", "edit_method")


def get_tree(m: Any, group: Any = None) -> Config:
    """Return the tree of the groups in a message.

    With a `group` that is not the outermost, return the groups inside it.
    """
    if group is None or group.id == 0:
        return _tree(m.groups, group_dict)
    return _inside(m.groups, group.id, group_dict)


def _tree(groups: Iterable[Any], make: Callable[[Any], Config]) -> Config:
    zeros = [group for group in groups if group.id == 0]
    if not zeros:
        raise AttributeError("'NoneType' object has no attribute 'id'")  # callers of the service see this text
    outermost = make(zeros[-1])
    outermost["groups"] = _inside(groups, 0, make)
    return outermost


def _inside(groups: Iterable[Any], parent: int, make: Callable[[Any], Config]) -> Config:
    found = Config()
    for group in groups:
        if group.id != 0 and group.parent == parent:
            made = found[group.name] = make(group)
            made["groups"] = _inside(groups, group.id, make)
    return found


def initial_config(msg: Any, description: Mapping[str, Any] | None = None) -> Config:
    """Return a server's initial values, and groups with the states of the description and their parameters' values."""
    config = _values(msg)
    if msg.groups and description is not None:
        states = {group["id"]: group["state"] for group in _described_below(description)}

        def with_state(group: Any) -> Config:
            made = group_dict(group)
            made["state"] = states.get(group.id, made["state"])
            return made

        config["groups"] = _tree(msg.groups, with_state)
        for group, described in _pairs(config["groups"], description):
            group["parameters"].update((each["name"], config[each["name"]]) for each in described["parameters"])
    return config


def decode_config(msg: Any, description: Mapping[str, Any] | None = None) -> Config:
    """Return values by name from a Config message. With a description, include the tree of groups with their values.

    Raises:
        AttributeError: the message has inner groups, and a server's description, as on ROS.
    """
    config = _values(msg)
    if msg.groups and description is not None:
        config["groups"] = get_tree(msg)
        for group, described in _pairs(config["groups"], description):
            if group["groups"] and not isinstance(described["groups"], Mapping):
                raise AttributeError(f"'{type(described['groups']).__name__}' object has no attribute 'items'")
            names = [each["name"] for each in described["parameters"]]
            group.update((name, config[name]) for name in names if name in config)
    return config


def _values(msg: Any) -> Config:
    return Config((each.name, each.value) for each in msg.bools + msg.ints + msg.strs + msg.doubles)


def _pairs(group: Mapping[str, Any], described: Mapping[str, Any]) -> Iterator[tuple[Any, Mapping[str, Any]]]:
    """Yield each group of a tree with its description."""
    yield group, described
    for inner in group["groups"].values():
        for each in _described_groups(described):
            if each["name"] == inner["name"]:
                yield from _pairs(inner, each)


def _described_groups(described: Mapping[str, Any]) -> Iterable[Mapping[str, Any]]:
    groups = described["groups"]
    return groups.values() if isinstance(groups, Mapping) else groups


def _described_below(described: Mapping[str, Any]) -> Iterator[Mapping[str, Any]]:
    for each in _described_groups(described):
        yield each
        yield from _described_below(each)


def extract_params(group: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return all parameters of a description: the group's own, then the parameters of its groups."""
    return [*group["parameters"], *(each for inner in _described_groups(group) for each in extract_params(inner))]


def get_parents(group: Mapping[str, Any], descriptions: Mapping[str, Any]) -> list[Any]:
    """Return the groups around a group, outermost first, out of the list `descriptions["group"]`."""
    found: list[Any] = []
    for each in descriptions["group"]:
        if each["id"] == group["parent"] and each is not group:
            found += [*get_parents(each, descriptions), each]
    return found
