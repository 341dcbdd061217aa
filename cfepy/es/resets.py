"""Resets: the cause and number of the processor's starts, and new resets (CFE_ES_ResetCFE, CFE_ES_GetResetType)."""

from __future__ import annotations

from cfepy.es import erlog
from cfepy.es.reset_data import ResetData
from cfepy.es.tables import EsCore
from cfepy.psp import (
    RST_SUBTYPE_HW_SPECIAL_COMMAND,
    RST_SUBTYPE_HW_WATCHDOG,
    RST_SUBTYPE_POWER_CYCLE,
    RST_SUBTYPE_RESET_COMMAND,
    RST_TYPE_POWERON,
    RST_TYPE_PROCESSOR,
    RestartType,
)
from cfepy.status import CFE_ES_BAD_ARGUMENT, CfeError

KEY = "ES"
"""The key of Executive Services' reset data in the board's retained memory."""

_POWER_ON_CAUSES = {
    RST_SUBTYPE_POWER_CYCLE: "Power Cycle (Power Cycle)",
    RST_SUBTYPE_HW_SPECIAL_COMMAND: "HW Special Cmd (Hw Spec Cmd)",
}


class ResetApi(EsCore):
    """The functions on resets for applications and the boot."""

    def get_reset_type(self) -> RestartType:
        """Return the type and subtype of the last reset (CFE_ES_GetResetType): RST_TYPE_*, RST_SUBTYPE_*."""
        return RestartType(self.reset.variables.reset_type, self.reset.variables.reset_subtype)

    def reset_cfe(self, reset_type: int) -> None:
        """Reset the processor (CFE_ES_ResetCFE). The call does not return to a task.

        Too many processor resets in a row become a power-on reset.

        Args:
            reset_type: RST_TYPE_PROCESSOR or RST_TYPE_POWERON.

        Raises:
            CfeError: CFE_ES_BAD_ARGUMENT for another type.
        """
        variables = self.reset.variables
        if reset_type == RST_TYPE_POWERON:
            text = "POWERON RESET called from CFE_ES_ResetCFE (Commanded)."
        elif reset_type != RST_TYPE_PROCESSOR:
            self.write_to_sys_log(f"CFE_ES_ResetCFE: Invalid Reset Type: {reset_type}.")
            raise CfeError(CFE_ES_BAD_ARGUMENT, f"invalid reset type {reset_type}")
        else:
            variables.processor_reset_count += 1
            if variables.processor_reset_count > variables.max_processor_reset_count:
                reset_type = RST_TYPE_POWERON
                text = "POWER ON RESET due to max proc resets (Commanded)."
            else:
                variables.es_caused_reset = True
                text = "PROCESSOR RESET called from CFE_ES_ResetCFE (Commanded)."
        self.write_to_sys_log(f"CFE_ES_ResetCFE: {text}")
        self.er_log.write(erlog.CORE, reset_type, RST_SUBTYPE_RESET_COMMAND, text)
        self.psp.restart(reset_type, text)

    def setup_reset_variables(self, start_type: int, start_subtype: int, boot_source: int) -> None:
        """Determine, at boot, why the processor was started (CFE_ES_SetupResetVariables).

        Args:
            start_type: RST_TYPE_*, from the board.
            start_subtype: RST_SUBTYPE_*.
            boot_source: the source of the boot.
        """
        psp = self.psp
        if KEY not in psp.retained.kept:
            fresh = ResetData(self.config, psp.get_timer_ticks_per_second(), psp.get_timer_low32_rollover())
            psp.retained.kept[KEY] = fresh
        self.keep_in(psp.retained.kept[KEY])
        variables = self.reset.variables
        variables.boot_source = boot_source
        if start_type == RST_TYPE_POWERON:
            self._powered_on(start_subtype)
        elif variables.es_caused_reset:
            variables.reset_type, variables.reset_subtype = RST_TYPE_PROCESSOR, start_subtype
        else:
            self._reset_by_hardware(start_subtype)
        variables.es_caused_reset = False
        self.perf_log.stop()

    def _powered_on(self, subtype: int) -> None:
        variables = self.reset.variables
        variables.reset_type, variables.reset_subtype = RST_TYPE_POWERON, subtype
        text = f"POWER ON RESET due to {_POWER_ON_CAUSES.get(subtype, 'other cause (See Subtype)')}"
        self.write_to_sys_log(f"CFE_ES_SetupResetVariables: {text}.")
        self.er_log.write(erlog.CORE, RST_TYPE_POWERON, subtype, text)
        variables.processor_reset_count = 0
        variables.max_processor_reset_count = self.config.es_max_processor_resets

    def _reset_by_hardware(self, start_subtype: int) -> None:
        """Record a processor reset that software did not request: by the watchdog or by a special hardware command."""
        variables = self.reset.variables
        variables.reset_type = RST_TYPE_PROCESSOR
        variables.processor_reset_count += 1
        special = start_subtype == RST_SUBTYPE_HW_SPECIAL_COMMAND
        variables.reset_subtype = RST_SUBTYPE_HW_SPECIAL_COMMAND if special else RST_SUBTYPE_HW_WATCHDOG
        too_many = variables.processor_reset_count > variables.max_processor_reset_count
        if too_many:
            text = f"POWER ON RESET due to max proc resets ({'HW Spec Cmd' if special else 'Watchdog'})."
        elif special:
            text = "PROCESSOR RESET due to Hardware Special Command (Hw Spec Cmd)."
        else:
            text = "PROCESSOR RESET due to Watchdog (Watchdog)."
        self.write_to_sys_log(f"CFE_ES_SetupResetVariables: {text.replace('Hw Spec', 'HW Spec')}")
        self.er_log.write(erlog.CORE, RST_TYPE_POWERON if too_many else RST_TYPE_PROCESSOR, start_subtype, text)
        if too_many:
            self.psp.restart(RST_TYPE_POWERON, text, fault=True)
