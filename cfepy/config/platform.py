"""Platform configuration: the values CFE_PLATFORM_* and CFE_MISSION_* that services read, with the defaults of cFE 7.0.

A board profile and a mission file can change them (`PlatformConfig.with_limits`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

from cfepy.config.versions import DEFAULT_RELEASE, RELEASES, Release

ES_MEM_BLOCK_SIZES = (8, 16, 32, 48, 64, 96, 128, 160, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768, 80000)
"""Bytes of the blocks in memory pools and in the CDS (CFE_PLATFORM_ES_MEM_BLOCK_SIZE_01 and following)."""

SB_MEM_BLOCK_SIZES = (8, 16, 20, 36, 64, 96, 128, 160, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768)
"""Bytes of the blocks in the Software Bus's pool, without the largest (CFE_PLATFORM_SB_MEM_BLOCK_SIZE_01 and
following).
"""

SB_LARGEST_BLOCK_MORE = 128
"""Bytes by which the largest block of that pool exceeds the largest message (CFE_PLATFORM_SB_MAX_BLOCK_SIZE)."""

MAY_BE_ZERO = frozenset(
    {
        "es_default_pr_syslog_mode",
        "es_max_processor_resets",
        "es_ram_disk_percent_reserved",
        "evs_default_type_flag",
        "evs_default_log_mode",
        "evs_default_msg_format_mode",
        "evs_port_default",
        "evs_max_app_event_burst",
        "time_def_met_secs",
        "time_def_stcf_secs",
        "time_def_leaps",
    }
)
"""Fields that accept 0 although their default is not 0; here 0 means a mode, no bit, never or off."""

COUNTED_BY_ID = frozenset(
    {
        "os_max_tasks",
        "os_max_queues",
        "os_max_bin_semaphores",
        "os_max_count_semaphores",
        "os_max_mutexes",
        "os_max_condvars",
        "os_max_rwlocks",
        "os_max_timers",
        "os_max_timebases",
        "os_max_modules",
        "os_max_num_open_files",
        "os_max_num_open_dirs",
        "os_max_file_systems",
        "es_max_applications",
        "es_max_libraries",
        "es_max_memory_pools",
        "es_max_gen_counters",
        "es_cds_max_num_entries",
        "sb_max_pipes",
        "tbl_max_num_tables",
        "tbl_max_num_handles",
    }
)
"""Limits on objects with resource ids; ids distinguish at most 65534 objects of a kind."""


REAL_TIME, FAIR = "real-time", "fair"
SCHEDULINGS = (REAL_TIME, FAIR)
"""The ways to schedule tasks: by priority, or in turns as Linux does for an ordinary user."""

NOT_LIMITS = frozenset({"cfe_version", "given", "safe", "scheduling"})
"""Fields that neither a board profile nor the `limits:` of a mission file can set."""

IDENTITIES: Mapping[str, str] = {"processor_id": "--cpuid", "spacecraft_id": "--scid"}
"""Identities that a run can override, with the option of NASA's executable for each."""

MOST_ID = 0xFFFF_FFFF


