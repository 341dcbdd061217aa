"""The version texts that cFE, OSAL and PSP show, in one place. Imports nothing of cfepy."""

from __future__ import annotations

CFE_VERSION = "v7.0.0+dev0"
OSAL_VERSION = "v7.0.0+dev0"
PSP_VERSION = "v7.0.0+dev0"
CODENAME = "Draco"
OFFICIAL = "v7.0.0"


def version_string(component: str, version: str = CFE_VERSION) -> str:
    """The long version text of a component, as CFE_Config_GetVersionString makes it."""
    return f"{component} {version} ({CODENAME}) {OFFICIAL} Official Release, EDS disabled"
