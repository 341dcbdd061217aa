"""Syntax trees, also while garbage is waiting whose finalizer makes another."""

from __future__ import annotations

import ast
import gc

import pytest

from cfepy.interpreter.syntax_trees import TooDeepError, parsed, parsed_input
from cfepy.reading.input_limits import PYTHON_DEPTH, PYTHON_WORDS

SOURCE = "\n".join(f"def f{number}(a, b=[1, (2, 3)]):\n    return a + b[{number}]" for number in range(200))


class Circle:
    """Garbage that parses in its finalizer, as a logged traceback does."""

    def __init__(self) -> None:
        self.me = self

    def __del__(self) -> None:
        ast.parse("x = [1, 2]")


def test_finalizer_that_parses_does_not_interfere() -> None:
    before = gc.get_threshold()
    gc.set_threshold(5)
    try:
        for _ in range(20):
            Circle()
            assert len(parsed(SOURCE).body) == 200
    finally:
        gc.set_threshold(*before)


def test_the_name_of_the_file_and_the_mode() -> None:
    with pytest.raises(SyntaxError) as caught:
        parsed("x = = 1", "app.py")
    assert caught.value.filename == "app.py"
    assert isinstance(parsed("1 + 2", mode="eval").body, ast.BinOp)


@pytest.mark.parametrize("text", ["x" + ".a" * 20_000, "x" + "()" * 20_000, "-" * 20_000 + "1", "not " * 20_000 + "x"])
def test_source_nested_too_deeply_is_a_syntax_error(text: str) -> None:
    for parse in (parsed, parsed_input):
        with pytest.raises(TooDeepError, match="is nested too deeply"):
            parse(text)


@pytest.mark.slow
def test_limits_apply_to_parsed_input() -> None:
    attributes = PYTHON_DEPTH - 5
    assert parsed_input(f"x{'.a' * attributes}").body
    with pytest.raises(TooDeepError, match=r"more than 50 levels") as caught:
        parsed_input(f"x\nx{'.a' * attributes}", "app.py", depth=50)
    assert (caught.value.filename, caught.value.lineno) == ("app.py", 2)
    assert parsed_input("x\n" * PYTHON_WORDS).body
    with pytest.raises(SyntaxError, match="words and signs"):
        parsed_input("x\n" * (PYTHON_WORDS + 1))
    with pytest.raises(SyntaxError, match="words and signs"):
        parsed_input(b"f(a)\n" * PYTHON_WORDS)
