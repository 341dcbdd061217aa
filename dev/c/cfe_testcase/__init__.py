"""NASA's functional tests of cFE, cfe_testcase and cfe_assert, as a cFS build makes them, flown here.

`python -m dev.c.cfe_testcase FOLDER` flies them, from a folder with the shared objects and table files of a cFS build
(`exe/cpu1/cf`); nothing of NASA's is part of this repository. `nasa.txt` has the counts of NASA's own run.
"""
