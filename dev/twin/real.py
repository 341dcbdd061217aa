"""Boot NASA's cFE: its Linux executable, in a private copy of its folder and in its own namespaces.

Message queues, shared memory, the RAM disk, UDP ports and process ids are private. So many can run at once, and
nothing remains after the end. A processor reset ends NASA's process; it is restarted with its retained memory.
"""

from __future__ import annotations

import ctypes
import os
import re
import select
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType

from cfepy.config.versions import RELEASES

VARIABLE = "CFEPY_REAL_CFE"
EXECUTABLE = "core-cpu1"
CI_PORT, TO_PORT = 1234, 1235
RAM_DISK = "dev/shm/osal:RAM"
OPERATIONAL = b"entering OPERATIONAL state"
CLONE_NEWNET = 0x40000000
BOOT_LIMIT_S = 60.0
NOT_LONGER_THAN_US = ("setpriv", "--pdeathsig", "KILL")  # also if the context is never left
NAMESPACES = ("unshare", "--ipc", "--net", "--mount", "--pid", "--fork", "--kill-child", "--mount-proc")
FURNISH = """
mount -t tmpfs none /dev/shm
mount -t mqueue none /dev/mqueue
echo 1000 > /proc/sys/fs/mqueue/msg_max
echo 10000 > /proc/sys/fs/mqueue/msgsize_max
ip link set lo up
ulimit -q unlimited
"""
FOREVER = FURNISH + 'while true; do "$@"; echo "process ended with $?"; done\n'


def installed(variable: str = VARIABLE) -> Path | None:
    """Return the folder of NASA's executable from an environment variable.

    Raises:
        FileNotFoundError: the variable is set, but the executable does not exist.
    """
    folder = os.environ.get(variable)
    if not folder:
        return None
    if not (Path(folder) / EXECUTABLE).exists():
        raise FileNotFoundError(f"{variable}: no {EXECUTABLE} in {folder}")
    return Path(folder)


def release_of(built: Path) -> str:
    """Return which release of cFE an executable is, such as "7.0.0": the newest of those that it names.

    Its OSAL and PSP may be older, and are in it too.

    Raises:
        ValueError: it names no release that cfepy knows.
    """
    data = (built / EXECUTABLE).read_bytes()
    named = [release for release in RELEASES if f"v{release}".encode() in data]
    if not named:
        raise ValueError(f"{built / EXECUTABLE} names no release of {', '.join(RELEASES)}")
    return max(named, key=lambda release: RELEASES[release].cfe)


def one_cpu() -> int:
    """Return the only host processor that a cFE gets, so that its applications start in the order of their priorities.

    With several processors, the first subscriber is random, and so are the ids of pipes.
    """
    return min(os.sched_getaffinity(0))


class RealCfe:
    """A running cFE of NASA's, as a context manager. Needs Linux and root rights for the namespaces.

    Args:
        built: the folder of the executable and of its `cf`.
        folder: folder for its private copy.
        files: files to write over the copy's, by virtual path ("/cf/x").
        line: the ports of commands and of telemetry.
        arguments: arguments of its command line, such as "--cpuid", "2".

    Attributes:
        inside: id of the first process of its namespaces.
    """

    def __init__(
        self,
        built: Path,
        folder: Path,
        files: Mapping[str, bytes],
        line: tuple[int, int] = (CI_PORT, TO_PORT),
        arguments: Sequence[str] = (),
    ) -> None:
        self._arguments = tuple(arguments)
        self._folder = folder
        self._up_port, self._down_port = line
        shutil.copytree(built / "cf", folder / "cf")
        shutil.copy(built / EXECUTABLE, folder)
        for path, content in files.items():
            target = folder / path.lstrip("/")
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
        self._log = folder / "console.log"

    def __enter__(self) -> RealCfe:
        spaces = [*NOT_LONGER_THAN_US, "taskset", "-c", str(one_cpu()), *NAMESPACES]
        with self._log.open("wb") as log:
            self._process = subprocess.Popen(
                [*spaces, "bash", "-c", FOREVER, "-", f"./{EXECUTABLE}", *self._arguments],
                cwd=self._folder,
                stdout=log,
                stderr=log,
            )
        try:
            self.wait(lambda: self.boots() > 0, "boot", BOOT_LIMIT_S)
            self.inside = int(
                Path(f"/proc/{self._process.pid}/task/{self._process.pid}/children").read_text(encoding="utf-8")
            )
            with in_network_of(self.inside):
                self._up = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
                self._down = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
                self._down.bind(("127.0.0.1", self._down_port))
        except BaseException:
            self._end()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self._up.close()
        self._down.close()
        self._end()

    def _end(self) -> None:
        self._process.kill()  # the first process of its space: all others go with it
        self._process.wait()

    def send(self, packet: bytes) -> None:
        """Send a datagram up."""
        self._up.sendto(packet, ("127.0.0.1", self._up_port))

    def receive(self, timeout_s: float) -> bytes | None:
        """Return the next datagram from it, or None after `timeout_s` seconds of the host without one."""
        if not select.select([self._down], [], [], max(0.0, timeout_s))[0]:
            return None
        return self._down.recv(65536)

    def kill(self) -> None:
        """End its process as a crash would. It is restarted."""
        for child in Path(f"/proc/{self.inside}/task/{self.inside}/children").read_text(encoding="utf-8").split():
            os.kill(int(child), signal.SIGKILL)

    def console(self) -> bytes:
        """Return the output since the start."""
        return self._log.read_bytes()

    def boots(self) -> int:
        """Return how often it has booted."""
        return self.console().count(OPERATIONAL)

    def release(self) -> str:
        """Return the release of cFE according to its first events, such as "7.0.0"."""
        found = re.search(rb"cFE ES Initialized: CFE_ES v(\d+\.\d+\.\d+)", self.console())
        return found[1].decode() if found else ""

    def files(self) -> dict[str, bytes]:
        """Content of every file in /ram, by virtual path."""
        disk = Path(f"/proc/{self.inside}/root/{RAM_DISK}")
        return {f"/ram/{each.name}": each.read_bytes() for each in disk.iterdir() if each.is_file()}

    @property
    def folder(self) -> Path:
        """The private copy; /cf is its `cf`."""
        return self._folder

    def wait(self, done: Callable[[], bool], what: str, limit_s: float) -> None:
        """Wait until something is so.

        Raises:
            TimeoutError: it was not so within the limit, in s of the host.
        """
        end = time.monotonic() + limit_s
        while not done():
            if time.monotonic() > end or self._process.poll() is not None:
                last = self.console()[-2000:].decode(errors="replace")
                raise TimeoutError(f"NASA's cFE: no {what} within {limit_s} s; its console ends with:\n{last}")
            time.sleep(0.02)


@contextmanager
def in_network_of(pid: int) -> Iterator[None]:
    """Create sockets in the network of another process while the block runs. They stay in that network."""
    enter = ctypes.CDLL(None, use_errno=True).setns
    with (
        Path("/proc/self/ns/net").open(encoding="utf-8") as own,
        Path(f"/proc/{pid}/ns/net").open(encoding="utf-8") as other,
    ):
        if enter(other.fileno(), CLONE_NEWNET):
            raise OSError(ctypes.get_errno(), "setns")
        try:
            yield
        finally:
            enter(own.fileno(), CLONE_NEWNET)
