"""The releases that a mission can select, from `releases/NAME.toml`, and the versions that cFE, OSAL and PSP report.

A release is data: a new one is another file. Code that only some releases have asks for a fact of the release by its
name. The files are TOML with one value in each line, which this module reads itself, because a boot has no time for
the library.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from cfepy.status import UsageError

FOLDER = Path(__file__).parent / "releases"
"""The files of the releases."""
SUFFIX = ".toml"
LIMIT = "limits."
DEFAULT_RELEASE = "7.0.1"
"""The release of a mission that names none; not 7.0.0, which refuses every table that the ground loads."""
MODULES = ("CORE_API", "ES", "EVS", "FS", "SB", "TBL", "TIME", "OSAL", "PSP", "MSG", "SBR", "RESOURCEID", "CONFIG")
"""The parts of the flight software, in the order of ES's version messages."""

DEVELOPMENT = 255
"""The mission revision of a build between two releases."""
_APPS = "v7.0.0"  # the version of NASA's lab and sample applications, with every release

Numbers = tuple[int, ...]


class Version(NamedTuple):
    """The version of a component.

    Attributes:
        number: major, minor, revision, mission revision.
        codename: of the release.
        build_number: commits since the release; 0 for a release.
    """

    number: Numbers
    codename: str
    build_number: int

    @property
    def official(self) -> str:
        """Its name, "v7.0.1" (CFE_LAST_OFFICIAL)."""
        return "v{}.{}.{}".format(*self.number)

    @property
    def source(self) -> str:
        """The version of its source, "v7.0.1+dev0" (CFE_SRC_VERSION, OS_VERSION, CFE_PSP_IMPL_VERSION)."""
        return f"{self.official}+dev{self.build_number}"

    @property
    def status(self) -> str:
        """The text of its mission revision, such as "v7.0.1 Official Release" (CFE_Config_GetMissionRevString)."""
        revision = self.number[3]
        if revision == 0:
            return f"{self.official} Official Release"
        return f"{'DEV BUILD' if revision == DEVELOPMENT else f'M{revision}'}, based on {self.official}"


class Release:
    """A release of cFE, with the OSAL and the PSP of its bundle; docs/reference/differences.md has the facts in words.

    Args:
        values: the attributes by name; they never change.

    Attributes:
        codename: its code name.
        build_number: commits since the release, of the components that are development builds; 0 for a release.
        cfe, osal, psp: major, minor, revision, mission revision of each.
        longest_entry: number of characters of a startup script entry, without blanks, that ES reads.
        early_inits: the calls before the core applications, as the system log names them; each has CFE_MODULE.
        early_init_failed: the line of one that fails, with its name and its status.
        core_apps: the core applications, without CFE_, in the order of their AppIDs.
        cleanup: the services in the order in which they release the resources of an ended application.
        load_reserves_buffer: LOAD reserves a working buffer; otherwise it finds none, and is refused.
        load_of_recovered_table_stays: the load of a recovered critical table stays in progress.
        sizes_of_32_bits: offset and size of a table file are added in 32 bits.
        update_needs_activation: a valid image waits for ACTIVATE.
        notification_is_whole: the notification of an owner has its parameter.
        notification_always_counts: a request is reported as sent even if the owner wants no notification.
        one_validation_at_a_time: a table with a pending validation gets no other.
        validation_has_crc_of_load: a validation reports the CRC of the load, not of the buffer now.
        validation_without_function_marks: VALIDATE marks the image of a table without function as valid, uncounted.
        failed_validation_unmarks: an image that fails loses an earlier mark.
        failed_validation_has_status: event 96 has the function's status.
        no_buffer_event: the event of VALIDATE without such a buffer.
        reports_long_path: a path that is too long gives an event.
        reports_unknown_table: VALIDATE and ACTIVATE report an unknown table.
        reports_bad_buffer_number: a buffer number that does not exist has an event of its own.
        reports_invalid_handle: CFE_TBL_Load reports an invalid handle.
        names_table_of_file: events of a file name the file's table, not the one that cFE found.
        names_file_without_table: the event of a file for no table names the file.
        loaded, file_for_no_table, dump, no_buffer, too_many_validations, assumed_valid: texts of events.
        activate_dump_only, activate_nothing, activate_unvalidated: texts of events.
        limits: the limits that differ from those in `cfepy.config.platform`, from lines such as
            `limits.sb_max_pipes = 64`.
    """

    codename: str
    build_number: int
    cfe: Numbers
    osal: Numbers
    psp: Numbers
    longest_entry: int
    early_inits: tuple[str, ...]
    early_init_failed: str
    core_apps: tuple[str, ...]
    cleanup: tuple[str, ...]
    load_reserves_buffer: bool
    load_of_recovered_table_stays: bool
    sizes_of_32_bits: bool
    update_needs_activation: bool
    notification_is_whole: bool
    notification_always_counts: bool
    one_validation_at_a_time: bool
    validation_has_crc_of_load: bool
    validation_without_function_marks: bool
    failed_validation_unmarks: bool
    failed_validation_has_status: bool
    no_buffer_event: int
    reports_long_path: bool
    reports_unknown_table: bool
    reports_bad_buffer_number: bool
    reports_invalid_handle: bool
    names_table_of_file: bool
    names_file_without_table: bool
    loaded: str
    file_for_no_table: str
    dump: str
    no_buffer: str
    too_many_validations: str
    assumed_valid: str
    activate_dump_only: str
    activate_nothing: str
    activate_unvalidated: str
    limits: Mapping[str, int]

    def __init__(self, values: Mapping[str, object]) -> None:
        vars(self).update(values)

    @property
    def cfe_version(self) -> Version:
        """The version of cFE."""
        return self._version(self.cfe)

    @property
    def osal_version(self) -> Version:
        """The version of OSAL."""
        return self._version(self.osal)

    @property
    def psp_version(self) -> Version:
        """The version of the PSP."""
        return self._version(self.psp)

    def _version(self, number: Numbers) -> Version:
        return Version(number, self.codename, self.build_number if number[3] == DEVELOPMENT else 0)

    @property
    def bundle(self) -> str:
        """The versions in one line, as in ES's version message."""
        return f"cfe {self.cfe_version.source}, osal {self.osal_version.source}, psp {self.psp_version.source}"

    def module(self, name: str) -> str:
        """Return the source version of one of `MODULES`."""
        version = {"OSAL": self.osal_version, "PSP": self.psp_version}.get(name, self.cfe_version)
        return f"git:{version.official}"

    def text(self, component: str) -> str:
        """Return the long version text of a component of cFE."""
        version = self.cfe_version
        return f"{component} {version.source} ({self.codename}) {version.status}, EDS disabled"


