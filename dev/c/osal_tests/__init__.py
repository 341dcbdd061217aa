"""OSAL's functional tests and coverage of its interface, compiled from NASA's sources and flown on cfepy.

`python -m dev.c.osal_tests SOURCES` builds and flies them. This repository contains none of NASA's files.
"""
