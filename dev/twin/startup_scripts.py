"""`python -m dev.twin.startup_scripts`: boots random startup scripts on NASA's cFE and on cfepy, and compares the logs.

The scripts have bad lines: missing, extra and too long parts, unknown types, two of one name, numbers in odd bases and
out of range, and ends that are missing. The program compares the lines of Executive Services in the system log.
CFEPY_REAL_CFE names the folder of NASA's core-cpu1, with the lab applications in its cf. cfepy runs the release that
the executable names, or `--release`.
"""

from __future__ import annotations

import argparse
import json
import lzma
import re
import sys
import tempfile
from pathlib import Path
from random import Random

from cfepy.config.versions import RELEASES
from cfepy.mission import Mission
from cfepy.writing.console import Console
from dev.twin.real import VARIABLE, RealCfe, installed, release_of
from dev.twin.recorded import of_release

PROGRAMS = (("CFE_LIB", "sample_lib", "SAMPLE_LIB_Init", "SAMPLE_LIB"),
            ("CFE_APP", "sample_app", "SAMPLE_APP_Main", "SAMPLE_APP"),
            ("CFE_APP", "ci_lab", "CI_LAB_AppMain", "CI_LAB"),
            ("CFE_APP", "to_lab", "TO_LAB_AppMain", "TO_LAB"))  # fmt: skip
"""Type, file, entry and name of what both sides have. Only the first three parts of one belong together."""
FIRST = "CFE_LIB, sample_lib, SAMPLE_LIB_Init, FIRST_LIB, 0, 0, 0x0, 0;\n"
"""The first line of each script, because NASA's SAMPLE_APP cannot be loaded without its library."""
TYPES = ("CFE_APP", "CFE_LIB", "cfe_app", "CFE_APPS", "CFE_FOO", "", "CFE APP", "0")
FILES = ("/cf/{}.so", "{}.so", "none.o", "/cf/{}", "{}", "/cf//{}.so", "/cf/./{}.so", "../{}.so", "none", "",
         "/cf/none.so", "/nowhere/{}.so", "n" * 15, "n" * 16, "n" * 20, "/", "/cf/", ".so",
         "/cf/" + "p" * 70)  # fmt: skip
ENTRIES = ("No_Such_Symbol", "", "N" * 19, "N" * 20, "N" * 30)
NAMES = ("A", "SAME", "SAME", "N" * 19, "N" * 20, "N" * 25, "", "CFE_ES", "with/slash")
NUMBERS = ("50", "0", "255", "256", "-1", "0x32", "0X32", "062", "08", "0x", "+7", "--7", "abc", "50abc", "1e2", "3.9",
           "99999999999999999999", "", "4294967296", "4294967346")  # fmt: skip
STACKS = ("16384", "8192", "0x4000", "040000", "32768", "16384abc")
ENDS = (";", ";", ";", ";", ";;", " ;\n", "; ", "\n;", "")
SAID = re.compile(r"CFE_ES_(?:ParseFileEntry|StartApplications|LoadModule|AppCreate|LoadLibrary|StartAppTask)\w*:.*")
"""What is compared. OS_ModuleLoad and OS_SymbolLookup are in docs/reference/differences.md."""
DONE = b"CFE_ES_Main: CFE_ES_Main entering OPERATIONAL state"
LIMIT_S = 90


def write_script(seed: int) -> bytes:
    """Return the bytes of a startup script."""
    random = Random(seed)
    text = FIRST + "".join(_line(random) for _ in range(random.randint(3, 9)))
    if random.random() < 0.8:
        text += random.choice(("!", "! CFE_APP, late, late, LATE, 50, 16384, 0x0, 0;", "\n!\n"))
    return text.encode("latin-1")


