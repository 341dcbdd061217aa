"""Parameters of compiled nodes: they ask the application ROS, so that all nodes of a mission see one parameter server.

A request has the form of `rospy_shim.graph.compiled`; values are JSON. A node that caches a value (getParamCached) gets
changes by a notice to all: an answer to call 0, whose body is the name of the changed parameter.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from enum import IntEnum
from typing import TYPE_CHECKING
from xml.parsers.expat import ExpatError

from cfepy.status import UsageError
from rospy_shim.client.service import answer_packets
from rospy_shim.parameters.table import MASTER_TLM_MID
from rospy_shim.parameters.tree import ParameterTree
from rospy_shim.parameters.values import json_of, marshalled, of_json, through_xml
from rospy_shim.types.exceptions import ROSException
from rospy_shim.types.names import SEP

if TYPE_CHECKING:
    from cfepy.sb import SoftwareBus

_YES, _NO = b"\1", b"\0"


class ParameterConcern(IntEnum):
    """The operation of a request about parameters; roscfe's ParameterCall."""

    GET = 16
    SET = 17
    HAS = 18
    DELETE = 19
    SEARCH = 20
    NAMES = 21
    GIVE = 22  # parameters of the node's table, if not set already
    WATCH = 23  # as GET, with notices of changes


class CompiledParams:
    """Answers requests of compiled nodes about parameters.

    Args:
        tree: the mission's parameters.
        bus: receives the notices.
    """

    def __init__(self, tree: ParameterTree, bus: SoftwareBus) -> None:
        self._tree = tree
        self._bus = bus
        self._watched: set[str] = set()
        self._does: dict[int, Callable[[str, str, str], bytes]] = {
            ParameterConcern.GET: self._get,
            ParameterConcern.SET: self._set,
            ParameterConcern.HAS: self._has,
            ParameterConcern.DELETE: self._delete,
            ParameterConcern.SEARCH: self._search,
            ParameterConcern.NAMES: self._names,
            ParameterConcern.GIVE: self._give,
            ParameterConcern.WATCH: self._watch,
        }
        tree.on_change(self._tell)

    def takes(self, kind: int) -> bool:
        """Return True if a request is about parameters."""
        return kind in self._does

    def answer(self, kind: int, who: str, name: str, text: str) -> bytes:
        """Return the body of an answer.

        Args:
            kind: a `ParameterConcern`.
            who: full name of the node.
            name: full name of the parameter.
            text: its value as JSON, or the namespace in which a search begins.

        Raises:
            UsageError: XML-RPC cannot carry the value, or the tables are full.
        """
        try:
            return self._does[kind](who, name, text)
        except (ExpatError, ROSException, TypeError, ValueError, OverflowError) as error:
            raise UsageError(f"{who}: parameter {name}: {error}") from None

    def _get(self, who: str, name: str, text: str) -> bytes:
        value = self._tree.find(name)
        return _NO if value is ParameterTree.MISSING else _YES + json_of(value).encode()

    def _watch(self, who: str, name: str, text: str) -> bytes:
        self._watched.add(name)
        return self._get(who, name, text)

    def _set(self, who: str, name: str, text: str) -> bytes:
        (value,) = through_xml("setParam", who, marshalled(of_json(text)))
        if name != SEP or type(value) is dict:  # the master's refusal of another root is ignored
            self._tree.set(name, value)
        return _YES

    def _has(self, who: str, name: str, text: str) -> bytes:
        return _NO if self._tree.find(name) is ParameterTree.MISSING else _YES

    def _delete(self, who: str, name: str, text: str) -> bytes:
        try:
            self._tree.delete(name)
        except KeyError:
            return _NO
        return _YES

    def _search(self, who: str, name: str, text: str) -> bytes:
        found = self._tree.search(text, name)
        return _NO if found is None else _YES + found.encode()

    def _names(self, who: str, name: str, text: str) -> bytes:
        return _YES + json.dumps(self._tree.names()).encode()

    def _give(self, who: str, name: str, text: str) -> bytes:
        self._tree.offer(who, marshalled(of_json(text)))
        return _YES

    def _tell(self, name: str) -> None:
        """Send a notice of a changed parameter; nodes that cache it are to ask again."""
        changed = f"{name.rstrip(SEP)}{SEP}"
        if any(f"{each}{SEP}".startswith(changed) or changed.startswith(f"{each}{SEP}") for each in self._watched):
            for packet in answer_packets(MASTER_TLM_MID, 0, True, name.encode(), self._bus.config.sb_max_msg_size):
                self._bus.transmit_msg(packet)
