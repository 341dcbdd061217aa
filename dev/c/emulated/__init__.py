"""An emulated aarch64 computer, to test compiled applications on a foreign processor: Python and C under qemu-user.

`python -m dev.c.emulated FOLDER` makes its root folder: Debian's Python for arm64, its headers and libraries,
and the packages that cfepy needs. The tests find it through CFEPY_AARCH64_ROOT.
"""
