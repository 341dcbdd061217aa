"""Drive an unknown node: the observer reads the graph and drives every topic and service that it finds.

Every topic that the node subscribes to gets the same messages in each run, every service the same requests, and every
topic that it publishes is recorded. It runs on ROS as well as on cfepy.
"""

import math

import genpy
import rosgraph
import roslib.message
import rospy
import rosservice

OWN = ("/probe", "/rosout", "/ROS", "/rostopic")  # nodes that are not driven
UNDRIVEN = ("/rosout", "/rosout_agg", "/clock", "/statistics")
PLAIN = ("/get_loggers", "/set_logger_level")  # services that every node has
ITEMS = 4  # of a sequence without a length of its own
SCAN = 12  # ranges of a laser scan
NAMED = {"frame_id": "odom", "child_frame_id": "base_link", "encoding": "rgb8"}  # texts that mean something


def filled(kind, index):
    """Return the `index`th message of a type. It is the same in each run, except for times."""
    message = kind()
    for number, (name, type_name) in enumerate(zip(message.__slots__, message._slot_types, strict=True)):
        setattr(message, name, _value(name, type_name, index, number))
    shape = _SHAPES.get(message._type)
    if shape is not None:
        shape(message, index)
    return message


def _value(name, type_name, index, number):
    base, is_array, length = _parsed(type_name)
    if is_array:
        count = length or ITEMS
        if base in ("uint8", "char"):
            return bytes((index + each) % 256 for each in range(count))
        return [_value(name, base, index + each, number) for each in range(count)]
    if base == "string":
        return NAMED.get(name, f"{name} {index}")
    if base == "bool":
        return index % 2 == 0
    if base in ("float32", "float64"):
        return 0.25 * (index + 1) + 0.125 * number
    if base == "time":
        return rospy.Time.now()
    if base == "duration":
        return rospy.Duration(0.5)
    if base in ("int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64", "byte", "char"):
        return (index + number) % 100
    return filled(roslib.message.get_message_class(base if base != "Header" else "std_msgs/Header"), index)


def _parsed(type_name):
    """Return the base of a type, whether it is an array, and its length or None."""
    if not type_name.endswith("]"):
        return type_name, False, None
    base, _, length = type_name[:-1].partition("[")
    return base, True, int(length) if length else None


def _turned(message, index):
    message.x = message.y = 0.0
    message.z, message.w = math.sin(0.05 * index), math.cos(0.05 * index)


def _scanned(message, index):
    message.angle_min, message.angle_max, message.angle_increment = -1.0, 1.0, 2.0 / (SCAN - 1)
    message.range_min, message.range_max = 0.1, 10.0
    message.ranges = [0.5 + 0.25 * ((each + index) % 5) for each in range(SCAN)]
    message.intensities = [1.0] * SCAN


def _pictured(message, index):
    message.height, message.width, message.step = 2, 2, 6
    message.data = bytes((index + each) % 256 for each in range(12))


def _steered(message, index):
    message.axes = [0.125 * ((each + index) % 5) for each in range(8)]
    message.buttons = [int((each + index) % 4 == 0) for each in range(12)]


def _mapped(message, index):
    message.info.width = message.info.height = 2
    message.data = [0, 50, 100, -1]


def _clouded(message, index):
    message.height, message.width, message.point_step, message.row_step = 1, 1, 16, 16
    names = ("x", "y", "z")
    for number, field in enumerate(message.fields[:3]):
        field.name, field.offset, field.datatype, field.count = names[number], 4 * number, 7, 1
    message.fields = message.fields[:3]
    message.is_bigendian = False
    message.data = bytes(16)


_SHAPES = {
    "geometry_msgs/Quaternion": _turned,
    "sensor_msgs/LaserScan": _scanned,
    "sensor_msgs/Image": _pictured,
    "sensor_msgs/Joy": _steered,
    "sensor_msgs/PointCloud2": _clouded,
    "nav_msgs/OccupancyGrid": _mapped,
}


class Drive:
    """Drives the nodes of a run.

    Args:
        watch: records a topic, by name and message class.
        plain: makes a message plain data.
    """

    def __init__(self, watch, plain):
        self._watch = watch
        self._plain = plain
        self._master = rosgraph.Master("/probe")
        self._publishers = {}
        self.kinds = {}
        self.services = {}
        self.answers = {}

    def run(self, rounds=5, gap=0.2, settle=1.5):
        """Send `rounds` messages on each topic, `gap` seconds apart, then call each service."""
        self._await_node()
        rospy.sleep(settle)
        self._look()
        rospy.sleep(1.0)
        for index in range(rounds):
            self._look()
            for topic in sorted(self._publishers):
                publisher = self._publishers[topic]
                publisher.publish(filled(publisher.data_class, index))
                rospy.sleep(gap)
        for name in sorted(self.services):
            self.answers[name] = self._called(name)
        rospy.sleep(settle)
        self._look()

    def _await_node(self, patience=100):
        for _ in range(patience):
            if any(node not in OWN for part in self._master.getSystemState() for _, nodes in part for node in nodes):
                return
            rospy.sleep(0.1)

    def _look(self):
        """Handle new entries in the graph."""
        published, subscribed, offered = self._master.getSystemState()
        types = dict(self._master.getTopicTypes())
        for topic, nodes in published:
            if topic not in UNDRIVEN and self._theirs(nodes) and "> " + topic not in self.kinds:
                self._take(">", topic, types, self._watch)
        for topic, nodes in subscribed:
            if topic not in UNDRIVEN and self._theirs(nodes) and "< " + topic not in self.kinds:
                self._take("<", topic, types, self._feed)
        for name, nodes in offered:
            if self._theirs(nodes) and not name.endswith(PLAIN) and name not in self.services:
                self.services[name] = rosservice.get_service_type(name)

    def _take(self, direction, topic, types, use):
        kind = types.get(topic, "*")
        self.kinds[direction + " " + topic] = kind
        found = None if kind == "*" else roslib.message.get_message_class(kind)
        if found is not None:
            use(topic, found)

    def _feed(self, topic, kind):
        self._publishers[topic] = rospy.Publisher(topic, kind, queue_size=10)

    def _called(self, name):
        found = roslib.message.get_service_class(self.services[name] or "")
        if found is None:
            return "?"
        try:
            rospy.wait_for_service(name, timeout=3)
            return self._plain(rospy.ServiceProxy(name, found)(filled(found._request_class, 1)))
        except (rospy.ROSException, rospy.ServiceException, genpy.MessageException) as error:
            return {"exception": type(error).__name__}

    @staticmethod
    def _theirs(nodes):
        return any(node not in OWN for node in nodes)
