"""Syntax trees, also when garbage is waiting whose finalizer makes another."""

from __future__ import annotations

import ast
import gc

import pytest

from cfepy.syntax_trees import parsed

SOURCE = "\n".join(f"def f{number}(a, b=[1, (2, 3)]):\n    return a + b[{number}]" for number in range(200))


class Circle:
    """Garbage that parses when it goes, as a logged traceback does."""

    def __init__(self) -> None:
        self.me = self

    def __del__(self) -> None:
        ast.parse("x = [1, 2]")


def test_a_finalizer_that_parses_is_not_in_the_way() -> None:
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
