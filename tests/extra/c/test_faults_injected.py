"""Injected faults affect compiled applications in the same way as those in Python."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from tests.extra.c.building import compile_c, needs_compiler, write_mission

pytestmark = needs_compiler

SOURCE = """
    void TEST_Main(void)
    {
        uint32_t pipe, run = RUN;
        void *got;
        uint8_t message[16];
        SAY("pipe %x", (unsigned)CFE_SB_CreatePipe(&pipe, 5, "TEST"));
        SAY("pipe %x", (unsigned)CFE_SB_CreatePipe(&pipe, 5, "TEST"));
        CFE_SB_Subscribe(0x1899, pipe);
        CFE_MSG_Init(message, 0x1899, sizeof message);
        while (CFE_ES_RunLoop(&run)) {
            CFE_SB_TransmitMsg(message, true);
            SAY("got %x", (unsigned)CFE_SB_ReceiveBuffer(&got, pipe, 0));
            OS_TaskDelay(500);
        }
        CFE_ES_ExitApp(run);
    }
"""


def test_calls_fail_and_messages_are_lost(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    compile_c(tmp_path, "TEST", SOURCE)
    folder = write_mission(tmp_path, "TEST")
    plan = tmp_path / "plan.yaml"
    plan.write_text(
        "faults:\n"
        "- {fail: CFE_SB_CreatePipe, app: TEST, status: CFE_SB_MAX_PIPES_MET, number: 1}\n"
        "- {drop: 0x1899, after: 1.4, until: 2.4}\n"
        "- {crash: TEST, at: 3.2}\n",
        encoding="utf-8",
    )
    main(["run", folder, "--for", "4", "--faults", str(plan)])
    out = capsys.readouterr().out
    told = [line.partition("> ")[2] for line in out.splitlines() if "> " in line]
    assert told[:2] == ["pipe ca000004", "pipe 0"]
    assert told[2:] == ["got 0", "got 0", "got ca000002", "got ca000002", "got 0", "got 0"], out
    assert "Restart Application TEST Initiated" in out
