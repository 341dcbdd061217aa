"""Headers of configurations: what a cfg script describes, in C++."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.convert.configurations import configuration_headers
from cfepy.convert.packages import CppPackage, Program
from cfepy.status import UsageError

SCRIPT = """
from dynamic_reconfigure.parameter_generator_catkin import *
gen = ParameterGenerator()
gen.add("count", int_t, 1, "How many", 50, 0, 100)
gen.add("gain", double_t, 2, "How much", .5, 0)
gen.add("title", str_t, 4, "A \\\\ in a text", "Hello")
size = gen.enum([gen.const("Large", int_t, 2, "large")], "sizes")
inner = gen.add_group("inner", type="tab")
inner.add("on", bool_t, 8, "Whether", True)
exit(gen.generate("demo", "demo", "Tune"))
"""


@pytest.fixture
def program(tmp_path: Path) -> Program:
    (tmp_path / "cfg").mkdir()
    (tmp_path / "cfg/Tune.cfg").write_text(SCRIPT)
    return Program(CppPackage("demo", tmp_path), "node")


def test_a_script_becomes_a_class(program: Program) -> None:
    found = configuration_headers(["ros/ros.h", "demo/TuneConfig.h", "other/TuneConfig.h", "demo/NoConfig.h"], program)
    assert list(found) == ["demo/TuneConfig.h"]
    text = found["demo/TuneConfig.h"]
    assert "class TuneConfig" in text
    assert "    std::string title;" in text
    assert (
        'visitor(config.count, roscfe::ConfigParameter<int>{"count", "int", 1u, "How many", "", (50), (0), (100), 0});'
        in text
    )
    assert "std::numeric_limits<double>::infinity()" in text
    assert '{"inner", "tab", 0, 1, true},' in text
    assert "        groups.inner.on = on;" in text
    assert "constexpr int Tune_Large = (2);" in text


def test_a_script_that_fails_is_told(program: Program) -> None:
    script = program.package.folder / "cfg/Tune.cfg"
    script.write_text("raise ValueError('no such gain')")
    with pytest.raises(UsageError, match=r"cfg/Tune.cfg: failed: ValueError: no such gain"):
        configuration_headers(["demo/TuneConfig.h"], program)
    script.write_text("from dynamic_reconfigure.parameter_generator_catkin import *\n")
    with pytest.raises(UsageError, match="it did not call generate"):
        configuration_headers(["demo/TuneConfig.h"], program)
