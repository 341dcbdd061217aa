"""Runs in processes of their own whose records are compared while they are made."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import IO, Any

from cfepy.cli.recorded_run import Plan
from cfepy.mission.determinism import RecordReader, RunEndedError
from cfepy.resources import import_path
from cfepy.status import UsageError


@dataclass(frozen=True, slots=True)
class RunInProcess:
    """A run in its process: what reads its records, and what it said beside them."""

    process: subprocess.Popen[bytes]
    reader: RecordReader
    said: IO[bytes]


@contextlib.contextmanager
def started(plan: Plan, hash_seed: int | None = None) -> Iterator[RunInProcess]:
    """Around a run that is compared.

    Args:
        plan: what to run; its pipe is made here.
        hash_seed: PYTHONHASHSEED of the process; None for that of this one.
    """
    out, into = os.pipe()
    command = [sys.executable, "-m", "cfepy.cli.recorded_run", dataclasses.replace(plan, pipe=into).to_json()]
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile() as said, open(out, "rb") as pipe:
        environment = {**os.environ, "PYTHONPATH": import_path()}
        if plan.journal is not None:  # it is killed in the end: what it unpacks goes with the folder
            environment["TMPDIR"] = folder
        if hash_seed is not None:
            environment["PYTHONHASHSEED"] = str(hash_seed)
        process = subprocess.Popen(command, pass_fds=[into], env=environment, stdout=said, stderr=said)
        os.close(into)
        try:
            yield RunInProcess(process, RecordReader(pipe), said)
        finally:
            process.kill()
            process.wait()


def facts_of(run: RunInProcess) -> dict[str, Any]:
    """What a run has to say that looks at one record.

    Raises:
        UsageError: it did not come to its end.
    """
    try:
        run.reader.fill()
    except RunEndedError:
        raise failure([run]) from None
    return run.reader.facts or {}


def failure(runs: Sequence[RunInProcess]) -> UsageError:
    """Why a run did not come to its end."""
    for run in runs:
        if run.process.poll() is None and run.reader.facts is None:
            with contextlib.suppress(subprocess.TimeoutExpired):
                run.process.wait(1)
        if run.process.poll():
            run.said.seek(0)
            text = run.said.read().decode("utf-8", "replace").strip()
            return UsageError(text or f"a run ended with status {run.process.returncode}")
    return UsageError("a run ended in the middle")
