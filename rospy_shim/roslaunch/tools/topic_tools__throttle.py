"""topic_tools/throttle: limit the messages or bytes a second (wiki.ros.org/topic_tools/throttle)."""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Callable

import rospy
from any_topic import QUEUE_SIZE, Output

USAGE = """usage: throttle messages IN_TOPIC MSGS_PER_SEC [OUT_TOPIC]
   or: throttle bytes IN_TOPIC BYTES_PER_SEC WINDOW [OUT_TOPIC]"""


class MessageThrottle:
    """Sends on messages that come later than a period after the last one that was sent.

    Args:
        output: the output topic.
        rate: messages a second.
    """

    def __init__(self, output: Output, rate: float) -> None:
        self._output = output
        self._period = rospy.Duration(1 / rate)
        self._last = rospy.Time(0)

    def take(self, message: rospy.AnyMsg) -> None:
        """Take a message."""
        now = rospy.Time.now()
        self._last = min(self._last, now)  # the clock was set back
        if now - self._last > self._period:
            self._output.send(message)
            self._last = now


class ByteThrottle:
    """Sends on messages while fewer bytes than permitted were sent in the window.

    Args:
        output: the output topic.
        rate: bytes that may have been sent.
        window: in s.
    """

    def __init__(self, output: Output, rate: float, window: float) -> None:
        self._output = output
        self._rate = rate
        self._window = window
        self._sent: deque[tuple[float, int]] = deque()  # time in s, bytes

    def take(self, message: rospy.AnyMsg) -> None:
        """Take a message."""
        now = rospy.get_time()
        while self._sent and self._sent[0][0] < now - self._window:
            self._sent.popleft()
        if sum(size for _, size in self._sent) < self._rate:
            self._output.send(message)
            self._sent.append((now, len(message._buff)))


def throttle(words: list[str]) -> Callable[[rospy.AnyMsg], None]:
    """Return the throttle that the command line asks for.

    Raises:
        ValueError: the command line is invalid.
    """
    kind, topic, *numbers = words
    count = {"messages": 1, "bytes": 2}.get(kind, 0)
    if not count or len(numbers) not in (count, count + 1):
        raise ValueError(f"{len(words)} arguments")
    output = Output(numbers[count] if len(numbers) > count else f"{topic}_throttle")
    values = [float(number) for number in numbers[:count]]
    if min(values) <= 0:
        raise ValueError(f"{min(values):g} is not greater than 0")
    return MessageThrottle(output, *values).take if count == 1 else ByteThrottle(output, *values).take


def main() -> int:
    """Run until the end."""
    rospy.init_node("throttle", anonymous=True)
    words = rospy.myargv()[1:]
    try:
        take = throttle(words)
    except ValueError as error:
        rospy.logerr("%s\n%s", error, USAGE)
        return 1
    rospy.Subscriber(words[1], rospy.AnyMsg, take, queue_size=QUEUE_SIZE)
    rospy.spin()
    return 0


if __name__ == "__main__":
    sys.exit(main())
