"""What a test sees when an expectation is not met. Imports nothing."""

from __future__ import annotations


class ExpectationError(AssertionError):
    """Something that a test waited for did not come, or something came that must not.

    The text says what was expected and until when, what there was instead, and the command that does it again.
    """
