"""Limits of inputs work at the right place, and their errors say what to do."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import msgpack
import pytest

from cfepy.cli.ground.export import file_name
from cfepy.cli.main import main
from cfepy.journal import read_journal, staged
from cfepy.journal.frame_check import check_values
from cfepy.journal.journal import JournalError
from cfepy.reading.contained_files import make_folder, write_contained
from cfepy.reading.input_files import read_limited, text_limited
from cfepy.reading.input_limits import BAG_CHUNK_BYTES, JOURNAL_VALUES, YAML_DEPTH
from cfepy.reading.plain_yaml import YamlError, plain_yaml
from cfepy.status import UsageError
from dev.fuzz.sample_journal import sample, with_frames
from ros_libraries.rosbag_storage import compression


def test_file_of_another_kind_or_size_is_refused(tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(b"a\r\nb")
    assert read_limited(tmp_path / "x", 4) == b"a\r\nb"
    assert text_limited(tmp_path / "x", 4) == "a\nb"
    with pytest.raises(UsageError, match=r"x: has more than the limit of 3 bytes"):
        read_limited(tmp_path / "x", 3)
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", Path("/dev/zero")):
        with pytest.raises(UsageError, match="a device or a pipe"):
            read_limited(path, 3)


def test_yaml_beyond_its_limits_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cfepy.reading.plain_yaml.YAML_VALUES", 1000)
    assert len(plain_yaml("[" + "1," * 999 + "]")) == 999
    for text, said in (
        ("[" + "1," * 1000 + "]", "more than 1,000 values"),
        ("[" * (YAML_DEPTH + 1), "nested too deeply"),
        ("\n- &a [*a]", "an alias that contains itself, line 2"),
        ("a: 1\nb: !!timestamp soon", "invalid timestamp.*line 2"),
        ("!!int ''", "invalid int"),
        ("0x" + "f" * 2000, "digits"),
    ):
        with pytest.raises(YamlError, match=said):
            plain_yaml(text)
    assert plain_yaml("'" + "1" * 2000 + "'") == "1" * 2000, "a text may be as long as it likes"


def test_limit_of_chunks_equals_the_limit_of_inputs() -> None:
    assert compression.LARGEST == BAG_CHUNK_BYTES


def test_packed_values_are_counted_before_they_are_unpacked() -> None:
    for value in ({"a": [1, -1, 2.5, None, True, b"x" * 70_000, "text" * 100]}, list(range(30_000)), "x" * 70_000):
        check_values(msgpack.packb(value))
    with pytest.raises(ValueError, match="more than 1,000,000 values"):
        check_values(b"\xdd" + (JOURNAL_VALUES + 1).to_bytes(4, "big") + b"\x90" * (JOURNAL_VALUES + 1))
    with pytest.raises(ValueError, match="truncated"):
        check_values(b"\xdd\0\0\xff\xff" + b"\x90" * 65_530 + b"\xdb\0\0\xff\xff")


def test_files_stay_in_their_folder(tmp_path: Path) -> None:
    root = tmp_path / "root"
    root.mkdir()
    write_contained(root, "/a/b", b"1")
    assert (root / "a/b").read_bytes() == b"1"
    (root / "link").symlink_to(tmp_path)
    (root / "file").symlink_to(tmp_path / "canary")
    for name in ("a", "/../x", "/a/../../x", "//x", "/a/./b", "/a/", "/", "/a\0", "/link/canary", "/" + "x" * 5000):
        with pytest.raises(UsageError):
            write_contained(root, name, b"")
    with pytest.raises(OSError, match="symbolic links"):
        write_contained(root, "/file", b"")
    with pytest.raises(UsageError, match="through a symbolic link"):
        make_folder(root, "/link/x")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["root"]


def test_tables_of_a_bag_are_written_into_their_folder() -> None:
    for topic in ("/../../x", "..", "/a\0b", "~/x", "C:\\x", "/x\n"):
        name = file_name(topic)
        assert "/" not in name
        assert "\\" not in name
        assert name.isprintable()


def test_journal_is_unpacked_unchanged_and_removed(tmp_path: Path) -> None:
    (tmp_path / "run.cfepy").write_bytes(sample())
    found = read_journal(tmp_path / "run.cfepy")
    with staged(found) as stage:
        for path, file in found.files.items():
            assert Path(stage.root + path).read_bytes() == file.data
        assert Path(stage.root).is_dir()
    assert not Path(stage.root).exists()


def test_info_of_a_journal_runs_and_unpacks_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def change(kind: str, body: dict[str, object]) -> None:
        if kind == "file":
            body.update(packed=b"no zlib at all", size=5)

    with_frames(tmp_path / "run.cfepy", change)
    seen = []

    def hook(event: str, values: tuple[object, ...]) -> None:
        if watching and event in ("open", "os.mkdir", "os.symlink", "exec", "subprocess.Popen", "socket.connect"):
            seen.append((event, values[0]))

    watching = False
    sys.addaudithook(hook)
    main(["replay", "--info", str(tmp_path / "run.cfepy")])  # load all modules now
    watching = True
    assert main(["replay", "--info", str(tmp_path / "run.cfepy")]) == 0
    watching = False
    assert set(seen) == {("open", str(tmp_path / "run.cfepy"))}
    with pytest.raises(JournalError, match="cannot be unpacked"), staged(read_journal(tmp_path / "run.cfepy")):
        pass
    assert "trace:" in capsys.readouterr().out


@pytest.mark.slow
def test_temporary_folders_are_removed_after_sigterm(tmp_path: Path) -> None:
    (tmp_path / "run.cfepy").write_bytes(sample())
    program = (
        "import sys, cfepy.journal.replay_files as stage\n"
        "from cfepy.cli.main import main\n"
        "def wait(journal, *_):\n    print('unpacked', flush=True)\n    sys.stdin.read()\n"
        "stage._show_lines = wait\n"
        "sys.exit(main(['replay', sys.argv[1]]))\n"
    )
    (tmp_path / "tmp").mkdir()
    process = subprocess.Popen(
        [sys.executable, "-c", program, str(tmp_path / "run.cfepy")],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env={**os.environ, "TMPDIR": str(tmp_path / "tmp")},
    )
    assert process.stdout is not None
    assert process.stdout.readline() == b"unpacked\n"
    assert len(list((tmp_path / "tmp").iterdir())) == 1
    process.send_signal(signal.SIGTERM)
    assert process.wait() == 130
    assert list((tmp_path / "tmp").iterdir()) == []
