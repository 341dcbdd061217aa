"""docs/how_to/testing.md is true: its examples are tests of the example package, and pass."""

from __future__ import annotations

import re
import shutil

import pytest

from cfepy.testing import Flight
from tests.testing.test_example_package import PROBE, ROOT

TEXT = (ROOT / "docs/how_to/testing.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```python\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)


@pytest.mark.slow
def test_examples_of_the_page_pass(pytester: pytest.Pytester, loaded: None) -> None:
    tests = pytester.path / "tests"
    shutil.copytree(PROBE / "mission", pytester.path / "mission")
    tests.mkdir()
    for number, example in enumerate(EXAMPLES):
        (tests / f"test_example_{number}.py").write_text(example, encoding="utf-8")
    result = pytester.runpytest_inprocess("-p", "cfepy.testing.plugin", "--cfepy-tasks", "greenlet")
    assert result.parseoutcomes() == {"passed": sum(example.count("def test_") for example in EXAMPLES)}
    assert len(EXAMPLES) >= 6


def test_names_of_the_page_exist(pytester: pytest.Pytester) -> None:
    for name in re.findall(r"`flight\.(\w+)", TEXT):
        assert hasattr(Flight, name) or name in ("mission",), name
    told = pytester.runpytest_inprocess("-p", "cfepy.testing.plugin", "--help").stdout.str()
    for option in re.findall(r"`(--cfepy-\w+)", TEXT):
        assert option in told
