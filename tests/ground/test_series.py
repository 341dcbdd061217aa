"""Values over time: of a mission, of a journal's replay and of a bag."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import NamedTuple

import numpy
import pytest

from cfepy.ground.bag import BagRecorder
from cfepy.ground.mcap_recorder import McapRecorder
from cfepy.ground.series import SeriesRecorder, SeriesSet, bag_series, meanings
from cfepy.pilot import RunPlan, fly, takeoff
from cfepy.status import UsageError

PLAN = RunPlan(("capture",), seconds=2.5)


class Recorded(NamedTuple):
    """A run of capture."""

    trace: str
    of_run: SeriesRecorder
    of_bag: SeriesSet


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Recorded:
    file = str(tmp_path_factory.mktemp("bag") / "run.bag")
    recorder = SeriesRecorder()
    with BagRecorder(file) as bag:
        flown = fly(PLAN, attachments=[recorder, bag])
    return Recorded(flown.results.trace, recorder, bag_series(file))


def test_topic_has_values_over_time(recorded: Recorded) -> None:
    series = recorded.of_run.series("/joint_states")
    times, positions = series.to_numpy("position")
    assert positions.shape == (len(series), 7)
    assert positions.dtype == times.dtype == numpy.float64
    assert (numpy.diff(times) > 0).all()
    assert series.times_ns[0] == round(times[0] * 1e9) == 550_016_000
    assert series.stamps_ns[0] == 316_533_800_550_016_000
    assert (series.to_numpy("position[1:3]").values == positions[:, 1:3]).all()
    assert series.to_numpy("name").values[0][0] == "shoulder_roll"
    assert repr(series) == f"</joint_states: {len(series)} of sensor_msgs/JointState>"


def test_packet_has_values_over_time(recorded: Recorded) -> None:
    series = recorded.of_run.series("CFE_TIME_HK_TLM")
    times, seconds = series.to_numpy("MET.Seconds")
    assert times.shape == (len(series),)
    assert (series.stamps_ns // 1_000_000_000 - 1_000_000).tolist() == seconds.tolist()
    assert series.type == "telemetry"


def test_bag_has_the_same_values_as_the_run(recorded: Recorded) -> None:
    of_run, of_bag = recorded.of_run.series("/joint_states"), recorded.of_bag.series("/joint_states")
    assert (of_run.to_numpy("position").values == of_bag.to_numpy("position").values).all()
    assert (of_run.stamps_ns == of_bag.stamps_ns).all()
    assert set(recorded.of_bag.names) == {name for name in recorded.of_run.names if name.startswith("/")}


def test_series_recorder_does_not_change_the_run(recorded: Recorded) -> None:
    assert fly(PLAN).results.trace == recorded.trace


def test_selected_series_are_recorded() -> None:
    asked = SeriesRecorder(["/joint_states.position", "CFE_ES.HK_TLM.CommandCounter", "0x0801", "CFE_TBL_SEND_HK"])
    with takeoff(PLAN, attachments=[asked]) as run:
        run.run_until(1_500_000_000)
        before = len(asked.series("/joint_states").messages)
        run.go()
    assert asked.names == ["/joint_states", "CFE_ES_HK_TLM", "CFE_EVS_HK_TLM", "CFE_TBL_SEND_HK"]
    assert asked.series("CFE_TBL_SEND_HK").type == "command"
    assert len(asked.series("/joint_states").messages) > before


@pytest.mark.parametrize(
    ("word", "name", "field"),
    [
        ("/joint_states", "/joint_states", ""),
        ("/joint_states.position[2]", "/joint_states", "position[2]"),
        ("/joint_states/position[2]", "/joint_states", "position[2]"),
        ("/arm_health/samples/data", "/arm_health/samples", "data"),
        ("/arm_health/samples.data", "/arm_health/samples", "data"),
        ("CFE_ES_HK_TLM.CommandCounter", "CFE_ES_HK_TLM", "CommandCounter"),
        ("CFE_ES.HK_TLM.CommandCounter", "CFE_ES_HK_TLM", "CommandCounter"),
    ],
)
def test_word_selects_a_series_and_a_field(recorded: Recorded, word: str, name: str, field: str) -> None:
    series, found = recorded.of_run.found(word)
    assert (series.name, found) == (name, field)


def test_pattern_selects_several_topics(recorded: Recorded) -> None:
    assert len(recorded.of_run.matching("/arm_health/*")) == 4
    assert [field for _, field in recorded.of_run.matching("/phase.data")] == ["data"]
    with pytest.raises(UsageError, match="unknown topic"):
        recorded.of_run.matching("/leg/*")


def test_word_selects_nested_topics() -> None:
    assert list(meanings("/a/b.c")) == [("/a/b", "c"), ("/a", "b.c")]


@pytest.mark.parametrize(
    ("word", "why"),
    [
        ("/joint_state.position", "unknown topic or packet; did you mean /joint_states"),
        ("/joint_states.positon", "unknown field of /joint_states; did you mean position"),
        ("/joint_states.position[7]", r"index out of range; the last item is position\[6\]"),
        ("/joint_states.header", "not a single field; name one of its fields: header.seq, header.stamp"),
        ("/joint_states", "not a single field; name one of its fields: header, name"),
    ],
)
def test_unknown_name_suggests_known_names(recorded: Recorded, word: str, why: str) -> None:
    def values() -> object:
        series, field = recorded.of_run.found(word)
        return series.to_numpy(field)

    with pytest.raises(UsageError, match=why):
        values()


def test_unknown_packet_is_refused() -> None:
    with pytest.raises(UsageError, match="unknown telemetry packet CFE_ES_HK_TIM; did you mean CFE_ES_HK_TLM"):
        fly(PLAN, attachments=[SeriesRecorder(["CFE_ES_HK_TIM.CommandCounter"])])


def test_a_bag_has_topics_only(tmp_path: Path) -> None:
    file = str(tmp_path / "x.bag")
    with BagRecorder(file):
        pass
    with pytest.raises(UsageError, match="CFE_ES_HK_TLM is not a topic"):
        bag_series(file, ["CFE_ES_HK_TLM"])


@pytest.mark.slow
def test_mcap_file_has_the_packets_of_the_run(tmp_path: Path) -> None:
    file, recorder = str(tmp_path / "run.mcap"), SeriesRecorder()
    with McapRecorder(file) as mcap:
        fly(PLAN, attachments=[recorder, mcap])
    found = bag_series(file)
    assert {"CFE_ES_HK_TLM", "CFE_EVS_LONG_EVENT_MSG", "/joint_states"} <= set(found.names)
    for name in ("CFE_ES_HK_TLM", "CFE_EVS_LONG_EVENT_MSG", "CFE_TIME_HK_TLM", "HK_HK_TLM"):
        of_run, of_file = recorder.series(name), found.series(name)
        ours, theirs = of_run.columns(), of_file.columns()
        assert list(ours) == list(theirs)
        for column, values in ours.items():
            assert numpy.array_equal(values, theirs[column]), (name, column)
        assert numpy.allclose(of_run.stamps_ns, of_file.stamps_ns, atol=1000, rtol=0)
        apart = set(of_run.times_ns - of_file.times_ns)
        assert len(apart) == 1, "the file begins with its first message on a topic"
    alone = bag_series(file, ["CFE_ES_HK_TLM.SysLogBytesUsed"])
    assert alone.names == ["CFE_ES_HK_TLM"]
    with pytest.raises(UsageError, match="did you mean CFE_ES_HK_TLM"):
        bag_series(file, ["CFE_ES_HK_TM.SysLogBytesUsed"]).found("CFE_ES_HK_TM.SysLogBytesUsed")


@pytest.mark.slow
def test_a_table(recorded: Recorded) -> None:
    series = recorded.of_run.series("/joint_states")
    pytest.importorskip("pandas")
    table = series.to_pandas("position", "header.stamp")
    assert list(table.columns) == [*(f"position[{number}]" for number in range(7)), "header.stamp"]
    assert table.index.name == "time"
    assert (table["position[1]"].to_numpy() == series.to_numpy("position").values[:, 1]).all()


def test_a_table_without_pandas(recorded: Recorded, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(UsageError, match="pip install pandas"):
        recorded.of_run.series("/joint_states").to_pandas()
