"""The commands of docs/how_to/ground_tools.md, unchanged, in a network in which all ports are free.

`python -m tests.ground.page_flight PART`, in a network of its own (`tests.own_network`).
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from tests.ground.page import blocks

COUNTED = "SAMPLE_APP 8: SAMPLE_APP: ValU32=10, ValI16=-3, ValStr=hello"
NOOP = "SAMPLE_APP 3: SAMPLE: NOOP command"
ENABLED = "telemetry output enabled for IP 127.0.0.1"
CTRL_C = 130


class Craft:
    """A spacecraft that flies in a process of its own."""

    def __init__(self, output: IO[str]) -> None:
        self._output = output

    def says(self, text: str) -> str:
        """Wait until it has printed a text. Returns the line."""
        for line in self._output:
            if text in line:
                return line
        raise AssertionError(f"the spacecraft never said {text!r}")


@contextmanager
def flying(command: Sequence[str], ready: str = "entering OPERATIONAL state") -> Iterator[Craft]:
    """Run a command until Ctrl-C. Yields when it reports that it is ready."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        assert process.stdout is not None
        craft = Craft(process.stdout)
        try:
            craft.says(ready)
            yield craft
        finally:
            process.send_signal(signal.SIGINT)
            process.stdout.read()
    assert process.returncode == CTRL_C


def output_of(command: Sequence[str], typed: str = "", status: int = 0) -> str:
    """Run a command to its end. Returns its output."""
    ended = subprocess.run(
        command, input=typed, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
    )
    assert ended.returncode == status, f"{command}: {ended.returncode}\n{ended.stdout}"
    return ended.stdout


def own_tools() -> None:
    """The spacecraft, and cfepy's own tools."""
    [fly] = blocks("The spacecraft")[0].commands
    tlm, noop, display, console = blocks("cfepy's own tools")[-1].commands
    with flying(fly) as craft:
        assert len(output_of(tlm).splitlines()) == 5
        craft.says(ENABLED)
        output_of(noop)
        craft.says(NOOP)
        output_of(display)
        craft.says(COUNTED)
        output_of(console, "SAMPLE_APP_NOOP\nexpect event SAMPLE_APP 3\n")


def recorded() -> None:
    """Fly with commands through the port, and replay the run without any network."""
    _, record = blocks("The spacecraft")
    fly, replay = record.commands
    noop = blocks("cfepy's own tools")[-1].commands[1]
    with flying(fly) as craft:
        output_of(noop)
        craft.says(NOOP)
    again = output_of(["unshare", "--net", *replay])  # its loopback interface is down
    assert NOOP in again
    assert "the same run as flight.cfepy" in again


def ground_system(folder: str) -> None:
    """NASA's cmdUtil, and that its packets are cfepy's."""
    [[fly], tools, _] = [block.commands for block in blocks("NASA's cFS-GroundSystem")]
    with flying(fly) as craft:
        os.chdir(folder)
        for command, said in zip(tools, (ENABLED, NOOP, COUNTED), strict=True):
            sent = output_of(command).partition("Data to send:")[2]
            craft.says(said)
            print("packet", "".join(sent.replace("0x", "").split()).lower())


def parser() -> None:
    """space_packet_parser, with the program of the page."""
    install, program, enable = blocks("space_packet_parser")
    output_of(install.commands[1])
    Path("program.py").write_text(program.text, encoding="utf-8")
    [fly] = blocks("The spacecraft")[0].commands
    listen = [sys.executable, "-u", "program.py"]
    with flying(fly) as craft, subprocess.Popen(listen, stdout=subprocess.PIPE, text=True) as reader:
        try:
            assert reader.stdout is not None
            output_of(enable.commands[0])
            craft.says(ENABLED)
            assert reader.stdout.readline().split()[1] == "0"
            output_of([*enable.commands[0][:-2], "SAMPLE_APP_NOOP"])
            assert any(line.split()[1] == "1" for line in reader.stdout)
        finally:
            reader.kill()


def several() -> None:
    """Fly three spacecraft, two of them with ports, and a fourth that finds its port taken."""
    crafts, tools, taken, in_python = blocks("Several spacecraft")
    first, second, third = crafts.commands
    with flying(first) as one, flying(second) as two, flying(third, "phase approach") as three:
        [tlm_one, tlm_two, noop, console] = tools.commands
        assert len(output_of(tlm_one).splitlines()) == 5
        assert len(output_of(tlm_two).splitlines()) == 5
        one.says(" 66/1/TO_LAB 3: ")
        two.says(" 67/1/TO_LAB 3: ")
        output_of(noop)
        two.says(f" 67/1/{NOOP}")
        output_of(console, "SAMPLE_APP_NOOP\nexpect event SAMPLE_APP 3\n")
        two.says(f" 67/1/{NOOP}")
        assert three
        [again] = taken.commands
        assert output_of(again, status=2).splitlines()[-1] == taken.text.splitlines()[-1]
    Path("program.py").write_text(in_python.text, encoding="utf-8")
    output_of([sys.executable, "program.py"])


PARTS = {"own_tools": own_tools, "recorded": recorded, "parser": parser, "several": several}

if __name__ == "__main__":
    if sys.argv[1] == "ground_system":
        ground_system(sys.argv[2])
    else:
        PARTS[sys.argv[1]]()
