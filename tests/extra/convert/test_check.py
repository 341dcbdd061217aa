"""The check's first pass: its findings in sources without the compiler."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.convert import Profile
from cfepy.extra.convert.node_check import RULES, CheckReport, Level, ProgramSources, SourcePlace, read_source, rule_of
from dev.convert import rules
from dev.convert.survey import DOCUMENT, between
from rospy_shim.types.msgs import shipped

MAIN = "int main(int argc, char **argv) { return 0; }\n"


def look(folder: Path, text: str, profile: Profile = Profile.STRICT, **others: str) -> CheckReport:
    """Return the report on one source; others are headers beside it."""
    for name, content in others.items():
        (folder / f"{name}.h").write_text(content, encoding="utf-8")
    (folder / "node.cpp").write_text(text, encoding="utf-8")
    report = CheckReport("node", profile)
    ProgramSources([folder / "node.cpp"], [], shipped()).look(report)
    return report


def found(report: CheckReport) -> dict[str, tuple[int, int]]:
    """Return where each rule was met first."""
    return {each.rule: (each.place.line, each.place.column) for each in sorted(report.findings, reverse=True)}


@pytest.mark.parametrize(
    ("line", "rule", "column"),
    [
        ("#include <nodelet_of_mine/none.h>", "include-unknown", 1),
        ("#include <gazebo/gazebo.hh>", "library-outside", 1),
        ("#include <QApplication>", "library-outside", 1),
        ("#include <gtest/gtest.h>", "gtest", 1),
        ("#include <moveit/move_group_interface/move_group_interface.h>", "ros-library", 1),
        ("#include <rover/DriveConfig.h>", "include-unknown", 1),
        ("#include <boost/asio.hpp>", "boost-header", 1),
        ("void f() { throw 1; }", "throw", 12),
        ("void f() { try { g(); } catch (...) { } }", "catch", 25),
        ("void f(A *a) { dynamic_cast<B *>(a); }", "rtti", 16),
        ("void f() { std::exit(3); }", "exit", 12),
        ("void f() { ::abort(); }", "abort", 12),
        ("void f() { assert(false); }", "assert", 12),
        ("void f() { signal(SIGINT, g); }", "signal", 12),
        ("std::thread worker(f);", "thread", 1),
        ("void f() { std::thread(g).detach(); }", "thread", 12),
        ("auto *worker = new boost::thread(f);", "thread", 16),
        ("void f() { group.create_thread(g); }", "thread", 12),
        ("class A { boost::condition_variable changed; };", "thread", 11),
        ("class A { boost::asio::io_service io; };", "socket", 11),
        ("void f() { socket(AF_INET, SOCK_DGRAM, 0); }", "socket", 12),
        ("void f() { tcsetattr(0, TCSANOW, &raw); }", "serial", 12),
        ("void f() { std::ofstream log(name); }", "file", 12),
        ('void f() { system("reboot"); }', "process", 12),
        ("void f() { getchar(); }", "getchar", 12),
        ("void f(int x) { std::cin >> x; }", "getchar", 17),
        ("void f(int x) { cin >> x; }", "getchar", 17),
        ("void f(T line) { getline(cin, line); }", "getchar", 18),
        ("void f() { cin.get(); }", "getchar", 12),
        ("void f(char *c) { read(0, c, 1); }", "getchar", 19),
        ("void f(char *c) { ::read(STDIN_FILENO, c, 1); }", "getchar", 19),
        ("void f() { fgetc(stdin); }", "getchar", 12),
        ("void f() { usleep(10); }", "sleep", 12),
        ("int count = 0;", "global-state", 5),
        ("void f() { static int count; }", "static-local", 23),
        ('void f() { n.subscribe("a", 0, g); }', "queue-unbounded", 12),
        ('void f() { n.subscribe("a", 1000, g); }', "queue-large", 12),
        ("void f() { n.advertise<std_msgs::String>(name, 1); }", "topic-not-constant", 12),
        ("void cb(int x) { v.push_back(x); } void f() { n.createTimer(d, cb); }", "heap-in-callback", 18),
        ('void f() { n.subscribe("a", 1, [](const A &a) { new A(a); }); }', "heap-in-callback", 49),
        (MAIN, "main-form", 1),
        ("int main(float x) { }", "main-form", 1),
    ],
)
def test_each_rule_is_met(tmp_path: Path, line: str, rule: str, column: int) -> None:
    """The source has a main already, so the last two have one too many or are wrong themselves."""
    text = line if line.startswith("int main(float") else f"{MAIN}{line}"
    report = look(tmp_path, text)
    assert found(report)[rule] == (1 if text is line else 2, column), report.findings


@pytest.mark.parametrize(
    "line",
    [
        "void f() { getchar(); }",
        "void f() { tcgetattr(0, &raw); }",
        "void f() { socket(AF_INET, SOCK_DGRAM, 0); }",
        'void f() { system("reboot"); }',
    ],
)
def test_unsupported_call_refuses_a_node_in_the_host_profile(tmp_path: Path, line: str) -> None:
    assert len(look(tmp_path, f"{MAIN}{line}", Profile.HOST).at(Level.ERROR)) == 1


@pytest.mark.parametrize("line", ["std::condition_variable changed;", "void f() { std::thread(g).detach(); }"])
def test_thread_refuses_a_node_of_one_task(tmp_path: Path, line: str) -> None:
    levels = {
        profile: [len(look(tmp_path, f"{MAIN}{line}", profile).at(level)) for level in (Level.ERROR, Level.WARNING)]
        for profile in Profile
    }
    assert levels == {Profile.HOST: [0, 1], Profile.POOL: [1, 0], Profile.STRICT: [1, 0]}


@pytest.mark.parametrize(
    ("line", "rule"),
    [
        ("void f() { throw 1; }", "throw"),
        ("void f() { try { g(); } catch (...) { } }", "catch"),
        ("void f(A *a) { dynamic_cast<B *>(a); }", "rtti"),
    ],
)
def test_exception_refuses_a_node_only_in_the_strict_profile(tmp_path: Path, line: str, rule: str) -> None:
    assert [each.rule for each in look(tmp_path, f"{MAIN}{line}", Profile.POOL).at(Level.WARNING)] == [rule]
    assert [each.rule for each in look(tmp_path, f"{MAIN}{line}", Profile.STRICT).at(Level.ERROR)] == [rule]


@pytest.mark.parametrize(
    "line",
    [
        "#include <ros/ros.h>",
        "#include <std_msgs/String.h>",
        "#include <std_srvs/SetBool.h>",
        "#include <std_srvs/SetBoolRequest.h>",
        "#include <vector>",
        "#include <boost/shared_ptr.hpp>",
        '#include "mine.h"',
        "const int count = 3;",
        "class A { boost::thread worker; boost::mutex lock; };",
        "void f(A &in, char *c, int x) { read(fd, c, 1); in.read(c); in >> x; x = x >> 1; }",
        "extern int count;",
        "int f(int);",
        "void f() { v.push_back(1); }",
        'void f() { n.subscribe("a", 10, g); }',
        'const std::string kName = "a"; void f() { n.subscribe(kName, 10, g); }',
        '#define NAME "a"\nvoid f() { n.advertise<A>(NAME, 0); }',
        "#if 0\nvoid f() { throw 1; }\n#endif",
        "#ifdef WIN32\n#include <windows.h>\n#endif",
        "// throw 1; exit(3);",
        'const char *kText = "exit(1)";',
    ],
)
def test_valid_source_has_no_findings(tmp_path: Path, line: str) -> None:
    report = look(tmp_path, f"{line}\n{MAIN}", mine="#ifndef MINE_H\n#define MINE_H\n#include <string>\n#endif\n")
    assert not report.findings


WORKER_H = "#ifndef WORKER_H\n#define WORKER_H\nclass Worker { public: void begin(); };\n#endif\n"
WORKER = '#include "worker.h"\nvoid Worker::begin() { std::thread(work).detach(); }\n'


@pytest.mark.parametrize(
    ("node", "worker", "rule"),
    [
        (MAIN, WORKER, "unused-code"),
        (f"{MAIN}", f"static void help() {{ }}\n{WORKER}", "unused-code"),
        (f'#include "worker.h"\n{MAIN}', WORKER, "thread"),
        (MAIN, f"{WORKER}void begin_all() {{ Worker().begin(); }}", "thread"),
        (MAIN, f"{WORKER}static const Worker one;", "thread"),
        (MAIN, f"{WORKER}int Other::begin() {{ Worker().begin(); }}", "thread"),
        (MAIN, f"{WORKER}PLUGINLIB_EXPORT_CLASS(Worker, Base)", "thread"),
    ],
)
def test_uncalled_library_code_does_not_refuse_a_node(tmp_path: Path, node: str, worker: str, rule: str) -> None:
    sources = {"node.cpp": node, "worker.cpp": worker, "worker.h": WORKER_H}
    for name, text in sources.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    report = CheckReport("node", Profile.STRICT)
    ProgramSources([tmp_path / "node.cpp", tmp_path / "worker.cpp"], [], shipped()).look(report)
    assert {each.rule for each in report.findings} & {"thread", "unused-code"} == {rule}


def test_own_headers_are_read(tmp_path: Path) -> None:
    guarded = "#ifndef MINE_H\n#define MINE_H\n#include <pcl/point_cloud.h>\n#endif\n"
    report = look(tmp_path, f'#include "mine.h"\n{MAIN}', mine=guarded)
    assert [(each.rule, each.place) for each in report.findings] == [
        ("library-outside", SourcePlace(tmp_path / "mine.h", 3, 1))
    ]


def test_a_level_is_the_profiles(tmp_path: Path) -> None:
    text = f"void f() {{ throw 1; }}\n{MAIN}"
    assert not look(tmp_path, text, Profile.HOST).findings
    assert look(tmp_path, text, Profile.STRICT).is_refused


def test_names_have_types_and_places(tmp_path: Path) -> None:
    report = look(
        tmp_path,
        """void Node::cb(const std_msgs::String::ConstPtr &m) { }
