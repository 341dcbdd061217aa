#!/usr/bin/env python3
"""Test node: Python's own threads, queues, locks and a thread pool beside rospy."""

from __future__ import annotations

import queue
import threading
from concurrent.futures import ThreadPoolExecutor

import rospy

WORKERS = 3
JOBS = 30


def main() -> None:
    rospy.init_node("threads")
    jobs: queue.Queue[int | None] = queue.Queue(maxsize=4)
    lock = threading.Lock()
    squares: list[int] = []

    def work() -> None:
        while True:
            job = jobs.get()
            if job is None:
                return
            rospy.sleep(0.002)
            with lock:
                squares.append(job * job)

    workers = [threading.Thread(target=work, name=f"worker {number}") for number in range(WORKERS)]
    for worker in workers:
        worker.start()
    for job in range(JOBS):
        jobs.put(job)
    for _ in workers:
        jobs.put(None)
    for worker in workers:
        worker.join()
    with ThreadPoolExecutor(max_workers=2) as pool:
        cubes = sum(pool.map(lambda number: number**3, range(10)))
    alive = sum(worker.is_alive() for worker in workers)
    print(f"result: {len(squares)} squares, sum {sum(squares)}, cubes {cubes}, {alive} workers alive")


if __name__ == "__main__":
    main()
