"""The kinds of inputs: samples of each, and a reader that reads as the commands do."""

from __future__ import annotations

import io
import json
import subprocess
from collections.abc import Callable, Iterator
from contextlib import redirect_stdout, suppress
from functools import cache
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from cfepy.cli.ros.rostest import read_results as read_test_results
from cfepy.es.startup_script import check, entries
from cfepy.extra.c.engine import compiler
from cfepy.extra.c.toolchain.source_files import find_sources
from cfepy.extra.convert.catkin_reader import TESTING
from cfepy.extra.convert.cpp_sources import collect, main_form
from cfepy.extra.convert.node_check.source import read_source
from cfepy.extra.convert.output import write_files
from cfepy.extra.convert.packages import program_of, read_package
from cfepy.extra.convert.project import cmake_word
from cfepy.extra.convert.source_names import SourceNames, names_of
from cfepy.extra.debugger.breakpoints import breakpoints
from cfepy.extra.exploration.results_file import read_failures, read_results
from cfepy.extra.exploration.verdict import Failure, Verdict
from cfepy.faults.fault_plan import read_plan
from cfepy.ground.bag import BagReader
from cfepy.ground.cfe_files import table_yaml
from cfepy.ground.cfe_files.dump_files import read_dump
from cfepy.ground.cfe_files.table_file import defects_of, document, take_apart
from cfepy.ground.dictionary import Dictionary, dictionary_of, table_types
from cfepy.ground.fields import steps_of, value_at
from cfepy.ground.mission_names import constants_in
from cfepy.ground.parameters import of_files
from cfepy.ground.recording import summary_of
from cfepy.ground.values import packet_of
from cfepy.ground.xtce import xtce_of
from cfepy.journal import read_journal
from cfepy.mission import MissionSpec, read_mission
from cfepy.mission import app_sources as sources
from cfepy.mission.mission_file import read_mission_file
from cfepy.mission.mission_lookup import read_lock
from cfepy.monitors import read_demands
from cfepy.msg import Layout, Telemetry
from cfepy.pilot.determinism_look import suspects
from cfepy.pilot.mission_check import check_mission
from cfepy.pilot.mission_check.cfe_names import wrong_names
from cfepy.psp.profile import load_profile
from cfepy.reading.marked_yaml import load
from cfepy.reading.mistakes import Mistakes, collected
from cfepy.reading.plain_xml import XmlError, plain_xml
from cfepy.reading.plain_yaml import YamlError
from cfepy.schedules import Schedule
from cfepy.script.text import parse_script, read_script
from cfepy.status import CfeError, UsageError
from dev.fuzz import dictionary_files, servers
from dev.fuzz.cds_board import Board
from rospy_shim.roslaunch.reader import read
from rospy_shim.roslaunch.values import from_yaml
from rospy_shim.types.expression import ExpressionError, plain_text, value_of
from rospy_shim.types.msgs import Packages, check_definitions
from rospy_shim.types.msgs.definition_sources import Definition, Texts
from rospy_shim.types.msgs.library import Library, from_full_text, shipped

ROOT = Path(__file__).parents[2]
DATA = ROOT / "tests/data"
REFUSED = (UsageError, CfeError)
APPLICATION = """
unsigned long strlen(const char *text);
int CFE_ES_WriteToSysLog(const char *format, ...);
int OS_TaskDelay(unsigned milliseconds);
void BUG_Main(void) { CFE_ES_WriteToSysLog("%d", (int)strlen("text")); OS_TaskDelay(10); }
"""


class Kind(NamedTuple):
    """A kind of inputs: its `samples`, and the reader of an input that was written to a file named `file`."""

    name: str
    samples: Callable[[], list[bytes]]
    attempt: Callable[[bytes, Path], object]
    file: str = "input"


@cache
def spec() -> MissionSpec:
    """Return a mission with nodes and applications."""
    return read_mission("capture")


@cache
def dictionary() -> Dictionary:
    """Return the ground's dictionary of the mission."""
    return dictionary_of(spec())


def files(*patterns: str) -> Callable[[], list[bytes]]:
    """Return samples from the repository. Large files are left out."""

    def found() -> list[bytes]:
        paths = sorted({path for pattern in patterns for path in ROOT.glob(pattern)})
        return [path.read_bytes() for path in paths if path.stat().st_size < 200_000]

    return found


