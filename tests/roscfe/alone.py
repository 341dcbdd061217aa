"""Nodes that fly alone: programs for any computer, with the interface library and a stand-in for cFE in them.

`cfe_stand_in.cpp` has a Software Bus with one pipe and a clock that continues while the node waits. Tests that need
several applications, or cFE's own timing, fly on cfepy and on NASA's cFE instead.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence
from pathlib import Path

from cfepy.extra.c import headers_folder
from cfepy.extra.convert.build import WITHOUT_TYPES, WRAPPED, library_includes, library_sources, profile_flags
from cfepy.extra.convert.cpp_sources import collect, message_types
from cfepy.extra.convert.entry import FREE_ROWS, NodeEntry, main_header
from cfepy.extra.convert.message_headers import Profile, write_headers
from dev.roscfe.building import FLIGHT_FLAGS, HERE, STRICT_FLAGS, Target, compile_objects, link_program
from dev.roscfe.probing import REMAPS, marked
from dev.roscfe.random_messages import LIBRARY
from rospy_shim.parameters.table import FREE

FOLDER = Path(__file__).parent
ACTIONS = ("count", "shy")
PARTS = ("goal", "cancel", "status", "feedback", "result")
TOPICS = ("a", "b", "latched", "silent", *(f"{action}/{part}" for action in ACTIONS for part in PARTS))
FIRST_ID = 0x0A00


class Alone:
    """The interface library with its stand-in, compiled once for a kind of computer.

    Args:
        folder: folder of the results.
        nodes: sources of the nodes to fly; they determine the needed parts of the library.
        target: the target computer.
    """

    def __init__(self, folder: Path, nodes: Sequence[Path], target: Target = HERE) -> None:
        self._folder, self._target = folder, target
        messages, includes = folder / "messages", library_includes()
        sources = library_sources(collect(nodes, includes).contents)
        write_headers(
            message_types(collect([*nodes, *sources], includes).missing, LIBRARY), messages, Profile.HOST, LIBRARY
        )
        self._flags = [f"-I{messages}", "-isystem", str(headers_folder()), *profile_flags(Profile.HOST), "-O1"]
        library = self._objects(sources, [*STRICT_FLAGS, *WITHOUT_TYPES])
        self._library = [*library, *self._objects([FOLDER / "cfe_stand_in.cpp"], FLIGHT_FLAGS)]

    def fly(self, source: Path) -> list[str]:
        """Return a node's output. It has the name, the namespace and the remappings of `dev.roscfe.probing`."""
        done = self.run(self.program(source))
        assert done.returncode == 0, (done.returncode, done.stderr[-3000:])
        return list(marked(done.stdout.splitlines()))

    def run(self, program: Path, fails: str = "") -> subprocess.CompletedProcess[str]:
        """Run a program of `program` to its end.

        Args:
            program: the program.
            fails: name of a function of cFE that fails; empty if none does.
        """
        command = [*self._target.runner, str(program)]
        environ = {**os.environ, "CFE_FAILS": fails}
        return subprocess.run(
            command, capture_output=True, check=False, timeout=300, text=True, errors="replace", env=environ
        )

    def program(self, source: Path) -> Path:
        """Return the program of a node; see `fly`."""
        main = self._folder / "main.h"
        main.write_text(main_header(True), encoding="utf-8")
        ids = {f"/probes/{name}": (FIRST_ID + at, False) for at, name in enumerate(TOPICS)}
        remaps = {f"/probes/{one}": other if other[0] == "/" else f"/probes/{other}" for one, other in REMAPS.items()}
        rows = [FREE] * FREE_ROWS
        entry = self._folder / "entry.cpp"
        entry.write_text(
            NodeEntry("NODE", "probe", "/probes", topics=ids, remaps=remaps, rows=rows).text(), encoding="utf-8"
        )
        node = self._objects([source], ["-std=c++17", "-Wall", "-include", str(main)], "node")
        parts = [*node, *self._objects([entry], STRICT_FLAGS), *self._library]
        wrapped = f"-Wl,--wrap={',--wrap='.join(WRAPPED)}"
        return link_program(self._folder / source.stem, parts, wrapped, *self._flags, target=self._target)

    def _objects(self, sources: Sequence[Path], base: Sequence[str], part: str = "library") -> list[Path]:
        return compile_objects(self._folder / part, sources, *self._flags, target=self._target, base=base)
