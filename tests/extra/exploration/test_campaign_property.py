"""Every seed counts exactly once, however its crew fails, and however often and wherever the campaign is
interrupted."""

from __future__ import annotations

import pickle
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.extra.exploration import worker_pools as cluster_module
from cfepy.extra.exploration.campaign import Campaign, Experiment, Job, NumberedVerdict, Take, Tally, judge
from cfepy.extra.exploration.results_file import ResultsFile, read_results
from cfepy.extra.exploration.verdict import Verdict
from cfepy.extra.exploration.worker_pools import Cluster
from cfepy.status import UsageError
from tests.extra.exploration.fake_trials import FakeTrial, Seeds

FAILS = (2, 3, 17)
IDENTITY = {"mission": "fake"}


class Flaky:
    """A crew that takes any seeds, loses batches and retries them, answers in any order, and may end.

    Args:
        random: decides.
        ends: exception that ends it occasionally.
        flown: counts the seeds that it flew.
    """

    def __init__(self, random: Random, ends: tuple[type[BaseException], ...], flown: Counter[int]) -> None:
        self._random = random
        self._ends = ends
        self._flown = flown

    def run(self, trial: Experiment, take: Take) -> Iterator[NumberedVerdict]:
        random, out = self._random, list[list[Job]]()
        while True:
            while len(out) < random.randint(1, 4) and (jobs := take(random.randint(1, 5))):
                out.append(jobs)
            if not out:
                return
            batch = out.pop(random.randrange(len(out)))
            if random.random() < 0.3:
                out.append(batch)  # lost with its worker
                continue
            random.shuffle(batch)
            for number, schedule in batch:
                self._flown[number] += 1
                yield number, judge(trial, schedule)
                if self._ends and random.random() < 0.05:
                    raise random.choice(self._ends)("the crew is gone")

    def close(self) -> None:
        """Nothing to end."""


def fly(path: Path, crew: Any, count: int) -> tuple[list[tuple[int, Verdict]], Tally | None]:
    """Return the reported verdicts of a session, and its tally, or None if it was interrupted."""
    told: list[tuple[int, Verdict]] = []
    campaign = Campaign(FakeTrial(fails=FAILS), Seeds(), count, crew, ResultsFile(path, IDENTITY))
    try:
        return told, campaign.run(lambda number, verdict: told.append((number, verdict)))
    except UsageError:
        return told, None


def check(told: list[tuple[int, Verdict]]) -> None:
    """In order from the first one, each once, each with the verdict on its own schedule."""
    assert [number for number, _ in told] == list(range(len(told)))
    for number, verdict in told:
        assert verdict.schedule.seed == number
        assert verdict.failed == (number in FAILS)


@settings(max_examples=30)
@given(st.integers(0, 2**32), st.integers(1, 60))
def test_every_seed_counts_once_after_interruptions(seed: int, count: int) -> None:
    random, flown = Random(seed), Counter[int]()
    with TemporaryDirectory() as folder:
        path = Path(folder, "results")
        for session in range(100):
            before = flown.total()
            kept = len(list(read_results(path)[1])) if session else 0
            ends = (KeyboardInterrupt, UsageError) if session < 99 else ()
            told, tally = fly(path, Flaky(random, ends, flown), count)
            check(told)
            assert flown.total() - before + kept == len(list(read_results(path)[1])), "flown, and not kept"
            if tally is not None and not tally.interrupted:
                break
            if random.random() < 0.3:  # killed while it wrote a line
                data = path.read_bytes()
                path.write_bytes(data[: max(data.index(b"\n") + 1, len(data) - random.randint(1, 40))])
        assert tally == Tally(done=count, failed=sum(each < count for each in FAILS), resumed=kept)
        assert len(told) == count
        numbers = Counter(number for number, _ in read_results(path)[1])
        assert numbers == Counter(range(count))


class Killed(Exception):
    """Stands for dask's error that a batch killed several workers."""


class SlowAnswer(Exception):
    """Stands for dask's error that no answer arrived."""


class Future:
    """A batch on the cluster."""

    def __init__(self, client: Client, jobs: list[Job]) -> None:
        self.status = "pending"
        self._client = client
        self._jobs = jobs
        self._callback: Callable[[Future], object] = lambda _: None

    def add_done_callback(self, callback: Callable[[Future], object]) -> None:
        self._callback = callback
        self._client.one_is_done()

    def end(self, status: str) -> None:
        self.status = status
        self._callback(self)

    def exception(self) -> Exception:
        return Killed("three workers died")

    def result(self, timeout: float) -> list[NumberedVerdict]:
        if self._client.random.random() < 0.2:
            raise SlowAnswer
        trial = self._client.trial
        return [(number, judge(trial, schedule)) for number, schedule in self._jobs]

    @property
    def size(self) -> int:
        return len(self._jobs)


class Client:
    """A cluster of two threads whose workers die at random."""

    id, status = "client-1", "running"

    def __init__(self, random: Random) -> None:
        self.random = random
        self.trial: Experiment = FakeTrial()
        self._pending: list[Future] = []

    def wait_for_workers(self, *_: object, **__: object) -> None:
        """They are there."""

    def register_plugin(self, desk: Any) -> None:
        self.trial = pickle.loads(desk._trial)

    def unregister_worker_plugin(self, name: str) -> None:
        """Remove the plugin."""

    def nthreads(self) -> dict[str, int]:
        return {"one": 1, "two": 1}

    def submit(self, function: object, name: str, jobs: list[Job], pure: bool) -> Future:
        self._pending.append(Future(self, jobs))
        return self._pending[-1]

    def one_is_done(self) -> None:
        future = self._pending.pop(self.random.randrange(len(self._pending)))
        future.end("error" if future.size > 1 and self.random.random() < 0.2 else "finished")

    def cancel(self, futures: list[Future], force: bool) -> None:
        """They are forgotten."""

    def close(self) -> None:
        """Close the client."""


@pytest.mark.parametrize("seed", range(20))
def test_cluster_with_dying_workers_loses_and_duplicates_no_verdict(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    comm = pytest.importorskip("distributed").comm
    random = Random(seed)
    fake = SimpleNamespace(
        Client=lambda *_, **__: Client(random),
        KilledWorker=Killed,
        TimeoutError=SlowAnswer,
        LocalCluster=None,
        comm=comm,
    )
    monkeypatch.setattr(cluster_module, "_distributed", lambda: fake)
    told: list[tuple[int, Verdict]] = []
    campaign = Campaign(FakeTrial(fails=FAILS), Seeds(), 300, Cluster("tcp://10.0.0.1:8786"))
    assert campaign.run(lambda number, verdict: told.append((number, verdict))) == Tally(done=300, failed=3)
    assert len(told) == 300
    check(told)
