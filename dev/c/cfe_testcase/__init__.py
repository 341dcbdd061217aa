"""NASA's functional tests of cFE, cfe_testcase and cfe_assert, as a cFS build makes them, flown on cfepy.

`python -m dev.c.cfe_testcase FOLDER` flies them from a folder with the shared objects and table files of a cFS build
(`exe/cpu1/cf`). This repository contains none of NASA's files. `nasa.txt` has the counts of NASA's own run.
"""
