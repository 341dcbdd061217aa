"""Files, streams and sockets of POSIX for compiled code: the descriptors of a processor and the objects behind them.

An object here knows Linux's behaviour and its errors, which it raises as `OSError`. `cfepy.extra.c.api` declares the
functions of C. Files are in OSAL's file system, and sockets on the mission's network.
"""
