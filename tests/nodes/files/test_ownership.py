"""Owners of files and users of programs: one ordinary user, with any user and umask of cfepy itself."""

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest

from cfepy.journal import read_journal, record
from cfepy.nodes.files import GROUP, USER, Overlay
from cfepy.pilot.pilot import fly
from cfepy.pilot.plan import NODE, RunPlan
from tests.journal.replays import assert_same_again
from tests.nodes.conftest import Program

pytestmark = pytest.mark.skipif(not hasattr(os, "getuid"), reason="users are those of POSIX")
Run = Callable[..., Program]
REFUSED = "[Errno 13] Permission denied"


@pytest.fixture
def lines(run: Run, tmp_path: Path) -> Callable[[str], list[str]]:
    """Return the output of a program in a folder with a file and a folder of the host."""
    (tmp_path / "host").write_text("host", encoding="utf-8")
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "file").write_text("inner", encoding="utf-8")

    def flown(source: str, **env: str) -> list[str]:
        return run(source, overlay=Overlay(), cwd=tmp_path, env=env).lines

    return flown


def test_all_files_belong_to_one_user(lines: Callable[[str], list[str]]) -> None:
    found = lines(
        """
        import os
        open("own", "w").close()
        os.mkdir("folder")
        os.symlink("own", "link")
        os.mkfifo("pipe")
        for name in ("host", "inner", "own", "folder", "link", "pipe", "/", "/etc"):
            facts = os.lstat(name)
            print(facts.st_uid, facts.st_gid, facts.st_dev)
        with open("host") as file:
            print(os.fstat(file.fileno()).st_uid, next(os.scandir("."), None).stat().st_gid)
        """
    )
    assert found == [f"{USER} {GROUP} 1"] * 8 + [f"{USER} {GROUP}"]


def test_child_program_has_the_user_of_the_run(lines: Callable[[str], list[str]]) -> None:
    before = os.getuid(), os.getgid(), os.getgroups()
    found = lines(
        """
        import os
        print(os.getuid(), os.geteuid(), os.getgid(), os.getegid(), os.getgroups())
        print(os.getresuid(), os.getresgid(), os.getpgrp() == os.getpid() == os.getsid(0))
        os.setuid(os.getuid()); os.setresgid(-1, os.getgid(), -1); os.setgroups(os.getgroups())
        for change in (os.setuid, os.seteuid, os.setgid, os.setegid):
            try:
                change(0)
            except PermissionError as error:
                print(error)
        try:
            os.setgroups([])
            os.setgroups([0])
        except PermissionError as error:
            print(error)
        """
    )
    assert found[0] == f"{USER} {USER} {GROUP} {GROUP} [{GROUP}]"
    assert found[1] == f"({USER}, {USER}, {USER}) ({GROUP}, {GROUP}, {GROUP}) True"
    assert found[2:] == ["[Errno 1] Operation not permitted"] * 5
    assert (os.getuid(), os.getgid(), os.getgroups()) == before


@pytest.mark.parametrize("name", ["anna", "root"])
def test_user_names_come_from_the_environment(lines: Callable[..., list[str]], name: str) -> None:
    found = lines(
        """
        import getpass, grp, os, pathlib, pwd
        print(getpass.getuser(), os.getlogin(), pwd.getpwuid(os.getuid()).pw_dir, grp.getgrgid(os.getgid()).gr_name)
        print(pathlib.Path("host").owner(), pathlib.Path("host").group(), os.path.expanduser("~"))
        print(pwd.getpwnam("root").pw_name, len(pwd.getpwall()), len(grp.getgrall()))
        for ask, key in ((pwd.getpwuid, 7), (pwd.getpwnam, "x"), (grp.getgrgid, 7), (grp.getgrnam, "x")):
            try:
                ask(key)
            except KeyError as error:
                print(error)
        """,
        USER=name,
        HOME="/home/of",
    )
    count = 1 if name == "root" else 2
    assert found[:3] == [f"{name} {name} /home/of {name}", f"{name} {name} /home/of", f"root {count} {count}"]
    assert found[3] == "'getpwuid(): uid not found: 7'"
    assert len(found) == 7


def test_user_without_a_name_is_node(lines: Callable[[str], list[str]]) -> None:
    assert lines("import getpass, os\nprint(getpass.getuser(), os.getlogin())") == ["node node"]


def test_permissions_do_not_depend_on_the_umask_of_the_computer(lines: Callable[[str], list[str]]) -> None:
    source = """
    import os, stat
    open("own", "w").close()
    os.mkdir("folder")
    os.close(os.open("private", os.O_CREAT | os.O_WRONLY, 0o600))
    for name in ("host", "inner", "own", "folder", "private"):
        print(oct(stat.S_IMODE(os.stat(name).st_mode)))
    print(oct(os.umask(0o077)))
    """
    mask = os.umask(0o077)
    try:
        found = lines(source)
    finally:
        os.umask(mask)
    assert found == ["0o644", "0o755", "0o644", "0o755", "0o600", "0o22"]


