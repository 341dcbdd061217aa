"""A worker process: flies batches of schedules for the process that started it.

`python -m cfepy.extra.exploration.worker NUMBER FOLDER`, where NUMBER is the file descriptor or handle of its end of a
connection and FOLDER the place for its temporary files. First comes the trial, then batches. Each batch is answered by
its verdicts. A thread reads the connection, so the worker ends at once, even in the middle of a schedule, when the
other process ends.
"""

from __future__ import annotations

import faulthandler
import os
import signal
import sys
import tempfile
import threading
from multiprocessing.connection import Connection
from queue import SimpleQueue
from typing import Any

from cfepy.extra.exploration.batch import Lot
from cfepy.extra.exploration.fork_server import ForkingJudge
from cfepy.interpreter.child_pipes import connection_of
from cfepy.interpreter.garbage import freeze
from cfepy.interpreter.host_system import in_forked_process
from cfepy.status import UsageError

READY = "ready"


def main() -> None:
    """Serve until the other end closes the connection."""
    faulthandler.enable()  # a worker that crashes or aborts writes its stacks
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that started it
    connection, tempfile.tempdir = connection_of(int(sys.argv[1])), sys.argv[2]
    in_forked_process(connection.close)  # its end means the end of this process alone
    inbox: SimpleQueue[bytes] = SimpleQueue()
    threading.Thread(target=_read, args=(connection, inbox), daemon=True).start()
    _serve(connection, inbox)


def _serve(connection: Connection[Any, Any], inbox: SimpleQueue[bytes]) -> None:
    import pickle

    trial = pickle.loads(inbox.get())
    judge = trial.judge if isinstance(trial, Lot) else ForkingJudge(trial).judge
    freeze()
    connection.send(READY)
    while True:
        jobs = pickle.loads(inbox.get())
        try:
            connection.send([(number, judge(schedule)) for number, schedule in jobs])
        except UsageError as error:
            connection.send(error)


def _read(connection: Connection[Any, Any], inbox: SimpleQueue[bytes]) -> None:
    try:
        while True:
            inbox.put(connection.recv_bytes())
    except (EOFError, OSError):
        os._exit(0)


if __name__ == "__main__":
    main()
