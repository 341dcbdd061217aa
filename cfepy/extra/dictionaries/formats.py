"""The formats in which a mission's dictionary is written; each makes the texts of files by name, or one text."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cfepy.extra.dictionaries.cosmos_writer import cosmos_text
from cfepy.extra.dictionaries.ctf_writer import ctf_files
from cfepy.extra.dictionaries.python_writer import python_text
from cfepy.ground import Dictionary
from cfepy.mission import MissionSpec

FORMATS: Mapping[str, Callable[[MissionSpec, Dictionary], str | Mapping[str, str]]] = {
    "cosmos": cosmos_text,
    "ctf": ctf_files,
    "python": python_text,
}
