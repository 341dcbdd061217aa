"""The configuration of a mission tree: from its headers and OSAL's options to `limits` of a mission file.

cFE names its values CFE_PLATFORM_... and CFE_MISSION_..., or without these words in cFE 6.5. `PlatformConfig` has the
values that the simulator follows. Each other value that differs from cfepy's headers becomes a note, because the
simulator cannot follow it.

A configuration header defines values by other macros and by arithmetic, so only a compiler knows them. It compiles a
variable for each macro, and the values are read from the object file. Each variable is in a function of its own,
because a compiler reports an unknown name once a function. Nothing of the mission is executed.
"""

from __future__ import annotations

import re
import struct
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from io import BytesIO
from pathlib import Path

from cfepy.config.platform import NOT_LIMITS, PlatformConfig
from cfepy.config.versions import DEFAULT_RELEASE, RELEASES
from cfepy.extra.c.elf import elf_file
from cfepy.extra.c.engine import compiler
from cfepy.extra.c.toolchain.cfe6 import option_of
from cfepy.extra.c.toolchain.cmake_project import Project, ProjectScript
from cfepy.extra.c.toolchain.compiler import C_FLAGS, COMMON, CompilerError, call_bounded, compile_file
from cfepy.extra.c.toolchain.headers import NEEDED, headers_folder, read_tree
from cfepy.extra.c.toolchain.headers import names as core_names
from cfepy.extra.c.trees.tree_model import TreeModel, locate_header
from cfepy.extra.c.trees.tree_reader import build_variables
from cfepy.reading.input_files import read_limited, text_limited
from cfepy.reading.input_limits import OBJECT_BYTES
from cfepy.status import UsageError
from cfepy.time import TimeSettings

BASES = {
    "CFEPY_CMD_MID_BASE": "CFE_PLATFORM_BASE_MIDVAL(CMD)",
    "CFEPY_TLM_MID_BASE": "CFE_PLATFORM_BASE_MIDVAL(TLM)",
    "CFEPY_GLOBAL_CMD_MID_BASE": "CFE_GLOBAL_BASE_MIDVAL(CMD)",
    "CFEPY_GLOBAL_TLM_MID_BASE": "CFE_GLOBAL_BASE_MIDVAL(TLM)",
}
"""cfepy's macros for the bases of MsgIds, and NASA's."""
DEFAULT_BASES = {
    "CFEPY_CMD_MID_BASE": 0x1800,
    "CFEPY_TLM_MID_BASE": 0x0800,
    "CFEPY_GLOBAL_CMD_MID_BASE": 0x1860,
    "CFEPY_GLOBAL_TLM_MID_BASE": 0x0860,
}
VERSION_6 = "cfe/fsw/cfe-core/src/inc/cfe_version.h"
_VERSION_PARTS = ("CFE_MAJOR_VERSION", "CFE_MINOR_VERSION", "CFE_REVISION")
BASE_HEADER = "cfe_core_api_base_msgid_values"

_OTHER_NAMES = {
    "es_app_scan_rate_ms": "ES_APP_SCAN_RATE",
    "es_startup_sync_poll_ms": "ES_STARTUP_SYNC_POLL_MSEC",
    "es_startup_script_timeout_ms": "ES_STARTUP_SCRIPT_TIMEOUT_MSEC",
    "es_core_max_startup_ms": "CORE_MAX_STARTUP_MSEC",
    "sb_max_msg_size": "SB_MAX_SB_MSG_SIZE",
    "sb_highest_valid_msg_id": "SB_HIGHEST_VALID_MSGID",
}
"""Fields whose macro has another name."""
_PREFIXES = ("CFE_PLATFORM_", "CFE_MISSION_", "CFE_")
_TIME_SOURCES = ("time_cfg_", "time_at_tone_")
_IDENTITIES = ("spacecraft_id", "processor_id", "processor_name")
_OSAL = "OSAL_CONFIG_"
_OS_MACRO = "OS_"
_NEUTRAL = ("_TASK_PRIORITY", "_TASK_STACK_SIZE", "_TOPICID", "_MID", "_REV", "_BLOCK_SIZE", "_ENDIAN")
"""Ends of names whose values are not part of the binary interface, or are compared elsewhere."""


@dataclass(slots=True)
class Configuration:
    """The configuration of a tree.

    Attributes:
        release: the release of cFE.
        limits: values for `limits` of a mission file that differ from the release's defaults.
        bases: bases of MsgIds that differ from cfepy's, by cfepy's macro.
        omit_deprecated: whether the tree leaves deprecated names out.
        notes: facts for the report: values that the simulator does not follow.
    """

    release: str = DEFAULT_RELEASE
    limits: dict[str, int | str] = field(default_factory=dict)
    bases: dict[str, int] = field(default_factory=dict)
    omit_deprecated: bool = False
    notes: list[str] = field(default_factory=list)


