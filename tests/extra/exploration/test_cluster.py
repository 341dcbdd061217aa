"""Campaigns on a cluster: real dask schedulers and workers on the loopback interface."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from pathlib import Path

import pytest

from cfepy.extra.exploration.campaign import Campaign, Inline, NumberedVerdict, Tally
from cfepy.extra.exploration.cluster_worker import check_versions
from cfepy.extra.exploration.mission_transfer import files_read, ship
from cfepy.extra.exploration.results_file import ResultsFile, read_results
from cfepy.extra.exploration.trial import Trial
from cfepy.extra.exploration.verdict import Verdict
from cfepy.extra.exploration.worker_pools import Cluster
from cfepy.extra.exploration.workers import PROCESS_DIED
from cfepy.pilot.plan import RunPlan
from cfepy.reading.resources import import_path, shipped
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from tests.extra.exploration.fake_trials import FakeTrial, Seeds

IDENTITY = {"plan": "fake"}
ENVIRONMENT = {**os.environ, "PYTHONPATH": import_path()}


class LoopbackCluster:
    """A scheduler and two workers, each a process of its own."""

    def __init__(self, stack: ExitStack, workers: int = 2) -> None:
        self._stack = stack
        self.scheduler = self._start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        assert self.scheduler.stderr is not None
        found = next(
            match for line in self.scheduler.stderr if (match := re.search(rb"Scheduler at: +(tcp:\S+)", line))
        )
        self.address = found[1].decode()
        self.workers: list[subprocess.Popen[bytes]] = []
        for _ in range(workers):
            self.start_worker()

    def start_worker(self) -> None:
        """Start one more."""
        options = ("--nthreads", "1", "--no-nanny", "--no-dashboard")
        self.workers.append(self._start("worker", self.address, *options))

    def _start(self, *words: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "dask", *words]
        process = subprocess.Popen(command, env=ENVIRONMENT, stderr=subprocess.PIPE, start_new_session=True)
        self._stack.enter_context(process)
        self._stack.callback(process.kill)
        return process


@pytest.fixture
def deserted() -> Iterator[LoopbackCluster]:
    with ExitStack() as stack:
        yield LoopbackCluster(stack, workers=0)


@pytest.fixture
def cluster() -> Iterator[LoopbackCluster]:
    with ExitStack() as stack:
        yield LoopbackCluster(stack)


def until(last: int, cluster_event: Callable[[], None]) -> tuple[list[int], Callable[[int, Verdict], bool]]:
    """Return the list of reports, and a callback that triggers an event during a campaign and ends it at a schedule."""
    told: list[int] = []

    def on_verdict(number: int, verdict: Verdict) -> bool:
        told.append(number)
        if number == last // 4:
            cluster_event()
        return number == last

    return told, on_verdict


@pytest.mark.slow
def test_cluster_gives_the_same_verdicts_as_the_local_computer(cluster: LoopbackCluster) -> None:
    trial = FakeTrial(fails=(3, 40), raises=(5,), exits=(7,))
    told: list[NumberedVerdict] = []
    tally = Campaign(trial, Seeds(), 60, Cluster(cluster.address)).run(lambda *result: told.append(result))
    assert tally == Tally(done=60, failed=3, troubled=1)
    assert [number for number, _ in told] == list(range(60))
    assert [number for number, verdict in told if verdict.failed] == [3, 7, 40]
    assert told[7][1].failures[0].kind == PROCESS_DIED


@pytest.mark.slow
def test_a_worker_killed_in_the_middle(cluster: LoopbackCluster, tmp_path: Path) -> None:
    """Both workers have batches at any time before the end, so one of them loses some."""
    told, on_verdict = until(1000, cluster.workers[0].kill)
    with_file = ResultsFile(tmp_path / "results", IDENTITY)
    tally = Campaign(FakeTrial(), Seeds(), 100_000, Cluster(cluster.address), with_file).run(on_verdict)
    assert told == list(range(1001))
    assert tally == Tally(done=1001)
    stored = [number for number, _ in read_results(tmp_path / "results")[1]]
    assert len(stored) == len(set(stored))
    assert set(stored) >= set(range(1001))


@pytest.mark.slow
def test_late_worker_takes_part(cluster: LoopbackCluster) -> None:
    """The only workers left in the end are those that came after the campaign had begun."""

    def replace_all() -> None:
        old = list(cluster.workers)
        cluster.start_worker()
        for worker in old:
            worker.kill()

    told, on_verdict = until(1000, replace_all)
    Campaign(FakeTrial(), Seeds(), 100_000, Cluster(cluster.address)).run(on_verdict)
    assert told == list(range(1001))


@pytest.mark.slow
def test_lost_scheduler_keeps_the_verdicts_so_far(cluster: LoopbackCluster, tmp_path: Path) -> None:
    told, on_verdict = until(100_000, lambda: None)

    def lose_it(number: int, verdict: Verdict) -> None:
        on_verdict(number, verdict)
        if number == 50:
            cluster.scheduler.kill()

    path = tmp_path / "results"
    crew = Cluster(cluster.address)
    with pytest.raises(
        UsageError,
        match=f"--cluster: the scheduler at {cluster.address} has stopped; a results file keeps the findings",
    ):
        Campaign(FakeTrial(), Seeds(), 1_000_000, crew, ResultsFile(path, IDENTITY)).run(lose_it)
    assert told == list(range(len(told)))
    again, tally = [], Campaign(FakeTrial(), Seeds(), 60, Inline(), ResultsFile(path, IDENTITY))
    assert tally.run(lambda number, _: again.append(number)).resumed >= 51
    assert again == list(range(60))


@pytest.mark.slow
def test_mission_is_shipped_to_workers_without_its_files(cluster: LoopbackCluster, tmp_path: Path) -> None:
    """The workers get the mission after it was removed here.

    Its verdicts do not contain the path where it was unpacked.
    """
    folder = tmp_path / "mission"
    shutil.copytree(shipped("missions") / "capture", folder)
    plan = RunPlan((str(folder),), seconds=0.2)
    here = [Trial(plan).run(Schedule("random", seed)) for seed in range(4)]
    shipment = ship(plan, files_read(plan))
    shutil.rmtree(folder)
    told: list[Verdict] = []
    Campaign(Trial(plan), Seeds(), 4, Cluster(cluster.address, shipment)).run(lambda _, each: told.append(each))
    assert told == here


@pytest.mark.slow
def test_a_cluster_of_this_computer() -> None:
    told: list[int] = []
    tally = Campaign(FakeTrial(fails=(2,)), Seeds(), 20, Cluster("local:2")).run(lambda number, _: told.append(number))
    assert (told, tally.failed) == (list(range(20)), 1)


def open_ports() -> list[tuple[str, int]]:
    """Return address (hexadecimal) and number of each TCP port on which this process listens."""
    sockets = set()
    for descriptor in Path("/proc/self/fd").iterdir():
        with suppress(OSError):
            sockets.add(os.readlink(descriptor))
    found = []
    for table in ("tcp", "tcp6"):
        for line in Path(f"/proc/self/net/{table}").read_text(encoding="utf-8").splitlines()[1:]:
            _, local, _, state, *_, inode = line.split()[:10]
            if state == "0A" and f"socket:[{inode}]" in sockets:
                address, _, port = local.rpartition(":")
                found.append((address, int(port, 16)))
    return found


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="Linux tells the ports")
def test_local_cluster_opens_no_well_known_port() -> None:
    first_of_any = int(Path("/proc/sys/net/ipv4/ip_local_port_range").read_text(encoding="utf-8").split()[0])
    before = set(open_ports())
    environ = dict(os.environ)
    crew = Cluster("local:1")
    try:
        assert dict(os.environ) == environ, "what workers are started with is not for this process"
        opened = set(open_ports()) - before
    finally:
        crew.close()
    assert dict(os.environ) == environ
    assert opened
    assert {address for address, _ in opened} == {"0100007F"}  # 127.0.0.1
    assert [port for _, port in opened if port < first_of_any] == []


@pytest.mark.slow
def test_a_mission_that_cannot_fly_ends_the_campaign(cluster: LoopbackCluster) -> None:
    with pytest.raises(UsageError) as caught:
        Campaign(FakeTrial(unusable=True), Seeds(), 20, Cluster(cluster.address)).run(lambda *_: None)
    assert str(caught.value) == "nowhere.scr:3: words: no such mission"


@pytest.mark.slow
def test_a_cluster_without_workers(deserted: LoopbackCluster, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cfepy.extra.exploration.worker_pools.CONNECT_S", 3)
    with pytest.raises(UsageError) as caught:
        Cluster(deserted.address)
    text = f"has no workers; start some (dask worker {deserted.address})"
    assert str(caught.value) == f"--cluster: the scheduler at {deserted.address} {text}"


@pytest.mark.slow
def test_loss_of_all_workers_is_reported_and_keeps_the_verdicts(
    cluster: LoopbackCluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("cfepy.extra.exploration.worker_pools.PATIENCE_NS", NS_PER_S)

    def lose_them(number: int, verdict: Verdict) -> None:
        if number == 20:
            for worker in cluster.workers:
                worker.kill()

    path = tmp_path / "results"
    campaign = Campaign(FakeTrial(), Seeds(), 1_000_000, Cluster(cluster.address), ResultsFile(path, IDENTITY))
    with pytest.raises(UsageError, match="has lost all its workers; a results file keeps the findings"):
        campaign.run(lose_them)
    assert {number for number, _ in read_results(path)[1]} >= set(range(21))


def test_without_dask(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(UsageError) as caught:
        Cluster("tcp://127.0.0.1:1")
    text = "--cluster: requires dask.distributed, which is not installed: pip install 'cfepy[cluster]'"
    assert str(caught.value) == text


@pytest.mark.parametrize("address", ["local:", "local:0", "local:many"])
def test_invalid_number_of_processes_is_refused(address: str) -> None:
    with pytest.raises(
        UsageError, match=f"^--cluster: invalid number of processes in {address}; write for instance local:4"
    ):
        Cluster(address)


@pytest.mark.parametrize("address", ["nonsense://x", "tcp://127.0.0.1:notaport"])
def test_invalid_scheduler_address_is_refused(address: str) -> None:
    before = set(threading.enumerate())
    with pytest.raises(UsageError, match=f"--cluster: no dask scheduler answers at {address}"):
        Cluster(address)
    assert set(threading.enumerate()) <= before  # an event loop of dask would wait for its end


def test_versions_must_agree() -> None:
    here = {"cfepy": "1.0", "cfe": "7", "python": "3.11"}
    check_versions("tcp://a:1", dict(here), here)
    with pytest.raises(UsageError) as caught:
        check_versions("tcp://a:1", {**here, "python": "3.12"}, here)
    assert str(caught.value) == (
        "--cluster: worker tcp://a:1 has cfepy 1.0, cfe 7, python 3.12, but the "
        "client has cfepy 1.0, cfe 7, python 3.11; "
        "install the same on all computers"
    )
