"""Expressions with recorded values from a real ROS 1 master give the same values and errors in a node."""

from __future__ import annotations

import json
from pathlib import Path

from rospy_shim.types.config import NodeConfig
from tests.rospy_shim.missions import run_nodes

RECORD = Path(__file__).parents[2] / "data" / "rospy_behaviour.json"

EVALUATOR = """
import json, re, sys, warnings
import genpy, rospy
from geometry_msgs.msg import Point, PointStamped
from std_msgs.msg import ColorRGBA, Header, String

rospy.init_node("probe_node", log_level=rospy.FATAL)
rospy.set_param("/t/a", 1)
rospy.set_param("/t/b", {"c": 2.5, "d": [1, "x", True]})
NAMES = {**globals(), "T": rospy.Time, "D": rospy.Duration}

def plain(value):
    if isinstance(value, (int, float, str, bool, list, dict, type(None))):
        return value
    return re.sub("0x[0-9a-f]+", "0x..", repr(value))

def outcome(expression):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            row = {"result": plain(eval(expression, NAMES))}
        except Exception as error:
            text = str(error).partition(" and no __dict__")[0]  # which newer interpreters add
            row = {"result": {"raises": type(error).__name__, "text": text[:160]}}
    row["expression"] = expression
    if caught:
        row["warns"] = caught[0].category.__name__
    return row

expressions = json.load(open("expressions.json"))
json.dump([outcome(expression) for expression in expressions], open("outcomes.json", "w"), default=repr)
"""


def test_values_equal_the_record_of_ros(tmp_path: Path) -> None:
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    (tmp_path / "expressions.json").write_text(
        json.dumps([row["expression"] for row in record["rows"]]), encoding="utf-8"
    )
    run = run_nodes(
        tmp_path, {"PROBE": EVALUATOR}, nodes={"PROBE": NodeConfig("PROBE", args=tuple(record["arguments"]))}
    )
    assert (tmp_path / "outcomes.json").is_file(), "\n".join(run.lines)
    outcomes = json.loads((tmp_path / "outcomes.json").read_text(encoding="utf-8"))
    different = [(row, outcome) for row, outcome in zip(record["rows"], outcomes, strict=True) if row != outcome]
    assert not different
