"""Call functions of cFE from compiled applications, with valid and with invalid arguments.

Each C file is an application that writes the return values into the system log. The text file beside it is the output
on NASA's cFE 7.0.0 on Linux. `python -m dev.c.api` flies the applications there and writes the text files.
`tests/extra/c/test_api.py` flies them on cfepy.
"""
