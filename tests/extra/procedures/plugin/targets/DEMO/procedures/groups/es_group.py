import time

from openc3.script.suite import Group


class es_group(Group):
    @requirement("cES1001")
    def test_noop(self):
        Group.print("noop on <%= target_name %>")
        wait_check_packet("<%= target_name %>", "CFE_ES_HK", 1, 20)
        count = tlm("<%= target_name %> CFE_ES_HK COMMAND_COUNTER")
        cmd("<%= target_name %> ES_CMD_NOOP")
        wait_check(f"<%= target_name %> CFE_ES_HK COMMAND_COUNTER == {count + 1}", 20)

    @requirement("cES1002")
    def test_processor_reset(self):
        cmd_no_hazardous_check("<%= target_name %> ES_CMD_RESTART with RESTART_TYPE PROCESSOR")
        time.sleep(2)
        cmd("<%= target_name %> TO_LAB_CMD_ENABLE_OUTPUT with DEST_IP '<%= demo_output_ip %>'")
        wait_check_packet("<%= target_name %>", "CFE_ES_HK", 1, 20)
        check("<%= target_name %> CFE_ES_HK NIBBLE_1 == 0")

    def test_skipped(self):
        raise SkipScript("not here")

    @requirement("cES1003")
    def test_wrong(self):
        wait_check("<%= target_name %> CFE_ES_HK COMMAND_ERROR_COUNTER == 9", 1)

    def setup(self):
        cmd("<%= target_name %> CFE_EVS_CMD_ENABLE_EVENT_TYPE with BIT_MASK DEBUG")
