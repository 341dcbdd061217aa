"""diagnostic_updater for nodes: reports of a node's health on /diagnostics.

Names, arguments and texts match ROS's diagnostic_updater 1.11; the code is cfepy's own, on top of `rospy`. A
star import provides the same names, including `rospy` and `threading`.
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
