"""SAMPLE_APP's messages and its table: ids, function codes, and layouts as the C structs have them in memory.

A message id is made of a topic id, which a mission gives out once per topic.
"""

from __future__ import annotations

from cfepy.msg import Layout, local_cmd_topic_id_to_msg_id, local_tlm_topic_id_to_msg_id

CMD_MID = local_cmd_topic_id_to_msg_id(0x82)
SEND_HK_MID = local_cmd_topic_id_to_msg_id(0x83)
HK_TLM_MID = local_tlm_topic_id_to_msg_id(0x83)

NOOP_CC = 0
RESET_COUNTERS_CC = 1
PROCESS_CC = 2
DISPLAY_PARAM_CC = 3

DISPLAY_PARAM = Layout(
    "SAMPLE_APP_DisplayParam_Payload", [("ValU32", "u32"), ("ValI16", "i16"), ("ValStr", "char[10]")]
)
HOUSEKEEPING = Layout(
    "SAMPLE_APP_HkTlm_Payload", [("CommandErrorCounter", "u8"), ("CommandCounter", "u8"), ("spare", "u8[2]")]
)

EXAMPLE_TABLE = Layout("SAMPLE_APP_ExampleTable", [("Int1", "u16"), ("Int2", "u16")])
INT1_MAX = 10
TABLE_OUT_OF_RANGE = -1
