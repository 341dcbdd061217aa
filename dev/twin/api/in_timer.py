"""The calls that a script makes in a timer's callback; app/api_osal.c has them in C, by the same numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy import msg
from cfepy.osal import OS_FILE_FLAG_CREATE, OS_READ_WRITE
from cfepy.status import OS_SEM_TIMEOUT, CfeError

CALLS = 29
"""How many there are."""


def in_timer(cfe: Any, which: int, timer: int, given: int) -> int:
    """Make a call in a callback.

    Args:
        cfe: the services.
        which: number of the call.
        timer: the timer whose callback it is.
        given: an id of any object.

    Returns:
        The status, or the call's answer.
    """
    os, es, evs, sb = cfe.os, cfe.es, cfe.evs, cfe.sb

    def put_file() -> None:
        os.close(os.open_create("/ram/in_timer", OS_FILE_FLAG_CREATE, OS_READ_WRITE))

    def nothing(*_: object) -> None:
        pass

    calls: tuple[Callable[[], int], ...] = (
        lambda: _done(os.timer_delete, timer),
        lambda: _done(os.timer_set, timer, 100000000, 0),
        lambda: _done(os.timer_create, "IN_TIMER_2", nothing),
        lambda: _done(os.time_base_create, "IN_TIMER_2"),
        lambda: _done(os.timer_add, "IN_TIMER_2", given, nothing),
        lambda: _done(os.timer_get_info, timer),
        lambda: _done(os.task_delay, 1),
        lambda: int(os.task_get_id() != 0),
        lambda: _done(os.bin_sem_give, given),
        lambda: 0 if os.bin_sem_timed_wait(given, 0) else OS_SEM_TIMEOUT,
        lambda: _done(os.count_sem_give, given),
        lambda: _done(os.queue_put, given, b"i"),
        lambda: _done(es.get_app_id),
        lambda: _done(es.get_task_id),
        lambda: int(evs.send_event(1, 3, "in a timer")),
        lambda: _done(sb.transmit_msg, msg.command(0x1890, 0)),
        lambda: _done(sb.create_pipe, 2, "IN_TIMER"),
        lambda: int(es.write_to_sys_log("in a timer\n")),
        lambda: _done(put_file),
        lambda: _done(os.task_set_priority, os.task_get_id(), 50),
        lambda: _done(es.create_child_task, "IN_TIMER", nothing, 4096, 50),
        lambda: int(es.run_loop(1)),
        lambda: _done(os.bin_sem_delete, given),
        lambda: _done(os.queue_delete, given),
        lambda: _done(os.timer_delete, given),
        lambda: _done(os.timer_set, given, 100000000, 0),
        lambda: _done(evs.reset_all_filters),
        lambda: _done(os.mut_sem_delete, given),
        lambda: 0 if os.count_sem_timed_wait(given, 0) else OS_SEM_TIMEOUT,
    )
    try:
        return calls[which]()
    except CfeError as error:
        return error.status


def _done(call: Callable[..., object], *arguments: object) -> int:
    call(*arguments)
    return 0