@dataclass(frozen=True, slots=True)
class PlatformConfig:
    """Limits and identities of one processor; field names are cFE's macro names without CFE_PLATFORM_/CFE_MISSION_.

    Attributes:
        cfe_version: the release of cFE that it runs, a key of `RELEASES`; a mission file has a field of its own for it.
        safe: whether OSAL and ES prevent hangs, leaks and ends of the process that NASA's Linux has; a mission file has
            a field of its own for it.
        scheduling: one of `SCHEDULINGS`; a mission file has a field of its own for it.
        given: the keys of `IDENTITIES` that the command line of the flight software set.
    """

    cfe_version: str = DEFAULT_RELEASE
    safe: bool = False
    scheduling: str = REAL_TIME
    given: tuple[str, ...] = ()

    spacecraft_id: int = 66
    processor_id: int = 1
    processor_name: str = "cpu1"

    os_max_tasks: int = 64
    os_max_queues: int = 64
    os_queue_max_depth: int = 50
    os_max_bin_semaphores: int = 20
    os_max_count_semaphores: int = 20
    os_max_mutexes: int = 20
    os_max_condvars: int = 4
    os_max_rwlocks: int = 20
    os_max_timers: int = 10
    os_max_timebases: int = 5
    os_max_modules: int = 20
    os_max_num_open_files: int = 50
    os_max_num_open_dirs: int = 4
    os_max_file_systems: int = 14

    es_max_applications: int = 32
    es_max_libraries: int = 10
    es_max_memory_pools: int = 10
    es_default_stack_size: int = 8192
    es_start_task_stack_size: int = 8192
    es_app_scan_rate_ms: int = 1000
    es_app_kill_timeout: int = 5
    es_startup_sync_poll_ms: int = 50
    es_startup_script_timeout_ms: int = 1000
    es_core_max_startup_ms: int = 30000
    es_system_log_size: int = 3072
    es_default_por_syslog_mode: int = 0
    es_default_pr_syslog_mode: int = 1
    es_er_log_entries: int = 20
    es_perf_data_buffer_size: int = 10000
    es_ram_disk_percent_reserved: int = 30
    es_max_processor_resets: int = 2
    es_cds_size: int = 131072
    es_cds_max_num_entries: int = 512
    es_max_gen_counters: int = 8

    sb_max_pipes: int = 64
    sb_max_msg_ids: int = 256
    sb_max_dest_per_pkt: int = 16
    sb_default_msg_limit: int = 4
    sb_buf_memory_bytes: int = 524288
    sb_max_msg_size: int = 32768
    sb_highest_valid_msg_id: int = 0x1FFF

    evs_max_event_filters: int = 8
    evs_log_max: int = 20
    evs_default_type_flag: int = 0x0E
    evs_default_log_mode: int = 1
    evs_default_msg_format_mode: int = 1
    evs_port_default: int = 0x01
    evs_max_app_event_burst: int = 32
    evs_app_events_per_sec: int = 15
    evs_max_message_length: int = 122

    tbl_max_num_tables: int = 128
    tbl_max_num_handles: int = 256
    tbl_max_simultaneous_loads: int = 4
    tbl_max_num_validations: int = 10
    tbl_max_sngl_table_size: int = 16384
    tbl_max_dbl_table_size: int = 16384
    tbl_buf_memory_bytes: int = 524288
    tbl_max_critical_tables: int = 32
    tbl_valid_scid: tuple[int, ...] = ()
    tbl_valid_prid: tuple[int, ...] = ()

    time_def_met_secs: int = 1000
    time_def_stcf_secs: int = 1000000
    time_def_met_subs: int = 0
    time_def_stcf_subs: int = 0
    time_def_leaps: int = 37
    time_cfg_default_utc: bool = False
    time_cfg_client: bool = False
    time_cfg_fake_tone: bool = True
    time_at_tone_will_be: bool = False
    time_cfg_signal: bool = False
    time_cfg_source: bool = False
    time_cfg_src_met: bool = False
    time_cfg_src_gps: bool = False
    time_cfg_src_time: bool = False
    time_min_elapsed: int = 0
    time_max_elapsed: int = 200000
    time_max_delta_secs: int = 0
    time_max_delta_subs: int = 500000
    time_max_local_secs: int = 27
    time_max_local_subs: int = 0
    time_cfg_tone_limit: int = 20000
    time_cfg_start_fly: int = 2
    time_cfg_latch_fly: int = 8

    @property
    def release(self) -> Release:
        """The release of cFE, with the facts that distinguish it from others."""
        return RELEASES[self.cfe_version]

    def with_limits(self, limits: Mapping[str, int | str | tuple[int, ...]]) -> PlatformConfig:
        """Return a copy with some values replaced.

        Args:
            limits: values by field name, as under `limits:` of a board profile.

        Raises:
            KeyError: if a name is not a field.
        """
        known = {field.name for field in fields(self)}
        for name in limits:
            if name not in known:
                raise KeyError(name)
        return replace(self, **limits)  # type: ignore[arg-type]  # names were checked against the fields
