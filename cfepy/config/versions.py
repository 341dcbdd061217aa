"""The releases of cFE that a mission can select, and the versions that cFE, OSAL and PSP report."""

from __future__ import annotations

from dataclasses import dataclass

CFE_7_0_0, CFE_7_0_1 = "7.0.0", "7.0.1"
OSAL_VERSION = "v7.0.0+dev0"
PSP_VERSION = "v7.0.0+dev0"
CODENAME = "Draco"
APP_VERSION = "v7.0.0+dev0"
OFFICIAL = "v7.0.0"
VERSION_NUMBER = (7, 0, 0, 0)
"""Major, minor, revision and mission revision of OSAL and PSP; the same with both releases of cFE."""

BUILD_NUMBER = 0  # of a release
MODULES = ("CORE_API", "ES", "EVS", "FS", "SB", "TBL", "TIME", "OSAL", "PSP", "MSG", "SBR", "RESOURCEID", "CONFIG")
"""The parts of the flight software, in the order of ES's version messages."""


@dataclass(frozen=True, slots=True)
class Release:
    """A release of cFE.

    Attributes:
        number: major, minor, revision, mission revision.
        longest_entry: number of characters of a startup script entry, without blanks, that ES reads.
    """

    number: tuple[int, int, int, int]
    longest_entry: int

    @property
    def official(self) -> str:
        """Its name, "v7.0.1" (CFE_LAST_OFFICIAL)."""
        return "v{}.{}.{}".format(*self.number)

    @property
    def source(self) -> str:
        """The version of its source, "v7.0.1+dev0" (CFE_SRC_VERSION)."""
        return f"{self.official}+dev{BUILD_NUMBER}"

    def module(self, name: str) -> str:
        """Return the source version of one of `MODULES`; it is the same for OSAL and the PSP in both releases."""
        return f"git:{OFFICIAL if name in ('OSAL', 'PSP') else self.official}"

    def text(self, component: str) -> str:
        """Return the long version text of a component."""
        return version_string(component, self.source, CODENAME, self.official)


RELEASES = {
    CFE_7_0_0: Release((7, 0, 0, 0), longest_entry=128),
    CFE_7_0_1: Release((7, 0, 1, 0), longest_entry=127),
}
"""The releases by their name in a mission file."""

DEFAULT_RELEASE = CFE_7_0_1
"""The release of a mission that names none; not 7.0.0, which refuses every table that the ground loads."""


def version_string(
    component: str, version: str = APP_VERSION, codename: str = CODENAME, official: str = OFFICIAL
) -> str:
    """Return the long version text of a component, as CFE_Config_GetVersionString makes it.

    Args:
        component: its name.
        version: version of this build.
        codename: code name of its release.
        official: version of the last official release.
    """
    return f"{component} {version} ({codename}) {official} Official Release, EDS disabled"


class VersionFunctions:
    """The version functions that OSAL and the PSP both have."""

    _version = OFFICIAL

    def get_version_string(self) -> str:
        """Return the version that this one corresponds to (OS_GetVersionString, CFE_PSP_GetVersionString)."""
        return self._version

    def get_version_code_name(self) -> str:
        """Return the code name of that release (OS_GetVersionCodeName, CFE_PSP_GetVersionCodeName)."""
        return CODENAME

    def get_version_number(self) -> tuple[int, int, int, int]:
        """Return major, minor, revision and mission revision (OS_GetVersionNumber, CFE_PSP_GetVersionNumber)."""
        return VERSION_NUMBER

    def get_build_number(self) -> int:
        """Return the build number, 0 for a release (OS_GetBuildNumber, CFE_PSP_GetBuildNumber)."""
        return BUILD_NUMBER
