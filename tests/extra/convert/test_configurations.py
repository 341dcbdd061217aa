"""Headers of configurations: the description of a cfg script, in C++."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cfepy.extra.convert.configurations import configuration_headers
from cfepy.extra.convert.cpp_package import CppPackage, Program
from cfepy.status import UsageError
from dev.convert.node_flights import mission_of
from dev.roscfe.building import needs_cpp

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
    (tmp_path / "cfg/Tune.cfg").write_text(SCRIPT, encoding="utf-8")
    return Program(CppPackage("demo", tmp_path), "node")


def test_a_script_becomes_a_class(program: Program) -> None:
    found = configuration_headers(["ros/ros.h", "demo/TuneConfig.h", "other/TuneConfig.h", "demo/NoConfig.h"], program)
    assert list(found) == ["demo/TuneConfig.h"]
    text = found["demo/TuneConfig.h"]
    assert "class TuneConfig" in text
    assert "    std::string title;" in text
    assert (
        'visitor(config.count, roscfe::ConfigParameter<int>{"count", "int", 1u, "How many", "", (50), (0), (100), 1});'
        in text
    )
    assert "std::numeric_limits<double>::infinity()" in text
    assert '{"inner", "tab", 0, 1, true},\n            roscfe::ConfigGroup{"Default", "", 0, 0, true},' in text
    assert "        groups.inner.on = on;" in text
    assert "constexpr int Tune_Large = (2);" in text


def test_failed_cfg_script_is_reported(program: Program) -> None:
    script = program.package.folder / "cfg/Tune.cfg"
    script.write_text("raise ValueError('no such gain')", encoding="utf-8")
    with pytest.raises(UsageError, match=r"cfg/Tune.cfg: failed: ValueError: no such gain"):
        configuration_headers(["demo/TuneConfig.h"], program)
    script.write_text("from dynamic_reconfigure.parameter_generator_catkin import *\n", encoding="utf-8")
    with pytest.raises(UsageError, match="it did not call generate"):
        configuration_headers(["demo/TuneConfig.h"], program)


UPDATED = "[('Default', True, 0, 0), ('Outer', True, 1, 0), ('Inner', True, 3, 1), ('Other', True, 2, 0)]"
CLOSED = UPDATED.replace("True", "False", 1)
SAID_BESIDE_ROSCPP = f"""
GROUP Inner  [('on', 'bool', 4)] 1 3
GROUP Outer tab [('gain', 'double', 2)] 0 1
GROUP Other  [('title', 'str', 8)] 0 2
GROUP Default  [('count', 'int', 1), ('last', 'int', 16)] 0 0
MAX [('on', True), ('count', 100), ('last', 2147483647), ('title', ''), ('gain', 2.0)] {UPDATED}
MIN [('on', False), ('count', 0), ('last', -2147483648), ('title', ''), ('gain', 0.0)] {UPDATED}
DFLT [('on', True), ('count', 5), ('last', 1), ('title', 'hello'), ('gain', 0.5)] {UPDATED}
UPDATE [('on', True), ('count', 5), ('last', 2), ('title', 'hello'), ('gain', 0.5)] {UPDATED}
ANSWER [('on', True), ('count', 100), ('last', 2), ('title', 'hello'), ('gain', 0.0)] {UPDATED}
ANSWER [('on', True), ('count', 1), ('last', 2), ('title', 'hello'), ('gain', 0.0)] {UPDATED}
ANSWER [('on', True), ('count', 3), ('last', 2), ('title', 'hello'), ('gain', 0.0)] {UPDATED}
ANSWER [('on', False), ('count', 3), ('last', 2), ('title', 'hello'), ('gain', 0.0)] {UPDATED}
ANSWER [('on', False), ('count', 3), ('last', 2), ('title', 'hello'), ('gain', 0.0)] {CLOSED}
ANSWER [('on', False), ('count', 3), ('last', 2), ('title', 'hello'), ('gain', 0.0)] {UPDATED}
ANSWER [('on', False), ('count', 3), ('last', 2), ('title', 'hello'), ('gain', 0.0)] {UPDATED}
ANSWER [('on', False), ('count', 13), ('last', 2), ('title', 'hello'), ('gain', 0.0)] {UPDATED}
ANSWER [('on', False), ('count', 14), ('last', 2), ('title', 'bye'), ('gain', 0.0)] {UPDATED}
"""
UNEXPECTED = "ERROR TuneConfig::__fromMessage__ called with an unexpected parameter."
LOGGED_BY_ROSCPP = f"""
INFO level ffffffff: 5 0.5 hello 1 1, groups 1 0 0 1
WARN updateConfig() called on a dynamic_reconfigure::Server that provides its own mutex.
INFO level 3: 100 0 hello 1 2, groups 1 1 1 1
{UNEXPECTED}
ERROR Booleans:
ERROR Integers:
ERROR   count
ERROR   count
ERROR Doubles:
ERROR Strings:
INFO level 1: 1 0 hello 1 2, groups 1 1 1 1
{UNEXPECTED}
ERROR Booleans:
ERROR Integers:
ERROR   count
ERROR   none
ERROR Doubles:
ERROR Strings:
ERROR   on
INFO level 1: 3 0 hello 1 2, groups 1 1 1 1
{UNEXPECTED}
ERROR Booleans:
ERROR   on
ERROR   last
ERROR Integers:
ERROR Doubles:
ERROR   more
ERROR Strings:
INFO level 4: 3 0 hello 0 2, groups 1 1 1 1
INFO level 0: 3 0 hello 0 2, groups 0 1 1 1
INFO level 0: 3 0 hello 0 2, groups 1 1 1 1
INFO level 0: 3 0 hello 0 2, groups 1 1 1 1
INFO level 1: 13 0 hello 0 2, groups 1 1 1 1
WARN Reconfigure callback failed with exception not thirteen:
INFO level 9: 14 0 bye 0 2, groups 1 1 1 1
WARN Reconfigure callback failed with unprintable exception.
"""
"""What both printed with Debian's dynamic_reconfigure 1.7.3; the second warning without its further sentences."""


@needs_cpp
@pytest.mark.slow
def test_reconfigure_server_logs_the_same_as_roscpp() -> None:
    with mission_of("tuned") as mission:
        mission.run_for(5)
        lines = mission.console.lines
    of_node = (re.fullmatch(r"\[/tuned\] \[ *(\w+)\] \[[\d.]+\]: (.*)", line) for line in lines)
    logged = [f"{each[1]} {each[2]}".partition(" This can")[0].rstrip() for each in of_node if each]
    assert logged == LOGGED_BY_ROSCPP.strip().splitlines()
    said = [line.removeprefix("[tuner] ") for line in lines if line.startswith("[tuner] ")]
    assert said == SAID_BESIDE_ROSCPP.strip().splitlines()