def texts(*found: str) -> Callable[[], list[bytes]]:
    """Return samples written in this module."""
    return lambda: [text.encode() for text in found]


# -- readers -----------------------------------------------------------------------------------------------------------


def startup(data: bytes, path: Path) -> None:
    """A startup script, as the boot and the check read it."""
    entries(data)
    check(data)


@cache
def shared_objects() -> list[bytes]:
    """Return compiled applications, or none without a compiler."""
    if which(compiler()[0]) is None:
        return [b"\x7fELF, but not more"]
    with TemporaryDirectory() as folder:
        source, made = Path(folder, "BUG.c"), Path(folder, "BUG.so")
        source.write_text(APPLICATION, encoding="utf-8")
        found = []
        for level in ("-O0", "-O2"):
            command = [*compiler(), "-shared", "-fPIC", "-g", "-fno-builtin", level, str(source), "-o", str(made)]
            subprocess.run(command, check=True)
            found.append(made.read_bytes())
        return found


def shared_object(data: bytes, path: Path) -> None:
    path.write_text("CFE_APP, BUG, BUG_Main, BUG, 50, 16384, 0x0, 0;\n!", encoding="utf-8")
    path.with_name("BUG.so").write_bytes(data)
    check_mission(str(path.parent))


def mission_file(data: bytes, path: Path) -> None:
    """Read a mission file with all its sections, as a check and as a run read it."""
    mistakes = Mistakes()
    read_demands(read_mission_file(path, mistakes).demands, mistakes)
    collected(lambda mistakes: read_demands(read_mission_file(path, mistakes).demands, mistakes))


def mission(data: bytes, path: Path) -> None:
    """A mission's folder, as `cfepy check` looks at it."""
    (path.parent / "startup.scr").write_bytes(b"CFE_APP, hk, HK_AppMain, HK, 90, 16384, 0x0, 0;\n!\n")
    check_mission(str(path.parent))


def launch(data: bytes, path: Path) -> None:
    """A launch file, as a check and as a run read it."""
    read(path, {"given": "1"}, Packages(path.parent, {}), {"HOME": "/home/me"}, Mistakes())
    read(path, {"given": "1"}, Packages(path.parent, {}), {"HOME": "/home/me"})


def parameters(data: bytes, path: Path) -> None:
    """YAML of parameters, in a launch file and as a file."""
    problems: list[str] = []
    with suppress(YamlError):  # which the launch file's reader turns into a mistake
        from_yaml(data.decode("utf-8", "replace"))
    of_files(path, problems)


def expression(data: bytes, path: Path) -> None:
    """Evaluate an expression of a launch file. Exceptions of Python itself become cfepy's error."""
    with suppress(ExpressionError, SyntaxError, ArithmeticError, TypeError, ValueError, LookupError, NameError):
        plain_text(value_of(data.decode("utf-8", "replace"), {"x": 3, "s": "a,b"}))


def definition(data: bytes, path: Path) -> None:
    """A message definition, made a class, filled and read."""
    text = data.decode("utf-8", "replace")
    library = Library([Texts({"fuzz/Message": Definition(text, "Message.msg")})], base=shipped())
    made = library.message_class("fuzz/Message")
    buffer = io.BytesIO()
    made().serialize(buffer)
    made().deserialize(buffer.getvalue())


def service(data: bytes, path: Path) -> None:
    """Definitions of services and actions, as a check of a package reads them."""
    folder = path.parent
    for kind in ("srv", "action"):
        (folder / kind).mkdir(exist_ok=True)
        (folder / kind / f"Thing.{kind}").write_bytes(data)
    (folder / "package.xml").write_text("<package><name>fuzz</name></package>", encoding="utf-8")
    list(check_definitions(Packages(folder / "x.py", {}), [folder.name, "fuzz"]))


def full_text(data: bytes, path: Path) -> None:
    """The definition that a bag or a publisher brings."""
    from_full_text("fuzz/Message", data.decode("utf-8", "replace")).message_class("fuzz/Message")()


TYPES = ("std_msgs/String", "sensor_msgs/JointState", "tf2_msgs/TFMessage", "diagnostic_msgs/DiagnosticArray")


