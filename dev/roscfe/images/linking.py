"""Link nodes in C++ as flight software does: a shared object on Linux, a part of the one image on a bare computer.

A node, its entry point and the interface library become one object on a bare computer, in which only the entry point
keeps its name. So two nodes in one image share no variables, and each has the parts of the library that it needs.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from cfepy.extra.c import headers_folder
from cfepy.extra.convert.build import (
    ALLOCATING,
    LANGUAGE,
    OWN_CPP_LIBRARY,
    WITH_ARENA,
    WITHOUT_EXCEPTIONS,
    WRAPPED,
    library_includes,
    library_sources,
)
from cfepy.extra.convert.cpp_sources import collect, message_types
from cfepy.extra.convert.entry import NodeEntry, main_header
from cfepy.extra.convert.message_headers import Profile, write_headers
from rospy_shim.types.msgs import shipped

FOLDER = Path(__file__).parent
TOPICS = {"/chatter": (0x0A00, False)}
STAND_IN = ("start.cpp", "tasks.cpp", "stand_in.cpp", "apps.cpp")
MESSAGES = FOLDER.parent / "cfe_messages.cpp"
"""The part of the stand-in that nodes that fly alone have, too."""
SIZE_FLAGS = (
    "-Os",
    "-g0",
    "-fno-threadsafe-statics",
    "-fno-asynchronous-unwind-tables",
    "-fno-unwind-tables",
    "-w",
)


class Computer(NamedTuple):
    """A kind of computer.

    Attributes:
        prefix: of the compiler's commands.
        flags: of its compiler.
        bare: there is no operating system with shared objects, and no POSIX.
    """

    prefix: str
    flags: tuple[str, ...] = ()
    bare: bool = False

    @property
    def lacking(self) -> str | None:
        """The compiler's command if it is not installed."""
        command = self.command("g++")
        return command if shutil.which(command) is None else None

    def command(self, name: str) -> str:
        """Return a command of its compiler, such as "size"."""
        return f"{self.prefix}{name}"


