"""Many messages, by one task, by two and by four (sb_performance_test.c)."""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import partial

from cfepy.app import Cfe
from cfepy.sb import POLL
from cfepy.sb.bus import DEFAULT_QOS
from tests.functional.harness import CHILD_STACK, CMD_MID, TLM_MID, Attempt

MESSAGES = 1000
VALUE = struct.Struct("<I")
SENDER_PRIORITY, RECEIVER_PRIORITY = 150, 100
IN_FLIGHT = 8


def listening_pipe(cfe: Cfe, msg_id: int, limit: int) -> int:
    pipe = cfe.sb.create_pipe(10, f"Pipe {msg_id:x}")
    cfe.sb.subscribe_ex(msg_id, pipe, DEFAULT_QOS, limit)
    return pipe


def message(cfe: Cfe, msg_id: int, value: int) -> bytearray:
    """Return a message that ends with a number."""
    packet = cfe.msg.init(msg_id, 16 + VALUE.size)
    packet[16:] = VALUE.pack(value)
    return packet


def receive(cfe: Cfe, pipe: int, timeout_ms: int = POLL) -> int:
    """Return the number in the next message."""
    packet = cfe.sb.receive_buffer(pipe, timeout_ms)
    assert packet is not None
    number: int = VALUE.unpack_from(packet, 16)[0]
    return number


def run_children(cfe: Cfe, tasks: list[tuple[Callable[[], None], int]]) -> None:
    """Run child tasks with their priorities to their ends. Raises an exception of one of them."""
    attempts = [Attempt(task) for task, _ in tasks]
    for number, (_, priority) in enumerate(tasks):
        cfe.es.create_child_task(f"Bulk{number}", attempts[number], CHILD_STACK, priority)
    while not all(attempt.is_over for attempt in attempts):
        cfe.os.task_delay(100)
    for attempt in attempts:
        attempt.confirm()


def test_single_thread_bulk_transfer(cfe: Cfe) -> None:
    pipes = {msg_id: listening_pipe(cfe, msg_id, limit=3) for msg_id in (CMD_MID, TLM_MID)}
    for number in range(MESSAGES):
        for msg_id in pipes:
            cfe.sb.transmit_msg(message(cfe, msg_id, number))
        assert [receive(cfe, pipe) for pipe in pipes.values()] == [number, number]
    for pipe in pipes.values():
        assert cfe.sb.receive_buffer(pipe, POLL) is None
        cfe.sb.delete_pipe(pipe)


def test_2_thread_bulk_transfer(cfe: Cfe) -> None:
    pipes = {msg_id: listening_pipe(cfe, msg_id, limit=3) for msg_id in (CMD_MID, TLM_MID)}

    def send_and_receive(msg_id: int, pipe: int) -> None:
        for number in range(MESSAGES):
            cfe.sb.transmit_msg(message(cfe, msg_id, number))
            assert receive(cfe, pipe) == number

    run_children(cfe, [(partial(send_and_receive, *each), SENDER_PRIORITY) for each in pipes.items()])
    for pipe in pipes.values():
        assert cfe.sb.receive_buffer(pipe, POLL) is None
        cfe.sb.delete_pipe(pipe)


def test_4_thread_bulk_transfer(cfe: Cfe) -> None:
    """Receivers let senders go on, so that no more messages are on their way than the limit lets through."""
    pipes = {msg_id: listening_pipe(cfe, msg_id, limit=IN_FLIGHT) for msg_id in (CMD_MID, TLM_MID)}
    semaphores = {msg_id: cfe.os.count_sem_create(f"Sem{msg_id:x}", IN_FLIGHT) for msg_id in pipes}

    def send(msg_id: int) -> None:
        for number in range(MESSAGES):
            cfe.os.count_sem_take(semaphores[msg_id])
            packet = message(cfe, msg_id, number)
            buffer = cfe.sb.allocate_message_buffer(len(packet))
            buffer[:] = packet
            cfe.sb.transmit_buffer(buffer)

    def take(msg_id: int) -> None:
        for number in range(MESSAGES):
            assert receive(cfe, pipes[msg_id], 5000) == number
            cfe.os.count_sem_give(semaphores[msg_id])

    senders = [(partial(send, msg_id), SENDER_PRIORITY) for msg_id in pipes]
    run_children(cfe, [*senders, *((partial(take, msg_id), RECEIVER_PRIORITY) for msg_id in pipes)])
    for msg_id, pipe in pipes.items():
        assert cfe.sb.receive_buffer(pipe, POLL) is None
        cfe.sb.delete_pipe(pipe)
        cfe.os.count_sem_delete(semaphores[msg_id])
