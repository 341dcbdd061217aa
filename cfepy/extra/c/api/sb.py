"""CFE_SB_*: the Software Bus for C, and CFE_MSG_*Action: its actions on a message at its origin and at its destination.

Functions that only read a message belong to the engine (`engine/natives_msg.c`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

from cfepy import msg
from cfepy.extra.c.api.pointers import name_into, need
from cfepy.sb import events as ev
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_MSG_BAD_ARGUMENT,
    CFE_SB_BAD_ARGUMENT,
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CfeError,
    to_signed,
)

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

BAD = CFE_SB_BAD_ARGUMENT
SIZE_FIELD = slice(4, 6)
TIMED_HEADER = 12
"""Bytes of a telemetry header up to the end of its time."""


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_pipes(api, c)
    _declare_subscriptions(api, c)
    _declare_messages(api, c)
    _declare_user_data(api, c)
    _declare_ids(api)
    _declare_actions(api, c)


def _declare_pipes(api: Declarations, c: CRuntime) -> None:
    sb, core, memory, packets = c.handle.sb, c.cfe.sb, c.memory, c.packets

    def create(out: int, depth: int, name: str | None) -> None:
        pipe_id = sb.create_pipe(depth, name, out)
        memory.put_u32(out, pipe_id)

    def delete(pipe_id: int) -> None:
        sb.delete_pipe(pipe_id)
        packets.forget_pipe(pipe_id)

    name_of = name_into(memory, sb.get_pipe_name, BAD, CFE_STATUS_EXTERNAL_RESOURCE_FAIL)

    def get_name(buffer: int, size: int, pipe_id: int) -> None:
        if not buffer or not size:
            refuse(ev.GETPIPENAME_NULL_PTR_EID, "Pipe Name Error:NullPtr")
        try:
            name_of(buffer, pipe_id, size)
        except CfeError as error:
            if error.status == CFE_STATUS_EXTERNAL_RESOURCE_FAIL:
                core.report_nameless(pipe_id)
            raise

    def get_opts(pipe_id: int, out: int) -> None:
        if not out and core.find_pipe(pipe_id) is not None:
            core.counters.pipe_opts_error += 1
            refuse(ev.GETPIPEOPTS_PTR_ERR_EID, "Pipe Opts Error:Bad Argument")
        options = sb.get_pipe_opts(pipe_id)
        memory.poke(out, bytes([options]))

    def get_id(out: int, name: str | None) -> None:
        if not out or name is None:
            core.counters.get_pipe_id_by_name_error += 1
            refuse(ev.GETPIPEIDBYNAME_NULL_ERR_EID, "Pipe ID By Name Error:Bad Argument")
        memory.put_u32(out, sb.get_pipe_id_by_name(name))

    def refuse(event_id: int, text: str) -> NoReturn:
        core.report(event_id, ev.ERROR, f"{text},Requestor {core.caller_name()}")
        raise CfeError(BAD, text)

    api.add("CFE_SB_CreatePipe", "pHs", create)
    api.add("CFE_SB_DeletePipe", "I", delete)
    api.add("CFE_SB_SetPipeOpts", "IB", sb.set_pipe_opts)
    api.add("CFE_SB_GetPipeOpts", "Ip", get_opts)
    api.add("CFE_SB_GetPipeName", "pQI", get_name)
    api.add("CFE_SB_GetPipeIdByName", "ps", get_id)
    api.add("CFE_SB_PipeId_ToIndex", "I4", sb.pipe_id_to_index, CFE_ES_BAD_ARGUMENT)


def _declare_subscriptions(api: Declarations, c: CRuntime) -> None:
    sb = c.handle.sb
    api.add("CFE_SB_Subscribe", "II", sb.subscribe)
    api.add("CFE_SB_SubscribeEx", "IIHH", sb.subscribe_ex)
    api.add("CFE_SB_SubscribeLocal", "IIH", sb.subscribe_local)
    api.add("CFE_SB_Unsubscribe", "II", sb.unsubscribe)
    api.add("CFE_SB_UnsubscribeLocal", "II", sb.unsubscribe_local)


def _declare_messages(api: Declarations, c: CRuntime) -> None:
    sb, core, packets, memory, time = c.handle.sb, c.cfe.sb, c.packets, c.memory, c.handle.time

    def release(buffer: int) -> None:
        need(BAD, buffer)
        packets.release(buffer)

    def no_message(*_: int) -> None:
        core.send_error(ev.SEND_BAD_ARG_EID, BAD, f"Send Err:Bad input argument,Arg 0x0,App {core.caller_name()}")

    def no_buffer(_: int, pipe_id: int, timeout: int) -> None:
        core.counters.msg_receive_error += 1
        text = f"Rcv Err:Bad Input Arg:BufPtr 0x0,pipe [n/a],t/o {to_signed(timeout)},app {core.caller_name()}"
        core.report_once(ev.RCV_BAD_ARG_EID, ev.ERROR, text)

    def transmit_buffer(buffer: int, is_origination: bool) -> None:
        packets.transmit(buffer, is_origination)

    def time_stamp(message: int) -> None:
        if message:
            header = bytearray(memory.peek(message, TIMED_HEADER))
            msg.set_msg_time(header, time.get_time())
            memory.poke(message, header)

    api.add("CFE_SB_TransmitMsg", "mb", sb.transmit_msg, BAD, no_message)
    api.add("CFE_SB_ReceiveBuffer", "$@~8Ii", sb.receive_buffer, BAD, no_buffer)
    api.add("CFE_SB_AllocateMessageBuffer", "Q", packets.allocate)
    api.add("CFE_SB_ReleaseMessageBuffer", "p", release)
    api.add("CFE_SB_TransmitBuffer", "Pb", transmit_buffer, BAD, no_message)
    api.add("CFE_SB_TimeStampMsg", "p", time_stamp)


def _declare_user_data(api: Declarations, c: CRuntime) -> None:
    """Add the cases that the engine leaves to Python: lines in the system log."""
    log = c.handle.es.write_to_sys_log

    def no_user_data(message: int) -> int:
        log("CFE_SB_GetUserData: Failed invalid arguments")
        return 0

    def bad_length(message: int, length: int) -> None:
        what = "TotalMsgSize too large" if message else "invalid arguments"
        log(f"CFE_SB_SetUserDataLength: Failed {what}")

    api.add("CFE_SB_GetUserData", "p", no_user_data)
    api.add("CFE_SB_SetUserDataLength", "pQ", bad_length)


def _declare_ids(api: Declarations) -> None:
    """Add functions for message ids of topics. As in NASA's code, a command to instance 0 has the id of telemetry."""

    def command(topic: int, instance: int) -> int:
        return msg.cmd_topic_id_to_msg_id(topic, instance) if instance else msg.global_tlm_topic_id_to_msg_id(topic)

    api.add("CFE_SB_CmdTopicIdToMsgId", "HH", command)
    api.add("CFE_SB_TlmTopicIdToMsgId", "HH", msg.tlm_topic_id_to_msg_id)
    api.add("CFE_SB_GlobalCmdTopicIdToMsgId", "H", msg.global_cmd_topic_id_to_msg_id)
    api.add("CFE_SB_GlobalTlmTopicIdToMsgId", "H", msg.global_tlm_topic_id_to_msg_id)
    api.add("CFE_SB_LocalCmdTopicIdToMsgId", "H", msg.local_cmd_topic_id_to_msg_id)
    api.add("CFE_SB_LocalTlmTopicIdToMsgId", "H", msg.local_tlm_topic_id_to_msg_id)


def _declare_actions(api: Declarations, c: CRuntime) -> None:
    memory, stamp = c.memory, c.handle.time.stamp

    def originate(message: int, _: int, is_acceptable: int) -> None:
        size = int.from_bytes(memory.peek(message, msg.PRIMARY_HEADER_SIZE)[SIZE_FIELD], "big") + 7
        packet = bytearray(memory.peek(message, size))
        msg.origination_action(packet, stamp())
        memory.poke(message, packet)
        memory.poke(is_acceptable, b"\1")

    def verify(message: int, _: int, is_acceptable: int) -> None:
        memory.poke(is_acceptable, b"\1")

    api.add("CFE_MSG_OriginationAction", "PQP", originate, CFE_MSG_BAD_ARGUMENT)
    api.add("CFE_MSG_VerificationAction", "PQP", verify, CFE_MSG_BAD_ARGUMENT)
