"""POWER: a battery, and a heater that drains it; LC watches the charge, and SC switches the heater off."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.msg import Command, CommandTable, Layout, Measurement, Telemetry

CMD_MID, HK_TLM_MID = 0x18D0, 0x08D0
PERIOD_MS = 1000
DRAINED, CHARGED, FULL = 5, 1, 100  # percent a second, percent a second, percent
HEATER_EID = 1

CHARGE = Measurement("u16", "%", yellow=(40, None), red=(20, None))
HOUSEKEEPING = Layout("POWER_HkTlm_Payload_t", [("Charge", CHARGE), ("Heater", "u8"), ("CommandCounter", "u8")])
HEATER = Layout("POWER_SetHeater_Payload_t", [("On", "u8"), ("Padding", "u8[3]")])
SET_HEATER = Command("POWER_SET_HEATER", CMD_MID, 1, HEATER, "Switches the heater on or off.")
HK_TLM = Telemetry("POWER_HK_TLM", HK_TLM_MID, HOUSEKEEPING, "Charge in percent, and whether the heater is on.")
COMMANDS = (SET_HEATER,)
TELEMETRY = (HK_TLM,)


class Power:
    """The battery's charge and the heater's switch."""

    def __init__(self, cfe: Cfe) -> None:
        self._cfe = cfe
        self._charge, self._heater, self._accepted = FULL, 0, 0
        self._commands = CommandTable((SET_HEATER, self.set_heater))
        cfe.evs.register()
        self._pipe = cfe.sb.create_pipe(10, "POWER_PIPE")
        cfe.sb.subscribe(CMD_MID, self._pipe)

    def set_heater(self, packet: bytes) -> None:
        """Execute a command."""
        self._accepted += 1
        self._heater = int(bool(SET_HEATER.read(packet)["On"]))
        self._cfe.evs.send_info(HEATER_EID, f"POWER: heater {'on' if self._heater else 'off'}, charge {self._charge}")

    def run(self) -> None:
        """Send the charge once a second."""
        while self._cfe.es.run_loop():
            self._cfe.os.task_delay(PERIOD_MS)
            while (packet := self._cfe.sb.receive_buffer(self._pipe, 0)) is not None:
                self._commands.dispatch(packet)
            change = -DRAINED if self._heater else CHARGED
            self._charge = min(FULL, max(0, self._charge + change))
            told = HK_TLM.packet(Charge=self._charge, Heater=self._heater, CommandCounter=self._accepted & 0xFF)
            self._cfe.sb.transmit_msg(told)


def POWER_Main(cfe: Cfe) -> None:
    """Run the application; the startup script names this function."""
    Power(cfe).run()
    cfe.es.exit_app()
