"""f-strings of Python 3.12 in procedures, on every release of Python that cfepy supports."""

from __future__ import annotations

import ast

import pytest

from cfepy.extra.procedures.procedure_loader import without_new_f_strings

NAMES = {"a": "x y", "values": {"k": 3}, "b": 2}


@pytest.mark.parametrize(
    ("source", "value"),
    [
        ('f"/ram/{"a b".replace(" ", "_")}/c"', "/ram/a_b/c"),
        ("f'{values['k']}-{b:>3}'", "3-  2"),
        ('f"{{{b}}} {f"{a}" + "z"}"', "{2} x yz"),
        ('"no # comment" + f"{b}"  # it\'s {one}', "no # comment2"),
        ("rf'\\d{values['k']}' + '\\''", "\\d3'"),
        ('f"""{a} "quoted" {"t"}"""', 'x y "quoted" t'),
    ],
)
def test_text_inside_of_an_f_string_may_have_its_quotes(source: str, value: str) -> None:
    assert eval(compile(ast.parse(without_new_f_strings(source), mode="eval"), "a.py", "eval"), dict(NAMES)) == value


@pytest.mark.parametrize("source", ['f"{"it\'s".title()}"', 'f"{a', "'open\n", 'f"{"\\n".join(a)}"'])
def test_source_without_an_older_form_stays(source: str) -> None:
    assert without_new_f_strings(source) == source


def test_source_without_nested_quotes_stays() -> None:
    source = 'def f(x):\n    """Say "it"."""\n    return f"{x["a"]}" if x else \'{"\'  # f"\n'
    assert without_new_f_strings(source) == source.replace('x["a"]', "x['a']")
