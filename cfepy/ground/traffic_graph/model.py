"""`MissionGraph`: applications and nodes, their messages with MsgIds, and the pipes that receive them.

It combines the routing table and ROS's graph at one moment with the senders observed until then, because cFE does not
know a sender before it sends.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

from cfepy.es import NODE_SYMBOL
from cfepy.ground.survey import rows_of
from cfepy.mission import CORE_APPS, Mission
from cfepy.units import NS_PER_S

APP, NODE, CORE = "app", "node", "core"
"""Kinds of units: cFE's own services, and the application that stands for roscore, are the core."""
CORE_NAME = "cFE"
ROS_APP = "ROS"
LOG_TOPIC = "/rosout"
LOGGER_SERVICES = ("/get_loggers", "/set_logger_level")
_GOAL = "ActionGoal"


@dataclass(frozen=True, slots=True)
class Unit:
    """A sender and receiver; `app` is its name in cFE, which differs from `name` for a node."""

    name: str
    kind: str
    app: str


@dataclass(frozen=True, slots=True)
class Taker:
    """A pipe that receives a message: its owner, its limit for all messages, and for this one."""

    unit: str
    pipe: str
    depth: int
    limit: int


@dataclass(frozen=True, slots=True)
class Channel:
    """One MsgId: its name and type, its observed senders, its number per virtual second since the mission was
    operational, and its receivers.
    """

    msg_id: int
    name: str
    type: str
    hz: float
    senders: tuple[str, ...]
    subscriptions: tuple[Taker, ...]

    @property
    def is_topic(self) -> bool:
        """Whether it is a ROS topic."""
        return "/" in self.type


@dataclass(frozen=True, slots=True)
class Offer:
    """A service, or an action, of a node."""

    name: str
    type: str
    unit: str
    kind: str


@dataclass(frozen=True, slots=True)
class MissionGraph:
    """The whole graph, ordered by names and MsgIds."""

    mission: str
    units: tuple[Unit, ...]
    channels: tuple[Channel, ...]
    offers: tuple[Offer, ...]

    def to_dict(self) -> dict[str, Any]:
        """Return plain numbers and text."""
        return asdict(self)

    @property
    def summary(self) -> str:
        """Return its size, in a line."""
        nodes = sum(unit.kind == NODE for unit in self.units)
        pipes = {each.pipe for channel in self.channels for each in channel.subscriptions}
        counts = {"node": nodes, "application": len(self.units) - nodes, "message": len(self.channels)}
        counts["pipe"] = len(pipes)
        return ", ".join(f"{count} {what}{'' if count == 1 else 's'}" for what, count in counts.items())

    def of_interest(self) -> MissionGraph:
        """Return the graph without the parts that every mission has.

        The services of cFE become one unit, and messages between them are left out. A log without subscribers and the
        services that set log levels are left out too.
        """
        core = {unit.name for unit in self.units if unit.kind == CORE}
        rest = [unit for unit in self.units if unit.name not in core]
        channels = tuple(filter(_is_of_interest, (_with_one_core(channel, core) for channel in self.channels)))
        return replace(
            self,
            units=(*([Unit(CORE_NAME, CORE, CORE_NAME)] if CORE_NAME in _mentioned(channels) else []), *rest),
            channels=channels,
            offers=tuple(offer for offer in self.offers if not offer.name.endswith(LOGGER_SERVICES)),
        )


def _mentioned(channels: Iterable[Channel]) -> set[str]:
    """Return the names of all that send or receive something."""
    return {name for each in channels for name in (*each.senders, *(taker.unit for taker in each.subscriptions))}


def _with_one_core(channel: Channel, core: set[str]) -> Channel:
    senders = dict.fromkeys(CORE_NAME if name in core else name for name in channel.senders)
    taken = tuple(replace(each, unit=CORE_NAME) if each.unit in core else each for each in channel.subscriptions)
    return replace(channel, senders=tuple(senders), subscriptions=taken)


def _is_of_interest(channel: Channel) -> bool:
    takers = {each.unit for each in channel.subscriptions}
    if channel.name == LOG_TOPIC and not takers:
        return False
    return bool(({*channel.senders} | takers) - {CORE_NAME})


def graph_of(mission: Mission, senders_of: Mapping[int, Iterable[str]]) -> MissionGraph:
    """Return the graph of a running mission.

    Args:
        mission: the mission.
        senders_of: names of the applications that sent each MsgId.
    """
    names = _names_of_nodes(mission)
    channels = tuple(_channels(mission, senders_of, names))
    units = tuple(_units(mission, names, _mentioned(channels)))
    return MissionGraph(mission.spec.name, units, channels, tuple(_offers(mission)))


def _names_of_nodes(mission: Mission) -> dict[str, str]:
    """Return the names of nodes by those of their applications, without scripts that are not (yet) nodes."""
    nodes = [] if mission.ros is None else mission.ros.graph.nodes.values()
    return {node.config.app: node.names.name for node in nodes}


def _channels(mission: Mission, senders_of: Mapping[int, Iterable[str]], names: Mapping[str, str]) -> Iterator[Channel]:
    routes, seconds = mission.cfe.sb.routes, (mission.kernel.now - (mission.booted or 0)) / NS_PER_S
    for row in rows_of(mission, {msg_id: set(senders) for msg_id, senders in senders_of.items()}):
        route = routes.get(row.msg_id)
        taken = [] if route is None else route.destinations
        found = [
            Taker(names.get(each.pipe.app_name, each.pipe.app_name), each.pipe.name, each.pipe.depth, each.limit)
            for each in taken
        ]
        yield Channel(
            row.msg_id,
            row.name,
            row.type,
            0.0 if route is None or not seconds else round(route.sent / seconds, 3),
            tuple(sorted({names.get(sender, sender) for sender in row.senders})),
            tuple(sorted(found, key=lambda each: (each.unit, each.pipe))),
        )


def _units(mission: Mission, names: Mapping[str, str], mentioned: set[str]) -> Iterator[Unit]:
    """Yield all that send or receive, and the rest of the startup script."""
    apps = {name: app for app, name in names.items()}
    listed = [names.get(entry.name, entry.name) for entry in mission.spec.entries if entry.kind == "CFE_APP"]
    scripts = {entry.name for entry in mission.spec.entries if entry.symbol == NODE_SYMBOL}
    for name in sorted({*listed, *mentioned, *names.values()}):
        core = name in CORE_APPS or (name == ROS_APP and mission.ros is not None)
        is_node = name in apps or name in scripts
        yield Unit(name, CORE if core else NODE if is_node else APP, apps.get(name, name))


def _offers(mission: Mission) -> Iterator[Offer]:
    if mission.ros is None:
        return
    for name, entry in sorted(mission.ros.graph.services.items()):
        yield Offer(name, entry.service.service_class._type, entry.service.__node__.names.name, "service")
    for row in mission.ros.topics():
        if row.name.endswith("/goal") and row.type.endswith(_GOAL):
            for server in row.subscribers:
                yield Offer(row.name.removesuffix("/goal"), row.type.removesuffix(_GOAL), server, "action")
