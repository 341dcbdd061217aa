"""The stimulus of a node: random messages and requests from a seed, which the driver executes on both sides."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from io import BytesIO
from typing import Any, NamedTuple

from cfepy.extra.convert.capacities import Capacities
from dev.roscfe.random_messages import Source
from rospy_shim.types.genpy import Duration
from rospy_shim.types.msgs import Library
from rospy_shim.types.msgs.spec import BUILTINS, Field

GAP_S = 0.1
"""Between two steps: what one leads to is over before the next."""
SECONDS = 5.0
ITEMS = 16
"""Of an array without a length of its own, where a scene says nothing: nodes seldom look whether there are enough."""
FEW = 3
"""Of an array of messages."""
WILD = 0.2
"""The share of messages whose values are anything that their types allow."""
TF = "tf2_msgs/TFMessage"
FRAMES = ("frame_id", "child_frame_id")
WHOLE = {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)} | {"byte", "char"}


class Seen(NamedTuple):
    """A node's entries in the graph: names with types.

    Attributes:
        publishes, subscribes: topics.
        serves, calls: services.
    """

    publishes: dict[str, str]
    subscribes: dict[str, str]
    serves: dict[str, str]
    calls: dict[str, str]


class Scene(NamedTuple):
    """The environment that a node needs.

    Attributes:
        params: parameters by name, such as "~rate".
        args: arguments of its command line.
        frames: pairs of parent and child for /tf; messages use the same frame names.
        texts: texts that its messages may have.
        undriven: topics that get no messages.
        gap_s: seconds between two steps, if the node needs longer.
        items: number of items in arrays without a fixed length.
        wild: the share of messages with arbitrary values.
    """

    params: Mapping[str, Any] = {}
    args: str = ""
    frames: tuple[tuple[str, str], ...] = (("map", "odom"), ("odom", "base_link"), ("base_link", "laser"))
    texts: tuple[str, ...] = ("one", "two", "three")
    undriven: tuple[str, ...] = ()
    gap_s: float = GAP_S
    items: int = ITEMS
    wild: float = WILD


class _Lengths(Capacities):
    """Any length is allowed."""

    def of_array(self, place: str, item: str) -> int:
        return ITEMS if item in BUILTINS else FEW


class Stimulus(Source):
    """Draws messages that a node can do something with, and now and then any others.

    Args:
        seed: of the random numbers.
        library: of the types.
        scene: names of frames, and other texts.
    """

    def __init__(self, seed: int | str, library: Library, scene: Scene) -> None:
        super().__init__(seed, _Lengths(text=24), library)
        self._scene = scene
        self._wild = False

    def data(self, full_name: str) -> bytes:
        """Return the bytes of a message."""
        self._wild = self._random.random() < self._scene.wild
        made = self._transforms() if full_name == TF else self.message(full_name)
        buffer = BytesIO()
        made.serialize(buffer)
        return buffer.getvalue()

    def message(self, full_name: str) -> Any:
        """See `Source.message`. Rotations have length 1, except in a wild message."""
        made = super().message(full_name)
        if full_name == "geometry_msgs/Quaternion" and not self._wild:
            length = math.hypot(made.x, made.y, made.z, made.w)
            for name in made.__slots__:
                setattr(made, name, getattr(made, name) / length)
        return made

    def _transforms(self) -> Any:
        """Return the whole tree of frames."""
        self._wild = False
        made = self._library.message_class(TF)()
        for parent, child in self._scene.frames:
            one = self.message("geometry_msgs/TransformStamped")
            one.header.frame_id, one.child_frame_id = parent, child
            made.transforms.append(one)
        return made

    def _value(self, owner: str, each: Field) -> Any:
        if each.is_array and each.length is None and each.base in BUILTINS:
            one = [self._one(each.base, f"{owner}.{each.name}[]") for _ in range(self._scene.items)]
            return bytes(value % 256 for value in one) if each.base in ("uint8", "char") else one
        return super()._value(owner, each)

    def _one(self, kind: str, place: str) -> Any:
        draw = self._random
        if kind == "string" and not self._wild:
            frames = sorted({name for pair in self._scene.frames for name in pair})
            return draw.choice(frames if place.rpartition(".")[2] in FRAMES else self._scene.texts)
        if kind == "duration" and not self._wild:
            return Duration(draw.randrange(3), draw.randrange(10**9))
        if kind in WHOLE and not self._wild:
            return draw.randrange(3)
        drawn = super()._one(kind, place)
        return drawn.replace("\n", " ") if kind == "string" else drawn  # a line of the log is one

    def _float(self, kind: str) -> float:
        if self._wild:
            return super()._float(kind)
        return self._random.randrange(-2048, 2048) / 1024


class Step(NamedTuple):
    """One thing that the driver does: a message on a topic, or a call of a service."""

    kind: str
    name: str
    hex: str


def steps(seed: int | str, seen: Seen, library: Library, scene: Scene) -> Iterator[Step]:
    """Yield the steps of the stimulus in order, for five seconds."""
    source = Stimulus(seed, library, scene)
    topics = {
        name: kind for name, kind in sorted(seen.subscribes.items()) if name not in scene.undriven and kind != "*"
    }
    doings = [("publish", name, kind) for name, kind in topics.items()]
    doings += [("call", name, f"{kind}Request") for name, kind in sorted(seen.serves.items())]
    for number in range(round(SECONDS / scene.gap_s) if doings else 0):
        what, name, kind = doings[number % len(doings)]
        yield Step(what, name, source.data(kind).hex())


def script(seed: int | str, seen: Seen, library: Library, scene: Scene) -> dict[str, Any]:
    """Return the whole script of the driver, as plain values.

    Args:
        seed: seed of the random numbers.
        seen: the node's entries in the graph.
        library: library of the types.
        scene: the environment that the node needs.
    """
    done = list(steps(seed, seen, library, scene))
    answers = Stimulus(f"{seed} answers", library, scene)
    driven = {step.name for step in done}
    return {
        "listen": sorted(seen.publishes),
        "publish": {name: kind for name, kind in sorted(seen.subscribes.items()) if name in driven},
        "serve": {
            name: [kind, [answers.data(f"{kind}Response").hex() for _ in range(8)]]
            for name, kind in sorted(seen.calls.items())
        },
        "call": dict(sorted(seen.serves.items())),
        "steps": done,
        "gap": scene.gap_s,
        "seconds": SECONDS,
    }
