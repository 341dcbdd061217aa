"""POWER_GUARD: watches the charge of the robot's battery, and stops the robot while there is some left.

The topics /battery_percent and /safe_mode are telemetry packets with the MsgIds of mission.yaml. A ROS message of one
number has this number behind the header, so the application reads and writes it as it would read any packet.
"""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.msg import Layout, Telemetry

CHARGE = Telemetry("POWER_GUARD_CHARGE", 0x0901, Layout("Float32", [("data", "f32")]), "The charge in percent.")
SAFE_MODE = Telemetry("POWER_GUARD_SAFE_MODE", 0x0902, Layout("Bool", [("data", "u8")]), "Whether the robot stops.")
TELEMETRY = (CHARGE, SAFE_MODE)

STARTED_EID, LOW_EID = 1, 2
LEAST = 20.0  # percent


def POWER_GUARD_Main(cfe: Cfe) -> None:
    """Run the application; the startup script names this function."""
    cfe.evs.register()
    pipe = cfe.sb.create_pipe(10, "POWER_GUARD")
    cfe.sb.subscribe(CHARGE.msg_id, pipe)
    cfe.evs.send_info(STARTED_EID, f"POWER_GUARD: stops the robot below {LEAST:.0f} %")
    is_low = False
    while cfe.es.run_loop():
        packet = cfe.sb.receive_buffer(pipe)
        if packet is None:
            continue
        charge = CHARGE.read(packet)["data"]
        if charge < LEAST and not is_low:
            cfe.evs.send_info(LOW_EID, f"POWER_GUARD: {charge:.1f} % left, the robot stops")
        is_low = is_low or charge < LEAST
        cfe.sb.transmit_msg(SAFE_MODE.packet(data=int(is_low)))
    cfe.es.exit_app()
