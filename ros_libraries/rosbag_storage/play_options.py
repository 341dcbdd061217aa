"""The options of `rosbag play`, for the node and for command lines that start it. Imports argparse only."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any, NoReturn


class PlayParser(argparse.ArgumentParser):
    """Parses the words that follow `rosbag play`; see `argparse.ArgumentParser` for the arguments."""

    def __init__(self, **said: Any) -> None:
        super().__init__(**said)
        self.add_argument("given", nargs="*", metavar="BAG")
        for flag, text in (
            ("-q --quiet", "say nothing"),
            ("-i --immediate", "do not wait between messages"),
            ("--pause", "start paused; the service ~pause_playback starts the playback"),
            ("--clock", "tell the bags' time on /clock"),
            ("-l --loop", "begin again at the end"),
            ("-k --keep-alive", "stay when all is played"),
            ("--wait-for-subscribers", "begin when each topic has a subscriber"),
            ("--try-future-version", "without effect"),
        ):
            self.add_argument(*flag.split(), action="store_true", help=text)
        self.add_argument("-p", "--prefix", default="", help="put this before the names of topics")
        self.add_argument("--queue", type=int, default=100, help="length of the publishers' queues (default: 100)")
        self.add_argument("--hz", type=float, default=100.0, help="rate of the clock messages (default: 100)")
        self.add_argument("-d", "--delay", type=float, default=0.2, help="s between advertising and playing")
        self.add_argument("-r", "--rate", type=float, default=1.0, help="so many times as fast")
        self.add_argument("-s", "--start", type=float, default=0.0, help="begin so many s into the bags")
        self.add_argument("-u", "--duration", type=float, help="play so many s only")
        self.add_argument("--skip-empty", type=float, metavar="S", help="leave out gaps of more than so many s")
        self.add_argument("--topics", nargs="+", default=[], help="play these only")
        self.add_argument("--bags", nargs="+", default=[], metavar="BAG", help="the bags, after --topics")

    def parse_play(self, words: Sequence[str]) -> argparse.Namespace:
        """Return the parsed options, with the bags of both kinds in `bags`.

        Args:
            words: without remappings such as /a:=/b.
        """
        options = self.parse_intermixed_args(words)
        options.bags = [*options.given, *options.bags]
        if not options.bags:
            self.error("You must specify at least 1 bag file to play back.")
        if not (options.rate > 0 and options.hz > 0):
            self.error("rate and frequency must be more than 0")
        return options


class CheckedPlayParser(PlayParser):
    """A `PlayParser` that only checks whether the words are valid."""

    def error(self, message: str) -> NoReturn:
        """Raises ValueError, where a parser ends the process."""
        raise ValueError(message)
