"""Package interfaces: type checkers see the same names as programs, and nothing is loaded before its first use."""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys

import pytest

from dev.house.tree import ROOT, TOPS, Tree, the_tree


@pytest.fixture(scope="module")
def tree() -> Tree:
    return the_tree()


def packages_with_faces() -> list[str]:
    """Without reading the whole tree: every process that collects tests asks."""
    files = [file for top in TOPS for file in (ROOT / top).rglob("__init__.py")]
    faces = [file for file in files if "= face(" in file.read_text(encoding="utf-8")]
    return sorted(".".join(file.parent.relative_to(ROOT).parts) for file in faces)


@pytest.mark.parametrize("name", packages_with_faces())
def test_names_of_all_kinds_agree(name: str) -> None:
    package = importlib.import_module(name)
    module = the_tree().modules[name]
    offered = {each.name.rpartition(".")[2] for each in module.imports if each.when == "for types"}
    later = set(_later(module.tree))
    assert later == offered - {""}, "what is loaded later is what type checkers are told"
    assert offered <= set(package.__all__)
    for each in package.__all__:
        assert getattr(package, each) is not None
    assert set(package.__all__) <= set(dir(package))


def _later(tree: ast.Module) -> list[str]:
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and ast.unparse(node.func) == "face"]
    return [name for value in ast.literal_eval(calls[0].args[1]).values() for name in value]


def test_unknown_name_is_an_attribute_error() -> None:
    package = importlib.import_module("cfepy.extra.reports")
    with pytest.raises(AttributeError, match=r"cfepy\.extra\.reports.*'Pages'"):
        package.Pages  # noqa: B018


def test_modules_are_loaded_on_first_use() -> None:
    code = "import sys, cfepy.extra.reports; print([name for name in sys.modules if 'cfepy.extra.reports.' in name])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
