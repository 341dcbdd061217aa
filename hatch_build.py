"""Builds a wheel that has the engine for compiled applications in it, when CFEPY_ENGINE is set; else a pure one.

`CFEPY_ENGINE=1 pip wheel --no-deps .` makes one for this computer, `cibuildwheel` the wheels for manylinux.
"""

from __future__ import annotations

import importlib.util
import os
import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

WANTED = "CFEPY_ENGINE"


class EngineHook(BuildHookInterface):
    """Compiles the engine into the wheel; `cfepy.c.engine` has the recipe."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """See hatchling: before a wheel is built."""
        if not os.environ.get(WANTED) or version == "editable":
            return
        root = Path(self.root)
        sys.path.insert(0, str(root))
        spec = importlib.util.spec_from_file_location("engine", root / "cfepy" / "c" / "engine.py")
        assert spec is not None
        assert spec.loader is not None
        recipe = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(recipe)
        made = recipe.built(Path(tempfile.mkdtemp()))
        build_data["pure_python"] = False
        build_data["infer_tag"] = True
        build_data["force_include"][str(made)] = f"cfepy/c/{made.name}"
