"""The rules of `cfepy convert check`: what is looked for in a node's sources, how bad it is, why, and what to do.

docs/how_to/convertor.md has this table too; a test holds them together.
"""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

from cfepy.extra.convert.message_headers import Profile


class Level(StrEnum):
    """How bad a finding is: an error refuses the node; a warning and a note do not. The words are SARIF's."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


class CheckRule(NamedTuple):
    """A rule.

    Attributes:
        id: its name, by which findings and `#error` texts of headers refer to it.
        host, pool, strict: its level by profile; None where it does not matter.
        what: it looks for.
        why: that matters on cFE.
        remedy: what to do.
    """

    id: str
    host: Level | None
    pool: Level | None
    strict: Level | None
    what: str
    why: str
    remedy: str

    def level(self, profile: Profile) -> Level | None:
        """Its level in a profile; None where it is not looked for."""
        return {Profile.HOST: self.host, Profile.POOL: self.pool, Profile.STRICT: self.strict}[profile]


_E, _W, _N = Level.ERROR, Level.WARNING, Level.NOTE

RULES: dict[str, CheckRule] = {
    rule.id: rule
    for rule in (
        CheckRule(
            *("compile-error", _E, _E, _E),
            "the compiler refuses the source for a reason that no other rule names",
            "what does not compile is not converted",
            "mend the source, or say with its CMakeLists.txt where its headers are",
        ),
        CheckRule(
            *("file-unreadable", _E, _E, _E),
            "a source that cannot be read, or is larger than a source is",
            "what was not read is not checked",
            "name a source file in C++",
        ),
        CheckRule(
            *("include-unknown", _E, _E, _E),
            "a header that is nowhere",
            "what it declares is not there to be built",
            "put its package beside this one, or on ROS_PACKAGE_PATH",
        ),
        CheckRule(
            *("library-outside", _E, _E, _E),
            "a header of a library from outside ROS",
            "no cFE build of the library comes with cfepy",
            "leave the library out, or build the node with it by hand",
        ),
        CheckRule(
            *("gtest", _E, _E, _E),
            "a test program of GoogleTest",
            "a test is no part of what flies: it is flown on cfepy, with GoogleTest of the computer",
            "leave it where it is; `cfepy rostest` runs it",
        ),
        CheckRule(
            *("ros-library", _E, _E, _E),
            "a header of a ROS library that is not in the interface library",
            "without it the node would be built against another ROS, whose code waits in threads and sockets",
            "leave the library out; docs/how_to/convertor.md has those that are there",
        ),
        CheckRule(
            *("boost-header", _E, _E, _E),
            "a header of Boost that the profile has no build of",
            "pool and strict have the small Boost of the interface library; host takes a Boost that is installed",
            "take the standard library's, or the host profile with Boost installed",
        ),
        CheckRule(
            *("system-ros", _E, _E, _E),
            "a header that came from a ROS on this computer",
            "two libraries with the same names in one program are neither",
            "report it: the interface library should have refused the header",
        ),
        CheckRule(
            *("api-missing", _E, _E, _E),
            "a class, function or overload of ROS that the interface library does not have",
            "nothing on cFE stands for it yet",
            "take a call that is there; docs/how_to/convertor.md has them",
        ),
        CheckRule(
            *("message-definition", _E, _E, _E),
            "a message whose definition is wrong, or names a message that is not there",
            "its header cannot be made",
            "mend the .msg, .srv or .action file, or put the package of the other message on ROS_PACKAGE_PATH",
        ),
        CheckRule(
            *("configuration", _E, _E, _E),
            "a script in cfg/ that fails",
            "the header of the configuration cannot be made of it",
            "mend the script; it is run as by a catkin build",
        ),
        CheckRule(
            *("capacity-missing", None, None, _E),
            "an array of messages without a capacity",
            "a message has a fixed size in this profile, and such arrays multiply",
            "say how many items the field has at most, under `cpp_nodes:` of a mission file",
        ),
        CheckRule(
            *("arena-too-small", None, _E, _E),
            "the messages of all subscriptions do not fit into the node's arena",
            "they are set aside there when the node starts",
            "give a larger `arena_bytes` under `cpp_nodes:` of a mission file, smaller capacities, or shorter queues",
        ),
        CheckRule(
            *("main-form", _E, _E, _E),
            "main is missing, is there twice, or takes something else than nothing or (int, char **)",
            "the entry point of the application calls it",
            "have one `int main()` or `int main(int argc, char **argv)`",
        ),
        CheckRule(
            *("throw", None, _E, _E),
            "an exception is thrown",
            "the profile builds without exceptions, as flight software does: there is nothing to throw with",
            "return an error, or take the host profile",
        ),
        CheckRule(
            *("catch", None, _E, _E),
            "an exception is caught",
            "the profile builds without exceptions: the handler would never run",
            "test for the error instead, or take the host profile",
        ),
        CheckRule(
            *("rtti", None, _E, _E),
            "dynamic_cast or typeid",
            "the profile builds without run-time type information",
            "use a virtual function, or take the host profile",
        ),
        CheckRule(
            *("exit", _W, _W, _W),
            "exit() or one of its kin",
            "it is made to end this application; the processor and its other applications go on",
            "return from main, or call ros::shutdown()",
        ),
        CheckRule(
            *("abort", _W, _W, _W),
            "abort()",
            "it is made to end this application with an error; the processor and its other applications go on",
            "call ros::shutdown() and return from main",
        ),
        CheckRule(
            *("assert", _W, _W, _W),
            "assert() or std::terminate()",
            "where it is carried out it ends the processor with all of its applications",
            "log and return, or build with NDEBUG",
        ),
        CheckRule(
            *("signal", _W, _E, _E),
            "a signal handler",
            "signals belong to the processor: handlers of SIGINT and SIGTERM run when the application is asked to end, "
            "others never",
            "wait with ros::ok(), which ends when the application is asked to",
        ),
        CheckRule(
            *("heap-in-callback", None, _N, _E),
            "memory is allocated in a callback",
            "memory is the application's own, and does not grow after its start",
            "reserve it before the first callback",
        ),
        CheckRule(
            *("queue-unbounded", _W, _W, _W),
            "a subscription with queue size 0, which in ROS has no bound",
            "memory is set aside when the node starts, so the queue has a bound",
            "say how many messages may wait",
        ),
        CheckRule(
            *("queue-large", _W, _W, _W),
            "a subscription whose queue is longer than a node keeps",
            "memory for all of its messages would be set aside when the node starts",
            "say how many messages may wait, or raise the bound for the node",
        ),
        CheckRule(
            *("thread", _E, _E, _E),
            "a thread that is not cFE's, or a condition that another thread has to make true",
            "cFE knows one task of the node, and calls of ROS are that task's alone; nobody ends the thread with it",
            "use a timer or a callback",
        ),
        CheckRule(
            *("socket", _E, _E, _E),
            "a socket of the operating system, or what waits in boost::asio",
            "cFE does not know of it: it stays open after a restart, and a wait in it holds up the task",
            "use OSAL's sockets, or a bridge application",
        ),
        CheckRule(
            *("serial", _E, _E, _E),
            "a device or terminal of the operating system",
            "a driver belongs to the board: a wait in it holds up the task, and it stays open after a restart",
            "put the device behind a driver application that speaks on the Software Bus",
        ),
        CheckRule(
            *("file", _W, _W, _E),
            "a file of the operating system",
            "the names of files are OSAL's virtual ones on cFE, and this goes past them",
            "use OSAL's files, parameters or a table",
        ),
        CheckRule(
            *("process", _E, _E, _E),
            "another process is started",
            "there are no processes on cFE, but tasks of one",
            "start an application instead",
        ),
        CheckRule(
            *("getchar", _E, _E, _E),
            "the keyboard is read",
            "an application has no keyboard, and a wait for it holds up the task",
            "subscribe to a topic or offer a service",
        ),
        CheckRule(
            *("unused-code", _W, _W, _W),
            "what would refuse the node, in a source of a library that the node links with for something else",
            "what nothing can call is not carried out",
            "nothing, or leave the source out",
        ),
        CheckRule(
            *("sleep", _W, _W, _W),
            "a sleep of the operating system",
            "it is made to wait as ROS's sleeps do, in cFE's time; messages wait meanwhile",
            "use ros::Rate, ros::Duration::sleep or a timer",
        ),
        CheckRule(
            *("topic-not-constant", _W, _W, _W),
            "the name of a topic or service that is computed when the node runs",
            "MsgIds are given out before the node is built: a name that has none ends the application",
            "write the name in the mission file",
        ),
        CheckRule(
            *("message-too-long", _W, _W, _W),
            "a subscription to messages whose structure alone is longer than a packet of the Software Bus",
            "the Software Bus carries packets of 32,768 bytes",
            "take a smaller message, or smaller capacities",
        ),
        CheckRule(
            *("global-state", _N, _N, _N),
            "a variable outside of functions and classes",
            "it is kept apart from other nodes by the way the node is linked, and begins anew at a restart",
            "nothing, where that is what is meant",
        ),
        CheckRule(
            *("static-local", _N, _N, _N),
            "a variable that outlives its function",
            "it is kept apart from other nodes by the way the node is linked, and begins anew at a restart",
            "nothing, where that is what is meant",
        ),
    )
}
"""All rules by id, those that refuse first."""
