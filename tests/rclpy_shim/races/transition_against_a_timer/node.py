"""A timer publishes while another thread deactivates and cleans up its lifecycle node."""

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from std_msgs.msg import Int32


class Source(LifecycleNode):
    def __init__(self):
        super().__init__("source")
        self.group = ReentrantCallbackGroup()
        self.pub = None
        self.create_timer(0.1, self.send, callback_group=self.group)
        self.create_timer(0.1, self.toggle, callback_group=self.group)

    def on_configure(self, state):
        self.pub = self.create_lifecycle_publisher(Int32, "a", 10)
        return TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state):
        self.destroy_lifecycle_publisher(self.pub)
        self.pub = None
        return TransitionCallbackReturn.SUCCESS

    def send(self):
        if self.pub is not None:
            self.get_logger().debug("sends")
            now = self.get_clock().now()
            self.pub.publish(Int32(data=now.nanoseconds % 1000))

    def toggle(self):
        if self.pub is not None:
            self.trigger_deactivate()
            self.trigger_cleanup()
        else:
            self.trigger_configure()
            self.trigger_activate()


rclpy.init()
source, executor = Source(), MultiThreadedExecutor(2)
source.trigger_configure()
source.trigger_activate()
executor.add_node(source)
end = source.get_clock().now().nanoseconds + 1_000_000_000
while source.get_clock().now().nanoseconds < end:
    executor.spin_once(timeout_sec=0.05)
