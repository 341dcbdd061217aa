"""An aarch64 computer for tests of compiled applications on any other: Python and C under qemu's user emulation.

`python -m dev.c.emulated FOLDER` makes the root folder of one: Debian's Python for arm64, its headers and libraries,
and the packages that cfepy needs. CFEPY_AARCH64_ROOT names it for the tests.
"""
