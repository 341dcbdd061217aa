"""The keyboard of a node: keys at virtual times, cooked, cbreak and raw mode, Ctrl-C, and reading them."""

from __future__ import annotations

import pytest


def test_input_reads_lines_as_they_are_typed(run):
    program = run(
        """
        import sys, time
        print(input("name? "), time.monotonic())
        print(repr(sys.stdin.readline()), round(time.monotonic(), 3))
        print([line for line in sys.stdin], sys.stdin.isatty())
        """,
        keys=["bob\n", 1.0, "two\r", "three\nfo\x04ur\n", "\x04"],
        call_cost_ns=0,
    )
    assert program.lines == ["name? bob 0.1", "'two\\n' 1.2", "['three\\n', 'four\\n'] True"]


def test_line_can_be_corrected_before_it_is_read(run):
    program = run("print(input(), input())", keys=["abx\x7fc\n", "wrong\x15right\n"])
    assert program.lines == ["abc right"]


def test_an_end_of_file_ends_input(run):
    program = run(
        """
        try:
            input()
        except EOFError as error:
            print(error)
        """,
        keys=["\x04"],
    )
    assert program.lines == ["EOF when reading a line"]


KEY_LOOP = """
import select, sys, termios, tty
settings = termios.tcgetattr(sys.stdin)

def get_key():
    tty.{mode}(sys.stdin.fileno())
    ready, _, _ = select.select([sys.stdin], [], [], 0.3)
    key = sys.stdin.read(1) if ready else ""
    termios.tcsetattr(sys.stdin, termios.TCSADRAIN, settings)
    return key
"""


def test_the_loop_of_a_keyboard_teleop(run):
    body = 'keys = []\nwhile "\\x03" not in keys:\n    keys.append(get_key())\nprint(keys)\n'
    program = run(KEY_LOOP.format(mode="setraw") + body, keys=["w", "a", 0.8, "\x03"])
    assert program.lines == ["['w', 'a', '', '', '\\x03']"]


def test_ctrl_c_is_a_signal_in_cbreak_mode(run):
    body = """
try:
    while True:
        print(repr(get_key()))
except KeyboardInterrupt:
    print("interrupted")
"""
    program = run(KEY_LOOP.format(mode="setcbreak") + body, keys=["w", "\x03"])
    assert program.lines == ["'w'", "interrupted"]


def test_keys_typed_in_cooked_mode_can_be_read_in_raw_mode(run):
    source = """
        import os, sys, time, tty
        time.sleep(0.15)
        tty.setraw(0)
        print(os.read(0, 10))
        """
    assert run(source, keys=["ab"]).lines == ["b'ab'"]


def test_reading_without_waiting(run):
    program = run(
        """
        import fcntl, os, sys, time, termios, tty
        tty.setcbreak(sys.stdin)
        flags = fcntl.fcntl(0, fcntl.F_GETFL)
        fcntl.fcntl(sys.stdin, fcntl.F_SETFL, flags | os.O_NONBLOCK)
        try:
            sys.stdin.read(1)
        except BlockingIOError as error:
            print(error.errno)
        fcntl.fcntl(0, fcntl.F_SETFL, flags)
        settings = termios.tcgetattr(0)
        settings[6][termios.VMIN], settings[6][termios.VTIME] = 0, 2
        termios.tcsetattr(0, termios.TCSANOW, settings)
        print(os.read(0, 1), time.monotonic())
        """,
        keys=[1.0, "x"],
        call_cost_ns=0,
    )
    assert program.lines == ["11", "b'' 0.2"]


def test_password_is_typed_with_keys(run):
    program = run("import getpass\nprint(getpass.getpass('secret: '))", keys=["x\n"])
    assert program.lines[-1] == "x"


def test_terminal_of_the_host_is_inaccessible(run):
    source = """
        import os
        for opens in (open, lambda path: os.open(path, os.O_RDWR)):
            try:
                opens("/dev/tty")
            except OSError as error:
                print(error)
        """
    assert run(source).lines == ["[Errno 6] No such device or address: '/dev/tty'"] * 2


def test_flush_discards_keys(run):
    program = run(
        """
        import sys, termios, time, tty
        tty.setcbreak(sys.stdin)
        time.sleep(0.15)
        termios.tcflush(sys.stdin, termios.TCIFLUSH)
        print(sys.stdin.read(1))
        """,
        keys=["a", "b"],
    )
    assert program.lines == ["b"]


def test_size_and_names_of_the_terminal(run):
    program = run(
        """
        import fcntl, os, shutil, struct, sys, termios
        print(shutil.get_terminal_size(), os.isatty(0), os.isatty(1))
        print(struct.unpack("HHHH", fcntl.ioctl(0, termios.TIOCGWINSZ, b"x" * 8))[:2])
        print(repr(sys.stdin))
        """,
        keys=[],
        env={},
    )
    assert program.lines == [
        "os.terminal_size(columns=80, lines=24) True True",
        "(24, 80)",
        "<_io.TextIOWrapper name='<stdin>' mode='r' encoding='utf-8'>",
    ]


def test_node_without_keys_has_no_terminal(run):
    program = run(
        """
        import os, sys, termios
        print(sys.stdin.isatty(), os.isatty(0), repr(sys.stdin.read()), os.read(0, 5), sys.stdin.buffer.read())
        try:
            termios.tcgetattr(sys.stdin)
        except termios.error as error:
            print(error)
        """
    )
    assert program.lines == ["False False '' b'' b''", "(25, 'Inappropriate ioctl for device')"]


@pytest.mark.parametrize(
    ("wait", "where"),
    [
        ("time.sleep(10)", "a sleep"),
        ("threading.Event().wait()", "an event"),
        ("queue.Queue().get()", "a queue"),
        ("thread.join()", "a thread"),
    ],
)
def test_ctrl_c_ends_the_wait_of_the_main_thread(run, wait, where):
    program = run(
        f"""
        import os, queue, threading, time
        thread = threading.Thread(target=time.sleep, args=(10,))
        thread.start()
        try:
            {wait}
        except KeyboardInterrupt:
            print("interrupted", round(time.monotonic(), 1))
        os._exit(3)
        """,
        keys=[0.9, "\x03"],
    )
    assert program.lines == ["interrupted 1.0"], where
    assert program.universe.exit_status == 3


def test_uncaught_ctrl_c_has_the_traceback_of_python(run):
    program = run("import time\ntime.sleep(10)", keys=["\x03"])
    assert program.lines[0] == "Traceback (most recent call last):"
    assert program.lines[-1] == "KeyboardInterrupt"
    assert program.universe.exit_status == 130
    assert program.kernel.now < 200_000_000


def test_handler_of_the_node_gets_ctrl_c(run):
    program = run(
        """
        import signal, sys, time
        def stop(number, frame):
            print("signal", number)
            sys.exit(4)
        signal.signal(signal.SIGINT, stop)
        time.sleep(10)
        """,
        keys=["\x03"],
    )
    assert program.lines == ["signal 2"]
    assert program.universe.exit_status == 4
