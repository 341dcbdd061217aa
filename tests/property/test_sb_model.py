"""The Software Bus against a model of a few lines: both agree on any calls in any order."""

from __future__ import annotations

from dataclasses import dataclass, field

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from cfepy.status import CfeError
from tests.sb.harness import Bench, packet

MSG_IDS = st.sampled_from([0x801, 0x802, 0x803, 0x804])
NAMES = st.sampled_from(["P0", "P1", "P2", "P3", "P4"])
MAX_PIPES, MAX_MSG_IDS, MAX_DESTS = 4, 3, 2


@dataclass(eq=False)
class ModelSubscription:
    """A pipe's name on a route, and how many of its messages were put there and not taken yet."""

    pipe: str
    limit: int
    outstanding: int = 0


@dataclass(eq=False)
class ModelPipe:
    """A pipe is a list of (MsgId, number, subscription) with a depth."""

    depth: int
    waiting: list[tuple[int, int, ModelSubscription]] = field(default_factory=list)


class BusAgainstModel(RuleBasedStateMachine):
    """Pipes by name. Routes keep subscriptions, newest first, and stay when they are empty."""

    @initialize()
    def start(self) -> None:
        self.bench = Bench(sb_max_pipes=MAX_PIPES, sb_max_msg_ids=MAX_MSG_IDS, sb_max_dest_per_pkt=MAX_DESTS)
        self.bus = self.bench.bus
        self.ids: dict[str, int] = {}
        self.pipes: dict[str, ModelPipe] = {}
        self.routes: dict[int, list[ModelSubscription]] = {}
        self.number = 0
        self.limit_errors = self.overflows = self.unrouted = 0

    def teardown(self) -> None:
        if hasattr(self, "bench"):
            self.bench.kernel.shutdown()

    @rule(name=NAMES, depth=st.integers(0, 6))
    def create_pipe(self, name: str, depth: int) -> None:
        possible = depth > 0 and name not in self.pipes and len(self.pipes) < MAX_PIPES
        result = self.bench.do("A", lambda: self.bus.create_pipe(depth, name))
        assert isinstance(result, int) == possible
        if isinstance(result, int):
            assert result not in self.ids.values()
            self.ids[name], self.pipes[name] = result, ModelPipe(depth)

    @rule(name=NAMES)
    def delete_pipe(self, name: str) -> None:
        result = self.bench.do("A", lambda: self.bus.delete_pipe(self.ids.get(name, 0x160000)))
        assert isinstance(result, CfeError) == (name not in self.pipes)
        self.ids.pop(name, None)
        self.pipes.pop(name, None)
        for route in self.routes.values():
            route[:] = [each for each in route if each.pipe != name]

    @rule(msg_id=MSG_IDS, name=NAMES, limit=st.integers(1, 4))
    def subscribe(self, msg_id: int, name: str, limit: int) -> None:
        result = self.bench.do("A", lambda: self.bus.subscribe_ex(msg_id, self.ids.get(name, 0x160000), 0, limit))
        if name not in self.pipes:
            assert isinstance(result, CfeError)
            return
        route = self.routes.get(msg_id)
        if route is None and len(self.routes) == MAX_MSG_IDS:
            assert isinstance(result, CfeError)
            return
        route = self.routes.setdefault(msg_id, [])
        if any(each.pipe == name for each in route):
            assert result is None
        elif len(route) == MAX_DESTS:
            assert isinstance(result, CfeError)
        else:
            assert result is None
            route.insert(0, ModelSubscription(name, limit))

    @rule(msg_id=MSG_IDS, name=NAMES)
    def unsubscribe(self, msg_id: int, name: str) -> None:
        result = self.bench.do("A", lambda: self.bus.unsubscribe(msg_id, self.ids.get(name, 0x160000)))
        assert isinstance(result, CfeError) == (name not in self.pipes)
        if msg_id in self.routes:
            self.routes[msg_id] = [each for each in self.routes[msg_id] if each.pipe != name]

    @rule(msg_id=MSG_IDS)
    def transmit(self, msg_id: int) -> None:
        self.number += 1
        assert self.bench.do("B", lambda: self.bus.transmit_msg(packet(msg_id, self.number.to_bytes(4, "big")))) is None
        if msg_id not in self.routes:
            self.unrouted += 1
            return
        for subscription in self.routes[msg_id]:
            pipe = self.pipes[subscription.pipe]
            if subscription.outstanding >= subscription.limit:
                self.limit_errors += 1
            elif len(pipe.waiting) >= pipe.depth:
                self.overflows += 1
            else:
                subscription.outstanding += 1
                pipe.waiting.append((msg_id, self.number, subscription))

    @rule(name=NAMES)
    def receive(self, name: str) -> None:
        result = self.bench.do("A", lambda: self.bus.receive_buffer(self.ids.get(name, 0x160000), 0))
        if name not in self.pipes:
            assert isinstance(result, CfeError)
        elif not self.pipes[name].waiting:
            assert result is None
        else:
            msg_id, number, subscription = self.pipes[name].waiting.pop(0)
            subscription.outstanding -= 1
            assert isinstance(result, bytes)
            assert (result[0] << 8 | result[1], int.from_bytes(result[16:], "big")) == (msg_id, number)

    @invariant()
    def counters_agree(self) -> None:
        if not hasattr(self, "bench"):
            return
        counters = self.bus.counters
        assert counters.msg_limit_error == self.limit_errors
        assert counters.pipe_overflow_error == self.overflows
        assert counters.no_subscribers == self.unrouted

    @invariant()
    def the_pool_is_counted_right(self) -> None:
        if not hasattr(self, "bench"):
            return
        waiting = {message[1] for pipe in self.pipes.values() for message in pipe.waiting}
        subscriptions = sum(len(route) for route in self.routes.values())
        assert self.bus.pool_use() == (len(waiting) * (20 + 64) + subscriptions * 32, len(waiting))
        assert self.bus.peaks.memory >= self.bus.pool_use()[0]

    @invariant()
    def routes_agree(self) -> None:
        if not hasattr(self, "bench"):
            return
        real = {
            msg_id: [(each.pipe.name, each.limit) for each in route.destinations]
            for msg_id, route in self.bus.routes.items()
        }
        assert real == {msg_id: [(each.pipe, each.limit) for each in route] for msg_id, route in self.routes.items()}


TestBusAgainstModel = BusAgainstModel.TestCase
TestBusAgainstModel.settings = settings(max_examples=25, stateful_step_count=40, deadline=None)
