"""`ConfigServices`: the object behind `cfe.config` (cFE's configuration registry, CFE_Config_*).

NASA's keys come first, in NASA's order. They have NASA's ids, except that a C build also has keys for its applications.
The platform configuration follows, like a mission's own keys.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict

from cfepy.config import versions
from cfepy.config.platform import (
    ES_MEM_BLOCK_SIZES,
    NOT_LIMITS,
    SB_LARGEST_BLOCK_MORE,
    SB_MEM_BLOCK_SIZES,
    PlatformConfig,
)
from cfepy.ids import CONFIGID_BASE, UNDEFINED, get_base, get_serial, make

UNKNOWN = "[unknown]"
NO_OBJECT = None

Array = tuple[int, ...]
Value = int | str | Array | None


class ConfigServices:
    """The registry of one processor. Its functions never fail: for an unknown id they return 0, "[unknown]" or None, as
    NASA's do.

    Args:
        config: the platform's limits.
        mission: the mission's name.
    """

    get_version_string = staticmethod(versions.version_string)

    def __init__(self, config: PlatformConfig, mission: str) -> None:
        values = _build_info(config, mission) | _arrays(config) | _platform(config)
        self._names = list(values)
        self._values = list(values.values())

    def get_value(self, config_id: int) -> int:
        """Return a number; 0 if the key has none (CFE_Config_GetValue)."""
        value = self._find(config_id)
        return value if isinstance(value, int) else 0

    def get_string(self, config_id: int) -> str:
        """Return a text; "[unknown]" if the key has none (CFE_Config_GetString)."""
        value = self._find(config_id)
        return value if isinstance(value, str) else UNKNOWN

    def get_array_value(self, config_id: int) -> Array:
        """Return the numbers of an array; an empty tuple if the key has no array (CFE_Config_GetArrayValue)."""
        value = self._find(config_id)
        return value if isinstance(value, tuple) else ()

    def get_obj_pointer(self, config_id: int) -> str | None:
        """Return the object that a key points to: a text, or None for the EDS databases, which this build lacks
        (CFE_Config_GetObjPointer).
        """
        value = self._find(config_id)
        return value if isinstance(value, str) else NO_OBJECT

    def get_name(self, config_id: int) -> str:
        """Return the name of a key, without CFE_CONFIGID_; "[unknown]" if there is no such key (CFE_Config_GetName)."""
        index = self._index(config_id)
        return self._names[index] if index is not None else UNKNOWN

    def get_id_by_name(self, name: str) -> int:
        """Return the id of a key, or 0 if no key has that name (CFE_Config_GetIdByName).

        >>> config = ConfigServices(PlatformConfig(), "demo")
        >>> config.get_string(config.get_id_by_name("MISSION_NAME"))
        'demo'
        """
        return make(CONFIGID_BASE, self._names.index(name)) if name in self._names else UNDEFINED

    def iterate_all(self, callback: Callable[[int, str], object]) -> None:
        """Call a function with the id and name of each key, in the order of the ids (CFE_Config_IterateAll)."""
        for index, name in enumerate(self._names):
            callback(make(CONFIGID_BASE, index), name)

    def _index(self, config_id: int) -> int | None:
        index = get_serial(config_id)
        return index if get_base(config_id) == CONFIGID_BASE and index < len(self._names) else None

    def _find(self, config_id: int) -> Value:
        index = self._index(config_id)
        return self._values[index] if index is not None else None


def _build_info(config: PlatformConfig, mission: str) -> dict[str, Value]:
    """Return the keys of config_ids_base.cmake."""
    release = config.release
    version = release.cfe_version
    major, minor, revision, mission_revision = version.number
    return {
        "MISSION_NAME": mission,
        "MISSION_SRCVER": release.module("CORE_API"),
        "MISSION_EDS_DB": NO_OBJECT,
        "MISSION_SBINTF_DB": NO_OBJECT,
        "CORE_VERSION_MAJOR": major,
        "CORE_VERSION_MINOR": minor,
        "CORE_VERSION_REVISION": revision,
        "CORE_VERSION_MISSION_REV": mission_revision,
        "CORE_VERSION_BUILDNUM": version.build_number,
        "CORE_VERSION_BASELINE": version.official,
        "CORE_VERSION_DESCRIPTION": release.text("cFE"),
        "CORE_BUILDINFO_DATE": f"cfepy {version.source}",
        "CORE_BUILDINFO_USER": "cfepy",
        "CORE_BUILDINFO_HOST": config.processor_name,
        **{f"MOD_SRCVER_{module}": release.module(module) for module in versions.MODULES},
    }


def _arrays(config: PlatformConfig) -> dict[str, Value]:
    """Return the keys of config_ids_dynamic.cmake, with block sizes from the largest to the smallest."""
    es_blocks = ES_MEM_BLOCK_SIZES[::-1]
    return {
        "PLATFORM_TBL_VALID_SCID": (),
        "PLATFORM_TBL_VALID_PRID": (),
        "PLATFORM_ES_MEM_BLOCK_SIZE": es_blocks,
        "PLATFORM_ES_CDS_MEM_BLOCK_SIZE": es_blocks,
        "PLATFORM_SB_MEM_BLOCK_SIZE": (config.sb_max_msg_size + SB_LARGEST_BLOCK_MORE, *SB_MEM_BLOCK_SIZES[::-1]),
    }


def _platform(config: PlatformConfig) -> dict[str, Value]:
    """Return the fields of the platform configuration as keys, such as PLATFORM_ES_MAX_APPLICATIONS. OSAL's keys have
    no prefix: OS_MAX_TASKS.
    """
    fields: dict[str, Value] = {name: value for name, value in asdict(config).items() if name not in NOT_LIMITS}
    return {name.upper() if name.startswith("os_") else f"PLATFORM_{name.upper()}": fields[name] for name in fields}
