"""Keeps a map and a pose, each with its lock. The two callbacks take the locks in opposite orders."""

import threading

import rospy
from std_msgs.msg import Float32


class Mapper:
    def __init__(self) -> None:
        self.map_lock, self.pose_lock = threading.Lock(), threading.Lock()
        self.walls, self.pose = [], 0.0
        rospy.Subscriber("scan", Float32, self.on_scan)
        rospy.Subscriber("odom", Float32, self.on_odom)

    def on_scan(self, message: Float32) -> None:
        with self.map_lock:
            with self.pose_lock:
                wall = self.pose + message.data
            self.walls.append(wall)

    def on_odom(self, message: Float32) -> None:
        with self.pose_lock:
            self.pose += message.data
            with self.map_lock:
                self.walls = [wall for wall in self.walls if wall > self.pose]


rospy.init_node("mapper")
Mapper()
rospy.spin()
