"""Names that `cfe` does not have: those that are reported, and those that are not because they are uncertain."""

from __future__ import annotations

import ast
import textwrap
from pathlib import Path

import pytest

from cfepy.pilot.mission_check import cfe_names
from cfepy.pilot.mission_check.cfe_names import wrong_names
from dev.house.tree import ROOT

FOLDERS = ("apps", "missions", "examples", "tests/quality", "tests/mission", "cfepy/cli/run/templates")


def told(folder: Path, body: str) -> list[tuple[int, str]]:
    """Return the findings about an application whose main function is `Main`: line, text."""
    source = folder / "app.py"
    source.write_text(textwrap.dedent(body), encoding="utf-8")
    return sorted((problem.line, problem.text) for problem in wrong_names(source, "Main"))


def test_unknown_name_is_reported_for_any_use_of_the_handle(tmp_path: Path) -> None:
    found = told(
        tmp_path,
        """\
        from cfepy.app import Cfe
        def Main(cfe):
            App(cfe).go()
            helper(1, handle=cfe)
            sb = cfe.sb
            pipe = sb.create_pip(10, "P")
            def inner():
                return cfe.es.run_lop(1)
            again = lambda: (copy := cfe).time.get_tim()
        def helper(number, handle):
            handle.tbl.CFE_TBL_Register("T")
        class App:
            def __init__(self, cfe):
                self._cfe, self.sb, self.number = None, None, 3
            def go(self):
                self._cfe.anything
        class Typed:
            cfe: Cfe
            def go(self):
                self.cfe.os.TaskDelay(3)
        def typed(n: int, cfe: "Cfe") -> None:
            cfe.sbb.subscribe(1, 2)
        class Keeper:
            def __init__(self, cfe: Cfe):
                self._cfe = cfe
                self.msg = cfe.msg
            def go(self):
                for each in range(3):
                    self._cfe.evs.send_infoo(1, "x")
                self.msg.get_msgid(b"")
        """,
    )
    assert found == [
        (6, "cfe.sb has no 'create_pip'; did you mean cfe.sb.create_pipe?"),
        (8, "cfe.es has no 'run_lop'; did you mean cfe.es.run_loop?"),
        (9, "cfe.time has no 'get_tim'; did you mean cfe.time.get_time?"),
        (11, "cfe.tbl has no 'CFE_TBL_Register'; did you mean cfe.tbl.register?"),
        (20, "cfe.os has no 'TaskDelay'; did you mean cfe.os.task_delay?"),
        (22, "cfe has no 'sbb'; did you mean cfe.sb?"),
        (29, "cfe.evs has no 'send_infoo'; did you mean cfe.evs.send_info?"),
        (30, "cfe.msg has no 'get_msgid'; did you mean cfe.msg.get_msg_id?"),
    ]


@pytest.mark.parametrize(
    ("call", "said"),
    [
        ("cfe.sb.create_pipe(10)", "missing a required argument: 'name'; write create_pipe(depth, name, pointer=None)"),
        ("cfe.os.task_delay(5, 6)", "cfe.os.task_delay: too many positional arguments; write task_delay(milliseconds)"),
        ("cfe.evs.send_info(1, 'x', colour=3)", "got an unexpected keyword argument 'colour'"),
        ("cfe.sb.create_pipe(*arguments)", ""),
        ("cfe.sb.create_pipe(10, **more)", ""),
        ("cfe.sb.create_pipe(name='P', depth=10)", ""),
    ],
)
def test_wrong_number_of_arguments_is_reported(tmp_path: Path, call: str, said: str) -> None:
    found = told(tmp_path, f"def Main(cfe):\n    {call}\n")
    assert len(found) == bool(said)
    assert all(said in text for _, text in found)


