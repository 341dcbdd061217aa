"""A script for the mission capture: cFE's housekeeping and the joints of the arm in one procedure."""

from openc3.script import *

wait_check_packet("CAPTURE", "CFE_ES_HK", 1, 10)
cmd("CAPTURE CFE_ES_CMD_NOOP")
wait_check("CAPTURE CFE_ES_HK COMMAND_COUNTER == 1", 10)

wait_check_packet("CAPTURE", "JOINT_STATES", 10, 5)
check_tolerance("CAPTURE JOINT_STATES POSITION_0", 0, 3.2)
print("first joint:", tlm("CAPTURE JOINT_STATES POSITION_0"))
