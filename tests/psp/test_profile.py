"""Board profiles: the shipped ones, and the errors of invalid ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.config.platform import MAY_BE_ZERO, PlatformConfig
from cfepy.psp.profile import DEFAULT_NODE_CALL_NS, MemoryRegion, available_boards, load_profile
from cfepy.status import UsageError

DOUBLED = "".join(f", a{i}: &a{i} [*a{i - 1}, *a{i - 1}]" for i in range(1, 40))


def test_shipped_boards() -> None:
    assert {"linux", "rx64m"} <= set(available_boards())
    for name in available_boards():
        assert load_profile(name).name == name


def test_linux_has_no_limits() -> None:
    board = load_profile("linux")
    assert board.config() == PlatformConfig()
    assert (board.cpu_hz, board.tick_ns, board.sram_size, board.max_publish_hz) == (0, 0, 0, 0)
    assert board.node_call_ns == DEFAULT_NODE_CALL_NS
    assert board.cycles_ns(1000) == 0


def test_rx64m() -> None:
    board = load_profile("rx64m")
    assert (board.cpu_hz, board.tick_ns, board.max_publish_hz) == (120_000_000, 10_000_000, 100)
    assert (board.program_flash, board.data_flash, board.sram_size) == (4 << 20, 64 << 10, 552 << 10)
    assert MemoryRegion("standby", 8 << 10, retained=True) in board.sram
    assert board.cycles_ns(1) == 9
    assert board.cycles_ns(300) == 2500
    assert (board.watchdog_max_ms, board.ports) == (34_952, ())


def test_rx64m_pools_and_core_stacks_fit_its_memory() -> None:
    board = load_profile("rx64m")
    config = board.config()
    pools = config.sb_buf_memory_bytes + config.tbl_buf_memory_bytes
    core_stacks = 8 * config.es_default_stack_size
    app_stacks = config.es_max_applications * 16384
    retained = sum(region.size for region in board.sram if region.retained)
    assert config.es_cds_size <= retained
    assert pools + core_stacks + app_stacks < board.sram_size - retained
    assert config.os_queue_max_depth == PlatformConfig().os_queue_max_depth


def write(path: Path, text: str) -> Path:
    file = path / "board.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_a_file_by_path(tmp_path: Path) -> None:
    board = load_profile(write(tmp_path, "name: mine\ncpu_hz:\nprogram_flash: 2 MiB\nlimits: {sb_max_pipes: 5}\n"))
    assert (board.name, board.cpu_hz, board.program_flash) == ("mine", 0, 2 << 20)
    assert board.config().sb_max_pipes == 5


def test_limits_are_numbers_or_switches(tmp_path: Path) -> None:
    text = "name: mine\nlimits: {time_cfg_fake_tone: false, time_def_met_subs: 0, time_cfg_client: true}\n"
    config = load_profile(write(tmp_path, text)).config()
    assert (config.time_cfg_fake_tone, config.time_def_met_subs, config.time_cfg_client) == (False, 0, True)
    with pytest.raises(UsageError, match=r"limits\.time_cfg_client: must be true or false, not 1"):
        load_profile(write(tmp_path, "name: mine\nlimits: {time_cfg_client: 1}\n"))


@pytest.mark.parametrize("name", sorted(MAY_BE_ZERO))
def test_limit_for_which_zero_has_a_meaning_may_be_zero(tmp_path: Path, name: str) -> None:
    config = load_profile(write(tmp_path, f"name: mine\nlimits: {{{name}: 0}}\n")).config()
    assert getattr(config, name) == 0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "board.yaml:1: missing name; a board profile starts with `name: ...`"),
        ("- a\n", "board.yaml:1: must be a mapping"),
        ("name: x\nspeed: 3\n", "board.yaml:2: speed: unknown field; expected name, description, cpu_hz"),
        ("name: x\ncpu_hz: fast\n", "board.yaml:2: cpu_hz: must be a whole number"),
        ("name: x\ncpu_hz: -1\n", "board.yaml:2: cpu_hz: must be a whole number of at least 0, not -1"),
        ("name: 7\n", "board.yaml:1: name: must be text, not 7; put it in quotes"),
        ("name: x\nsram:\n  - {name: a}\n", "board.yaml:3: sram[0]: missing size"),
        ("name: x\nsram: {}\n", "board.yaml:2: sram: must be a list, not {}"),
        ("name: x\nsram:\n  - {name: a, size: 5 KB}\n", "board.yaml:3: sram[0].size: must be bytes"),
        (
            "name: x\nsram:\n  - {name: a, size: 5, retained: 1}\n",
            "board.yaml:3: sram[0].retained: must be true or false, not 1",
        ),
        ("name: x\nlimits:\n  sb_pipes: 1\n", "board.yaml:3: limits.sb_pipes: unknown field"),
        ("name: x\nlimits:\n  sb_max_pipes: 0\n", "board.yaml:3: limits.sb_max_pipes: must be a whole number"),
        (
            "name: x\nlimits:\n  sb_max_pipes: true\n",
            "board.yaml:3: limits.sb_max_pipes: must be a whole number of at least 1, not true",
        ),
        ("name: x\nmemory_costs: {pipes: 1}\n", "board.yaml:2: memory_costs.pipes: unknown field"),
        ("name: x\nname: y\n", "board.yaml:2: 'name' is given twice"),
        ("name: [x\n", "board.yaml:2: is not YAML"),
        ("7: x\n", "board.yaml:1: must be text, not 7"),
        ("name: !thing x\n", "board.yaml:1: is not YAML"),
    ],
)
def test_errors_of_a_profile_have_their_line(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(UsageError) as caught:
        load_profile(write(tmp_path, text))
    assert str(caught.value).startswith(f"{tmp_path}/{message}")


def test_all_mistakes_of_a_profile_are_raised_together(tmp_path: Path) -> None:
    text = """\