def message(data: bytes, path: Path) -> None:
    """Read the bytes of a message. The first byte selects the type."""
    from rospy_shim.types.genpy import DeserializationError

    made = shipped().message_class(TYPES[data[0] % len(TYPES)] if data else TYPES[0])()
    with suppress(DeserializationError):
        made.deserialize(data[1:])
        made.serialize(io.BytesIO())


def table(data: bytes, path: Path) -> None:
    """A table file: shown, written as YAML, verified."""
    find = table_types(None, []).get
    list(defects_of(data, find))
    found = take_apart(data, find, str(path))
    table_yaml.write(document(found))
    list(found.leaves())


def table_text(data: bytes, path: Path) -> None:
    """A table in YAML, built."""
    table_yaml.read(path, table_types(None, []).get).pack()


def dump(data: bytes, path: Path) -> None:
    """A file that cFE wrote, shown."""
    from cfepy.cli.files.log import run

    read_dump(data, str(path))
    with redirect_stdout(io.StringIO()):
        run(_words("log", str(path)))


def bag(data: bytes, path: Path) -> None:
    """A bag with all its messages."""
    with BagReader(str(path)) as found:
        for _ in found.messages():
            pass


def recording(data: bytes, path: Path) -> None:
    """Read an MCAP file with all its messages, and recover it."""
    summary_of(str(path))
    bag(data, path)


def journal(data: bytes, path: Path) -> None:
    """A journal: shown by `--info`, its files unpacked."""
    from cfepy.cli.journal.replay import show_info
    from cfepy.journal import staged

    found = read_journal(path)
    show_info(found, io.StringIO())
    with staged(found):
        pass


def results(data: bytes, path: Path) -> None:
    """The results file of an exploration."""
    for _, verdict in read_results(path)[1]:
        Verdict.from_dict(verdict)
    read_failures(path)


def schedule(data: bytes, path: Path) -> None:
    """The text of a schedule."""
    Schedule.parse(data.decode("utf-8", "replace")).policy()


def script(data: bytes, path: Path) -> None:
    """A script of commands and expectations."""
    read_script(path, spec(), dictionary())


def typed(data: bytes, path: Path) -> None:
    """Lines that are typed at the console."""
    for line in data.decode("utf-8", "replace").split("\n")[:20]:
        parse_script(line, "typed", spec(), dictionary())


def faults(data: bytes, path: Path) -> None:
    """A fault plan."""
    read_plan(path).to_dict()


def lock(data: bytes, path: Path) -> None:
    """A lock file of MsgIds."""
    read_lock(path, spec().ros)


def board(data: bytes, path: Path) -> None:
    """A board's profile."""
    load_profile(path)


def words(data: bytes, path: Path) -> None:
    """Parse words of `cfepy cmd`. The first word names the command."""
    commands = list(dictionary().commands.values())
    given = data.decode("utf-8", "replace").split("\n")
    packet_of(commands[len(given[0]) % len(commands)], given[1:])


def telemetry(data: bytes, path: Path) -> None:
    """Packets that arrive from somewhere."""
    for declared in dictionary().telemetry.values():
        with suppress(*REFUSED):
            if isinstance(declared, Telemetry):
                declared.read(data)


def paths(data: bytes, path: Path) -> None:
    """Paths of fields."""
    made = shipped().message_class("sensor_msgs/JointState")()
    made.position = [1.0, 2.0]
    for line in data.decode("utf-8", "replace").split("\n"):
        with suppress(LookupError):  # the commands report this
            value_at(made, steps_of(line))


def breaks(data: bytes, path: Path) -> None:
    """Parse the value of `--break`."""
    breakpoints(data.decode("utf-8", "replace").split("\n"), spec(), lambda *_: None)


def junit(data: bytes, path: Path) -> None:
    """Results that a test program wrote."""
    with suppress(ValueError):  # the command reports this
        read_test_results(path, "suite")


def manifest(data: bytes, path: Path) -> None:
    """A package's manifest, where packages are looked for."""
    (path.parent / "package.xml").write_bytes(data)
    (path.parent / "setup.py").write_bytes(data)
    list(Packages(path.parent / "x.py", {}).names())


