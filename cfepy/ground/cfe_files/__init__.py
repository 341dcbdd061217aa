"""Files that go to a flight computer or come from it: table files, and the logs and registries that cFE dumps.

What belongs here reads, writes, checks or shows such a file. What needs a mission that flies does not.
"""
