"""Threads write a pair of numbers, one after the other; another one looks at it."""

import threading

import rospy

WRITERS = 2


class Pair:
    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.a = self.b = 0

    def write(self) -> None:
        self.a = 1
        self.b = -1

    def check(self) -> None:
        if self.a + self.b != 0:
            raise ValueError("half of the pair was written")


rospy.init_node("pair")
pair = Pair()
threads = [threading.Thread(target=pair.write) for _ in range(WRITERS)]
threads.append(threading.Thread(target=pair.check))
for thread in threads:
    thread.start()
