"""fopen, fread, fprintf, fscanf and related functions of stdio, on files and on the standard streams.

A FILE has an address of its own. Code that reads its fields (such as an inlined getc_unlocked) finds empty buffers
there, and calls. The standard streams are handles.
"""

from __future__ import annotations

import errno
from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.api.posix_calls import PosixCalls, Slots
from cfepy.extra.c.api.posix_files import open_path
from cfepy.extra.c.api.streams import STDERR, STDIN, STDOUT, Streams
from cfepy.extra.c.arena import pages
from cfepy.extra.c.crashes import CFault
from cfepy.extra.c.posix.open_descriptors import (
    EOF,
    FULL,
    NONE,
    O_RDONLY,
    O_WRONLY,
    DescriptorTable,
    FileStream,
    StandardStream,
    flags_of,
)
from cfepy.reading.texts import to_bytes

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

FILE_BYTES = 256
"""At least sizeof(FILE), 216."""
NEW_FILE = 0o666
FIRST_LINE = 120
"""The bytes that getline allocates at first."""
SCAN = Struct("<QQQQ")
"""`Scan` of engine/natives_scanning.c: text, size, bytes used, whether the end was seen."""
POSITION = Struct("<q8x")
"""fpos_t."""
SCANS = ("fscanf", "__isoc99_fscanf", "__isoc23_fscanf", "vfscanf", "__isoc99_vfscanf", "__isoc23_vfscanf")
SCANS_STDIN = ("scanf", "__isoc99_scanf", "__isoc23_scanf", "vscanf", "__isoc99_vscanf", "__isoc23_vscanf")


class PrintedStream(FileStream):
    """stdout or stderr: bytes go to the console, which shows whole lines.

    Args:
        number: its descriptor's number.
        handle: its handle.
        streams: the console.
    """

    def __init__(self, number: int, handle: int, streams: Streams) -> None:
        super().__init__(number, StandardStream(lambda data: streams.write(handle, data)), O_WRONLY)
        self._handle = handle
        self._streams = streams

    def write(self, data: bytes) -> int:
        return self._streams.write(self._handle, data)

    def set_buffer(self, buffering: int, size: int) -> None:
        """Leave it as it is: a line is always shown when it is complete."""


class FileStreams:
    """The FILEs of a processor, by their addresses.

    Args:
        c: its C side.
    """

    def __init__(self, c: CRuntime) -> None:
        self._c = c
        self._slots = Slots(c, FILE_BYTES)
        self._table: DescriptorTable = c.descriptors
        self._open: dict[int, FileStream] = {STDIN: FileStream(0, StandardStream(), O_RDONLY)}
        for handle in (STDOUT, STDERR):
            self._open[handle] = PrintedStream(handle, handle, c.streams)
        for number, handle in enumerate((STDIN, STDOUT, STDERR)):
            self._table.add(self._open[handle].descriptor, number)
        self._scanned: dict[FileStream, tuple[bytes, int, int, int]] = {}  # input, its copy, position, record

    def of(self, handle: int) -> FileStream:
        """Return an open FILE.

        Raises:
            CFault: it is not open, so that libc would use other memory.
        """
        found = self._open.get(handle)
        if found is None:
            raise CFault(f"0x{handle:x} is not an open FILE")
        if found in self._scanned:
            self._finish_scan(found)
        return found

    def add(self, number: int, flags: int) -> int:
        """Return the address of a new FILE for a descriptor."""
        handle = self._slots.take()
        self._open[handle] = FileStream(number, self._table.of(number), flags)
        return handle

    def close(self, handle: int) -> int:
        """Close a FILE and its descriptor."""
        stream = self.of(handle)
        del self._open[handle]
        if handle not in (STDIN, STDOUT, STDERR):
            self._slots.give(handle)
        try:
            stream.sync()
        finally:
            self._table.close(stream.number)
        return 0

    def reopen(self, path: str, mode: str, handle: int) -> int:
        """Close the file of a FILE and open another one in its place (freopen). Returns the FILE.

        Raises:
            OSError: the file cannot be opened, and the FILE is closed.
        """
        if handle in (STDIN, STDOUT, STDERR):
            raise CFault("freopen() of a standard stream is not available; use fopen, and fprintf to that file")
        stream, flags = self.of(handle), flags_of(mode)
        number = stream.number
        del self._open[handle]
        try:
            stream.sync()
        except OSError:
            pass  # as in glibc, which forgets the bytes
        try:
            self._table.close(number)
            opened = open_path(self._c, "freopen", path, flags, NEW_FILE)
        except OSError:
            self._slots.give(handle)
            raise
        if opened != number:
            self._table.replace(number, opened)
            self._table.close(opened)
        self._open[handle] = FileStream(number, self._table.of(number), flags)
        return handle

    def flush_all(self) -> int:
        """Write all buffers. Returns EOF if a file does not take its bytes."""
        status = 0
        for handle in list(self._open):
            try:
                self.of(handle).flush()
            except OSError:
                status = EOF
        return status

    # -- scanning ----------------------------------------------------------------------------------------------------

    def begin_scan(self, handle: int) -> int:
        """Make the bytes of a stream ready for scanf, which the engine executes. Returns the address of a `Scan`."""
        stream, memory = self.of(handle), self._c.memory
        data, at = stream.rest()
        known = self._scanned.get(stream)
        if known is None or known[0] is not data:
            if known is not None:
                self._c.arena.unmap(known[1])
            copy = self._c.arena.map(pages(len(data) + SCAN.size))
            memory.poke(copy + SCAN.size, data)
        else:
            copy = known[1]
        memory.poke(copy, SCAN.pack(copy + SCAN.size + at, len(data) - at, 0, 0))
        self._scanned[stream] = (data, copy, at, 1)
        return copy

    def _finish_scan(self, stream: FileStream) -> None:
        """Count the bytes that the last scan used."""
        data, copy, at, is_pending = self._scanned[stream]
        if is_pending:
            _, _, used, is_ended = SCAN.unpack(self._c.memory.peek(copy, SCAN.size))
            stream.skip(used, bool(is_ended))
            self._scanned[stream] = (data, copy, at, 0)


