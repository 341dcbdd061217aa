"""The versions that cFE, OSAL and PSP show, in one place."""

from __future__ import annotations

CFE_VERSION = "v7.0.0+dev0"
OSAL_VERSION = "v7.0.0+dev0"
PSP_VERSION = "v7.0.0+dev0"
CODENAME = "Draco"
OFFICIAL = "v7.0.0"
VERSION_NUMBER = (7, 0, 0, 0)
"""Major, minor, revision, mission revision: of cFE, OSAL and PSP alike."""

BUILD_NUMBER = 0  # of a release
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


class VersionFunctions:
    """The version functions that OSAL and the PSP both have."""

    _version = OFFICIAL

    def get_version_string(self) -> str:
        """The version that this is like (OS_GetVersionString, CFE_PSP_GetVersionString)."""
        return self._version

    def get_version_code_name(self) -> str:
        """The code name of that release (OS_GetVersionCodeName, CFE_PSP_GetVersionCodeName)."""
        return CODENAME

    def get_version_number(self) -> tuple[int, int, int, int]:
        """Major, minor, revision, mission revision (OS_GetVersionNumber, CFE_PSP_GetVersionNumber)."""
        return VERSION_NUMBER

    def get_build_number(self) -> int:
        """The build number, 0 for a release (OS_GetBuildNumber, CFE_PSP_GetBuildNumber)."""
        return BUILD_NUMBER
