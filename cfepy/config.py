"""Platform configuration: the CFE_PLATFORM_* and CFE_MISSION_* values that services read, with cFE v7.0.0's defaults.

A board profile may lower them (`PlatformConfig.with_limits`); nothing else changes them. Imports nothing of cfepy.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace


@dataclass(frozen=True, slots=True)
class PlatformConfig:
    """Limits and identities of one processor; field names are cFE's macro names without CFE_PLATFORM_/CFE_MISSION_."""

    spacecraft_id: int = 66
    processor_id: int = 1
    processor_name: str = "cpu1"

    os_max_tasks: int = 64
    os_max_queues: int = 64
    os_queue_max_depth: int = 50
    os_max_semaphores: int = 64
    os_max_timers: int = 10
    os_max_timebases: int = 5

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
    es_max_processor_resets: int = 2
    es_cds_size: int = 131072

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

    time_def_met_secs: int = 1000
    time_def_stcf_secs: int = 1000000
    time_def_leaps: int = 37
    time_start_fly_secs: int = 2

    def with_limits(self, limits: dict[str, int | str]) -> PlatformConfig:
        """A copy with some values replaced.

        Args:
            limits: field name to value, as under `limits:` of a board profile.

        Raises:
            KeyError: a name that is not a field here.
        """
        known = {field.name for field in fields(self)}
        for name in limits:
            if name not in known:
                raise KeyError(name)
        return replace(self, **limits)  # type: ignore[arg-type]  # names were checked against the fields