def cmake_lists(data: bytes, path: Path) -> None:
    """A CMakeLists.txt, of a catkin package and of an application of cFS."""
    (path.parent / "src").mkdir(exist_ok=True)
    for name in ("src/one.cpp", "src/two.c", "one.cpp"):
        (path.parent / name).write_text("int a;\n", encoding="utf-8")
    package = read_package(path.parent, "demo", TESTING)
    for node_type in (*package.executables(), *package.nodelets()):
        with suppress(UsageError):
            program = program_of(package, node_type, Packages(path, {}))
            for word in program.definitions:
                cmake_word(word, path)
    with suppress(UsageError):
        find_sources(path.parent)


def package_manifest(data: bytes, path: Path) -> None:
    """A package.xml, and a file of plugins."""
    (path.parent / "plugins.xml").write_bytes(data)
    (path.parent / "CMakeLists.txt").write_text("add_library(n n.cpp)\n", encoding="utf-8")
    package = read_package(path.parent, "demo")
    package.executables()
    package.nodelets()
    with suppress(XmlError):
        plain_xml(data)


def cpp_source(data: bytes, path: Path) -> None:
    """A source of a node in C++."""
    found = collect([path], [path.parent])
    names_of(SourceNames(list(found.texts.values()), {"p": "x"}).used(), "/", "/n", [])
    with suppress(UsageError):
        main_form([path], path)
    read_source(path, data)


def python_source(data: bytes, path: Path) -> None:
    """A source in Python, as checks look into it."""
    if sources.syntax_error(path) is None:
        list(wrong_names(path, "A_Main"))
        sources.defines(path, "A_Main")
    suspects(str(path))
    list(constants_in(path))


def output_list(data: bytes, path: Path) -> None:
    """Read the list of files that `cfepy convert` wrote the last time."""
    with suppress(OSError):  # the command reports this, such as a name that is too long
        write_files(path.parent, {"a/b": b"1"}, force=True)


def names(data: bytes, path: Path) -> None:
    """A mission's name and descriptions in XTCE, which any XML reader must take."""
    from xml.etree import ElementTree

    name = data.decode("utf-8", "surrogateescape")
    few = Dictionary()
    few.add([Telemetry(name, 0x0801, Layout(name, [(name, "uint8")]))])
    text = xtce_of(name, few)
    ElementTree.fromstring(text.encode("utf-8"))


def yaml_file(data: bytes, path: Path) -> None:
    """Read any YAML file with line numbers of its values."""
    load(path).plain()


def _words(*given: str) -> Any:
    from cfepy.cli.main import parser_for

    return parser_for(given).parse_args(given)


def cds_image(data: bytes, path: Path) -> None:
    """Use the memory of the Critical Data Store after a processor reset, with everything found in it."""
    board = Board()
    board.memory[:] = data[: len(board.memory)].ljust(len(board.memory), b"\0")
    store = board.boot()
    for block in list(store):
        with suppress(CfeError):
            store.read(block.handle)
        with suppress(CfeError):
            store.write(block.handle, bytes(block.user_size))
    with suppress(CfeError):
        store.write(store.register(40, "NEW.Block", is_table=False)[0], bytes(40))


# -- samples -----------------------------------------------------------------------------------------------------------


def journals() -> list[bytes]:
    """Return the journal of a short run, with files of its mission."""
    from dev.fuzz.sample_journal import sample

    return [sample()]


def cds_images() -> list[bytes]:
    """Return images of CDS memory with blocks."""
    board = Board()
    for size, name in ((10, "APP.One"), (200, "APP.Two"), (33, "TBL.Three")):
        handle = board.cds.register(size, name, name.startswith("TBL"))[0]
        board.cds.write(handle, bytes(range(size)))
    board.cds.delete("APP.Two")
    return [bytes(board.memory)]


def packets() -> list[bytes]:
    """Return telemetry packets."""
    return [
        bytes.fromhex(text)
        for text in _hex_in(json.loads((DATA / "golden_telemetry.json").read_text(encoding="utf-8")))
    ][:40]


def messages() -> list[bytes]:
    """Return messages of some types, with something in them."""
    found = []
    for number, name in enumerate(TYPES):
        buffer = io.BytesIO()
        made = shipped().message_class(name)()
        for attribute, value in (("name", ["a", "bc"]), ("position", [1.0, 2.0]), ("data", "text")):
            if hasattr(made, attribute):
                setattr(made, attribute, value)
        made.serialize(buffer)
        found.append(bytes([number]) + buffer.getvalue())
    return found


