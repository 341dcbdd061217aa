"""`cfepy tlm`: show telemetry by name, as it arrives over UDP or as a mission sends it in virtual time."""

from __future__ import annotations

import argparse
import sys

from cfepy.cli.failures import booting
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.target import Host, dictionary_for, host_of
from cfepy.cli.tlm_output import Output, make_output
from cfepy.console import Console
from cfepy.io import udp
from cfepy.mission import Mission, MissionSpec, read_mission
from cfepy.mission.dictionary import Dictionary, dictionary_of
from cfepy.mission.ground import CI_PORT, TO_PORT
from cfepy.mission.results import deaths
from cfepy.mission.spec import find_script
from cfepy.mission.topics import topic_id, topics_of
from cfepy.mission.values import packet_of
from cfepy.mission.watch import PacketWatch, Seen
from cfepy.msg import TLM_HEADER_SIZE, get_header_size, get_msg_id
from cfepy.rtos.realtime import Stopwatch
from cfepy.rtos.units import NS_PER_MS, NS_PER_S
from cfepy.status import UsageError

ANY_ADDRESS = "0.0.0.0"
FLIGHT_S = 10.0
PIECE_NS = 100 * NS_PER_MS
REFRESH_S = 0.2


def run(arguments: argparse.Namespace) -> int:
    """Show telemetry.

    Returns:
        The exit status: 1 when nothing came.

    Raises:
        UsageError: no such mission, packet or address.
    """
    words: list[str] = list(arguments.words)
    host = host_of(words[0], TO_PORT) if words else None
    if host is None and words and _is_mission(words[0]):
        if arguments.enable is not None:
            raise UsageError("a mission in virtual time sends to no computer; leave it out", field="--enable")
        return _fly(read_mission(words[0]), words[1:], arguments)
    names = words if host is None else words[1:]
    dictionary = dictionary_for(arguments.mission)
    wanted = {dictionary.telemetry_of(name).msg_id for name in names}
    return _listen(host or Host(ANY_ADDRESS, TO_PORT), dictionary, wanted, arguments)


def _is_mission(word: str) -> bool:
    try:
        find_script(word)
    except UsageError:
        return False
    return True


# -- over UDP ----------------------------------------------------------------------------------------------------------


def _listen(host: Host, dictionary: Dictionary, wanted: set[int], arguments: argparse.Namespace) -> int:
    with udp.Listener(host.name, host.port) as listener:
        if arguments.enable is not None:
            _enable(arguments.enable, dictionary)
        output = make_output(dictionary, arguments.json, sys.stdout, is_live=True)
        try:
            shown = _take(listener, wanted, output, arguments)
        finally:
            output.close()
    if shown:
        return ENDED_WELL
    hint = "" if arguments.enable is not None else "; TO_LAB sends nothing before it is asked to, see --enable"
    return _nothing(f"no such packet came to port {host.port} in {arguments.seconds:g} s{hint}")


def _nothing(text: str) -> int:
    sys.stdout.flush()
    print(f"cfepy: {text}", file=sys.stderr)
    return FOUND_PROBLEMS


def _take(listener: udp.Listener, wanted: set[int], output: Output, arguments: argparse.Namespace) -> int:
    """Show packets until there were enough or the time is over; how many there were."""
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
    """Whether a datagram can be a telemetry packet: anything may arrive at a port."""
    return len(packet) >= TLM_HEADER_SIZE and get_header_size(packet) == TLM_HEADER_SIZE


def _enable(address: str, dictionary: Dictionary) -> None:
    """Ask TO_LAB to send to this computer."""
    host = host_of(address, CI_PORT) or Host(address, CI_PORT)
    packet = packet_of(dictionary.command("TO_LAB_OUTPUT_ENABLE"), [f"dest_IP={udp.own_address(host.name)}"])
    if not udp.send(host.name, host.port, packet):
        raise UsageError("nobody listens there, so TO_LAB cannot be asked to send", file=str(host))


# -- in virtual time ---------------------------------------------------------------------------------------------------


def _fly(spec: MissionSpec, names: list[str], arguments: argparse.Namespace) -> int:
    dictionary = dictionary_of(spec)
    wanted = {_msg_id(spec, dictionary, name) for name in names}
    seen: list[Seen] = []
    watch = PacketWatch(seen.append, lambda msg_id: msg_id in wanted if wanted else msg_id & 0x1800 == 0x0800)
    output = make_output(dictionary, arguments.json, sys.stdout, is_live=False)
    with booting(spec.script), Mission(spec, console=Console(quiet=True), attachments=[watch]) as mission:
        shown = _show_flight(mission, seen, output, dictionary, arguments)
        problems, end_s = deaths(mission), mission.kernel.now / NS_PER_S
    sys.stdout.flush()
    for problem in problems:
        print(f"cfepy: {problem}", file=sys.stderr)
    is_topic = any(name.startswith("/") for name in names)
    hint = "; a topic is sent when somebody subscribes, `cfepy topic echo` shows it in any case" if is_topic else ""
    return ENDED_WELL if shown else _nothing(f"no such packet was sent in {end_s:g} virtual seconds{hint}")


def _msg_id(spec: MissionSpec, dictionary: Dictionary, name: str) -> int:
    return topic_id(spec, name) if name.startswith("/") else dictionary.telemetry_of(name).msg_id


def _show_flight(
    mission: Mission, seen: list[Seen], output: Output, dictionary: Dictionary, arguments: argparse.Namespace
) -> int:
    """Show packets until there were enough or the time is over; how many there were."""
    shown = 0
    until_ns = round((arguments.seconds or FLIGHT_S) * NS_PER_S)
    while mission.kernel.now < until_ns and shown != arguments.count:
        mission.run_until(min(until_ns, mission.kernel.now + PIECE_NS))
        dictionary.learn(topics_of(mission))
        packets = seen if arguments.count is None else seen[: arguments.count - shown]
        for each in packets:
            output.show(each.packet, each.at_ns)
        shown += len(packets)
        seen.clear()
    return shown
