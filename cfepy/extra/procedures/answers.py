"""Answers to questions of procedures, from a file in YAML; a question without an answer is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from cfepy.extra.procedures.procedure_errors import UnsupportedError
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import LINE_FILE_BYTES
from cfepy.reading.plain_yaml import plain_yaml
from cfepy.status import UsageError


class Answers:
    """Answers in order, or by a part of the question.

    Args:
        file: a YAML file with a list of answers, or a mapping from a part of a question to its answer; None for no
            answers.

    Raises:
        UsageError: if the file has neither.
    """

    def __init__(self, file: Path | None = None) -> None:
        given: Any = [] if file is None else plain_yaml(read_limited(file, LINE_FILE_BYTES).decode("utf-8", "replace"))
        if not isinstance(given, list | dict):
            raise UsageError("answers must be a list, or a mapping from questions to answers", file=file)
        self._in_order = list(given) if isinstance(given, list) else []
        self._by_question = dict(given) if isinstance(given, dict) else {}

    def answer(self, question: str) -> Any:
        """Return the answer to a question.

        Raises:
            UnsupportedError: if there is none.
        """
        for part, value in self._by_question.items():
            if str(part).lower() in question.lower():
                return value
        if self._in_order:
            return self._in_order.pop(0)
        raise UnsupportedError(f"no answer to the question {question!r}; give a file with --answers")
