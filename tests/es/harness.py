"""Python functions as applications of a real mission."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from cfepy.app import Cfe
from cfepy.es.records import StartParams
from cfepy.mission import Mission
from cfepy.status import OS_ERROR, OsalError
from cfepy.writing.console import Console

Main = Callable[[Cfe], Any]


class Functions:
    """A loader that finds functions by their file's name."""

    def __init__(self, cfe: Cfe, mains: dict[str, Main]) -> None:
        self.cfe = cfe
        self.mains = mains

    def exists(self, file: str) -> bool:
        return file in self.mains

    def load(self, file: str, symbol: str, app_name: str) -> Callable[[], object]:
        if file not in self.mains:
            raise OsalError(OS_ERROR, f"no {file}")
        return lambda: self.mains[file](self.cfe)

    def unload(self, app_name: str) -> None:
        pass

    def load_library(self, file: str, symbol: str) -> Callable[[int], object]:
        return lambda lib_id: self.mains[file](self.cfe)


class Lab:
    """A mission that has booted, with room for applications."""

    def __init__(self, folder: Path, tasks: str = "thread", **mains: Main) -> None:
        (folder / "startup.scr").write_text("!\n", encoding="utf-8")
        (folder / "mission.yaml").write_text(
            'cfe_version: "7.0.0"\n', encoding="utf-8"
        )  # the recordings for the tests were made on it
        self.mission = Mission(str(folder), console=Console(quiet=True), tasks=tasks)
        self.cfe = self.mission.cfe
        self.es = self.cfe.es
        self.es.loader = Functions(self.cfe, {f"/cf/{name}.so": main for name, main in mains.items()})
        self.mission.run_for(1)
        self.lines = self.mission.console.lines

    def start(self, name: str, exception_action: int = 0, priority: int = 50) -> int:
        """Start the application of a function's name. Returns its AppId."""
        params = StartParams(f"/cf/{name}.so", f"{name}_main", 8192, priority, exception_action)
        return self.es.create_app(name.upper(), params)

    def log(self) -> str:
        """Everything on the console."""
        return "\n".join(self.lines)
