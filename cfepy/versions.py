"""The version texts that cFE, OSAL and PSP show, in one place. Imports nothing of cfepy."""

from __future__ import annotations

CFE_VERSION = "v7.0.0+dev0"
OSAL_VERSION = "v7.0.0+dev0"
PSP_VERSION = "v7.0.0+dev0"
CODENAME = "Draco"
OFFICIAL = "v7.0.0"
MODULES = ("CORE_API", "ES", "EVS", "FS", "SB", "TBL", "TIME", "OSAL", "PSP", "MSG", "SBR", "RESOURCEID", "CONFIG")
"""The parts of the flight software, in the order in which ES tells their versions."""


def version_string(
    component: str, version: str = CFE_VERSION, codename: str = CODENAME, official: str = OFFICIAL
) -> str:
    """The long version text of a component, as CFE_Config_GetVersionString makes it.

    Args:
        component: its name.
        version: of this build.
        codename: of the release that it belongs to.
        official: version of the last official release.
    """
    return f"{component} {version} ({codename}) {official} Official Release, EDS disabled"
