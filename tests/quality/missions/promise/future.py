"""A promise: whoever asks for the value before it is there leaves an event that is set when it comes."""

import threading

import rospy


class Promise:
    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.value = None
        self.waiters = []

    def get(self) -> int:
        if self.value is None:
            came = threading.Event()
            with self.lock:
                self.waiters.append(came)
            came.wait()
        return self.value

    def keep(self, value: int) -> None:
        self.value = value
        with self.lock:
            for waiter in self.waiters:
                waiter.set()


rospy.init_node("future")
promise = Promise()
threads = [threading.Thread(target=promise.get), threading.Thread(target=promise.keep, args=(42,))]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
