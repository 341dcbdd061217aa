"""What can go wrong in the kernel itself."""

from __future__ import annotations


class DeadlockError(RuntimeError):
    """No task can ever go on: nobody is ready and no deadline is left. The text says who waits for what."""
