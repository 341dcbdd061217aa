"""The whole library on computers of other kinds, big-endian and of 32 bits: nodes have the same output as with roscpp.

The probes of `dev.roscfe.probing` run with a stand-in for cFE, here and emulated. Nodes of `alone_nodes` fly here only,
where calls of cFE fail.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from dev.roscfe.alone import Alone
from dev.roscfe.building import needs_cpp, target_named
from dev.roscfe.probing import PROBES

pytestmark = [pytest.mark.slow, needs_cpp]
NODES = ("actions", "approximate", "clouds", "logs", "names", "params", "timers", "topics", "values")
"""Probes whose topics have MsgIds there (`dev.roscfe.alone.TOPICS`)."""
OWN = Path(__file__).parent / "alone_nodes"
NUMERIC = ("clouds",)
"""Those that call libm, whose sines differ in the last bit between computers."""
MOST_GROWTH = 1000
"""Bytes: lists of freed blocks may differ."""


@pytest.fixture(scope="module")
def here(tmp_path_factory: pytest.TempPathFactory) -> Alone:
    """The library for this computer."""
    nodes = [PROBES / f"{name}.cpp" for name in NODES]
    return Alone(tmp_path_factory.mktemp("here"), [*nodes, *OWN.glob("*.cpp")])


@pytest.fixture(scope="module")
def busy(here: Alone) -> Path:
    return here.program(OWN / "busy.cpp")


def test_probes_print_the_recorded_output(here: Alone) -> None:
    for name in NODES:
        node = PROBES / f"{name}.cpp"
        assert here.fly(node) == node.with_suffix(".txt").read_text(encoding="utf-8").splitlines(), name


def test_probes_print_the_recorded_output_with_only_the_parts_that_they_need(here: Alone) -> None:
    for name in NODES:
        node = PROBES / f"{name}.cpp"
        assert here.fly(node, is_small=True) == node.with_suffix(".txt").read_text(encoding="utf-8").splitlines(), name


@pytest.mark.parametrize("target", ["powerpc", "arm"])
def test_probes_print_the_recorded_output_elsewhere(tmp_path: Path, target: str) -> None:
    nodes = [PROBES / f"{name}.cpp" for name in NODES if name not in NUMERIC]
    alone = Alone(tmp_path, nodes, target_named(target))
    for node in nodes:
        assert alone.fly(node) == node.with_suffix(".txt").read_text(encoding="utf-8").splitlines(), node.stem


def test_subscribers_publishers_and_timers_that_end_keep_no_memory(here: Alone) -> None:
    (line,) = here.fly(OWN / "churn.cpp")
    assert int(line.split()[0]) < MOST_GROWTH


def test_node_ends_that_asks_a_publisher_without_a_topic_whether_it_is_latched(here: Alone) -> None:
    done = here.run(here.program(OWN / "latched.cpp"))
    assert (done.returncode, done.stdout) == (3, "P| 1\n")
    assert "isLatched() of a publisher that has no topic" in done.stderr


@pytest.mark.parametrize(
    ("function", "text"),
    [
        ("CFE_EVS_Register", "NODE: CFE_EVS_Register failed\n"),
        ("CFE_SB_CreatePipe", "NODE: CFE_SB_CreatePipe failed: NODE_PIPE\n"),
        ("CFE_SB_SubscribeEx:2", "NODE: the Software Bus has no room for the subscription: /probes/a\n"),
    ],
)
def test_start_fails_if_a_service_of_cfe_refuses(here: Alone, busy: Path, function: str, text: str) -> None:
    done = here.run(busy, fails=function)
    assert done.returncode == 3
    assert done.stderr.endswith(text)


@pytest.mark.parametrize(
    ("function", "text", "line"),
    [
        ("none", "", "heard 1, found 1 5, slept 0.0003 s"),
        ("CFE_TBL_Register", "no table of parameters: 0xCC000006", "heard 1, found 0 7, slept 0.0003 s"),
        ("CFE_TBL_Load", "no table of parameters: 0xCC000012", "heard 1, found 0 7, slept 0.0003 s"),
        ("CFE_TBL_GetAddress", "no row is free for the parameter /value", "heard 1, found 0 7, slept 0.0003 s"),
        ("CFE_TBL_Modified", "CFE_TBL_Modified failed", "heard 1, found 1 5, slept 0.0003 s"),
        (
            "CFE_SB_AllocateMessageBuffer",
            "no memory of the Software Bus for 20 b",
            "heard 0, found 1 5, slept 0.0003 s",
        ),
        ("CFE_SB_TransmitBuffer", "", "heard 0, found 1 5, slept 0.0003 s"),
        ("OS_CondVarCreate", "", "heard 1, found 1 5, slept 0.0020 s"),
    ],
)
def test_node_goes_on_if_a_service_of_cfe_refuses(here: Alone, busy: Path, function: str, text: str, line: str) -> None:
    done = here.run(busy, fails=function)
    assert (done.returncode, done.stdout) == (0, f"P| {line}\n")
    assert text in done.stderr
