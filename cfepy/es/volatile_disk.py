"""The RAM disk at boot (CFE_ES_InitializeFileSystems): new after a power-on, else checked for room."""

from __future__ import annotations

from cfepy.es.tables import EsCore
from cfepy.psp.psp import RST_TYPE_POWERON

MOUNT_POINT = "/ram"


def initialize_file_systems(es: EsCore, start_type: int) -> None:
    """Make the RAM disk ready.

    Args:
        es: whose board and limits.
        start_type: RST_TYPE_*.
    """
    if start_type == RST_TYPE_POWERON:
        _format(es)
        return
    stat = es.osal.file_sys_stat_volume(MOUNT_POINT)
    percent = stat.blocks_free * 100 // stat.total_blocks
    log = "CFE_ES_InitializeFileSystems: "
    es.write_to_sys_log(f"{log}Volatile Disk has {percent} Percent free space.")
    if percent < es.config.es_ram_disk_percent_reserved:
        es.write_to_sys_log(f"{log}Insufficient Free Space on Volatile Disk, Reformatting.")
        _format(es)


def _format(es: EsCore) -> None:
    es.osal.files.volume(MOUNT_POINT).clear()
