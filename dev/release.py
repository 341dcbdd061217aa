"""A version of cfepy made ready to publish: `python -m dev.release 0.1.0`.

It works on a copy of the committed files in a separate folder. It changes the checkout only after all steps succeed:
then CHANGELOG.md has the day, the commit is tagged, and `dist/` has the files. It sends nothing except pip's requests
to the package registry. The last line that it prints is the command that uploads.
"""

from __future__ import annotations

import argparse
import datetime
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import venv
import zipfile
from collections.abc import Mapping, Sequence
from email.parser import Parser
from pathlib import Path

from cfepy.status import UsageError

ROOT = Path(__file__).parents[1]
VERSION_FILE = "cfepy/__init__.py"
CHANGES = "CHANGELOG.md"
LIBRARIES = "ros_libraries"  # which have the versions of the real ones
SHARE = {"apps": "cfepy/share/apps", "boards": "cfepy/share/boards"}
SHARE |= {"missions": "cfepy/share/missions", "roscfe": "cfepy/share/roscfe"}
SHARE |= {"ros_packages": "cfepy/share/ros_packages"}
PACKAGES = ("cfepy", "rospy_shim", "rclpy_shim", "ros_libraries")
NOT_IN_SDIST = (".ci/",)
MUST_HAVE: tuple[str, ...] = ("cfepy/py.typed", "rospy_shim/py.typed", "cfepy/share/missions/capture/startup.scr")
MUST_HAVE += ("cfepy/share/boards/linux.yaml", "cfepy/share/apps/hk/app.py")
MUST_HAVE += ("cfepy/share/ros_packages/cfepy_plant/package.xml",)
DEMO = ("run", "capture", "--for", "2", "--no-console")
RENDER = "import sys; from readme_renderer import markdown; print(markdown.render(open(sys.argv[1]).read()))"
"""twine looks at the pages of projects that are reStructuredText, and at no others."""
_VERSION = re.compile(r"\d+\.\d+\.\d+(?:(?:a|b|rc)\d+)?")
_UNRELEASED = "unreleased"


def main(words: Sequence[str] | None = None) -> int:
    """Make a version. Returns 0 on success, or 1 after printing the error as the last line."""
    parser = argparse.ArgumentParser(prog="python -m dev.release", description=__doc__)
    parser.add_argument("version", help="such as 0.1.0")
    parser.add_argument("--dry-run", action="store_true", help="check everything, and change nothing in the checkout")
    arguments = parser.parse_args(words)
    try:
        release(ROOT, arguments.version, arguments.dry_run)
    except UsageError as error:
        print(f"no release: {error}")
        return 1
    return 0


def release(root: Path, version: str, dry_run: bool) -> None:
    """Check, build, check the build, and tag.

    Args:
        root: the checkout.
        version: the version for users of pip.
        dry_run: change nothing in the checkout.

    Raises:
        UsageError: the checkout, the version or the build is not in order.
    """
    say("the checkout")
    check_clean(root, version)
    check_version(root, version)
    day = datetime.datetime.now(tz=datetime.UTC).date().isoformat()
    changes = dated((root / CHANGES).read_text(encoding="utf-8"), version, day)
    tracked = output(["git", "ls-files"], root).splitlines()
    with tempfile.TemporaryDirectory(prefix="cfepy-release-") as name:
        work = Path(name)
        tree = work / "tree"
        export(root, tree)
        (tree / CHANGES).write_text(changes, encoding="utf-8")
        built = build(work, tree, committed(root))
        for file in built:
            check_contents(file, version, tracked)
        same_wheel(work, tree, built)
        digest = demo_of([sys.executable, "-P", "-m", "cfepy"], work, {"PYTHONPATH": str(tree)})
        for file in built:
            check_installed(work / f"home-{file.suffix[1:]}", file, version, digest)
        if not dry_run:
            keep(root, built, version, changes)
    if dry_run:
        say("all well; nothing was kept")
    else:
        say(f"tagged v{version}. Push the branch and the tag, then upload:")
        print(f"python -m twine upload {' '.join(f'dist/{file.name}' for file in built)}")


def say(text: str) -> None:
    """Print the progress."""
    print(f"== {text}", flush=True)


def output(command: Sequence[str], folder: Path, more: Mapping[str, str] | None = None) -> str:
    """Return the output of a command.

    Raises:
        UsageError: it failed.
    """
    kept = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    done = subprocess.run(command, cwd=folder, env=kept | dict(more or {}), capture_output=True, text=True, check=False)
    if done.returncode:
        raise UsageError(f"{' '.join(command)} failed:\n{done.stdout[-4000:]}{done.stderr[-4000:]}".rstrip())
    return done.stdout


# -- the checkout ----------------------------------------------------------------------------------------------------


