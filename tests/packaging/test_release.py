"""`python -m dev.release`, as in docs/how_to/install.md: its refusals, and a complete release."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from cfepy import __version__
from cfepy.status import UsageError
from dev.release import ROOT, check_clean, check_contents, check_version, dated, wanted_in

CHANGES = "# Changelog\n\n## [0.2.0] - unreleased\n\n- News.\n\n## [0.1.0] - 2026-01-02\n\n- All.\n"
LEFT = shutil.ignore_patterns(
    ".git", ".venv", ".hypothesis", "__pycache__", ".*_cache", "dist", "build", "*.egg-info", ".site"
)


def test_the_changelog_gets_the_day() -> None:
    assert dated(CHANGES, "0.2.0", "2026-11-24") == CHANGES.replace("unreleased", "2026-11-24")
    done = CHANGES.replace("unreleased", "2026-11-23")
    assert dated(done, "0.2.0", "2026-11-24") == done


@pytest.mark.parametrize(
    ("changes", "version", "why"),
    [
        (CHANGES, "0.3.0", "no section"),
        (CHANGES, "0.1.0", "below other versions"),
        (CHANGES.replace("- News.", ""), "0.2.0", "has nothing"),
        (CHANGES.replace("unreleased", "soon"), "0.2.0", "invalid day 'soon'"),
    ],
)
def test_a_changelog_without_the_version_is_refused(changes: str, version: str, why: str) -> None:
    with pytest.raises(UsageError, match=why):
        dated(changes, version, "2026-11-24")


def test_wheel_with_other_files_than_git_is_refused(tmp_path: Path) -> None:
    tracked = ["cfepy/py.typed", "cfepy/a.py", "boards/linux.yaml", "tests/test_a.py"]
    assert wanted_in("whl", tracked) == {"cfepy/py.typed", "cfepy/a.py", "cfepy/share/boards/linux.yaml"}
    assert wanted_in("gz", [*tracked, ".ci/run"]) == set(tracked)
    file = tmp_path / "cfepy-0.2.0-py3-none-any.whl"
    with zipfile.ZipFile(file, "w") as wheel:
        for name in (
            "cfepy/py.typed",
            "cfepy/share/boards/linux.yaml",
            "cfepy/stray.py",
            "cfepy-0.2.0.dist-info/METADATA",
        ):
            wheel.writestr(name, "Name: cfepy\nVersion: 0.2.0\n\n")
    with pytest.raises(UsageError, match=r"missing files: cfepy/a\.py, .*unexpected files, .*: cfepy/stray\.py"):
        check_contents(file, "0.2.0", tracked)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A small checkout."""
    (tmp_path / "cfepy").mkdir()
    (tmp_path / "cfepy" / "__init__.py").write_text('__version__ = "0.2.0"\n', encoding="utf-8")
    (tmp_path / "pyproject.toml").write_text('[project]\ndynamic = ["version"]\n', encoding="utf-8")
    committed(tmp_path)
    return tmp_path


def committed(folder: Path) -> None:
    """Make a folder a checkout with one commit."""
    for words in (["init", "--quiet"], ["add", "--all"], ["commit", "--quiet", "--message", "all"]):
        git(folder, *words)


def git(folder: Path, *words: str) -> str:
    """Call git with an identity for tests."""
    who = ["-c", "user.name=somebody", "-c", "user.email=somebody@example.org"]
    return subprocess.run(["git", *who, *words], cwd=folder, check=True, capture_output=True, text=True).stdout


def test_version_must_be_in_one_place(checkout: Path) -> None:
    check_version(checkout, "0.2.0")
    with pytest.raises(UsageError, match=r"has version 0\.2\.0; write 0\.2\.1"):
        check_version(checkout, "0.2.1")
    with pytest.raises(UsageError, match="expected a version such as"):
        check_version(checkout, "two")
    (checkout / "pyproject.toml").write_text('[project]\nversion = "0.2.0"\n', encoding="utf-8")
    with pytest.raises(UsageError, match=r"not in cfepy/__init__\.py, pyproject\.toml"):
        check_version(checkout, "0.2.0")


def test_checkout_with_changes_or_the_tag_is_refused(checkout: Path) -> None:
    check_clean(checkout, "0.2.0")
    git(checkout, "tag", "v0.2.0")
    with pytest.raises(UsageError, match=r"there is a tag v0\.2\.0"):
        check_clean(checkout, "0.2.0")
    (checkout / "new.txt").write_text("new", encoding="utf-8")
    with pytest.raises(UsageError, match=r"(?s)has changes.*new\.txt"):
        check_clean(checkout, "0.2.0")


@pytest.mark.slow
def test_command_prepares_a_version(tmp_path: Path) -> None:
    """In a copy of this checkout: two environments are made, and the demonstration is flown in each."""
    copy = tmp_path / "copy"
    shutil.copytree(ROOT, copy, ignore=LEFT, symlinks=True)
    committed(copy)
    who = {
        f"GIT_{role}_{what}": f"{role}@example.org" for role in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")
    }
    command = [sys.executable, "-m", "dev.release", __version__]
    environment = {**os.environ, **who}
    done = subprocess.run(command, cwd=copy, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    wheel, sdist = f"cfepy-{__version__}-py3-none-any.whl", f"cfepy-{__version__}.tar.gz"
    assert done.stdout.splitlines()[-1] == f"python -m twine upload dist/{wheel} dist/{sdist}"
    assert {path.name for path in (copy / "dist").iterdir()} == {wheel, sdist}
    assert git(copy, "tag", "--list").split() == [f"v{__version__}"]
    assert "unreleased" not in (copy / "CHANGELOG.md").read_text(encoding="utf-8").partition("### ")[0]
    again = subprocess.run(command, cwd=copy, env=environment, capture_output=True, text=True, check=False)
    assert again.returncode == 1
    assert again.stdout.splitlines()[-1].startswith(f"no release: there is a tag v{__version__} already")
