"""curses in a node: the standard library's package on the virtual terminal."""

from __future__ import annotations

SCREEN = """
import curses, time

def main(screen):
{body}

curses.wrapper(main)
"""


def program_of(*lines: str) -> str:
    """Return a program that executes lines with a screen."""
    return SCREEN.format(body="\n".join(f"    {line}" for line in lines))


def test_refreshed_text_is_printed_once(run):
    source = program_of(
        "screen.addstr(2, 3, 'speed %d' % 1, curses.A_BOLD)",
        "screen.refresh()",
        "screen.addstr(2, 3, 'speed %d' % 2)",
        "screen.addstr(4, 0, 'same')",
        "screen.refresh()",
        "screen.refresh()",
        "print(screen.getmaxyx(), screen.getyx(), screen.instr(2, 3, 7))",
    )
    assert run(source, keys=[]).lines == ["   speed 1", "   speed 2", "same", "(24, 80) (4, 4) b'speed 2'"]


def test_arrows_and_plain_keys(run):
    source = program_of(
        "keys = [screen.getch() for _ in range(4)]",
        "print(keys == [curses.KEY_UP, curses.KEY_UP, curses.KEY_F1, ord('q')], *[screen.getkey() for _ in range(3)])",
    )
    keys = ["\x1bOA", "\x1b[A", "\x1bOP", "q", "x", "\x1b[D", "\x1b[15~"]
    assert run(source, keys=keys).lines == ["True x KEY_LEFT KEY_F(5)"]


def test_single_escape_is_a_key(run):
    source = program_of("print([screen.getch() for _ in range(2)])")
    assert run(source, keys=["\x1b", "["]).lines == [f"[27, {ord('[')}]"]


def test_without_a_key(run):
    source = program_of(
        "screen.nodelay(True)",
        "print(screen.getch())",
        "screen.timeout(500)",
        "print(screen.getch(), round(time.monotonic(), 2))",
        "curses.halfdelay(2)",
        "screen.nodelay(False)",
        "print(screen.getch(), round(time.monotonic(), 2))",
        "try:",
        "    screen.getkey()",
        "except curses.error as error:",
        "    print(error)",
    )
    assert run(source, keys=[]).lines == ["-1", "-1 0.5", "-1 0.7", "no input"]


def test_windows_cover_the_screen(run):
    source = program_of(
        "screen.addstr(0, 0, 'under')",
        "screen.noutrefresh()",
        "window = curses.newwin(3, 6, 0, 10)",
        "window.box()",
        "window.addstr(1, 1, 'over')",
        "window.noutrefresh()",
        "curses.doupdate()",
    )
    assert run(source, keys=[]).lines == ["under     +----+", "          |over|", "          +----+"]


def test_write_outside_the_screen_is_an_error(run):
    source = program_of(
        "for place in ((24, 0), (0, 80), (-1, 0)):",
        "    try:",
        "        screen.addstr(*place, 'x')",
        "    except curses.error as error:",
        "        print(error)",
    )
    assert run(source, keys=[]).lines == ["wmove() returned ERR"] * 3


def test_ctrl_c_leaves_the_wrapper(run):
    program = run(program_of("time.sleep(10)") + "print('not here')", keys=["\x03"])
    assert program.lines[-1] == "KeyboardInterrupt"
    assert program.universe.exit_status == 130


def test_curses_without_a_terminal_is_an_error(run):
    program = run(program_of("print('not here')"))
    assert program.lines[-1] == "_curses.error: could not find terminal"
