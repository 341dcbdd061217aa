"""The whole library on computers of other kinds, big-endian and of 32 bits: nodes have the same output as with roscpp.

The probes of `dev.roscfe.probing` run with a stand-in for cFE, here and emulated.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from dev.roscfe.building import needs_cpp, target_named
from dev.roscfe.probing import PROBES
from tests.roscfe.alone import Alone

pytestmark = [pytest.mark.slow, needs_cpp]
NODES = ("actions", "clouds", "logs", "names", "params", "timers", "topics", "values")
"""Probes whose topics have MsgIds there (`tests.roscfe.alone.TOPICS`)."""
HEARING = """
#include <ros/ros.h>
#include <std_msgs/String.h>
static void hear(const std_msgs::String &) {}
int main(int argc, char **argv)
{
  ros::init(argc, argv, "probe");
  ros::NodeHandle node;
  ros::Subscriber heard = node.subscribe("a", 1, hear);
  return 0;
}
"""
NUMERIC = ("clouds",)
"""Those that call libm, whose sines differ in the last bit between computers."""


@pytest.mark.parametrize("target", ["here", "powerpc", "arm"])
def test_probes_print_the_recorded_output(tmp_path: Path, target: str) -> None:
    nodes = [PROBES / f"{name}.cpp" for name in NODES if target == "here" or name not in NUMERIC]
    alone = Alone(tmp_path, nodes, target_named(target))
    for node in nodes:
        assert alone.fly(node) == node.with_suffix(".txt").read_text(encoding="utf-8").splitlines(), node.stem


@pytest.mark.parametrize(
    ("function", "text"),
    [
        ("CFE_EVS_Register", "NODE: CFE_EVS_Register failed\n"),
        ("CFE_SB_CreatePipe", "NODE: CFE_SB_CreatePipe failed: NODE_PIPE\n"),
        ("CFE_SB_SubscribeEx", "NODE: the Software Bus has no room for the subscription: /probes/a\n"),
    ],
)
def test_start_fails_if_a_service_of_cfe_refuses(failing: tuple[Alone, Path], function: str, text: str) -> None:
    alone, program = failing
    done = alone.run(program, fails=function)
    assert done.returncode == 3
    assert done.stderr.endswith(text)


@pytest.fixture(scope="module")
def failing(tmp_path_factory: pytest.TempPathFactory) -> tuple[Alone, Path]:
    """A node with a subscription, and its stand-in of cFE."""
    folder = tmp_path_factory.mktemp("failing")
    source = folder / "hearing.cpp"
    source.write_text(HEARING, encoding="utf-8")
    alone = Alone(folder, [source])
    return alone, alone.program(source)
