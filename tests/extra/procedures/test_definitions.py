"""ERB, definitions and the words of procedures, without a flight."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from cfepy.extra.procedures.definition_reader import read_definitions, ruby_variables
from cfepy.extra.procedures.erb import Template
from cfepy.extra.procedures.packet_items import PacketDefinition
from cfepy.extra.procedures.requirements import Requirements, next_state
from cfepy.extra.procedures.script_words import command_words, holds
from cfepy.extra.procedures.suites import ProcedureGroup, ProcedureSuite, steps_of
from cfepy.extra.procedures.target_packets import TargetPackets
from cfepy.ground import Dictionary
from cfepy.status import UsageError

FILE = Path("a.txt")
TEMPLATE = """a
<% if $size == 64 && name != 'x' %>
big <%= name %>
<% elsif $size > 16 %>
middle
<% else %>
small
<% end %>
<% (1..2).each do |i| %>
row <%= i * 2 %>
<% end %>
<%# nothing %>b
"""


@pytest.mark.parametrize(
    ("size", "text"), [(64, "a\n\nbig n\n\n\nrow 2\n\nrow 4\n\nb\n"), (32, "a\n\nmiddle\n\n\nrow 2\n\nrow 4\n\nb\n")]
)
def test_template_has_conditions_and_loops(size: int, text: str) -> None:
    assert Template({"$size": size, "name": "n"}).render(TEMPLATE, FILE) == text


def test_template_divides_whole_numbers_and_keeps_texts() -> None:
    assert Template({"$size": 7}).render("<%= $size / 2 %> <%= 'a/b && c' %>", FILE) == "3 a/b && c"


@pytest.mark.parametrize(
    ("ruby", "text"),
    [("7 / 2", "3"), ("-7 / 2", "-4"), ("7.0 / 2", "3.5"), ("(1 + 1.0) / 4 / 2", "0.25"), ("9 / (5 / 2)", "4")],
)
def test_division_gives_a_whole_number_of_whole_numbers_only(ruby: str, text: str) -> None:
    assert Template({}).render(f"<%= {ruby} %>", FILE) == text


def test_template_prints_values_as_ruby_does() -> None:
    variables = {"$yes": True, "$none": None, "text": "a"}
    assert Template(variables).render("<%= $yes %> <%= $none %>|<%= text %> <%= 2 * 3 %>", FILE) == "true |a 6"


@pytest.mark.parametrize(
    ("template", "text", "line"),
    [
        ("a\n<% File.read('x') %>", "Ruby is not executed", 2),
        ("<%= unknown %>", "the variable unknown has no value", 1),
        ("<% if 1 == 1 %>\na", "missing <% end %>", 1),
        ("a\n<% end %>", "unexpected <% end %>", 2),
        ("<%= 1 / 0 %>", "division", 1),
        ('<%= "a#{1}" %>', "Ruby is not executed", 1),
        ("<%= 2 ** 3 %>", "Ruby is not executed", 1),
        ("<%= ('a' * 1000000) * 1000000 %>", "Ruby is not executed", 1),
        ("<% 200000.times do |i| %><% end %>", "at most 100,000 rounds", 1),
    ],
)
def test_template_beyond_is_refused_with_its_line(template: str, text: str, line: int) -> None:
    with pytest.raises(UsageError) as error:
        Template({}).render(template, FILE)
    assert text in error.value.text
    assert (error.value.file, error.value.line) == (str(FILE), line)


DEFINITIONS = """
COMMAND T GO BIG_ENDIAN "Go"
  APPEND_ID_PARAMETER ID 16 UINT MIN MAX 0x1890 "Id"
  APPEND_PARAMETER SEQ 16 UINT MIN MAX 0xC000
  APPEND_PARAMETER LEN 16 UINT MIN MAX 1
  APPEND_ID_PARAMETER CODE 8 UINT MIN MAX 3
  APPEND_PARAMETER SUM 8 UINT MIN MAX 0
  APPEND_PARAMETER MODE 16 INT -2 2 -1 "Mode" LITTLE_ENDIAN
    STATE OFF 0
    STATE ON 1 HAZARDOUS "it moves"
  APPEND_PARAMETER RATE 32 FLOAT MIN MAX 1.5
    REQUIRED
  APPEND_PARAMETER TEXT 32 STRING "ab"
  APPEND_ARRAY_PARAMETER LIST 8 UINT 24 "List"
