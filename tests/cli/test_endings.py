"""How the command ends on request: Ctrl-C from its first import to its last step, SIGHUP, a closed terminal."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.cli.watched_host import Interrupts
from cfepy.ground.bag import BagReader
from cfepy.interpreter import early_end
from cfepy.interpreter.host_system import interrupt_once
from cfepy.journal import read_journal
from cfepy.mission.run_pieces import HeldBack
from cfepy.reading.resources import import_path

pytestmark = pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="signals are those of POSIX")

COMMAND = """
import importlib.abc, os, signal, sys

class Interrupting(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == {when!r}:
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Interrupting())
sys.argv = ["/usr/bin/cfepy", *{words!r}]
{before}
from cfepy.cli.main import process
{after}
sys.exit(process())
"""


def ended(words: Sequence[str], when: str = "", before: str = "", after: str = "") -> subprocess.CompletedProcess[str]:
    """Run the command in a separate process, with Ctrl-C when a module is imported."""
    return subprocess.run(
        [sys.executable, "-c", COMMAND.format(words=list(words), when=when, before=before, after=after)],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": import_path()},
        check=False,
    )


@pytest.mark.parametrize(
    "when",
    ["cfepy.interpreter.faces", "cfepy.cli", "cfepy.cli.options", "cfepy.cli.board", "cfepy.cli.board.board_list"],
)
def test_ctrl_c_during_the_first_imports_ends_it_without_a_traceback(when: str) -> None:
    done = ended(["board", "list"], when)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")


def test_ctrl_c_while_a_command_imports_more_ends_it_without_a_traceback() -> None:
    body = "from cfepy.cli.board import board_list; board_list.run = lambda chosen: __import__('wave')"
    done = ended(["board", "list"], "wave", after=body)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")


def test_ctrl_c_in_its_last_steps_ends_it_without_a_traceback() -> None:
    done = ended(["--version"], before="import atexit; atexit.register(os.kill, os.getpid(), signal.SIGINT)")
    assert (done.returncode, done.stderr) == (130, "")
    assert done.stdout.startswith("cfepy ")


def test_ctrl_c_that_comes_up_in_a_finalizer_is_not_lost() -> None:
    body = """
from cfepy.cli.board import board_list

class Dying:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)

def run(chosen):
    import time
    Dying()
    time.sleep(60)
    return 0

