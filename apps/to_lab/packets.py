"""TO_LAB's messages and its table (to_lab_msgids.h, to_lab_fcncodes.h, to_lab_msgdefs.h, to_lab_tbldefs.h)."""

from __future__ import annotations

from cfepy.msg import Command, Layout, Telemetry, local_cmd_topic_id_to_msg_id, local_tlm_topic_id_to_msg_id
from cfepy.tbl import TableType

CMD_MID = local_cmd_topic_id_to_msg_id(0x80)
SEND_HK_MID = local_cmd_topic_id_to_msg_id(0x81)
HK_TLM_MID = local_tlm_topic_id_to_msg_id(0x80)
DATA_TYPES_MID = local_tlm_topic_id_to_msg_id(0x81)

QOS = Layout("CFE_SB_Qos_t", [("Priority", "u8"), ("Reliability", "u8")])
ADD_PACKET = Layout("TO_LAB_AddPacket_Payload_t", [("Stream", "u32"), ("Flags", QOS), ("BufLimit", "u8")])
REMOVE_PACKET = Layout("TO_LAB_RemovePacket_Payload_t", [("Stream", "u32")])
ENABLE_OUTPUT = Layout("TO_LAB_EnableOutput_Payload_t", [("dest_IP", "char[16]")])

HOUSEKEEPING = Layout(
    "TO_LAB_HkTlm_Payload_t", [("CommandCounter", "u8"), ("CommandErrorCounter", "u8"), ("spareToAlign", "u8[2]")]
)
DATA_TYPES = Layout(
    "TO_LAB_DataTypes_Payload_t",
    [
        ("synch", "u16"),
        *((name, "u8") for name in ("bl1", "bl2")),
        *((name, "i8") for name in ("b1", "b2", "b3", "b4")),
        *((name, "i16") for name in ("w1", "w2")),
        *((name, "i32") for name in ("dw1", "dw2")),
        *((name, "f32") for name in ("f1", "f2")),
        *((name, "f64") for name in ("df1", "df2")),
        ("str", "char[10]"),
    ],
)
"""One field of every type, to try out a ground system with."""

NOOP = Command("TO_LAB_NOOP", CMD_MID, 0, text="Sends an event, to show that the app is alive.")
RESET_STATUS = Command("TO_LAB_RESET_STATUS", CMD_MID, 1, text="Sets the command counters to zero.")
ADD_PKT = Command("TO_LAB_ADD_PKT", CMD_MID, 2, ADD_PACKET, "Sends one more packet to the ground.")
SEND_DATA_TYPES = Command("TO_LAB_SEND_DATA_TYPES", CMD_MID, 3, text="Asks for the packet of all data types.")
REMOVE_PKT = Command("TO_LAB_REMOVE_PKT", CMD_MID, 4, REMOVE_PACKET, "Stops sending a packet to the ground.")
REMOVE_ALL_PKT = Command("TO_LAB_REMOVE_ALL_PKT", CMD_MID, 5, text="Stops sending all packets of the table.")
OUTPUT_ENABLE = Command("TO_LAB_OUTPUT_ENABLE", CMD_MID, 6, ENABLE_OUTPUT, "Starts sending to an address.")
SEND_HK = Command("TO_LAB_SEND_HK", SEND_HK_MID, text="Asks for the housekeeping packet.")
HK_TLM = Telemetry("TO_LAB_HK_TLM", HK_TLM_MID, HOUSEKEEPING, "The app's command counters.")
DATA_TYPES_TLM = Telemetry("TO_LAB_DATA_TYPES", DATA_TYPES_MID, DATA_TYPES, "A field of every data type.")

COMMANDS = (NOOP, RESET_STATUS, ADD_PKT, SEND_DATA_TYPES, REMOVE_PKT, REMOVE_ALL_PKT, OUTPUT_ENABLE, SEND_HK)
TELEMETRY = (HK_TLM, DATA_TYPES_TLM)

SUBSCRIPTION = Layout("TO_LAB_Sub_t", [("Stream", "u32"), ("Flags", QOS), ("BufLimit", "u16")])
SUBSCRIPTIONS = TableType(
    "TO_LAB.TO_LAB_Subs", SUBSCRIPTION, rows=32, file="/cf/to_lab_sub.tbl", description="TO Lab Sub Tbl"
)
TABLES = (SUBSCRIPTIONS,)
