"""The memory budget: the allocations, their owners, and the behaviour of a full board."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cfepy.config.platform import PlatformConfig
from cfepy.osal import Osal
from cfepy.psp import BoardProfile, MemoryBudget, OverBudget, load_profile, object_sizes
from cfepy.psp.profile import MemoryCosts, MemoryRegion
from cfepy.rtos import CpuCosts, Kernel
from cfepy.status import CfeError
from cfepy.writing.console import Console

SMALL = BoardProfile("small", sram=(MemoryRegion("main", 900), MemoryRegion("standby", 100)))


def test_claims_are_summed_by_owner_and_kind() -> None:
    budget = MemoryBudget(SMALL)
    budget.claim("HK", "stack", 400)
    budget.claim("HK", "queue", 100)
    budget.claim("HK", "queue", 50)
    budget.claim("TO", "stack", 300)
    assert budget.totals() == {("HK", "stack"): 400, ("TO", "stack"): 300, ("HK", "queue"): 150}
    assert budget.by_owner() == {"HK": 550, "TO": 300}
    assert (budget.used, budget.free) == (850, 150)


def test_too_large_claim_is_refused_with_a_table() -> None:
    budget = MemoryBudget(SMALL)
    budget.claim("HK", "stack", 600)
    budget.claim("TO", "pool", 300)
    with pytest.raises(OverBudget) as caught:
        budget.claim("SCH", "stack", 128)
    assert caught.value.missing == 28
    assert str(caught.value).splitlines() == [
        "CFE_STATUS_EXTERNAL_RESOURCE_FAIL (0xC8000005): the board is full: SCH asks for 128 bytes (stack), "
        "28 are missing; choose smaller stacks, pools or queues, or fewer apps",
        "  HK            stack    600",
        "  TO            pool     300",
        "  used                   900",
        "  RAM of small         1,000",
    ]
    assert budget.used == 900


def test_released_memory_can_be_claimed_again() -> None:
    budget = MemoryBudget(SMALL)
    token = budget.claim("HK", "stack", 1000)
    budget.release(token)
    budget.release(token)
    assert budget.claim("TO", "stack", 1000) != token
    assert budget.peak == 1000


def test_board_without_limits_counts_claims() -> None:
    budget = MemoryBudget(load_profile("linux"))
    budget.claim("HK", "stack", 1 << 40)
    assert budget.free is None
    assert budget.used == 1 << 40
    assert "unlimited" in budget.report()


def test_a_negative_claim_is_refused() -> None:
    with pytest.raises(CfeError):
        MemoryBudget(SMALL).claim("HK", "stack", -1)


@given(st.lists(st.tuples(st.booleans(), st.sampled_from("AB"), st.integers(0, 400))))
def test_sum_equals_the_open_claims(steps: list[tuple[bool, str, int]]) -> None:
    budget = MemoryBudget(SMALL)
    tokens: list[tuple[int, int]] = []
    for give_back, owner, size in steps:
        if give_back and tokens:
            budget.release(tokens.pop(0)[0])
        elif budget.used + size > 1000:
            with pytest.raises(OverBudget):
                budget.claim(owner, "stack", size)
        else:
            tokens.append((budget.claim(owner, "stack", size), size))
        assert budget.used == sum(size for _, size in tokens) == sum(budget.totals().values()) <= 1000
        assert budget.peak >= budget.used


def test_osal_claims_memory_of_its_objects_and_releases_it() -> None:
    costs = MemoryCosts(task_control_block=10, queue_control_block=20, queue_slot=2, semaphore=5, mutex=6, timer=7)
    board = BoardProfile("board", memory_costs=costs)
    budget = MemoryBudget(board)
    with Kernel("thread") as kernel:
        osal = Osal(kernel, PlatformConfig(), Console(quiet=True), memory=budget, sizes=object_sizes(board))
        app = type("App", (), {"name": "HK"})()
        osal.task_create("HK", lambda: osal.task_delay(10), 100, 50, owner=app)
        queue_id = osal.queue_create("Q", 4, 8)
        osal.bin_sem_create("S", 0)
        osal.mut_sem_create("M")
        assert budget.totals() == {
            ("HK", "stack"): 110,
            ("system", "queue"): 20 + 4 * (2 + 8),
            ("system", "mutex"): 6,
            ("system", "semaphore"): 5,
        }
        osal.queue_delete(queue_id)
        kernel.run()
        assert budget.totals() == {("system", "mutex"): 6, ("system", "semaphore"): 5}


def test_full_board_creates_no_objects() -> None:
    with Kernel("thread") as kernel:
        osal = Osal(kernel, memory=MemoryBudget(SMALL))
        with pytest.raises(OverBudget):
            osal.task_create("BIG", lambda: None, 4096, 50)
        assert not kernel.tasks
        osal.task_create("BIG", lambda: None, 1000, 50)


def test_costs_of_a_board() -> None:
    costs = load_profile("rx64m").cpu_costs()
    assert costs == CpuCosts(call_ns=1500, byte_ps=8334, switch_ns=2500, polling_ns=1000)
    assert load_profile("linux").cpu_costs() == CpuCosts(polling_ns=1000)  # a loop that polls ends on any board


def test_cost_of_a_call_grows_with_its_bytes() -> None:
    costs = CpuCosts(call_ns=1500, byte_ps=8334)
    assert (costs.of(0), costs.of(1), costs.of(100)) == (1500, 1508, 2333)
    assert (costs.of_copying(0), costs.of_copying(100)) == (0, 833)
    assert CpuCosts().of(1000) == 0
