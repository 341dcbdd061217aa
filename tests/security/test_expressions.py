"""Expressions of launch files: evaluated as by roslaunch, or ended with an error without delay."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.reading.input_limits import EXPRESSION_BITS, EXPRESSION_CHARACTERS
from rospy_shim.roslaunch.substitution import SubstitutionError, Substitutions, World
from rospy_shim.types.angles import degrees, radians
from rospy_shim.types.expression import ExpressionError, value_of


def evaluated(text: str) -> str:
    world = World({"HOME": "/home/me"}, lambda name: None, lambda name: f"{name}_1", [0])
    given = {"x": "3", "y": "2.5", "s": "hello,world", "n": "true"}
    return Substitutions(world, Path("/a/b.launch"), given, {}).resolve(f"$(eval {text})")


@pytest.mark.parametrize(
    ("text", "value"),  # values of roslaunch 1.15.14 (`roslaunch.substitution_args.resolve_args`)
    [
        ("x * y + 1", "8.5"),
        ("arg('x') ** 2 // 2", "4"),
        ("n and not x == 4", "True"),
        ("true if s.startswith('hello') else false", "True"),
        ("s.split(',')[1].upper()", "WORLD"),
        ("env('HOME') + optenv('NOT_SET', '/d')", "/home/me/d"),
        ("dirname() + '/c'", "/a/c"),
        ("'%s-%03d' % (s, x)", "hello,world-003"),
        ("'{} {:.2f}'.format(x, pi)", "3 3.14"),
        ("f'{x + 1}'", "4"),
        ("[i * x for i in [1, 2, 3] if i != 2]", "[3, 9]"),
        ("list(map(int, '3,1'.split(',')))", "[3, 1]"),
        ("max([1, 5, 2]) + min(4, 3) + len(s) + abs(-1)", "20"),
        ("{'a': 1, 'b': 2}['b']", "2"),
        ("1 < x <= 3 and 'll' in s", "True"),
        ("sqrt(16) + pow(2, 3) + radians(180) - pi", "12.0"),
        ("sorted([3, 1, 2], reverse=True)[:2]", "[3, 2]"),
        ("-x if x is not None else 0", "-3"),
        ("str(int('7') << 2) + repr('a')", "28'a'"),
    ],
)
def test_expression_has_the_value_of_roslaunch(text: str, value: str) -> None:
    assert evaluated(text) == value


@pytest.mark.parametrize(
    "text",
    [
        "9**9**9",
        "1 << 10**9",
        "'ab' * 10**9",
        "[[0] * 9999] * 9999",
        "'x'.replace('', 'y' * 9999).replace('y', 'z' * 9999)",
        "'%*d' % (10**9, 1)",
        "'%((a))999999999d' % {'(a)': 1}",
        "f'{1:{10**9}}'",
        "'{:{}}'.format(1, 10**9)",
        "set(range(0, 10**6 * (2**61 - 1), 2**61 - 1))",
        "sum([[1] * 9999 for i in range(999)], [])",
        "prod([2**8000] * 9999)",
        "lcm(*[2**i + 1 for i in range(4000)])",
        "round(5, -10**9)",
        "factorial(factorial(20))",
        "str([s] * 9999 * 9999)",
        "'a'.center(10**9)",
        "'a'.join(['b' * 9999] * 9999)",
        "max(map(len, [s * i for i in range(9999)]))",
    ],
)
def test_endless_expression_is_refused(text: str) -> None:
    with pytest.raises(SubstitutionError, match=r"\$\(eval"):
        evaluated(text)


@pytest.mark.parametrize(
    "text",
    [
        "s.__class__",
        "s.format_map({})",
        "int.from_bytes",
        "(lambda: 0)()",
        "(y := 1)",
        "[*s][0].x",
        "b'a'",
        "...",
        "print(1)",
    ],
)
def test_forbidden_expression_is_refused(text: str) -> None:
    with pytest.raises(SubstitutionError):
        evaluated(text)


def test_expression_beyond_its_limits_is_refused() -> None:
    assert value_of(f"(1 << {EXPRESSION_BITS - 1}) > 0", {}) is True
    with pytest.raises(ExpressionError, match="bits"):
        value_of(f"1 << {EXPRESSION_BITS}", {})
    with pytest.raises(ExpressionError, match="characters"):
        value_of("1" * (EXPRESSION_CHARACTERS + 1), {})
    with pytest.raises(ExpressionError, match="inside each other"):
        value_of("(" * 90 + "1" + ")" * 90 + "+ 1" * 70, {})


def test_text_that_differs_between_runs_is_refused() -> None:
    for text in ("{'a', 'b'}", "map(str, s)", "[len]", "env"):
        with pytest.raises(SubstitutionError, match="converts"):
            evaluated(text)


def test_angles() -> None:
    assert radians("rad(pi/2)") == pytest.approx(1.5707963)
    assert degrees("deg(90)") == radians("pi / 2")
    with pytest.raises(NameError):
        radians("open('/tmp/x')")
    with pytest.raises(ValueError, match="could not convert"):
        degrees("deg(90/2)")
