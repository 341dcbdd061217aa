"""A driver counts who is in it, so that it stops when the last one has left. A caller may come in just then."""

import threading

import rospy


class Driver:
    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.users = 1  # the driver itself
        self.stopping = self.stopped = False
        self.empty = threading.Event()

    def enter(self) -> bool:
        if self.stopping:
            return False
        with self.lock:
            self.users += 1
        return True

    def leave(self) -> None:
        with self.lock:
            self.users -= 1
            if self.users == 0:
                self.empty.set()

    def request(self) -> None:
        if self.enter():
            if self.stopped:
                raise RuntimeError("a request in a driver that has stopped")
            self.leave()

    def stop(self) -> None:
        self.stopping = True
        self.leave()
        self.empty.wait()
        self.stopped = True


rospy.init_node("driver")
driver = Driver()
for work in (driver.request, driver.stop):
    threading.Thread(target=work).start()
