"""The names of topics and services in the sources of a node, which get their MsgIds before the node is compiled.

A name is found if the source has it as a text: in the call that advertises, subscribes or calls, or in the variable,
the default of a parameter or the parameter's value in that call. Comments do not count. The NodeHandle defines the
namespace of a name. If the namespace is not known, all namespaces of the node's handles are used.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence, Sized
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from cfepy.status import UsageError
from rospy_shim.types.names import SEP

PRIVATE = "~"
TOPIC_CALLS = ("advertise", "subscribe", "advertiseCamera", "subscribeCamera", "waitForMessage", "getNumPublishers")
SERVICE_CALLS = ("advertiseService", "serviceClient", "waitForService", "exists", "call")
ACTION_TOPICS = ("goal", "cancel", "status", "feedback", "result")
BY_INCLUDE: Mapping[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "tf/": (("/tf", "/tf_static"), ()),
    "tf2_ros/": (("/tf", "/tf_static"), ()),
    "diagnostic_updater/": (("/diagnostics",), ()),
    "dynamic_reconfigure/": (("~parameter_descriptions", "~parameter_updates"), ("~set_parameters",)),
}
"""Topics and services that come with a library, by the folder of its headers."""
_TEXT = r'"((?:[^"\\\n]|\\.){0,500}+)"'
_STRING = rf"(?:(?:std\s*+::\s*+)?string\s*+[({{]\s*+)?{_TEXT}"
_TYPE = r"(?:<[^;(){}]{0,500}>)?"
_COMMENT = re.compile(
    r"""("(?:[^"\\\n]|\\.)*+"?)|//[^\n]*+|/\*(?:[^*]++|\*(?!/))*+(?:\*/)?|'(?:[^'\\\n]|\\.)*+'?""", re.DOTALL
)
_CALL = re.compile(
    r"(?:\b(\w++)\s*+(?:\.|->|::)\s*+(?:template\s++)?)?\b(" + "|".join((*TOPIC_CALLS, *SERVICE_CALLS)) + r")\s*+"
    rf"{_TYPE}\s*+\(\s*+(?:" + _STRING + r"|([^,()]*+(?:\([^()]*+\))?[^,()]*+))"
)
_OPTIONS = re.compile(r"\b(Advertise|Subscribe|AdvertiseService|ServiceClient)Options\b[^;(]{0,300}+\(\s*+" + _STRING)
_FILTER = re.compile(r"\bSubscriber\s*+<[^;(){}]{0,500}>\s*+(?:\w++\s*+)?\(\s*+(\w++)\s*+,\s*+" + _STRING)
_FILTER_LATER = re.compile(r"\.\s*+subscribe\s*+\(\s*+(\w++)\s*+,\s*+" + _STRING)
_ACTION = re.compile(
    r"\bSimpleAction(?:Server|Client)\s*+<[^;(){}]{0,500}>\s*+(?:\w++\s*+)?\(\s*+(?:\w++\s*+,\s*+)?" + _STRING
)
_ACTION_MEMBER = re.compile(r"\bSimpleAction(?:Server|Client)\s*+<[^;(){}]{0,500}>\s*+(\w++)\s*+;")
_BEGUN_ACTION = re.compile(r"\b(\w++)\s*+\(\s*+(?:\w++\s*+,\s*+)?" + _STRING)
_HANDLE = re.compile(r"\bNodeHandle\s*+(?:[&*]\s*+)?(\w++)\s*+(;|[,)({=][^;\n]*+)")
_HANDLES = re.compile(r"\bNodeHandle\s++(\w[^;{}]{0,1000}+);")
_DECLARED = re.compile(r"\s*+(\w++)\s*+((?:[(=].*)?)", re.DOTALL)
_HANDLE_MADE = re.compile(r"\bNodeHandle\s*+(?:\w++\s*+)?[({]\s*+(?:(\w++)\s*+,\s*+)?" + _STRING)
_BEGUN_HANDLE = re.compile(
    r"\b(\w++)\s*+[({=]\s*+(?:(?:ros\s*+::\s*+)?NodeHandle\s*+[({]\s*+)?"
    rf"(?:(?:(\w++)\s*+,\s*+)?{_STRING}|(\w++)\s*+[)}};])"
)
_VARIABLE = re.compile(r"\b(\w++)\s*+(?:\[\s*+\]\s*+)?(?:=|\()\s*+" + _STRING)
_MACRO = re.compile(r"^[ \t]*+#[ \t]*+define[ \t]++(\w++)[ \t]++" + _TEXT, re.MULTILINE)
_PARAM = re.compile(rf"\b(?:param|getParam|getParamCached|get)\s*+{_TYPE}\s*+\(\s*+{_STRING}\s*+(?:\)\s*+)?,\s*+(\w++)")
_DEFAULT = re.compile(rf"\bparam\s*+{_TYPE}\s*+\(\s*+{_STRING}\s*+(?:\)\s*+)?,\s*+(\w++)\s*+,\s*+{_STRING}")
_RETURNED = re.compile(rf"\b(\w++)\s*+=[^;=]*?\bparam\s*+{_TYPE}\s*+\(\s*+{_STRING}\s*+(?:\)\s*+)?,\s*+{_STRING}")
_INCLUDE = re.compile(r"^[ \t]*+#[ \t]*+include[ \t]*+[<\"]([^>\"\n]{1,8000}+)[>\"]", re.MULTILINE)
_MOST_NAMES = 10_000
_MOST_SPACES = 200
_LONGEST_WORD = 200  # characters of an argument that is not a text
_NAME = re.compile(r"[~/A-Za-z]?[\w/]*")


