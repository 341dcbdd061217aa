"""A packer works off a queue; the main program takes the queue away as soon as it is empty."""

import threading

import rospy


class Queue:
    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.blocks = [b"one", b"two"]
        self.empty = threading.Event()


def pack() -> None:
    while True:
        with work.queue.lock:
            if not work.queue.blocks:
                return
            work.queue.blocks.pop()
            if not work.queue.blocks:
                work.queue.empty.set()


class Work:
    queue = Queue()


rospy.init_node("packer")
work = Work()
packer = threading.Thread(target=pack)
packer.start()
work.queue.empty.wait()
rospy.loginfo("all is packed")
work.queue = None
packer.join()
