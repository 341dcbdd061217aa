"""`cfepy export cosmos MISSION -o FOLDER/`: a plugin folder for COSMOS, and mission scripts as procedures.

The folder has the definitions of the mission's packets, a target, an interface for CI_LAB and TO_LAB with length and
checksum, and a procedure. A step of a mission script that has no counterpart in COSMOS is refused with its line.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from cfepy.extra.procedures.station import CI_PORT, TO_PORT
from cfepy.ground import Dictionary, flat, xtce_name
from cfepy.mission import MissionSpec
from cfepy.script import Comparison, EventCondition, Step, TelemetryCondition, read_script
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

_DEFAULT_WITHIN_S = 5.0
_TYPES = {1: "DEBUG", 2: "INFORMATION", 3: "ERROR", 4: "CRITICAL"}
_HELPERS = '''"""Translated by cfepy export cosmos from a mission script."""

import time
from openc3.script import *

start = time.time()
events = subscribe_packets([["{target}", "CFE_EVS_LONG_EVENT_MSG"]])
seen = []


def wait_until(seconds):
    """Wait until this time in s since the start of the procedure."""
    wait(max(seconds - (time.time() - start), 0))


def wait_check_event(app, event_id, kind, text, timeout):
    """Wait for an event; None stands for any."""
    end = time.time() + timeout
    while True:
        seen.extend(get_packets(events)[1])
        for each in seen:
            if (
                app in (None, each["PACKETID_APPNAME"])
                and event_id in (None, each["PACKETID_EVENTID"])
                and kind in (None, each["PACKETID_EVENTTYPE"])
                and (text is None or text in each["MESSAGE"])
            ):
                return
        if time.time() >= end:
            raise CheckError(f"no event of {{app}} with id {{event_id}} and text {{text}} in {{timeout}} s")
        wait(0.25)


'''


def plugin_files(spec: MissionSpec, definitions: str, script: str | None, dictionary: Dictionary) -> dict[str, str]:
    """Return the files of a plugin folder by path.

    Args:
        spec: the mission.
        definitions: text of its packets.
        script: file of a mission script to translate; None for none.
        dictionary: the mission's packets.

    Raises:
        UsageError: if the script has a mistake, or a step without a counterpart.
    """
    name = spec.name.upper().replace("-", "_")
    folder = f"targets/{name}"
    gem = f"openc3-cosmos-{spec.name.lower().replace('_', '-')}"
    files = {
        "plugin.txt": _plugin(name),
        f"{gem}.gemspec": _gemspec(gem, spec.name),
        f"{folder}/target.txt": f"# Target {name}\n",
        f"{folder}/cmd_tlm/{spec.name}.txt": definitions,
    }
    if script is not None:
        procedure = "\n".join(_procedure(name, script, spec, dictionary)) + "\n"
        files[f"{folder}/procedures/{Path(script).stem}.py"] = procedure
    return files


def _plugin(name: str) -> str:
    return f"""# Written by cfepy export cosmos
VARIABLE flight_ip 127.0.0.1
VARIABLE command_port {CI_PORT}
VARIABLE telemetry_port {TO_PORT}

TARGET {name} {name}
INTERFACE {name}_INT udp_interface.rb <%= flight_ip %> <%= command_port %> <%= telemetry_port %> nil nil 128 nil nil
  MAP_TARGET {name}
  PROTOCOL WRITE CrcProtocol CCSDS_CHECKSUM nil "ERROR" 56 8 "XOR"
  PROTOCOL READ LengthProtocol 32 16 7 1 BIG_ENDIAN 0 nil
"""


def _gemspec(gem: str, mission: str) -> str:
    return f"""Gem::Specification.new do |s|
  s.name = "{gem}"
  s.summary = "Packets of the mission {mission}, written by cfepy"
  s.authors = ["cfepy"]
  s.version = "0.0.1"
  s.files = Dir.glob("{{targets}}/**/*") + ["plugin.txt"]
end
"""


def _procedure(target: str, file: str, spec: MissionSpec, dictionary: Dictionary) -> Iterator[str]:
    script = read_script(file, spec, dictionary)
    yield _HELPERS.format(target=target).rstrip("\n")
    yield ""
    for step in script.steps:
        try:
            yield from _lines(target, step, dictionary)
        except UsageError as error:
            raise UsageError(error.text, file=file, line=step.line) from None


def _lines(target: str, step: Step, dictionary: Dictionary) -> Iterator[str]:
    yield f"# {step.line}: {step.text}"
    if step.at_ns is not None:
        yield f"wait_until({step.at_ns / NS_PER_S:g})"
    if step.after_ns is not None:
        yield f"wait({step.after_ns / NS_PER_S:g})"
    if step.packet is not None:
        yield "seen.clear()"
        yield _command(target, step.packet, dictionary)
    elif step.condition is not None:
        yield from _check(target, step)
    elif step.action is not None:
        raise UsageError("a step of ROS has no counterpart in COSMOS; leave it out")


def _command(target: str, packet: bytes, dictionary: Dictionary) -> str:
    decoded = dictionary.decode(packet)
    if decoded.problem:
        return f'send_raw("{target}_INT", bytes.fromhex("{packet.hex()}"))'
    values = {xtce_name(path).upper(): value for path, value in flat(decoded.values).items() if value not in (0, "")}
    return f'cmd("{target}", "{decoded.name}", {values!r})'


def _check(target: str, step: Step) -> Iterator[str]:
    if step.must_not:
        raise UsageError("an expectation of nothing has no counterpart in COSMOS; leave it out")
    if step.until_ns is not None:
        timeout = f"{step.until_ns / NS_PER_S:g} - (time.time() - start)"
    else:
        within = _DEFAULT_WITHIN_S if step.within_ns is None else step.within_ns / NS_PER_S
        timeout = f"{within:g}"
    condition = step.condition
    if isinstance(condition, EventCondition):
        kind = None if condition.event_type is None else _TYPES[condition.event_type]
        yield f"wait_check_event({condition.app!r}, {condition.event_id!r}, {kind!r}, {condition.text!r}, {timeout})"
    elif isinstance(condition, TelemetryCondition) and not condition.is_topic:
        if not condition.comparisons:
            yield f'wait_check_packet("{target}", "{condition.name}", 1, {timeout})'
        for each in condition.comparisons:
            yield f"wait_check({_comparison(target, condition.name, each)!r}, {timeout})"
    else:
        raise UsageError("this expectation has no counterpart in COSMOS; leave it out")


def _comparison(target: str, packet: str, each: Comparison) -> str:
    value = each.value
    try:
        float(value)
    except ValueError:
        value = repr(value)
    return f"{target} {packet} {xtce_name(each.path).upper()} {each.sign} {value}"