void Node::start() {
  n.subscribe("in", 5, &Node::cb, this);
  out = n.advertise<std_msgs::Bool>(kPrefix + "/out", 1);
  n.subscribe<std_msgs::Header>("h", 1, boost::bind(&Node::x, this, _1));
  n.param<std::string>("frame", frame, "base");
}
"""
        + MAIN,
        Profile.HOST,
    )
    told = [(each.kind, each.name, each.type, each.queue, each.place.line) for each in report.names]
    assert told == [
        ("subscribe", "in", "std_msgs/String", 5, 3),
        ("publish", None, "std_msgs/Bool", 1, 4),
        ("subscribe", "h", "std_msgs/Header", 1, 5),
        ("parameter", "frame", "", None, 6),
    ]


def test_unreadable_file_is_a_finding(tmp_path: Path) -> None:
    report = CheckReport("node", Profile.HOST)
    ProgramSources([tmp_path / "none.cpp"], [], shipped()).look(report)
    assert found(report) == {"file-unreadable": (0, 0), "main-form": (0, 0)}


@pytest.mark.parametrize(
    ("message", "rule"),
    [
        ("foo.h: No such file or directory", "include-unknown"),
        ('#error "roscfe: nodelet/nodelet.h is not supported [ros-library]"', "ros-library"),
        ("'AsyncSpinner' is not a member of 'ros'", "api-missing"),
        ("'class ros::NodeHandle' has no member named 'fly'", "api-missing"),
        ("'x' was not declared in this scope", "compile-error"),
        ("expected ';' before '}' token", "compile-error"),
        ("exception handling disabled, use '-fexceptions' to enable", "throw"),
        ('#error "something of its own [no-rule]"', "compile-error"),
    ],
)
def test_errors_of_the_compiler_have_rules(message: str, rule: str) -> None:
    assert rule_of(message, Profile.POOL)[0] == rule


def test_a_name_that_no_file_can_have_is_not_found(tmp_path: Path) -> None:
    report = look(tmp_path, f"#include <{'x' * 5000}>\n#include <boost/{'x' * 5000}>\n{MAIN}", Profile.HOST)
    assert {each.rule for each in report.findings} == {"include-unknown", "boost-header"}


def test_deep_nesting_is_read() -> None:
    depth = 20_000
    assert (
        read_source(Path("deep.cpp"), b"int x = " + b"(" * depth + b"1" + b")" * depth + b";").path.name == "deep.cpp"
    )


def test_each_rule_has_a_description_a_reason_and_a_remedy() -> None:
    for rule in RULES.values():
        assert rule.what, rule.id
        assert rule.why, rule.id
        assert rule.remedy, rule.id
        assert {rule.level(profile) for profile in Profile} & set(Level), rule.id


def test_table_in_the_docs_matches_the_rules() -> None:
    text = DOCUMENT.read_text(encoding="utf-8")
    assert between(text, rules.BEGIN, rules.END, rules.table()) == text, "python -m dev.convert.rules writes it"
