"""`cfepy tlm`: show telemetry by name, as it arrives over UDP or as a mission sends it in virtual time.

The output is a line a packet, JSON lines, or on a terminal a table with the newest packet of each kind.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Protocol, TextIO

from cfepy.cli.flying_progress import FlyingProgress
from cfepy.cli.ground.command_target import RemoteHost, dictionary_for, host_of
from cfepy.cli.json_output import json_lines, json_text
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.options import plan_of, refuse_run_options
from cfepy.cli.text_table import show_paragraph
from cfepy.cli.user_notes import tell, tell_briefly
from cfepy.ground import CI_PORT, TO_PORT, Decoded, Dictionary, dictionary_of, packet_of, topic_id, topics_of
from cfepy.io import live_flight, live_name, udp
from cfepy.mission import MissionSpec, PacketWatch, Seen, TopicMessage, find_script, is_node, read_mission
from cfepy.msg import RED, TLM_HEADER_SIZE, YELLOW, get_header_size, get_msg_id
from cfepy.pilot import LiveRun, RunPlan, never_happened, takeoff
from cfepy.rtos import Stopwatch
from cfepy.status import UsageError
from cfepy.units import NS_PER_MS, NS_PER_S
from cfepy.writing.escapes import keep_output_safe, rich_console, visible_line

ANY_ADDRESS, OWN_ADDRESS = "0.0.0.0", "127.0.0.1"
PIECE_NS = 100 * NS_PER_MS
REFRESH_S = 0.2


class Output(Protocol):
    """Interface of an output for packets."""

    def show(self, packet: bytes, at_ns: int) -> None:
        """Show a packet and its time: virtual ns when it was sent, or ns since the start when it arrived."""

    def refresh(self) -> None:
        """Draw the packets shown so far; called at intervals."""

    def close(self) -> None:
        """End the output: no more packets follow."""


@contextmanager
def output_for(dictionary: Dictionary, arguments: argparse.Namespace, is_live: bool) -> Iterator[Output]:
    """Yield the output for packets that the command line asks for.

    Args:
        dictionary: names the packets and their fields.
        arguments: the command line.
        is_live: packets arrive in real time, so a terminal shows a table.

    Raises:
        UsageError: the file for JSON cannot be written.
    """
    shows_table = is_live and sys.stdout.isatty()
    with json_lines(arguments) as lines:
        kind = LiveTable if shows_table else TextLines
        text: Output = kind(dictionary, sys.stdout, arguments.raw)
        output = Several([text] if lines is None else [text, JsonLines(dictionary, lines)])
        try:
            yield output
        finally:
            output.close()


class Several:
    """Shows packets in several outputs.

    Args:
        outputs: the outputs.
    """

    def __init__(self, outputs: Sequence[Output]) -> None:
        self._outputs = outputs

    def show(self, packet: bytes, at_ns: int) -> None:
        for each in self._outputs:
            each.show(packet, at_ns)

    def refresh(self) -> None:
        for each in self._outputs:
            each.refresh()

    def close(self) -> None:
        for each in self._outputs:
            each.close()


class TextLines:
    """Writes lines such as `2.450 CFE_ES_HK_TLM CommandCounter=0 ...`."""

    def __init__(self, dictionary: Dictionary, stream: TextIO, raw: bool = False) -> None:
        self._dictionary = dictionary
        self._stream = stream
        self._raw = raw

    def show(self, packet: bytes, at_ns: int) -> None:
        decoded = self._dictionary.decode(packet)
        text = f"{at_ns / NS_PER_S:.3f} {decoded.name} {content(decoded, packet, self._raw)}"
        show_paragraph(visible_line(text), self._stream)

    def refresh(self) -> None:
        self._stream.flush()

    def close(self) -> None:
        """Leave the stream open, because the caller owns it."""


class JsonLines(TextLines):
    """Writes objects with name, msg_id, sequence, time (spacecraft time, s), at (s) and raw values, one a line.

    Packets with measurements also have their engineering values.
    """

    def show(self, packet: bytes, at_ns: int) -> None:
        decoded = self._dictionary.decode(packet)
        record: dict[str, Any] = {
            "name": decoded.name,
            "msg_id": decoded.msg_id,
            "sequence": decoded.sequence,
            "time": decoded.time_s,
            "at": at_ns / NS_PER_S,
            "values": decoded.values,
        }
        if decoded.measurements:
            record["measurements"] = decoded.measurements
        if decoded.problem:
            record |= {"problem": decoded.problem, "packet": packet.hex()}
        self._stream.write(json_text(record, default=bytes.hex) + "\n")


class LiveTable:
    """Shows a row for each kind of packet: their number, the time of the newest one, and its fields."""

    def __init__(self, dictionary: Dictionary, stream: TextIO, raw: bool = False) -> None:
        from rich.live import Live

        self._dictionary = dictionary
        self._raw = raw
        self._rows: dict[int, tuple[int, int, bytes]] = {}
        self._is_new = True
        self._live = Live(console=rich_console(stream), auto_refresh=False)
        self._live.start()
        keep_output_safe()

    def show(self, packet: bytes, at_ns: int) -> None:
        msg_id = packet[0] << 8 | packet[1]
        count = self._rows[msg_id][0] if msg_id in self._rows else 0
        self._rows[msg_id] = (count + 1, at_ns, packet)
        self._is_new = True

    def refresh(self) -> None:
        if self._is_new:
            self._is_new = False
            self._live.update(self._table(), refresh=True)

    def close(self) -> None:
        self.refresh()
        self._live.stop()

    def _table(self) -> Any:
        from rich import box
        from rich.table import Table
        from rich.text import Text

        table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
        for column in ("packet", "count", "at"):
            table.add_column(column, justify="left" if column == "packet" else "right", no_wrap=True)
        table.add_column("content")
        for _, (count, at_ns, packet) in sorted(self._rows.items()):
            decoded = self._dictionary.decode(packet)
            cells = (decoded.name, f"{count:,}", f"{at_ns / NS_PER_S:.1f}", content(decoded, packet, self._raw))
            texts = [Text(visible_line(cell)) for cell in cells]
            for name, style in ((YELLOW, "yellow"), (RED, "bold red")):
                texts[-1].highlight_regex(rf"\S+\[{name}[<>][^\]]*\]", style)
            table.add_row(*texts)
        return table


def content(decoded: Decoded, packet: bytes, raw: bool = False) -> str:
    """Return the fields of a packet, or its bytes if its fields are not known."""
    return f"{packet.hex()} ({decoded.problem})" if decoded.problem else decoded.line(raw)


def run(arguments: argparse.Namespace) -> int:
    """Show telemetry.

    Returns:
        The exit status: 1 if no packet came.

    Raises:
        UsageError: there is no such mission, packet or address.
    """
    words: list[str] = list(arguments.words)
    live = live_name(words[0]) if words else None
    if live is not None:
        return _attach(live, words[1:], arguments)
    host = host_of(words[0], TO_PORT) if words else None
    if host is None and words and _is_mission(words[0]):
        if arguments.enable is not None:
            raise UsageError("only valid for a remote target; leave it out", field="--enable")
        return _fly(plan_of(arguments, words[:1]), words[1:], arguments)
    refuse_run_options(arguments, "requires a mission, and none is named; leave it out", but=["seconds"])
    names = words if host is None else words[1:]
    dictionary = dictionary_for(arguments.mission)
    wanted = {msg_id for name in names for msg_id in dictionary.telemetry_like(name)}
    return _listen(host or RemoteHost(ANY_ADDRESS, TO_PORT), dictionary, wanted, arguments)


def _attach(name: str, names: list[str], arguments: argparse.Namespace) -> int:
    """Show the telemetry of a running flight."""
    if arguments.enable is not None:
        raise UsageError("only valid for a remote target; leave it out", field="--enable")
    refuse_run_options(arguments, "only valid for a mission to be run; leave it out", but=["seconds"])
    with live_flight(name) as flight:
        spec = read_mission(arguments.mission or flight.script)
        dictionary = dictionary_of(spec)
        wanted = [msg_id for each in names for msg_id in _msg_ids(spec, dictionary, each)]
        flight.listen(telemetry=wanted)
        shown = 0
        with output_for(dictionary, arguments, is_live=True) as output:
            for message in flight.messages(arguments.seconds):
                if not isinstance(message, TopicMessage):
                    output.show(*message)
                    output.refresh()
                    shown += 1
                if shown == arguments.count:
                    break
    return ENDED_WELL if shown else _nothing("no matching packet was sent")


def _is_mission(word: str) -> bool:
    try:
        return is_node(word) or bool(find_script(word))
    except UsageError:
        return False


# -- over UDP ----------------------------------------------------------------------------------------------------------
def _listen(host: RemoteHost, dictionary: Dictionary, wanted: set[int], arguments: argparse.Namespace) -> int:
    with udp.UdpListener(host.name, host.port) as listener:
        if arguments.enable is not None:
            _enable(arguments.enable, dictionary)
        with output_for(dictionary, arguments, is_live=True) as output:
            shown = _take(listener, wanted, output, arguments)
    if shown:
        return ENDED_WELL
    hint = "" if arguments.enable is not None else "; TO_LAB sends nothing before it is asked to, see --enable"
    return _nothing(f"no matching packet arrived at port {host.port} in {arguments.seconds:g} s{hint}")


def _nothing(text: str) -> int:
    tell([text])
    return FOUND_PROBLEMS


def _take(listener: udp.UdpListener, wanted: set[int], output: Output, arguments: argparse.Namespace) -> int:
    """Show packets until there were enough or the time is over. Returns their number."""
    watch = Stopwatch()
    shown = 0
    while shown != arguments.count:
        elapsed_s = watch.elapsed_ns() / NS_PER_S
        if arguments.seconds is not None and elapsed_s >= arguments.seconds:
            break
        rest_s = REFRESH_S if arguments.seconds is None else min(REFRESH_S, arguments.seconds - elapsed_s)
        packet = listener.receive(rest_s)
        if packet is not None and _is_telemetry(packet) and (not wanted or get_msg_id(packet) in wanted):
            output.show(packet, watch.elapsed_ns())
            shown += 1
        output.refresh()
    return shown


def _is_telemetry(packet: bytes) -> bool:
    """Return True if a datagram can be a telemetry packet; any data may arrive at a port."""
    return len(packet) >= TLM_HEADER_SIZE and get_header_size(packet) == TLM_HEADER_SIZE


def _enable(address: str, dictionary: Dictionary) -> None:
    """Ask TO_LAB to send to this computer."""
    host = host_of(address or OWN_ADDRESS, CI_PORT) or RemoteHost(address, CI_PORT)
    packet = packet_of(dictionary.command("TO_LAB_OUTPUT_ENABLE"), [f"dest_IP={udp.own_address(host.name)}"])
    if not udp.send(host.name, host.port, packet):
        raise UsageError(
            "no receiver is listening, so telemetry cannot be enabled; start the mission first", file=str(host)
        )


# -- in virtual time ---------------------------------------------------------------------------------------------------
def _fly(plan: RunPlan, names: list[str], arguments: argparse.Namespace) -> int:
    spec = plan.spec()
    dictionary = dictionary_of(spec)
    wanted = {msg_id for name in names for msg_id in _msg_ids(spec, dictionary, name)}
    seen: list[Seen] = []
    watch = PacketWatch(seen.append, lambda msg_id: msg_id in wanted if wanted else msg_id & 0x1800 == 0x0800)
    host = FlyingProgress()
    with (
        output_for(dictionary, arguments, is_live=False) as output,
        takeoff(plan, spec=spec, attachments=[watch], host=host) as run,
    ):
        tell_briefly(run.notes)
        shown = _show_flight(run, host, seen, output, dictionary, arguments.count)
        problems, end_s = (
            [*run.problems(), *never_happened(run.mission)],
            run.mission.kernel.now / NS_PER_S,
        )
    tell(problems)
    is_topic = any(name.startswith("/") for name in names)
    hint = (
        "; a topic is sent only while it has a subscriber; `cfepy rostopic echo` subscribes to it" if is_topic else ""
    )
    return ENDED_WELL if shown else _nothing(f"no matching packet was sent in {end_s:g} virtual seconds{hint}")


def _msg_ids(spec: MissionSpec, dictionary: Dictionary, name: str) -> list[int]:
    return [topic_id(spec, name)] if name.startswith("/") else dictionary.telemetry_like(name)


def _show_flight(
    run: LiveRun, host: FlyingProgress, seen: list[Seen], output: Output, dictionary: Dictionary, most: int | None
) -> int:
    """Show packets until there were enough or the time is over. Returns their number."""
    shown = 0
    while run.course.goes_on and shown != most:
        run.run_until(run.mission.kernel.now + PIECE_NS)
        dictionary.learn(topics_of(run.mission))
        packets = seen if most is None else seen[: most - shown]
        if packets:
            host.progress.clear()
        for each in packets:
            output.show(each.packet, each.at_ns)
        shown += len(packets)
        seen.clear()
    return shown
