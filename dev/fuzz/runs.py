"""Run cases of a kind, and find those that end with an unexpected error."""

from __future__ import annotations

import signal
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random
from types import FrameType
from typing import NamedTuple

from dev.fuzz.damage import damaged
from dev.fuzz.kinds import KINDS, REFUSED

_WAITS = 20  # times as long a case may wait: a busy computer gives it the CPU now and then


class Failed(NamedTuple):
    """A case that ended with a traceback, or did not end."""

    kind: str
    seed: int
    number: int
    what: str
    data: bytes


class HangError(BaseException):
    """A case took too long. Handlers for Exception do not catch it."""


def failures(name: str, count: int, seed: int, folder: Path, patience_s: float = 0) -> Iterator[Failed]:
    """Yield the cases that fail.

    Args:
        name: name of the kind.
        count: how many cases.
        seed: seed of all cases.
        folder: folder for their files.
        patience_s: limit of CPU time for each case, s, with a much longer limit for waiting; 0 for no limit.
    """
    kind = KINDS[name]
    samples = kind.samples()
    assert samples, f"{name} has no samples"
    for number in range(count):
        data = damaged(samples, Random(f"{name}:{seed}:{number}"))
        path = folder / kind.file
        path.write_bytes(data)
        try:
            with _alarm(patience_s):
                kind.attempt(data, path)
        except REFUSED:
            continue
        except (Exception, HangError):
            yield Failed(name, seed, number, traceback.format_exc(), data)


@contextmanager
def _alarm(patience_s: float) -> Iterator[None]:
    if not patience_s:
        yield
        return

    def ring(number: int, frame: FrameType | None) -> None:
        raise HangError

    before = {each: signal.signal(each, ring) for each in (signal.SIGPROF, signal.SIGALRM)}
    signal.setitimer(signal.ITIMER_PROF, patience_s)
    signal.setitimer(signal.ITIMER_REAL, _WAITS * patience_s)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)
        for each, handler in before.items():
            signal.signal(each, handler)