def _hex_in(value: Any) -> Iterator[str]:
    if isinstance(value, str) and len(value) > 20 and len(value) % 2 == 0 and set(value) <= set("0123456789abcdef"):
        yield value
    elif isinstance(value, (dict, list)):
        for each in value.values() if isinstance(value, dict) else value:
            yield from _hex_in(each)


LAUNCH = """<launch>
  <arg name="given"/><arg name="x" default="$(eval 1 + int(arg('given')))"/>
  <env name="A" value="$(optenv HOME nothing)"/>
  <group ns="arm" if="$(eval x == 2)"><remap from="a" to="/b"/>
    <param name="p" value="1.5" type="double"/><param name="q" command="cat $(dirname)/none"/>
    <rosparam>{a: [1, 2.5, deg(90), rad(pi/2)], b: {c: text}}</rosparam>
    <node pkg="rospy_tutorials" type="talker.py" name="n" args="$(anon n)" respawn="true" respawn_delay="1e9">
      <param name="~r" value="true"/><remap from="x" to="y"/></node>
  </group>
  <include file="$(dirname)/input"><arg name="given" value="$(arg x)"/></include>
  <rosparam param="l" subst_value="true">[$(arg x), 2]</rosparam>
  <test test-name="t" pkg="p" type="t.py" time-limit="1e999" retry="2"/>
</launch>
"""
MESSAGE = """# what it is
Header header
uint8 A=1
string S= text # all of it
float64[3] three
string[] names
geometry_msgs/Pose[2] poses
time stamp
char c
int64[] many
duration[4] spans
"""
ACTION = "int32 order=1\n---\nint32[] sequence\n---\nfloat32 part\n"
FULL = (
    f"{MESSAGE}{'=' * 80}\nMSG: geometry_msgs/Pose\nOther position\n{'=' * 80}\nMSG: geometry_msgs/Other\nfloat64 x\n"
)
FULL += f"{'=' * 80}\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
CMAKE = """cmake_minimum_required(VERSION 3.0.2)
project(demo)
set(SOURCES src/one.cpp "src/two.c")
list(APPEND SOURCES ${SOURCES})
if(NOT DEFINED X AND (UNIX OR ${PROJECT_NAME} STREQUAL "demo") AND 3.10 VERSION_GREATER 2)
  foreach(i RANGE 0 3)
    add_library(l${i} ${SOURCES})
  endforeach()
else()
  add_subdirectory(src)
endif()
file(GLOB_RECURSE ALL src/*.c* *.cpp)
macro(both name)
  add_executable(${name} ${ARGN}) # and what it needs
  target_link_libraries(${name} l0 l1 ${catkin_LIBRARIES})
endmacro()
find_package(catkin REQUIRED COMPONENTS roscpp std_msgs)
both(node ${ALL})
add_definitions(-DA="b c" -DE=\\"f\\")
add_cfe_app(demo ${SOURCES})
add_cfe_tables(demo fsw/tables/t.c)
#[[ what
is left out ]]
include_directories(include ${X_MISSION_DIR}/fsw/inc)
"""
PACKAGE = """<?xml version="1.0"?>
<!DOCTYPE package [<!ENTITY a "text">]>
<package format="2"><name>demo</name><version>0.0.0</version><depend>roscpp</depend>
<export><nodelet plugin="${prefix}/plugins.xml"/></export>
<library path="lib/libn"><class name="demo/N" type="demo::N" base_class_type="nodelet::Nodelet">&a;</class></library>
</package>
"""
CPP = """#include <ros/ros.h>
#include "input"
#define NAME "odom" /* of the topic */
class A { ros::NodeHandle nh, p{"~"}; ros::Subscriber s; message_filters::Subscriber<a::B> f{nh, "x", 1};
  A() : p(nh, "q") { s = nh.subscribe<std_msgs::String>(NAME, 1, boost::bind(&A::on, this, _1)); throw 1; } };
int main(int argc, char **argv) { std::string t = "y"; ros::NodeHandle n("~"), m(n, "a");
  n.param("p", t, std::string("z"));
  ros::Publisher out = n.advertise<a::B>(t, 10); actionlib::SimpleActionServer<a::C> c(n, "act", false); // \"'
  n.createTimer(ros::Duration(1), [&](const ros::TimerEvent &) { new int('\\''); }); return R"(a)"[0]; }
"""
PYTHON = """import rospy
from cfepy.app import Cfe
STATUS_MID = 0x0883
class A:
    def __init__(self, cfe: Cfe) -> None:
        self.cfe = cfe
def A_Main(cfe):
    held = A(cfe).cfe.sb
    while (key := held.receive_buffer(1, -1)) is not None and [x.a.b for x in {1, 2}]:
        try:
            cfe.evs.sent_event(1, f"{key!r:>{3}}")
        except (AttributeError, TypeError):
            match key:
                case {"a": [1, *rest]}:
                    lambda *a, b=1, **c: (yield)
"""
WRITTEN = '{"a/b": "6b86b273ff34fce19d6b804eff5a3f57", "c": "x", "../d": "y"}'
EXPRESSIONS = (
    "1 + 2 * 3 ** 2 // 5 % 7",
    "[i * 2 for i in range(10) if i % 2]",
    "'%s-%05d' % (s, 12)",
    "'{:>10}'.format(s.upper())",
    "f'{x:.3f}' + str({'a': [1, (2, 3)]})",
    "sorted(map(int, '3,1,2'.split(',')), reverse=True)[0]",
    "max([len(p) for p in s.split(',')]) if x > 2 and not x == 5 else -abs(x)",
    "sum(range(100)) << 3 | 5",
)
FAULTS = """faults:
- {reorder: CFE_ES_SEND_HK, name: reorder-1, after: 1.1, number: 1, past: 3}
- {duplicate: /motor_command, name: duplicate-2, after: 1.903, until: 8.75, probability: 0.2}
- {lose_1hz: tone, name: lose_1hz-3, after: 1.112, until: 10.25}
- {drop: HK_SEND_COMBINED_PKT, name: drop-4, after: 1.1, number: 1}
- {duplicate: /joint_states_throttle, name: duplicate-5, after: 5.28, until: 9.826, probability: 0.01}
"""
MOVES = "moves:A@650/add.publish/3=B,C-2@7/next=hold"
SCHEDULES = ("fifo", "random:3", "at:56=1", MOVES, "pct:3:100:7", "at:1=1,2=2", "random:1:any")
RESULTS = (
    '{"format": "cfepy exploration 1", "campaign": {"plan": {"words": ["m"]}, "files": {}}}\n'
    '{"number": 0, "verdict": VERDICT}\n'
    '{"failure": {"group": "died|HK|x", "title": "died: HK: x", "schedule": "moves:A=B"}}\n'
)
VERDICT = Verdict(Schedule.parse("random:3"), (Failure("died", "HK", "at hk.py:3", 5),), deviations=((1, 2),))
JUNIT = """<testsuites><testsuite name="s" tests="2" errors="0" failures="1">
<testcase classname="a" name="b" time="0.1">
<failure message="x" type="y">text</failure></testcase><testcase classname="a" name="c"/></testsuite></testsuites>"""
PARAMETERS = """a: 1
b: {c: [1.5, -2, true, ~], d: "text", when: 2001-01-01}
angle: deg(90)
turn: !radians 2*pi
data: !!binary AAEC
base: &base {x: 1}
other: {<<: *base, y: 2}
"""
LOCK = "topics:\n  /joint_states: 0x0910\n  /phase: 0x0912\nservices:\n  /reset: 0x0930\n"


