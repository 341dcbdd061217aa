"""Fifty tricks of an adversary: files that try to run code, to leave their folder, or to exhaust memory and time.

Each makes files in a folder and names the words of the command that reads them. Code that runs would write the canary,
and a path that leaves the folder leads to the canary.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.ground.bag import storage
from dev.fuzz.kinds import DATA
from dev.fuzz.sample_journal import with_frames

CANARY = "canary"
HARMLESS = ""
"""In place of what the error says: there is none, and nothing happens."""


class Trick(NamedTuple):
    """A trick.

    Attributes:
        name: its attempt.
        words: words of the command, with `{}` for the folder.
        said: text of the error, or `HARMLESS` for none.
        make: makes its files in a folder.
    """

    name: str
    words: str
    said: str
    make: Callable[[Path], object]


def _file(name: str, content: str | bytes) -> Callable[[Path], object]:
    """Make one file; @ in its text is the folder."""

    def make(folder: Path) -> None:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.replace("@", str(folder)).encode())

    return make


def _files(**contents: str) -> Callable[[Path], object]:
    """Make several files; two underscores in a name stand for a point."""

    def make(folder: Path) -> None:
        for name, content in contents.items():
            _file(name.replace("__", "."), content)(folder)

    return make


def files_of(contents: Mapping[str, str]) -> Callable[[Path], object]:
    """Make files by their paths; @ in their texts is the folder."""

    def make(folder: Path) -> None:
        for name, content in contents.items():
            _file(name, content)(folder)

    return make


def launch(name: str, said: str, body: str) -> Trick:
    """Return a launch file that is checked."""
    return Trick(name, "check {}/x.launch", said, _file("x.launch", f"<launch>\n{body}\n</launch>\n"))


def expression(name: str, said: str, text: str) -> Trick:
    """Return an expression in a launch file."""
    text = text.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
    return launch(f"eval: {name}", said, f'<param name="p" value="$(eval {text})"/>')


def parameters(name: str, said: str, text: str) -> Trick:
    """Return a file of parameters, built into tables."""
    return Trick(f"yaml: {name}", "rosparam build {}/robot.yaml -o {}/out", said, _file("robot.yaml", text))


def mission(name: str, said: str, text: str, **more: str) -> Trick:
    """Return a mission file that is checked."""
    start = "CFE_APP, hk, HK_AppMain, HK, 90, 16384, 0x0, 0;\n!\n"
    return Trick(f"mission: {name}", "check {}", said, _files(startup__scr=start, mission__yaml=text, **more))


def journal(name: str, said: str, change: Callable[[str, dict[str, Any], Path], object], words: str) -> Trick:
    """Return a trick with a journal of changed frames."""

    def make(folder: Path) -> None:
        with_frames(folder / "run.cfepy", lambda kind, body: change(kind, body, folder))

    return Trick(f"journal: {name}", f"{words} {{}}/run.cfepy", said, make)


def _look(**values: Any) -> Callable[[str, dict[str, Any], Path], object]:
    def change(kind: str, body: dict[str, Any], folder: Path) -> None:
        if kind == "look":
            body.update(values)

    return change


def _look_through_link() -> Callable[[str, dict[str, Any], Path], object]:
    """Return a link, and a link to be created through it."""
    names = iter(["/way", f"/way/{CANARY}"])

    def change(kind: str, body: dict[str, Any], folder: Path) -> None:
        if kind == "look":
            body.update(path=next(names, body["path"]), kind="link", target=str(folder))

    return change


def _path_of_file(path: str) -> Callable[[str, dict[str, Any], Path], object]:
    def change(kind: str, body: dict[str, Any], folder: Path) -> None:
        if kind == "file":
            body["path"] = path.replace("@", str(folder))

    return change


def _packed(size: int, data: bytes) -> Callable[[str, dict[str, Any], Path], object]:
    def change(kind: str, body: dict[str, Any], folder: Path) -> None:
        if kind == "file":
            body.update(size=size, packed=zlib.compress(data), sha256=sha256(data).hexdigest())

    return change


def _header(**changes: Any) -> Callable[[str, dict[str, Any], Path], object]:
    def change(kind: str, body: dict[str, Any], folder: Path) -> None:
        if kind == "header":
            body.update(changes)

    return change


def _linked(kind: str, body: dict[str, Any], folder: Path) -> None:
    """Turn a file that the journal does not carry into a link, through which another file is to be written."""
    if kind == "file" and body["path"].endswith("startup.scr"):
        body.update(path=f"{folder}/run.cfepy", size=0, sha256="", packed=None)
    elif kind == "file":
        data = b"x"
        body.update(
            path=f"{folder}/run.cfepy/{CANARY}", size=1, sha256=sha256(data).hexdigest(), packed=zlib.compress(data)
        )


def _bag_bomb(folder: Path) -> None:
    """Make a chunk of 20 MB of zeros in a few hundred bytes. The limit is smaller for it."""
    header = {
        "type": "std_msgs/String",
        "md5sum": "992ce8a1687cec8c8bd883ec73ca41d1",
        "message_definition": "string data",
    }
    with (folder / "x.bag").open("w+b") as file:
        bag = storage().BagFile(file)
        bag.create()
        bag.write(bag.connect("/chatter", header, "bz2"), 10**9, bytes(20_000_000), "bz2")
        bag.finish()


def _damaged_lz4(folder: Path) -> None:
    data = bytearray((DATA / "bags/golden_api_lz4.bag").read_bytes())
    at = data.index(b"\x04\x22\x4d\x18")
    data[at + 20 : at + 60] = bytes(40)
    (folder / "x.bag").write_bytes(data)


def _wide_includes(folder: Path) -> None:
    """Make seven files, each of which includes the next one ten times: ten million tags."""
    for level in range(7):
        inner = f'<include file="$(dirname)/l{level + 1}.launch"/>\n' * 10
        (folder / f"l{level}.launch").write_text(
            f"<launch>{inner if level < 6 else '<node/>' * 10}</launch>", encoding="utf-8"
        )
    (folder / "x.launch").write_text('<launch><include file="$(dirname)/l0.launch"/></launch>', encoding="utf-8")


def _messages(package: str, text: str) -> Callable[[Path], object]:
    """Return a package with a message, and a node that imports it."""
    return _files(
        **{
            "package__xml": f"<package><name>{package}</name></package>",
            "msg/Bomb__msg": text,
            "node__py": f"import rospy\nfrom {package}.msg import Bomb\nrospy.init_node('n')\n",
        }
    )


def definition(name: str, said: str, text: str) -> Trick:
    """Return a trick with a message definition of a package whose node is checked."""
    package = name.replace(" ", "_").replace(",", "").replace("50", "p50")
    return Trick(f"msg: {name}", "check {}/node.py", said, _messages(package, text))


ESCAPE = "[g.gi_frame.f_back.f_back for g in [(x for x in [1])]]"
WRITE = "open('@/canary', 'w')"
NESTED = "".join(f"x{level}: &x{level} [{', '.join([f'*x{level - 1}'] * 9)}]\n" for level in range(1, 12))
LAUGHS_IN_XML = f"x0: &x0 [1]\n{NESTED}".replace("&", "&amp;")
ENTITIES = "".join(f'<!ENTITY e{level} "{f"&e{level - 1};" * 10}">' for level in range(1, 12))
MANY = "\n".join(f"int32 f{number}" for number in range(50_000))

EXPORT = "export csv {}/x.bag /chatter.data -o {}/out"

TRICKS = (
    expression("a generator's frames lead to builtins", "which is not allowed in expressions in files", ESCAPE),
    expression("opens a file", "name 'open' is not defined", WRITE),
    expression("imports", "two underscores", "__import__('os').system('touch @/canary')"),
    expression("the classes of an object", "two underscores", "().__class__.__base__.__subclasses__()"),
    expression("an attribute by its name", "name 'getattr' is not defined", "getattr('', '_' + '_class_' + '_')"),
    expression("a format reaches attributes", "name a value without attributes or items", "'{0._x}'.format(arg)"),
    expression(
        "a format builds the underscores",
        "name a value without attributes or items",
        "('{0._' + '_class_' + '_}').format(1)",
    ),
    expression("a lambda", "which is not allowed in expressions in files", "(lambda: 1)()"),
    expression("an assignment", "which is not allowed in expressions in files", "(x := 5)"),
    expression("the code of a function", "is not allowed", "env.func_globals"),
    expression("9**9**9", "bits", "9**9**9**9"),
    expression("a text of gigabytes", "characters or items", "'a' * 9999999999"),
    expression("a list of lists of lists", "characters or items", "str([[[0] * 1000] * 1000] * 1000)"),
    expression("a width of gigabytes", "widths below 10,000", "'%999999999d' % 1"),
    expression("a width in a format", "widths below 10,000", "'{:999999999}'.format(1)"),
    expression("a range without end", "characters or items", "sum(range(10**12))"),
    expression("a factorial", "combinations of more than", "factorial(10**7)"),
    expression("loops in loops", "steps", "[0 for a in range(999) for b in range(999) for c in range(999)]"),
    expression("brackets in brackets", "inside each other", "-" * 5000 + "1"),
    launch("rosparam: !radians runs code", "invalid angle", "<rosparam>a: !radians open('@/canary', 'w')</rosparam>"),
    launch("rosparam: an object", "is not YAML", "<rosparam>a: !!python/object/apply:os.system [x]</rosparam>"),
    launch("rosparam: rad of 9**9**9", "invalid angle", "<rosparam>a: rad(9**9**9)</rosparam>"),
    launch(
        "rosparam: billion laughs",
        "values when its aliases",
        f"<rosparam>\n{LAUGHS_IN_XML}</rosparam>",
    ),
    launch(
        "rosparam: an alias inside itself",
        "contains itself",
        "<rosparam>a: &amp;a [*a]</rosparam>",
    ),
    launch("rosparam: 5,000 lists", "nested too deeply", f"<rosparam>a: {'[' * 5000}</rosparam>"),
    launch("rosparam: a device", "a device or a pipe", '<rosparam file="/dev/zero"/>'),
    launch("command starts a program", "cannot start the program", '<param name="p" command="touch @/canary"/>'),
    launch("command hides another", "No such file", '<param name="p" command="cat none; touch @/canary"/>'),
    launch("textfile of a device", "a device or a pipe", '<param name="p" textfile="/dev/zero"/>'),
    launch("binfile of a device", "a device or a pipe", '<param name="p" binfile="/dev/urandom"/>'),
    launch(
        "an argument that doubles itself",
        "characters",
        '<arg name="a0" default="aaaaaaaaaa"/>'
        + "".join(f'<arg name="a{n + 1}" default="{f"$(arg a{n})" * 10}"/>' for n in range(12)),
    ),
    launch("tags 20,000 deep", "nested more than", "<group>" * 20_000),
    launch("a million nodes", "exceeds the limit", '<node pkg="p" type="t" name="n"/>' * 11_000),
    launch("a test that is tried without end", "to 1e+09", '<test test-name="t" pkg="p" type="t" retry="1e999"/>'),
    launch(
        "a node that is awaited without end",
        "to 1e+09",
        '<node name="n" pkg="p" type="t" respawn="true" respawn_delay="inf"/>',
    ),
    launch("yaml again and again", "becomes too large", f"<rosparam>a: {'x' * 20_000}</rosparam>" * 60),
    launch("a prefix that is a program", HARMLESS, '<node pkg="p" type="t" name="n" launch-prefix="touch @/canary"/>'),
    Trick(
        "xml: entities in entities",
        "check {}/x.launch",
        "entity 'e1' must be a short text",
        _file("x.launch", f'<!DOCTYPE l [<!ENTITY e0 "x">{ENTITIES}]><launch a="&e11;"/>'),
    ),
    Trick(
        "xml: an entity that is a file",
        "check {}/x.launch",
        "entity 'e' must be a short text",
        _file("x.launch", '<!DOCTYPE l [<!ENTITY e SYSTEM "file:///etc/passwd">]><launch>&e;</launch>'),
    ),
    Trick("launch: includes that multiply", "check {}/x.launch", "becomes too large", _wide_includes),
    Trick(
        "launch: a file that includes itself twice",
        "check {}/x.launch",
        "includes itself",
        _file(
            "x.launch", '<launch><include file="$(dirname)/x.launch"/><include file="$(dirname)/x.launch"/></launch>'
        ),
    ),
    parameters("an object", "unknown tag", "a: !!python/object/apply:os.system ['touch @/canary']"),
    parameters("a date without a date", "invalid timestamp", "a: !!timestamp soon"),
    parameters("billion laughs", "values when its aliases", f"x0: &x0 [1]\n{NESTED}"),
    parameters("a number of a million digits", "digits", f"a: {'1:' * 500_000}1"),
    mission("an application outside of the mission", "", "nodes: {}\n"),
    mission("times without end", "", "deadlines: [{pipe: HK, within: 1e999}]\n"),
    mission(
        "an invariant is not executed by a check",
        "invariants",
        "invariants: [{name: a, on: /x, file: bad.py, function: f}]\n",
        bad__py=f"{WRITE}\ndef f(m):\n    return True\n",
    ),
    mission(
        "a table and an application are not executed by a check",
        HARMLESS,
        "nodes: {}\n",
        hk__py=f"{WRITE}\ndef HK_AppMain(cfe):\n    pass\n",
    ),
    Trick(
        "check: a node is not executed",
        "check {}/x.launch",
        "",
        _files(
            x__launch='<launch><node pkg="arm" type="node.py" name="n"/></launch>',
            package__xml="<package><name>arm</name></package>",
            node__py=f"from arm.cfg import ThingConfig\n{WRITE}\n",
            setup__py=WRITE,
            **{"cfg/Thing__cfg": f"#!/usr/bin/env python\n{WRITE}\n"},
        ),
    ),
    definition("50,000 fields", "at most 5,000 fields", MANY),
    definition("an array of terabytes", "values in fixed arrays", "uint8[999999999999] a"),
    definition("a type inside itself", "contains itself", "a_type_inside_itself/Bomb b"),
    definition("a name that is code", "is not a field name", "int32 a;import_os\nint32 b):__import__('os')#"),
    Trick(
        "bag: a chunk that unpacks to gigabytes",
        "export csv {}/x.bag /chatter.data -o {}/out",
        "when it is unpacked",
        _bag_bomb,
    ),
    Trick("bag: damaged lz4", "export csv {}/x.bag /chatter.data -o {}/out", "", _damaged_lz4),
    journal("a path that leaves the folder", "'path' of a frame 'file'", _path_of_file("/../../@/canary"), "trace"),
    journal("a relative path", "'path' of a frame 'file'", _path_of_file("canary"), "trace"),
    journal("a path to a path", "'path' of a frame 'file'", _path_of_file("//tmp/x/./y"), "replay --info"),
    journal("a link out of the folder", "cannot be unpacked", _linked, "replay"),
    journal("a file that unpacks to more", "does not match its checksum", _packed(10, bytes(2_000_000)), "replay"),
    journal("a file of a terabyte", "at most", _packed(1 << 40, b"x"), "replay --info"),
    journal("a look outside", "'path' of a frame 'look'", _look(path="/../../canary"), "replay"),
    journal("a look of a kind that there is not", "'kind' of a frame 'look'", _look(kind="canary"), "replay"),
    journal("a look through a link", "cannot be unpacked", _look_through_link(), "replay"),
    journal("a working directory elsewhere", "'cwd' of a frame 'header'", _header(cwd="/../.."), "replay"),
    journal("variables that are none", "'environ' of a frame 'header'", _header(environ={"A=B\0": "x"}), "replay"),
    journal("a plan that is none", "'plan'", _header(plan={"words": [["x"]]}), "replay --info"),
)
