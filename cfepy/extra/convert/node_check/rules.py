"""The rules of `cfepy convert check`: each with its criterion, its level, the reason, and the remedy.

docs/how_to/convertor.md has this table too; a test checks that they are the same.
"""

from __future__ import annotations

from enum import StrEnum
from typing import NamedTuple

from cfepy.extra.convert.message_headers import Profile


class Level(StrEnum):
    """The level of a finding: an error refuses the node; a warning and a note do not. The words are SARIF's."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


class CheckRule(NamedTuple):
    """A rule.

    Attributes:
        id: its name, by which findings and `#error` texts of headers refer to it.
        host, pool, strict: its level by profile; None where it does not apply.
        what: the code that it looks for.
        why: the reason why that matters on cFE.
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
        """Return its level in a profile; None if it does not apply."""
        return {Profile.HOST: self.host, Profile.POOL: self.pool, Profile.STRICT: self.strict}[profile]


_E, _W, _N = Level.ERROR, Level.WARNING, Level.NOTE

RULES: dict[str, CheckRule] = {
    rule.id: rule
    for rule in (
        CheckRule(
            *("compile-error", _E, _E, _E),
            "the compiler refuses the source for a reason that no other rule names",
            "a source must compile to be converted",
            "fix the source, or name the folders of its headers in its CMakeLists.txt",
        ),
        CheckRule(
            *("file-unreadable", _E, _E, _E),
            "a source that cannot be read, or is larger than a source is",
            "a source that cannot be read cannot be checked",
            "name a source file in C++",
        ),
        CheckRule(
            *("include-unknown", _E, _E, _E),
            "a header that is not found",
            "its declarations are missing, so the node cannot be built",
            "put its package next to this one, or on ROS_PACKAGE_PATH",
        ),
        CheckRule(
            *("library-outside", _E, _E, _E),
            "a header of a library from outside ROS",
            "cfepy has no build of the library for cFE",
            "leave the library out, or build the node with it by hand",
        ),
        CheckRule(
            *("gtest", _E, _E, _E),
            "a test program of GoogleTest",
            "a test is not part of the flight software: it runs on cfepy, with GoogleTest of this computer",
            "leave it in place; `cfepy rostest` runs it",
        ),
        CheckRule(
            *("ros-library", _E, _E, _E),
            "a header of a ROS library that is not in the interface library",
            "the node would be built with another ROS, whose code waits in threads and sockets",
            "leave the library out; docs/how_to/convertor.md lists the available libraries",
        ),
        CheckRule(
            *("boost-header", _E, _E, _E),
            "a header of Boost that the profile has no build of",
            "pool and strict have the small Boost of the interface library; host takes a Boost that is installed",
            "use the standard library, or the host profile with Boost installed",
        ),
        CheckRule(
            *("system-ros", _E, _E, _E),
            "a header of a ROS that is installed on this computer",
            "two libraries with the same names cannot be combined in one program",
            "report it: the interface library should have refused the header",
        ),
        CheckRule(
            *("api-missing", _E, _E, _E),
            "a class, function or overload of ROS that the interface library does not have",
            "it is not implemented on cFE",
            "use another call; docs/how_to/convertor.md lists the available calls",
        ),
        CheckRule(
            *("undefined-name", _E, _E, _E),
            "a function or a variable that is declared and used, and that no source of the node defines",
            "the application cannot be loaded",
            "name the source that defines it in CMakeLists.txt; a library from outside has no build for cFE",
        ),
        CheckRule(
            *("message-definition", _E, _E, _E),
            "a message whose definition is wrong, or names a missing message",
            "its header cannot be generated",
            "fix the .msg, .srv or .action file, or put the package of the other message on ROS_PACKAGE_PATH",
        ),
        CheckRule(
            *("configuration", _E, _E, _E),
            "a script in cfg/ that fails",
            "the header of the configuration cannot be generated from it",
            "fix the script; it is run as by a catkin build",
        ),
        CheckRule(
            *("capacity-missing", None, None, _E),
            "an array of messages without a capacity",
            "a message has a fixed size in this profile, and such arrays multiply",
            "set the capacity of the field under `cpp_nodes:` in a mission file",
        ),
        CheckRule(
            *("arena-too-small", None, _E, _E),
            "the messages of all subscriptions do not fit into the node's arena",
            "the node reserves their memory when it starts",
            "give a larger `arena_bytes` under `cpp_nodes:` of a mission file, smaller capacities, or shorter queues",
        ),
        CheckRule(
            *("main-form", _E, _E, _E),
            "main is missing, defined twice, or has other parameters than () or (int, char **)",
            "the entry point of the application calls it",
            "define one `int main()` or `int main(int argc, char **argv)`",
        ),
        CheckRule(
            *("throw", None, _W, _E),
            "an exception is thrown",
            "in the pool profile an exception takes memory of the arena, and the image grows by tables; the strict "
            "profile builds without exceptions",
            "return an error, or take the host profile",
        ),
        CheckRule(
            *("catch", None, _W, _E),
            "an exception is caught",
            "as throw; in the strict profile the handler would never run",
            "test for the error instead, or take the host profile",
        ),
        CheckRule(
            *("rtti", None, _W, _E),
            "dynamic_cast or typeid",
            "in the pool profile the node gets run-time type information; the strict profile has none",
            "use a virtual function, or take the host profile",
        ),
        CheckRule(
            *("exit", _W, _W, _W),
            "exit() or a similar function",
            "cfepy makes it end only this application; the processor and other applications continue",
            "return from main, or call ros::shutdown()",
        ),
        CheckRule(
            *("abort", _W, _W, _W),
            "abort()",
            "cfepy makes it end only this application, with an error; the processor and other applications continue",
            "call ros::shutdown() and return from main",
        ),
        CheckRule(
            *("assert", _W, _W, _W),
            "assert() or std::terminate()",
            "if it fails, it ends the processor with all its applications",
            "log and return, or build with NDEBUG",
        ),
        CheckRule(
            *("signal", _W, _E, _E),
            "a signal handler",
            "signals belong to the processor: handlers of SIGINT and SIGTERM run when the application must end, "
            "other handlers never run",
            "wait with ros::ok(), which becomes false when the application must end",
        ),
        CheckRule(
            *("heap-in-callback", None, _N, _E),
            "memory is allocated in a callback",
            "an application does not allocate memory after its start",
            "reserve it before the first callback",
        ),
        CheckRule(
            *("queue-unbounded", _W, _W, _W),
            "a subscription with queue size 0, which in ROS has no bound",
            "the node reserves memory when it starts, so the queue needs a bound",
            "set the number of messages that may wait",
        ),
        CheckRule(
            *("queue-large", _W, _W, _W),
            "a subscription whose queue is longer than the bound of a node",
            "the node would reserve memory for all of its messages when it starts",
            "set the number of messages that may wait, or raise the bound for the node",
        ),
        CheckRule(
            *("thread", _W, _E, _E),
            "a thread, or a condition that another thread has to make true",
            "in the profile host each thread becomes a child task of the application, and one runs until it waits; in "
            "the other profiles a node is one task",
            "use a timer or a callback, or take the host profile",
        ),
        CheckRule(
            *("socket", _E, _E, _E),
            "a socket of the operating system, or a wait in boost::asio",
            "cFE does not close it at a restart, and a wait in it blocks the task",
            "use OSAL's sockets, or a bridge application",
        ),
        CheckRule(
            *("serial", _E, _E, _E),
            "a device or terminal of the operating system",
            "a driver belongs to the board: a wait in it blocks the task, and it stays open after a restart",
            "write a driver application that sends the data over the Software Bus",
        ),
        CheckRule(
            *("file", _W, _W, _E),
            "a file of the operating system",
            "file names on cFE are OSAL's virtual names, and this call does not use them",
            "use OSAL's files, parameters or a table",
        ),
        CheckRule(
            *("host-function", _E, _E, _E),
            "a call of a function of C or POSIX that needs the operating system, such as tmpfile() or mkfifo()",
            "cfepy ends the node at the call",
            "use the function of OSAL or cFE that the message names, or a call of ROS",
        ),
        CheckRule(
            *("process", _E, _E, _E),
            "another process is started",
            "cFE runs all applications as tasks of one process",
            "start an application instead",
        ),
        CheckRule(
            *("getchar", _E, _E, _E),
            "the keyboard is read",
            "an application has no keyboard, and the wait blocks the task",
            "subscribe to a topic or offer a service",
        ),
        CheckRule(
            *("unused-code", _W, _W, _W),
            "code that would be refused, in a library source that the node links for another purpose",
            "code that cannot be called never runs",
            "nothing, or leave the source out",
        ),
        CheckRule(
            *("sleep", _W, _W, _W),
            "a sleep of the operating system",
            "cfepy makes it wait like ROS's sleeps, in cFE's time; messages wait in the meantime",
            "use ros::Rate, ros::Duration::sleep or a timer",
        ),
        CheckRule(
            *("topic-not-constant", _W, _W, _W),
            "the name of a topic or service that is computed when the node runs",
            "MsgIds are assigned before the node is built: a name without a MsgId ends the application",
            "write the name in the mission file",
        ),
        CheckRule(
            *("message-too-long", _W, _W, _W),
            "a subscription to messages whose structure alone is longer than a packet of the Software Bus",
            "the Software Bus carries packets of 32,768 bytes",
            "use a smaller message, or smaller capacities",
        ),
        CheckRule(
            *("global-state", _N, _N, _N),
            "a variable outside of functions and classes",
            "each node is linked with its own copy, which is initialized again at a restart",
            "nothing, if this is intended",
        ),
        CheckRule(
            *("static-local", _N, _N, _N),
            "a variable that outlives its function",
            "each node is linked with its own copy, which is initialized again at a restart",
            "nothing, if this is intended",
        ),
    )
}
"""All rules by id, those that refuse first."""