def _line(random: Random) -> str:
    kind, file, entry, name = random.choice(PROGRAMS)
    parts = [kind, file, entry, name, "50", "16384", "0x0", "0"]
    for _ in range(random.choice((0, 1, 1, 2))):
        which = random.randrange(8)
        if which == 1:
            parts[1] = random.choice(FILES).format(file)
        else:
            parts[which] = random.choice((TYPES, (), ENTRIES, NAMES, NUMBERS, STACKS, NUMBERS, NUMBERS)[which])
    if parts[0] in ("CFE_APP", "CFE_LIB") and parts[0] != kind:
        parts[2] = ENTRIES[0]  # a main function is no library's, and returns nothing
    change = random.random()
    if change < 0.06:
        del parts[random.randrange(1, 8) :]
    elif change < 0.12:
        parts.append(random.choice(("", "extra", "0")))
    elif change < 0.17:
        parts[7] += "0" * random.choice((60, 80, 100))
    blank = random.choice((" ", "", "  ", "\t", "\n ", "\r\n"))
    begin = random.choice(("", "", "", "# remark\n", "\x01", "\xe9", "\n\n"))
    return begin + f",{blank}".join(parts) + random.choice(ENDS) + random.choice(("\n", "\n", "", " comment\n"))


def said(console: str) -> list[str]:
    """Return the lines of the system log about the startup script."""
    lines = (SAID.search(line) for line in console.splitlines())
    return [re.sub(r"Tick \d+|0x[0-9A-F]{6,}", "NUMBER", found[0]).rstrip() for found in lines if found]


def play_real(built: Path, script: bytes) -> list[str]:
    """Boot a script on NASA's cFE."""
    files = {"/cf/cfe_es_startup.scr": script}
    with tempfile.TemporaryDirectory() as folder, RealCfe(built, Path(folder), files) as real:
        real.wait(lambda: DONE in real.console(), "operational state", LIMIT_S)
        return said(real.console().partition(DONE)[0].decode("latin-1"))


def play(script: bytes, release: str) -> list[str]:
    """Boot a script on cfepy, with a release of cFE such as "7.0.1"."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "startup.scr").write_bytes(script)
        Path(folder, "mission.yaml").write_text(f'cfe_version: "{release}"\n', encoding="utf-8")
        with Mission(folder, console=Console(quiet=True)) as mission:
            while mission.booted is None and mission.kernel.now < LIMIT_S * 10**9:
                mission.run_for(0.1)
            return said("\n".join(mission.console.lines).partition(DONE.decode())[0])


def load(release: str) -> list[tuple[bytes, list[str]]]:
    """Return the recorded scripts, with the lines of NASA's cFE of a release."""
    rows = json.loads(lzma.decompress(of_release(release, "startup").read_bytes()))
    return [(text.encode("latin-1"), lines) for text, lines in rows]


def main() -> int:
    """Compare. Returns exit status 1 if anything differs."""
    parser = argparse.ArgumentParser(prog="python -m dev.twin.startup_scripts", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of the first script")
    parser.add_argument("--count", type=int, default=60, help="how many scripts, with seeds that count up")
    parser.add_argument(
        "--release", choices=tuple(RELEASES), help="of cfepy; by default the release of NASA's executable"
    )
    parser.add_argument("--record", action="store_true", help="keep the real one's lines for tests without it")
    options = parser.parse_args()
    built = installed()
    if built is None:
        parser.error(f"{VARIABLE} is not a folder with a real cFE")
    release = options.release or release_of(built)
    rows, found = [], 0
    for seed in range(options.seed, options.seed + options.count):
        script = write_script(seed)
        theirs, mine = play_real(built, script), play(script, release)
        rows.append((script.decode("latin-1"), theirs))
        if theirs != mine:
            found += 1
            print(f"seed {seed}: {script!r}", *(f"  cFE   {line}" for line in theirs if line not in mine), sep="\n")
            print(*(f"  cfepy {line}" for line in mine if line not in theirs), sep="\n")
    if options.record:
        data = json.dumps(rows, separators=(",", ":")).encode()
        of_release(release, "startup").write_bytes(lzma.compress(data, preset=9))
    print(f"{len(rows)} scripts on {release}, {found} different")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