nam: x
cpu_hz: fast
sram:
- {name: a, size: big, retained: 1}
- {nme: b}
ports: [{name: 1, address: x, size: -1}]
limits: {sb_max_pipe: 3, os_max_tasks: many}
memory_costs: {mutex: a, queue_slots: b}
"""
    with pytest.raises(UsageError) as caught:
        load_profile(write(tmp_path, text))
    fields = "nam cpu_hz sram[0].size sram[0].retained sram[1].nme ports[0].name ports[0].address ports[0].size "
    fields += "limits.sb_max_pipe limits.os_max_tasks memory_costs.queue_slots"
    assert [error.field for error in caught.value.each] == fields.split()
    assert "nam: unknown field; did you mean name?" in str(caught.value)


def test_unknown_boards() -> None:
    with pytest.raises(UsageError, match="unknown board 'vax'; expected gr716, linux, rx64m, scobc_a1, workstation or"):
        load_profile("vax")
    with pytest.raises(UsageError, match=r"nowhere\.yaml: cannot be read"):
        load_profile("nowhere.yaml")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("data_flash: 99999999999999999999999", "must be at most 4294967296"),
        ("data_flash: 99999999 MiB", "must be at most 4096 MiB"),
        ("limits: {es_cds_size: 99999999999999999999999}", "must be at most 2147483647"),
        ("tick_ns: 99999999999999999999999", "must be at most 4611686018427387903"),
        ("limits: {a0: &a0 [x, x]" + DOUBLED + "}", "has more than 100,000 values"),
        ("sram: &x [*x]", "has an alias that contains itself"),
        ("sram: " + "[" * 3000 + "]" * 3000, "is nested too deeply"),
    ],
)
def test_absurd_boards(tmp_path: Path, text: str, said: str) -> None:
    board = tmp_path / "board.yaml"
    board.write_text(f"name: absurd\n{text}\n", encoding="utf-8")
    with pytest.raises(UsageError, match=said):
        load_profile(board)
