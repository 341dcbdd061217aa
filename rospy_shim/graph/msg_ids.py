"""MsgIds of topics and services: from the mission file, from the lock file, or from a hash of the name.

A hash is the same in every run, but 1791 ids are few: among 50 topics two collide in every other mission. So there is a
lock file, in which every name has its own id (`locked`). In a run without a mission folder, a name whose id is taken
gets the next free one.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.nodes import RosConfig

ROSOUT = "/rosout"
ROSOUT_MSG_ID = 0x0900
FIRST_MSG_ID = 0x0901
LAST_MSG_ID = 0x0FFF
COMMAND_BIT = 0x1000  # a service's requests are commands, its answers telemetry of the same number

_SERVICE = "service "
_HOW_MANY = LAST_MSG_ID - FIRST_MSG_ID + 1


class MsgIds:
    """The MsgIds of one mission and their owners.

    Args:
        config: ids of the mission file and its lock file.
    """

    def __init__(self, config: RosConfig) -> None:
        self._config = config
        self._names: dict[int, str] = {msg_id: service_label(name) for name, msg_id in config.locked_services.items()}
        self._names |= {msg_id: name for name, msg_id in config.locked_topics.items()}
        self._names |= {topic.msg_id: name for name, topic in config.topics.items()}
        self._claimed: dict[str, int] = {}

    def of_topic(self, name: str) -> int:
        """Return the MsgId of a topic, by its resolved name.

        Raises:
            UsageError: it belongs to another topic or service, or no id is left.
        """
        pinned, known = self._config.topics.get(name), self._config.locked_topics.get(name)
        if pinned is not None:
            return pinned.msg_id
        if known is not None:
            return known
        msg_id = msg_id_of(name)
        holder = self._names.get(msg_id, name)
        if holder == name or self._config.spread:
            return self.claim(name)
        raise UsageError(
            f"{holder} and {name} have the same MsgId 0x{msg_id:04X}; run `cfepy graph --lock MISSION` to "
            f'give each topic its own MsgId, or write in mission.yaml: "{name}: {{msg_id: '
            f'0x{next_free(msg_id, self._names):04X}}}"',
            field="topics",
        )

    def of_service(self, name: str) -> int:
        """Return the MsgId of a service's answers, by its resolved name: the next free one if the id of its name is
        taken.
        """
        known = self._config.locked_services.get(name)
        return self.claim(service_label(name)) if known is None else known

    def claimed(self) -> tuple[list[str], list[str]]:
        """Return the names of topics and of services that have an id without a file's entry."""
        services = [label.removeprefix(_SERVICE) for label in self._claimed if label.startswith(_SERVICE)]
        return [label for label in self._claimed if not label.startswith(_SERVICE)], services

    def services(self) -> dict[int, str]:
        """Return the services that have MsgIds, by the MsgId of their answers."""
        return {id_: label.removeprefix(_SERVICE) for id_, label in self._names.items() if label.startswith(_SERVICE)}

    def claim(self, label: str) -> int:
        """Claim the id of a name's hash, or the next free one. Returns the id."""
        msg_id = self._claimed.get(label)
        if msg_id is None:
            msg_id = msg_id_of(label)
            if self._names.get(msg_id, label) != label:
                msg_id = next_free(msg_id, self._names)
            self._names[msg_id] = label
            self._claimed[label] = msg_id
        return msg_id


def locked(config: RosConfig, topics: Iterable[str], services: Iterable[str]) -> tuple[dict[str, int], dict[str, int]]:
    """Compute the MsgIds for a lock file: existing entries stay, new names follow in their order.

    Args:
        config: the entries of the mission file and the present lock file.
        topics: resolved names of the mission's topics.
        services: resolved names of the mission's services.

    Returns:
        MsgIds by name: of the topics that the mission file does not pin, and of the services' answers.

    Raises:
        UsageError: there are more names than MsgIds.
    """
    ids, old_topics, old_services = MsgIds(config), config.locked_topics, config.locked_services
    of_topics = dict(old_topics)
    for name in sorted({*topics} - {*old_topics, *config.topics}):
        of_topics[name] = ids.claim(name)
    of_services = dict(old_services)
    for name in sorted({*services} - {*old_services}):
        of_services[name] = ids.of_service(name)
    return of_topics, of_services


def next_free(msg_id: int, taken: Mapping[int, str]) -> int:
    """Return the first free id after `msg_id`; after the last id the search continues at the first.

    Raises:
        UsageError: no id is free.
    """
    for step in range(1, _HOW_MANY):
        found = FIRST_MSG_ID + (msg_id + step - FIRST_MSG_ID) % _HOW_MANY
        if found not in taken:
            return found
    raise UsageError(f"more than {_HOW_MANY} topics and services: no MsgId is left", field="topics")


def msg_id_of(name: str) -> int:
    """Return the default MsgId of a name: 0x0901 to 0x0FFF, from a hash; /rosout has 0x0900."""
    if name == ROSOUT:
        return ROSOUT_MSG_ID
    digest = hashlib.blake2b(name.encode(), digest_size=8).digest()
    return FIRST_MSG_ID + int.from_bytes(digest, "big") % _HOW_MANY


def service_label(name: str) -> str:
    """Return the label of a service among the names with MsgIds; a topic may have the same name."""
    return f"{_SERVICE}{name}"
