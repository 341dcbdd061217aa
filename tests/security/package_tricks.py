"""Tricks of packages and sources: names that lead out of a folder, endless data, pipes in place of files."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from tests.security.tricks import CANARY, HARMLESS, Trick, files_of

MANIFEST = "<package><name>{}</name></package>"
SOURCE = '#include <ros/ros.h>\nint main(int a, char** b) { ros::init(a, b, "n"); ros::NodeHandle h; ros::spin(); }\n'
NODE = '<launch><node pkg="evil" type="n" name="n" required="true"/></launch>'
BUILT = "find_package(catkin REQUIRED COMPONENTS roscpp)\ncatkin_package()\nadd_executable(n src/n.cpp)\n"
START = "CFE_APP, a, A_Main, A, 90, 16384, 0x0, 0;\n!\n"
CONVERT = "convert {}/evil -o {}/out --no-check"
TERABYTE = 1 << 40


def package(
    name: str,
    said: str,
    cmake: str = BUILT,
    source: str = SOURCE,
    called: str = "evil",
    words: str = CONVERT,
    **more: str,
) -> Trick:
    """Return a package that is converted."""
    contents = {
        "evil/package.xml": MANIFEST.format(called),
        "evil/CMakeLists.txt": cmake,
        "evil/src/n.cpp": source,
        "x.launch": NODE,
    }
    return Trick(f"package: {name}", words, said, files_of(contents | more))


def cmake(name: str, said: str, text: str) -> Trick:
    """Return a CMakeLists.txt that is read when a node of a launch file is built."""
    return package(f"cmake, {name}", said, f"{text}\n{BUILT}", words="check {}/x.launch")


def node(name: str, said: str, text: str) -> Trick:
    """Return a node that is checked."""
    return Trick(f"python: {name}", "check {}/n.py", said, files_of({"n.py": f"import rospy\n{text}"}))


def app(name: str, said: str, contents: dict[str, str]) -> Trick:
    """Return an application that is checked."""
    return Trick(f"application: {name}", "check {}", said, files_of({"startup.scr": START, **contents}))


def c_app(name: str, said: str, contents: dict[str, str]) -> Trick:
    """Return an application in C that is built."""
    inside = {f"evil/{file}": text for file, text in contents.items()}
    return Trick(f"application in C: {name}", "build {}/evil", said, files_of({"evil/fsw/src/a.c": "int a;", **inside}))


def with_(trick: Trick, name: str, more: Callable[[Path], object]) -> Trick:
    """Return a trick with another file in its folder."""

    def make(folder: Path) -> None:
        trick.make(folder)
        more(folder)

    return trick._replace(name=f"{trick.name}: {name}", make=make)


def pipe(file: str) -> Callable[[Path], object]:
    """Return a pipe in place of a file."""

    def make(folder: Path) -> None:
        (folder / file).unlink(missing_ok=True)
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        os.mkfifo(folder / file)

    return make


def link(file: str, target: str) -> Callable[[Path], object]:
    """Make a symbolic link; @ is the folder."""

    def make(folder: Path) -> None:
        (folder / file).unlink(missing_ok=True)
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).symlink_to(target.replace("@", str(folder)))

    return make


def holes(file: str) -> Callable[[Path], object]:
    """Return a file of a terabyte, which takes no room."""

    def make(folder: Path) -> None:
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        with (folder / file).open("wb") as made:
            made.truncate(TERABYTE)

    return make


def _circles(folder: Path) -> None:
    """Make links that send a pattern in circles."""
    for name in "abc":
        (folder / "evil" / name).symlink_to(folder / "evil")


def _packages_in_circles(folder: Path) -> None:
    """Packages that depend on each other."""
    for number in range(30):
        depends = "".join(f"<depend>p{each}</depend>" for each in range(30))
        inner = folder / f"p{number}"
        inner.mkdir()
        (inner / "package.xml").write_text(f"<package><name>p{number}</name>{depends}</package>", encoding="utf-8")
        (inner / "CMakeLists.txt").write_text("catkin_package(LIBRARIES l)\nadd_library(l l.cpp)\n", encoding="utf-8")
        (inner / "l.cpp").write_text("int l;\n", encoding="utf-8")


def _doubled(first: str, again: str, times: int = 60) -> str:
    return f"{first}\n" + f"{again}\n" * times


CHAIN = "".join(f"add_library(l{n} src/n.cpp)\ntarget_link_libraries(l{n} l{n + 1})\n" for n in range(8000))
ROUND = '#include "../src/n.h"\n#include "../src/../src/n.h"\n#include "../src/m.h"\n'
NAMED = "invalid package name"
LINKED = "through a symbolic link"
PIPE = "a device or a pipe"

PACKAGE_TRICKS = (
    # -- names that lead out
    package("a name that leads out", NAMED, called=f"../../{CANARY}"),
    package("a name that is a path", NAMED, called=f"/tmp/{CANARY}"),
    package("a name with a NUL", NAMED, called=f"a\0{CANARY}"),
    package("a name of two words", NAMED, called="a b"),
    package("no name", NAMED, called=" "),
    package("a name of a megabyte", NAMED, called="a" * (1 << 20)),
    package("a name that leads out, launched", NAMED, called=f"../{CANARY}", words="check {}/x.launch"),
    with_(package("the folder of packages", LINKED), "leads out", link("out/packages", "@")),
    with_(package("the list of files", LINKED), "is elsewhere", link("out/.cfepy-convert.json", f"@/{CANARY}")),
    with_(package("a file", LINKED), "is elsewhere", link("out/README.md", f"@/{CANARY}")),
    with_(package("a file", "is not a file"), "is a pipe", pipe("out/README.md")),
    with_(package("the list of files", "is not a file"), "is a pipe", pipe("out/.cfepy-convert.json")),
    package(
        "a source that ends CMake's list",
        "CMake does not allow",
        BUILT.replace("src/n.cpp", f'"src/n.cpp;execute_process(COMMAND touch {CANARY}).cpp"'),
        **{f"evil/src/n.cpp;execute_process(COMMAND touch {CANARY}).cpp": SOURCE},
    ),
    c_app(
        "a name that leads out", "invalid application name", {"CMakeLists.txt": f"add_cfe_app(../{CANARY} fsw/src/a.c)"}
    ),
    c_app("a name with a NUL", "invalid application name", {"CMakeLists.txt": 'add_cfe_app("a\0b" fsw/src/a.c)'}),
    c_app("a source elsewhere", "names a missing file", {"CMakeLists.txt": "add_cfe_app(a /none/a.c)"}),
    # -- CMakeLists.txt
    cmake("a word without an end", HARMLESS, "a" * 50_000),
    cmake("words that are no commands", HARMLESS, "a (" * 20_000),
    cmake("a loop of ten milliards", "has a loop of", "foreach(i RANGE 0 9999999999)\nset(x 1)\nendforeach()"),
    cmake("a loop without end", HARMLESS, f"foreach(i RANGE {'9' * 5000})\nendforeach()"),
    cmake("loops in loops", "has a loop of", "foreach(i RANGE 200)\n" * 6 + "endforeach()\n" * 6),
    cmake("a list that doubles", "words of more than", _doubled("set(a x)", "set(a ${a} ${a})")),
    cmake("a text that doubles", "words of more than", _doubled("set(a x)", 'set(a "${a}${a}")')),
    cmake("a text of many of itself", "words of more than", _doubled("set(a x)", f'set(a "{"${a}" * 900}")', 3)),
    cmake("a list that is added to itself", "words of more than", _doubled("set(a x)", "list(APPEND a ${a})")),
    cmake("a function that calls itself", "nested", "function(f)\nf()\nendfunction()\nf()"),
    cmake("macros that call each other", "nested", "macro(f)\ng()\nendmacro()\nmacro(g)\nf()\nendmacro()\ng()"),
    cmake("a folder inside itself", "nested", "add_subdirectory(.)"),
    cmake("conditions 20,000 deep", "nested", "if(UNIX)\n" * 20_000 + "endif()\n" * 20_000),
    cmake("brackets 20,000 deep", "nested", f"if({'(' * 20_000}UNIX{')' * 20_000})\nendif()"),
    cmake("NOT again and again", HARMLESS, f"if({'NOT ' * 20_000}UNIX)\nendif()"),
    cmake("a version of 10,000 digits", HARMLESS, f"if({'1' * 10_000} VERSION_LESS {'2' * 10_000})\nendif()"),
    cmake("an empty component", HARMLESS, 'find_package(catkin REQUIRED "")\nproject("")\nset("")'),
    cmake("20,000 components", HARMLESS, f"find_package(catkin COMPONENTS {' '.join(f'c{n}' for n in range(20_000))})"),
    cmake(
        "a name of a file that is too long",
        HARMLESS,
        f"add_subdirectory({'a' * 5000})\nif(EXISTS {'b' * 5000})\nendif()",
    ),
    cmake(
        "targets with many definitions",
        HARMLESS,
        f"add_definitions({' '.join(f'-Da{n}' for n in range(999))})\n" + "add_library(a)\n" * 999,
    ),
    with_(cmake("a pattern", "match more than", f"file(GLOB x {'*/' * 30}*.cpp)"), "goes round", _circles),
    with_(
        cmake("its file", "more than the limit of 1,048,576 bytes", ""), "of a terabyte", holes("evil/CMakeLists.txt")
    ),
    with_(cmake("its file", HARMLESS, ""), "is a device", link("evil/CMakeLists.txt", "/dev/zero")),
    with_(cmake("its file", "", ""), "is a pipe", pipe("evil/CMakeLists.txt")),
    with_(package("a manifest", HARMLESS, words="check {}/src"), "is a pipe", pipe("evil/package.xml")),
    with_(package("packages", HARMLESS), "depend on each other", _packages_in_circles),
    package("libraries of libraries", "made of more than", f"{BUILT}target_link_libraries(n l0)\n{CHAIN}"),
    # -- C++
    package("comments without an end", HARMLESS, source=SOURCE + "/*" * 20_000),
    package("texts without an end", HARMLESS, source=SOURCE + '"\\' * 20_000),
    package("characters without an end", HARMLESS, source=SOURCE + "'\\" * 20_000),
    package("calls without an end", HARMLESS, source=SOURCE + "subscribe<" * 9_000),
    package("a word without an end", HARMLESS, source=SOURCE + "NodeHandle" * 9_000),
    package("handles without an end", HARMLESS, source=SOURCE + "NodeHandle a," * 6_000),
    package("a handle of itself", "namespaces", source=SOURCE + 'ros::NodeHandle n(n, "a"), m(n, "b");' * 40),
    package(
        "names by the thousand",
        "names of topics",
        source=SOURCE + "".join(f'h.advertise("n{n}");' for n in range(20_000)),
    ),
    with_(package("a header", PIPE, source='#include "p.h"\n' + SOURCE), "is a pipe", pipe("evil/src/p.h")),
    package("a header that is a device", PIPE, source='#include "/dev/zero"\n' + SOURCE),
    package(
        "headers in a circle",
        HARMLESS,
        source='#include "n.h"\n' + SOURCE,
        **{"evil/src/n.h": ROUND, "evil/src/m.h": ROUND},
    ),
    # -- Python
    node("attributes 20,000 deep", "nested too deeply", f"x = 1\nx{'.a' * 20_000}"),
    node("attributes 2,000 deep", "nested too deeply", f"x = 1\nx{'.a' * 2_000}"),
    node("calls 20,000 deep", "nested too deeply", f"x = 1\nx{'()' * 20_000}"),
    node("brackets 20,000 deep", "is not Python", "(" * 20_000),
    node("signs 20,000 deep", "nested too deeply", f"x = {'-' * 20_000}1"),
    node("conditions 3,000 deep", "nested too deeply", "if x:\n pass\n" + "elif x:\n pass\n" * 3_000),
    node("300,000 statements", "words and signs", "x\n" * 300_000),
    with_(node("a script", "more than", ""), "of a terabyte", holes("n.py")),
    app("attributes 20,000 deep", "nested too deeply", {"a.py": f"def A_Main(cfe):\n    cfe{'.a' * 20_000}\n"}),
    app("chains of attributes", HARMLESS, {"a.py": "def A_Main(cfe):\n" + f"    x{'.a' * 800}\n" * 30}),
    app("imports in a circle", HARMLESS, {"a.py": "from .b import *\n", "b.py": "from .a import *\n"}),
    app(
        "500 wrong names and more",
        "has no",
        {"a.py": "def A_Main(cfe):\n" + "".join(f"    cfe.x{n}\n" for n in range(1_000))},
    ),
    with_(app("a module", HARMLESS, {}), "is a pipe", pipe("a.py")),
    with_(app("an object", HARMLESS, {}), "is a pipe", pipe("a.so")),
    with_(app("an object", HARMLESS, {}), "of a terabyte", holes("a.so")),
    # -- files of launches and missions
    with_(
        Trick(
            "launch: an include",
            "check {}/x.launch",
            PIPE,
            files_of({"x.launch": '<launch><include file="@/p"/></launch>'}),
        ),
        "is a pipe",
        pipe("p"),
    ),
    with_(
        Trick(
            "launch: a file of parameters",
            "check {}/x.launch",
            PIPE,
            files_of({"x.launch": '<launch><rosparam file="@/p"/></launch>'}),
        ),
        "is a pipe",
        pipe("p"),
    ),
    with_(package("a node", "", words="check {}/x.launch"), "is a pipe", pipe("evil/scripts/n")),
    *(
        Trick(
            f"launch: an include of {file}",
            "check {}/x.launch",
            "",
            files_of({"x.launch": f'<launch><include file="{file}"/></launch>'}),
        )
        for file in (
            "/dev/stdin",
            "/dev/fd/0",
            "/dev/fd/../../dev/zero",
            "/proc/self/fd/0",
            "/proc/kmsg",
            "/proc/self/mem",
        )
    ),
    Trick("mission: a script of a terabyte", "check {}/startup.scr", "more than", holes("startup.scr")),
    Trick(
        "mission: a launch file with a NUL",
        "check {}",
        "",
        files_of({"startup.scr": "!\n", "mission.yaml": 'launch: ["a\\0b.launch"]\n'}),
    ),
    Trick(
        "mission: a board with a NUL",
        "check {}",
        "",
        files_of({"startup.scr": "!\n", "mission.yaml": 'board: "a\\0/b.yaml"\n'}),
    ),
    Trick(
        "mission: parameters with a NUL",
        "check {}",
        "",
        files_of({"startup.scr": "!\n", "mission.yaml": 'params_from: ["a\\0b.yaml"]\n'}),
    ),
    Trick(
        "mission: parameters of a device",
        "check {}",
        "file not found",
        files_of({"startup.scr": "!\n", "mission.yaml": "params_from: [/dev/stdin]\n"}),
    ),
    Trick(
        "results: nested 100,000 deep", "explore --replay-all {}/r.json", "", files_of({"r.json": "[" * 100_000 + "\n"})
    ),
    *(
        Trick(f"a pipe: {words}", f"{words} {{}}/p", PIPE, pipe("p"))
        for words in ("replay --info", "rosbag recover", "log", "tbl show", "rosparam build")
    ),
)
