"""Points other than calls: between two accesses, two lines, or a call and the use of its result."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from textwrap import dedent

import pytest

from cfepy.cli.main import main
from cfepy.extra.exploration import Expedition, Report, Trial
from cfepy.pilot import RunPlan
from cfepy.schedules import Schedule

SCRIPT = "CFE_APP, {}.py, __main__, {}, 100, 16384, 0x0, 1;\n!\n"
COUNTER = """
    import sys
    import threading
    import time


    class Counter:
        def __init__(self):
            self.n = 0

        def add(self):
            for _ in range(3):
                time.sleep(0.01)
                self.n = self.n + 1


    def run():
        counter = Counter()
        threads = [threading.Thread(target=counter.add) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        if counter.n != 6:
            sys.exit(f"counted {counter.n}")


    run()
"""
CLOCK = """
    import sys
    import threading
    import time

    last = 0.0
    wrong = []


    def look():
        global last
        for _ in range(3):
            now = time.time()
            if now < last:
                wrong.append(now)
            last = now


    def run():
        threads = [threading.Thread(target=look) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        if wrong:
            sys.exit("time went back")


    run()
"""
APP = """
    class Counter:
        def __init__(self):
            self.n = 0

    counter = Counter()

    def main(cfe):
        cfe.es.create_child_task("CHILD", lambda: child(cfe), 8192, 100)
        add(cfe)
        cfe.os.task_delay(200)
        if counter.n != 60:
            cfe.es.exit_app(3)
        while cfe.es.run_loop():
            cfe.os.task_delay(100)

    def child(cfe):
        add(cfe)

    def add(cfe):
        for _ in range(30):
            counter.n += 1
            cfe.os.task_delay(5)
"""
Plans = Callable[[str, str], RunPlan]


@pytest.fixture
def plan_of(tmp_path: Path) -> Plans:
    def write(name: str, source: str) -> RunPlan:
        (tmp_path / f"{name}.py").write_text(dedent(source), encoding="utf-8")
        (tmp_path / "startup.scr").write_text(SCRIPT.format(name, name.upper()), encoding="utf-8")
        return RunPlan((str(tmp_path),), seconds=1.0)

    return write


def explored(plan: RunPlan, points: str, seeds: int = 15) -> Report:
    return Expedition(plan, seeds=seeds, policy="random", points=points, jobs=1).run()


@pytest.mark.parametrize("points", ["attributes", "lines"])
@pytest.mark.slow
def test_update_in_one_line_is_lost_between_its_accesses(plan_of: Plans, points: str) -> None:
    plan = plan_of("counter", COUNTER)
    assert explored(plan, "").findings == []
    found = explored(plan, points).findings
    assert bool(found) == (points == "attributes")  # a statement is one step, where points are at lines
    if found:
        assert found[0].shrunk is not None
        assert found[0].shrunk.verdict.schedule.points == points
        assert any("self.n = self.n + 1" in line for line in found[0].timeline)


@pytest.mark.slow
def test_clock_value_is_outdated_when_a_task_gets_in_before_its_use(plan_of: Plans) -> None:
    plan = plan_of("clock", CLOCK)
    assert explored(plan, "").findings == []
    assert [told.finding.failure.title for told in explored(plan, "calls").findings] == [
        "ended with an error: CLOCK: exit status 1 (node /CLOCK): time went back"
    ]


@pytest.mark.slow
def test_points_are_limited_to_named_modules(plan_of: Plans) -> None:
    plan = plan_of("counter", COUNTER)
    package = Path(plan.words[0]) / "other"
    package.mkdir()
    (package / "__init__.py").write_text("", encoding="utf-8")
    (package / "part.py").write_text("", encoding="utf-8")
    node = Path(plan.words[0]) / "counter.py"
    node.write_text(f"import other.part\n{node.read_text(encoding='utf-8')}", encoding="utf-8")
    assert explored(plan, "attributes:other").findings == []
    assert explored(plan, "attributes:part,counter").findings != []


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ("attributes:countr", "--points: the mission loads no module 'countr'; did you mean counter?"),
        ("lines:counter,arm", "--points: the mission loads no module 'arm'; it has counter"),
    ],
)
def test_module_that_the_mission_does_not_load_is_an_error(
    plan_of: Plans, points: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words = plan_of("counter", COUNTER).words
    assert main(["explore", *words, "--for", "1", "--seeds", "2", "--points", points, "--quiet"]) == 2
    assert said in capsys.readouterr().err


@pytest.mark.slow
def test_package_stands_for_its_modules(plan_of: Plans) -> None:
    plan = plan_of("starter", "import parts.counter\n")
    package = Path(plan.words[0]) / "parts"
    package.mkdir()
    (package / "__init__.py").write_text("", encoding="utf-8")
    (package / "counter.py").write_text(dedent(COUNTER), encoding="utf-8")
    assert explored(plan, "attributes:starter").findings == []
    assert explored(plan, "attributes:parts").findings != []


@pytest.mark.parametrize("kind", ["lines", "attributes", "calls"])
def test_points_do_not_change_the_default_run(plan_of: Plans, kind: str) -> None:
    trial = Trial(plan_of("counter", COUNTER))
    plain, pointed = (trial.run(Schedule.parse(text)) for text in ("at", f"at:points={kind}"))
    assert (plain.failures, plain.trace) == (pointed.failures, pointed.trace)
    assert plain.decisions <= pointed.decisions


def test_run_with_points_has_one_trace_on_threads_and_greenlets(plan_of: Plans) -> None:
    pytest.importorskip("greenlet")
    plan = plan_of("counter", COUNTER)
    schedule = Schedule.parse("random:3:points=attributes")
    one, other = (
        Trial(RunPlan(plan.words, seconds=1.0, tasks=tasks)).run(schedule) for tasks in ("thread", "greenlet")
    )
    assert one.trace == other.trace
    assert one.decisions == other.decisions > 0


@pytest.mark.slow
def test_apps_have_points(plan_of: Plans) -> None:
    folder = Path(plan_of("app", APP).words[0])
    (folder / "startup.scr").write_text("CFE_APP, app, main, APP, 100, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    plan = RunPlan((str(folder),), seconds=1.0)
    assert explored(plan, "").findings == []
    assert explored(plan, "attributes").findings != []


def test_a_command_line_has_points(plan_of: Plans, capsys: pytest.CaptureFixture[str]) -> None:
    words = plan_of("counter", COUNTER).words
    assert main(["run", *words, "--for", "1", "--points", "every", "--quiet"]) == 2
    assert (
        "--points: invalid kind of points 'every'; expected lines, attributes, calls or shared"
        in capsys.readouterr().err
    )
    assert main(["explore", *words, "--for", "1", "--points", "lines:", "--quiet"]) == 2
    assert "invalid module ''; write for instance lines:arm,util" in capsys.readouterr().err
    assert main(["run", *words, "--for", "1", "--points", "lines:counter", "--quiet"]) == 0


@pytest.mark.slow
def test_variables_without_points_are_reported_as_gaps(plan_of: Plans) -> None:
    plan = plan_of("counter", COUNTER)
    assert explored(plan, "", 2).breadth.gaps == ["Counter.add (counter.py:14): Counter.n"]
    guarded = COUNTER.replace("self.n = self.n + 1", "with lock: self.n = self.n + 1")
    guarded = guarded.replace("    class Counter", "    lock = threading.Lock()\n\n\n    class Counter")
    assert explored(plan_of("counter", guarded), "", 2).breadth.gaps == []