def read_configuration(model: TreeModel) -> Configuration:
    """Read the configuration of a tree for its processor.

    Raises:
        UsageError: there is no compiler, or no reader of object files.
    """
    found = Configuration()
    found.omit_deprecated = model.variables.get("OMIT_DEPRECATED", ["0"])[:1] in (["1"], ["ON"], ["TRUE"], ["true"])
    _Reader(model, found).read()
    return found


class _Reader:
    def __init__(self, model: TreeModel, found: Configuration) -> None:
        self._model = model
        self._found = found
        self._has_cfe = (model.layout.tree / NEEDED).is_file()

    def read(self) -> None:
        own = self._own_headers()
        with tempfile.TemporaryDirectory(prefix="cfepy-tree-") as scratch:
            flags, headers = self._flags(Path(scratch), own)
            values = self._values(headers, flags) if headers else {}
            if self._has_cfe:
                self._release(flags)
        self._note_cfe_6()
        defaults = PlatformConfig().with_limits(RELEASES[self._found.release].limits)
        self._limits(values, defaults)
        self._check_time(defaults)
        self._osal(defaults)
        self._identities(defaults)

    def _own_headers(self) -> dict[str, Path]:
        """Return the mission's own versions of headers of cFE."""
        layout, cpu = self._model.layout, self._model.cpu
        found = {}
        for name in core_names():
            file = locate_header(layout.definitions, f"{name}.h", ("default", cpu))
            if file is not None and name != "cfe_perfids":
                found[f"{name}.h"] = file
        for name, short, prefix in (  # the names of cFS 6
            ("cfe_mission_cfg.h", "mission_cfg.h", layout.config_name),
            ("cfe_platform_cfg.h", "platform_cfg.h", cpu),
            ("osconfig.h", "osconfig.h", "default"),
        ):
            file = locate_header(layout.definitions, short, (prefix,))
            if file is not None:
                found.setdefault(name, file)
        return found

    def _flags(self, scratch: Path, own: Mapping[str, Path]) -> tuple[list[str], list[str]]:
        """Return flags for headers of the tree, and the headers to read."""
        definitions, cpu = self._model.layout.definitions, self._model.cpu
        folders = [each for each in (definitions / cpu, definitions, definitions / "inc") if each.is_dir()]
        chosen: dict[str, Path | None] = {}
        more: list[Path] = [headers_folder()]
        headers = [each for each in own if "cfg" in each or each == "osconfig.h"]
        if self._has_cfe:
            tree = read_tree(self._model.layout.tree)
            chosen, more = dict(tree.chosen), tree.includes
            headers += [f"{each.stem}.h" for each in self._internal()]
            headers += ["cfe_mission_cfg.h"]
        chosen |= own
        for name, file in chosen.items():
            (scratch / name).write_text("" if file is None else f'#include "{file.absolute()}"\n', encoding="utf-8")
        flags = [f"-I{each}" for each in (scratch, *folders, *more)]
        if BASE_HEADER + ".h" in own:
            headers.append(f"{BASE_HEADER}.h")
        return flags, list(dict.fromkeys(headers))

    def _internal(self) -> list[Path]:
        modules = self._model.layout.tree / "cfe/modules"
        return sorted(
            (*modules.glob("*/fsw/inc/cfe_*_internal_cfg.h"), *modules.glob("*/fsw/inc/cfe_*_interface_cfg.h"))
        )

    def _values(self, headers: Sequence[str], flags: Sequence[str]) -> dict[str, int]:
        """Return the values of macros. A header that cannot be compiled is left out with a note."""
        usable = list(headers)
        names: list[str] = []
        try:
            names = macro_names(headers, flags)
        except CompilerError:
            usable = []
        for header in () if usable else headers:
            try:
                names += macro_names([header], flags)
            except CompilerError as error:
                self._found.notes.append(f"{header} cannot be read: {_first_error(error)}")
            else:
                usable.append(header)
        wanted = [each for each in dict.fromkeys(names) if each.startswith(("CFE_PLATFORM_", "CFE_MISSION_", "OS_"))]
        wanted += [each for each in dict.fromkeys(names) if each.startswith("CFE_") and each not in wanted]
        if f"{BASE_HEADER}.h" in usable:
            wanted += BASES.values()
        try:
            return macro_values(usable, wanted, flags)
        except CompilerError as error:
            self._found.notes.append(f"the configuration headers cannot be compiled together: {_first_error(error)}")
            return {}

    def _release(self, flags: Sequence[str]) -> None:
        try:
            values = macro_values(["cfe_version.h"], _VERSION_PARTS, flags)
        except CompilerError:
            return
        name = ".".join(str(values[each]) for each in _VERSION_PARTS if each in values)
        if name in RELEASES:
            self._found.release = name
        else:
            self._found.notes.append(
                f"cFE is {name or 'of an unknown release'} in the tree; cfepy follows {DEFAULT_RELEASE}"
            )

    def _note_cfe_6(self) -> None:
        """Note the release of a cFE 6, whose files are in other folders."""
        file = self._model.layout.tree / VERSION_6
        if file.is_file():
            said = dict(_DEFINED.findall(text_limited(file, OBJECT_BYTES, "replace")))
            numbers = [said.get(each, "?").strip("() ") for each in _VERSION_PARTS]
            text = f"the tree has cFE {'.'.join(numbers)}; the mission runs on cFE {DEFAULT_RELEASE}"
            option = option_of(numbers)
            self._found.notes.append(text if option is None else f"{text}, and the sources need {option}")

    def _limits(self, values: Mapping[str, int], defaults: PlatformConfig) -> None:
        seen = set()
        for each in fields(PlatformConfig):
            if each.name in NOT_LIMITS or each.name in _IDENTITIES or not isinstance(getattr(defaults, each.name), int):
                continue
            base = _OTHER_NAMES.get(each.name, each.name.upper())
            prefixes = (_OS_MACRO,) if base.startswith(_OS_MACRO) else _PREFIXES
            names = [base] if base.startswith(_OS_MACRO) else [f"{prefix}{base}" for prefix in prefixes]
            name = next((one for one in names if one in values), None)
            if name is not None:
                seen.add(name)
                self._set(each.name, values[name], defaults)
        for macro, text in BASES.items():
            if text in values and values[text] != DEFAULT_BASES[macro]:
                self._found.bases[macro] = values[text]
        self._compare(values, seen)

    def _check_time(self, defaults: PlatformConfig) -> None:
        """Leave out settings of the time that contradict each other, with which cFE would not compile."""
        try:
            TimeSettings.of(defaults.with_limits(self._found.limits))
        except UsageError as error:
            dropped = [each for each in self._found.limits if each.startswith(_TIME_SOURCES)]
            for each in dropped:
                del self._found.limits[each]
            self._found.notes.append(
                f"cFE's defaults replace {', '.join(dropped)}, which contradict each other: {error}"
            )

    def _set(self, name: str, value: int, defaults: PlatformConfig) -> None:
        before = getattr(defaults, name)
        made = bool(value) if isinstance(before, bool) else value
        if made != before:
            self._found.limits[name] = made

    def _compare(self, values: Mapping[str, int], seen: set[str]) -> None:
        """Note values that apps see and that cfepy's headers have with another value."""
        names = [each for each in values if each.startswith("CFE_MISSION_") and each not in seen]
        self._note_differences({each: values[each] for each in names if not each.endswith(_NEUTRAL)})

    def _note_differences(self, values: Mapping[str, int]) -> None:
        """Note values that cfepy's headers have too, with another value."""
        ours = macro_values(["cfe.h"], values, [f"-I{headers_folder()}"]) if values else {}
        for name, value in ours.items():
            if value != values[name]:
                text = f"{name} is {values[name]} in the mission and {value} in cfepy, which cannot change it"
                self._found.notes.append(text)

    def _osal(self, defaults: PlatformConfig) -> None:
        """Read OSAL's options: default_osconfig.cmake, then the toolchain's and the processor's."""
        definitions, cpu = self._model.layout.definitions, self._model.cpu
        files = [definitions / f"{each}_osconfig.cmake" for each in ("default", "native", cpu)]
        files = [each for each in files if each.is_file()]
        if not files:
            return
        script = ProjectScript(Project(files[0]), definitions, build_variables(self._model.layout))
        for file in files:
            script.include(file)
        names = {each.name for each in fields(PlatformConfig)}
        unknown: dict[str, int] = {}
        for key, words in script.variables.items():
            if not key.startswith(_OSAL) or len(words) != 1 or not words[0].isdecimal():
                continue
            name = f"os_{key.removeprefix(_OSAL).lower()}"
            if name in names:
                self._set(name, int(words[0]), defaults)
            else:
                unknown[f"{_OS_MACRO}{key.removeprefix(_OSAL)}"] = int(words[0])
        self._note_differences(unknown)

    def _identities(self, defaults: PlatformConfig) -> None:
        model = self._model
        for name, value in (
            ("spacecraft_id", model.spacecraft_id),
            ("processor_id", model.processor_id),
            ("processor_name", model.cpu),
        ):
            if value is not None and value != getattr(defaults, name):
                self._found.limits[name] = value