@pytest.mark.parametrize(
    "body",
    [
        "def Main(cfe):\n    cfe = wrapped(cfe)\n    cfe.sb.nothing()",
        "def Main(cfe):\n    if hasattr(cfe.sb, 'later'):\n        cfe.sb.later()",
        "def Main(cfe):\n    try:\n        cfe.sb.nothing()\n    except AttributeError:\n        pass",
        "def Main(cfe):\n    cfe.sb.own = 3\n    cfe.sb.own += 1",
        "def other(cfe):\n    cfe.sb.nothing()",
        "def helper(cfe):\n    cfe.sb.nothing()\ndef Main(cfe):\n    helper(cfe)\n    helper(fake())",
        "def helper(cfe):\n    cfe.sb.nothing()\ndef Main(cfe):\n    helper(cfe)\n    start(helper)",
        "def Main(cfe: Fake):\n    cfe.sb.nothing()",
        "@wrapped\ndef Main(cfe):\n    cfe.sb.nothing()",
        "def Main(cfe):\n    for cfe in others():\n        cfe.sb.nothing()",
        "def Main(cfe):\n    def inner(cfe):\n        cfe.sb.nothing()",
        "class A:\n    def __init__(self, cfe):\n        self.c = cfe\n    def swap(self):\n        self.c = fake()\n"
        "    def go(self):\n        self.c.sb.nothing()\ndef Main(cfe):\n    A(cfe)",
        "class A:\n    def __init__(self, cfe):\n        self.c = cfe\n    def go(self):\n        self.c.sb.nothing()\n"
        "class B(A):\n    def __init__(self):\n        self.c = fake()\ndef Main(cfe):\n    A(cfe)",
        "from cfepy.app import Cfe\nclass A:\n    def __init__(self, cfe: Cfe):\n        self.c = cfe\n"
        "    def go(self):\n        self.c.sb.nothing()\nclass B(A):\n    def __init__(self):\n        self.c = fake()",
        "HANDLE = None\ndef Main(cfe):\n    global HANDLE\n    HANDLE = cfe\ndef go():\n    HANDLE.sb.nothing()",
    ],
)
def test_uncertain_use_of_the_handle_is_not_reported(tmp_path: Path, body: str) -> None:
    assert told(tmp_path, body) == []


def test_all_files_of_a_package_are_read(tmp_path: Path) -> None:
    (tmp_path / "__init__.py").write_text("from .main import Main\n", encoding="utf-8")
    (tmp_path / "main.py").write_text(
        "from .part import go\ndef Main(cfe):\n    go(cfe)\n    cfe.es.nothing_like_it()\n", encoding="utf-8"
    )
    (tmp_path / "part.py").write_text(
        "from cfepy.app import Cfe\ndef go(cfe: Cfe):\n    cfe.evs.registre()\n", encoding="utf-8"
    )
    found = [(problem.file.name, problem.line) for problem in wrong_names(tmp_path / "__init__.py", "Main")]
    assert sorted(found) == [("main.py", 4), ("part.py", 3)]


@pytest.mark.slow
def test_code_of_this_repository_has_no_false_alarm() -> None:
    looked_at = 0
    for path in (path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*.py*"))):
        if path.suffix not in (".py", ".in"):
            continue
        for main in main_functions(path):
            assert list(wrong_names(path, main)) == []
            looked_at += 1
    assert looked_at > 40


def main_functions(path: Path) -> list[str]:
    tree = cfe_names.sources.tree_of(path)
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef) and node.args.args]
    return [function.name for function in functions if function.args.args[0].arg == "cfe"]


def test_unknown_imports_from_cfepy_are_reported(tmp_path: Path) -> None:
    found = told(
        tmp_path,
        """\
        from cfepy.msg import Layout, Layuot
        from cfepy.mgs import Layout
        from cfepy import msg
        from cfepy.apps.hk import packets, pakcets
        from cfepy.status import *
        from cfepy.ground import BagReader, dictionary_of
        try:
            from cfepy.msg import Later
        except ImportError:
            pass
        """,
    )
    assert [(line, text.partition(";")[0]) for line, text in found] == [
        (1, "cfepy.msg has no name 'Layuot'"),
        (2, "unknown module cfepy.mgs"),
        (4, "cfepy.apps.hk has no name 'pakcets'"),
    ]


def test_deeply_nested_code_is_not_checked(tmp_path: Path) -> None:
    assert told(tmp_path, "def Main(cfe):\n    return " + " + ".join(["cfe.sb.nothing()"] * 900)) == []
