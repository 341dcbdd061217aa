"""The command that writes sources, as genmsg_py.py and gensrv_py.py run it."""

from __future__ import annotations

import os
import sys
from argparse import ArgumentParser
from typing import Any

from genmsg import InvalidMsgSpec, MsgGenerationException
from genmsg.command_line import includepath_to_dict

from .generate_initpy import write_modules


def genmain(argv: list[str], progname: str, gen: Any) -> None:
    """Run the command and exit.

    Args:
        argv: its arguments, the program itself first.
        progname: its name.
        gen: a `generator.MsgGenerator` or `SrvGenerator`.
    """
    parser = ArgumentParser(prog=progname)
    parser.add_argument("--initpy", action="store_true", help="write the __init__.py of a folder of sources")
    parser.add_argument("-p", dest="package", help="the package")
    parser.add_argument("-o", dest="outdir", required=True, help="folder that is written to")
    parser.add_argument("-I", dest="includepath", action="append", help="package:folder of definitions")
    parser.add_argument("files", nargs="*")
    options = parser.parse_args(argv[1:])
    try:
        if options.initpy:
            code = write_modules(options.outdir)
        else:
            os.makedirs(options.outdir, exist_ok=True)
            search_path = includepath_to_dict(options.includepath)
            code = gen.generate_messages(options.package, options.files, options.outdir, search_path)
    except (InvalidMsgSpec, MsgGenerationException) as error:
        print("ERROR: ", error, file=sys.stderr)
        code = 1 if isinstance(error, InvalidMsgSpec) else 2
    sys.exit(code)
