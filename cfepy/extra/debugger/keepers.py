"""`Keepers`: paused processes at moments of a run, from each of which the run can go on.

    keeper at 1 --fork--> keeper at 2001 --fork--> ... --fork--> the process that flies, and asks its user

The flying process forks regularly: the parent waits there, and its child goes on. To go back, the child sends the
target to the last keeper before it, and ends; the keeper forks once more. So going back takes as long as the run took
from that keeper on. Only tasks on greenlets can be forked, because a fork copies one thread only.
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

FIRST = 500  # events between two keepers, at first
LEAST = 50
PARTS = 8  # parts of a way back, with a keeper after each
LENGTH_BYTES = 8
MOST = 24  # keepers; beyond this, every other one ends, and new ones come half as often


class Keeper(NamedTuple):
    """A waiting process.

    Attributes:
        happened: number of events at its moment.
        orders: pipe for its orders: go on to a target, or end.
    """

    happened: int
    orders: int


class KeeperOrder(NamedTuple):
    """An order for a keeper; see `Journey`."""

    target: RunMoment | LineMoment | None
    search: BackSearch | None
    texts: list[str]
    was_in_vain: bool


class Keepers:
    """The keepers of the flights of a replay, in the order of their moments."""

    def __init__(self) -> None:
        self._all: list[Keeper] = []
        self._every = FIRST
        self._next = 1

    def keep(self, journey: Journey, happened: int, waiting: Callable[[], AbstractContextManager[None]]) -> None:
        """Leave a keeper here if one is due after this number of events.

        Args:
            journey: of the replay; changed when this call returns in a process that got an order.
            happened: number of events.
            waiting: a context around the time that the keeper waits.
        """
        if happened < self._next:
            return
        if len(self._all) >= MOST:
            self._thin_out()
        self._next = happened + self._every
        sys.stdout.flush()
        sys.stderr.flush()
        freeze()  # a garbage collection in a child would have to copy these objects
        with waiting():
            self._fork(journey, happened)

    def _fork(self, journey: Journey, happened: int) -> None:
        """Turn this process into the keeper. The call returns only in its children."""
        while True:
            reader, writer = os.pipe()
            with warnings.catch_warnings():  # about other threads, which only watch here and hold no lock
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
            os.waitpid(child, 0)  # it has ended, as have all processes at later moments
            journey.target, journey.search, journey.texts, journey.was_in_vain = order
            journey.flies_again = False
            self._come_closer(order, happened)

    def _come_closer(self, order: KeeperOrder, happened: int) -> None:
        """Place more keepers on the way, because a user who goes back usually does it again."""
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
        """Return True if a keeper can go to the journey's target; then call `hand_over`."""
        return self._before(journey) is not None

    def _before(self, journey: Journey) -> Keeper | None:
        search = journey.search
        at = journey.target if search is None else search.limit
        if not isinstance(at, RunMoment):
            return None
        last = at.happened if search is None or at.hits or at.finds else at.happened - 1
        return next((keeper for keeper in reversed(self._all) if keeper.happened <= last), None)

    def hand_over(self, journey: Journey) -> None:
        """Let a keeper go on. This process ends.

        Raises:
            LookupError: no keeper can.
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
            with contextlib.suppress(BrokenPipeError):  # this keeper was removed after the fork of this process
                os.write(chosen.orders, len(order).to_bytes(LENGTH_BYTES, "little") + order)
                end_process(0)
            self._all = self._all[: self._all.index(chosen)]
        raise LookupError("no process to continue from")

    def dismiss(self) -> None:
        """End all keepers."""
        for keeper in reversed(self._all):
            _dismiss(keeper)
        self._all.clear()
        self._next = 1


def _wait_for_order(reader: int) -> KeeperOrder | None:
    """Return the order for this keeper; None if it is to end, or if the ordering process has ended."""
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
    """Let a keeper end. Processes that were forked later may still have its pipe."""
    with contextlib.suppress(BrokenPipeError):
        os.write(keeper.orders, bytes(LENGTH_BYTES))
    os.close(keeper.orders)
