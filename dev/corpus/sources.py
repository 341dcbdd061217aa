"""The repositories of the nodes: fetch each at its commit, and locate them.

A repository is a folder "owner+name" below the folder of sources. Large files that a node does not need, such as meshes
and pictures, are left out.
"""

from __future__ import annotations

import argparse
import hashlib
import io
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, Protocol

from cfepy.status import UsageError
from dev.corpus.scenarios import Program, Scenario

GITHUB = "https://github.com/{repo}.git"
ENVIRONMENT = "CFEPY_CORPUS_SOURCES"
FETCH = "python -m dev.corpus fetch FOLDER"
_LEFT_OUT = (".stl", ".obj", ".png", ".jpg", ".jpeg", ".gif", ".tif", ".svg", ".pdf", ".mp4", ".bag", ".pgm")
_LARGEST = "300k"  # of the files that are asked of a server


class Sources:
    """A folder of sources.

    Args:
        folder: with the repositories in it.
    """

    def __init__(self, folder: Path) -> None:
        self.root = folder.absolute()

    def folder(self, repo: str) -> Path:
        """Return where a repository is."""
        return self.root / repo.replace("/", "+")

    def script(self, program: Program) -> tuple[Path, str]:
        """Return the folder of a program's package, or else its repository, and the script's path in it."""
        root = self.folder(program.repo)
        script = root / program.path
        inside = [folder for folder in script.parents if folder.is_relative_to(root)]
        package = next((folder for folder in inside if (folder / "package.xml").is_file()), root)
        return package, str(script.relative_to(package))

    def missing(self, scenario: Scenario) -> str:
        """Return which part of a scenario is missing here, or "" if it is complete."""
        lacking = [repo for repo in scenario.repos if not self.folder(repo).is_dir()]
        if lacking:
            return f"no sources of {', '.join(lacking)} in {self.root}; run `{FETCH}`"
        return self._fault_of(scenario.node, scenario.sha256)

    def _fault_of(self, node: Program, sha256: str) -> str:
        script = self.folder(node.repo) / node.path
        if not script.is_file():
            return f"{script} is not there; remove the repository's folder and run `{FETCH}`"
        if hashlib.sha256(script.read_bytes()).hexdigest() != sha256:
            return f"{script} is not the script that is meant: its SHA-256 is another one"
        return ""

    def fetch(self, repo: str, commit: str, mirrors: Path | None = None) -> bool:
        """Fetch a repository at a commit, unless it is already present.

        Args:
            repo: "owner/name" on GitHub.
            commit: its full hash.
            mirrors: a folder with bare repositories as owner+name/repo, to use instead of GitHub.

        Returns:
            Whether it had to be fetched.

        Raises:
            UsageError: git could not fetch it.
        """
        target = self.folder(repo)
        if target.is_dir():
            return False
        with tempfile.TemporaryDirectory() as scratch:
            bare = Path(scratch) if mirrors is None else mirrors / repo.replace("/", "+") / "repo"
            if mirrors is None:
                _download(GITHUB.format(repo=repo), commit, bare)
            for name, content in _files(bare, commit):
                file = target / name
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_bytes(content)
        return True

    def fetch_all(self, commits: Mapping[str, str], mirrors: Path | None = None) -> list[str]:
        """Fetch all repositories that are missing. Returns their names."""
        return [repo for repo, commit in commits.items() if self.fetch(repo, commit, mirrors)]


def _download(url: str, commit: str, bare: Path) -> None:
    """Fetch the files of one commit, without its history and without files too large to be programs."""
    _git(bare, "init", "--quiet", "--bare", ".")
    _git(bare, "fetch", "--quiet", "--depth", "1", f"--filter=blob:limit={_LARGEST}", url, commit)


def _files(bare: Path, commit: str) -> Iterator[tuple[str, bytes]]:
    """Yield the name and content of the files of a commit that a program may need."""
    entries = _git(bare, "ls-tree", "-r", "-z", "--format=%(objecttype) %(objectname) %(path)", commit).decode()
    names = [entry.split(" ", 2)[1:] for entry in entries.split("\0") if entry.startswith("blob ")]
    wanted = [(blob, name) for blob, name in names if not name.lower().endswith(_LEFT_OUT)]
    stream = io.BytesIO(_git(bare, "cat-file", "--batch", given="".join(f"{blob}\n" for blob, _ in wanted)))
    for _, name in wanted:
        about = stream.readline().split()
        if about[-1] != b"missing":  # left out by the server for its size
            yield name, stream.read(int(about[-1]))
            stream.read(1)


def _git(folder: Path, *arguments: str, given: str = "") -> bytes:
    command = ["git", "-C", str(folder), *arguments]
    environment = {**os.environ, "GIT_NO_LAZY_FETCH": "1"}
    done = subprocess.run(command, input=given.encode(), env=environment, capture_output=True, check=False)
    if done.returncode:
        raise UsageError(f"git {' '.join(arguments[:4])}: {done.stderr.decode().strip()}", file=str(folder))
    return done.stdout


# -- programs ----------------------------------------------------------------------------------------------------------


class Listed(Protocol):
    """A list of public code."""

    @property
    def commits(self) -> Mapping[str, str]:
        """The commit of each repository, by its name."""


Fetch = Callable[[argparse.Namespace, Any], int]
"""Fetches the sources of a list. Gets the arguments `folder` and `mirrors`, and the list. Returns the exit status."""


def add_fetch(actions: argparse._SubParsersAction[argparse.ArgumentParser], fetch: Fetch | None = None) -> None:
    """Add the action `fetch` to a program.

    Args:
        actions: the program's actions.
        fetch: fetches the sources; None for a list with one commit of each repository (`Listed`).
    """
    parser = actions.add_parser("fetch", help="get the sources from GitHub, each repository at its commit")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--mirrors", type=Path, help="folder with bare repositories as owner+name/repo")
    parser.set_defaults(action=fetch or _fetch)


def _fetch(arguments: argparse.Namespace, listed: Listed) -> int:
    for repo in Sources(arguments.folder).fetch_all(listed.commits, arguments.mirrors):
        print(repo)
    return 0


def execute(parser: argparse.ArgumentParser, read: Callable[[], Any]) -> int:
    """Execute the action of a command line. Returns the exit status, 2 for bad usage.

    Args:
        parser: sets `action`, which gets the arguments and the list.
        read: reads the list.
    """
    arguments = parser.parse_args()
    try:
        status: int = arguments.action(arguments, read())
    except UsageError as error:
        print(error, file=sys.stderr)
        return 2
    return status
