"""Damaged sources for the check: `python -m dev.convert.mutate --files N [--seed S] [--sources FOLDER]`.

Each file is a damaged node, from this module or from a folder. The damages are: tokens removed, doubled and exchanged,
a truncated end, junk bytes, unmatched braces, deep nesting. The check must terminate, and must not call a file clean
that the compiler rejects. The compiler is started separately here, and only for the few files that the check calls
clean. Nodes of this module are compiled against a stub of roscpp of a few lines, so that ten thousand of them take
less than an hour instead of days. Of the nodes of a folder, one in fifty is compiled against the interface library.
"""

from __future__ import annotations

import argparse
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from cfepy.extra.convert import Profile
from cfepy.extra.convert.build import LANGUAGE, BuildOptions, library_includes, profile_flags
from cfepy.extra.convert.cpp_package import CppPackage, Program
from cfepy.extra.convert.message_headers import write_headers
from cfepy.extra.convert.node_check import check_program
from cfepy.status import UsageError
from rospy_shim.types.msgs import shipped

STUB = {
    "ros/ros.h": """#ifndef STUB_ROS_H
#define STUB_ROS_H
namespace std_msgs { struct String { typedef const String *ConstPtr; const char *data; }; }
namespace ros {
struct Subscriber { };
struct Publisher { template <class M> void publish(const M &) const { } };
struct TimerEvent { };
struct Duration { explicit Duration(double) { } };
struct Timer { };
struct NodeHandle {
  NodeHandle(const char * = "") { }
  template <class M> Publisher advertise(const char *, int, bool = false) { return Publisher(); }
  template <class F> Subscriber subscribe(const char *, int, F) { return Subscriber(); }
  template <class M, class T> Subscriber subscribe(const char *, int, void (T::*)(M), T *) { return Subscriber(); }
  template <class T> Timer createTimer(Duration, void (T::*)(const TimerEvent &), T *) { return Timer(); }
  template <class T> bool param(const char *, T &, const T &) { return true; }
};
inline void init(int, char **, const char *) { }
inline bool ok() { return false; }
inline void spin() { }
inline void shutdown() { }
}
#define ROS_INFO(...) do { } while (0)
#endif
"""
}
NODES = (
    """#include <ros/ros.h>
/* A talker. */
static int count = 0;
int main(int argc, char **argv)
{
  ros::init(argc, argv, "talker");
  ros::NodeHandle n("~");
  ros::Publisher pub = n.advertise<std_msgs::String>("chatter", 1000);
  while (ros::ok()) {
    std_msgs::String message = { "text \\"quoted\\" // no comment" };
    pub.publish(message);
    ++count;
  }
  return count > 3 ? 1 : 0;
}
""",
    """#include <ros/ros.h>
#define TOPIC "chatter"
namespace ear {
template <class T> struct Pair { T first, second; };
class Listener {
 public:
  explicit Listener(ros::NodeHandle &n) : limit_(3) {
    sub_ = n.subscribe(TOPIC, 10, &Listener::heard, this);
    timer_ = n.createTimer(ros::Duration(0.5), &Listener::tick, this);
    n.param<int>("limit", limit_, 7);
  }
 private:
  void heard(const std_msgs::String::ConstPtr &message) { if (message->data) { ++seen_.first; } }
  void tick(const ros::TimerEvent &) { ROS_INFO("%d of %d", seen_.first, limit_); }
  ros::Subscriber sub_;
  ros::Timer timer_;
  Pair<int> seen_ = { 0, 0 };
  int limit_;
};
}  // namespace ear
int main(int argc, char **argv)
{
  ros::init(argc, argv, "listener");
  ros::NodeHandle n;
  ear::Listener listener(n);
#ifdef NEVER
  #include <none.h>
#else
  ros::spin();
#endif
}
""",
    """#include <ros/ros.h>
enum Mode { IDLE = 0, RUN = 0x1F, STOP = 'c' };
static const char kRaw[] = R"x(raw "text" )x";
void heard(std_msgs::String::ConstPtr) { }
int main()
{
  ros::NodeHandle n;
  auto on = [&n](std_msgs::String::ConstPtr m) -> void { switch (RUN) { case RUN: break; default: (void)m; } };
  ros::Subscriber a = n.subscribe("a", 0, on), b = n.subscribe("b", 1, heard);
  for (int i = 0; i < 3; ++i) { do { ros::spin(); } while (false); }
  goto end;
end:
  return sizeof(kRaw) == 12;
}
""",
)
_TOKEN = re.compile(rb'"(?:[^"\\\n]|\\.)*"|\w+|\s+|.', re.DOTALL)
_LONGEST = 60_000  # bytes of a node that is taken from a folder
_OF_FOLDER = 0.02  # of all files: those take seconds each
_HEADER = re.compile(rb"#include\s*[<\"](\w+/\w+)\.h[>\"]")
OWN = Path(__file__).parents[2] / "tests/extra/convert"


