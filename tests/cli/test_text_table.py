"""Tables and paragraphs on terminals: they fit the width of a terminal; in a file, nothing is left out."""

from __future__ import annotations

import io
import re

import pytest

from cfepy.cli.text_table import Table, fitting, show_paragraph, show_tables


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def messages() -> Table:
    table = Table("Messages", ("MsgId", "name", "sent", "dropped", "why", "Hz"), right=(2, 3, 5), least=(0, 3))
    table.add("0x0910", "/a_robot/with/names/of_some_length", 19_449, 49, "49 pipe full", "1002.5")
    table.add("0x0911", "/b", 3, 0, "", "0.9")
    table.note = "a note that says more about the table than there is room for on one line of a terminal of 60"
    return table


@pytest.mark.parametrize("width", [40, 60, 80, 120])
def test_a_table_is_no_wider_than_the_terminal(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    terminal = Terminal()
    show_tables([messages()], terminal)
    shown = re.sub(r"\x1b\[[\d;]*m", "", terminal.getvalue())
    assert max(len(line.rstrip()) for line in shown.splitlines()) <= width
    assert "19,449" in shown  # numbers are not folded


def test_what_is_left_out_first() -> None:
    table = messages()
    assert fitting(table, 120) == [0, 1, 2, 3, 4, 5]
    assert fitting(table, 65) == [1, 2, 3, 4, 5]
    assert fitting(table, 50) == [1, 2, 4, 5]
    assert fitting(table, 10) == [1, 2, 4, 5]  # the others are wanted in any case
    empty = Table("Applications", ("name", "died of", "CPU"), right=(2,))
    empty.add("HK", "", "0.1 %")
    assert fitting(empty, 80) == [0, 1, 2]
    assert fitting(empty, 16) == [0, 2]  # an empty column is dropped first


def test_a_file_has_all_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "40")
    file = io.StringIO()
    show_tables([messages()], file)
    assert "0x0910  /a_robot/with/names/of_some_length  19,449       49  49 pipe full  1002.5\n" in file.getvalue()


def test_a_paragraph_ends_its_lines_between_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "20")
    text = "1.000 virtual s in 0.440 s: 2.3 x real time\nand more"
    terminal, file = Terminal(), io.StringIO()
    show_paragraph(text, terminal)
    show_paragraph(text, file)
    assert terminal.getvalue() == "1.000 virtual s in\n0.440 s: 2.3 x real\ntime\nand more\n"
    assert file.getvalue() == f"{text}\n"
