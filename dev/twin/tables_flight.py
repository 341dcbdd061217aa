"""A flight of tables in cfepy: the twins of tables_app.c, and the compared parts of an answer.

An answer is a list of texts: the status of a call, and the resulting events and packets of Table Services.
Times, addresses and handles are left out. Of a dumped file, bytes that NASA's cFE never sets are left out.
"""

from __future__ import annotations

import re
import struct
import tempfile
from pathlib import Path
from typing import Any

from cfepy.es import packets as es
from cfepy.evs import packets as evs
from cfepy.mission import Mission, PacketWatch, Seen
from cfepy.msg import command
from cfepy.status import CfeError
from cfepy.tbl import packets as pk
from cfepy.writing.console import Console
from dev.twin.tables_steps import CALL, CLOSE, COMMAND, READ, REGISTRY, REMOVE, RESET, RESTART, WRITE, Step

Answer = list[str]
REQUEST = struct.Struct("<cBHII128s")
REPLY_MID = 0x08E1
WATCHED = (evs.LONG_EVENT_MSG_MID, pk.HK_TLM_MID, pk.REG_TLM_MID, REPLY_MID)
REGISTRY_FILE = "/ram/cfe_tbl_reg.log"
LISTENED_TO = ("CFE_TBL", "TTA", "CFE_ES")
"""Whose DEBUG events are switched on."""
STARTUP = """\
CFE_APP, tt, TTT_Main, TTT, 120, 16384, 0x0, 0;
CFE_APP, tta, TTA_Main, TTA, 100, 16384, 0x0, 0;
CFE_APP, ttb, TTB_Main, TTB, 110, 16384, 0x0, 0;
!
"""
LISTENER = """
def TTT_Main(cfe):
    cfe.evs.register()
    while cfe.es.run_loop():
        cfe.os.task_delay(50)
"""
CALLER = """
import struct

from cfepy.status import CFE_SUCCESS, CFE_TBL_INFO_UPDATED, CfeError


def judge(image):
    return {0xEE: -5, 0xDD: 7}.get(image[0], 0)


class Caller:
    def __init__(self, cfe, who):
        self.cfe, self.tbl = cfe, cfe.tbl
        self.handles, self.sizes = [-1] * 16, [0] * 16
        self.memory = bytearray(16384), bytearray(16384)
        cfe.evs.register()
        self.notices = cfe.sb.create_pipe(50, f"N{who}")
        cfe.sb.subscribe_ex(0x18F1 if who == "A" else 0x18F2, self.notices, msg_limit=50)
        self.requests = cfe.sb.create_pipe(50, f"Q{who}")
        cfe.sb.subscribe(0x18E1 if who == "A" else 0x18E2, self.requests)

    def run(self):
        while self.cfe.es.run_loop():
            packet = self.cfe.sb.receive_buffer(self.requests, 100)
            if packet is not None:
                self.answer(*struct.unpack_from("<cBHII128s", bytes(packet), 8))

    def answer(self, letter, slot, options, number, other, text):
        data = b""
        try:
            status, data = self.do(letter.decode(), slot % 16, options, number, other, text.rstrip(b"\\0").decode())
        except CfeError as error:
            status = error.status
        packet = self.cfe.msg.init(0x08E1, 20 + len(data))
        packet[16:] = struct.pack("<i", status) + data
        self.cfe.sb.transmit_msg(packet)

    def do(self, letter, slot, options, number, other, text):
        tbl, handle, size = self.tbl, self.handles[slot], self.sizes[slot]
        simple = {
            "P": tbl.update, "E": tbl.release_address, "V": tbl.validate, "M": tbl.manage, "T": tbl.get_status,
            "B": tbl.dump_to_buffer,
        }
        if letter in simple:
            return simple[letter](handle), b""
        if letter == "R":
            self.handles[slot], self.sizes[slot] = -1, number
            self.handles[slot] = tbl.register(text, number, options, judge if other else None)
            return self.handles[slot].status, b""
        if letter == "S":
            self.handles[slot], self.sizes[slot] = -1, 4
            self.handles[slot] = tbl.share(text)
        elif letter == "U":
            tbl.unregister(handle)
        elif letter == "F":
            return tbl.load(handle, text), b""
        elif letter == "A":
            self.memory[slot & 1][:] = bytes([number]) * 16384
            return tbl.load(handle, self.memory[slot & 1]), b""
        elif letter == "G":
            view, updated = tbl.get_address(handle)
            return CFE_TBL_INFO_UPDATED if updated else CFE_SUCCESS, bytes(view[:size])
        elif letter == "I":
            return CFE_SUCCESS, self.info(tbl.get_info(text))
        elif letter == "O":
            view, _ = tbl.get_address(handle)
            view[: min(4, size)] = bytes([number]) * min(4, size)
            tbl.modified(handle)
            tbl.release_address(handle)
        elif letter == "N":
            tbl.notify_by_message(handle, number, options, other)
        elif letter == "Q":
            return CFE_SUCCESS, b"".join(struct.pack(">H", len(each)) + each for each in self.notifications())
        return CFE_SUCCESS, b""

    def notifications(self):
        while (packet := self.cfe.sb.receive_buffer(self.notices, 0)) is not None:
            yield bytes(packet)

    def info(self, info):
        numbers = info.table_loaded_once, info.dump_only, info.double_buffered, info.user_def_addr, info.critical
        time = int(info.time_of_last_update[0] != 0)
        head = f"{info.size} {info.num_users} {info.file_time[0]}.{info.file_time[1]} {info.crc} {time}"
        return f"{head} {' '.join(str(int(each)) for each in numbers)} {info.last_file_loaded}".encode()


def TTA_Main(cfe):
    Caller(cfe, "A").run()


def TTB_Main(cfe):
    Caller(cfe, "B").run()
"""


