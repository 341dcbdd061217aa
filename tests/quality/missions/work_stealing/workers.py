"""A queue of which its owner takes from the tail without a lock, and a thief from the head with one."""

import sys
import threading

import rospy

ITEMS = 3


class WorkQueue:
    def __init__(self) -> None:
        self.items = {}
        self.head = self.tail = 0
        self.lock = threading.Lock()

    def put(self, item: int) -> None:
        self.items[self.tail] = item
        self.tail += 1

    def take(self) -> int | None:
        tail = self.tail - 1
        if self.head > tail:
            return None
        self.tail = tail  # too late: a thief may have looked at it before
        return self.items[tail]

    def steal(self) -> int | None:
        with self.lock:
            head = self.head
            self.head = head + 1
            if head < self.tail:
                return self.items[head]
            self.head = head
            return None


def own() -> None:
    while (item := queue.take()) is not None:
        taken.append(item)


def steal() -> None:
    if (item := queue.steal()) is not None:
        taken.append(item)


rospy.init_node("workers")
queue, taken = WorkQueue(), []
for number in range(ITEMS):
    queue.put(number)
threads = [threading.Thread(target=work) for work in (own, steal)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
if sorted(taken) != list(range(ITEMS)):
    sys.exit(f"taken were {sorted(taken)}")
