"""Callbacks, nodes and applications that use the processor for a while."""

from __future__ import annotations

from pathlib import Path

import pytest

import cfepy
from tests.extra.exploration import missions

APP = """
def Work(cfe):
    cfe.evs.register()
    cfe.es.run_loop(1)
    before = cfe.psp.get_time()
    cfe.psp.compute(30_000)
    after = cfe.psp.get_time()
    cfe.evs.send_info(1, "%d us" % ((after - before) // 10))
    cfe.es.run_loop(1)
"""


PRINTED = """
    import cfepy
    import rospy
    from std_msgs.msg import Float64
    from std_srvs.srv import Empty, EmptyResponse

    rospy.init_node("slow")


    def take(message):
        print("message", round((rospy.get_time() - message.data) * 1e3))


    rospy.Service("~reset", Empty, lambda request: EmptyResponse())
    rospy.Subscriber("work", Float64, take)
    work = rospy.Publisher("work", Float64, queue_size=1)
    rospy.sleep(0.1)
    work.publish(rospy.get_time())
    rospy.sleep(0.1)
    before = rospy.get_time()
    rospy.ServiceProxy("~reset", Empty)()
    print("request", round((rospy.get_time() - before) * 1e3))
    before = rospy.get_time()
    cfepy.compute(0.02)
    print("compute", round((rospy.get_time() - before) * 1e3))
"""


@pytest.mark.parametrize(("yaml", "times"), [("", (0, 0, 20)), ("{work: 5 ms, ~reset: 1 ms}", (5, 1, 20))])
def test_callbacks_handlers_and_nodes_take_their_compute_time(
    tmp_path: Path, yaml: str, times: tuple[int, ...]
) -> None:
    folder = missions.write(tmp_path, {"SLOW": PRINTED})
    (folder / "mission.yaml").write_text(f"nodes: {{SLOW: {{compute: {yaml or '{}'}}}}}\n", encoding="utf-8")
    run = cfepy.run(str(folder), seconds=1)
    message, request, compute = times
    printed = [line.partition("] ")[2] for line in run.console if line.startswith("[slow] ")]
    assert printed == [f"message {message}", f"request {request}", f"compute {compute}"]


def test_application_takes_its_compute_time(tmp_path: Path) -> None:
    (tmp_path / "work.py").write_text(APP, encoding="utf-8")
    (tmp_path / "startup.scr").write_text("CFE_APP, work, Work, WORK, 50, 8192, 0, 0;\n!\n", encoding="utf-8")
    with cfepy.boot(str(tmp_path)) as flight:
        flight.run_for(1)
        flight.expect_event("WORK", 1, text="30000 us", within=0)


def test_invalid_compute_time_is_refused(tmp_path: Path) -> None:
    folder = missions.write(tmp_path, {"SLOW": "import cfepy\ncfepy.compute(-1)\n"})
    (folder / "mission.yaml").write_text("nodes: {SLOW: {compute: {work: soon}}}\n", encoding="utf-8")
    with pytest.raises(cfepy.UsageError, match=r"mission.yaml:1: nodes.SLOW.compute.work: "):
        cfepy.run(str(folder), seconds=1)
    (folder / "mission.yaml").unlink()
    assert any("invalid time -1 s" in line for line in cfepy.run(str(folder), seconds=1).console)


def test_compute_does_nothing_on_the_host() -> None:
    cfepy.compute(1000)
    with pytest.raises(ValueError, match="expected 0 or more"):
        cfepy.compute(-1)
