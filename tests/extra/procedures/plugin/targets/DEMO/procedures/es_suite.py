from openc3.script.suite import Suite

load_utility("<%= target_name %>/procedures/groups/es_group.py")


class demo_suite(Suite):
    def __init__(self):
        self.add_group(es_group)

    def setup(self):
        cmd("<%= target_name %> TO_LAB_CMD_ENABLE_OUTPUT with DEST_IP '<%= demo_output_ip %>'")

    def teardown(self):
        set_requirement_status("cES1009", "I", "read the console")