class UsedName(NamedTuple):
    """A name in a source.

    Attributes:
        name: as written, with the namespace of its handle: absolute, "~private" or relative.
        is_service: of a service, not of a topic.
        is_certain: the call contains it; otherwise it is a possible value of a variable.
    """

    name: str
    is_service: bool
    is_certain: bool


@dataclass(slots=True)
class NodeNames:
    """The names of a node, resolved and with the node's remaps applied, in order.

    Attributes:
        topics, services: its names; each certain or not.
        remaps: resolved names, and their replacements.
        open: texts of calls whose name is not known.
    """

    topics: dict[str, bool] = field(default_factory=dict)
    services: dict[str, bool] = field(default_factory=dict)
    remaps: dict[str, str] = field(default_factory=dict)
    open: list[str] = field(default_factory=list)


def without_comments(text: str) -> str:
    """Return a source without its comments; string literals stay."""
    return _COMMENT.sub(lambda match: match[1] or " ", text)


def includes_of(text: str) -> list[str]:
    """Return the includes of a source without comments, as written."""
    return _INCLUDE.findall(text)


class SourceNames:
    """Finds names in the sources of one node.

    Args:
        texts: of its sources and own headers, without comments.
        values: the values of its private parameters that are texts, by name.
    """

    def __init__(self, texts: Sequence[str], values: Mapping[str, str]) -> None:
        self._texts = texts
        self._actions_begun = _by_name(_BEGUN_ACTION, texts)
        self._handles_begun: dict[str, list[Any]] = {}
        self._held = self._variables(values)
        self._handles = self._handle_namespaces()
        self.open: list[str] = []

    def used(self) -> list[UsedName]:
        """Return all names, each once.

        Raises:
            UsageError: they are too many.
        """
        found: dict[UsedName, None] = {}
        every = (each for text in self._texts for each in self._in_text(text))
        for count, each in enumerate(every):
            found[each] = None
            if count >= _MOST_NAMES:
                raise UsageError(f"uses more than {_MOST_NAMES:,} names of topics and services; split it")
        return list(found)

    def _in_text(self, text: str) -> Iterator[UsedName]:
        for handle, call, name, variable in _CALL.findall(text):
            is_service = call in SERVICE_CALLS
            if call in ("exists", "call") and handle != "service":
                continue
            if name:
                yield from self._spaced(handle, name, is_service, True)
            else:
                yield from self._by_variable(handle, call, variable, is_service)
        for kind, name in _OPTIONS.findall(text):
            yield from self._spaced("", name, "Service" in kind, True)
        for handle, name in (*_FILTER.findall(text), *_FILTER_LATER.findall(text)):
            yield from self._spaced(handle, name, False, True)
        for name in (*_ACTION.findall(text), *self._members(text)):
            for topic in ACTION_TOPICS:
                yield from self._spaced("", f"{name}/{topic}", False, True)
        for folder in dict.fromkeys(each.partition(SEP)[0] + SEP for each in includes_of(text)):
            topics, services = BY_INCLUDE.get(folder, ((), ()))
            yield from (UsedName(name, False, True) for name in topics)
            yield from (UsedName(name, True, True) for name in services)

    def _by_variable(self, handle: str, call: str, variable: str, is_service: bool) -> Iterator[UsedName]:
        """Yield names that a variable may hold. A call with options has its name in them."""
        word = variable.strip()
        if len(word) > _LONGEST_WORD:
            self.open.append(f"{call}({word[:_LONGEST_WORD]}...)")
            return
        found = [name for each in re.findall(r"\w+", word) for name in self._held.get(each, [])]
        if not found and word and not re.fullmatch(r"\w*(?:ops|opts|options|o)\w*|nh\w*|n|\d+|.*\bnh\w*", word):
            self.open.append(f"{call}({word})")
        for name in found:
            yield from self._spaced(handle, name, is_service, False)

    def _members(self, text: str) -> Iterator[str]:
        """Yield the names of actions whose server or client is a member that a constructor initialises."""
        for member in dict.fromkeys(_ACTION_MEMBER.findall(text)):
            yield from self._actions_begun.get(member, ())

    def _spaced(self, handle: str, name: str, is_service: bool, is_certain: bool) -> Iterator[UsedName]:
        """Yield a name in the possible namespaces of its handle."""
        if not _NAME.fullmatch(name) or not name:
            return
        if name[0] in (SEP, PRIVATE):
            yield UsedName(name, is_service, is_certain)
            return
        for space in self._handles.get(handle) or self._handles[""]:
            yield UsedName(joined(space, name), is_service, is_certain)

    def _handle_namespaces(self) -> dict[str, list[str]]:
        """Return namespaces of the node's handles, by their variables; "" has all, for an unknown handle."""
        found: dict[str, list[str]] = {}
        unknown: set[str] = set()
        plain: list[str] = []  # declared without an initialiser: a constructor may initialise them differently
        texts = [_HANDLES.sub(_one_by_one, text) for text in self._texts]
        self._handles_begun = _by_name(_BEGUN_HANDLE, texts)
        for text in texts:
            for name, rest in _HANDLE.findall(text):
                spaces = self._spaces_made(rest, found)
                if spaces is None:
                    unknown.add(name)
                elif rest == ";":
                    plain.append(name)
                    spaces = []
                found[name] = [*found.get(name, []), *(spaces or [])]
                _check_few(found[name])
            for parent, space in _HANDLE_MADE.findall(text):
                found["made"] = [*found.get("made", []), *(joined(each, space) for each in found.get(parent) or [""])]
                found["made"] = list(dict.fromkeys(found["made"]))
                _check_few(found["made"])
            if "getPrivateNodeHandle" in text:
                found["made"] = [*found.get("made", []), PRIVATE]
        for name in dict.fromkeys([*plain, *unknown]):
            self._begin_later(name, found, unknown)
            _check_few(found[name])
        for name in plain:
            if (not found[name] and name not in unknown) or plain.count(name) > 1:
                found[name] = [*found[name], ""]
        is_plain = any("getNodeHandle" in text for text in texts) or not any(found.values())
        every = dict.fromkeys([*([""] if is_plain else []), *(each for spaces in found.values() for each in spaces)])
        _check_few(every)
        known = {name: list(dict.fromkeys(spaces)) for name, spaces in found.items() if name not in unknown}
        return {**known, "": list(every)}

    def _begin_later(self, name: str, found: dict[str, list[str]], unknown: set[str]) -> None:
        """Add the namespaces that a handle gets after its declaration: in a constructor, or in an assignment."""
        for parent, space, other in self._handles_begun.get(name, ()):
            if not other:
                found[name] = [*found[name], *(joined(each, space) for each in found.get(parent) or [""])]
            elif found.get(other) and other not in unknown:
                found[name] = [*found[name], *found[other]]
            else:
                unknown.add(name)
            _check_few(found[name])

    def _spaces_made(self, rest: str, found: Mapping[str, list[str]]) -> list[str] | None:
        """Return a handle's namespaces from the text after its name in the declaration; None if they are not known."""
        if rest.startswith(";"):
            return [""]
        if rest.startswith((",", ")")):
            return None
        made = re.match(r"[=({]\s*(?:(?:ros\s*::\s*)?NodeHandle\s*[({]\s*)?(?:(\w+)\s*,\s*)?" + _STRING, rest)
        if made is not None:
            return [joined(each, made[2]) for each in found.get(made[1] or "") or [""]]
        return [""] if re.match(r"[({]\s*[)}]", rest) else None

    def _variables(self, values: Mapping[str, str]) -> dict[str, list[str]]:
        """Return the texts that variables may hold."""
        found: dict[str, list[str]] = {}
        for text in self._texts:
            for name, value in (*_VARIABLE.findall(text), *_MACRO.findall(text)):
                found.setdefault(name, []).append(value)
            for param, variable in _PARAM.findall(text):
                if param.lstrip(PRIVATE) in values:
                    found.setdefault(variable, []).append(values[param.lstrip(PRIVATE)])
            for param, variable, value in _DEFAULT.findall(text):
                found.setdefault(variable, []).append(values.get(param.lstrip(PRIVATE), value))
            for variable, param, value in _RETURNED.findall(text):
                found.setdefault(variable, []).append(values.get(param.lstrip(PRIVATE), value))
        return {name: list(dict.fromkeys(held)) for name, held in found.items() if name}


