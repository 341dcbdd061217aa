"""Functions of cFE as compiled applications call them, with good and with bad arguments.

Each C file is an application that writes what calls answer into the system log. The text beside it is what it wrote on
NASA's cFE 7.0.0 on Linux: `python -m dev.c.api` flies them there and writes the texts. `tests/extra/c/test_api.py`
flies them here.
"""
