"""The XTCE of every shipped mission, against the schema of XTCE 1.2 and another reader.

Both come from space_packet_parser: it has OMG's SpaceSystem.xsd, and decodes from the document alone.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest
from space_packet_parser.xtce.definitions import XtcePacketDefinition
from space_packet_parser.xtce.validation import validate_xtce

from cfepy.ground.dictionary import Dictionary, dictionary_of
from cfepy.ground.xtce import xtce_of
from cfepy.mission import read_mission
from cfepy.msg import Telemetry
from cfepy.reading.resources import shipped
from tests.ground.random_packets import DECLARED, random_telemetry, telemetry_values

MISSIONS = sorted(script.parent.name for script in shipped("missions").glob("*/startup.scr"))
ALL_TYPES = "all types"


def dictionary_named(name: str) -> Dictionary:
    """Return the dictionary of a shipped mission, or one with a field of every type."""
    if name != ALL_TYPES:
        return dictionary_of(read_mission(name))
    found = Dictionary()
    found.add(DECLARED)
    return found


def declared_telemetry(dictionary: Dictionary) -> Iterator[Telemetry]:
    """Yield every packet that is declared, also several of one MsgId."""
    for declared in dictionary.telemetry.values():
        if isinstance(declared, Telemetry):
            yield declared
            yield from declared.variants


def read_back(name: str, folder: Path, times: int) -> int:
    """Let the other reader check the document and decode random packets. Returns how many fields were compared."""
    dictionary, file = dictionary_named(name), folder / "mission.xml"
    file.write_text(xtce_of(name, dictionary), encoding="utf-8")
    result = validate_xtce(file, level="all", raise_on_error=False)
    assert result.valid, [str(error) for error in result.errors[:5]]
    definition = XtcePacketDefinition.from_xtce(file)
    random, compared = Random(name), 0
    for declared in declared_telemetry(dictionary):
        for sequence in range(times):
            packet = random_telemetry(declared, sequence, random)
            with warnings.catch_warnings():
                warnings.simplefilter("error")  # bytes that were not read
                theirs = dict(definition.parse_bytes(packet))
            ours = telemetry_values(declared, packet)
            decoded = dictionary.decode(packet)
            assert (theirs["SRC_SEQ_CTR"], theirs["TIME"]) == (decoded.sequence, decoded.time_s)
            own = {key for key in theirs if key.startswith(f"{declared.name}_") and not key.endswith("_any_first")}
            assert {key: theirs[key] for key in own} == ours
            compared += len(ours)
    return compared


@pytest.mark.parametrize("name", [*MISSIONS, ALL_TYPES])
def test_random_telemetry_is_read_field_by_field(name: str, tmp_path: Path) -> None:
    assert read_back(name, tmp_path, times=3) >= 100


@pytest.mark.slow
@pytest.mark.parametrize("name", [*MISSIONS, ALL_TYPES])
def test_much_random_telemetry_is_read_field_by_field(name: str, tmp_path: Path) -> None:
    assert read_back(name, tmp_path, times=200) >= 5_000


def test_a_document_with_a_mistake_is_found(tmp_path: Path) -> None:
    """The schema is at hand, and looked at."""
    file = tmp_path / "bad.xml"
    file.write_text(
        xtce_of("m", dictionary_named(ALL_TYPES)).replace("SequenceContainer", "SequentialContainer"), encoding="utf-8"
    )
    assert not validate_xtce(file, level="schema", raise_on_error=False).valid