def check_clean(root: Path, version: str) -> None:
    """Refuse a checkout with changes, and a version that there is."""
    changed = output(["git", "status", "--porcelain"], root)
    if changed:
        raise UsageError(f"the checkout has changes: commit them, or put them away\n{changed}".rstrip())
    if output(["git", "tag", "--list", f"v{version}"], root):
        raise UsageError(f"there is a tag v{version} already: a version is published once")


def check_version(root: Path, version: str) -> None:
    """Refuse an invalid version, or one that differs from the version in the code."""
    if not _VERSION.fullmatch(version):
        raise UsageError(f"invalid version {version}; expected a version such as 0.1.0 or 0.2.0rc1")
    told = ["git", "grep", "-E", '^(__version__|version) *= *"', "--", *PACKAGES, "pyproject.toml", f":!{LIBRARIES}"]
    found = {line.partition(":")[0]: line.rsplit('"', 2)[1] for line in output(told, root).splitlines()}
    if list(found) != [VERSION_FILE]:
        raise UsageError(f"the version must be only in {VERSION_FILE}, not in {', '.join(found) or 'no file'}")
    if found[VERSION_FILE] != version:
        raise UsageError(f"{VERSION_FILE} has version {found[VERSION_FILE]}; write {version} there, and commit it")


def dated(changes: str, version: str, day: str) -> str:
    """Return the changelog with the day of a version, where it says that it is unreleased.

    Raises:
        UsageError: its section of the version is missing, empty, or not at the top.
    """
    sections = re.split(r"^## ", changes, flags=re.MULTILINE)[1:]
    mine = next((section for section in sections if section.startswith(f"[{version}] - ")), None)
    if mine is None:
        raise UsageError(f"{CHANGES} has no section ## [{version}] - {_UNRELEASED}")
    heading, _, body = mine.partition("\n")
    if not body.strip():
        raise UsageError(f"{CHANGES} has nothing in its section [{version}]")
    if mine is not sections[0]:
        raise UsageError(f"{CHANGES} has [{version}] below other versions: the latest is the first")
    when = heading.rpartition(" - ")[2].strip()
    if when != _UNRELEASED and not re.fullmatch(r"\d{4}-\d\d-\d\d", when):
        raise UsageError(
            f"{CHANGES}: invalid day {when!r} of [{version}]; expected {_UNRELEASED} or a day such as 2026-01-31"
        )
    return changes.replace(f"## [{version}] - {_UNRELEASED}\n", f"## [{version}] - {day}\n", 1)


def export(root: Path, tree: Path) -> None:
    """Export the committed files into a separate folder."""
    tree.mkdir()
    archive = tree.parent / "tree.tar"
    output(["git", "archive", "--output", str(archive), "HEAD"], root)
    shutil.unpack_archive(archive, tree, "tar")  # Python 3.11.2, Debian's, knows no filter


def committed(root: Path) -> str:
    """Return the time of the commit, in s since 1970, so that each build gives the same files."""
    return output(["git", "log", "-1", "--format=%ct"], root).strip()


# -- build -----------------------------------------------------------------------------------------------------------


def tools(work: Path) -> Path:
    """Return the Python of an environment that has `build` and `twine`."""
    home = work / "tools"
    if not home.exists():
        say("tools")
        venv.create(home, with_pip=True)
        output([str(python_of(home)), "-m", "pip", "install", "--quiet", "build", "twine", "readme-renderer[md]"], work)
    return python_of(home)


def python_of(home: Path) -> Path:
    """Return the interpreter of a virtual environment."""
    return home / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def build(work: Path, tree: Path, epoch: str) -> list[Path]:
    """Return the sdist, and the wheel built from it. Both have metadata that the registry accepts."""
    python = str(tools(work))
    say("sdist, and a wheel of it")
    dist = work / "dist"
    more = {"SOURCE_DATE_EPOCH": epoch}
    output([python, "-m", "build", "--outdir", str(dist), str(tree)], work, more)
    built = sorted(dist.iterdir())
    if [file.name.rpartition(".")[2] for file in built] != ["whl", "gz"]:
        built.reverse()
    say("metadata")
    output([python, "-m", "twine", "check", "--strict", *map(str, built)], work)
    page = output([python, "-c", RENDER, str(tree / "README.md")], work)
    if "<h1" not in page:
        raise UsageError("README.md cannot be shown as the registry shows it")
    return built


def same_wheel(work: Path, tree: Path, built: Sequence[Path]) -> None:
    """Refuse an sdist whose wheel differs from the wheel of the checkout."""
    say("a wheel of the checkout, to compare")
    there = work / "direct"
    output([str(tools(work)), "-m", "build", "--wheel", "--outdir", str(there), str(tree)], work)
    (direct,) = there.glob("*.whl")
    of_sdist = next(file for file in built if file.suffix == ".whl")
    ours, theirs = hashes_of(direct), hashes_of(of_sdist)
    other = sorted(name for name in ours | theirs if ours.get(name) != theirs.get(name))
    if other:
        raise UsageError(f"the sdist makes another wheel than the checkout: {', '.join(other[:10])}")


