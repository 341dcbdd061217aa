"""Work goes through two stages, each with a lock of its own; a reader believes that both are done at once."""

import threading

import rospy

WORKERS = 19


class Stages:
    def __init__(self) -> None:
        self.first_lock, self.second_lock = threading.Lock(), threading.Lock()
        self.first = self.second = 0

    def work(self) -> None:
        with self.first_lock:
            self.first = 1
        with self.second_lock:
            self.second = self.first + 1

    def read(self) -> None:
        with self.first_lock:
            first = self.first
        if first == 0:
            return
        with self.second_lock:
            second = self.second
        if second != first + 1:
            raise ValueError(f"the first stage has {first}, the second {second}")


rospy.init_node("stages")
stages = Stages()
threads = [threading.Thread(target=stages.work) for _ in range(WORKERS)]
threads.append(threading.Thread(target=stages.read))
for thread in threads:
    thread.start()
