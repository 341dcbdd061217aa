"""Calls of message headers, File Services and resource ids in a script; app/api_msg.c has them in C."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy import ids, msg
from cfepy.fs.background import FileWriteMetaData
from cfepy.status import CfeError
from dev.twin.api.words import Answer, Line


class MsgCalls:
    """The calls. `play` is the player, `w` the arguments."""

    def __init__(self, play: Any) -> None:
        self.cfe, self.fs, self.stamp = play.cfe, play.cfe.fs, None

    def __getattr__(self, name: str) -> Callable[[Line], Answer]:
        """Getters and setters of one field."""
        for kind in ("Get", "Set"):
            if name.startswith(f"MSG_{kind}"):
                call = getattr(msg, FIELDS[name[7:]].format(kind.lower()))
                return _getter(call) if kind == "Get" else _setter(call)
        raise AttributeError(name)

    def MSG_ValidateChecksum(self, w: Line) -> Answer:
        return 0, msg.validate_checksum(w.data(1))

    def MSG_GenerateChecksum(self, w: Line) -> Answer:
        return _set(w, msg.generate_checksum)

    def MSG_Init(self, w: Line) -> Answer:
        return 0, msg.init(w.num(1), w.num(2))

    def MSG_GetMsgTime(self, w: Line) -> Answer:
        return 0, *msg.get_msg_time(w.data(1))

    def MSG_SetMsgTime(self, w: Line) -> Answer:
        return _set(w, msg.set_msg_time, (w.num(2), w.num(3)))

    def MSG_GetTypeFromMsgId(self, w: Line) -> Answer:
        return 0, msg.get_type_from_msg_id(w.num(1))

    def MSG_GetNextSequenceCount(self, w: Line) -> Answer:
        return 0, msg.get_next_sequence_count(w.num(1))

    def SB_SetUserDataLength(self, w: Line) -> Answer:
        packet = bytearray(w.data(1))
        try:
            msg.set_user_data_length(packet, w.num(2))
        except CfeError:
            pass  # a function without a status in C
        return 0, packet

    def SB_GetUserDataLength(self, w: Line) -> Answer:
        return 0, msg.get_user_data_length(w.data(1))

    def SB_IsValidMsgId(self, w: Line) -> Answer:
        return 0, msg.is_valid_msg_id(w.num(1))

    def SB_CmdTopicIdToMsgId(self, w: Line) -> Answer:
        return 0, msg.cmd_topic_id_to_msg_id(w.num(1), w.num(2))

    def SB_TlmTopicIdToMsgId(self, w: Line) -> Answer:
        return 0, msg.tlm_topic_id_to_msg_id(w.num(1), w.num(2))

    def SB_GlobalCmdTopicIdToMsgId(self, w: Line) -> Answer:
        return 0, msg.global_cmd_topic_id_to_msg_id(w.num(1))

    def SB_LocalTlmTopicIdToMsgId(self, w: Line) -> Answer:
        return 0, msg.local_tlm_topic_id_to_msg_id(w.num(1))

    def SB_MessageStringGet(self, w: Line) -> Answer:
        text = msg.message_string_get(w.data(1), w.num(2), w.text(3) if len(w) > 2 else None)
        return len(text.encode("utf-8", "surrogateescape")), text

    def SB_MessageStringSet(self, w: Line) -> Answer:
        field = msg.message_string_set(w.text(1), w.num(2))
        return min(len(w.text(1)), w.num(2)), field

    def FS_Header(self, w: Line) -> Answer:
        return (self.fs.write_header(w.num(1), self.fs.init_header(w.text(2), w.num(3))),)

    def FS_ReadHeader(self, w: Line) -> Answer:
        found = self.fs.read_header(w.num(1))
        numbers = found.spacecraft_id, found.processor_id, found.application_id
        return 64, found.content_type, found.subtype, found.length, *numbers, found.description

    def FS_SetTimestamp(self, w: Line) -> Answer:
        self.fs.set_timestamp(w.num(1), (w.num(2), w.num(3)))
        return (0,)

    def FS_ParseInputFileName(self, w: Line) -> Answer:
        return 0, self.fs.parse_input_file_name(w.text(1), w.num(2), w.num(3))

    def FS_ParseInputFileNameEx(self, w: Line) -> Answer:
        return 0, self.fs.parse_input_file_name_ex(w.text(1), w.text(2), w.text(3), w.text(4), w.num(5))

    def FS_ExtractFilenameFromPath(self, w: Line) -> Answer:
        return 0, self.fs.extract_filename_from_path(w.text(1))

    def FS_Defaults(self, w: Line) -> Answer:
        return 0, self.fs.get_default_mount_point(w.num(1)) or "-", self.fs.get_default_extension(w.num(1)) or "-"

    def FS_BackgroundFileDump(self, w: Line) -> Answer:
        came = [0] * 8

        def count(event: int, *more: object) -> None:
            came[event % 8] += 1

        def record(number: int) -> tuple[bytes, bool]:
            return (b"0123456789" if number < 3 else b""), number >= 3

        meta = FileWriteMetaData(w.text(1), w.num(2), "twin", record, count)
        self.fs.background_file_dump_request(meta)
        self.cfe.os.task_delay(200)
        return 0, meta.is_pending, *came

    def ResourceId(self, w: Line) -> Answer:
        number = w.num(1)
        try:
            index, status = ids.to_index(number, w.num(2), w.num(3)), 0
        except CfeError as error:
            index, status = 0, error.status
        return ids.is_defined(number), ids.get_base(number), ids.get_serial(number), status, index


FIELDS = {
    "Size": "{}_size",
    "Type": "{}_type",
    "HeaderVersion": "{}_header_version",
    "HasSecondaryHeader": "{}_has_secondary_header",
    "ApId": "{}_ap_id",
    "SegmentationFlag": "{}_segmentation_flag",
    "SequenceCount": "{}_sequence_count",
    "FcnCode": "{}_fcn_code",
    "MsgId": "{}_msg_id",
}


def _getter(call: Callable[[bytes], object]) -> Callable[[Line], Answer]:
    return lambda w: (0, call(w.data(1)))


def _setter(call: Callable[..., object]) -> Callable[[Line], Answer]:
    return lambda w: _set(w, call, w.num(2))


def _set(w: Line, call: Callable[..., object], *values: object) -> Answer:
    packet = bytearray(w.data(1))
    call(packet, *values)
    return 0, packet
