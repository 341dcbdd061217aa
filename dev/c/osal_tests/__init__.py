"""OSAL's own tests, functional ones and those of its interface, compiled from NASA's sources and flown here.

`python -m dev.c.osal_tests SOURCES` builds and flies them; nothing of NASA's is part of this repository.
"""