def fly(cfe_version: str, steps: list[Step]) -> list[Answer]:
    """Return cfepy's answers to the steps of a flight."""
    with tempfile.TemporaryDirectory() as folder:
        sources = {"tt.py": LISTENER, "tta.py": CALLER, "ttb.py": CALLER, "startup.scr": STARTUP}
        mission_file = f'cfe_version: "{cfe_version}"\nlimits: {{evs_max_app_event_burst: 0}}\n'
        for name, text in {**sources, "mission.yaml": mission_file}.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        seen: list[Seen] = []
        watch = PacketWatch(seen.append, lambda msg_id: msg_id in WATCHED)
        with Mission(folder, console=Console(quiet=True), attachments=[watch]) as mission:
            flight = _Flight(mission, seen)
            return [flight.answer(step) for step in steps]


class _Flight:
    def __init__(self, mission: Mission, seen: list[Seen]) -> None:
        self._mission = mission
        self._seen = seen
        mission.run_for(2)
        self._listen()

    def _listen(self) -> None:
        for name in LISTENED_TO:
            self._send(evs.ENABLE_APP_EVENT_TYPE.packet(AppName=name, BitMask=1))

    def _send(self, packet: bytes | bytearray, seconds: float = 0.02) -> list[bytes]:
        self._seen.clear()
        self._mission.cfe.sb.transmit_msg(bytes(packet), is_origination=False)
        self._mission.run_for(seconds)
        return [each.packet for each in self._seen]

    def answer(self, step: Step) -> Answer:
        kind, *given = step
        if kind == COMMAND:
            return packets_of(self._send(bytes.fromhex(given[0])))
        if kind == CALL:
            return self._call(*given)
        if kind == REGISTRY:
            told = self._send(pk.DUMP_REGISTRY.packet(), 6)
            return [*packets_of(told), *registry_of(self._file(REGISTRY_FILE))]
        if kind == RESTART:
            return packets_of(self._send(es.RESTART_APP.packet(Application="TTA"), 8))
        if kind == RESET:
            self._send(es.RESTART.packet(RestartType=1), 4)
            self._listen()
        elif kind == CLOSE:
            self._mission.cfe.os.close_all_files()
        elif kind == READ:
            return [dump_of(self._file(given[0]))]
        elif kind == REMOVE:
            self._remove(given[0])
        elif kind == WRITE:
            self._mission.files.write_file(given[0], bytes.fromhex(given[1]))
        return []

    def _call(self, who: str, letter: str, *given: Any) -> Answer:
        slot, options, number, other, text = given
        request = REQUEST.pack(letter.encode(), slot, options, number, other, text.encode())
        packets = self._send(command(0x18E1 if who == "A" else 0x18E2, 0, request))
        (reply,) = (packet for packet in packets if _msg_id(packet) == REPLY_MID)
        status, data = struct.unpack_from("<I", reply, 16)[0], reply[20:]
        return [*result_of(letter, status, data), *packets_of(packets)]

    def _file(self, path: str) -> bytes:
        try:
            return self._mission.files.read_file(path)
        except CfeError:
            return b""

    def _remove(self, path: str) -> None:
        try:
            self._mission.files.remove(path)
        except CfeError:
            pass  # it was never written


