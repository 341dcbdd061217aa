"""`Keepers`: processes that stand still at moments of a run, from each of which it can go on.

    keeper at 1 --fork--> keeper at 2001 --fork--> ... --fork--> the process that flies, and asks its user

The process that flies forks now and then: the parent waits there, and its child goes on. To go back, the child writes
to the keeper before the moment that is meant where to go, and ends; the keeper forks once more. So a way back takes as
long as the run took from that keeper on. Only tasks on greenlets can be forked, since a fork takes one thread along.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import sys
import warnings
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import NamedTuple

from cfepy.extra.debugger.journey import BackSearch, Journey, LineMoment, RunMoment
from cfepy.interpreter.garbage import freeze
from cfepy.interpreter.host_system import end_process

FIRST = 500  # things that happen between two keepers, at first
LEAST = 50
PARTS = 8  # of a way back, with a keeper behind each
LENGTH_BYTES = 8
MOST = 24  # keepers; when there are more, every other one goes, and the next ones come half as often


class Keeper(NamedTuple):
    """A process that waits.

    Attributes:
        happened: how many things have happened there.
        orders: where it is told to go on, or to end.
    """

    happened: int
    orders: int


class KeeperOrder(NamedTuple):
    """What a keeper is told: see `Journey`."""

    target: RunMoment | LineMoment | None
    search: BackSearch | None
    texts: list[str]
    was_in_vain: bool


class Keepers:
    """Those of the flights of a replay, in the order of their moments."""

    def __init__(self) -> None:
        self._all: list[Keeper] = []
        self._every = FIRST
        self._next = 1

    def keep(self, journey: Journey, happened: int, waiting: Callable[[], AbstractContextManager[None]]) -> None:
        """So much has happened: leave a keeper here, if it is time for one.

        Args:
            journey: of the replay; changed when this comes back in a process that was told where to go.
            happened: how many things.
            waiting: a context around the time that the keeper waits.
        """
        if happened < self._next:
            return
        if len(self._all) >= MOST:
            self._thin_out()
        self._next = happened + self._every
        sys.stdout.flush()
        sys.stderr.flush()
        freeze()  # a child that went through these objects would have to copy them
        with waiting():
            self._fork(journey, happened)

    def _fork(self, journey: Journey, happened: int) -> None:
        """This process becomes the keeper; it comes back in its children alone."""
        while True:
            reader, writer = os.pipe()
            with warnings.catch_warnings():  # of other threads: here they only watch, and hold no lock
                warnings.simplefilter("ignore", DeprecationWarning)
                child = os.fork()
            if not child:
                os.close(reader)
                self._all.append(Keeper(happened, writer))
                return
            os.close(writer)
            order = _wait_for_order(reader)
            if order is None:
                end_process(0)
            os.close(reader)
            os.waitpid(child, 0)  # which has ended, as all have that stood at later moments
            journey.target, journey.search, journey.texts, journey.was_in_vain = order
            journey.flies_again = False
            self._come_closer(order, happened)

    def _come_closer(self, order: KeeperOrder, happened: int) -> None:
        """Who goes back once does it again: more keepers on the way make the next ways shorter."""
        at = order.target if order.search is None else order.search.limit
        if isinstance(at, RunMoment):
            self._every = max(LEAST, (at.happened - happened) // PARTS)
            self._next = happened + self._every

    def _thin_out(self) -> None:
        for keeper in self._all[1::2]:
            _dismiss(keeper)
        del self._all[1::2]
        self._every *= 2

    def serves(self, journey: Journey) -> bool:
        """Whether a keeper can go where a journey wants to be; then `hand_over` lets it."""
        return self._before(journey) is not None

    def _before(self, journey: Journey) -> Keeper | None:
        search = journey.search
        at = journey.target if search is None else search.limit
        if not isinstance(at, RunMoment):
            return None
        last = at.happened if search is None or at.hits or at.finds else at.happened - 1
        return next((keeper for keeper in reversed(self._all) if keeper.happened <= last), None)

    def hand_over(self, journey: Journey) -> None:
        """Let a keeper go on; this process ends.

        Raises:
            LookupError: none can.
        """
        sys.stdout.flush()
        sys.stderr.flush()
        while (chosen := self._before(journey)) is not None:
            for keeper in reversed(self._all):
                if keeper.happened > chosen.happened:
                    _dismiss(keeper)
            if journey.search is not None:
                journey.search.begins_at = chosen.happened
            order = pickle.dumps(KeeperOrder(journey.target, journey.search, journey.texts, journey.was_in_vain))
            with contextlib.suppress(BrokenPipeError):  # it has been thinned out since this process was forked
                os.write(chosen.orders, len(order).to_bytes(LENGTH_BYTES, "little") + order)
                end_process(0)
            self._all = self._all[: self._all.index(chosen)]
        raise LookupError("no process to continue from")

    def dismiss(self) -> None:
        """None is needed any more."""
        for keeper in reversed(self._all):
            _dismiss(keeper)
        self._all.clear()
        self._next = 1


def _wait_for_order(reader: int) -> KeeperOrder | None:
    """What this keeper is told; None when it is to end, or the process that would tell it has ended."""
    usual = signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that flies
    length = int.from_bytes(_read(reader, LENGTH_BYTES), "little")
    order: KeeperOrder | None = pickle.loads(_read(reader, length)) if length else None
    signal.signal(signal.SIGINT, usual)
    return order


def _read(reader: int, count: int) -> bytes:
    data = b""
    while len(data) < count and (more := os.read(reader, count - len(data))):
        data += more
    return data


def _dismiss(keeper: Keeper) -> None:
    """Let it end; others that were forked later may still have its pipe."""
    with contextlib.suppress(BrokenPipeError):
        os.write(keeper.orders, bytes(LENGTH_BYTES))
    os.close(keeper.orders)
