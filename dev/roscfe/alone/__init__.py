"""Nodes that fly alone: programs for any computer, with the interface library and a stand-in for cFE in them.

`cfe_stand_in.cpp` has a Software Bus with one pipe and a clock that continues while the node waits. Tests that need
several applications, or cFE's own timing, fly on cfepy and on NASA's cFE instead.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from cfepy.extra.c import headers_folder
from cfepy.extra.convert.build import (
    WITH_ARENA,
    WITHOUT_TYPES,
    WRAPPED,
    BuildOptions,
    library_includes,
    library_sources,
    profile_flags,
)
from cfepy.extra.convert.cpp_sources import collect, message_types
from cfepy.extra.convert.entry import FREE_ROWS, NodeEntry, main_header
from cfepy.extra.convert.message_headers import Profile, write_headers
from dev.roscfe.building import FLIGHT_FLAGS, HERE, STRICT_FLAGS, Target, compile_objects, link_program
from dev.roscfe.probing import REMAPS, marked
from dev.roscfe.random_messages import LIBRARY, capacities
from rospy_shim.parameters.table import FREE

FOLDER = Path(__file__).parent
ACTIONS = ("count", "shy")
PARTS = ("goal", "cancel", "status", "feedback", "result")
TOPICS = ("a", "b", "latched", "silent", *(f"{action}/{part}" for action in ACTIONS for part in PARTS))
FIRST_ID = 0x0A00


def probe_entry() -> NodeEntry:
    """Return the entry point of the probes: `dev.roscfe.probing` gives them the same names."""
    ids = {f"/probes/{name}": (FIRST_ID + at, False) for at, name in enumerate(TOPICS)}
    remaps = {f"/probes/{one}": other if other[0] == "/" else f"/probes/{other}" for one, other in REMAPS.items()}
    return NodeEntry("NODE", "probe", "/probes", topics=ids, remaps=remaps, rows=[FREE] * FREE_ROWS)


class Alone:
    """The interface library with its stand-in, compiled once for a kind of computer and a profile.

    Args:
        folder: folder of the results.
        nodes: sources of the nodes to fly; they determine the needed parts of the library.
        target: the target computer.
        profile: the profile of the library and of the messages.
        flags: further flags of the compiler and the linker, such as the flags of a sanitizer.
        own_flags: flags of the library's sources only.
    """

    def __init__(
        self,
        folder: Path,
        nodes: Sequence[Path],
        target: Target = HERE,
        profile: Profile = Profile.HOST,
        flags: Sequence[str] = ("-O1",),
        own_flags: Sequence[str] = (),
    ) -> None:
        self._folder, self._target, self._profile = folder, target, profile
        messages, includes = folder / "messages", library_includes()
        self.sources = library_sources(collect(nodes, includes).contents)
        types = message_types(collect([*nodes, *self.sources], includes).missing, LIBRARY)
        write_headers(types, messages, profile, LIBRARY, capacities())
        self._flags = [f"-I{messages}", f"-I{FOLDER}", "-isystem", str(headers_folder())]
        self._flags += [*profile_flags(BuildOptions(profile)), *flags]
        self._library = self._objects(self.sources, ["-fvisibility=hidden", *STRICT_FLAGS, *WITHOUT_TYPES, *own_flags])
        stand_in = [FOLDER / "cfe_stand_in.cpp", FOLDER.parent / "cfe_messages.cpp"]
        self._stand_in = self._objects(stand_in, FLIGHT_FLAGS, "stand_in")
        self._nodes: dict[tuple[Path, ...], list[Path]] = {}

    def fly(self, source: Path, is_small: bool = False) -> list[str]:
        """Return a node's output. It has the name, the namespace and the remappings of `dev.roscfe.probing`.

        Args:
            source: the node's main file.
            is_small: see `program`.
        """
        done = self.run(self.program(source, is_small=is_small))
        assert done.returncode == 0, (done.returncode, done.stderr[-3000:])
        return list(marked(done.stdout.splitlines()))

    def run(
        self, program: Path, fails: str = "", environ: Mapping[str, str] | None = None, timeout_s: float = 300
    ) -> subprocess.CompletedProcess[str]:
        """Run a program of `program` to its end.

        Args:
            program: the program.
            fails: name of a function of cFE that fails, and behind a colon how many of its calls succeed first; empty
                if none does.
            environ: further variables of its environment.
            timeout_s: seconds of wall time after which the test fails.
        """
        command = [*self._target.runner, str(program)]
        variables = {**os.environ, **(environ or {}), "CFE_FAILS": fails}
        return subprocess.run(
            command, capture_output=True, check=False, timeout=timeout_s, text=True, errors="replace", env=variables
        )

    def program(self, source: Path, *more: Path, entry: NodeEntry | None = None, is_small: bool = False) -> Path:
        """Return the program of a node.

        Args:
            source: the node's main file.
            more: further sources.
            entry: its entry point, of the application NODE; None for the probes' entry point.
            is_small: whether to link only the parts of the library that the node needs, as in the image of a small
                computer. `target` must be this computer.
        """
        main = self._folder / "main.h"
        main.write_text(main_header(True), encoding="utf-8")
        made = self._folder / "entry.cpp"
        made.write_text((entry or probe_entry()).text(), encoding="utf-8")
        sources = source, *more
        if sources not in self._nodes:
            self._nodes[sources] = self._objects(sources, ["-std=c++17", "-Wall", "-include", str(main)], "node")
        library = [self._archive()] if is_small else self._library
        parts = [*self._nodes[sources], *self._objects([made], STRICT_FLAGS), *self._stand_in, *library]
        wrapped = [f"-Wl,--wrap={',--wrap='.join(WRAPPED)}"]
        wrapped += WITH_ARENA if self._profile is not Profile.HOST else ()
        return link_program(self._folder / source.stem, parts, *wrapped, *self._flags, target=self._target)

    def _archive(self) -> Path:
        made = self._folder / "libroscfe.a"
        if not made.is_file():
            subprocess.run(["ar", "rcs", str(made), *map(str, self._library)], check=True)
        return made

    def _objects(self, sources: Sequence[Path], base: Sequence[str], part: str = "library") -> list[Path]:
        return compile_objects(self._folder / part, sources, *self._flags, target=self._target, base=base)
