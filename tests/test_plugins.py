"""The door for add-ons: installed ones, missing ones, and add-ons of other packages."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import pytest

from cfepy import plugins
from cfepy.plugins import OWN, Hook, Plugin, installed
from cfepy.status import UsageError
from dev.house.tree import ROOT

EXAMPLE = ROOT / "examples" / "plugin"
Give = Callable[..., "subprocess.CompletedProcess[str]"]


def offer(folder: Path, name: str, value: str) -> None:
    """Write the metadata that pip writes for an installed package with an add-on."""
    about = folder / f"cfepy_{name}-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: cfepy-{name}\nVersion: 1.0\n", encoding="utf-8")
    (about / "entry_points.txt").write_text(f"[cfepy.plugins]\n{name} = {value}\n", encoding="utf-8")


@pytest.fixture
def site(tmp_path: Path) -> Path:
    """A folder of installed packages."""
    folder = tmp_path / "site"
    folder.mkdir()
    return folder


@pytest.fixture
def give(site: Path) -> Give:
    """Gives a command of cfepy in a process that has the packages of `site`."""

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        path = os.pathsep.join([str(site), *(each for each in sys.path if each)])
        environ = {**os.environ, "PYTHONPATH": path, "COLUMNS": "100"}
        command = [sys.executable, "-m", "cfepy", *words]
        return subprocess.run(command, env=environ, capture_output=True, text=True, encoding="utf-8", check=False)

    return run


@pytest.mark.slow
def test_add_on_of_another_package_adds_its_command_and_its_table(site: Path, give: Give) -> None:
    shutil.copytree(EXAMPLE / "cfepy_busiest", site / "cfepy_busiest")
    offer(site, "busiest", "cfepy_busiest:PLUGIN")
    helped = give("--help")
    assert (helped.returncode, helped.stderr) == (0, "")
    shown = helped.stdout
    assert "Traffic:\n  busiest             fly a mission, and rank its traffic\n" in shown
    assert shown.split()[-5:] == ["Add-ons", "of", "other", "packages:", "busiest."]
    ranked = give("busiest", "lab", "--top", "2")
    assert (ranked.returncode, ranked.stderr) == (0, "")
    assert [line[:3] for line in ranked.stdout.splitlines()] == ["1. ", "2. "]
    report = give("run", "lab", "--for", "2", "--no-console").stdout
    name = ranked.stdout.splitlines()[0].split()[1].rstrip(":")
    assert report.index("Busiest\n") < report.rindex(name) < report.index("virtual s in")


@pytest.mark.slow
def test_example_can_be_installed(tmp_path: Path, site: Path, give: Give) -> None:
    source = tmp_path / "plugin"
    shutil.copytree(EXAMPLE, source)
    pip = [sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--disable-pip-version-check"]
    subprocess.run([*pip, "--target", str(site), str(source)], check=True)
    assert give("busiest", "lab").returncode == 0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("raise RuntimeError('no licence')", "cfepy: the add-on odd cannot be loaded: RuntimeError: no licence\n"),
        ("PLUGIN = 7", "cfepy: the add-on odd cannot be used: odd:PLUGIN is not a Plugin\n"),
    ],
)
def test_invalid_add_on_is_left_out(site: Path, give: Give, text: str, said: str) -> None:
    (site / "odd.py").write_text(text, encoding="utf-8")
    offer(site, "odd", "odd:PLUGIN")
    done = give("run", "lab", "--for", "1", "--no-console")
    assert (done.returncode, done.stderr) == (0, said)


@pytest.mark.slow
@pytest.mark.parametrize(("words", "status"), [(["--help"], 0), (["run", "lab", "--for", "1", "--no-console"], 2)])
def test_add_on_that_fails_later_is_named(site: Path, give: Give, words: list[str], status: int) -> None:
    offers = "commands=('odd',), title='Odd', hooks={'report_tables': '.no:tables'}"
    (site / "odd").mkdir()
    text = f"from cfepy.plugins import Plugin\nPLUGIN = Plugin('odd', 'odd', {offers})"
    (site / "odd" / "__init__.py").write_text(text, encoding="utf-8")
    offer(site, "odd", "odd:PLUGIN")
    done = give(*words)
    assert done.returncode == status
    assert "cfepy: add-on odd: cannot be loaded: ModuleNotFoundError: No module named 'odd." in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("name", ["run", "explore"])
def test_existing_command_cannot_be_added(site: Path, give: Give, name: str) -> None:
    text = f"from cfepy.plugins import Plugin\nPLUGIN = Plugin('odd', 'odd', commands=('odd', '{name}'))"
    (site / "odd.py").write_text(text, encoding="utf-8")
    offer(site, "odd", "odd:PLUGIN")
    done = give("--help")
    assert done.returncode == 0
    assert done.stderr == f"cfepy: the add-on odd is left out: the command {name} already exists\n"


def without(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    left = tuple(each for each in OWN if each.name != name)
    monkeypatch.setattr(plugins, "installed", lambda: left)


def test_unfilled_hook_names_the_missing_add_on(monkeypatch: pytest.MonkeyPatch) -> None:
    hook: Hook[Callable[..., object]] = Hook("perf_log")
    assert callable(hook.need("--perfetto"))
    without(monkeypatch, "reports")
    assert hook.first() is None
    with pytest.raises(
        UsageError, match="--perfetto requires the add-on reports, which is missing in this installation"
    ):
        hook.need("--perfetto")


def test_functions_named_by_hooks_exist() -> None:
    for plugin in OWN:
        for hook in plugin.hooks:
            assert plugin.load(hook) is not None, (plugin.name, hook)


def test_each_hook_of_the_code_is_filled_or_documented() -> None:
    page = (ROOT / "docs" / "how_to" / "plugins.md").read_text(encoding="utf-8")
    offered = {hook for plugin in OWN for hook in plugin.hooks}
    for name in offered | {"report_tables"}:
        assert f"`{name}`" in page, "docs/how_to/plugins.md lists the hooks"


def test_plugin_names_modules_relative_to_its_package() -> None:
    plugin = Plugin("x", "cfepy.extra.viewers", hooks={"a": ".viewer_options:Viewers", "b": "cfepy.units:NS_PER_S"})
    assert plugin.load("a").__name__ == "Viewers"
    assert plugin.load("b") == 1_000_000_000


def test_add_on_with_a_missing_requirement_is_not_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plugins, "find_spec", lambda name: None if name == "cfepy.extra.c" else find_spec(name))
    installed.cache_clear()
    try:
        names = {each.name for each in installed()}
    finally:
        monkeypatch.undo()
        installed.cache_clear()
    assert "exploration" in names
    assert names.isdisjoint({"c", "convert"})
