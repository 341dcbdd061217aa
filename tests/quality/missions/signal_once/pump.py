"""A consumer waits for the signal that there is something, without looking whether there is."""

import threading

import rospy


class Store:
    def __init__(self) -> None:
        self.changed = threading.Condition()
        self.items = 0

    def produce(self) -> None:
        with self.changed:
            self.items += 1
            self.changed.notify()

    def consume(self) -> None:
        with self.changed:
            self.changed.wait()
            self.items -= 1


rospy.init_node("pump")
store = Store()
threads = [threading.Thread(target=work) for work in (store.consume, store.produce)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
