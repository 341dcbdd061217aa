"""`python -m dev.house`: the figures of this tree or of another, or the pictures of docs/explanation/design.md."""

from __future__ import annotations

import argparse
from pathlib import Path

from dev.house.figures import report
from dev.house.picture import draw
from dev.house.tree import ROOT, Tree


def main() -> None:
    """Print the figures of a checkout, or draw its pictures."""
    parser = argparse.ArgumentParser(prog="python -m dev.house", description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?", default=ROOT, help="another checkout, to compare")
    parser.add_argument("--picture", action="store_true", help="draw house.svg and message.svg in docs/pictures anew")
    options = parser.parse_args()
    tree = Tree(options.folder.resolve())
    if not options.picture:
        print(report(tree), end="")
        return
    for path, text in draw(tree).items():
        (tree.root / path).write_text(text, encoding="utf-8")
        print(path)


main()
