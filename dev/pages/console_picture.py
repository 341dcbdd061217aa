"""A picture of the console on a terminal: `save_console(path)` flies a mission in it and writes an SVG."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from pathlib import Path

from textual.pilot import Pilot

from cfepy.cli.ground.console import Opening
from cfepy.cli.ground.console.screen import ConsoleScreen
from cfepy.cli.main import parser_for
from cfepy.cli.watched_host import Interrupts

POLL_S = 0.01
Use = Callable[[ConsoleScreen, Pilot[None]], Awaitable[None]]
LINES = ("run 2", "CFE_ES_NOOP", "expect event CFE_ES 3", "hk", "page CFE_ES_HK_TLM SAMPLE_APP_HK_TLM", "run 3")


async def idle(screen: ConsoleScreen, pilot: Pilot[None]) -> None:
    """Until all that was typed is done, and shown."""
    while not screen.is_idle and screen.is_running:
        await pilot.pause(POLL_S)
    await pilot.pause()


async def say(screen: ConsoleScreen, pilot: Pilot[None], lines: Sequence[str]) -> None:
    """Enter lines one by one, each when the one before is done."""
    for line in lines:
        screen.enter(line)
        await idle(screen, pilot)


def in_a_console(words: Sequence[str], use: Use, size: tuple[int, int] = (120, 36)) -> Opening:
    """Open a console on an invisible terminal, use it, and end the session.

    Args:
        words: arguments of the command line, after `cfepy console`.
        use: function that uses the console when the mission stands at its beginning.
        size: columns and rows.

    Returns:
        The object that opened it, which has the result of the session.
    """

    async def go() -> None:
        async with screen.run_test(size=size) as pilot:
            await idle(screen, pilot)
            await use(screen, pilot)
            screen.enter("quit")
            while screen.is_running:
                await pilot.pause(POLL_S)
        screen.tell_error()

    with Interrupts() as interrupts:
        opening = Opening(parser_for(["console"]).parse_args(["console", *words]), interrupts)
        screen = ConsoleScreen(opening.session)
        asyncio.run(go())
    return opening


def save_console(
    path: Path, mission: str = "lab", lines: Sequence[str] = LINES, size: tuple[int, int] = (120, 36)
) -> None:
    """Write a picture of the console as SVG.

    Args:
        path: path of the file.
        mission: the mission to fly.
        lines: lines to type.
        size: columns and rows of the terminal.
    """

    async def photograph(screen: ConsoleScreen, pilot: Pilot[None]) -> None:
        await say(screen, pilot, lines)
        path.write_text(screen.export_screenshot(), encoding="utf-8")

    in_a_console([mission], photograph, size)
