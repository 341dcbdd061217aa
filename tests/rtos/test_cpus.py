"""The CPU that a process's runs share: processes spread, the user may choose, and it is released."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import textwrap

import pytest

from cfepy.rtos import Kernel, cpus
from cfepy.rtos.cpus import Seat, current_cpu, process_seat
from cfepy.status import UsageError

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux has abstract sockets")
MANY = [1000, 1001, 1002, 1003]


@pytest.fixture(autouse=True)
def four_cpus_of_our_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(cpus.VARIABLE, raising=False)
    monkeypatch.setattr(cpus, "NAME", f"test {os.urandom(8).hex()}")  # other processes on this computer do not count
    monkeypatch.setattr(cpus, "allowed_cpus", lambda: list(MANY))
    monkeypatch.setattr(cpus, "_shared", None)  # a task that an earlier test left behind keeps the seat of its kernel


def test_processes_use_different_cpus() -> None:
    first, second, third, fourth = MANY
    seats = [Seat() for _ in range(8)]
    chosen = [seat.choose(first) for seat in seats]
    assert chosen == [first, second, third, fourth] * 2
    seats[2].leave()
    assert Seat().choose(first) == third


def test_current_cpu_of_the_host_is_chosen() -> None:
    seat = Seat()
    assert seat.choose(MANY[2]) == MANY[2] == seat.choose(MANY[2]) == seat.cpu


def test_seat_follows_the_host_to_a_free_cpu() -> None:
    first, second, third = MANY[:3]
    one, other = Seat(), Seat()
    assert (one.choose(first), other.choose(second)) == (first, second)
    assert one.choose(second) == first, "the other one sits there"
    assert one.choose(third) == third
    assert other.choose(first) == first, "it was given back"


def test_seat_on_a_shared_cpu_moves_to_a_free_one() -> None:
    seats = [Seat() for _ in range(5)]
    for seat in seats:
        seat.choose(MANY[0])
    assert seats[4].choose(MANY[0]) == MANY[0]
    seats[3].leave()
    assert seats[4].choose(MANY[0]) == MANY[3]


def test_cpu_is_released_with_the_last_reference() -> None:
    seat = Seat()
    seat.choose(MANY[0])
    del seat
    assert Seat().choose(MANY[0]) == MANY[0]


def test_unknown_cpu_gives_no_seat() -> None:
    assert Seat().choose(-1) == -1


@pytest.mark.parametrize("wanted", ["", "on", "-1", "99", "1.0"])
def test_invalid_setting_is_refused(wanted: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(cpus.VARIABLE, wanted)
    with pytest.raises(UsageError, match=r"invalid CFEPY_PIN=.*expected auto, off or a CPU"):
        Seat().choose(MANY[0])


def test_user_chooses_the_cpu_by_a_variable(monkeypatch: pytest.MonkeyPatch) -> None:
    other = Seat()
    other.choose(MANY[1])
    monkeypatch.setenv(cpus.VARIABLE, str(MANY[1]))
    assert Seat().choose(MANY[0]) == MANY[1]
    monkeypatch.setenv(cpus.VARIABLE, "off")
    assert Seat().choose(MANY[0]) == -1


def test_forked_process_chooses_its_own_cpu() -> None:
    seat = process_seat()
    seat.choose(MANY[0])
    child = os.fork()
    if not child:
        os._exit(0 if seat.cpu == -1 and process_seat().choose(MANY[0]) == MANY[1] else 1)
    assert os.waitpid(child, 0)[1] == 0
    assert seat.choose(MANY[0]) == MANY[0]


def test_forked_process_does_not_keep_the_cpu_of_its_parent() -> None:
    seat = Seat()
    shared = process_seat()
    shared.choose(MANY[0])
    (is_over, end), (is_up, up) = os.pipe(), os.pipe()
    child = os.fork()
    if not child:
        os.close(end)
        os.write(up, b"!")
        os.read(is_over, 1)
        os._exit(0)
    os.read(is_up, 1)
    shared.leave()
    chosen = seat.choose(MANY[0])
    for each in (is_over, end, is_up, up):
        os.close(each)
    os.waitpid(child, 0)
    assert chosen == MANY[0]


def test_kernel_holds_a_cpu_while_it_has_tasks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cpus, "allowed_cpus", lambda: sorted(os.sched_getaffinity(0)))
    here: list[int] = []
    kernel = Kernel()
    kernel.spawn("A", lambda: here.append(current_cpu()))
    kernel.run(1)
    seat = process_seat()
    assert here == [seat.cpu]
    del seat
    kernel.shutdown()
    gc.collect()
    assert process_seat().cpu == -1


def test_processes_run_on_different_cpus() -> None:
    """Two processes at the same time each report the CPU of their tasks."""
    if len(os.sched_getaffinity(0)) < 2:
        pytest.skip("this computer has one CPU")
    code = textwrap.dedent("""
        import sys
        from cfepy.rtos import Kernel, cpus
        from cfepy.rtos.cpus import current_cpu
        cpus.NAME = sys.argv[1]
        here = []
        kernel = Kernel()
        kernel.spawn("A", lambda: here.append(current_cpu()))
        kernel.run(1)
        print(here[0], flush=True)
        sys.stdin.read()
        """)
    environ = {name: value for name, value in os.environ.items() if name != cpus.VARIABLE}
    command = [sys.executable, "-c", code, cpus.NAME]
    processes = []
    try:
        for _ in range(2):
            process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environ)
            processes.append(process)
        told = [process.stdout.readline() for process in processes if process.stdout is not None]
    finally:
        for process in processes:
            process.communicate()
    assert len(set(told)) == len(told)
