"""Names here for the public names of NASA's headers: a rule, and the exceptions from it.

CFE_SB_CreatePipe is `cfe.sb.create_pipe`: an area for the prefix, the rest in snake case. Imports nothing of cfepy.
"""

from __future__ import annotations

import re

AREAS = {
    "CFE_Config_": "cfe.config",
    "CFE_ES_": "cfe.es",
    "CFE_EVS_": "cfe.evs",
    "CFE_FS_": "cfe.fs",
    "CFE_MSG_": "cfe.msg",
    "CFE_ResourceId_": "cfepy.ids",
    "CFE_SB_": "cfe.sb",
    "CFE_SBR_": "cfe.sb.routing",
    "CFE_TBL_": "cfe.tbl",
    "CFE_TIME_": "cfe.time",
    "CFE_PSP_": "cfe.psp",
    "OS_": "cfe.os",
}
"""Where functions live, by prefix: `cfe.` is the handle that an application gets, `cfepy.` a module."""

ELSEWHERE = {
    "CFE_SB_SetUserDataLength": "cfe.msg.set_user_data_length",
    "CFE_SB_GetUserData": "cfe.msg.get_user_data",
    "CFE_SB_GetUserDataLength": "cfe.msg.get_user_data_length",
    "CFE_SB_MessageStringSet": "cfe.msg.message_string_set",
    "CFE_SB_MessageStringGet": "cfe.msg.message_string_get",
    "CFE_SB_IsValidMsgId": "cfe.msg.is_valid_msg_id",
    "CFE_SB_CmdTopicIdToMsgId": "cfe.msg.cmd_topic_id_to_msg_id",
    "CFE_SB_TlmTopicIdToMsgId": "cfe.msg.tlm_topic_id_to_msg_id",
    "CFE_SB_GlobalCmdTopicIdToMsgId": "cfe.msg.global_cmd_topic_id_to_msg_id",
    "CFE_SB_GlobalTlmTopicIdToMsgId": "cfe.msg.global_tlm_topic_id_to_msg_id",
    "CFE_SB_LocalCmdTopicIdToMsgId": "cfe.msg.local_cmd_topic_id_to_msg_id",
    "CFE_SB_LocalTlmTopicIdToMsgId": "cfe.msg.local_tlm_topic_id_to_msg_id",
    "CFE_SB_MsgId_Equal": "cfe.msg.msg_id_equal",
    "CFE_SB_MsgIdToValue": "cfe.msg.msg_id_to_value",
    "CFE_SB_ValueToMsgId": "cfe.msg.value_to_msg_id",
    "CFE_TIME_Add": "cfepy.time.add",
    "CFE_TIME_Subtract": "cfepy.time.subtract",
    "CFE_TIME_Compare": "cfepy.time.compare",
    "CFE_TIME_Sub2MicroSecs": "cfepy.time.sub2micro_secs",
    "CFE_TIME_Micro2SubSecs": "cfepy.time.micro2sub_secs",
    "CFE_TIME_Print": "cfepy.time.print_",
    "CFE_TIME_Local1HzISR": "cfe.time.local1hz_isr",
    "CFE_TIME_GetMETseconds": "cfe.time.get_met_seconds",
    "CFE_TIME_GetMETsubsecs": "cfe.time.get_met_subsecs",
    "CFE_RESOURCEID_TO_ULONG": "cfepy.ids.to_integer",
    "CFE_RESOURCEID_TEST_DEFINED": "cfepy.ids.is_defined",
    "CFE_RESOURCEID_TEST_EQUAL": "cfepy.ids.equal",
    "CFE_ES_Main": "cfepy.es.Boot.main",
    "CFE_PSP_Main": "cfe.psp.boot",
    "OS_Application_Startup": "cfe.psp.boot",
    "CFE_PSP_GetTimerLow32Rollover": "cfe.psp.get_timer_low32_rollover",
    "OS_BSP_GetArgC": "cfe.os.bsp_get_argc",
    "OS_BSP_GetArgV": "cfe.os.bsp_get_argv",
    "OS_PRINTF": "cfe.os.printf",
} | {
    f"CFE_PSP_{way.format(order=order, bits=bits)}": f"cfe.psp.{name.format(order=order.lower(), bits=bits)}"
    for order in ("BE", "LE")
    for bits in (16, 32, 64)
    for way, name in (("Hto{order}{bits}", "hto_{order}{bits}"), ("{order}{bits}toH", "{order}{bits}_to_h"))
}
"""Names that the rule does not fit, or that live with functions of another prefix."""


def snake(name: str) -> str:
    """Return a name of NASA's, without its prefix, in snake case: "GetCDSBlockIDByName" is
    "get_cds_block_id_by_name"."""
    words = re.sub(r"(?<=[A-Za-z])(?=[A-Z][a-z])|(?<=[a-z])(?=[A-Z])", "_", name)
    return re.sub("_+", "_", words).lower()


def python_name(name: str) -> str:
    """Return the Python name of a function or macro of NASA's headers."""
    prefix = max((prefix for prefix in AREAS if name.startswith(prefix)), key=len, default="")
    area = AREAS.get(prefix, "cfe")
    return ELSEWHERE.get(name) or f"{area}.{snake(name.removeprefix(prefix))}"
