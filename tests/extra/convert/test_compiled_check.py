"""The check asks the compiler for the types of subscriptions, and the linker for names that nothing defines."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.convert.message_headers import Profile
from cfepy.extra.convert.node_check import CheckReport, Level, SourcePlace, check_program, programs_of, rule_of
from cfepy.extra.convert.node_check.compiler import Diagnostic, causes
from cfepy.extra.convert.undefined_names import undefined_names
from dev.roscfe.building import needs_cpp

FORMS = """
#include <message_filters/subscriber.h>
#include <ros/ros.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>

struct Functor
{
    void operator()(const std_msgs::Int32ConstPtr &) const {}
};

class Node
{
  public:
    Node() : filter_(nh_, "filtered", 3)
    {
        boost::function<void(const sensor_msgs::ImuConstPtr &)> call = boost::bind(&Node::imu, this, _1, 2);
        hold(nh_.subscribe<sensor_msgs::Imu>("bound", 2, boost::bind(&Node::imu, this, _1, 1)));
        hold(nh_.subscribe("held", 2, call));
        hold(nh_.subscribe<std_msgs::Int32>("functor", 5, Functor()));
\tauto other = nh_.subscribe("method", 1, &Node::text, this);
        auto handler = [](const std_msgs::StringConstPtr &) {};
        hold(nh_.subscribe<std_msgs::String>("kept", 7, handler));
        hear<std_msgs::Int32>("wrapped");
        hold(other);
    }
    template <class M>
    void hear(const char *name)
    {
        hold(nh_.subscribe<M>(name, 9, [](const boost::shared_ptr<M const> &) {}));
    }
    void imu(const sensor_msgs::ImuConstPtr &, int) {}
    void text(std_msgs::String) {}
    void hold(const ros::Subscriber &made) { made_.push_back(made); }

  private:
    ros::NodeHandle                               nh_;
    std::vector<ros::Subscriber>                  made_;
    message_filters::Subscriber<sensor_msgs::Imu> filter_;
};

int main(int argc, char **argv)
{
    ros::init(argc, argv, "forms");
    Node node;
    ros::spin();
}
"""
LOST = """
#include <ros/ros.h>
double filtered(double value);
extern int count;
extern "C" void CFE_ES_ExitApp(unsigned);
int main(int argc, char **argv)
{
    ros::init(argc, argv, "lost");
    CFE_ES_ExitApp(0);
    return filtered(count);
}
"""
NEVER_CALLED = """
#include <ros/ros.h>
#include <thread>
double filtered(double value);
struct Remote { virtual ~Remote(); virtual void send() = 0; };
struct Unused : Remote { void send() override { filtered(1); } };
Remote *made() { return new Unused; }
int main(int argc, char **argv)
{
    ros::init(argc, argv, "lost");
    ros::spin();
}
"""
FILES = """
#include <cstdio>
#include <ros/ros.h>
#include <unistd.h>
int main(int argc, char **argv)
{
    ros::init(argc, argv, "files");
    char name[] = "/tmp/xXXXXXX";
    if (pause() == 0)
    {
        mkstemp(name);
    }
    usleep(10);
    return mkstemp(name);
}
"""


def checked(tmp_path: Path, text: str) -> CheckReport:
    source = tmp_path / "node.cpp"
    source.write_text(text, encoding="utf-8")
    return check_program(programs_of([str(source)], {})[0], Profile.HOST, {})


@needs_cpp
@pytest.mark.slow
def test_memory_is_known_of_callbacks_of_any_form(tmp_path: Path) -> None:
    report = checked(tmp_path, FORMS)
    assert not report.is_refused
    assert [(each.topic, each.type, each.slots) for each in report.memory] == [
        ("bound", "sensor_msgs/Imu", 6),
        ("held", "sensor_msgs/Imu", 6),
        ("functor", "std_msgs/Int32", 9),
        ("method", "std_msgs/String", 5),
        ("kept", "std_msgs/String", 11),
        ("name", "std_msgs/Int32", 13),
        ("a topic", "sensor_msgs/Imu", 68),
    ]


@needs_cpp
@pytest.mark.slow
def test_name_that_nothing_defines_is_an_error_before_flight(tmp_path: Path) -> None:
    errors = [each for each in checked(tmp_path, LOST).findings if each.rule == "undefined-name"]
    assert [(each.place.line, each.message) for each in errors] == [(10, "nothing defines count, filtered(double)")]


@needs_cpp
@pytest.mark.slow
def test_code_that_is_never_called_may_use_names_that_nothing_defines(tmp_path: Path) -> None:
    assert not checked(tmp_path, NEVER_CALLED).is_refused


@needs_cpp
@pytest.mark.slow
def test_function_of_the_host_that_ends_the_node_is_an_error(tmp_path: Path) -> None:
    report = checked(tmp_path, FILES)
    errors = [(each.rule, each.place.line, each.message.partition(":")[0]) for each in report.at(Level.ERROR)]
    assert errors == [
        ("host-function", line, call) for line, call in ((9, "pause()"), (11, "mkstemp()"), (14, "mkstemp()"))
    ]
    assert {each.rule for each in report.at(Level.WARNING)} == {"sleep"}


def test_one_cause_has_one_message(tmp_path: Path) -> None:
    source = tmp_path / "node.cpp"
    source.write_text("int a;\nros::Gone gone(1);\ngone.call();\nother();\n", encoding="utf-8")

    def error(line: int, message: str) -> Diagnostic:
        return Diagnostic(message, SourcePlace(source, line, 1))

    gone = error(2, "'Gone' is not a member of 'ros'")
    other = error(4, "'other' was not declared in this scope")
    follow = [error(2, "expected ';' before 'gone'"), error(3, "'gone' was not declared in this scope")]
    assert causes([gone, *follow, other]) == [gone, other]


@pytest.mark.parametrize(
    ("message", "rule"),
    [
        ("'Gone' is not a member of 'ros'", "api-missing"),
        ("'Tiem' is not a member of 'ros'; did you mean 'Time'?", "compile-error"),
        ("'Own' is not a member of 'own'", "compile-error"),
    ],
)
def test_api_is_missing_only_where_ros_has_it(message: str, rule: str) -> None:
    assert rule_of(message, Profile.HOST)[0] == rule


@needs_cpp
@pytest.mark.slow
def test_missing_header_of_a_header_is_reported_once(tmp_path: Path) -> None:
    (tmp_path / "own.h").write_text("#include <gone/gone.h>\n", encoding="utf-8")
    report = checked(tmp_path, '#include "own.h"\nint main() {}\n')
    assert [(each.rule, each.place.line) for each in report.findings] == [("include-unknown", 1)]


def test_undefined_names_are_read_from_the_linker() -> None:
    said = """/usr/bin/ld: node.o: in function `main':
/home/a/node.cpp:7: warning: undefined reference to `help(int)'
/usr/bin/ld: /home/a/node.cpp:8: undefined reference to `help(int)'
/usr/bin/ld: node.o:(.data.rel+0x0): undefined reference to `vtable for Own'
/usr/bin/ld: /home/a/node.cpp:9: undefined reference to `CFE_ES_ExitApp'
/usr/bin/ld: /home/a/node.cpp:9: undefined reference to `roscfe_cerr'
/usr/bin/ld: /home/a/node.cpp:9: undefined reference to `vtable for ros::Thing'
"""
    assert [tuple(each) for each in undefined_names(said, with_library=False)] == [
        ("/home/a/node.cpp", 7, "help(int)"),
        ("", 0, "vtable for Own"),
    ]
    assert undefined_names(said, with_library=True)[-1].name == "vtable for ros::Thing"
