"""Files for or from a flight computer: table files, and the logs and registries that cFE dumps.

Code that reads, writes, checks or shows such a file without a running mission belongs here.
"""
