"""How much memory a message takes in C++, as the compiler for a target says: `sizeof`, what it points to left out."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Sequence
from pathlib import Path

from cfepy.c import CompilerError, cpp_compiler
from cfepy.status import UsageError

_SIZE = re.compile(r"^\s*\.size\s+roscfe_size_(\d+),\s*(\d+)", re.MULTILINE)


def sizes_of(types: Sequence[str], includes: Sequence[Path], compiler: Sequence[str] = ()) -> dict[str, int]:
    """Bytes of each type of message.

    In the strict profile this is all that a message takes; in the others its texts and arrays are beside it.

    Args:
        types: full names of messages, e.g. "std_msgs/String".
        includes: folders of headers: those of the messages and of the interface library.
        compiler: command of the target's C++ compiler, e.g. ("arm-linux-gnueabihf-g++",); empty for this computer's.

    Raises:
        CompilerError: a header is missing, or the compiler refused one.
        UsageError: there is no such compiler.
    """
    lines = [f"#include <{name}.h>" for name in types]
    lines += [
        f'extern "C" {{ char roscfe_size_{number}[sizeof({name.replace("/", "::")})]; }}'
        for number, name in enumerate(types)
    ]
    command = [*(compiler or cpp_compiler()), "-std=c++17", "-fno-exceptions", "-fno-rtti"]
    command += [*(f"-I{folder}" for folder in includes), "-S", "-x", "c++", "-", "-o", "-"]
    try:
        done = subprocess.run(command, input="\n".join(lines) + "\n", capture_output=True, text=True, check=False)
    except OSError as error:
        raise UsageError(f"{command[0]} cannot be started: {error.strerror}") from None
    if done.returncode:
        raise CompilerError(done.stderr.rstrip())
    return {types[int(number)]: int(size) for number, size in _SIZE.findall(done.stdout)}
