#!/usr/bin/env python3
"""A robot with two driven wheels: drives as /cmd_vel commands, and publishes odometry.

Subscribes: `cmd_vel` (geometry_msgs/Twist), `battery_state` (sensor_msgs/BatteryState; an empty battery stops it)
Publishes, at ~rate: `odom` (nav_msgs/Odometry) and the transform from ~odom_frame to ~base_frame, from the encoders;
            `ground_truth` (nav_msgs/Odometry), the real pose in ~map_frame;
            `motor_power` (std_msgs/Float32, W);
            with a map also `clearance` (std_msgs/Float32, m from the centre to the nearest wall), and `contact`
            (std_msgs/Bool, latched, on change): a wall stops the robot
Parameters: ~rate 50 Hz; ~x, ~y, ~yaw 0, the first pose; ~map, a YAML file as for map_server; ~radius 0.15 m;
            ~wheel_separation 0.3 m; ~max_speed 0.6 m/s and ~acceleration 1 m/s^2 of a wheel; ~command_timeout 0.5 s,
            after which it stops; ~mass 8 kg, ~rolling_resistance 0.03, ~efficiency 0.6;
            ~encoder_step 0 m of travel for one tick; ~wheel_noise 0, standard deviation as a part of the travel;
            ~seed 1
"""

from __future__ import annotations

import contextlib
import math
from typing import Any

import rospy
import tf2_ros
from drive_model import DriveModel, Pose, WheelEncoders
from geometry_msgs.msg import TransformStamped, Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Bool, Float32

LONGEST_STEP_S = 0.1


def param(name: str, default: float) -> float:
    """Return a private parameter that is a number."""
    return float(rospy.get_param("~" + name, default))


class DiffDrive:
    """The node: the robot, its encoders, and the walls around it."""

    def __init__(self) -> None:
        pose = Pose(param("x", 0), param("y", 0), param("yaw", 0))
        separation = param("wheel_separation", 0.3)
        self._robot = DriveModel(
            pose,
            separation,
            param("acceleration", 1.0),
            param("max_speed", 0.6),
            param("mass", 8.0),
            param("rolling_resistance", 0.03),
            param("efficiency", 0.6),
        )
        seed = int(rospy.get_param("~seed", 1))
        self._encoders = WheelEncoders(separation, param("encoder_step", 0), param("wheel_noise", 0), seed)
        self._walls = self._read_map()
        self._radius = param("radius", 0.15)
        self._timeout = rospy.Duration.from_sec(param("command_timeout", 0.5))
        self._frames = {name: str(rospy.get_param(f"~{name}_frame", name)) for name in ("map", "odom")}
        self._base = str(rospy.get_param("~base_frame", "base_link"))
        self._command, self._commanded, self._is_empty = (0.0, 0.0), rospy.Time(0), False
        self._odometry = rospy.Publisher("odom", Odometry, queue_size=10)
        self._truth = rospy.Publisher("ground_truth", Odometry, queue_size=10)
        self._power = rospy.Publisher("motor_power", Float32, queue_size=10)
        self._transforms = tf2_ros.TransformBroadcaster()
        if self._walls is not None:
            self._clearance = rospy.Publisher("clearance", Float32, queue_size=10)
            self._contact = rospy.Publisher("contact", Bool, queue_size=10, latch=True)
            self._touches = False
            self._contact.publish(self._touches)
        rospy.Subscriber("cmd_vel", Twist, self._on_command, queue_size=1)
        rospy.Subscriber("battery_state", BatteryState, self._on_battery, queue_size=1)

    @staticmethod
    def _read_map() -> Any:
        path = rospy.get_param("~map", "")
        if not path:
            return None
        from floor_map import read_map

        return read_map(path)

    def _on_command(self, message: Twist) -> None:
        self._command, self._commanded = (message.linear.x, message.angular.z), rospy.Time.now()

    def _on_battery(self, message: BatteryState) -> None:
        self._is_empty = message.percentage <= 0

    def run(self) -> None:
        """Drive until shutdown."""
        rate = rospy.Rate(param("rate", 50))
        before = rospy.Time.now()
        while not rospy.is_shutdown():
            rate.sleep()
            now = rospy.Time.now()
            self._drive(now, min(LONGEST_STEP_S, (now - before).to_sec()))
            before = now

    def _drive(self, now: rospy.Time, seconds: float) -> None:
        if seconds <= 0:
            return
        is_old = now - self._commanded > self._timeout
        speed, turn = (0.0, 0.0) if is_old or self._is_empty else self._command
        pose = self._robot.step(speed, turn, seconds)
        if self._walls is not None:
            pose = self._stopped_by_walls(pose)
        self._encoders.add(self._robot.left * seconds, self._robot.right * seconds)
        self._robot.pose = pose
        self._publish(now)

    def _stopped_by_walls(self, pose: Pose) -> Pose:
        """Return the pose that the walls permit: a robot that touches one stays, but may turn and drive away."""
        here, there = (self._walls.clearance(each.x, each.y) for each in (self._robot.pose, pose))
        touches = there < self._radius and there < here
        if touches:
            self._robot.block()
            pose, there = Pose(self._robot.pose.x, self._robot.pose.y, pose.yaw), here
        if touches != self._touches:
            self._touches = touches
            self._contact.publish(touches)
        self._clearance.publish(there)
        return pose

    def _publish(self, now: rospy.Time) -> None:
        counted = self._message(now, self._frames["odom"], self._encoders.pose)
        self._odometry.publish(counted)
        self._truth.publish(self._message(now, self._frames["map"], self._robot.pose))
        self._power.publish(self._robot.power)
        transform = TransformStamped(header=counted.header, child_frame_id=self._base)
        transform.transform.translation.x = counted.pose.pose.position.x
        transform.transform.translation.y = counted.pose.pose.position.y
        transform.transform.rotation = counted.pose.pose.orientation
        self._transforms.sendTransform(transform)

    def _message(self, now: rospy.Time, frame: str, pose: Pose) -> Odometry:
        message = Odometry(child_frame_id=self._base)
        message.header.stamp, message.header.frame_id = now, frame
        message.pose.pose.position.x, message.pose.pose.position.y = pose.x, pose.y
        message.pose.pose.orientation.z = math.sin(pose.yaw / 2)
        message.pose.pose.orientation.w = math.cos(pose.yaw / 2)
        message.twist.twist.linear.x, message.twist.twist.angular.z = self._robot.speed, self._robot.turn
        return message


def main() -> None:
    rospy.init_node("diff_drive")
    DiffDrive().run()


if __name__ == "__main__":
    with contextlib.suppress(rospy.ROSInterruptException):
        main()