def hashes_of(wheel: Path) -> dict[str, str]:
    """Return the files of a wheel with digests of their contents."""
    with zipfile.ZipFile(wheel) as packed:
        return {name: hashlib.sha256(packed.read(name)).hexdigest() for name in packed.namelist()}


def wanted_in(kind: str, tracked: Sequence[str]) -> set[str]:
    """Return the files that a distribution is to have, but for its metadata.

    Args:
        kind: "whl" or "gz".
        tracked: the files that git has.
    """
    if kind == "gz":
        return {name for name in tracked if not name.startswith(NOT_IN_SDIST)}
    found = {name for name in tracked if name.partition("/")[0] in PACKAGES}
    for folder, place in SHARE.items():
        found |= {place + name.removeprefix(folder) for name in tracked if name.startswith(f"{folder}/")}
    return found


def check_contents(file: Path, version: str, tracked: Sequence[str]) -> None:
    """Refuse a distribution that lacks a file, or has one that git does not have."""
    kind = file.name.rpartition(".")[2]
    say(f"what is in {file.name}")
    names, metadata = contents_of(file, version)
    wanted = wanted_in(kind, tracked)
    missing, strange = sorted(wanted - names), sorted(names - wanted)
    if kind == "whl":
        missing += [name for name in MUST_HAVE if name not in names]
    if missing or strange:
        lacks, has = (", ".join(names[:10]) or "nothing" for names in (missing, strange))
        raise UsageError(f"{file.name}: missing files: {lacks}; unexpected files, which git does not track: {has}")
    told = Parser().parsestr(metadata)
    if (told["Name"], told["Version"]) != ("cfepy", version):
        raise UsageError(f"{file.name} has the metadata of {told['Name']} {told['Version']}, not of cfepy {version}")
    for name in ("Summary", "Requires-Python", "License-Expression"):
        if not told[name]:
            raise UsageError(f"{file.name} has no {name} in its metadata")
    if told["Description-Content-Type"] != "text/markdown" or not told.get_payload():
        raise UsageError(f"{file.name} has no README in its metadata")


def contents_of(file: Path, version: str) -> tuple[set[str], str]:
    """Return the file names in a distribution without its metadata, and the metadata."""
    if file.suffix == ".whl":
        info = f"cfepy-{version}.dist-info/"
        with zipfile.ZipFile(file) as packed:
            metadata = packed.read(f"{info}METADATA").decode()
            return {name for name in packed.namelist() if not name.startswith(info)}, metadata
    top = f"cfepy-{version}/"
    with tarfile.open(file) as packed:
        found = packed.extractfile(f"{top}PKG-INFO")
        assert found is not None
        names = {member.name.removeprefix(top) for member in packed.getmembers() if not member.isdir()}
        return names - {"PKG-INFO"}, found.read().decode()


def check_installed(home: Path, file: Path, version: str, digest: str) -> None:
    """Install a distribution in a new environment, with no compiler at hand, and fly the demonstration there."""
    say(f"{file.name} in a new environment without a compiler")
    venv.create(home, with_pip=True)
    python = str(python_of(home))
    alone = {"PATH": str(Path(python).parent), "CC": "no-compiler", "CXX": "no-compiler"}
    output([python, "-m", "pip", "install", "--quiet", str(file)], home, alone)
    output([python, "-m", "pip", "check"], home, alone)
    command = str(Path(python).with_name("cfepy"))
    told = output([python, "-c", "import cfepy; print(cfepy.__version__)"], home, alone).strip()
    if told != version:
        raise UsageError(f"{file.name} installs cfepy {told}")
    if "rx64m" not in output([command, "board", "list"], home, alone):
        raise UsageError(f"{file.name} brings no boards")
    found = demo_of([command], home, alone)
    if found != digest:
        raise UsageError(f"{file.name} flies {' '.join(DEMO)} with digest {found}; the checkout, with {digest}")


def demo_of(command: Sequence[str], folder: Path, more: Mapping[str, str]) -> str:
    """Return the digest of the demonstration."""
    return output([*command, *DEMO], folder, more).splitlines()[-2].removeprefix("trace: ")


# -- the end ---------------------------------------------------------------------------------------------------------


def keep(root: Path, built: Sequence[Path], version: str, changes: str) -> None:
    """Put the files into dist/, and commit and tag the version."""
    (root / "dist").mkdir(exist_ok=True)
    for file in built:
        (root / "dist" / file.name).write_bytes(file.read_bytes())
    (root / CHANGES).write_text(changes, encoding="utf-8")
    if output(["git", "status", "--porcelain"], root):
        output(["git", "commit", "--quiet", "--all", "--message", f"Version {version}"], root)
    output(["git", "tag", "--annotate", f"v{version}", "--message", f"cfepy {version}"], root)


if __name__ == "__main__":
    sys.exit(main())
