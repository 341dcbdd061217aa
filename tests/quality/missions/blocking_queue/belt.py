"""A buffer of one place with one condition, on which producers and consumers both wait; one of them is woken."""

import threading

import rospy


class Belt:
    def __init__(self) -> None:
        self.changed = threading.Condition()
        self.items = []

    def put(self, item: int) -> None:
        with self.changed:
            while self.items:
                self.changed.wait()
            self.items.append(item)
            self.changed.notify()

    def get(self) -> int:
        with self.changed:
            while not self.items:
                self.changed.wait()
            item = self.items.pop()
            self.changed.notify()
            return item


def produce() -> None:
    for item in range(2):
        belt.put(item)


def consume() -> None:
    for _ in range(2):
        belt.get()


rospy.init_node("belt")
belt = Belt()
threads = [threading.Thread(target=work) for work in (produce, produce, consume, consume)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