# -- compared parts ----------------------------------------------------------------------------------------------------


def _msg_id(packet: bytes) -> int:
    return packet[0] << 8 | packet[1]


def packets_of(packets: list[bytes]) -> Answer:
    """Return the events and packets of Table Services."""
    return [text for text in map(_packet, packets) if text]


def _packet(packet: bytes) -> str:
    msg_id = _msg_id(packet)
    if msg_id == evs.LONG_EVENT_MSG_MID:
        event = evs.LONG_EVENT.unpack(packet[16:])
        source = event["PacketID"]
        if source["AppName"] != "CFE_TBL":
            return ""
        return f"{source['EventID']}/{source['EventType']} {_without_address(event['Message'])}"
    if msg_id == pk.HK_TLM_MID:
        fields = pk.HOUSEKEEPING.unpack(packet[16:])
        for name in ("MemPoolHandle", "CommandErrorCounter", "ByteAlignPad1"):
            del fields[name]
    elif msg_id == pk.REG_TLM_MID:
        fields = pk.REGISTRY_PACKET.unpack(packet[16:])
    else:
        return ""
    return _fields(fields)


def _fields(fields: dict[str, Any]) -> str:
    """Return all fields as text. Times and addresses only show whether they are zero."""
    shown = {}
    for name, value in fields.items():
        if isinstance(value, dict):
            shown[name] = value["Seconds"] != 0
        elif name.endswith(("Addr", "Ptr")):
            shown[name] = value != 0
        else:
            shown[name] = _without_address(value) if isinstance(value, str) else value
    return " ".join(f"{name}={value}" for name, value in shown.items())


def _without_address(text: str) -> str:
    return re.sub("Addr 0x[0-9A-F]+", "Addr", text)


def result_of(letter: str, status: int, data: bytes) -> Answer:
    """Status and data of a call."""
    if letter == "I":
        text = re.sub(r"^(\d+ \d+) (\d+)\.\d+", lambda found: f"{found[1]} {found[2] != '0'}", data.decode())
        return [f"{status:08X}", _without_address(text)]
    if letter != "Q":
        return [f"{status:08X}", data.hex()]
    notices = []
    while data:
        size = int.from_bytes(data[:2], "big")
        notices.append(f"{size} {data[2:4].hex()} {data[8 : 2 + size].hex()}")  # without sequence count
        data = data[2 + size :]
    return [f"{status:08X}", *notices]


def dump_of(file: bytes) -> str:
    """Return a dumped table without its time, its application, and the header bytes that NASA's cFE never sets."""
    return (file[:16] + file[32:64] + file[72:115] + file[116:]).hex()


def registry_of(file: bytes) -> Answer:
    """Return the records of a registry dump."""
    size = pk.REGISTRY_RECORD.size
    return [_fields(pk.REGISTRY_RECORD.unpack(file, at)) for at in range(64, len(file) - size + 1, size)]
