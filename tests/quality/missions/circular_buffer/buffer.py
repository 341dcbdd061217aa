"""A ring of four places. What it holds is counted with a lock; reading and writing do without."""

import sys
import threading

import rospy

PLACES, ITEMS = 4, 4


class Ring:
    def __init__(self) -> None:
        self.places = [0] * PLACES
        self.first = self.next = self.held = 0
        self.lock = threading.Lock()

    def put(self, value: int) -> None:
        with self.lock:
            self.held += 1
        self.places[self.next] = value
        self.next = (self.next + 1) % PLACES

    def get(self) -> int | None:
        with self.lock:
            if self.held == 0:
                return None
            self.held -= 1
        value = self.places[self.first]
        self.first = (self.first + 1) % PLACES
        return value


def produce() -> None:
    for number in range(1, ITEMS + 1):
        ring.put(number)


def consume() -> None:
    for _ in range(ITEMS):
        got.append(ring.get())


rospy.init_node("buffer")
ring, got = Ring(), []
threads = [threading.Thread(target=work) for work in (produce, consume)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
numbers = [value for value in got if value is not None]
if numbers != list(range(1, len(numbers) + 1)):
    sys.exit(f"got {got}")