class Stdio:
    """The functions of stdio.

    Args:
        c: the C side of the processor.
        calls: declares them.
    """

    def __init__(self, c: CRuntime, calls: PosixCalls) -> None:
        self._c = c
        self._calls = calls
        self.files: FileStreams = c.file_streams

    # -- opening and closing -----------------------------------------------------------------------------------------

    def open(self, path: str, mode: str) -> int:
        flags = flags_of(mode)
        return self.files.add(open_path(self._c, "fopen", path, flags, NEW_FILE), flags)

    def open_number(self, number: int, mode: str) -> int:
        flags = flags_of(mode)
        self._c.descriptors.of(number)
        return self.files.add(number, flags)

    def close(self, handle: int) -> int:
        self._c.kernel.preempt()
        return self.files.close(handle)

    def flush(self, handle: int) -> int:
        self._c.kernel.preempt()
        if not handle:
            return self.files.flush_all()
        self.files.of(handle).sync()
        return 0

    # -- reading -----------------------------------------------------------------------------------------------------

    def read(self, to: int, size: int, count: int, handle: int) -> int:
        self._c.kernel.preempt()
        stream = self.files.of(handle)
        if not size or not count:
            return 0
        data = stream.read(size * count)
        self._c.memory.poke(to, data)
        return len(data) // size

    def read_checked(self, to: int, room: int, size: int, count: int, handle: int) -> int:
        if size * count > room:
            raise CFault("buffer overflow detected")
        return self.read(to, size, count, handle)

    def read_one(self, handle: int) -> int:
        data = self.files.of(handle).read(1)
        return data[0] if data else EOF

    def read_line(self, to: int, size: int, handle: int) -> int:
        self._c.kernel.preempt()
        if size <= 0:
            return 0
        line = self.files.of(handle).read_line(size - 1)
        if not line and size > 1:
            return 0
        self._c.memory.poke(to, line + b"\0")
        return to

    def read_line_checked(self, to: int, room: int, size: int, handle: int) -> int:
        if size > 0 and size > room:
            raise CFault("buffer overflow detected")
        return self.read_line(to, size, handle)

    def read_allocated(self, line_at: int, size_at: int, end: int, handle: int) -> int:
        """Read a text with its end into memory of malloc (getdelim). Returns its bytes, or -1 at the end."""
        self._c.kernel.preempt()
        memory, text = self._c.memory, self.files.of(handle).read_line(1 << 30, bytes([end & 0xFF]))
        if not text:
            return EOF
        address, room = memory.u64(line_at), memory.u64(size_at)
        if not address or room < len(text) + 1:
            room = max(len(text) + 1, FIRST_LINE, 2 * room if address else 0)
            address = self._c.reallocate(address, room)
            memory.put_u64(line_at, address)
            memory.put_u64(size_at, room)
        memory.poke(address, text + b"\0")
        return len(text)

    def give_back(self, code: int, handle: int) -> int:
        return self.files.of(handle).give_back(code)

    # -- writing -----------------------------------------------------------------------------------------------------

    def write_bytes(self, handle: int, data: bytes) -> int:
        """Write to a stream. Returns the number of bytes, or EOF."""
        try:
            return self.files.of(handle).write(data)
        except OSError as error:
            self._calls.set_errno(error.errno or errno.EIO)
            return EOF

    def write(self, data: int, size: int, count: int, handle: int) -> int:
        self._c.kernel.preempt()
        if not size or not count:
            self.files.of(handle)
            return 0
        written = self.write_bytes(handle, bytes(self._c.memory.peek(data, size * count)))
        return max(written, 0) // size

    def put_text(self, text: str, handle: int) -> int:
        data = to_bytes(text)
        return self.write_bytes(handle, data) if data else 0

    def put_character(self, code: int, handle: int) -> int:
        return EOF if self.write_bytes(handle, bytes([code & 0xFF])) == EOF else code & 0xFF

    def print_to(self, handle: int, text: str) -> int:
        return self.write_bytes(handle, to_bytes(text))

    # -- positions and states ----------------------------------------------------------------------------------------

    def seek(self, handle: int, offset: int, whence: int) -> int:
        self._c.kernel.preempt()
        self.files.of(handle).seek(offset, whence)
        return 0

    def rewind(self, handle: int) -> None:
        self.seek(handle, 0, 0)
        self.files.of(handle).clear()

    def tell(self, handle: int) -> int:
        return self.files.of(handle).tell()

    def get_position(self, handle: int, at: int) -> int:
        self._c.memory.poke(at, POSITION.pack(self.tell(handle)))
        return 0

    def set_position(self, handle: int, at: int) -> int:
        return self.seek(handle, int(POSITION.unpack(self._c.memory.peek(at, POSITION.size))[0]), 0)

    def set_buffer(self, handle: int, buffer: int, mode: int, size: int) -> int:
        self.files.of(handle).set_buffer(mode, size)
        return 0

    def set_buffer_or_none(self, handle: int, buffer: int) -> None:
        self.files.of(handle).set_buffer(FULL if buffer else NONE, 0)

    def number(self, handle: int) -> int:
        return self.files.of(handle).number

    def reopen(self, path: str, mode: str, handle: int) -> int:
        return self.files.reopen(path, mode, handle)

    def scan(self, handle: int) -> int:
        self._c.kernel.preempt()
        return self.files.begin_scan(handle)


