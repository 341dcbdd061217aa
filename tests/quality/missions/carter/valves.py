"""The first pump closes the main valve, the last one opens it; somebody takes the two locks in another order."""

import threading

import rospy


class Valves:
    def __init__(self) -> None:
        self.count_lock, self.valve = threading.Lock(), threading.Lock()
        self.pumps = 0

    def pump(self) -> None:
        with self.count_lock:
            self.pumps += 1
            if self.pumps == 1:
                self.valve.acquire()
        rospy.logdebug("pumping")
        with self.count_lock:
            self.pumps -= 1
            if self.pumps == 0:
                self.valve.release()

    def inspect(self) -> None:
        with self.valve, self.count_lock:
            rospy.logdebug("%d pumps", self.pumps)


rospy.init_node("valves")
valves = Valves()
threads = [threading.Thread(target=work) for work in (valves.pump, valves.pump, valves.inspect)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
