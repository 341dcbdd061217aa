"""Dictionaries of C applications: their packets, commands and tables by name, from where they are declared first.

Readers and writers of electronic data sheets, COSMOS text, XTCE and debug data belong here. The ground tools
that use the names are in `cfepy.ground`. The central file is `cfepy/extra/dictionaries/packets.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.dictionaries.c_header import header_difference
    from cfepy.extra.dictionaries.cosmos_reader import read_cosmos
    from cfepy.extra.dictionaries.cosmos_writer import cosmos_text
    from cfepy.extra.dictionaries.ctf_writer import ctf_files
    from cfepy.extra.dictionaries.debug_cache import cached_content
    from cfepy.extra.dictionaries.debug_data import read_debug_data
    from cfepy.extra.dictionaries.design_parameters import DesignParameters
    from cfepy.extra.dictionaries.eds_defaults import DEFAULTS
    from cfepy.extra.dictionaries.eds_packets import DataSheets
    from cfepy.extra.dictionaries.eds_types import EdsTypes
    from cfepy.extra.dictionaries.file_sources import contents_of_files
    from cfepy.extra.dictionaries.mission_sources import contents_of
    from cfepy.extra.dictionaries.placed_types import memory_layout, wire_layout
    from cfepy.extra.dictionaries.python_writer import python_text
    from cfepy.extra.dictionaries.xml_tags import read_document
    from cfepy.extra.dictionaries.xtce_reader import read_xtce

__all__ = [
    "DEFAULTS",
    "DataSheets",
    "DesignParameters",
    "EdsTypes",
    "cached_content",
    "contents_of",
    "contents_of_files",
    "cosmos_text",
    "ctf_files",
    "header_difference",
    "memory_layout",
    "python_text",
    "read_cosmos",
    "read_debug_data",
    "read_document",
    "read_xtce",
    "wire_layout",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".c_header": ("header_difference",),
            ".cosmos_reader": ("read_cosmos",),
            ".cosmos_writer": ("cosmos_text",),
            ".ctf_writer": ("ctf_files",),
            ".debug_cache": ("cached_content",),
            ".debug_data": ("read_debug_data",),
            ".design_parameters": ("DesignParameters",),
            ".eds_defaults": ("DEFAULTS",),
            ".eds_packets": ("DataSheets",),
            ".eds_types": ("EdsTypes",),
            ".file_sources": ("contents_of_files",),
            ".mission_sources": ("contents_of",),
            ".placed_types": ("memory_layout", "wire_layout"),
            ".python_writer": ("python_text",),
            ".xml_tags": ("read_document",),
            ".xtce_reader": ("read_xtce",),
        },
    )
