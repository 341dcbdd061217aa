"""Removes features that a system lacks, imports all of cfepy, and flies a mission: `without.py SYSTEM MISSION SECONDS`.

The last line that it prints is the digest of the run.
"""

from __future__ import annotations

import importlib
import os
import pkgutil
import select
import signal
import socket
import sys
from types import ModuleType

MODULES = {
    "windows": "fcntl termios tty pty resource pwd grp posix _curses curses syslog readline _posixshmem",
    "macos": "spwd ossaudiodev",
}
NAMES: dict[str, dict[ModuleType, str]] = {
    "windows": {
        os: "fork forkpty register_at_fork sched_setaffinity sched_getaffinity sched_setscheduler sched_param"
        " SCHED_BATCH fchmod fchown chown lchown killpg getuid geteuid getgid mkfifo mknod uname O_CLOEXEC O_NOFOLLOW"
        " O_NONBLOCK O_TMPFILE O_DIRECTORY getloadavg nice setsid statvfs pread pwrite posix_fallocate waitid"
        " setpriority memfd_create getxattr listxattr setxattr removexattr sched_yield getrandom wait",
        signal: "SIGUSR1 SIGUSR2 SIGBUS SIGTRAP SIGRTMIN SIGRTMAX SIGALRM SIGVTALRM SIGHUP SIGQUIT SIGKILL SIGPIPE"
        " SIGCHLD setitimer getitimer pthread_kill pthread_sigmask alarm pause sigwait siginterrupt"
        " ITIMER_VIRTUAL ITIMER_REAL",
        select: "epoll poll POLLIN POLLOUT POLLPRI POLLHUP POLLERR POLLNVAL EPOLLIN EPOLLOUT",
        socket: "AF_UNIX SOCK_NONBLOCK SOCK_CLOEXEC MSG_DONTWAIT EAI_ADDRFAMILY AF_NETLINK",
    },
    "macos": {
        os: "sched_setaffinity sched_getaffinity sched_setscheduler sched_param SCHED_BATCH O_TMPFILE memfd_create"
        " posix_fallocate getxattr listxattr setxattr removexattr getrandom",
        signal: "SIGRTMIN SIGRTMAX",
        select: "epoll EPOLLIN EPOLLOUT",
        socket: "SOCK_NONBLOCK SOCK_CLOEXEC AF_NETLINK",
    },
}
NEED_MORE = (
    "psutil",
    "pandas",
    "matplotlib",
    "pytest",
    "hypothesis",
    "distributed",
    "textual",
    "greenlet",
    "mcap",
    "elftools",
    "tree_sitter",
)
"""Libraries that are optional: those that are here are built for this system."""
POSIX_ONLY = {"windows": ("cfepy.nodes.stdlib.terminal", "cfepy.nodes.stdlib.curses_module"), "macos": ()}
"""What only nodes get that import such a module of Python themselves."""


def take_away(system: str) -> None:
    """Remove the features that the system lacks."""
    import multiprocessing.connection  # the standard library's own look at the system comes before
    import subprocess
    import tempfile

    assert multiprocessing.connection is not subprocess is not tempfile
    for name in (*MODULES[system].split(), *NEED_MORE):
        sys.modules[name] = None  # type: ignore[assignment]  # what makes an import fail
    for module, names in NAMES[system].items():
        for name in names.split():
            vars(module).pop(name, None)
    if system == "macos":
        sys.platform = "darwin"


def import_all(system: str) -> None:
    """Every module of cfepy, but for those that want an optional library that is not there."""
    import cfepy
    import rospy_shim

    for package in (cfepy, rospy_shim):
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            name = found.name
            if name.startswith("ros_libraries.") or name.endswith("__main__") or name in POSIX_ONLY[system]:
                continue
            try:
                importlib.import_module(name)
            except ModuleNotFoundError as error:
                if (error.name or "").partition(".")[0] not in NEED_MORE:
                    raise


def main() -> None:
    """Do it all."""
    system, mission_name, seconds = sys.argv[1:]
    take_away(system)
    import_all(system)
    from cfepy.mission import Mission
    from cfepy.writing.console import Console

    with Mission(mission_name, console=Console(quiet=True)) as mission:
        mission.run_for(float(seconds))
        mission.shut_down_nodes()
        print(mission.trace.digest())


if __name__ == "__main__":
    main()