class Outcome(NamedTuple):
    """Result of checking a damaged file.

    Attributes:
        kind: kind of the damage.
        of_folder: whether it is compiled against the interface library.
        refused: whether the check refuses it.
        problem: what is wrong with the check; empty if nothing is.
    """

    kind: str
    of_folder: bool
    refused: bool
    problem: str


def _tokens(source: bytes) -> list[bytes]:
    return _TOKEN.findall(source)


def _delete(chance: random.Random, source: bytes) -> bytes:
    tokens = _tokens(source)
    for _ in range(chance.randint(1, 3)):
        del tokens[chance.randrange(len(tokens))]
    return b"".join(tokens)


def _double(chance: random.Random, source: bytes) -> bytes:
    tokens = _tokens(source)
    at = chance.randrange(len(tokens))
    tokens[at:at] = tokens[at : at + chance.randint(1, 5)] * chance.choice((1, 1, 1, 50))
    return b"".join(tokens)


def _exchange(chance: random.Random, source: bytes) -> bytes:
    tokens = _tokens(source)
    a, b = chance.randrange(len(tokens)), chance.randrange(len(tokens))
    tokens[a], tokens[b] = tokens[b], tokens[a]
    return b"".join(tokens)


def _cut(chance: random.Random, source: bytes) -> bytes:
    return source[: chance.randrange(len(source))]


def _junk(chance: random.Random, source: bytes) -> bytes:
    at = chance.randrange(len(source))
    return source[:at] + chance.randbytes(chance.choice((1, 3, 200, 5000))) + source[at:]


def _brace(chance: random.Random, source: bytes) -> bytes:
    at = chance.randrange(len(source))
    more = chance.choice((b"{", b"}", b"(", b")", b"<", b'"', b"'", b"/*", b"#if 1\n", b"\n#endif\n", b"\\\n"))
    return source[:at] + more * chance.choice((1, 1, 2, 30)) + source[at:]


def _nest(chance: random.Random, source: bytes) -> bytes:
    depth = chance.choice((10, 100, 1000, 20_000))
    left, right = chance.choice(
        ((b"(", b")"), (b"{", b"}"), (b"[", b"]"), (b"A<", b">"), (b"-", b""), (b"if(1)", b";"))
    )
    deep = b"\nint deep() { return " + left * depth + b"1" + right * depth + b"; }\n"
    return source + deep if chance.random() < 0.5 else deep + source


def _byte(chance: random.Random, source: bytes) -> bytes:
    damaged = bytearray(source)
    for _ in range(chance.randint(1, 4)):
        damaged[chance.randrange(len(damaged))] = chance.randrange(256)
    return bytes(damaged)


def _include(chance: random.Random, source: bytes) -> bytes:
    names = (
        b"<>",
        b'""',
        b"<",
        b"<.>",
        b'"/"',
        b"<a\0b>",
        b"NAME",
        b"<" + b"x" * 5000 + b">",
        b'"node.cpp"',
        b"<vector>",
    )
    return b"#include " + chance.choice(names) + b"\n" + source


DAMAGES: dict[str, Callable[[random.Random, bytes], bytes]] = {
    "token deleted": _delete,
    "tokens doubled": _double,
    "tokens exchanged": _exchange,
    "end cut off": _cut,
    "junk put in": _junk,
    "brace put in": _brace,
    "deep nesting": _nest,
    "bytes changed": _byte,
    "include put in": _include,
}


