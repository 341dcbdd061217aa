"""Requests over topics: the asker notes the question after it has sent it."""

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import Int32


class Asker(Node):
    def __init__(self):
        super().__init__("asker")
        group = ReentrantCallbackGroup()
        self.pending = {}
        self.question = self.create_publisher(Int32, "question", 10)
        self.create_subscription(Int32, "answer", self.answered, 10, callback_group=group)
        self.timer = self.create_timer(0.1, self.ask, callback_group=group)
        self.futures = []

    def ask(self):
        number = len(self.futures)
        future = Future()
        self.question.publish(Int32(data=number))
        self.pending[number] = future
        self.futures.append(future)
        if len(self.futures) == 5:
            self.timer.cancel()

    def answered(self, message):
        future = self.pending.pop(message.data, None)
        if future is not None:
            future.set_result(message.data)


class Answerer(Node):
    def __init__(self):
        super().__init__("answerer")
        self.answer = self.create_publisher(Int32, "answer", 10)
        self.create_subscription(Int32, "question", self.answer.publish, 10)


rclpy.init()
asker, executor = Asker(), MultiThreadedExecutor(3)
executor.add_node(asker)
executor.add_node(Answerer())
end = asker.get_clock().now().nanoseconds + 1_000_000_000
while asker.get_clock().now().nanoseconds < end:
    executor.spin_once(timeout_sec=0.05)
assert all(each.done() for each in asker.futures), "a future never completes"
