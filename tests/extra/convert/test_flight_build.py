"""Nodes in C++ that `cfepy launch` and `cfepy node` build and fly automatically."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.c import CompilerError
from cfepy.extra.convert import build
from cfepy.extra.convert.build import (
    BuildOptions,
    CompileUnit,
    compile_units,
    core_units,
    library_folder,
    unique_symbols,
)
from cfepy.extra.convert.flight_build import shortened
from cfepy.journal import read_journal, replay
from cfepy.mission import read_mission
from cfepy.pilot.plan import built_node
from cfepy.writing.work_progress import WorkProgress
from dev.convert.ping import ping_package
from rospy_shim.types.msgs import shipped

pytestmark = pytest.mark.slow


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    return ping_package(tmp_path)


def test_a_launch_file_is_flown(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", "ping", "ping.launch", "--for", "1.55"]) == 0
    shown = capfd.readouterr().out
    assert "heard 1 plain-beat-odd!" in shown
    assert "/pulse" in shown


def test_missing_elf_reader_is_reported_before_anything_is_compiled(
    package: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def compile_nothing(*words: object) -> None:
        raise AssertionError("a compiler was started")

    monkeypatch.setitem(sys.modules, "elftools.elf.elffile", None)
    monkeypatch.setattr(build, "start_bounded", compile_nothing)
    monkeypatch.setenv("CFEPY_CACHE", str(package / "cache"))
    assert main(["launch", "ping", "ping.launch", "--for", "1"]) != 0
    assert "pip install 'cfepy[c]'" in capfd.readouterr().err


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The texts that tell the progress of compiling."""

    class Shown(WorkProgress):
        def show(self, text: str) -> None:
            texts.append(text)

    texts: list[str] = []
    monkeypatch.setattr(build, "WorkProgress", Shown)
    return texts


def test_compiling_shows_the_source_and_its_number(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, shown: list[str]
) -> None:
    monkeypatch.setenv("CFEPY_CACHE", str(tmp_path / "cache"))
    sources = [tmp_path / name for name in ("sender.cpp", "words.cpp", "hearer.cpp")]
    for each in sources:
        each.write_text("int word;\n", encoding="utf-8")
    units = [CompileUnit(each, (), (), each.name) for each in sources]
    compile_units(units[1:2], "words")
    compile_units(units, "left")
    assert shown == [
        "compiling words: 1 of 1, words.cpp",
        "compiling left: 1 of 2, sender.cpp",
        "compiling left: 2 of 2, hearer.cpp",
    ]


def test_a_changed_source_alone_is_compiled_again(package: Path, shown: list[str]) -> None:
    assert main(["launch", "ping", "ping.launch", "--for", "1.55"]) == 0
    shown.clear()
    words = package / "src/words.cpp"
    never_compiled = words.read_text(encoding="utf-8").replace("even", str(package))
    words.write_text(never_compiled, encoding="utf-8")
    assert main(["launch", "ping", "ping.launch", "--for", "1.55"]) == 0
    assert {each.split(", ")[-1] for each in shown} == {"words.cpp"}


def test_a_further_part_of_the_library_leaves_the_other_parts_as_they_are() -> None:
    options, library = BuildOptions(), shipped()
    few = {each.source: each.key for each in core_units(options, False, library, [])}
    with_tf = [library_folder() / "include/tf2_ros/buffer.h"]
    more = {each.source: each.key for each in core_units(options, False, library, with_tf)}
    assert few.items() < more.items()
    assert {each.parent.name for each in more.keys() - few.keys()} == {"tf"}


