"""CFE_Config_*: the configuration registry for C."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

from cfepy.reading.texts import to_bytes

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime


def declare(api: Declarations, c: CRuntime) -> None:
    """Add the functions. The texts and arrays that they point to stay in place."""
    config, memory, constants = c.handle.config, c.memory, c.constants

    def get_object(config_id: int) -> int:
        text = config.get_obj_pointer(config_id)
        return 0 if text is None else constants.text(text)

    def get_array(config_id: int) -> tuple[int, int]:
        values = config.get_array_value(config_id)
        return (len(values), constants.data(struct.pack(f"<{len(values)}Q", *values))) if values else (0, 0)

    def iterate(argument: int, callback: int) -> None:
        config.iterate_all(lambda config_id, name: c.run(callback, argument, config_id, constants.text(name)))

    def get_version(to: int, size: int, *texts: str | None) -> None:
        if size:
            made = to_bytes(config.get_version_string(*("(null)" if text is None else text for text in texts)))
            memory.poke(to, made[: size - 1] + b"\0")

    api.add("CFE_Config_GetValue", "I", config.get_value)
    api.add("CFE_Config_GetObjPointer", "I", get_object)
    api.add("CFE_Config_GetArrayValue", "&I", get_array)
    api.add("CFE_Config_GetString", "I", lambda config_id: constants.text(config.get_string(config_id)))
    api.add("CFE_Config_GetName", "I", lambda config_id: constants.text(config.get_name(config_id)))
    api.add("CFE_Config_GetIdByName", "p", lambda name: config.get_id_by_name(memory.text(name)))
    api.add("CFE_Config_IterateAll", "pp", iterate)
    api.add("CFE_Config_GetVersionString", "pQssss", get_version)
