"""OSAL's shell (osapi-shell.h): a few commands on the virtual file system, with their output written to a file.

NASA's Linux passes the line to the host's shell; a simulated computer has none. The commands refuse the same requests
as the host's, such as a copy of a file onto itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from cfepy.osal.files import DirectoryApi
from cfepy.osal.limits import (
    OS_FILE_FLAG_CREATE,
    OS_FILE_FLAG_TRUNCATE,
    OS_MAX_CMD_LEN,
    OS_SEEK_END,
    OS_WRITE_ONLY,
)
from cfepy.osal.paths import PathApi
from cfepy.osal.volumes import FileNode
from cfepy.status import OS_ERROR, OsalError

Command = Callable[[Sequence[str], FileNode], bytes]
_TOKEN = r"""\s*(?:(?P<sign>>>|[<>|;&()]+)|(?P<word>(?:\\.|'[^']*'|"(?:\\.|[^"\\])*"|[^\s<>|;&()'"\\])+))\s*"""


class _Line(NamedTuple):
    """A command line: its words, and the file that gets the output instead; `appends` if it is not emptied first."""

    words: list[str]
    target: str
    appends: bool


class ShellApi(PathApi, DirectoryApi):
    """OS_ShellOutputToFile: cat, cp, echo, ls, mkdir, mv, rm, rmdir."""

    def shell_output_to_file(self, cmd: str, filedes: int) -> None:
        """Run a command line, and write its output to a file (OS_ShellOutputToFile).

        Args:
            cmd: a command and its words, quoted as in sh, and perhaps `> FILE` or `>> FILE`; no pipes, no variables.
            filedes: a file open for writing.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_OPERATION_NOT_SUPPORTED for a socket, OS_ERROR if the command fails,
                with the reason in the file.
        """
        output = self._file(filedes).node
        try:
            line = _parse(cmd[: OS_MAX_CMD_LEN - 1])
            if line.target:
                self._redirect(line)
                return
            told = self._run(line.words, output)
        except _Complaint as complaint:
            self.write(filedes, f"{complaint}\n".encode())
            raise OsalError(OS_ERROR, f"{cmd!r} failed: {complaint}") from None
        if told:
            self.write(filedes, told)

    def _redirect(self, line: _Line) -> None:
        """Run a command whose output goes to a file of its own, which is emptied before the command runs."""
        flags = OS_FILE_FLAG_CREATE | (0 if line.appends else OS_FILE_FLAG_TRUNCATE)
        try:
            filedes = self.open_create(line.target, flags, OS_WRITE_ONLY)
        except OsalError as error:
            raise _Complaint(f"sh: cannot create {line.target}: {error}") from None
        try:
            self.lseek(filedes, 0, OS_SEEK_END)
            told = self._run(line.words, self._file(filedes).node)
            if told:
                self.write(filedes, told)
        except (OsalError, _Complaint) as error:
            self._close_again([filedes])
            raise _Complaint(str(error)) from None
        self._close_again([filedes])

    def _run(self, words: Sequence[str], output: FileNode) -> bytes:
        """Return the output of a command, which goes to the file `output`."""
        if not words:
            return b""
        name, *arguments = words
        command = self._shell_commands().get(name)
        if command is None:
            raise _Complaint(f"sh: {name}: not found")
        try:
            return command(arguments, output)
        except OsalError as error:
            raise _Complaint(f"{name}: {error}") from None

    def _shell_commands(self) -> dict[str, Command]:
        return {
            "cat": lambda paths, output: b"".join(self._content(path, output) for path in paths),
            "cp": lambda paths, _: self._onto(self.cp, paths),
            "echo": lambda texts, _: (" ".join(texts) + "\n").encode(),
            "ls": lambda paths, _: "".join(
                f"{name}\n" for path in paths for name in self.files.list_dir(path)
            ).encode(),
            "mkdir": lambda paths, _: self._on_one(self.mkdir, paths, "already exists" if self._exists(paths) else ""),
            "mv": lambda paths, _: self._onto(self.mv, paths),
            "rm": lambda paths, _: self._on_one(self.remove, paths, self._is_folder(paths) and "is a folder"),
            "rmdir": lambda paths, _: self._on_one(self.rmdir, paths),
        }

    def _exists(self, paths: Sequence[str]) -> bool:
        return bool(paths) and self.files.exists(paths[0])

    def _is_folder(self, paths: Sequence[str]) -> bool:
        return bool(paths) and self.files.is_folder(paths[0])

    def _content(self, path: str, output: FileNode) -> bytes:
        data = self.files.read_file(path)
        if data and self.files.find(path) is output:
            raise OsalError(OS_ERROR, f"{path}: input file is output file")
        return data

    def _onto(self, function: Callable[[str, str], object], paths: Sequence[str]) -> bytes:
        """Copy or move to a path, or into a folder."""
        _check_count(paths, 2)
        source, target = paths
        if self.files.is_folder(target):
            target = f"{target.rstrip('/')}/{source.rstrip('/').rpartition('/')[2]}"
        if self.files.exists(source) and self.files.translate(source)[:2] == self.files.translate(target)[:2]:
            raise OsalError(OS_ERROR, f"{source} and {target} are the same file")
        function(source, target)
        return b""

    def _on_one(self, function: Callable[[str], object], paths: Sequence[str], obstacle: str | bool = "") -> bytes:
        _check_count(paths, 1)
        if obstacle:
            raise OsalError(OS_ERROR, f"{paths[0]} {obstacle}")
        function(paths[0])
        return b""


class _Complaint(Exception):
    """The reason why a command line failed, as the shell writes it."""


def _check_count(paths: Sequence[str], count: int) -> None:
    if len(paths) != count:
        raise OsalError(OS_ERROR, f"takes {count} path{'s' * (count > 1)}")


def _parse(cmd: str) -> _Line:
    import re  # few missions have a shell, and a boot would pay for the imports
    import shlex

    tokens, at = [], 0
    while at < len(cmd.rstrip()):
        found = re.compile(_TOKEN, re.DOTALL).match(cmd, at)
        if found is None:
            raise _Complaint("sh: No closing quotation")
        tokens.append(found)
        at = found.end()
    words: list[str] = []
    target, appends = "", False
    while tokens:
        token = tokens.pop(0)
        sign = token["sign"]
        if sign is None:
            words += shlex.split(token["word"])
        elif sign in (">", ">>") and tokens and tokens[0]["word"] and not target:
            target, appends = "".join(shlex.split(tokens.pop(0)["word"])), sign == ">>"
        else:
            raise _Complaint(f"sh: {sign} is not supported here")
    return _Line(words, target, appends)
