"""Play a script of API calls in an application of cfepy, and write its answers as the C application does.

API_AUX and API are the applications, API_CHILD is the child task, which also calls. They hand over the turn with kernel
semaphores, which use no OSAL ids.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from textwrap import dedent
from typing import Any

from cfepy.es import SYSTEM_OPERATIONAL
from cfepy.evs.packets import LONG_EVENT, LONG_EVENT_MSG_MID
from cfepy.mission import Mission
from cfepy.rtos.semaphore import Semaphore
from cfepy.status import CfeError
from cfepy.writing.console import Console
from dev.twin.api.bus_calls import BusCalls
from dev.twin.api.es_calls import EsCalls
from dev.twin.api.msg_calls import MsgCalls
from dev.twin.api.osal_calls import OsalCalls, PspCalls
from dev.twin.api.words import SLOTS, Line, quote, word_of

STARTUP = """\
CFE_LIB, sample_lib, SAMPLE_LIB_Init, SAMPLE_LIB, 0, 0, 0x0, 0;
CFE_APP, api_app, API_AuxMain, API_AUX, 100, 65536, 0x0, 0;
CFE_APP, api_app, API_Main, API, 101, 65536, 0x0, 0;
"""
LIMITS = """
cfe_version: "{release}"
limits:
  evs_max_app_event_burst: 0
"""
LOG_STAMP = len("1980-012-14:03:20.00000 ")
LONGEST_S = 100_000


class Player:
    """The application and its tasks.

    Args:
        mission: the mission in which it flies.
        script: the lines.
    """

    def __init__(self, mission: Mission, script: list[str]) -> None:
        self.cfe = mission.cfe
        self.script = script
        self.answers: list[str] = []
        self.is_over = False
        self.slots = [0] * SLOTS
        kernel = self.cfe.es.kernel
        self.turns = {name: Semaphore(kernel) for name in "BC"}
        self.done = Semaphore(kernel)
        self.line: list[str] = []
        self.answer = ""
        self.tables = [kind(self) for kind in (EsCalls, BusCalls, MsgCalls, OsalCalls, PspCalls)]
        self.loader = self.cfe.es.loader
        self.exists, self.load_library = self.loader.exists, self.loader.load_library
        self.cfe.es.loader = self

    def load(self, file: str, symbol: str, app_name: str) -> Any:
        """Return the main functions of the two applications. The mission loads all others."""
        mains = {"API_AuxMain": self.aux_main, "API_Main": self.main}
        return mains[symbol] if symbol in mains else self.loader.load(file, symbol, app_name)

    def unload(self, app_name: str) -> None:
        """Unload an application of the mission."""
        self.loader.unload(app_name)

    def child_main(self) -> None:
        """Run a child task."""
        while not self.is_over:
            self.cfe.os.task_delay(50)
            self.cfe.es.increment_task_counter()
        self.cfe.es.exit_child_task()

    def aux_main(self) -> None:
        """The main function of API_AUX."""
        self.cfe.evs.register()
        self._serve("B")

    def main(self) -> None:
        """The main function of API."""
        cfe = self.cfe
        cfe.evs.register()
        cfe.es.wait_for_system_state(SYSTEM_OPERATIONAL, 20_000)
        cfe.os.task_delay(500)
        pipe = cfe.sb.create_pipe(50, "API_EVENTS")
        cfe.sb.subscribe_ex(LONG_EVENT_MSG_MID, pipe, msg_limit=50)
        cfe.es.create_child_task("API_CHILD", lambda: self._serve("C"), 65536, 150)
        cfe.os.task_delay(200)
        self._drain(pipe)
        self.answers.clear()
        for number, line in enumerate(self.script, 1):
            self.line = line.split()
            if len(self.line) < 2:
                continue
            if self.line[0] == "A":
                self._perform()
            else:
                self.turns[self.line[0]].give()
                self.done.take()
            self.answers.append(f"{number} {self.answer}".rstrip())
            self._drain(pipe)
        self.answers.append("end")
        self.is_over = True

    def _serve(self, who: str) -> None:
        while True:
            self.turns[who].take()
            self._perform()
            self.done.give()

    def _perform(self) -> None:
        _, name, *words = self.line
        call = next((found for table in self.tables if (found := getattr(table, name, None)) is not None), None)
        if call is None:
            self.answer = "unknown"
            return
        try:
            answer = call(Line(words, self.slots))
        except CfeError as error:
            answer = (error.status,)
        if answer and answer[0] < 0 and name not in WITHOUT_STATUS:
            answer = answer[:1]
        self.answer = " ".join(map(word_of, answer))

    def _drain(self, pipe: int) -> None:
        while (packet := self.cfe.sb.receive_buffer(pipe, 0)) is not None:
            event = LONG_EVENT.unpack(packet[16:])
            origin = event["PacketID"]
            head = f"E {origin['AppName']} {origin['EventID']} {origin['EventType']}"
            self.answers.append(f"{head} {quote(event['Message'])}")
        log = self.cfe.es.syslog
        self.answers += [f"L {quote(line)}" for line in log.read().splitlines()]
        log.clear()


WITHOUT_STATUS = ("PSP_PortRead", "PSP_Eeprom", "ResourceId")
"""Calls whose first output is no status of their own."""


def play(script: list[str], release: str = "7.0.0") -> list[str]:
    """Return the answers of cfepy to a script, on a release of cFE."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "startup.scr").write_text(dedent(STARTUP), encoding="utf-8")
        Path(folder, "mission.yaml").write_text(dedent(LIMITS.format(release=release)), encoding="utf-8")
        with Mission(folder, console=Console(quiet=True)) as mission:
            player = Player(mission, script)
            while not player.is_over and mission.cfe.es.kernel.now < LONGEST_S * 10**9:
                mission.run_for(10)
            return player.answers
