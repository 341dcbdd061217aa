"""`cfepy new schema`: copy the JSON schemas with which editors complete mission files, boards and fault plans."""

from __future__ import annotations

import argparse
from pathlib import Path

from cfepy.cli.main import ENDED_WELL
from cfepy.cli.user_notes import writing

SCHEMAS = Path(__file__).with_name("schemas")
KINDS = {"mission": "mission.yaml or flight.yaml", "board": "a board profile", "faults": "a fault plan"}
"""The schemas, and the files that they describe."""


def run(arguments: argparse.Namespace) -> int:
    """Write the schemas into a folder, and print the line that connects a file with its schema.

    Returns:
        The exit status.

    Raises:
        UsageError: a file cannot be written.
    """
    folder = Path(arguments.folder)
    with writing(folder, "FOLDER"):
        folder.mkdir(parents=True, exist_ok=True)
    for kind in KINDS:
        name = f"{kind}.schema.json"
        with writing(folder / name, "FOLDER"):
            (folder / name).write_bytes((SCHEMAS / name).read_bytes())
        print(folder / name)
    print("\nMake the schema's path, relative to your file, the first line of the file:")
    for kind, described in KINDS.items():
        print(f"{described}:\n  # yaml-language-server: $schema={folder / f'{kind}.schema.json'}")
    return ENDED_WELL
