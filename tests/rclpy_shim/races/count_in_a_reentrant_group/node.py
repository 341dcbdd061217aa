"""Two callbacks of a reentrant group count in one variable."""

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Int32


class Counter(Node):
    def __init__(self):
        super().__init__("counter")
        group = ReentrantCallbackGroup()
        self.count = 0
        self.shown = self.create_publisher(Int32, "count", 10)
        self.timers_of_it = [self.create_timer(0.1, self.add, callback_group=group) for turn in range(2)]
        self.calls = 0

    def add(self):
        count = self.count
        self.shown.publish(Int32(data=count))
        self.count = count + 1
        self.calls += 1


rclpy.init()
counter, executor = Counter(), MultiThreadedExecutor(2)
executor.add_node(counter)
end = counter.get_clock().now().nanoseconds + 550_000_000
while counter.get_clock().now().nanoseconds < end:
    executor.spin_once(timeout_sec=0.05)
assert counter.count == counter.calls, "an update was lost"