def _first_error(error: CompilerError) -> str:
    lines = [each.partition("error: ")[2] for each in str(error).splitlines() if "error: " in each]
    return lines[0] if lines else str(error).partition("\n")[0]


def mission_file(name: str, configuration: Configuration) -> bytes:
    """Return the mission file of a tree."""
    import yaml

    content: dict[str, object] = {"name": name, "cfe_version": configuration.release}
    if configuration.omit_deprecated:
        content["compiled"] = {"omit_deprecated": True}
    if configuration.limits:
        content["limits"] = dict(configuration.limits)
    return yaml.safe_dump(content, sort_keys=False, default_flow_style=False, allow_unicode=True).encode()


# -- values of macros --------------------------------------------------------------------------------------------------

_DEFINED = re.compile(r"^#define +(\w+) +(\S[^\n]*?)(?: */\*[^\n]*)?$", re.MULTILINE)
_IN_FUNCTION = re.compile(r"In function .cfepy_(\d+).")
_ROUNDS = 6
_LAYOUT = struct.Struct("<q")
_PREFIX = "cfepy_value_"
COMMON_LINES = (
    "#include <stdbool.h>",
    "#include <stdint.h>",
    "#ifndef TRUE",
    "#define TRUE 1",
    "#define FALSE 0",
    "#endif",
)
"""Names that cFE's own sources have before its configuration: those of C, and those of cFE 6."""
ERRORS = ("-fmax-errors=0", "-Werror=int-conversion", "-Werror=pointer-to-int-cast")


