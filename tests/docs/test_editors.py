"""The configurations for VS Code on the page about editors stop in a node and in an application in C."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from cfepy.cli.main import main
from cfepy.extra.c import GDB_SYMBOLS
from tests.extra.c.building import needs_compiler

PAGE = Path(__file__).parents[2] / "docs/how_to/editors.md"
SECONDS = "2"


def configurations() -> dict[str, dict[str, Any]]:
    """Return the configurations of the page's launch.json, by type, with a shorter run."""
    blocks = re.findall(r"```json\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    found = {each["type"]: each for block in blocks for each in json.loads(block)["configurations"]}
    for each in found.values():
        each["args"][each["args"].index("--for") + 1] = SECONDS
    return found


def line_of(file: Path, text: str) -> int:
    """Return the number of the first line with a text."""
    return next(number for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1) if text in line)


def trace_in(text: str) -> str:
    """Return the digest that a run printed."""
    return re.findall(r"trace: ([0-9a-f]{32})", text)[-1]


def run_of(words: list[str], folder: Path) -> str:
    """Return the digest of a run without a debugger."""
    done = subprocess.run(
        [sys.executable, "-m", "cfepy", *words], cwd=folder, capture_output=True, text=True, check=True
    )
    return trace_in(done.stdout)


# -- Python ------------------------------------------------------------------------------------------------------------


class Adapter:
    """A debug adapter that an editor talks to.

    Attributes:
        output: the text that the debugged program wrote.
    """

    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdin is not None
        assert process.stdout is not None
        self._writing, self._reading = process.stdin, process.stdout
        self._sequence = 0
        self.output = ""

    def send(self, command: str, **arguments: Any) -> int:
        """Send a request; return its number."""
        self._sequence += 1
        request = {"seq": self._sequence, "type": "request", "command": command, "arguments": arguments}
        body = json.dumps(request).encode()
        self._writing.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        self._writing.flush()
        return self._sequence

    def until(self, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """Read messages up to the wanted one, and return it."""
        while True:
            size = 0
            while line := self._reading.readline().strip():
                size = int(line.split(b":")[1]) if line.lower().startswith(b"content-length") else size
            message: dict[str, Any] = json.loads(self._reading.read(size))
            if message.get("event") == "output" and message["body"].get("category") == "stdout":
                self.output += message["body"]["output"]
            if wanted(message):
                return message

    def ask(self, command: str, **arguments: Any) -> dict[str, Any]:
        """Send a request and return the body of its answer."""
        number = self.send(command, **arguments)
        answer = self.until(lambda message: message.get("request_seq") == number)
        assert answer["success"], answer
        body: dict[str, Any] = answer.get("body", {})
        return body


@contextmanager
def adapter() -> Iterator[Adapter]:
    """Start the adapter of debugpy, as VS Code does."""
    process = subprocess.Popen(
        [sys.executable, "-m", "debugpy.adapter"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    try:
        yield Adapter(process)
    finally:
        process.kill()
        process.communicate()


def test_python_configuration_stops_in_a_node_and_keeps_the_trace(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "mission", "rover"]) == 0
    chosen = configurations()["debugpy"]
    text = json.dumps(chosen).replace("${workspaceFolder}", str(tmp_path))
    chosen = {**json.loads(text), "python": [sys.executable], "console": "internalConsole"}
    listener = tmp_path / "rover/listener.py"
    with adapter() as editor:
        editor.ask("initialize", adapterID="debugpy", linesStartAt1=True, pathFormat="path")
        editor.send("launch", **chosen)
        editor.until(lambda message: message.get("event") == "initialized")
        line = line_of(listener, "min(self.low")
        editor.ask("setBreakpoints", source={"path": str(listener)}, breakpoints=[{"line": line}])
        editor.send("configurationDone")
        stopped = editor.until(lambda message: message.get("event") == "stopped")["body"]
        frame = editor.ask("stackTrace", threadId=stopped["threadId"])["stackFrames"][0]
        scope = editor.ask("scopes", frameId=frame["id"])["scopes"][0]["variablesReference"]
        variables = {
            each["name"]: each["value"] for each in editor.ask("variables", variablesReference=scope)["variables"]
        }
        editor.ask("setBreakpoints", source={"path": str(listener)}, breakpoints=[])
        editor.send("continue", threadId=stopped["threadId"])
        editor.until(lambda message: message.get("event") == "exited")
    assert (frame["name"], frame["line"]) == ("add", line)
    assert variables["message"].startswith("data: ")
    assert trace_in(editor.output) == run_of(["run", "rover", "--for", SECONDS], tmp_path)


# -- C -----------------------------------------------------------------------------------------------------------------


@needs_compiler
@pytest.mark.skipif(shutil.which("gdb") is None, reason="there is no gdb")
def test_c_configuration_stops_in_an_application_and_keeps_the_trace(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "app", "heater", "--c"]) == 0
    assert main(["build", "heater", "-O0"]) == 0
    shutil.copy(GDB_SYMBOLS, "cfepy.gdb")
    chosen = configurations()["cppdbg"]
    assert chosen["program"].endswith(".venv/bin/python")
    line = line_of(tmp_path / "heater/fsw/src/heater.c", "CFE_EVS_SendEvent(HEATER_INIT_INF_EID")
    commands = [  # the requests of VS Code's adapter to gdb, in its order
        *(f'-interpreter-exec console "{each["text"]}"' for each in chosen["setupCommands"]),
        f"-file-exec-and-symbols {sys.executable}",
        f"-exec-arguments {' '.join(chosen['args'])}",
        f"-break-insert -f heater.c:{line}",
        "-exec-run",
    ]
    then = ["-stack-list-frames 0 1", "-break-delete", "-exec-continue"]
    shown = dialogue(commands, then, tmp_path)
    if "ptrace: Operation not permitted" in shown:
        pytest.skip("this computer does not permit tracing a process")
    assert re.search(rf'func="HEATER_Init".*line="{line}"', shown)
    assert trace_in(shown) == run_of(["run", "heater", "--for", SECONDS], tmp_path)


def dialogue(commands: list[str], then: list[str], folder: Path) -> str:
    """Give gdb commands, further ones when it stops, and end it when the program has ended. Returns its output."""
    gdb = subprocess.Popen(
        ["gdb", "-q", "-nx", "--interpreter=mi"],
        cwd=folder,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert gdb.stdin is not None
    assert gdb.stdout is not None
    lines: list[str] = []
    try:
        for command in commands:
            print(command, file=gdb.stdin, flush=True)
        for line in gdb.stdout:
            lines.append(line)
            if line.startswith("*stopped") and "exited" not in line:
                for command in then:
                    print(command, file=gdb.stdin, flush=True)
            elif line.startswith(("*stopped", "^error")):
                break
    finally:
        gdb.kill()
        gdb.communicate()
    return "".join(lines)


def test_command_prints_the_script_for_gdb(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["build", "--gdb-symbols"]) == 0
    assert Path(capsys.readouterr().out.strip()) == GDB_SYMBOLS
    assert GDB_SYMBOLS.is_file()
