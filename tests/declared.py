"""Checks of the ground declarations of a service or an app: complete, and with the bytes of recorded packets."""

from __future__ import annotations

import json
from pathlib import Path
from types import ModuleType

from cfepy.msg import CMD_HEADER_SIZE

REAL = json.loads((Path(__file__).parent / "data" / "packets.json").read_text(encoding="utf-8"))


def assert_complete(packets: ModuleType) -> None:
    """Assert that every function code from 0 has its command, names are unique and NASA's, and texts are sentences.

    Args:
        packets: the module with `COMMANDS`, `TELEMETRY`, constants `*_MID`, and `*_CC` if it names its function codes.
    """
    codes = {value: name.removesuffix("_CC") for name, value in vars(packets).items() if name.endswith("_CC")}
    declared = {command.code: command.name for command in packets.COMMANDS if command.code is not None}
    if codes:
        assert sorted(declared) == sorted(codes)
        assert [code for code, name in declared.items() if not name.endswith(f"_{codes[code]}")] == []
    everything = [*packets.COMMANDS, *packets.TELEMETRY]
    assert len({each.name for each in everything}) == len(everything)
    assert [each.name for each in everything if not each.text.endswith(".")] == []
    assert {each.msg_id for each in everything} <= {
        value for name, value in vars(packets).items() if name.endswith("_MID")
    }


def assert_as_recorded(packets: ModuleType, least: int) -> None:
    """Commands pack to the recorded bytes, telemetry has the recorded lengths.

    Of commands, the sequence count is left out, which a ground station counts, and the checksum, which includes it.

    Args:
        packets: as for `assert_complete`.
        least: how many commands have to be among the recorded ones.
    """
    commands = {(command.msg_id, command.code or 0): command for command in packets.COMMANDS}
    found = 0
    for recorded in REAL["commands"]:
        command = commands.get((recorded["mid"], recorded["fc"]))
        if command is not None and len(recorded["hex"]) == 2 * recorded["length"]:
            real = bytes.fromhex(recorded["hex"])
            ours = command.packet(command.read(real))
            assert (ours[:2], ours[4:7], ours[CMD_HEADER_SIZE:]) == (real[:2], real[4:7], real[CMD_HEADER_SIZE:])
            found += 1
    assert found >= least
    lengths = {recorded["mid"]: len(recorded["hex"]) // 2 for recorded in REAL["telemetry"]}
    for telemetry in packets.TELEMETRY:
        assert lengths.get(telemetry.msg_id, telemetry.length) == telemetry.length
