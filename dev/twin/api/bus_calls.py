"""Calls of Event Services, Software Bus, Table Services and Time Services in a script; app/api_bus.c has them in C."""

from __future__ import annotations

from typing import Any

from cfepy import time as cfe_time
from cfepy.status import CFE_SB_NO_MESSAGE, CFE_SB_TIME_OUT, CFE_TBL_INFO_UPDATED, CfeError
from dev.twin.api.words import Answer, Line


def _time(w: Line, word: int) -> tuple[int, int]:
    return w.num(word), w.num(word + 1)


def _judge(data: bytes) -> int:
    return {0xEE: -1, 0xDD: 5}.get(data[0], 0)


class BusCalls:
    """The calls. `play` is the player, `w` the arguments."""

    def __init__(self, play: Any) -> None:
        cfe = play.cfe
        self.cfe, self.evs, self.sb, self.tbl, self.time = cfe, cfe.evs, cfe.sb, cfe.tbl, cfe.time
        self.buffers: dict[int, Any] = {}
        self.image = bytearray(40000)  # one for all tables, as in C
        self.synchs = [0, 0]
        self.synch = [lambda: self._count(0), lambda: self._count(1)]

    def _count(self, which: int) -> None:
        self.synchs[which] += 1

    def EVS_Register(self, w: Line) -> Answer:
        self.evs.register([(w.num(at), w.num(at + 1)) for at in range(2, len(w), 2)], w.num(1))
        return (0,)

    def EVS_SendEvent(self, w: Line) -> Answer:
        return (self.evs.send_event(w.num(1), w.num(2), "%s", w.text(3)),)

    def EVS_SendEventWithAppID(self, w: Line) -> Answer:
        return (self.evs.send_event_with_app_id(w.num(1), w.num(2), w.num(3), "%s", w.text(4)),)

    def EVS_SendTimedEvent(self, w: Line) -> Answer:
        return (self.evs.send_timed_event(_time(w, 1), w.num(3), w.num(4), "%s", w.text(5)),)

    def EVS_ResetFilter(self, w: Line) -> Answer:
        self.evs.reset_filter(w.num(1))
        return (0,)

    def EVS_ResetAllFilters(self, w: Line) -> Answer:
        self.evs.reset_all_filters()
        return (0,)

    def SB_CreatePipe(self, w: Line) -> Answer:
        return 0, w.keep(1, self.sb.create_pipe(w.num(2), w.text(3)))

    def SB_DeletePipe(self, w: Line) -> Answer:
        self.sb.delete_pipe(w.num(1))
        return (0,)

    def SB_PipeId_ToIndex(self, w: Line) -> Answer:
        return 0, self.sb.pipe_id_to_index(w.num(1))

    def SB_SetPipeOpts(self, w: Line) -> Answer:
        self.sb.set_pipe_opts(w.num(1), w.num(2))
        return (0,)

    def SB_GetPipeOpts(self, w: Line) -> Answer:
        return 0, self.sb.get_pipe_opts(w.num(1))

    def SB_GetPipeName(self, w: Line) -> Answer:
        return 0, self.sb.get_pipe_name(w.num(1))

    def SB_GetPipeIdByName(self, w: Line) -> Answer:
        return 0, w.keep(1, self.sb.get_pipe_id_by_name(w.text(2)))

    def SB_Subscribe(self, w: Line) -> Answer:
        self.sb.subscribe(w.num(1), w.num(2))
        return (0,)

    def SB_SubscribeEx(self, w: Line) -> Answer:
        self.sb.subscribe_ex(w.num(1), w.num(2), w.num(3) | w.num(4) << 8, w.num(5))
        return (0,)

    def SB_SubscribeLocal(self, w: Line) -> Answer:
        self.sb.subscribe_local(w.num(1), w.num(2), w.num(3))
        return (0,)

    def SB_Unsubscribe(self, w: Line) -> Answer:
        self.sb.unsubscribe(w.num(1), w.num(2))
        return (0,)

    def SB_UnsubscribeLocal(self, w: Line) -> Answer:
        self.sb.unsubscribe_local(w.num(1), w.num(2))
        return (0,)

    def SB_TransmitMsg(self, w: Line) -> Answer:
        self.sb.transmit_msg(w.data(1), bool(w.num(2)))
        return (0,)

    def SB_ReceiveBuffer(self, w: Line) -> Answer:
        found = self.sb.receive_buffer(w.num(1), w.num(2))
        if found is None:
            return (CFE_SB_TIME_OUT if w.num(2) else CFE_SB_NO_MESSAGE,)
        return 0, found

    def SB_AllocateMessageBuffer(self, w: Line) -> Answer:
        self.buffers[w.num(1)] = None
        try:
            self.buffers[w.num(1)] = self.sb.allocate_message_buffer(w.num(2))
        except CfeError:
            return (-1,)
        return (0,)

    def SB_TransmitBuffer(self, w: Line) -> Answer:
        buffer = self.buffers.get(w.num(1))
        if buffer is None:
            return (0,)
        data = w.data(2)
        buffer[:] = data
        self.sb.transmit_buffer(buffer, bool(w.num(3)))
        self.buffers[w.num(1)] = None
        return (0,)

    def SB_ReleaseMessageBuffer(self, w: Line) -> Answer:
        buffer = self.buffers.get(w.num(1))
        self.buffers[w.num(1)] = None
        if buffer is not None:
            self.sb.release_message_buffer(buffer)
        return (0,)

    def TBL_Register(self, w: Line) -> Answer:
        handle = self.tbl.register(w.text(2), w.num(3), w.num(4), _judge if w.num(5) else None)
        return handle.status, w.keep(1, handle)

    def TBL_Share(self, w: Line) -> Answer:
        return 0, w.keep(1, self.tbl.share(w.text(2)))

    def TBL_Unregister(self, w: Line) -> Answer:
        self.tbl.unregister(w.num(1))
        return (0,)

    def TBL_Update(self, w: Line) -> Answer:
        return (self.tbl.update(w.num(1)),)

    def TBL_Validate(self, w: Line) -> Answer:
        return (self.tbl.validate(w.num(1)),)

    def TBL_Manage(self, w: Line) -> Answer:
        return (self.tbl.manage(w.num(1)),)

    def TBL_DumpToBuffer(self, w: Line) -> Answer:
        return (self.tbl.dump_to_buffer(w.num(1)),)

    def TBL_Modified(self, w: Line) -> Answer:
        self.tbl.modified(w.num(1))
        return (0,)

    def TBL_ReleaseAddress(self, w: Line) -> Answer:
        return (self.tbl.release_address(w.num(1)),)

    def TBL_GetStatus(self, w: Line) -> Answer:
        return (self.tbl.get_status(w.num(1)),)

    def TBL_LoadFile(self, w: Line) -> Answer:
        return (self.tbl.load(w.num(1), w.text(2)),)

    def TBL_LoadAddress(self, w: Line) -> Answer:
        self.image[:] = w.data(2).ljust(len(self.image), b"\0")
        return (self.tbl.load(w.num(1), self.image),)

    def TBL_GetAddress(self, w: Line) -> Answer:
        data, is_updated = self.tbl.get_address(w.num(1))
        return CFE_TBL_INFO_UPDATED if is_updated else 0, data[: w.num(2)]

    def TBL_GetAddresses(self, w: Line) -> Answer:
        found = self.tbl.get_addresses([w.num(1), w.num(2)])
        return (CFE_TBL_INFO_UPDATED if any(is_updated for _, is_updated in found) else 0,)

    def TBL_ReleaseAddresses(self, w: Line) -> Answer:
        return (self.tbl.release_addresses([w.num(1), w.num(2)]),)

    def TBL_GetInfo(self, w: Line) -> Answer:
        info = self.tbl.get_info(w.text(1))
        flags = info.table_loaded_once, info.dump_only, info.double_buffered, info.user_def_addr, info.critical
        name = () if info.last_file_loaded.startswith("Addr") else (info.last_file_loaded,)
        return 0, info.size, info.num_users, info.file_time[0], info.crc, *flags, *name

    def TBL_NotifyByMessage(self, w: Line) -> Answer:
        self.tbl.notify_by_message(w.num(1), w.num(2), w.num(3), w.num(4))
        return (0,)

    def TIME_Add(self, w: Line) -> Answer:
        return 0, *cfe_time.add(_time(w, 1), _time(w, 3))

    def TIME_Subtract(self, w: Line) -> Answer:
        return 0, *cfe_time.subtract(_time(w, 1), _time(w, 3))

    def TIME_Compare(self, w: Line) -> Answer:
        return 0, cfe_time.compare(_time(w, 1), _time(w, 3))

    def TIME_MET2SCTime(self, w: Line) -> Answer:
        return 0, *self.time.met2sc_time(_time(w, 1))

    def TIME_Sub2MicroSecs(self, w: Line) -> Answer:
        return 0, cfe_time.sub2micro_secs(w.num(1))

    def TIME_Micro2SubSecs(self, w: Line) -> Answer:
        return 0, cfe_time.micro2sub_secs(w.num(1))

    def TIME_Print(self, w: Line) -> Answer:
        return 0, cfe_time.print_(_time(w, 1))

    def TIME_Settings(self, w: Line) -> Answer:
        time = self.time
        tai, utc, met = time.get_tai(), time.get_utc(), time.get_met()
        return (
            0,
            *time.get_stcf(),
            time.get_leap_seconds(),
            time.get_clock_state(),
            time.get_clock_info(),
            (tai[0] + 2 - utc[0] - time.get_leap_seconds()) & 0xFFFFFFFF < 4,
            time.get_met_seconds() - met[0] < 2,
            time.compare(time.get_time(), utc) != -1,
        )

    def TIME_RegisterSynchCallback(self, w: Line) -> Answer:
        self.time.register_synch_callback(self.synch[w.num(1)])
        return (0,)

    def TIME_UnregisterSynchCallback(self, w: Line) -> Answer:
        self.time.unregister_synch_callback(self.synch[w.num(1)])
        return (0,)

    def TIME_SynchCallbacksCame(self, w: Line) -> Answer:
        before = list(self.synchs)
        self.cfe.os.task_delay(2500)
        return 0, self.synchs[0] > before[0], self.synchs[1] > before[1]

    def TIME_ExternalTone(self, w: Line) -> Answer:
        self.time.external_tone()
        return (0,)