CORTEX_M7 = ("-mcpu=cortex-m7", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv5-d16")
COMPUTERS = {
    "x86-64": Computer(""),
    "ARM Linux": Computer("arm-linux-gnueabihf-"),
    "Cortex-M7": Computer("arm-none-eabi-", CORTEX_M7, bare=True),
}


class Sizes(NamedTuple):
    """Bytes of an image.

    Attributes:
        text: code and constants.
        ram: variables, the arena included.
    """

    text: int
    ram: int


class Linker:
    """The interface library for a kind of computer, in the strict profile, and nodes that are linked with it.

    Args:
        computer: the kind of computer.
        folder: folder of the results.
        nodes: sources of nodes that are linked later; they determine the generated headers.
        arena: bytes of a node's arena.
    """

    def __init__(self, computer: Computer, folder: Path, nodes: Sequence[Path], arena: int) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self.computer, self._folder = computer, folder
        sources = library_sources(collect(nodes, library_includes()).contents)
        self.sources = [each for each in sources if not computer.bare or each.parent.name != "posix"]
        messages = folder / "messages"
        needed = collect([*nodes, *self.sources], library_includes()).missing
        write_headers(message_types(needed, shipped()), messages, Profile.STRICT, shipped())
        self._include = [f"-I{each}" for each in (messages, *library_includes())]
        self._include += ["-isystem", str(headers_folder())]
        # GNU extensions and -fPIC are not needed where everything is one image.
        language = [each for each in LANGUAGE if each != "-fPIC" or not computer.bare]
        self._flags = [*language, *SIZE_FLAGS, *WITHOUT_EXCEPTIONS, *computer.flags, "-DROSCFE_PROFILE_STRICT"]
        self._flags.append(f"-DROSCFE_ARENA_BYTES={arena}")
        self._library = folder / "libroscfe.a"
        self._library.unlink(missing_ok=True)
        objects = [self.compiled(each) for each in self.sources]
        self.call("ar", "rcs", str(self._library), *map(str, objects))

    def linked(self, source: Path, entry: NodeEntry) -> Path:
        """Return a node with the parts of the library that it needs: a shared object, or an object of an image."""
        main = self._folder / "main.h"
        main.write_text(main_header(entry.takes_arguments), encoding="utf-8")
        text = self._folder / f"{entry.app.lower()}_entry.cpp"
        text.write_text(entry.text(), encoding="utf-8")
        objects = [self.compiled(source, "-include", str(main)), self.compiled(text)]
        made = self._folder / f"{entry.app.lower()}.{'o' if self.computer.bare else 'so'}"
        if self.computer.bare:
            self._link_part(made, objects, entry.symbol)
        else:
            flags = [f"-Wl,--wrap={',--wrap='.join(WRAPPED)}", *WITH_ARENA, *OWN_CPP_LIBRARY, "-Wl,-Bsymbolic"]
            exports = self._folder / "exports.map"
            exports.write_text(f"{{ global: {entry.symbol}; roscfe_node; local: *; }};\n", encoding="utf-8")
            flags += ["-shared", "-Wl,--gc-sections", "-Wl,-O1", f"-Wl,--version-script={exports}", "-s"]
            self.call("g++", *self.computer.flags, *map(str, objects), str(self._library), *flags, "-o", str(made))
        return made

    def compiled(self, source: Path, *more: str) -> Path:
        """Return the object file of a source in C or C++."""
        made = self._object(source)
        self.call("g++", *self._flags, *self._include, *more, "-c", str(source), "-o", str(made))
        return made

    def image(self, nodes: Sequence[Path]) -> Path:
        """Return an image of a bare computer: nodes, the applications in apps.cpp, and the stand-in for cFE."""
        objects = [*nodes, *(self.compiled(FOLDER / name) for name in STAND_IN), self.compiled(MESSAGES)]
        formats = [self.compiled(each) for each in self.sources if each.name in ("formats.cpp", "floats.cpp")]
        made = self._folder / "image.elf"
        self._link_image(made, [*objects, *formats], f"-Wl,-T,{FOLDER / 'image.ld'}")
        return made

    def sizes(self, node: Path, symbol: str) -> Sizes:
        """Return the bytes of a linked node; on a bare computer with the functions of libc that it alone would need."""
        if self.computer.bare:
            whole = node.with_suffix(".elf")
            flags = ["-Wl,--unresolved-symbols=ignore-all", "-Wl,--defsym=__dso_handle=0", f"-Wl,-e,{symbol}"]
            self._link_image(whole, [node], *flags)
            node = whole
        text, data, bss = map(int, self.call("size", str(node)).splitlines()[1].split()[:3])
        return Sizes(text, data + bss)

    def core_sizes(self) -> Sizes:
        """Return the bytes of the core's object files."""
        core = [self._object(each) for each in self.sources if each.parent.name == "core"]
        rows = [list(map(int, line.split()[:3])) for line in self.call("size", *map(str, core)).splitlines()[1:]]
        return Sizes(sum(row[0] for row in rows), sum(row[1] + row[2] for row in rows))

    def _object(self, source: Path) -> Path:
        return self._folder / f"{source.parent.name}-{source.stem}.o"

    def _link_image(self, made: Path, objects: Sequence[Path], *flags: str) -> None:
        given = ["-nostartfiles", "--specs=nosys.specs", "-Wl,--gc-sections", "-Wl,--no-warn-rwx-segments", *flags]
        self.call("g++", *self.computer.flags, *map(str, objects), *given, "-o", str(made))

    def call(self, name: str, *words: str) -> str:
        """Run a command of the compiler. Returns its output."""
        command = [self.computer.command(name), *words]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(f"{command[0]}: {done.stderr[-3000:]}")
        return done.stdout

    def _link_part(self, made: Path, objects: Sequence[Path], symbol: str) -> None:
        """Link a node into one object whose names are its own.

        It contains libstdc++, whose functions allocate from the node's arena. libc and libgcc come with the image.
        """
        wrapped = [f"-Wl,--wrap={name}" for name in (*WRAPPED, *ALLOCATING)]
        keep = [f"-Wl,-u,{symbol}", f"-Wl,-e,{symbol}", "-Wl,--gc-sections"]
        flags = ["-r", "-nostdlib", "-Wl,--force-group-allocation", *keep, *wrapped]
        flags += [*map(str, objects), str(self._library), "-lstdc++"]
        self.call("g++", *self.computer.flags, *flags, "-o", str(made))
        # Nothing is thrown, so the tables for that are not needed, nor libgcc's reader of them.
        tables = [f"--remove-section={name}" for name in (".ARM.exidx*", ".ARM.extab*", ".rel.ARM.ex*")]
        self.call("objcopy", f"--keep-global-symbol={symbol}", "--strip-unneeded", *tables, str(made))


def entry_of(name: str) -> NodeEntry:
    """Return the entry point of a node of this folder."""
    return NodeEntry(name.upper(), name, "/", topics=TOPICS)