def _by_name(pattern: re.Pattern[str], texts: Iterable[str]) -> dict[str, list[Any]]:
    """Return the matches of a pattern in texts: by its first group, the other groups (or the only other one)."""
    found: dict[str, list[Any]] = {}
    for text in texts:
        for name, *others in pattern.findall(text):
            found.setdefault(name, []).append(others[0] if len(others) == 1 else tuple(others))
    return found


def _check_few(spaces: Sized) -> None:
    """Check that namespaces do not multiply, as for a handle that is made from itself.

    Raises:
        UsageError: they are too many.
    """
    if len(spaces) > _MOST_SPACES:
        raise UsageError(f"has a NodeHandle with more than {_MOST_SPACES} namespaces; make one handle for each")


def _one_by_one(declaration: re.Match[str]) -> str:
    """Split a declaration of several handles into one for each; parameters of a function stay as they are."""
    if "," not in declaration[1]:
        return declaration[0]
    parts = [_DECLARED.fullmatch(each) for each in re.split(r",(?![^()]*\))", declaration[1])]
    if None in parts:
        return declaration[0]
    return " ".join(f"NodeHandle {each[1]}{each[2]};" for each in parts if each)


def joined(space: str, name: str) -> str:
    """Return a name in a namespace; an absolute or private one stays."""
    if not space or name.startswith((SEP, PRIVATE)):
        return name
    return f"{space}{name}" if space.endswith((SEP, PRIVATE)) else f"{space}{SEP}{name}"


