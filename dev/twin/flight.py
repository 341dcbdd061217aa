"""Fly steps on a computer, and keep the results of each: the packets received and the files changed."""

from __future__ import annotations

import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import NamedTuple, Protocol, TypeVar

from apps import to_lab
from cfepy.es import packets as es
from cfepy.evs import packets as evs
from cfepy.ground.link import GroundLink
from cfepy.mission import Mission
from cfepy.sb import packets as sb
from cfepy.tbl import packets as tbl
from cfepy.time import packets as time_packets
from cfepy.writing.console import Console
from dev.twin import masks, mission
from dev.twin.commands import APPS, BACKGROUND, CONTROL, HOUSEKEEPING, PLAIN, RESET, Step
from dev.twin.real import BOOT_LIMIT_S, CI_PORT, TO_PORT, RealCfe

VIRTUAL_S = {PLAIN: 1.6, BACKGROUND: 4.0, CONTROL: 9.5, RESET: 1.6}
"""How long a step flies in the simulation: uplink, answer, and TO_LAB's pass every half a second."""
LIMIT_S = {PLAIN: 4.0, BACKGROUND: 8.0, CONTROL: 14.0, RESET: 4.0}
"""How long the real one may take for the same, on a busy host."""
LEAST_S = {PLAIN: 0.0, BACKGROUND: 2.2, CONTROL: 8.5, RESET: 0.0}
"""How long the real one is given at least: the events that tell the end may be switched off."""
VIRTUAL_RESET_S = 3.0
"""How long the simulation gets for a reset; the applications are up, and what they say of it came down."""
AFTER_BOOT_S = 1.0
"""The same of the real one, after it has said that it is operational."""
QUIET_S = 0.8
"""How long nothing comes down when a step without an answer is over: more than a pass of TO_LAB."""
RELEASE = "7.0.0"
STARTUP_PATH = "/cf/cfe_es_startup.scr"
ENABLE = to_lab.packets.OUTPUT_ENABLE.packet(dest_IP="127.0.0.1")


class Observed(NamedTuple):
    """Results of a step: packets in order, and the new or changed files by path."""

    packets: tuple[bytes, ...]
    files: dict[str, bytes]

    def told(self, of_packet: Callable[[bytes], bytes | None] = masks.of_packet) -> Counter[bytes]:
        """Return the compared contents of the packets."""
        return Counter(each for each in map(of_packet, self.packets) if each is not None)


class Computer(Protocol):
    """One that flies steps."""

    def fly(self, step: Step, expected: Observed | None = None) -> Observed:
        """Send a step up, and wait for its results. `expected` lists them, so that the wait can end early."""


Flyer = TypeVar("Flyer", bound=Computer)


def with_housekeeping(step: Step) -> tuple[bytes, ...]:
    """Return the packets of a step, followed by its service's housekeeping request."""
    return (*step.packets, *question(step))


def question(step: Step) -> tuple[bytes, ...]:
    """Return the housekeeping request of a step's service, or nothing if there is none."""
    return (HOUSEKEEPING[step.service].packet(),) if step.service in HOUSEKEEPING else ()


def preparation() -> list[Step]:
    """Return steps that reset counters of the boot, which differ between the two computers."""
    reset = [es.RESET_COUNTERS, evs.RESET_COUNTERS, sb.RESET_COUNTERS, tbl.RESET_COUNTERS, time_packets.RESET_COUNTERS]
    steps = [Step("EVS", (evs.RESET_ALL_FILTERS.packet(AppName="CFE_SB"),), PLAIN)]
    steps += [Step(each.name.split("_")[1], (each.packet(),), PLAIN) for each in reset]
    steps += [Step("EVS", (evs.RESET_APP_COUNTER.packet(AppName=name),), PLAIN) for name in APPS]
    return [*steps, Step("ES", (es.CLEAR_SYS_LOG.packet(),), PLAIN), Step("EVS", (evs.CLEAR_LOG.packet(),), PLAIN)]


