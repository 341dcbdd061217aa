"""OSAL's shell (osapi-shell.h): a few commands on the virtual file system, with their output written to a file.

NASA's Linux passes the line to the host's shell; a simulated computer has none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from cfepy.osal.files import DirectoryApi
from cfepy.osal.limits import OS_MAX_CMD_LEN
from cfepy.osal.paths import PathApi
from cfepy.status import OS_ERROR, OsalError

Command = Callable[[Sequence[str]], bytes]


class ShellApi(PathApi, DirectoryApi):
    """OS_ShellOutputToFile: cat, cp, echo, ls, mkdir, mv, rm, rmdir."""

    def shell_output_to_file(self, cmd: str, filedes: int) -> None:
        """Run a command line, and write its output to a file (OS_ShellOutputToFile).

        Args:
            cmd: a command and its words, quoted as in sh; no pipes, no redirection, no variables.
            filedes: a file open for writing.

        Raises:
            OsalError: OS_ERR_INVALID_ID, OS_ERR_OPERATION_NOT_SUPPORTED for a socket, OS_ERROR if the command fails,
                with the reason in the file.
        """
        self._file(filedes)
        output, failed = self._run(cmd)
        if output:
            self.write(filedes, output)
        if failed:
            raise OsalError(OS_ERROR, f"{cmd!r} failed: {output.decode().strip()}")

    def _run(self, cmd: str) -> tuple[bytes, bool]:
        """Return the output of a command line, and whether it failed."""
        import shlex  # few missions have a shell, and a boot would pay for the import

        try:
            words = shlex.split(cmd[: OS_MAX_CMD_LEN - 1])
        except ValueError as error:
            return f"sh: {error}\n".encode(), True
        if not words:
            return b"", False
        name, *arguments = words
        command = self._shell_commands().get(name)
        if command is None:
            return f"sh: {name}: not found\n".encode(), True
        try:
            return command(arguments), False
        except OsalError as error:
            return f"{name}: {error}\n".encode(), True

    def _shell_commands(self) -> dict[str, Command]:
        return {
            "cat": lambda paths: b"".join(self.files.read_file(path) for path in paths),
            "cp": lambda paths: self._silently(self.cp, paths, 2),
            "echo": lambda texts: (" ".join(texts) + "\n").encode(),
            "ls": lambda paths: "".join(f"{name}\n" for path in paths for name in self.files.list_dir(path)).encode(),
            "mkdir": lambda paths: self._silently(self.mkdir, paths, 1),
            "mv": lambda paths: self._silently(self.mv, paths, 2),
            "rm": lambda paths: self._silently(self.remove, paths, 1),
            "rmdir": lambda paths: self._silently(self.rmdir, paths, 1),
        }

    def _silently(self, function: Callable[..., object], paths: Sequence[str], count: int) -> bytes:
        if len(paths) != count:
            raise OsalError(OS_ERROR, f"takes {count} path{'s' * (count > 1)}")
        function(*paths)
        return b""