def resolved(name: str, namespace: str, node: str) -> str:
    """Return a name as ros::names::resolve does, without remaps.

    Args:
        name: absolute, private or relative.
        namespace: of the node, such as "/".
        node: its full name.
    """
    if name.startswith(PRIVATE):
        name = f"{node}{SEP}{name[1:].lstrip(SEP)}"
    elif not name.startswith(SEP):
        name = f"{namespace.rstrip(SEP)}{SEP}{name}"
    return re.sub("/+", SEP, name).rstrip(SEP) or SEP


def names_of(used: Iterable[UsedName], namespace: str, node: str, remaps: Iterable[tuple[str, str]]) -> NodeNames:
    """Return the names of a node in the ROS graph.

    Args:
        used: in its sources.
        namespace: of the node.
        node: its full name.
        remaps: from the launch file.
    """
    found = NodeNames(remaps={resolved(a, namespace, node): resolved(b, namespace, node) for a, b in remaps})
    for each in used:
        name = resolved(each.name, namespace, node)
        kind = found.services if each.is_service else found.topics
        name = found.remaps.get(name, name)
        kind[name] = kind.get(name, False) or each.is_certain
    return found


def texts_below(params: Any, node: str) -> dict[str, str]:
    """Return the private parameters of a node that are texts, by name without the "~".

    Args:
        params: the tree of parameters.
        node: full name of the node.
    """
    for part in filter(None, node.split(SEP)):
        params = params.get(part) if isinstance(params, Mapping) else None
    return (
        {key: value for key, value in (params or {}).items() if isinstance(value, str)}
        if isinstance(params, Mapping)
        else {}
    )
