"""What cfepy asks of Python and of the process it runs in: signals, child processes, garbage, sources, lazy names.

What belongs here would serve any program. The clock and the threads of the host do not: `cfepy.rtos` has them. The
central file is `cfepy/interpreter/host_system.py`.
"""
