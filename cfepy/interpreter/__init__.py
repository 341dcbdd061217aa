"""Services of Python and of the host process: signals, child processes, garbage collection, sources, lazy names.

Code that could serve any program belongs here. The host's clock and threads are in `cfepy.rtos`. The central file is
`cfepy/interpreter/host_system.py`.
"""
