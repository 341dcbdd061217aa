"""Signals that shut rclpy down (rclpy.signals)."""

from __future__ import annotations

import signal
from enum import IntFlag

from rclpy import _seam
from rclpy.context import get_default_context


class SignalHandlerOptions(IntFlag):
    """Signals for which rclpy installs a handler."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


_installed: dict[int, object] = {}
"""The handlers before rclpy's, by signal."""


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Let signals shut the default context down. The handler that was set before runs too."""
    wanted = {SignalHandlerOptions.SIGINT: signal.SIGINT, SignalHandlerOptions.SIGTERM: signal.SIGTERM}
    numbers = [number for option, number in wanted.items() if options & option and number not in _installed]
    _installed.update({number: signal.getsignal(number) for number in numbers})
    _seam.program.catch_signals(lambda: get_default_context().shut_down_by_signal(), numbers)


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """Return the signals for which handlers are installed."""
    found = SignalHandlerOptions.NO
    if signal.SIGINT in _installed:
        found |= SignalHandlerOptions.SIGINT
    if signal.SIGTERM in _installed:
        found |= SignalHandlerOptions.SIGTERM
    return found


def uninstall_signal_handlers() -> None:
    """Restore the handlers from before; only the main thread can do this."""
    _seam.program.restore_signals(_installed)
    _installed.clear()
