"""Builds a wheel with compiled parts in it when CFEPY_ENGINE is set; else a pure one.

The parts are the engine for compiled applications, and the kernel and the bus, which mypyc compiles from the sources
that a pure wheel has too. `CFEPY_ENGINE=1 pip wheel --no-deps .` makes a wheel for this computer, `cibuildwheel` those
for manylinux, and `CFEPY_ENGINE=1 pip install -e .` puts the kernel and the bus beside the sources of a checkout.
"""

from __future__ import annotations

import importlib.machinery
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from types import ModuleType
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

WANTED = "CFEPY_ENGINE"
MYPYC = ["mypy[mypyc]==2.4.*", "types-PyYAML"]  # tried with this one: see `with_types_counted`
TRAVERSE = r"{}_traverse\(\w+ \*self, visitproc visit, void \*arg\)\n\s*{{\n"
DEALLOC = re.compile(r"(\w+)_dealloc\(\w+ \*self\)\n\s*\{.*?\bdone: ;", re.DOTALL)
FREE = "Py_TYPE(self)->tp_free((PyObject *)self);"


class EngineHook(BuildHookInterface):
    """Compiles them into the wheel; `cfepy.extra.c.engine` and `cfepy.interpreter.compiled` know of what."""

    def dependencies(self) -> list[str]:
        """See hatchling: what the build needs beside hatchling itself."""
        return MYPYC if os.environ.get(WANTED) else []

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """See hatchling: before a wheel is built."""
        if not os.environ.get(WANTED):
            return
        root = Path(self.root)
        folder = Path(tempfile.mkdtemp())
        libraries = compiled_modules(root, folder)
        if version == "editable":  # the engine is built when it is used for the first time
            for old in root.glob("cfepy_*__mypyc.*"):
                old.unlink()
            for name, made in libraries.items():
                shutil.copy(made, root / name)
            return
        made = recipe(root, "cfepy/extra/c/engine.py").built(folder)
        build_data["pure_python"] = False
        build_data["infer_tag"] = True
        build_data["force_include"][str(made)] = f"cfepy/extra/c/{made.name}"
        for name, made in libraries.items():
            build_data["force_include"][str(made)] = name


def recipe(root: Path, path: str) -> ModuleType:
    """A module of cfepy's that knows how something is built, without what it is part of."""
    sys.path.insert(0, str(root))
    spec = importlib.util.spec_from_file_location(Path(path).stem, root / path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def compiled_modules(root: Path, folder: Path) -> dict[str, Path]:
    """Compile the kernel and the bus.

    Args:
        root: the checkout, which is only read: compiled modules beside the sources are left as they are.
        folder: where they are built.

    Returns:
        The files of the libraries by their places in a wheel.
    """
    compiled = recipe(root, "cfepy/interpreter/compiled.py")
    for package in ("cfepy", "rospy_shim", "ros_libraries"):
        shutil.copytree(root / package, folder / package, ignore=shutil.ignore_patterns("__pycache__", "*.so"))
    (folder / "mypy.ini").write_text(
        "[mypy]\nexplicit_package_bases = True\nignore_missing_imports = True\n"
        "mypy_path = ros_libraries:rospy_shim/roslaunch/tools:rospy_shim/stand_ins\n"
    )
    command = [sys.executable, str(root / "hatch_build.py"), compiled.library_name(root), *compiled.MODULES]
    ended = subprocess.run(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
    )
    if ended.returncode != 0:
        raise SystemExit(f"mypyc cannot compile the kernel and the bus:\n{ended.stdout}")
    endings = tuple(importlib.machinery.EXTENSION_SUFFIXES)
    made = [path for path in (folder / "built").rglob("*") if path.name.endswith(endings)]
    return {path.relative_to(folder / "built").as_posix(): path for path in made}


def build(name: str, modules: list[str]) -> None:
    """Compile modules below the working folder into its folder `built`.

    Args:
        name: of the library that they share.
        modules: their sources.
    """
    from mypyc.build import mypycify
    from setuptools import Distribution

    options = ["--python-version", f"{sys.version_info.major}.{sys.version_info.minor}"]
    extensions = mypycify([*options, *modules], opt_level="3", group_name=name)
    for source in Path("build").rglob("__native_*.c"):
        source.write_text(with_types_counted(source.read_text()))
    distribution = Distribution({"name": name, "ext_modules": extensions})
    command = distribution.get_command_obj("build_ext")
    command.build_lib, command.build_temp = "built", "temporary"
    command.ensure_finalized()
    command.run()


def with_types_counted(source: str) -> str:
    """What mypyc has made, with the reference that an object has to its type.

    Each object of a heap type keeps it alive, so its `tp_traverse` has to visit it and its `tp_dealloc` to let it go
    (Python's manual, Py_TPFLAGS_HEAPTYPE). mypyc does neither. A kernel and a bus that somebody watches have types of
    their own, derived for the flight, and these and what they know of would never be freed: 7 MB a flight.
    """
    counted = "{ PyTypeObject *its_type = Py_TYPE(self); its_type->tp_free((PyObject *)self); Py_DECREF(its_type); }"
    names = [found[1] for found in DEALLOC.finditer(source) if FREE in found[0]]
    if not names or len(names) != source.count(FREE):
        raise SystemExit(f"mypyc frees objects in {source.count(FREE)} places, and {len(names)} of them are known")
    for name in names:
        source, count = re.subn(TRAVERSE.format(name), r"\g<0>    Py_VISIT(Py_TYPE(self));\n", source)
        if count != 1:
            raise SystemExit(f"mypyc wrote {count} functions that traverse {name}")
    return source.replace(FREE, counted)


if __name__ == "__main__":
    build(sys.argv[1], sys.argv[2:])
