"""An interactive script: lines come one at a time while the mission runs.

Each line, and each loaded file, is a separate `ScriptRun`, so it means the same as in a file. They share one scene,
including the time from which expectations count. A line acts at once, even while others are waiting.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from cfepy.mission import MissionSpec
from cfepy.rtos import ENDLESS
from cfepy.script.conditions import Scene
from cfepy.script.script_run import Outcome, ScriptRun, StepVerdict
from cfepy.script.text import Step, parse_script
from cfepy.status import UsageError

Tell = Callable[[Step, StepVerdict], object]
TYPED = "console"
"""Name used in place of a file for typed lines."""


class StandingScript:
    """Steps, one at a time.

    Args:
        scene: objects that they check and act on.
        spec: the mission whose topics they may name; None for another computer.
    """

    def __init__(self, scene: Scene, spec: MissionSpec | None) -> None:
        self.scene = scene
        self._spec = spec
        self._runs: list[ScriptRun] = []

    @property
    def is_waiting(self) -> bool:
        """Whether a line or a file is waiting for an expected condition."""
        return any(run.is_waiting for run in self._runs)

    def add(self, text: str, file: str | Path, tell: Tell, stop_on_failure: bool = False) -> None:
        """Start the steps of a text.

        Args:
            text: a line, or a whole file.
            file: its name, for errors and verdicts.
            tell: receives each step's verdict.
            stop_on_failure: whether a file ends with its first failed step.

        Raises:
            UsageError: if it has a mistake; then nothing of it is executed.
        """
        script = parse_script(text, file, self._spec, self.scene.dictionary)
        if not self.scene.has_mission:
            _check_for_a_computer_elsewhere(script.steps, file)
        run = ScriptRun(script, stop_on_failure, tell, stands=True)
        run.join(self.scene)
        self._runs.append(run)

    def advance(self) -> int:
        """Execute the steps that are due.

        Returns:
            The virtual time in ns at which it wants to be asked again; far in the future when nothing is open.
        """
        wake_ns = min((run.advance() for run in self._runs), default=ENDLESS)
        self._runs = [run for run in self._runs if not run.is_settled]
        return wake_ns

    def give_up(self) -> int:
        """Stop waiting for expected conditions. Unwanted conditions are still watched for.

        Returns:
            How many lines and files were given up.
        """
        waiting = [run for run in self._runs if run.is_waiting]
        self._runs = [run for run in self._runs if not run.is_waiting]
        return len(waiting)

    def end(self) -> list[Outcome]:
        """Decide all open expectations at the end."""
        runs, self._runs = self._runs, []
        return [run.end() for run in runs]


def _check_for_a_computer_elsewhere(steps: tuple[Step, ...], file: str | Path) -> None:
    for step in steps:
        if step.is_reset or step.action is not None or (step.condition is not None and not step.condition.msg_ids):
            text = (
                f"{step.text!r}: a remote target can only be checked by its packets; "
                "use send, expect event or expect tlm"
            )
            raise UsageError(text, file=file, line=step.line)
