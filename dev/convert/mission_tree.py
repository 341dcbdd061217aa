"""A cFS mission tree with converted ROS nodes in it: conversions, the build, and boots on NASA's cFE.

The tree is copied from a checkout of cFS 7.0.0 with its submodules and sample_defs. It needs Linux, cmake, a compiler
and root rights, because `dev.twin.real` boots in its own namespaces. `dev.convert.real_flights` flies it.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from cfepy.cli.main import main
from cfepy.es.packets import START_APP
from dev.twin.real import RealCfe

CI_LAB = "CFE_APP, ci_lab, CI_LAB_AppMain, CI_LAB, 60, 16384, 0x0, 0;"
"""The line of a startup script for the application that takes commands from the ground."""
STARTUP = "/cf/cfe_es_startup.scr"
TARGETS = "sample_defs/targets.cmake"
APPS = re.compile(r"SET\(cpu1_APPLIST [^)]*\)")


class MissionTree:
    """A copy of a mission tree.

    Args:
        tree: the tree.
        scratch: an empty folder.
        apps: NASA's applications that are built with it.
    """

    def __init__(self, tree: Path, scratch: Path, apps: Iterable[str] = ()) -> None:
        self._folder = scratch / "mission"
        self._lines: dict[str, str] = {}
        shutil.copytree(tree, self._folder, symlinks=True, ignore=shutil.ignore_patterns("build", ".git"))
        targets = self._folder / TARGETS
        text = targets.read_text(encoding="utf-8")
        targets.write_text(APPS.sub(f"SET(cpu1_APPLIST ci_lab {' '.join(apps)})", text), encoding="utf-8")

    def convert(self, words: Sequence[str], name: str = "ros_nodes", profile: str = "host") -> list[str]:
        """Convert nodes into the tree.

        Args:
            words: the nodes to convert, and options.
            name: name of the folder in apps/.
            profile: profile of the nodes.

        Returns:
            The names of their applications.
        """
        made = self._folder / "apps" / name
        if main(["convert", *words, "-o", str(made), "--node-profile", profile]):
            raise SystemExit(f"{words[0]} could not be converted")
        with (self._folder / TARGETS).open("a", encoding="utf-8") as targets:
            targets.write(f"include(${{MISSION_SOURCE_DIR}}/apps/{name}/targets.cmake)\n")
        lines = (made / "startup_lines.scr").read_text(encoding="utf-8").splitlines()
        apps = {line.split(",")[3].strip(): line for line in lines}
        self._lines |= apps
        return list(apps)

    def build(self) -> Path:
        """Build the tree.

        Returns:
            The folder of the executable.

        Raises:
            SystemExit: the build failed, or the compiler warned of the nodes or the library.
        """
        for words in (["SIMULATION=native", "prep"], [], [f"DESTDIR={self._folder / 'build'}", "install"]):
            done = subprocess.run(
                ["nice", "make", *words],
                cwd=self._folder,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                check=False,
            )
            if done.returncode:
                raise SystemExit(done.stdout[-6000:])
            warnings = [line for line in done.stdout.splitlines() if " warning: " in line]
            if warnings:
                raise SystemExit("\n".join(warnings[:20]))
        return self._folder / "build/exe/cpu1"

    def startup(self, apps: Iterable[str], lines: Iterable[str] = ()) -> bytes:
        """Return a startup script with converted nodes.

        Args:
            apps: names of their applications.
            lines: lines that come first.
        """
        return "\n".join([*lines, *(self._lines[app] for app in apps), "!", ""]).encode()

    @contextmanager
    def booted(
        self, folder: Path, apps: Iterable[str], lines: Iterable[str] = (), files: Mapping[str, bytes] | None = None
    ) -> Iterator[RealCfe]:
        """NASA's cFE with some of the nodes, from its boot to its end.

        Args:
            folder: a new one, for its private copy.
            apps: names of the nodes' applications.
            lines: of the startup script, before those.
            files: contents by virtual path.
        """
        folder.mkdir()
        script = {STARTUP: self.startup(apps, lines)}
        with RealCfe(self._folder / "build/exe/cpu1", folder, {**script, **(files or {})}) as cfe:
            yield cfe

    def start(self, cfe: RealCfe, app: str) -> None:
        """Start one more node while cFE runs, by a command through CI_LAB.

        Args:
            cfe: it.
            app: name of the node's application.
        """
        _, file, entry, name, priority, stack, _, action = map(str.strip, self._lines[app].rstrip(";").split(","))
        command = START_APP.packet(
            Application=name,
            AppEntryPoint=entry,
            AppFileName=f"/cf/{file}.so",
            StackSize=int(stack),
            ExceptionAction=int(action),
            Priority=int(priority),
        )
        cfe.send(command)


def said(cfe: RealCfe) -> str:
    """Return the console output so far."""
    return cfe.console().decode("utf-8", "replace")
