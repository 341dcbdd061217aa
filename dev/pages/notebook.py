"""docs/tutorials/library.ipynb: executed anew, with its outputs written down, by `python -m dev.pages.notebook`.

The outputs serve readers who cannot execute it, such as on GitHub. A test executes it as well, and compares the texts.
"""

from __future__ import annotations

import argparse
import re
import tempfile
from pathlib import Path
from typing import Any

FILE = Path(__file__).parents[2] / "docs" / "tutorials" / "library.ipynb"
LONGEST_S = 600  # for a cell, on a busy machine: kills a cell that hangs
VARIES = (
    (re.compile(r"[\d.]+ x real time"), "N x real time"),
    (re.compile(r"\b[0-9a-f]{32}\b"), "TRACE"),  # another one under another version of Python
)


def executed(folder: str) -> Any:
    """Return the notebook after a new kernel has executed it, in an empty folder."""
    import nbformat
    from nbclient import NotebookClient
    from traitlets.config import Config

    notebook: Any = nbformat.read(FILE, as_version=4)  # type: ignore[no-untyped-call]
    where = {"metadata": {"path": folder}}
    with tempfile.TemporaryDirectory() as sockets:
        options = Config({"KernelManager": kernel_sockets(sockets)})
        NotebookClient(notebook, timeout=LONGEST_S, record_timing=False, resources=where, config=options).execute()
    return notebook


def kernel_sockets(folder: str) -> dict[str, str]:
    """Return the options of jupyter's KernelManager that make a kernel listen in a folder instead of TCP ports.

    Another program may take a port between the manager's choice and the kernel's start.
    """
    return {"transport": "ipc", "ip": f"{folder}/kernel"}


def texts(notebook: Any) -> list[str]:
    """Return the texts that each cell shows, without parts that may differ in another run."""
    shown = []
    for cell in notebook.cells:
        for output in cell.get("outputs", ()):
            text = output.get("text") or output.get("data", {}).get("text/plain") or ""
            for pattern, name in VARIES:
                text = pattern.sub(name, text)
            shown.append(text)
    return shown


def write() -> None:
    """Write it with its outputs."""
    import nbformat

    with tempfile.TemporaryDirectory() as folder:
        notebook = executed(folder)
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    for number, cell in enumerate(notebook.cells):
        cell.id, cell.metadata = f"cell-{number}", {}
    text = nbformat.writes(notebook)  # type: ignore[no-untyped-call]
    FILE.write_text(text.replace(f"{folder}/", "") + "\n", encoding="utf-8")


if __name__ == "__main__":
    argparse.ArgumentParser(prog="python -m dev.pages.notebook", description=__doc__).parse_args()
    write()