"""


def test_command_has_the_bytes_of_its_definition() -> None:
    (packet,) = read_definitions(DEFINITIONS, FILE, list[str]().append)
    data = packet.built({"RATE": 2.0, "MODE": "ON", "LIST": [1, 2]})
    assert data.hex() == "1890c00000010300" + "0100" + "40000000" + "61620000" + "010200"
    assert (packet.msg_id, packet.code, packet.hazard({"MODE": "ON"}), packet.hazard({})) == (
        0x1890,
        3,
        "it moves",
        None,
    )


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({}, "requires the parameter RATE"),
        ({"RATE": 1, "MODE": 3}, "not in the valid range of -2 to 2"),
        ({"RATE": 1, "MODE": "OF"}, "did you mean OFF"),
        ({"RATE": 1, "TEXT": "abcde"}, "has 4 bytes, and the value 5"),
        ({"RATE": 1, "LIST": [1, 2, 3, 4]}, "has 3 elements, not 4"),
        ({"RATE": 1, "NO": 1}, "has no item NO"),
    ],
)
def test_command_refuses_wrong_values(values: dict[str, Any], text: str) -> None:
    (packet,) = read_definitions(DEFINITIONS, FILE, list[str]().append)
    with pytest.raises(UsageError, match=text):
        packet.built(values)


def test_item_converts_raw_values() -> None:
    text = """
TELEMETRY T HK LITTLE_ENDIAN "Hk"
  APPEND_ID_ITEM ID 16 UINT 0x0890 "Id" BIG_ENDIAN
  APPEND_ITEM TEMP 16 INT "Temperature"
    POLY_READ_CONVERSION 10 0.5
    FORMAT_STRING "%0.1f"
    UNITS Celsius C
  APPEND_ITEM STEP 8 UINT "Steps"
    SEG_POLY_READ_CONVERSION 0 0 1
    SEG_POLY_READ_CONVERSION 10 100 2
  APPEND_ITEM BITS 4 UINT "Bits"
  APPEND_ITEM MORE 4 UINT "Bits"
    STATE LOW 1
