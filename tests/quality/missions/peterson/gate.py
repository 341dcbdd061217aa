"""Peterson's mutual exclusion, with its first two steps the other way round."""

import threading

import rospy


class Gate:
    def __init__(self) -> None:
        self.wants = [False, False]
        self.turn = 0
        self.inside = 0

    def enter(self, me: int) -> None:
        self.turn = 1 - me
        self.wants[me] = True
        while self.wants[1 - me] and self.turn != me:
            rospy.sleep(0.001)

    def leave(self, me: int) -> None:
        self.wants[me] = False

    def work(self, me: int) -> None:
        self.enter(me)
        self.inside += 1
        rospy.logdebug("%d is inside", me)
        if self.inside > 1:
            raise RuntimeError("two are inside")
        self.inside -= 1
        self.leave(me)


rospy.init_node("gate")
gate = Gate()
for number in range(2):
    threading.Thread(target=gate.work, args=(number,)).start()
