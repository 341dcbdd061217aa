"""Hypothesis strategies for flight software: ROS messages, packets, tables, schedules, faults.

@given(message=messages("std_msgs/String"), schedule=schedules())
def test_it(mission, message, schedule): ...
"""

from __future__ import annotations

from cfepy.testing.message_strategies import messages
from cfepy.testing.packet_strategies import packets, tables
from cfepy.testing.run_strategies import fault_plans, schedules

__all__ = ["fault_plans", "messages", "packets", "schedules", "tables"]