def declare(api: Declarations, c: CRuntime) -> None:
    calls = PosixCalls(api, c)
    stdio = Stdio(c, calls)
    calls.add("fopen fopen64", "$SS", stdio.open, 0)
    calls.add("freopen freopen64", "$SSp", stdio.reopen, 0)
    calls.add("fdopen", "iS", stdio.open_number, 0)
    calls.add("fclose", "$p", stdio.close)
    calls.add("fflush fflush_unlocked", "$p", stdio.flush)
    calls.add("fread fread_unlocked", "$pQQp", stdio.read, 0)
    calls.add("__fread_chk __fread_unlocked_chk", "$pQQQp", stdio.read_checked, 0)
    calls.add("fgetc getc getwc getc_unlocked fgetc_unlocked __uflow", "p", stdio.read_one)
    calls.add("getchar getchar_unlocked", "", lambda: stdio.read_one(STDIN))
    calls.add("fgets fgets_unlocked", "$pip", stdio.read_line, 0)
    calls.add("__fgets_chk __fgets_unlocked_chk", "$pQip", stdio.read_line_checked, 0)
    calls.add("getline __getline", "$PPp", lambda line, size, handle: stdio.read_allocated(line, size, 10, handle))
    calls.add("getdelim __getdelim", "$PPip", stdio.read_allocated)
    calls.add("ungetc", "ip", stdio.give_back)
    calls.add("fwrite fwrite_unlocked", "$pQQp", stdio.write, 0)
    calls.add("fputs fputs_unlocked", "Sp", stdio.put_text)
    calls.add("fputc putc fputc_unlocked putc_unlocked", "ip", stdio.put_character)
    calls.add("__overflow", "pi", lambda handle, code: stdio.put_character(code, handle))
    calls.add("fprintf", "pF", stdio.print_to)
    calls.add("__fprintf_chk", "p-F", stdio.print_to)
    calls.add("vfprintf", "pV", stdio.print_to)
    calls.add("__vfprintf_chk", "p-V", stdio.print_to)
    calls.add("fseek fseeko fseeko64", "$pqi", stdio.seek)
    calls.add("ftell ftello ftello64", "p", stdio.tell)
    calls.add("rewind", "$p", stdio.rewind)
    calls.add("fgetpos fgetpos64", "pP", stdio.get_position)
    calls.add("fsetpos fsetpos64", "$pP", stdio.set_position)
    calls.add("feof feof_unlocked", "p", lambda handle: stdio.files.of(handle).is_ended)
    calls.add("ferror ferror_unlocked", "p", lambda handle: stdio.files.of(handle).is_failed)
    calls.add("clearerr clearerr_unlocked", "p", lambda handle: stdio.files.of(handle).clear())
    calls.add("fileno fileno_unlocked", "p", stdio.number)
    calls.add("setvbuf", "ppiQ", stdio.set_buffer)
    calls.add("setbuf", "pp", stdio.set_buffer_or_none)
    calls.add(" ".join(SCANS), "$p", stdio.scan, 0)
    calls.add(" ".join(SCANS_STDIN), "", lambda: stdio.read_one(STDIN))
