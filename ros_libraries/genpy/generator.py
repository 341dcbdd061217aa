"""Python source from message and service definitions: `msg_generator`, `srv_generator`, and the writing of files."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import genmsg
from genmsg import InvalidMsgSpec, MsgContext, MsgGenerationException, MsgSpec
from genmsg.base import log
from genmsg.gentools import compute_full_type_name
from genmsg.msg_loader import load_depends, load_msg_from_file, load_srv_from_file

from ._expressions import (
    Special,
    compute_constructor,
    compute_full_text_escaped,
    compute_import,
    compute_pkg_type,
    compute_post_deserialize,
    default_value,
    flatten,
    get_registered_ex,
    get_special,
    is_special,
    make_python_safe,
)
from ._serializers import (
    INDENT,
    array_serializer_generator,
    complex_serializer_generator,
    deserialize_fn_generator,
    len_serializer_generator,
    next_var,
    pop_context,
    push_context,
    reset_var,
    serialize_fn_generator,
    serializer_generator,
    simple_serializer_generator,
    string_serializer_generator,
)
from .base import SIMPLE_TYPES, is_simple
from .generate_struct import clear_patterns, get_patterns

__all__ = [
    "INDENT",
    "SIMPLE_TYPES",
    "Generator",
    "InvalidMsgSpec",
    "MsgContext",
    "MsgGenerationException",
    "MsgGenerator",
    "MsgSpec",
    "Special",
    "SrvGenerator",
    "array_serializer_generator",
    "complex_serializer_generator",
    "compute_constructor",
    "compute_full_text_escaped",
    "compute_import",
    "compute_outfile_name",
    "compute_pkg_type",
    "compute_post_deserialize",
    "compute_resource_name",
    "default_value",
    "deserialize_fn_generator",
    "flatten",
    "get_registered_ex",
    "get_special",
    "is_simple",
    "is_special",
    "len_serializer_generator",
    "log",
    "make_python_safe",
    "msg_generator",
    "next_var",
    "pop_context",
    "push_context",
    "reset_var",
    "serialize_fn_generator",
    "serializer_generator",
    "simple_serializer_generator",
    "srv_generator",
    "string_serializer_generator",
]

Source = Iterator[str]
SearchPath = dict[str, list[str]]


def msg_generator(msg_context: MsgContext, spec: MsgSpec, search_path: SearchPath) -> Source:
    """Source of a message class, line by line.

    Args:
        msg_context: the known types.
        spec: the message.
        search_path: where types that are not known are looked for.

    Raises:
        MsgGenerationException: a definition has a mistake.
        MsgNotFound: one is not there.
    """
    try:
        load_depends(msg_context, spec, search_path)
    except InvalidMsgSpec as error:
        problem = f"Cannot generate .msg for {spec.package}/{spec.short_name}: {error}"
        raise MsgGenerationException(problem) from None
    md5sum = genmsg.compute_md5(msg_context, spec)
    safe = make_python_safe(spec)
    clear_patterns()
    yield "# This Python file uses the following encoding: utf-8"
    yield f'"""Made by genpy from {spec.full_name}.msg; changes will be lost."""'
    yield from ("import codecs", "import struct", "import sys", "", "import genpy")
    yield from sorted({line for kind in spec.types for line in compute_import(msg_context, spec.package, kind)})
    yield from ("", "python3 = sys.hexversion > 0x03000000", "")
    yield f"class {spec.short_name}(genpy.Message):"
    yield f'{INDENT}_md5sum = "{md5sum}"'
    yield f'{INDENT}_type = "{spec.full_name}"'
    yield f"{INDENT}_has_header = {spec.has_header()}"
    yield f"{INDENT}_full_text = {genmsg.compute_full_text(msg_context, spec)!r}"
    yield from (f"{INDENT}{constant.name} = {constant.val!r}" for constant in safe.constants)
    yield f"{INDENT}__slots__ = {safe.names!r}"
    yield f"{INDENT}_slot_types = {safe.types!r}"
    yield from _constructor(msg_context, safe)
    yield from ("", f"{INDENT}def _get_types(self):", f"{INDENT * 2}return self._slot_types")
    yield from _functions(msg_context, spec)
    yield from _structs()


def _constructor(msg_context: MsgContext, spec: MsgSpec) -> Source:
    defaults = [(name, default_value(msg_context, kind, spec.package)) for kind, name in spec.fields()]
    yield ""
    yield f"{INDENT}def __init__(self, *args, **kwds):"
    yield f"{INDENT * 2}if args or kwds:"
    yield f"{INDENT * 3}super({spec.short_name}, self).__init__(*args, **kwds)"
    for name, default in defaults:
        yield f"{INDENT * 3}if self.{name} is None:"
        yield f"{INDENT * 4}self.{name} = {default}"
    if defaults:
        yield f"{INDENT * 2}else:"
        yield from (f"{INDENT * 3}self.{name} = {default}" for name, default in defaults)


def _functions(msg_context: MsgContext, spec: MsgSpec) -> Source:
    safe = make_python_safe(spec)
    for head, body, source, is_numpy in (
        ("serialize(self, buff)", serialize_fn_generator, spec, False),
        ("deserialize(self, str)", deserialize_fn_generator, safe, False),
        ("serialize_numpy(self, buff, numpy)", serialize_fn_generator, spec, True),
        ("deserialize_numpy(self, str, numpy)", deserialize_fn_generator, safe, True),
    ):
        yield ""
        yield f"{INDENT}def {head}:"
        yield from (INDENT * 2 + line for line in body(msg_context, source, is_numpy))


def _structs() -> Source:
    """Yield the code of `_get_struct_<pattern>` for the functions."""
    yield ""
    yield "_struct_I = genpy.struct_I"
    yield "def _get_struct_I():"
    yield f"{INDENT}return _struct_I"
    for pattern in sorted(set(get_patterns()) - {"I"}):
        yield f'_struct_{pattern} = struct.Struct("<{pattern}")'
        yield f"def _get_struct_{pattern}():"
        yield f"{INDENT}return _struct_{pattern}"
    clear_patterns()


def srv_generator(msg_context: MsgContext, spec: Any, search_path: SearchPath) -> Source:
    """Yield the source of a service: request, response, and a class that holds both; see `msg_generator`."""
    for part in (spec.request, spec.response):
        yield from msg_generator(msg_context, part, search_path)
    load_depends(msg_context, spec, search_path)
    yield f"class {spec.short_name}(object):"
    yield f"{INDENT}_type = '{spec.full_name}'"
    yield f"{INDENT}_md5sum = '{genmsg.compute_md5(msg_context, spec)}'"
    yield f"{INDENT}_request_class = {spec.short_name}Request"
    yield f"{INDENT}_response_class = {spec.short_name}Response"


def compute_resource_name(filename: str, ext: str) -> str:
    """Bare name of the type in a file."""
    return os.path.basename(filename).removesuffix(ext)


def compute_outfile_name(outdir: str, infile_name: str, ext: str) -> str:
    """File that the source of a definition is written to."""
    return os.path.join(outdir, f"_{compute_resource_name(infile_name, ext)}.py")


class Generator:
    """Writes source files.

    Args:
        what: name of its output, for errors.
        ext: file name extension of the definitions.
        spec_loader_fn: reads one of them.
        generator_fn: `msg_generator` or `srv_generator`.
    """

    def __init__(
        self, what: str, ext: str, spec_loader_fn: Callable[..., Any], generator_fn: Callable[..., Source]
    ) -> None:
        self.what, self.ext = what, ext
        self.spec_loader_fn, self.generator_fn = spec_loader_fn, generator_fn

    def generate(self, msg_context: MsgContext, full_type: str, f: str, outdir: str, search_path: SearchPath) -> str:
        """Write the source of one definition. Returns the path of the file."""
        os.makedirs(outdir, exist_ok=True)
        spec = self.spec_loader_fn(msg_context, f, full_type)
        outfile = compute_outfile_name(outdir, os.path.basename(f), self.ext)
        with open(outfile, "w", encoding="utf-8") as file:
            file.writelines(line + "\n" for line in self.generator_fn(msg_context, spec, search_path))
        return outfile

    def generate_messages(
        self, package: str, package_files: Iterable[str], outdir: str, search_path: SearchPath
    ) -> int:
        """Write the sources of several definitions of a package.

        Returns:
            0, or 1 if one of them could not be written; the error is on stderr.

        Raises:
            MsgGenerationException: the package's name is invalid.
        """
        if not genmsg.is_legal_resource_base_name(package):
            problem = f"package name '{package}' is illegal and cannot be used in message generation."
            raise MsgGenerationException(f"\nERROR: {problem}\nPlease see http://ros.org/wiki/Names")
        context, code = MsgContext.create_default(), 0
        for file in map(os.path.abspath, package_files):
            try:
                full_type = compute_full_type_name(package, os.path.basename(file))
                self.generate(context, full_type, file, outdir, search_path)
            except Exception as error:
                if not isinstance(error, (MsgGenerationException, InvalidMsgSpec)):
                    traceback.print_exc()
                where = f"for package '{package}': while processing '{file}'"
                print(f"\nERROR: Unable to generate {self.what} {where}: {error}\n", file=sys.stderr)
                code = 1
        return code


class SrvGenerator(Generator):
    """Writes services."""

    def __init__(self) -> None:
        super().__init__("services", genmsg.EXT_SRV, load_srv_from_file, srv_generator)


class MsgGenerator(Generator):
    """Writes messages."""

    def __init__(self) -> None:
        super().__init__("messages", genmsg.EXT_MSG, load_msg_from_file, msg_generator)
