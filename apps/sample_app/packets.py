"""SAMPLE_APP's commands, telemetry and table: ids, function codes, and layouts as the C structs have them in memory.

A message id is made from a topic id, which a mission assigns once per topic. Ground tools read `COMMANDS`,
`TELEMETRY` and `TABLES`.
"""

from __future__ import annotations

from cfepy.msg import Command, Layout, Telemetry, local_cmd_topic_id_to_msg_id, local_tlm_topic_id_to_msg_id
from cfepy.tbl import TableType

CMD_MID = local_cmd_topic_id_to_msg_id(0x82)
SEND_HK_MID = local_cmd_topic_id_to_msg_id(0x83)
HK_TLM_MID = local_tlm_topic_id_to_msg_id(0x83)

DISPLAY_PARAM_PAYLOAD = Layout(
    "SAMPLE_APP_DisplayParam_Payload_t", [("ValU32", "u32"), ("ValI16", "i16"), ("ValStr", "char[10]")]
)
HOUSEKEEPING = Layout(
    "SAMPLE_APP_HkTlm_Payload_t", [("CommandErrorCounter", "u8"), ("CommandCounter", "u8"), ("spare", "u8[2]")]
)

NOOP = Command("SAMPLE_APP_NOOP", CMD_MID, 0, text="Sends an event, to show that the app is alive.")
RESET_COUNTERS = Command("SAMPLE_APP_RESET_COUNTERS", CMD_MID, 1, text="Sets the command counters to zero.")
PROCESS = Command("SAMPLE_APP_PROCESS", CMD_MID, 2, text="Writes the table's values to the system log.")
DISPLAY_PARAM = Command(
    "SAMPLE_APP_DISPLAY_PARAM", CMD_MID, 3, DISPLAY_PARAM_PAYLOAD, "Sends an event with the values given."
)
SEND_HK = Command("SAMPLE_APP_SEND_HK", SEND_HK_MID, text="Asks for the housekeeping packet.")
HK_TLM = Telemetry("SAMPLE_APP_HK_TLM", HK_TLM_MID, HOUSEKEEPING, "The app's command counters.")

COMMANDS = (NOOP, RESET_COUNTERS, PROCESS, DISPLAY_PARAM, SEND_HK)
TELEMETRY = (HK_TLM,)

EXAMPLE_TABLE = Layout("SAMPLE_APP_ExampleTable_t", [("Int1", "u16"), ("Int2", "u16")])
INT1_MAX = 10
TABLE_OUT_OF_RANGE = -1


def find_fault(image: bytes | memoryview) -> str | None:
    """Return the fault of a table image, or None if it is valid."""
    value = EXAMPLE_TABLE.unpack(image)["Int1"]
    return f"Int1 is {value}, at most {INT1_MAX} is allowed" if value > INT1_MAX else None


TABLE = TableType(
    "SAMPLE_APP.ExampleTable",
    EXAMPLE_TABLE,
    file="/cf/sample_app_tbl.tbl",
    description="Table Utility Test Table",
    fault=find_fault,
)
TABLES = (TABLE,)