@cache
def table_texts() -> list[bytes]:
    """Return table files in YAML."""
    find = table_types(None, []).get
    sources = sorted([*DATA.glob("*.tbl"), *(ROOT / "missions").glob("*/*.tbl")])
    return [table_yaml.write(document(take_apart(path.read_bytes(), find, path.name))).encode() for path in sources]


KINDS = {
    kind.name: kind
    for kind in (
        Kind("startup", files("missions/*/startup.scr"), startup, "startup.scr"),
        Kind(
            "mission-file",
            files("missions/*/mission.yaml", "tests/quality/missions/*/mission.yaml"),
            mission_file,
            "mission.yaml",
        ),
        Kind("mission", files("missions/*/mission.yaml"), mission, "mission.yaml"),
        Kind("launch", lambda: [*texts(LAUNCH)(), *files("tests/**/*.launch")()], launch, "input"),
        Kind("rostest", lambda: [*texts(LAUNCH)(), *files("tests/**/*.test")()], launch, "input.test"),
        Kind("parameters", texts(PARAMETERS), parameters, "robot.yaml"),
        Kind("expression", texts(*EXPRESSIONS), expression),
        Kind("message-definition", texts(MESSAGE), definition),
        Kind("service-definition", texts(ACTION), service),
        Kind("full-text", texts(FULL), full_text),
        Kind("message", messages, message),
        Kind("table", files("tests/data/*.tbl", "missions/*/*.tbl"), table, "table.tbl"),
        Kind("table-yaml", table_texts, table_text, "table.yaml"),
        Kind("dump", files("tests/data/*.log", "tests/data/*.dat"), dump, "dump.log"),
        Kind("bag", files("tests/data/bags/*.bag"), bag, "input.bag"),
        Kind("mcap", files("tests/data/bags/*.mcap"), recording, "input.mcap"),
        Kind("journal", journals, journal, "run.cfepy"),
        Kind(
            "results",
            lambda: [RESULTS.replace("VERDICT", json.dumps(VERDICT.to_dict())).encode()],
            results,
            "results.json",
        ),
        Kind("schedule", texts(*SCHEDULES), schedule),
        Kind("script", files("missions/capture/checks.txt", "tests/**/checks.txt"), script, "checks.txt"),
        Kind("typed", files("missions/capture/checks.txt"), typed),
        Kind("faults", texts(FAULTS), faults, "faults.yaml"),
        Kind("lock", texts(LOCK), lock, "topics.lock"),
        Kind("board", files("boards/*.yaml"), board, "board.yaml"),
        Kind("command-words", texts("abc\nName=x\nMode=0x10\nMask[1]=3", "a\nx=1,2,3\ny=-2.5"), words),
        Kind("cds-image", cds_images, cds_image),
        Kind("telemetry", packets, telemetry),
        Kind(
            "field-paths", texts("position[0]", "header.stamp", "position[-1]", "name[0:2]", "header.frame_id"), paths
        ),
        Kind("breakpoints", texts("/joint_states", "CFE_ES:3", "0x910", "msg.data > 3 and t > 1", "HK:ERROR"), breaks),
        Kind("test-results", texts(JUNIT), junit, "results.xml"),
        Kind(
            "cmake-lists", lambda: [*texts(CMAKE)(), *files("tests/**/CMakeLists.txt")()], cmake_lists, "CMakeLists.txt"
        ),
        Kind("data-sheet", texts(dictionary_files.SHEET), dictionary_files.data_sheet, "tank.xml"),
        Kind("cosmos", texts(dictionary_files.COSMOS), dictionary_files.cosmos, "tank.txt"),
        Kind("xtce", texts(dictionary_files.XTCE), dictionary_files.xtce, "tank.xml"),
        Kind("c-header", texts(dictionary_files.HEADER), dictionary_files.c_header, "tank_msg.h"),
        Kind("package-manifest", texts(PACKAGE), package_manifest, "package.xml"),
        Kind(
            "cpp-source",
            lambda: [*texts(CPP)(), *files("tests/extra/convert/nodes/**/*.cpp")()],
            cpp_source,
            "input.cpp",
        ),
        Kind("python-source", lambda: [*texts(PYTHON)(), *files("apps/*/app.py")()], python_source, "input.py"),
        Kind("output-list", texts(WRITTEN), output_list, ".cfepy-convert.json"),
        Kind("manifest", texts("<package><name>arm</name></package>", "setup(package_dir={'': 'src'})"), manifest),
        Kind("xtce-names", texts("capture", "a b/c", "\x1b[0m"), names),
        Kind("shared-object", shared_objects, shared_object, "startup.scr"),
        Kind("yaml", files("missions/*/*.yaml", "boards/*.yaml"), yaml_file, "any.yaml"),
        Kind("tcpros", servers.tcpros_samples, servers.tcpros),
        Kind("http", servers.http_samples, servers.http),
        Kind("master-api", servers.master_samples, servers.master_api),
        Kind("slave-api", servers.slave_samples, servers.slave_api),
        Kind("websocket", servers.websocket_samples, servers.websocket),
        Kind("rosbridge", servers.rosbridge_samples, servers.rosbridge),
        Kind("foxglove", servers.foxglove_samples, servers.foxglove),
    )
}
