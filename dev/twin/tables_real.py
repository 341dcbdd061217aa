"""Flies tables on NASA's cFE and records them: `python -m dev.twin.tables_real BUILT FILE --seed N --count N`.

BUILT is the folder in which NASA's cFE was built, with sources, `build/inc` and `build/exe/cpu1`. tables_app.c is
compiled with the flags of its SAMPLE_APP.
"""

from __future__ import annotations

import argparse
import json
import lzma
import re
import shlex
import socket
import subprocess
import tempfile
from pathlib import Path

from cfepy.es import packets as es
from cfepy.evs import packets as evs
from cfepy.tbl import packets as pk
from dev.twin import tables_flight as flight
from dev.twin.real import RealCfe, in_network_of
from dev.twin.tables_flight import Answer
from dev.twin.tables_steps import CALL, CLOSE, COMMAND, READ, REGISTRY, REMOVE, RESET, RESTART, WRITE, Step, Steps

SOURCE = Path(__file__).with_name("tables_app.c")
FLAGS = "build/native/default_cpu1/apps/sample_app/CMakeFiles/sample_app.dir/flags.make"
LISTENER_PORT, CALLER_PORTS = 5100, {"A": 5101, "B": 5102}
ANSWER_LIMIT_S = 8.0
TICKS_PER_S = 100


def compiled_app(built: Path, source: Path = SOURCE, *more: str) -> bytes:
    """Return the shared object of tables_app.c, or of another source, for a cFE; `more` are further compiler flags."""
    said = dict(re.findall(r"^(C_\w+) = (.*)$", (built / FLAGS).read_text(encoding="utf-8"), re.MULTILINE))
    modules = [f"-I{folder}/{part}" for folder in (built / "cfe/modules").iterdir() for part in ("fsw/inc", "fsw/src")]
    flags = [*shlex.split(said["C_DEFINES"]), *shlex.split(said["C_INCLUDES"]), *modules]
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "app.so"
        subprocess.run(["cc", "-std=gnu99", "-w", "-fPIC", "-shared", *flags, *more, "-o", target, source], check=True)
        return target.read_bytes()


class RealTables:
    """NASA's cFE with the applications of tables_app.c, in flight.

    Args:
        cfe: it runs already.
    """

    def __init__(self, cfe: RealCfe) -> None:
        self._cfe = cfe
        self._listen()

    def _listen(self) -> None:
        """Begin after a boot, with a new socket that cannot receive earlier answers."""
        with in_network_of(self._cfe.inside):
            self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.settimeout(ANSWER_LIMIT_S)
        for name in flight.LISTENED_TO:
            self._send(evs.ENABLE_APP_EVENT_TYPE.packet(AppName=name, BitMask=1))

    def _ask(self, port: int, request: bytes) -> bytes:
        self._socket.sendto(request, ("127.0.0.1", port))
        return self._socket.recv(65536)

    def _send(self, packet: bytes | bytearray) -> list[bytes]:
        return _split(self._ask(LISTENER_PORT, b"C" + packet))

    def _wait(self, seconds: int) -> list[bytes]:
        """Wait some seconds of NASA's clock. Returns the packets of that time."""
        second = b"D" + bytes([TICKS_PER_S])
        return [packet for _ in range(seconds) for packet in _split(self._ask(LISTENER_PORT, second))]

    def _request(self, who: str, letter: str, *given: int | str, data: bytes = b"") -> tuple[int, bytes]:
        slot, options, number, other, text = given
        request = flight.REQUEST.pack(letter.encode(), slot, options, number, other, str(text).encode())
        reply = self._ask(CALLER_PORTS[who], request + data)
        return int.from_bytes(reply[:4], "little"), reply[4:]

    def _file(self, letter: str, path: str, data: bytes = b"") -> bytes:
        return self._request("B", letter, 0, 0, 0, 0, path, data=data)[1]

    def answer(self, step: Step) -> Answer:
        """Return the answer to a step."""
        kind, *given = step
        if kind == COMMAND:
            return flight.packets_of(self._send(bytes.fromhex(given[0])))
        if kind == CALL:
            result = flight.result_of(given[1], *self._request(*given))
            return [*result, *flight.packets_of(_split(self._ask(LISTENER_PORT, b"-")))]
        if kind == REGISTRY:
            told = [*self._send(pk.DUMP_REGISTRY.packet()), *self._wait(3)]
            return [*flight.packets_of(told), *flight.registry_of(self._ram(flight.REGISTRY_FILE))]
        if kind == RESTART:
            return flight.packets_of([*self._send(es.RESTART_APP.packet(Application="TTA")), *self._wait(9)])
        if kind == RESET:
            self._reset()
        elif kind == CLOSE:
            self._file("K", "")
        elif kind == READ:
            return [flight.dump_of(self._ram(given[0]))]
        elif kind == REMOVE:
            self._file("X", given[0])
        elif kind == WRITE:
            self._file("W", given[0], bytes.fromhex(given[1]))
        return []

    def _ram(self, path: str) -> bytes:
        return self._cfe.files().get(path, b"")

    def _reset(self) -> None:
        boots = self._cfe.boots()
        self._socket.sendto(b"C" + es.RESTART.packet(RestartType=1), ("127.0.0.1", LISTENER_PORT))
        self._cfe.wait(lambda: self._cfe.boots() > boots, "reset", 30)
        self._socket.close()
        self._listen()


def _split(data: bytes) -> list[bytes]:
    packets = []
    while data:
        size = int.from_bytes(data[:2], "big")
        if size == 0xFFFF:
            raise TimeoutError("Table Services did not come to the end of a step")
        packets.append(data[2 : 2 + size])
        data = data[2 + size :]
    return packets


def fly(built: Path, steps: list[Step]) -> list[Answer]:
    """Return the answers of NASA's cFE to the steps of a flight."""
    with tempfile.TemporaryDirectory() as folder:
        startup = re.sub("tt[ab],", "tt,", flight.STARTUP)
        files = {"/cf/tt.so": compiled_app(built), "/cf/cfe_es_startup.scr": startup.encode()}
        with RealCfe(built / "build/exe/cpu1", Path(folder) / "cfe", files) as cfe:
            tables = RealTables(cfe)
            return [tables.answer(step) for step in steps]


def main() -> None:
    """Write the file."""
    parser = argparse.ArgumentParser(prog="python -m dev.twin.tables_real", description=__doc__)
    parser.add_argument("built", type=Path)
    parser.add_argument("file", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=400)
    given = parser.parse_args()
    steps = Steps(given.seed).make(given.count)
    record = {"steps": steps, "answers": fly(given.built, steps)}
    given.file.write_bytes(lzma.compress(json.dumps(record, separators=(",", ":")).encode(), preset=9))


if __name__ == "__main__":
    main()
