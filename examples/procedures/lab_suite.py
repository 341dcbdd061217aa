"""A suite for the mission lab: its executive services are alive and come back after a processor reset."""

from openc3.script import *
from openc3.script.suite import Group, Suite


class executive_services(Group):
    @requirement("cES1001")
    def test_noop(self):
        wait_check_packet("<%= target_name %>", "CFE_ES_HK", 1, 20)
        count = tlm("<%= target_name %> CFE_ES_HK COMMAND_COUNTER")
        cmd("<%= target_name %> CFE_ES_CMD_NOOP")
        wait_check(f"<%= target_name %> CFE_ES_HK COMMAND_COUNTER == {count + 1}", 20)

    @requirement("cES1002")
    def test_processor_reset(self):
        cmd("<%= target_name %> CFE_ES_CMD_RESTART with RESTART_TYPE 1")
        wait(2)
        enable_output()
        wait_check("<%= target_name %> CFE_ES_HK PROCESSOR_RESETS == 1", 20)

    @requirement("cES1003")
    def test_z_power_on_reset(self):
        cmd("<%= target_name %> CFE_ES_CMD_RESTART with RESTART_TYPE 2")
        wait(2)
        enable_output()
        wait_check_packet("<%= target_name %>", "CFE_ES_HK", 1, 20)
        check("<%= target_name %> CFE_ES_HK PROCESSOR_RESETS == 0")


class lab_suite(Suite):
    def __init__(self):
        self.add_group(executive_services)

    def setup(self):
        enable_output()


def enable_output():
    cmd("<%= target_name %> TO_LAB_OUTPUT_ENABLE with DEST_IP '127.0.0.1'")
    wait_check_packet("<%= target_name %>", "TO_LAB_HK", 1, 20)
