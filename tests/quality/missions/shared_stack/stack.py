"""Pushes and pops. Whoever pops looks first whether there is something, and takes the lock then."""

import threading

import rospy


class Stack:
    def __init__(self) -> None:
        self.items = []
        self.lock = threading.Lock()

    def push(self, item: int) -> None:
        with self.lock:
            self.items.append(item)

    def pop(self) -> int | None:
        if not self.items:
            return None
        with self.lock:
            return self.items.pop()


rospy.init_node("stack")
stack = Stack()
stack.push(1)
threads = [threading.Thread(target=stack.pop) for _ in range(2)]
for thread in threads:
    thread.start()
