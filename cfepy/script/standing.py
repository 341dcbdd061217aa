"""A script that is not written yet: lines come one at a time, as a person types them, while the mission goes on.

Each line, and each file that is loaded, is a `ScriptRun` of its own, so it means what it means in a file. They share
one scene, with it the moment from which expectations look. A line acts at once, whatever others are still waiting for.
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
"""What stands for the file of a line that was typed."""


class StandingScript:
    """Steps as they come.

    Args:
        scene: what they look at and act upon.
        spec: the mission whose topics they may name; None for a computer elsewhere.
    """

    def __init__(self, scene: Scene, spec: MissionSpec | None) -> None:
        self.scene = scene
        self._spec = spec
        self._runs: list[ScriptRun] = []

    @property
    def is_waiting(self) -> bool:
        """Whether a line or a file waits for something that is to come."""
        return any(run.is_waiting for run in self._runs)

    def add(self, text: str, file: str | Path, tell: Tell, stop_on_failure: bool = False) -> None:
        """Begin to do what a text says.

        Args:
            text: a line, or a whole file.
            file: its name, for errors and verdicts.
            tell: gets each step's verdict.
            stop_on_failure: a file ends with its first failed step.

        Raises:
            UsageError: a mistake in it; then nothing of it is done.
        """
        script = parse_script(text, file, self._spec, self.scene.dictionary)
        if not self.scene.has_mission:
            _check_for_a_computer_elsewhere(script.steps, file)
        run = ScriptRun(script, stop_on_failure, tell, stands=True)
        run.join(self.scene)
        self._runs.append(run)

    def advance(self) -> int:
        """Do what is due now.

        Returns:
            The virtual time in ns at which it wants to be asked again; far in the future when nothing is open.
        """
        wake_ns = min((run.advance() for run in self._runs), default=ENDLESS)
        self._runs = [run for run in self._runs if not run.is_settled]
        return wake_ns

    def give_up(self) -> int:
        """Wait no more for what was to come; what must not come is still watched for.

        Returns:
            How many lines and files were given up.
        """
        waiting = [run for run in self._runs if run.is_waiting]
        self._runs = [run for run in self._runs if not run.is_waiting]
        return len(waiting)

    def end(self) -> list[Outcome]:
        """All is over: what is undecided is decided now."""
        runs, self._runs = self._runs, []
        return [run.end() for run in runs]


def _check_for_a_computer_elsewhere(steps: tuple[Step, ...], file: str | Path) -> None:
    for step in steps:
        if step.is_reset or (step.condition is not None and not step.condition.msg_ids):
            text = (
                f"{step.text!r}: a remote target can only be checked by its packets; "
                "use send, expect event or expect tlm"
            )
            raise UsageError(text, file=file, line=step.line)
