"""Message ids of topic ids (CFE_SB_*TopicIdToMsgId): the numbers that missions assign to commands and telemetry.

A topic belongs to one processor instance, or, as instance 0, to all of them ("global"). The default mapping ORs the
topic into a base.
"""

from __future__ import annotations

PLATFORM_CMD_BASE = 0x1800
PLATFORM_TLM_BASE = 0x0800
GLOBAL_CMD_BASE = 0x1860
GLOBAL_TLM_BASE = 0x0860

_LOCAL_INSTANCE = 1


def global_cmd_topic_id_to_msg_id(topic_id: int) -> int:
    """Return the message id of a command to every processor (CFE_SB_GlobalCmdTopicIdToMsgId)."""
    return GLOBAL_CMD_BASE | topic_id


def global_tlm_topic_id_to_msg_id(topic_id: int) -> int:
    """Return the message id of telemetry that does not belong to one processor (CFE_SB_GlobalTlmTopicIdToMsgId)."""
    return GLOBAL_TLM_BASE | topic_id


def cmd_topic_id_to_msg_id(topic_id: int, instance: int) -> int:
    """Return the message id of a command to a processor; instance 0 means all (CFE_SB_CmdTopicIdToMsgId).

    NASA's function gives the telemetry id for instance 0; this one gives the command id.
    """
    return PLATFORM_CMD_BASE | topic_id if instance else global_cmd_topic_id_to_msg_id(topic_id)


def tlm_topic_id_to_msg_id(topic_id: int, instance: int) -> int:
    """Return the message id of telemetry of a processor; instance 0 means all (CFE_SB_TlmTopicIdToMsgId)."""
    return PLATFORM_TLM_BASE | topic_id if instance else global_tlm_topic_id_to_msg_id(topic_id)


def local_cmd_topic_id_to_msg_id(topic_id: int) -> int:
    """Return the message id of a command to this processor (CFE_SB_LocalCmdTopicIdToMsgId)."""
    return cmd_topic_id_to_msg_id(topic_id, _LOCAL_INSTANCE)


def local_tlm_topic_id_to_msg_id(topic_id: int) -> int:
    """Return the message id of telemetry of this processor (CFE_SB_LocalTlmTopicIdToMsgId)."""
    return tlm_topic_id_to_msg_id(topic_id, _LOCAL_INSTANCE)


def msg_id_equal(first: int, second: int) -> bool:
    """Return whether two message ids are the same (CFE_SB_MsgId_Equal)."""
    return first == second


def msg_id_to_value(msg_id: int) -> int:
    """Return the number of a message id; message ids are plain integers here (CFE_SB_MsgIdToValue)."""
    return msg_id


def value_to_msg_id(value: int) -> int:
    """Return the message id of a number (CFE_SB_ValueToMsgId)."""
    return value
