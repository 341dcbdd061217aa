"""The measurements of the architecture: they find hidden dependencies, and the pictures in docs match this tree."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from dev.house import figures
from dev.house.floors import allowed, homeless, wrong_arrows
from dev.house.picture import HOUSE, MESSAGE, draw
from dev.house.tree import ROOT, Tree, the_tree

FILES = {
    "cfepy/__init__.py": '"""The face."""\n__version__ = "1"\n',
    "cfepy/status.py": '"""Errors. More of them."""\nclass Error(Exception):\n    pass\n',
    "cfepy/rtos/__init__.py": (
        "from cfepy import __version__\nfrom cfepy.rtos.kernel import Kernel\n__all__ = ['Kernel']\n"
    ),
    "cfepy/rtos/kernel.py": (
        "from typing import TYPE_CHECKING\n"
        "from ..status import Error\n"
        "if TYPE_CHECKING:\n    from cfepy.rtos.task import Task\n"
        "class Kernel:\n    def run(self):\n        if self and True:\n            return [x for x in self]\n"
    ),
    "cfepy/rtos/task.py": "import cfepy.rtos.kernel\nclass Task:\n    pass\n",
    "cfepy/sb/__init__.py": "__all__ = []\n",
    "cfepy/sb/bus.py": (
        '"""The bus. Imports only the kernel."""\n'
        "def late():\n    try:\n        from cfepy.evs import log\n    except ImportError:\n        pass\n"
        "class Task:\n    pass\n"
    ),
    "cfepy/evs/__init__.py": "__all__ = []\n",
    "cfepy/evs/log.py": (
        'import importlib\nPLACE = "cfepy.sb.bus"\nTABLE = {1: "cfepy.rtos.task"}\n'
        "def load(name):\n    importlib.import_module(PLACE)\n    importlib.import_module('.none', __package__)\n"
        "    return importlib.import_module(name)\n"
    ),
}


@pytest.fixture
def small(tmp_path: Path) -> Tree:
    for name, text in FILES.items():
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    return Tree(tmp_path)


def test_imports_of_every_kind_are_found(small: Tree) -> None:
    found = {(name, target) for name, module in small.modules.items() for target in small.arrows(module)}
    assert found == {
        ("cfepy.rtos", "cfepy.rtos.kernel"),
        ("cfepy.rtos.kernel", "cfepy.status"),
        ("cfepy.rtos.kernel", "cfepy.rtos.task"),
        ("cfepy.rtos.task", "cfepy.rtos.kernel"),
        ("cfepy.sb.bus", "cfepy.evs.log"),
        ("cfepy.evs.log", "cfepy.sb.bus"),
        ("cfepy.evs.log", "cfepy.rtos.task"),
        ("cfepy.evs.log", "cfepy.evs"),
    }
    assert small.modules["cfepy.evs.log"].unread == [7]
    assert {each.when for each in small.modules["cfepy.sb.bus"].imports} == {"late"}


def test_violations_are_reported(small: Tree) -> None:
    assert [arrow.source for arrow in wrong_arrows(small)] == ["cfepy.evs.log", "cfepy.sb.bus"]
    assert figures.circles(small) == [["cfepy.evs.log", "cfepy.sb.bus"]]
    assert figures.circles(small, for_types=True) == [["cfepy.rtos.kernel", "cfepy.rtos.task"]]
    assert figures.faces(small) == (3, 0)
    assert figures.names_twice(small) == {"Task": ["cfepy.rtos.task", "cfepy.sb.bus"]}
    assert figures.sentences_about_imports(small) == ["cfepy.sb.bus"]
    assert figures.offered(small) == ["__version__"]
    assert figures.most_complex(small, 1) == [(4, "cfepy/rtos/kernel.py:Kernel.run")]
    assert "| `cfepy/rtos` | 3 |" in figures.report(small)


def test_package_without_a_floor_is_reported(small: Tree, tmp_path: Path) -> None:
    assert homeless(small) == []
    (tmp_path / "cfepy" / "attic.py").touch()
    assert homeless(Tree(tmp_path)) == ["attic"]


def test_purpose_of_a_module_is_its_first_sentence(small: Tree) -> None:
    assert small.modules["cfepy.status"].purpose == "Errors."


@pytest.mark.parametrize(
    ("source", "target", "may"),
    [
        ("sb", "osal", True),
        ("osal", "sb", False),
        ("sb", "evs", False),
        ("ports", "status", True),
        ("apps", "app", True),
        ("apps", "nodes", False),
        ("mission", "rospy_shim", True),
        ("rospy_shim", "mission", False),
        ("__main__", "cli", True),
    ],
)
def test_allowed_imports_follow_the_floors(source: str, target: str, may: bool) -> None:
    assert allowed(source, target) is may


@pytest.mark.slow
@pytest.mark.parametrize("path", [HOUSE, MESSAGE], ids=str)
def test_pictures_match_this_tree(path: Path) -> None:
    """Numbers of imports may lag behind by a quarter, or each new import would be a new picture."""
    committed, drawn = (ROOT / path).read_text(encoding="utf-8"), draw(the_tree())[path]
    number = re.compile(r'class="count">([\d,]+)<')
    assert number.sub("", committed) == number.sub("", drawn), "run python -m dev.house --picture"
    for old, new in zip(number.findall(committed), number.findall(drawn), strict=True):
        assert abs(int(old.replace(",", "")) / int(new.replace(",", "")) - 1) < 0.25, "python -m dev.house --picture"


def test_each_package_names_its_central_file() -> None:
    """Exceptions are packages below the names that a design uses, and packages that are an app each."""
    tree = the_tree()
    for module in tree.modules.values():
        top, *rest = module.name.split(".")
        depth = 2 if rest[:1] in (["extra"], ["types"]) else 1
        if not module.is_package or top == "apps" or module.name in ("cfepy", "cfepy.apps") or len(rest) > depth:
            continue
        named = re.search(r"[Tt]he\s+central\s+file\s+is\s+`([^`]*)`", module.text)
        if module.name == "cfepy.extra":
            continue  # it has add-ons, and no files
        assert named is not None, f"{module.where} says which file to read first"
        assert (ROOT / named[1]).is_file(), f"{module.where}: there is no {named[1]}"
        assert re.search(r"\bbelongs?\s+here\b", module.text), f"{module.where} says what belongs there"
