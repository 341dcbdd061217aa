"""A cFS tree of the user's own, whose headers are taken in place of cfepy's.

A tree that was configured (`make prep`) has the headers that its build made in `build/inc` and `build/native/*/inc`.
Of one that was not, the defaults of each module stand for them, as they would for its build; what only a build can
make, such as `osconfig.h`, is cfepy's then.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from cfepy.c.toolchain.headers import DECLARATIONS
from cfepy.c.toolchain.sources import chosen_headers
from cfepy.status import UsageError

PUBLIC = ("cfe/modules/*/fsw/inc", "osal/src/os/inc", "psp/fsw/inc", "psp/fsw/modules/iodriver/inc")
MADE = ("build*/inc", "build*/native/*/inc", "build*/native/*/*/inc", "build*/osal_public_api/inc")
OPTIONS = {
    "cfe_msg_hdr.h": "cfe/modules/msg/option_inc/default_cfe_msg_hdr_pri.h",
    "cfe_msg_sechdr.h": "cfe/modules/msg/option_inc/default_cfe_msg_sechdr.h",
    "cfe_resourceid_typedef.h": "cfe/modules/resourceid/option_inc/cfe_resourceid_simple.h",
}
"""Headers of which a tree has several to choose from; those that it takes when nothing else is said."""
MADE_BY_BUILDS = {
    "osconfig.h": "osal_config.h",
    "pspconfig.h": "osal_config.h",
    "cfe_config_ids.h": "config_ids.h",
}
"""Headers that only a build makes, and cfepy's that stand for them."""
NEEDED = "cfe/modules/core_api/fsw/inc/cfe.h"


@dataclass(slots=True)
class CfsTree:
    """Where a tree has its headers.

    Attributes:
        includes: folders, the first searched first.
        chosen: headers to be written for the compiler: a name, and the file that stands for it.
    """

    includes: list[Path] = field(default_factory=list)
    chosen: dict[str, Path | None] = field(default_factory=dict)


def read_tree(folder: Path) -> CfsTree:
    """Find the headers of a cFS tree.

    Args:
        folder: that has cfe, osal and psp.

    Raises:
        UsageError: it is no such tree.
    """
    if not (folder / NEEDED).is_file():
        raise UsageError(f"is no cFS tree of cFE 7: {NEEDED} is not there", file=folder)
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
