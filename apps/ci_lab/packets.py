"""CI_LAB's messages: message ids, function codes, layouts (ci_lab_msgids.h, ci_lab_fcncodes.h, ci_lab_msgdefs.h)."""

from __future__ import annotations

from cfepy.msg import Command, Layout, Telemetry, local_cmd_topic_id_to_msg_id, local_tlm_topic_id_to_msg_id

CMD_MID = local_cmd_topic_id_to_msg_id(0x84)
SEND_HK_MID = local_cmd_topic_id_to_msg_id(0x85)
READ_UPLINK_MID = local_cmd_topic_id_to_msg_id(0x86)
HK_TLM_MID = local_tlm_topic_id_to_msg_id(0x84)

HOUSEKEEPING = Layout(
    "CI_LAB_HkTlm_Payload_t",
    [
        ("CommandCounter", "u8"),
        ("CommandErrorCounter", "u8"),
        ("EnableChecksums", "u8"),
        ("SocketConnected", "u8"),
        ("Spare1", "u8[8]"),
        ("IngestPackets", "u32"),
        ("IngestErrors", "u32"),
        ("Spare2", "u32"),
    ],
)

NOOP = Command("CI_LAB_NOOP", CMD_MID, 0, text="Sends an event, to show that the app is alive.")
RESET_COUNTERS = Command("CI_LAB_RESET_COUNTERS", CMD_MID, 1, text="Sets the command and ingest counters to zero.")
SEND_HK = Command("CI_LAB_SEND_HK", SEND_HK_MID, text="Asks for the housekeeping packet.")
READ_UPLINK = Command(
    "CI_LAB_READ_UPLINK", READ_UPLINK_MID, text="Reads the socket now. From then on, only this command reads it."
)
HK_TLM = Telemetry("CI_LAB_HK_TLM", HK_TLM_MID, HOUSEKEEPING, "Command counters, and counters of received packets.")

COMMANDS = (NOOP, RESET_COUNTERS, SEND_HK, READ_UPLINK)
TELEMETRY = (HK_TLM,)