def macro_names(headers: Sequence[str], flags: Sequence[str]) -> list[str]:
    """Return the macros without arguments that headers define, and those that they include.

    Args:
        headers: names of headers, as in `#include`.
        flags: flags of the compiler, such as -I.

    Raises:
        CompilerError: a header cannot be read.
        UsageError: there is no compiler.
    """
    with tempfile.TemporaryDirectory(prefix="cfepy-macros-") as scratch:
        source = Path(scratch) / "names.c"
        source.write_text("".join(f'#include "{each}"\n' for each in headers), encoding="utf-8")
        status, said = call_bounded([*compiler(), *C_FLAGS, *COMMON, "-w", *flags, "-E", "-dM", str(source)])
    if status:
        raise CompilerError(said)
    return [name for name, _ in _DEFINED.findall(said)]


def macro_values(headers: Sequence[str], expressions: Iterable[str], flags: Sequence[str]) -> dict[str, int]:
    """Return the values of expressions that are integers.

    Args:
        headers: names of headers, as in `#include`.
        expressions: macros, or calls of macros.
        flags: flags of the compiler, such as -I.

    Raises:
        CompilerError: a header cannot be compiled.
        UsageError: there is no compiler.
    """
    wanted = dict(enumerate(expressions))
    with tempfile.TemporaryDirectory(prefix="cfepy-macros-") as scratch:
        source, made = Path(scratch) / "values.c", Path(scratch) / "values.o"
        for _ in range(_ROUNDS):
            lines = [*COMMON_LINES, *(f'#include "{each}"' for each in headers)]
            for number, text in wanted.items():
                variable = f"static const long long {_PREFIX}{number} __attribute__((used)) = (long long)({text});"
                lines.append(f"void cfepy_{number}(void) {{ {variable} }}")
            source.write_text("\n".join(lines) + "\n", encoding="utf-8")
            try:
                compile_file(source, made, ["-w", *ERRORS, *flags])
            except CompilerError as error:
                wrong = {int(each) for each in _IN_FUNCTION.findall(str(error))} & set(wanted)
                if not wrong:
                    raise
                for number in wrong:
                    del wanted[number]
            else:
                found = _read(read_limited(made, OBJECT_BYTES))
                return {text: found[number] for number, text in wanted.items() if number in found}
    return {}


def _read(data: bytes) -> dict[int, int]:
    elf = elf_file(BytesIO(data))
    found = {}
    for each in elf.get_section_by_name(".symtab").iter_symbols():
        if each.name.startswith(_PREFIX) and isinstance(each["st_shndx"], int):
            section = elf.get_section(each["st_shndx"])
            at = each["st_value"]
            content = bytes(_LAYOUT.size) if section["sh_type"] == "SHT_NOBITS" else section.data()[at : at + 8]
            found[int(each.name.removeprefix(_PREFIX).partition(".")[0])] = _LAYOUT.unpack(content)[0]
    return found
