"""diagnostic_updater for nodes: what a node says about its health on /diagnostics.

Names, arguments and texts are those of ROS's diagnostic_updater 1.11; the code is cfepy's own, on top of `rospy`. What
a star import brings is the same too, `rospy` and `threading` included.
"""

from __future__ import annotations

import threading

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from ._diagnostic_status_wrapper import ERROR, OK, WARN, DiagnosticStatusWrapper
from ._diagnostic_updater import (
    CompositeDiagnosticTask,
    DiagnosticTask,
    DiagnosticTaskVector,
    FunctionDiagnosticTask,
    Updater,
)
from ._publisher import DiagnosedPublisher, HeaderlessTopicDiagnostic, TopicDiagnostic
from ._update_functions import FrequencyStatus, FrequencyStatusParam, Heartbeat, TimeStampStatus, TimeStampStatusParam

__all__ = [
    "ERROR",
    "OK",
    "WARN",
    "CompositeDiagnosticTask",
    "DiagnosedPublisher",
    "DiagnosticArray",
    "DiagnosticStatus",
    "DiagnosticStatusWrapper",
    "DiagnosticTask",
    "DiagnosticTaskVector",
    "FrequencyStatus",
    "FrequencyStatusParam",
    "FunctionDiagnosticTask",
    "HeaderlessTopicDiagnostic",
    "Heartbeat",
    "KeyValue",
    "TimeStampStatus",
    "TimeStampStatusParam",
    "TopicDiagnostic",
    "Updater",
    "rospy",
    "threading",
]
