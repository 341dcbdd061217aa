"""HEATER: a cFE application that keeps a temperature in the limits of its table."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.msg import Command, CommandTable, Layout, Telemetry
from cfepy.msg.dispatch import DONE
from cfepy.tbl import TableType

CMD_MID, HK_MID = 0x18A0, 0x08A0
NOOP_EID, TARGET_EID, REJECTED_EID = 1, 2, 3
SECOND_MS = 1000

NOOP = Command("HEATER_NOOP", CMD_MID, 0, text="Sends an event.")
SET_TARGET = Command("HEATER_SET_TARGET", CMD_MID, 1, Layout("Target", [("Celsius", "f32")]), "Sets the target.")
HK_TLM = Telemetry(
    "HEATER_HK_TLM", HK_MID, Layout("Hk", [("Accepted", "u8"), ("Rejected", "u8"), ("Target", "f32")]), "Each second."
)
LIMITS = TableType("HEATER.Limits", Layout("Limits", [("Low", "i16"), ("High", "i16")]))

COMMANDS, TELEMETRY, TABLES = (NOOP, SET_TARGET), (HK_TLM,), (LIMITS,)


class Heater:
    """The application's state."""

    def __init__(self, cfe: Cfe) -> None:
        self.cfe = cfe
        self.accepted = self.rejected = 0
        self.target = 20.0
        self.commands = CommandTable((NOOP, self.noop), (SET_TARGET, self.set_target))
        cfe.evs.register()
        self.pipe = cfe.sb.create_pipe(10, "HEATER_PIPE")
        cfe.sb.subscribe(CMD_MID, self.pipe)
        self.limits = cfe.tbl.register(LIMITS.own_name, LIMITS.size, validate=check)
        cfe.tbl.load(self.limits, LIMITS.pack({"Low": -10, "High": 40}))

    def step(self) -> None:
        """A command, or a second without one."""
        packet = self.cfe.sb.receive_buffer(self.pipe, SECOND_MS)
        if packet is not None and self.commands.dispatch(packet).outcome != DONE:
            self.reject("no command of mine")
        counters = {"Accepted": self.accepted & 0xFF, "Rejected": self.rejected & 0xFF, "Target": self.target}
        self.cfe.sb.transmit_msg(HK_TLM.packet(counters))
        self.cfe.tbl.manage(self.limits)

    def noop(self, packet: bytes) -> None:
        self.accepted += 1
        self.cfe.evs.send_info(NOOP_EID, "HEATER: no-op")

    def set_target(self, packet: bytes) -> None:
        target = SET_TARGET.read(packet)["Celsius"]
        image, _ = self.cfe.tbl.get_address(self.limits)
        limits = LIMITS.unpack(bytes(image))[0]
        self.cfe.tbl.release_address(self.limits)
        if not limits["Low"] <= target <= limits["High"]:
            self.reject(f"{target:g} is out of limits")
            return
        self.accepted += 1
        self.target = target
        self.cfe.evs.send_info(TARGET_EID, f"HEATER: target {target:g}")

    def reject(self, why: str) -> None:
        self.rejected += 1
        self.cfe.evs.send_err(REJECTED_EID, f"HEATER: {why}")


def check(image: memoryview) -> int:
    """Whether a table is good, as cFE asks: 0 or a negative number."""
    limits = LIMITS.unpack(bytes(image))[0]
    return 0 if limits["Low"] < limits["High"] else -1


def HEATER_AppMain(cfe: Cfe) -> None:
    """The entry point that the startup script names."""
    heater = Heater(cfe)
    while cfe.es.run_loop():
        heater.step()
    cfe.es.exit_app()
