"""The modules of cfepy that a run loads: without nodes, faults and journal it loads only those it needs."""

from __future__ import annotations

import json
import subprocess
import sys

MOST_OF_A_COMMAND = 227  # modules of `cfepy run lab`; may only fall, but an add-on with an option adds two
MOST_OF_A_PROGRAM = 224  # modules of `cfepy.run("lab")`; may only fall
TOPS = ("cfepy", "rospy_shim", "ros_libraries")
RECORDS = {"rospy_shim", "rospy_shim.types", "rospy_shim.types.config"}
"""What a mission file may say of nodes, which each mission has room for."""

FOR_OTHERS = (
    *("rospy_shim", "ros_libraries", "cfepy.faults", "cfepy.script", "cfepy.journal", "cfepy.io", "cfepy.testing"),
    *("cfepy.nodes.universe", "cfepy.nodes.stdlib", "cfepy.nodes.node_tracebacks", "cfepy.mission.tracebacks"),
    *("cfepy.mission.launch", "cfepy.mission.mission_file", "cfepy.mission.call_points", "cfepy.monitors.deadlines"),
    *("cfepy.schedules.exploring", "cfepy.schedules.moves", "cfepy.schedules.side_by_side", "cfepy.rtos.policies"),
    *("cfepy.extra.c", "cfepy.extra.convert", "cfepy.extra.debugger", "cfepy.extra.exploration"),
    *(
        "cfepy.extra.reports",
        "cfepy.extra.ros_host.host",
        "cfepy.extra.viewers.listen",
        "cfepy.pilot.mission_check",
        "cfepy.ground.bag",
    ),
)
"""Modules and packages of missions with nodes, of other schedules and of add-ons."""

COMMAND = 'from cfepy.cli.main import main; main(["run", "lab", "--for", "2", "--quiet"])'
PROGRAM = 'import cfepy; cfepy.run("lab", seconds=2)'


def loaded_by(code: str) -> set[str]:
    """Return the modules of cfepy that a fresh interpreter has after some code."""
    told = f"import json, sys\n{code}\nprint()\nprint(json.dumps(list(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", told], capture_output=True, text=True, check=True)
    return {name for name in json.loads(done.stdout.splitlines()[-1]) if name.partition(".")[0] in TOPS}


def for_others(loaded: set[str]) -> list[str]:
    """Return the modules that only other missions need."""
    packages = tuple(f"{name}." for name in FOR_OTHERS)
    return sorted(name for name in loaded - RECORDS if name in FOR_OTHERS or name.startswith(packages))


def test_a_mission_without_nodes_loads_few_modules() -> None:
    loaded = loaded_by(COMMAND)
    assert for_others(loaded) == []
    assert len(loaded) <= MOST_OF_A_COMMAND, "load it where it is used, or lower the number when there are fewer"


def test_a_program_that_flies_such_a_mission_loads_few_modules() -> None:
    loaded = loaded_by(PROGRAM)
    assert for_others(loaded) == []
    assert not [name for name in loaded if name.startswith("cfepy.cli")]
    assert len(loaded) <= MOST_OF_A_PROGRAM, "load it where it is used, or lower the number when there are fewer"
