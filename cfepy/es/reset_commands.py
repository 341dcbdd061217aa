"""Commands that reset the processor, or say how often it may be reset (CFE_ES_RestartCmd, CFE_ES_*PRCountCmd)."""

from __future__ import annotations

from cfepy.es import events as ev
from cfepy.es import packets as pk
from cfepy.es.command_group import CommandGroup, Handlers
from cfepy.psp.psp import RST_TYPE_POWERON, RST_TYPE_PROCESSOR


class ResetCommands(CommandGroup):
    """Resetting the processor."""

    def handlers(self) -> Handlers:
        return (
            (pk.RESTART, self._restart),
            (pk.RESET_PR_COUNT, self._reset_count),
            (pk.SET_MAX_PR_COUNT, self._set_max_count),
        )

    def _restart(self, packet: bytes) -> None:
        kind = pk.RESTART.read(packet)["RestartType"]
        if kind in (RST_TYPE_PROCESSOR, RST_TYPE_POWERON):
            self._es.reset_cfe(kind)
        else:
            self._replies.reject(ev.BOOT_ERR_EID, f"Invalid cFE restart type: {kind}")

    def _reset_count(self, packet: bytes) -> None:
        self._es.reset.variables.processor_reset_count = 0
        self._replies.accept(ev.RESET_PR_COUNT_EID, "Set Processor Reset Count to Zero")

    def _set_max_count(self, packet: bytes) -> None:
        count = pk.SET_MAX_PR_COUNT.read(packet)["MaxPRCount"]
        self._es.reset.variables.max_processor_reset_count = count
        self._replies.accept(ev.SET_MAX_PR_COUNT_EID, f"Maximum Processor Reset Count set to: {count}")