@pytest.mark.parametrize(
    ("act", "told"),
    [
        ("os.chmod('own', 0); open('own')", "'own'"),
        ("os.chmod('own', 0o444); open('own', 'a')", "'own'"),
        ("os.chmod('own', 0o200); open('own', 'r+')", "'own'"),
        ("os.chmod('inner', 0o600); open('inner/file')", "'inner/file'"),
        ("os.chmod('inner', 0o600); os.stat('inner/none')", "'inner/none'"),
        ("os.chmod('inner', 0o300); os.listdir('inner')", "'inner'"),
        ("os.chmod('inner', 0o500); open('inner/new', 'w')", "'inner/new'"),
        ("os.chmod('inner', 0o500); os.remove('inner/file')", "'inner/file'"),
        ("os.chmod('inner', 0o500); os.rename('inner/file', 'away')", "'inner/file' -> 'away'"),
        ("os.chmod('inner', 0); os.chdir('inner')", "'inner'"),
        ("open('locked', 'w')", "'locked'"),
    ],
)
def test_user_of_a_run_is_not_root(lines: Callable[[str], list[str]], tmp_path: Path, act: str, told: str) -> None:
    (tmp_path / "locked").write_text("host", encoding="utf-8")
    os.chmod(tmp_path / "locked", 0o444)
    before = {path: path.stat().st_mode for path in tmp_path.iterdir()}
    source = f"import os\nopen('own', 'w').close()\ntry:\n    {act}\nexcept PermissionError as error:\n    print(error)"
    assert lines(source) == [f"{REFUSED}: {told}"]
    assert {path: path.stat().st_mode for path in before} == before


def test_access_checks_the_user_of_the_run(lines: Callable[[str], list[str]]) -> None:
    found = lines(
        """
        import os
        open("own", "w").close()
        os.chmod("own", 0o400)
        asked = os.F_OK, os.R_OK, os.W_OK, os.X_OK
        print([os.access(name, bits) for name in ("own", "inner", "none") for bits in asked])
        print(os.access("/dev/null", os.W_OK))
        """
    )
    assert found == [str([True, True, False, False, True, True, True, True, False, False, False, False]), "True"]


def test_file_of_the_host_can_be_written_in_the_run_for_any_owner(lines: Callable[[str], list[str]]) -> None:
    before = Path("/etc/passwd").read_bytes()
    found = lines(
        "open('/etc/passwd', 'a').write('x')\nopen('/etc/new', 'w').write('y')\nprint(open('/etc/new').read())"
    )
    assert found == ["y"]
    assert Path("/etc/passwd").read_bytes() == before
    assert not os.path.exists("/etc/new")


def test_permissions_of_an_open_host_file_are_private_to_the_run(
    lines: Callable[[str], list[str]], tmp_path: Path
) -> None:
    host = tmp_path / "host"
    os.chmod(host, 0o640)
    found = lines(
        """
        import os, stat
        with open("host") as file:
            number = file.fileno()
            os.fchmod(number, 0o777)
            os.chmod(number, 0o700)
            print(oct(stat.S_IMODE(os.fstat(number).st_mode)), oct(stat.S_IMODE(os.stat("host").st_mode)))
            os.fchown(number, -1, -1)
            for change in (lambda: os.fchown(number, 0, 0), lambda: os.setxattr(number, "user.x", b"1")):
                try:
                    change()
                except PermissionError:
                    print("refused")
        open("host", "a").close()
        print(oct(stat.S_IMODE(os.stat("host").st_mode)))
        """
    )
    assert found == ["0o700 0o700", "refused", "refused", "0o700"]
    assert stat.S_IMODE(host.stat().st_mode) == 0o640


def test_inaccessible_folders_are_removed_after_the_run(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    overlay = Overlay()
    run("import os\nos.makedirs('d/e')\nopen('d/e/f', 'w').close()\nos.chmod('d', 0)", overlay=overlay, cwd=tmp_path)
    assert len(list(tmp_path.glob("cfepy-files-*"))) == 1
    overlay.close()
    assert not list(tmp_path.glob("cfepy-files-*"))


ASKING = """
import os, pwd, rospy
rospy.init_node("asking")
open("own", "w").close()
print(os.getuid(), os.stat("own"), os.stat("host"), os.access("host", os.W_OK), os.stat("."))
"""


def test_journal_replays_for_another_user_with_another_umask(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The journal also covers files of root and of others."""
    home = tmp_path / "home"
    home.mkdir()
    (home / "host").write_text("x", encoding="utf-8")
    (home / "asking.py").write_text(ASKING, encoding="utf-8")
    monkeypatch.chdir(home)
    plan = RunPlan((str(home / "asking.py"),), seconds=1.0, command=NODE, tasks="thread")
    flown = record(plan, tmp_path / "run.cfepy")
    journal = read_journal(tmp_path / "run.cfepy")
    monkeypatch.setattr(os, "getuid", lambda: 4711)
    mask = os.umask(0o077)
    try:
        assert_same_again(journal, flown.trace)
        os.chmod(home / "host", 0o600)
        if os.geteuid() == 0:
            os.chown(home / "host", 65534, 65534)
        assert fly(plan).trace == flown.trace
    finally:
        os.umask(mask)


APP = """
import os, pathlib, pwd

def Asking(cfe):
    open("own", "w").close()
    facts = os.stat("own")
    cfe.os.printf(f"uid {os.getuid()} {facts.st_uid} {pwd.getpwuid(os.getuid()).pw_uid} {pathlib.Path('own').owner()}")
"""


def test_application_has_the_user_of_the_run(tmp_path: Path) -> None:
    (tmp_path / "startup.scr").write_text("CFE_APP, asking, Asking, ASKING, 90, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    (tmp_path / "asking.py").write_text(APP, encoding="utf-8")
    found = fly(RunPlan((str(tmp_path),), seconds=1.0)).mission.console.lines
    assert f"uid {USER} {USER} {USER} node" in found