board_list.run = run
"""
    done = ended(["board", "list"], after=body)
    assert (done.returncode, done.stderr) == (130, "")


def test_a_traceback_has_no_control_characters() -> None:
    body = "from cfepy.cli.board import board_list\n"
    body += "def run(chosen): raise RuntimeError(chr(27) + ']0;title')\nboard_list.run = run"
    done = ended(["board", "list"], after=body)
    assert done.returncode == 1
    assert r"RuntimeError: \x1b]0;title" in done.stderr


def test_a_program_that_imports_cfepy_keeps_its_answer_to_ctrl_c() -> None:
    text = "import signal, cfepy; print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"
    assert (
        subprocess.check_output([sys.executable, "-c", text], env={**os.environ, "PYTHONPATH": import_path()})
        == b"True\n"
    )


@pytest.mark.parametrize(
    ("argv", "orig", "is_it"),
    [
        (["/x/bin/cfepy", "run"], ["python", "/x/bin/cfepy", "run"], True),
        ([r"cfepy.exe"], ["python", "cfepy.exe"], True),
        (["-m"], ["python", "-X", "dev", "-m", "cfepy", "run"], True),
        (["-m"], ["python", "-mcfepy"], True),
        (["-m"], ["python", "-m", "pytest", "cfepy"], False),
        (["-m", "cfepy"], ["python", "-m", "cfepy.extra.exploration.worker", "cfepy"], False),
        (["my_cfepy.py"], ["python", "my_cfepy.py"], False),
        ([], ["python"], False),
    ],
)
def test_the_command_is_known_by_its_name(
    argv: list[str], orig: list[str], is_it: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "argv", argv)
    monkeypatch.setattr(sys, "orig_argv", orig)
    assert early_end.is_command() is is_it


def test_main_puts_the_answers_to_signals_back() -> None:
    signals = signal.SIGINT, signal.SIGTERM, signal.SIGHUP
    before = [signal.getsignal(each) for each in signals]
    main(["board", "list"])
    assert [signal.getsignal(each) for each in signals] == before


# -- SIGHUP ------------------------------------------------------------------------------------------------------------


def flying(folder: Path) -> tuple[subprocess.Popen[str], Path, Path]:
    """Return a run that has begun, its bag and its journal."""
    bag, journal = folder / "run.bag", folder / "run.cfepy"
    process = started("--for", "100000", "--bag", str(bag), "--record", str(journal))
    read_to(process, "phase approach")
    return process, bag, journal


def started(*options: str, below: Sequence[str] = ()) -> subprocess.Popen[str]:
    """Return a run of capture, its output in pipes."""
    words = [*below, sys.executable, "-u", "-m", "cfepy", "run", "capture", *options]  # each line is seen at once
    return subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def read_to(process: subprocess.Popen[str], text: str) -> None:
    """Read its output up to a text."""
    assert process.stdout is not None
    while text not in process.stdout.readline():
        assert process.poll() is None


def assert_whole(bag: Path, journal: Path) -> None:
    """Assert that both are complete, as they are after Ctrl-C."""
    with BagReader(str(bag)) as reader:
        assert sum(1 for _ in reader.messages())
    end = read_journal(journal).end
    assert end is not None
    assert end.trace


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 3])
def test_sighup_finishes_bag_and_journal(tmp_path: Path, count: int) -> None:
    process, bag, journal = flying(tmp_path)
    for _ in range(count):
        process.send_signal(signal.SIGHUP)
    out, err = process.communicate()
    assert process.returncode == 130
    assert out.splitlines()[-2].startswith("trace: ")
    assert "Traceback" not in err
    assert_whole(bag, journal)


@pytest.mark.slow
def test_sighup_is_ignored_below_nohup() -> None:
    process = started("--for", "100000", below=["nohup"])
    read_to(process, "phase approach")
    process.send_signal(signal.SIGHUP)
    read_to(process, "phase grasp")
    process.send_signal(signal.SIGTERM)
    process.communicate()
    assert process.returncode == 130


@pytest.mark.slow
def test_a_terminal_that_is_closed_finishes_bag_and_journal(tmp_path: Path) -> None:
    pty = pytest.importorskip("pty")
    bag, journal, saved = tmp_path / "run.bag", tmp_path / "run.cfepy", tmp_path / "saved"
    words = [
        "run",
        "capture",
        "--for",
        "100000",
        "--bag",
        str(bag),
        "--record",
        str(journal),
        "--save-files",
        str(saved),
    ]
    child, terminal = pty.fork()
    if not child:
        os.execv(sys.executable, [sys.executable, "-m", "cfepy", *words])
    shown = b""
    while b"phase approach" not in shown:
        shown += os.read(terminal, 1 << 16)
    os.close(terminal)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 130
    assert_whole(bag, journal)
    assert saved.is_dir()


@pytest.mark.slow
def test_a_reader_that_went_away_leaves_a_whole_journal(tmp_path: Path) -> None:
    process, bag, journal = flying(tmp_path)
    assert process.stdout is not None
    process.stdout.close()
    assert process.wait() == 0
    assert_whole(bag, journal)


@pytest.fixture
def _sighup_is_not_ignored() -> Iterator[None]:
    """Enable the signal, which is ignored if the tests run under nohup."""
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    yield
    signal.signal(signal.SIGHUP, before)


@pytest.mark.usefixtures("_sighup_is_not_ignored")
def test_sighup_counts_once_and_another_signal_raises() -> None:
    before = signal.getsignal(signal.SIGHUP)
    with Interrupts() as interrupts:
        signal.raise_signal(signal.SIGHUP)
        signal.raise_signal(signal.SIGHUP)
        assert interrupts.asked
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGHUP) is before


def test_sighup_is_held_back_until_a_piece_is_over() -> None:
    before = signal.signal(signal.SIGHUP, interrupt_once)
    done: list[str] = []

    def piece() -> None:
        with HeldBack():
            signal.raise_signal(signal.SIGHUP)
            signal.raise_signal(signal.SIGHUP)
            done.append("whole")

    try:
        with pytest.raises(KeyboardInterrupt):
            piece()
        signal.raise_signal(signal.SIGHUP)  # which comes once more when the shell ends
    finally:
        signal.signal(signal.SIGHUP, before)
    assert done == ["whole"]