class Releases(Mapping[str, Release]):
    """The releases by their name in a mission file; a file is read when its release is used."""

    def __init__(self) -> None:
        self._read: dict[Path, Release] = {}

    def __getitem__(self, name: str) -> Release:
        file = FOLDER / f"{name}{SUFFIX}"
        if file not in self._read:
            if name not in self:
                raise KeyError(name)
            self._read[file] = read_release(file)
        return self._read[file]

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and f"{name}{SUFFIX}" in os.listdir(FOLDER)

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(file.removesuffix(SUFFIX) for file in os.listdir(FOLDER) if file.endswith(SUFFIX)))

    def __len__(self) -> int:
        return sum(1 for _ in self)


RELEASES = Releases()
"""The releases by their name in a mission file."""


def read_release(file: Path) -> Release:
    """Read the file of a release.

    The file is TOML with one value a line. This function reads it, because each boot does, and the import of tomllib
    takes 7 ms.

    Raises:
        UsageError: a value is missing, unknown, or of another kind, with its line.
    """
    kinds = Release.__annotations__
    limits: dict[str, object] = {}
    values: dict[str, object] = {"limits": limits}
    for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
        name, is_value, text = (part.strip() for part in line.partition("="))
        if not name or name.startswith("#"):
            continue
        if name.startswith(LIMIT) and text.isdecimal():
            limits[name.removeprefix(LIMIT)] = int(text)
            continue
        if name not in kinds or not is_value:
            raise UsageError(f"unknown value {name!r} of a release", file=file, line=number)
        value = values[name] = _value(text)
        if not _is_of_kind(value, kinds[name]):
            raise UsageError(f"must be {_KINDS[kinds[name]]}, not {text}", file=file, line=number, field=name)
    missing = [name for name in kinds if name not in values]
    if missing:
        raise UsageError(f"missing {', '.join(missing)}; add {'them' if len(missing) > 1 else 'it'}", file=file)
    return Release(values)


def _value(text: str) -> object:
    """Return a plain value of TOML: a truth value, a text, a number or an array; None for any other text."""
    if text in ("true", "false"):
        return text == "true"
    if len(text) > 1 and text[0] == text[-1] == '"' and '"' not in text[1:-1] and "\\" not in text:
        return text[1:-1]
    if text.startswith("[") and text.endswith("]"):
        return tuple(_value(part.strip()) for part in text[1:-1].split(","))
    return int(text) if text.isdecimal() else None


_KINDS = {
    "bool": "true or false",
    "int": "a number",
    "str": "a text in quotation marks",
    "Numbers": "a list of four numbers",
    "tuple[str, ...]": "a list of texts",
}


def _is_of_kind(value: object, kind: str) -> bool:
    if kind == "Numbers":
        return isinstance(value, tuple) and len(value) == 4 and all(type(part) is int for part in value)
    if kind.startswith("tuple"):
        return isinstance(value, tuple) and all(isinstance(part, str) for part in value)
    return type(value).__name__ == kind


def version_string(
    component: str, version: str = f"{_APPS}+dev0", codename: str = "Draco", official: str = _APPS
) -> str:
    """Return the long version text of a component, as CFE_Config_GetVersionString makes it.

    Args:
        component: its name.
        version: version of this build.
        codename: code name of its release.
        official: version of the last official release.
    """
    return f"{component} {version} ({codename}) {official} Official Release, EDS disabled"


class VersionFunctions:
    """The version functions that OSAL and the PSP both have; the class that inherits them sets `_version`."""

    _version: Version

    def get_version_string(self) -> str:
        """Return the version that this one corresponds to (OS_GetVersionString, CFE_PSP_GetVersionString)."""
        return self._version.source

    def get_version_code_name(self) -> str:
        """Return the code name of that release (OS_GetVersionCodeName, CFE_PSP_GetVersionCodeName)."""
        return self._version.codename

    def get_version_number(self) -> Numbers:
        """Return major, minor, revision and mission revision (OS_GetVersionNumber, CFE_PSP_GetVersionNumber)."""
        return self._version.number

    def get_build_number(self) -> int:
        """Return the build number, 0 for a release (OS_GetBuildNumber, CFE_PSP_GetBuildNumber)."""
        return self._version.build_number