def test_standard_output_of_a_node_is_shown_with_its_name(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    source = package / "src/sender.cpp"
    own = """
  struct Last { ~Last() { std::printf("at its end"); } };
  static Last last;
  std::printf("to be ");
  std::cout << "continued" << std::endl;
  for (const char byte : std::string("h\\xc3\\xb6rt\\n")) std::cout.put(byte);
  std::cerr << "one\\ntwo\\n";
  std::printf("half a line");
  return 0;
  ros::Rate rate(hz);"""
    text = source.read_text(encoding="utf-8").replace("  ros::Rate rate(hz);", own)
    source.write_text("#include <cstdio>\n#include <iostream>\n" + text, encoding="utf-8")
    assert main(["launch", "ping", "ping.launch", "--for", "8"]) == 0
    shown = capfd.readouterr().out.splitlines()
    said = ["to be continued", "hört", "one", "two", "half a line", "at its end"]
    assert [line for line in shown if line.startswith("[/arm/left] ")] == [f"[/arm/left] {line}" for line in said]
    assert main(["node", "ping", "sender", "--for", "8"]) == 0
    assert capfd.readouterr().out.splitlines() == said[:-1]  # the run ends with the node, before its code is unloaded


def test_cpp_clocks_show_mission_time(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    source = package / "src/sender.cpp"
    own = """
  const auto steady = std::chrono::steady_clock::now();
  const auto system = std::chrono::system_clock::now();
  ros::Duration(0.5).sleep();
  const std::chrono::duration<double> one = std::chrono::steady_clock::now() - steady;
  const std::chrono::duration<double> other = std::chrono::system_clock::now() - system;
  std::printf("after %.3f s, %.3f s\\n", one.count(), other.count());
  return 0;
  ros::Rate rate(hz);"""
    text = source.read_text(encoding="utf-8").replace("  ros::Rate rate(hz);", own)
    source.write_text("#include <chrono>\n#include <cstdio>\n" + text, encoding="utf-8")
    assert main(["node", "ping", "sender", "--for", "2"]) == 0
    assert capfd.readouterr().out == "after 0.500 s, 0.500 s\n"


def test_nodes_in_python_and_cpp_exchange_messages(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", str(package / "launch/both.launch"), "--for", "1.55"]) == 0
    shown = capfd.readouterr().out
    assert "python heard plain-beat-even!" in shown
    assert 8 <= shown.count("[/arm/ear]") <= 11  # ten a second


@pytest.mark.parametrize("name", ["ping/Doubler", "Filters/Doubler"])
def test_a_nodelet_is_an_application(package: Path, name: str, capfd: pytest.CaptureFixture[str]) -> None:
    for file in (package / "nodelets.xml", package / "launch/nodelet.launch"):
        file.write_text(file.read_text(encoding="utf-8").replace("ping/Doubler", name), encoding="utf-8")
    assert main(["launch", "ping", "nodelet.launch", "--for", "1"]) == 0
    shown, told = capfd.readouterr()
    assert "doubling 3" in shown
    assert "/twice/out" in shown
    assert "left out" not in told


def test_a_test_of_nodes_in_cpp(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["rostest", "ping", "ping.test"]) == 0
    assert "RESULT: SUCCESS" in capfd.readouterr().out


def test_a_mission_with_the_launch_file(package: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["convert", str(package / "launch/ping.launch"), "-o", str(tmp_path / "made")]) == 0
    spec = read_mission(str(tmp_path / "made/mission"), build=built_node)
    assert [each.name for each in spec.built.values()] == ["/arm/left", "/arm/ear"]
    assert main(["run", str(tmp_path / "made/mission"), "--for", "2"]) == 0
    assert "heard 1 plain-beat-odd!" in capfd.readouterr().out


def test_one_node_is_built_and_flown(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["node", "ping", "hearer", "--for", "1"]) == 0
    assert main(["check", "ping", "ping.launch"]) == 0


def test_a_replay_needs_no_compiler(package: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    journal = tmp_path / "run.journal"
    assert main(["launch", "ping", "ping.launch", "--for", "1", "--record", str(journal)]) == 0
    shutil.rmtree(package)
    monkeypatch.setattr(build, "start_bounded", None)  # the function that starts compilers
    assert replay(read_journal(journal)).verdict.same


def test_node_refused_by_the_compiler_is_left_out_with_the_error(
    package: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    source = package / "src/sender.cpp"
    source.write_text(
        source.read_text(encoding="utf-8").replace("ros::Rate rate(hz);", "ros::Rate rate(nothing_such);"),
        encoding="utf-8",
    )
    assert main(["launch", "ping", "ping.launch", "--for", "1"]) == 0
    told = capfd.readouterr().err
    assert "node /arm/left is left out: it cannot be built" in told
    assert "nothing_such" in told


def test_error_of_the_compiler_is_shown_without_the_headers_that_lead_to_it() -> None:
    chain = [f"                 from /usr/include/boost/h{number}.hpp:{number}," for number in range(20)]
    said = [
        "In file included from /usr/include/boost/first.hpp:22,",
        *chain,
        "                 from node.cpp:3:",
        "helper.h: In function 'int f()':",
        "In file included from node.cpp:39:",
        "helper.h:58:5: error: '_type' was not declared in this scope",
        "   58 |     _type = 1; // from here on,",
    ]
    assert shortened("\n".join(said)).splitlines() == [said[-4], *said[-2:]]


def test_second_type_on_a_topic_of_a_node_is_refused(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    source = package / "src/sender.cpp"
    again = 'ros::Publisher other = nh.advertise<std_msgs::String>("beat", 4); ROS_INFO("is one: %d", bool(other));'
    text = source.read_text(encoding="utf-8").replace("ros::Rate rate(hz);", again + " ros::Rate rate(hz);")
    source.write_text("#include <std_msgs/String.h>\n" + text, encoding="utf-8")
    assert main(["launch", "ping", "ping.launch", "--for", "1"]) == 1  # an event of the type ERROR
    shown = capfd.readouterr().out
    assert "is one: 0" in shown
    assert "Tried to advertise on topic [/pulse] with md5sum [992ce8a1687cec8c8bd883ec73ca41d1]" in shown
    assert "heard 1 plain-beat-odd!" in shown


def test_missing_compiler_is_reported_when_a_node_is_launched(
    package: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("CXX", "no-such-compiler")
    monkeypatch.setenv("CFEPY_CACHE", str(tmp_path / "cache"))
    build.identity.cache_clear()
    assert main(["launch", "ping", "ping.launch", "--for", "1"]) == 2
    assert (
        "no-such-compiler is not installed; install a C compiler (on Debian `apt-get install gcc`, and g++ for C++)"
        in capfd.readouterr().err
    )


def test_symbols_that_nodes_would_share_are_found(tmp_path: Path) -> None:
    source = tmp_path / "unit.cpp"
    source.write_text(
        "template <class T> struct A { static int x; }; template <class T> int A<T>::x = 1;"
        'extern "C" int* f() { return &A<int>::x; }\n',
        encoding="utf-8",
    )
    made = tmp_path / "unit.so"
    subprocess.run(["c++", "-shared", "-fPIC", str(source), "-o", str(made)], check=True)
    assert unique_symbols(made) == ["A<int>::x"]
    with pytest.raises(CompilerError):
        unique_symbols(source)


def test_other_type_of_a_topic_in_python_is_reported_once(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    source = package / "src/sender.cpp"
    (package / "launch/both.launch").write_text(
        '<launch><node pkg="ping" type="sender" name="left"/>'
        '<node pkg="ping" type="script.py" name="script"/></launch>\n',
        encoding="utf-8",
    )
    (package / "scripts/script.py").write_text(
        "#!/usr/bin/env python3\nimport rospy\nfrom ping.msg import Beat\nrospy.init_node('script')\n"
        "rospy.Subscriber('/other', Beat, lambda message: rospy.loginfo('heard'))\nrospy.spin()\n",
        encoding="utf-8",
    )
    (package / "scripts/script.py").chmod(0o755)
    source.write_text(
        """
#include <ros/ros.h>
#include <std_msgs/String.h>

static void heard(const std_msgs::String &) { ROS_INFO("heard"); }

int main(int argc, char **argv)
{
  ros::init(argc, argv, "left");
  ros::NodeHandle nh;
  ros::Duration(0.5).sleep();
  ros::Publisher pub = nh.advertise<std_msgs::String>("/other", 4);
  for (int i = 0; i < 5; ++i)
  {
    pub.publish(std_msgs::String());
    ros::Duration(0.1).sleep();
  }
  pub.shutdown();
  ros::Subscriber sub = nh.subscribe("/other", 4, heard);
  ros::Subscriber again = nh.subscribe("/fine", 4, heard);
  ros::spinOnce();
  sub.shutdown();
  ROS_INFO("goes on: %u", pub.getNumSubscribers());
}
""",
        encoding="utf-8",
    )
    assert main(["run", str(package / "launch/both.launch"), "--for", "3"]) == 1  # events of the type ERROR
    shown = capfd.readouterr().out
    events = [line for line in shown.splitlines() if line.startswith("EVS") and "/LEFT 3: " in line]
    text = (
        "[/left] has the type std_msgs/String [992ce8a1687cec8c8bd883ec73ca41d1] for topic /other, which is ping/Beat"
    )
    assert [text in line for line in events] == [True, True]  # to publish, and to subscribe
    assert "no MsgId" not in shown
    assert "goes on: 0" in shown
    assert "heard" not in shown
