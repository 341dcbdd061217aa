"""The public API of the library: names at run time, names for type checkers, documentation, and loaded modules."""

from __future__ import annotations

import ast
import inspect
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import cfepy
from dev.pages import python_api

ROOT = Path(__file__).parents[1]
GUIDE = ROOT / "docs" / "how_to" / "python_api.md"
MISSIONS = ROOT / "tests" / "quality" / "missions"
needs_docstrings = pytest.mark.skipif(sys.flags.optimize > 1, reason="python -OO leaves docstrings out")
EXAMPLES = re.findall(r"^```python\n(.*?)^```", GUIDE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


def test_public_names_are_visible_to_type_checkers() -> None:
    tree = ast.parse(Path(cfepy.__file__).read_text(encoding="utf-8"))
    seen = {"__version__"}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module not in ("__future__", "typing", "cfepy.interpreter.faces"):
            seen |= {alias.name for alias in node.names}
        elif isinstance(node, ast.FunctionDef):
            seen.add(node.name)
    assert sorted(seen) == sorted(cfepy.__all__)
    assert set(cfepy.__all__) <= set(dir(cfepy))


def test_public_names_differ_from_package_names() -> None:
    """A package that is imported would take the place of the name."""
    packages = {path.stem for path in Path(cfepy.__file__).parent.iterdir()}
    assert not packages & set(cfepy.__all__)


@needs_docstrings
@pytest.mark.parametrize("name", sorted(set(cfepy.__all__) - {"__version__"}))
def test_public_names_are_documented(name: str) -> None:
    thing: Any = getattr(cfepy, name)
    assert inspect.getdoc(thing), name
    for member, value in python_api.members(thing) if inspect.isclass(thing) else ():
        assert inspect.getdoc(value), f"{name}.{member}"


@needs_docstrings
def test_options_equal_the_attributes_of_a_plan() -> None:
    """Each attribute of a plan is an option, except for those that the mission defines."""
    from cfepy.pilot import RunPlan

    options = set(cfepy.RunOptions.__annotations__)
    attributes = {name for name in inspect.signature(RunPlan).parameters if name not in ("words", "command")}
    assert options == attributes - {"launch_args"} | {"args"}
    for option in options:
        assert f"`{option}`" in inspect.getdoc(cfepy.run)  # type: ignore[operator]


@needs_docstrings
def test_reference_is_up_to_date() -> None:
    assert python_api.PAGE.read_text(encoding="utf-8") == python_api.page(), "python -m dev.pages.python_api"


def test_import_loads_few_modules() -> None:
    code = "import sys; before = set(sys.modules); import cfepy; print(*sorted(set(sys.modules) - before))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = [name for name in done.stdout.split() if name.startswith("cfepy")]
    assert loaded == ["cfepy", "cfepy.interpreter", "cfepy.interpreter.faces"]


@pytest.mark.slow
def test_examples_of_the_guide_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copytree(MISSIONS / "lost_update", tmp_path / "lost_update")
    monkeypatch.chdir(tmp_path)
    space: dict[str, Any] = {}
    for example in EXAMPLES:
        exec(compile(example.replace("seconds=20", "seconds=3").replace("seeds=20", "seeds=6"), GUIDE, "exec"), space)
    assert space["run"].trace == cfepy.run("capture", seconds=3, seed=3, tasks="thread").trace
    assert space["positions"].shape == (len(space["joints"]), 7)
    assert space["again"].problems


@pytest.mark.slow
def test_script_of_the_examples_passes_mypy_strict(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    names = "".join(f"print(cfepy.{name})\n" for name in cfepy.__all__)
    wrong = "reveal_type(run)\nreveal_type(positions)\nrun.nothing\ncfepy.nothing\ncfepy.run('capture', second=1)\n"
    script.write_text("\n".join([*EXAMPLES, names, wrong]), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--cache-dir", os.devnull, str(script)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    told = [line.partition(": ")[2] for line in done.stdout.splitlines()]
    assert told[0] == 'note: Revealed type is "cfepy.flight.run.Run"'
    assert "ndarray" in told[1]
    assert told[2:] == [
        'error: "Run" has no attribute "nothing"  [attr-defined]',
        'error: Module has no attribute "nothing"  [attr-defined]',
        'error: Unexpected keyword argument "second" for "run"; did you mean "seconds"?  [call-arg]',
        'note: "run" defined in "cfepy.flight.start"',
    ]