class Damaging:
    """Damages nodes and compares the check with the compiler.

    Args:
        seed: seed of the random numbers.
        folder: folder for the files.
        sources: folder with more nodes.
    """

    def __init__(self, seed: int, folder: Path, sources: Path = OWN) -> None:
        self._chance = random.Random(seed)
        self._folder = folder
        self._stub = folder / "stub"
        for name, text in STUB.items():
            (self._stub / name).parent.mkdir(parents=True, exist_ok=True)
            (self._stub / name).write_text(text, encoding="utf-8")
        self._nodes = [each.encode() for each in NODES]
        found = sorted(sources.rglob("*.cpp"))
        self._others = [each.read_bytes() for each in found if 0 < each.stat().st_size < _LONGEST]
        self._messages: dict[Profile, Path] = {}

    def outcomes(self, count: int) -> Iterator[Outcome]:
        """Damage so many files, and check each."""
        for _ in range(count):
            chance = self._chance
            of_folder = bool(self._others) and chance.random() < _OF_FOLDER
            source = chance.choice(self._others if of_folder else self._nodes)
            kind = chance.choice(sorted(DAMAGES))
            yield self.check(kind, DAMAGES[kind](chance, source), of_folder)

    def check(self, kind: str, source: bytes, of_folder: bool) -> Outcome:
        """Compare the check with the compiler for one file. `of_folder` compiles it against the interface library."""
        file = self._folder / "node.cpp"
        file.write_bytes(source)
        includes = [] if of_folder else [self._stub]
        program = Program(CppPackage("", self._folder), "node", [file], includes)
        profile = self._chance.choice(list(Profile))
        try:
            report = check_program(program, profile, {})
        except Exception as error:  # any exception is a finding here
            return Outcome(kind, of_folder, False, f"{type(error).__name__}: {error}"[:200])
        clean = not report.is_refused
        wrong = clean and not self._compiles(file, includes or [self._headers(profile)], profile)
        return Outcome(kind, of_folder, not clean, "clean, but it does not compile" if wrong else "")

    def _headers(self, profile: Profile) -> Path:
        """Return the headers of all messages that the nodes of the folder and the library include, as far as known."""
        if profile not in self._messages:
            made = self._messages[profile] = self._folder / f"messages_{profile.name}"
            made.mkdir()
            library = [each.read_bytes() for folder in library_includes() for each in sorted(folder.rglob("*.h"))]
            named = {name.decode() for each in (*self._others, *library) for name in _HEADER.findall(each)}
            for name in sorted(named):
                with suppress(UsageError):
                    write_headers([name], made, profile, shipped())
        return self._messages[profile]

    def _compiles(self, file: Path, includes: list[Path], profile: Profile) -> bool:
        """Return whether the plain compiler accepts a file."""
        folders = [f"-I{each}" for each in (*includes, *library_includes())]
        command = [
            "g++",
            LANGUAGE[0],
            *profile_flags(BuildOptions(profile)),
            "-w",
            "-fsyntax-only",
            *folders,
            str(file),
        ]
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, check=False)
        return done.returncode == 0


def main() -> int:
    """Damage files and report the results."""
    parser = argparse.ArgumentParser(prog="python -m dev.convert.mutate", description=__doc__)
    parser.add_argument("--files", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--sources", type=Path, default=OWN, help="a folder with more nodes (default: the folder of the tests)"
    )
    arguments = parser.parse_args()
    counts: Counter[str] = Counter()
    with tempfile.TemporaryDirectory(prefix="cfepy-mutate-") as folder:
        damaging = Damaging(arguments.seed, Path(folder), arguments.sources)
        for number, each in enumerate(damaging.outcomes(arguments.files), 1):
            counts.update(["refused" if each.refused else "clean", "against the library"][: 1 + each.of_folder])
            if each.problem:
                counts["wrong"] += 1
                print(f"{number} ({each.kind}): {each.problem}", flush=True)
            if number % 500 == 0:
                print(number, dict(counts), flush=True)
    print(f"{arguments.files} files, seed {arguments.seed}: {dict(counts)}")
    return 1 if counts["wrong"] else 0


if __name__ == "__main__":
    sys.exit(main())
