"""Compares a real Yamcs that uses our XTCE with cfepy, in a network of its own (`tests.own_network`).

`python -m tests.ground.yamcs_flight loop` executes the commands of docs/how_to/ground_tools.md. `compare TIMES` lets
Yamcs send every command of every shipped mission and read all of their telemetry, with random values.
"""

from __future__ import annotations

import math
import os
import socket
import sys
from pathlib import Path
from random import Random

from cfepy.ground.dictionary import Dictionary
from cfepy.ground.topics import Topic
from cfepy.ground.xtce import xtce_name, xtce_of
from cfepy.msg import Cell, Command, Telemetry, generate_checksum
from tests.ground import yamcs
from tests.ground.page import blocks
from tests.ground.page_flight import COUNTED, ENABLED, flying, output_of
from tests.ground.random_packets import SEQUENCES, random_payload, random_telemetry, telemetry_values, xtce_values
from tests.ground.test_xtce import Export
from tests.ground.test_xtce_missions import ALL_TYPES, MISSIONS, declared_telemetry, dictionary_named

LOOPBACK = "127.0.0.1"


def loop() -> None:
    """The page's own way, with Yamcs's own tool for the command line."""
    home = Path("yamcs").resolve()
    yamcs.install(home)
    [[export], _, [login, enable, display, counter, packets]] = [
        block.commands for block in blocks("Yamcs") if block.language == ""
    ]
    [fly] = blocks("The spacecraft")[0].commands
    os.chdir(home)
    os.environ["HOME"] = str(home)  # where the tool keeps its login
    output_of(export)
    with yamcs.running(home), flying(fly) as craft:
        output_of(login)
        output_of(enable)
        craft.says(ENABLED)
        output_of(display)
        craft.says(COUNTED)
        while yamcs.parameters("lab", ["/lab/SAMPLE_APP_HK_TLM_CommandCounter"]) != {
            "/lab/SAMPLE_APP_HK_TLM_CommandCounter": 1
        }:
            pass
        assert output_of(counter).split() == ["1"]
        assert "/lab/SAMPLE_APP_HK_TLM" in output_of(packets)


class Comparison:
    """One mission: the packets and values of Yamcs, and those of cfepy.

    Args:
        name: name of the mission.
        number: number of its instance.
        home: home folder of Yamcs.
    """

    def __init__(self, name: str, number: int, home: Path) -> None:
        self.dictionary: Dictionary = dictionary_named(name)
        self.name = name.replace(" ", "_")
        self._random = Random(name)
        tm_port, tc_port = yamcs.ports_of(number)
        self._tm = (LOOPBACK, tm_port)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((LOOPBACK, tc_port))
        (home / f"mdb/{self.name}.xml").write_text(xtce_of(self.name, self.dictionary), encoding="utf-8")

    def commands(self, times: int) -> int:
        """Let Yamcs send each command. Returns how many packets were compared."""
        compared = 0
        for declared in self.dictionary.commands.values():
            for _ in range(times if declared.payload.fields else 1):
                self._command(declared)
                compared += 1
        return compared

    def _command(self, declared: Command) -> None:
        layout = declared.payload
        payload = bytearray(random_payload(layout, self._random))
        cells = list(layout.cells())
        for cell in cells:
            _avoid_the_smallest(cell, payload)
        values = xtce_values("", layout, payload)
        arguments = {xtce_name(cell.path): _argument(cell, values[xtce_name(cell.path)]) for cell in cells}
        path = f"/processors/{self.name}/realtime/commands/{self.name}/{xtce_name(declared.name)}"
        yamcs.call(path, {"args": arguments})
        theirs = self._socket.recv(65_535)
        ours = bytearray(declared.packet(layout.unpack(payload)))
        ours[2:4] = theirs[2:4]  # Yamcs counts its packets
        generate_checksum(ours)
        assert theirs == bytes(ours), f"{declared.name} {arguments}\n{theirs.hex()}\n{ours.hex()}"

    def telemetry(self, times: int) -> int:
        """Send each packet to Yamcs. Returns how many values were compared."""
        compared = sequence = 0
        for declared in declared_telemetry(self.dictionary):
            for _ in range(times):
                sequence += 1
                compared += self._packet(declared, sequence % SEQUENCES)
        return compared

    def _packet(self, declared: Telemetry, sequence: int) -> int:
        packet = random_telemetry(declared, sequence, self._random)
        ours = telemetry_values(declared, packet)
        wanted = {f"/{self.name}/{name}": value for name, value in {"SRC_SEQ_CTR": sequence, **ours}.items()}
        self._socket.sendto(packet, self._tm)
        theirs: dict[str, object] = {}
        while theirs.get(f"/{self.name}/SRC_SEQ_CTR") != sequence:
            theirs = yamcs.parameters(self.name, wanted)
        assert theirs == wanted, [(name, wanted[name], theirs.get(name)) for name in wanted]
        return len(ours)


def _avoid_the_smallest(cell: Cell, payload: bytearray) -> None:
    """Yamcs does not take the smallest number of a signed type."""
    if cell.type[0] == "i" and cell.names is None:
        part = slice(cell.offset, cell.offset + cell.size)
        if payload[part] == (1 << (8 * cell.size - 1)).to_bytes(cell.size, "little"):
            payload[part] = bytes(cell.size)


def _argument(cell: Cell, value: object) -> object:
    """Return a value as Yamcs takes it in JSON."""
    if isinstance(value, float) and not math.isfinite(value):
        return "Infinity" if value > 0 else "-Infinity"
    return str(value) if cell.type in ("u64", "i64") else value


class Topics:
    """ROS messages of a flight: the values of Yamcs, and those of space_packet_parser.

    Args:
        number: number of its instance.
        home: home folder of Yamcs.
    """

    name = "topics"

    def __init__(self, number: int, home: Path) -> None:
        folder = Path(self.name)
        folder.mkdir()
        self._export = Export(folder)
        self._tm = (LOOPBACK, yamcs.ports_of(number)[0])
        (home / f"mdb/{self.name}.xml").write_text(self._export.text, encoding="utf-8")

    def compare(self) -> int:
        """Send one message of each topic to Yamcs. Returns how many values were compared."""
        compared = 0
        topics = [each for each in self._export.dictionary.telemetry.values() if isinstance(each, Topic)]
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
            for topic in (each for each in topics if each.msg_id in self._export.packets):
                link.sendto(self._export.packets[topic.msg_id], self._tm)
                read = dict(self._export.definition.parse_bytes(self._export.packets[topic.msg_id]))
                names = [name for name in read if name.startswith(f"{xtce_name(topic.name)}_")]
                wanted = {f"/{self.name}/{name}": read[name] for name in names}
                theirs: dict[str, object] = {}
                while set(theirs) != set(wanted):
                    theirs = yamcs.parameters(self.name, wanted)
                assert theirs == wanted
                compared += len(wanted)
        return compared


def compare(times: int) -> None:
    """Every command and packet of every mission, so many times each, and ROS messages."""
    home = Path("yamcs").resolve()
    yamcs.install(home)
    missions = [Comparison(name, number, home) for number, name in enumerate((*MISSIONS, ALL_TYPES))]
    topics = Topics(len(missions), home)
    yamcs.add_instances(home, [*(mission.name for mission in missions), topics.name])
    with yamcs.running(home):
        print("topics", topics.compare())
        for mission in missions:
            print(mission.name, mission.commands(times), "commands,", mission.telemetry(times), "values of telemetry")


if __name__ == "__main__":
    if sys.argv[1] == "loop":
        loop()
    else:
        compare(int(sys.argv[2]))
