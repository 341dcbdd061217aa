"""Trains look whether the other one is on the single track, and go onto it then."""

import threading

import rospy


class Track:
    def __init__(self) -> None:
        self.wants = [False, False]
        self.trains = 0

    def drive(self, me: int) -> None:
        while self.wants[1 - me]:
            rospy.sleep(0.001)
        self.wants[me] = True
        self.trains += 1
        rospy.logdebug("train %d", me)
        if self.trains > 1:
            raise RuntimeError("two trains on one track")
        self.trains -= 1
        self.wants[me] = False


rospy.init_node("track")
track = Track()
for number in range(2):
    threading.Thread(target=track.drive, args=(number,)).start()
