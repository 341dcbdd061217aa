"""A mission with an application that heats up: its telemetry has units, a calibration and limits."""

from __future__ import annotations

from pathlib import Path

from tests.mission.flights import write_mission

STARTUP = "CFE_APP, thermal, THERMAL_Main, THERMAL, 50, 8192, 0x0, 0;\n!\n"
THERMAL = """
    from cfepy.msg import Layout, Measurement, Telemetry

    TEMP = Measurement("u16", "degC", polynomial=(-40.0, 0.1), yellow=(0, 50), red=(-20, 60))
    VOLTS = Measurement("u8", "V", points=((0, 0.0), (100, 20.0)))
    HK = Telemetry("THERMAL_HK_TLM", 0x08F0, Layout("Hk", [("Temp", TEMP), ("Volts", VOLTS), ("Samples", "u8")]))
    TELEMETRY = (HK,)


    def THERMAL_Main(cfe):
        samples = 0
        while cfe.es.run_loop():
            samples += 1
            cfe.sb.transmit_msg(HK.packet(Temp=600 + 120 * samples, Volts=140, Samples=samples))
            cfe.os.task_delay(500)
"""
"""32 degC at 0.55 s, and 12 degC more each half second: yellow at 1.55 s, red at 2.05 s."""


def write_thermal(folder: Path, mission_yaml: str = "") -> str:
    """Write the mission; returns the argument for `Mission`."""
    more = {"mission_yaml": mission_yaml} if mission_yaml else {}
    return write_mission(folder, STARTUP, thermal=THERMAL, **more)
