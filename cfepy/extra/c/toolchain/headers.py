"""The headers that compiled applications include: cFE's, OSAL's and the PSP's public interface, under NASA's names.

The declarations are in `cfepy/extra/c/headers`, a file for each part. The compiler gets a folder in the user's cache
that has them under `cfepy/`, and for each of NASA's names a file that includes them (`headers/names.txt`).

A cFS tree of the user's own can be used in their place. A configured tree (`make prep`) has the headers of its build in
`build/inc` and `build/native/*/inc`. For an unconfigured tree, the defaults of each module stand for them, as in its
build. Headers that only a build can make, such as `osconfig.h`, are then cfepy's.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.extra.c.build_cache import cache_folder, writing_cache
from cfepy.extra.c.toolchain.cfe6 import FOLDER
from cfepy.extra.c.toolchain.source_files import chosen_headers
from cfepy.status import UsageError

DECLARATIONS = Path(__file__).parents[1] / "headers"
NAMES = DECLARATIONS / "names.txt"
NAMES_6 = DECLARATIONS / "names_cfe6.txt"
"""Headers that only cFE 6 has."""
INNER = "cfepy"
"""The folder of the declarations, relative to the names."""


def headers_folder() -> Path:
    """Return the folder for the compiler's -I, and make it first if necessary.

    Raises:
        UsageError: it cannot be written.
    """
    files = _files()
    digest = hashlib.sha256(repr(sorted(files.items())).encode()).hexdigest()[:16]
    folder = cache_folder() / f"headers-{digest}"
    if not folder.is_dir():
        with writing_cache(folder.parent), tempfile.TemporaryDirectory(dir=folder.parent) as made:
            _write(files, Path(made) / "all")
            try:
                os.rename(Path(made) / "all", folder)
            except OSError:
                if not folder.is_dir():  # otherwise another process was quicker
                    raise
    return folder


def names(file: Path = NAMES) -> dict[str, list[str]]:
    """Return cfepy's headers for each of NASA's names; all without `.h`."""
    found: dict[str, list[str]] = {}
    ours: list[str] = []
    for line in file.read_text(encoding="utf-8").splitlines():
        if line.endswith(":"):
            ours = line[:-1].split()
        elif not line.startswith("#"):
            found.update((name, ours) for name in line.split())
    return found


def _files() -> dict[str, str]:
    """Return the contents of the folder: path to text."""
    files = {f"{INNER}/{each.name}": each.read_text(encoding="utf-8") for each in DECLARATIONS.glob("*.h")}
    for folder, listed in (("", NAMES), (f"{FOLDER}/", NAMES_6)):
        for name, ours in names(listed).items():
            files[f"{folder}{name}.h"] = "".join(f'#include "{INNER}/{each}.h"\n' for each in ours)
    return files


def _write(files: dict[str, str], folder: Path) -> None:
    (folder / INNER).mkdir(parents=True)
    (folder / FOLDER).mkdir()
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")


# -- a cFS tree --------------------------------------------------------------------------------------------------------

PUBLIC = ("cfe/modules/*/fsw/inc", "osal/src/os/inc", "psp/fsw/inc", "psp/fsw/modules/iodriver/inc")
MADE = ("build*/inc", "build*/native/*/inc", "build*/native/*/*/inc", "build*/osal_public_api/inc")
OPTIONS = {
    "cfe_msg_hdr.h": "cfe/modules/msg/option_inc/default_cfe_msg_hdr_pri.h",
    "cfe_msg_sechdr.h": "cfe/modules/msg/option_inc/default_cfe_msg_sechdr.h",
    "cfe_resourceid_typedef.h": "cfe/modules/resourceid/option_inc/cfe_resourceid_simple.h",
}
"""Headers of which a tree has several variants, with the default variant."""
MADE_BY_BUILDS = {
    "osconfig.h": "osal_config.h",
    "pspconfig.h": "osal_config.h",
    "cfe_config_ids.h": "config_ids.h",
}
"""Headers that only a build makes, and cfepy's that stand for them."""
NEEDED = "cfe/modules/core_api/fsw/inc/cfe.h"


@dataclass(slots=True)
class CfsTree:
    """The headers of a tree.

    Attributes:
        includes: folders, the first searched first.
        chosen: headers to write for the compiler: a name, and the file that stands for it.
    """

    includes: list[Path] = field(default_factory=list)
    chosen: dict[str, Path | None] = field(default_factory=dict)


def read_tree(folder: Path) -> CfsTree:
    """Find the headers of a cFS tree.

    Args:
        folder: the folder with cfe, osal and psp.

    Raises:
        UsageError: it is not such a tree.
    """
    if not (folder / NEEDED).is_file():
        raise UsageError(f"is not a cFS tree of cFE 7: {NEEDED} is missing", file=folder)
    folder = folder.resolve()
    tree = CfsTree()
    for pattern in (*MADE, *PUBLIC):
        tree.includes += sorted(each for each in folder.glob(pattern) if each.is_dir())
    if not any((each / "cfe_mission_cfg.h").is_file() for each in tree.includes):
        definitions = sorted(folder.glob("*_defs"))
        tree.chosen |= chosen_headers(sorted(folder.glob("cfe/modules/*/config")), definitions)
        tree.chosen |= {name: folder / file for name, file in OPTIONS.items()}
        tree.chosen |= {name: DECLARATIONS / file for name, file in MADE_BY_BUILDS.items()}
        tree.includes += definitions
    return tree
