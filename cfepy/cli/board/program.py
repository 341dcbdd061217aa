"""`cfepy board program`: write the application of cFS, in C, that takes the three measurements of `cfepy board new`."""

from __future__ import annotations

import argparse
import os
import shutil

from cfepy.cli.main import ENDED_WELL
from cfepy.cli.user_notes import writing
from cfepy.reading.resources import shipped
from cfepy.status import UsageError

NAME = "board_times"
LINE = "CFE_APP, board_times, BOARD_TIMES_Main, BOARD_TIMES, 50, 16384, 0x0, 0;"


def run(arguments: argparse.Namespace) -> int:
    """Write the folder of the application.

    Returns:
        The exit status.

    Raises:
        UsageError: the folder exists already, or it cannot be written.
    """
    folder = arguments.folder
    if os.path.lexists(folder):
        raise UsageError("already exists; give another name", file=folder)
    with writing(folder, "FOLDER"):
        shutil.copytree(shipped("boards") / NAME, folder)
    print(f"{folder}: an application of a cFS mission; its folder there is apps/{NAME}, its line in the startup script")
    print(f"  {LINE}")
    return ENDED_WELL