"""
    (packet,) = read_definitions(text, FILE, list[str]().append)
    data = bytes.fromhex("0890" + "fcff" + "0c" + "51")
    read = {name: item.read(data) for name, item in packet.items.items()}
    assert read == {"ID": 0x0890, "TEMP": 8.0, "STEP": 124.0, "BITS": 5, "MORE": "LOW"}
    assert packet.item("TEMP").read(data, "WITH_UNITS") == "8.0 C"
    assert packet.item("TEMP").read(data[:3]) is None


def test_command_words_have_numbers_texts_and_lists() -> None:
    text = "T GO with A 0x10, B 'a, b', C WORD, D [1, 2], E -1.5"
    values = {"A": 16, "B": "a, b", "C": "WORD", "D": [1, 2], "E": -1.5}
    assert command_words((text,)) == ("T", "GO", values)


@pytest.mark.parametrize(
    ("value", "comparison", "result"),
    [
        (5, "== 5", True),
        (5, ">= 4 + 2", False),
        ("A", "!= 'B'", True),
        (None, "> 1", False),
        (3, "in [1, 3]", True),
        (3, "> 1 and < 3", False),
        (7, "& 0x6 == 6", True),
        (1, "& 1 == 0", False),
        (9, "% 4 == 1 and telemetry_value > 8", True),
        (5, "+ 1 in [6, 7]", True),
        (None, "& 1 == 0", False),
        (8, ">> 3 == 1", True),
    ],
)
def test_comparison_holds_for_a_value(value: Any, comparison: str, result: bool) -> None:
    assert holds(value, comparison) is result


@pytest.mark.parametrize(
    ("value", "comparison", "text"),
    [
        (1, "& ", "invalid comparison"),
        (1, "/ 0 == 1", "division"),
        (1, "+ x == 2", "'x'"),
        ("a", "- 1 == 0", "cannot be compared"),
    ],
)
def test_comparison_that_cannot_be_computed_is_refused(value: Any, comparison: str, text: str) -> None:
    with pytest.raises(UsageError, match=text):
        holds(value, comparison)


@pytest.mark.parametrize(
    ("before", "wanted", "after"),
    [
        ("U", "P", "P"),
        ("F", "P", "F"),
        ("P", "F", "F"),
        ("I", "P", "I"),
        ("I", "A", "IA"),
        ("IA", "A", "IA"),
        ("P", "U", "P"),
        ("IA", "F", "F"),
    ],
)
def test_requirement_changes_its_state_as_in_nasa_s_tracker(before: str, wanted: str, after: str) -> None:
    assert next_state(before, wanted) == after


def test_requirements_take_the_states_of_a_tracker() -> None:
    tracker = SimpleNamespace(requirements={"R1": {"state": "P", "events": [{"message": "ok"}]}, "R2": {"state": "U"}})
    found = Requirements()
    found.read_tracker(tracker)
    assert [(each.name, each.state) for each in found.rows()] == [("R1", "P")]


def test_variables_of_ruby_files_are_computed_and_functions_are_not_executed(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    text = "$rows = 9 # of them\n$fields = (($rows + 7) / 8)\n$size = 64\n$name = File.read('x')\n$big = $size == 64\n"
    function = "def set(size)\n  $size = 32\nend\n"
    (tmp_path / "lib" / "globals.rb").write_text(text + function, encoding="utf-8")
    assert ruby_variables([tmp_path]) == {"$rows": 9, "$fields": 2, "$size": 64, "$big": True}


def test_procedure_may_have_the_msg_id_of_a_packet_and_the_number_of_its_target() -> None:
    targets = TargetPackets(Dictionary({}, {}), "CFS-2")
    targets.add([PacketDefinition("CFS-2", "GO", True, 0x1890), PacketDefinition("CFS-2", "HK", False, 0x890)])
    template = Template({"target_name": "CFS-2"}, targets.helper)
    text = "<%= get_cfs_pkt_msg_id('GO', cpu_num_from_target_name(target_name)) %> <%= get_msg_id('HK') %>"
    assert template.render(text, FILE) == f"{0x1890} {0x890}"
    assert template.render("<%= cpu_num_from_target_name(target_name) %>", FILE) == "2"
    assert template.render("<%= cpu_num_from_target_name('CFS') %>", FILE) == ""
    with pytest.raises(UsageError, match="has no telemetry packet STOP"):
        template.render("<%= get_msg_id('STOP') %>", FILE)


def test_values_of_a_group_are_no_tests() -> None:
    class WithValues(ProcedureGroup):
        test_file = "/ram/a"

        def test_b(self) -> None:
            """Do nothing."""

        def script_a(self) -> None:
            """Do nothing."""

    class All(ProcedureSuite):
        def __init__(self) -> None:
            self.add_group(WithValues)

    assert WithValues.scripts() == ["script_a", "test_b"]
    assert [each.script for each in steps_of(All)] == ["script_a", "test_b"]


def _mode_of(command: PacketDefinition, value: Any, **options: bool) -> int:
    return int.from_bytes(command.built({"MODE": value, "RATE": 1.0}, **options)[8:10], "little", signed=True)


def test_raw_command_takes_numbers_of_states_and_no_names() -> None:
    command = next(each for each in read_definitions(DEFINITIONS, FILE, print) if each.name == "GO")
    assert _mode_of(command, "ON") == 1
    assert _mode_of(command, 1, is_raw=True) == 1
    for check_range in (True, False):
        with pytest.raises(UsageError, match="a raw MODE must be a number, not 'ON'"):
            command.built({"MODE": "ON", "RATE": 1.0}, check_range, is_raw=True)


@pytest.mark.parametrize("is_raw", [False, True])
def test_value_that_is_no_state_requires_a_command_without_check_of_ranges(is_raw: bool) -> None:
    command = next(each for each in read_definitions(DEFINITIONS, FILE, print) if each.name == "GO")
    with pytest.raises(UsageError, match="MODE = 2 is not one of the states OFF 0, ON 1"):
        command.built({"MODE": 2, "RATE": 1.0}, is_raw=is_raw)
    assert _mode_of(command, 2, check_range=False, is_raw=is_raw) == 2