class Simulated:
    """The mission in cfepy.

    Args:
        flown: the mission.
        line: the ports of commands and of telemetry.
    """

    def __init__(self, flown: Mission, line: tuple[int, int] = (CI_PORT, TO_PORT)) -> None:
        self._mission, self._ground = flown, GroundLink(flown)
        self._up, self._down = line
        flown.run_for(3)
        self._ground.send(ENABLE, self._up)
        flown.run_for(2)
        self._ground.received(self._down)
        self._files = self._read_files()

    def fly(self, step: Step, expected: Observed | None = None) -> Observed:
        if step.pace == RESET:
            self._send(step.packets)
            self._mission.run_for(VIRTUAL_RESET_S)
            self._send(question(step))
        else:
            self._send(with_housekeeping(step))
        self._mission.run_for(VIRTUAL_S[step.pace])
        packets = tuple(data for _, data in self._ground.received(self._down))
        files = self._read_files()
        changed = {path: data for path, data in files.items() if self._files.get(path) != data}
        self._files |= files
        return Observed(packets, changed)

    def _send(self, packets: tuple[bytes, ...]) -> None:
        for packet in packets:
            self._ground.send(packet, self._up)

    def _read_files(self) -> dict[str, bytes]:
        read, names = self._mission.files.read_file, self._mission.files.list_dir
        found = {f"{folder}/{name}" for folder in ("/ram", "/cf") for name in names(folder)}
        return {path: read(path) for path in found if path not in mission.files()}


class Real:
    """The mission in NASA's cFE."""

    of_packet = staticmethod(masks.of_packet)

    def __init__(self, booted: RealCfe) -> None:
        self._booted = booted
        self.release = booted.release()
        booted.send(ENABLE)
        end = time.monotonic() + LIMIT_S[BACKGROUND]
        while booted.receive(0.5) is None:
            if time.monotonic() > end:
                raise TimeoutError("NASA's cFE: no telemetry after TO_LAB_OUTPUT_ENABLE")
        while booted.receive(QUIET_S) is not None:
            pass
        self._files = self._read_files()

    def fly(self, step: Step, expected: Observed | None = None) -> Observed:
        if step.pace == RESET:
            boots = self._booted.boots()
            self._send(step.packets)
            self._booted.wait(lambda: self._booted.boots() > boots, "reset", BOOT_LIMIT_S)
            time.sleep(AFTER_BOOT_S)
            self._send(question(step))
        else:
            self._send(with_housekeeping(step))
        packets = list(self._come_down(step, expected))
        files = self._read_files()
        changed = {path: data for path, data in files.items() if self._files.get(path) != data}
        self._files |= files
        return Observed(tuple(packets), changed)

    def _send(self, packets: tuple[bytes, ...]) -> None:
        for packet in packets:
            self._booted.send(packet)

    def _come_down(self, step: Step, expected: Observed | None) -> Iterator[bytes]:
        wanted = expected.told(self.of_packet) if expected is not None else Counter[bytes]()
        silent = bool(wanted)  # then the last answer is the end; otherwise it takes a while to be sure
        last = begin = time.monotonic()
        end = begin + LIMIT_S[step.pace]
        while time.monotonic() < end:
            packet = self._booted.receive(0.05 if wanted else QUIET_S)
            if packet is not None:
                last = time.monotonic()
                told = self.of_packet(packet)
                if told is not None and wanted[told] > 0:
                    wanted -= Counter([told])
                yield packet
            elif time.monotonic() - begin < LEAST_S[step.pace]:
                continue
            elif not wanted and (silent or time.monotonic() - last > QUIET_S):
                return

    def _read_files(self) -> dict[str, bytes]:
        files = self._booted.files()
        given = mission.files()
        for path in (self._booted.folder / "cf").iterdir():
            virtual = f"/cf/{path.name}"
            if path.is_file() and virtual not in given and path.suffix not in (".so", ".scr"):
                files[virtual] = path.read_bytes()
        return files


@contextmanager
def prepared_simulation(
    files: Mapping[str, bytes],
    steps: Iterable[Step],
    make: Callable[[Mission], Simulated] = Simulated,
    release: str = RELEASE,
    memory: str = "linux",
) -> Iterator[Simulated]:
    """Return a mission in cfepy.

    Args:
        files: its files, by virtual path.
        steps: steps to fly first.
        make: makes the computer of the mission.
        release: release of cFE, such as "7.0.0".
        memory: how applications reach memory by address, as in a mission file.
    """
    with tempfile.TemporaryDirectory() as folder:
        for path, data in files.items():
            (Path(folder) / Path(path).name).write_bytes(data)
        (Path(folder) / "startup.scr").write_bytes(files[STARTUP_PATH])
        (Path(folder) / "mission.yaml").write_text(f'cfe_version: "{release}"\nmemory: {memory}\n', encoding="utf-8")
        with Mission(folder, console=Console(quiet=True)) as flown:
            yield _after(steps, make(flown))


@contextmanager
def prepared_real(
    built: Path,
    files: Mapping[str, bytes],
    steps: Iterable[Step],
    make: Callable[[RealCfe], Real] = Real,
    line: tuple[int, int] = (CI_PORT, TO_PORT),
) -> Iterator[Real]:
    """Return the same in NASA's cFE.

    Args:
        built: the folder of its executable.
        files: files to write over its own, by virtual path.
        steps: steps to fly first.
        make: makes the computer of it.
        line: the ports of commands and of telemetry.
    """
    with tempfile.TemporaryDirectory() as folder, RealCfe(built, Path(folder) / "cfe", files, line) as booted:
        yield _after(steps, make(booted))


def _after(steps: Iterable[Step], computer: Flyer) -> Flyer:
    for step in steps:
        computer.fly(step)
    return computer


def simulated(release: str) -> AbstractContextManager[Simulated]:
    """Return the mission of the lab applications in cfepy, prepared, on a release of cFE such as "7.0.0"."""
    return prepared_simulation(mission.files(), preparation(), release=release)


def real(built: Path) -> AbstractContextManager[Real]:
    """Return the same in NASA's cFE, prepared."""
    return prepared_real(built, mission.files(), preparation())


def differences(ours: Observed, theirs: Observed) -> list[str]:
    """Return the differences between two observations of a step, one line each."""
    mine, real_ones = ours.told(), theirs.told()
    missing, added = [*(real_ones - mine).elements()], [*(mine - real_ones).elements()]
    found = []
    for each in [*missing]:
        pair = next((other for other in added if masks.fields_that_differ(other, each)), None)
        if pair is not None:
            missing.remove(each)
            added.remove(pair)
            found.append(f"telemetry 0x{int.from_bytes(each[:2], 'big'):04X}: {masks.fields_that_differ(pair, each)}")
    return [*found, *only(missing, added), *file_differences(ours, theirs, _of_file)]


def _of_file(path: str, ours: bytes, theirs: bytes) -> str:
    if masks.is_log(ours) and masks.is_log(theirs):
        return "" if masks.same_log(ours, theirs) else "other events"
    return first_difference(masks.of_file(ours), masks.of_file(theirs))


def only(missing: Iterable[bytes], added: Iterable[bytes]) -> list[str]:
    """Return a line for each packet that only one side sent."""
    return [
        *(f"only NASA's: {shown(told)}" for told in missing),
        *(f"only ours:   {shown(told)}" for told in added),
    ]


def file_differences(ours: Observed, theirs: Observed, compare: Callable[[str, bytes, bytes], str]) -> list[str]:
    """Return a line for each file that differs.

    Args:
        ours: the results of a step in cfepy.
        theirs: the results in NASA's cFE.
        compare: gets a path and two contents, and returns the differences, or "" if there are none.
    """
    found = []
    for path in sorted({*ours.files, *theirs.files}):
        one, other = (each.files.get(path) for each in (ours, theirs))
        if one is None or other is None:
            found.append(f"file {path}: {'not here' if one is None else 'not there'}")
        elif line := compare(path, one, other):
            found.append(f"file {path}: {line}")
    return found


def shown(told: bytes) -> str:
    """Return the compared content of a packet as readable text."""
    msg_id = int.from_bytes(told[:2], "big")
    if msg_id == evs.LONG_EVENT_MSG_MID:
        app, number = told[8:28].partition(b"\0")[0], int.from_bytes(told[28:30], "little")
        return f"event {app.decode(errors='replace')} {number}: {told[40:].rstrip(bytes(1))!r} type {told[30]}"
    return f"0x{msg_id:04X} {told[2:].hex()}"


def first_difference(ours: bytes, theirs: bytes) -> str:
    """Return where and how two pieces of data begin to differ, or "" if they are equal."""
    if ours == theirs:
        return ""
    at = next((at for at, (one, other) in enumerate(zip(ours, theirs, strict=False)) if one != other), None)
    if at is None:
        return f"{len(ours)} bytes of ours, {len(theirs)} of NASA's are compared"
    here, there = (each[at : at + 24].hex() for each in (ours, theirs))
    return f"byte {at}: {here} is {there} in NASA's; of {len(ours)}, {len(theirs)}"


def fly(computer: Computer, steps: Iterable[Step]) -> list[Observed]:
    """Fly steps, and return the results of each."""
    return [computer.fly(step, None) for step in steps]
