"""Standard modules that find a class through the name of its module find the node's classes."""

from __future__ import annotations

import pytest

HELPER = """
from __future__ import annotations
import dataclasses, typing

@dataclasses.dataclass
class Base:
    number: int
    kind: typing.ClassVar[int] = 3

class Plain:
    text: Text
    def method(self) -> Text: ...

class Text(str):
    pass
"""

HEAD = """
from __future__ import annotations
import abc, collections, copy, dataclasses, enum, functools, inspect, json, pickle, typing, unittest
import helper
"""


@pytest.mark.parametrize(
    "body",
    [
        # dataclasses with string annotations: ClassVar, InitVar and KW_ONLY are distinguished from fields by their text
        """
@dataclasses.dataclass
class D(helper.Base):
    shared: typing.ClassVar[int] = 1
    start: dataclasses.InitVar[int] = 2
    _: dataclasses.KW_ONLY
    names: list[str] = dataclasses.field(default_factory=list)
    def __post_init__(self, start):
        self.number += start
d = D(4)
assert d == D(4) and repr(d) == "D(number=6, names=[])", d
assert [f.name for f in dataclasses.fields(D)] == ["number", "names"]
assert dataclasses.asdict(d) == {"number": 6, "names": []} and dataclasses.replace(d, start=0, number=1).number == 1
""",
        # typing.get_type_hints
        """
class T(typing.TypedDict):
    inner: Later
class N(typing.NamedTuple):
    inner: Later
class Later: pass
def function(a: Later) -> helper.Plain: ...
assert typing.get_type_hints(function) == {"a": Later, "return": helper.Plain}
assert typing.get_type_hints(helper.Plain) == {"text": helper.Text}
assert typing.get_type_hints(helper.Plain.method) == {"return": helper.Text}
assert typing.get_type_hints(T) == typing.get_type_hints(N) == {"inner": Later}
""",
        # pickle
        """
@dataclasses.dataclass
class P:
    x: int
    class Inner(enum.Enum):
        RED = 1
Pair = collections.namedtuple("Pair", "a b")
thing = {"p": P(2), "e": P.Inner.RED, "n": Pair(1, 2), "b": helper.Base(1), "f": collections.OrderedDict(a=1)}
for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
    back = pickle.loads(pickle.dumps(thing, protocol))
    assert back == thing and type(back["p"]) is P and type(back["b"]) is helper.Base
assert Pair.__module__ == P.__module__ == "__main__"
""",
        # inspect
        """
class S:
    '''A documented class.'''
    def run(self):
        return 1
assert inspect.getsource(S).startswith("class S:") and "return 1" in inspect.getsource(S.run)
assert inspect.getmodule(S).__name__ == "__main__" and inspect.getdoc(S) == "A documented class."
assert inspect.getsource(helper.Base).startswith("@dataclasses.dataclass")
assert inspect.getfile(S) == __file__ and inspect.getmodule(helper.Base) is helper
assert list(inspect.signature(S.run).parameters) == ["self"]
""",
        # copy, enum, json, abc, functools
        """
class Color(enum.Enum):
    RED = 1
class Level(enum.IntFlag):
    LOW = 1
    HIGH = 2
class Shape(abc.ABC):
    @abc.abstractmethod
    def area(self): ...
class Square(Shape):
    calls = 0
    def area(self): return 4
    @functools.cached_property
    def side(self):
        Square.calls += 1
        return 2
square = Square()
assert copy.deepcopy([Color.RED, helper.Base(1)]) == [Color.RED, helper.Base(1)] and Color["RED"] is Color(1)
assert (Level.LOW | Level.HIGH).value == 3 and json.loads(json.dumps({"level": Level.HIGH})) == {"level": 2}
assert square.side + square.side == 4 and Square.calls == 1
try:
    Shape()
except TypeError:
    pass
else:
    raise AssertionError
""",
        # unittest
        """
class Case(unittest.TestCase):
    def test_one(self):
        self.assertEqual(1, 1)
    def test_two(self):
        with self.assertRaises(ZeroDivisionError):
            1 / 0
program = unittest.main(argv=["node"], exit=False)
assert program.result.testsRun == 2 and program.result.wasSuccessful()
print("tested")
""",
    ],
    ids=["dataclasses", "typing", "pickle", "inspect", "classes", "unittest"],
)
def test_lookup(run, tmp_path, body):
    (tmp_path / "helper.py").write_text(HELPER, encoding="utf-8")
    program = run(HEAD + body)
    assert program.universe.exit_status == 0, program.text
    assert "Traceback" not in program.text


def test_main_module_of_a_node_differs_from_the_hosts(run):
    program = run("""
        import pickle, sys
        class OnlyHere: pass
        print(type(pickle.loads(pickle.dumps(OnlyHere()))) is OnlyHere, sys.modules["__main__"].OnlyHere is OnlyHere)
    """)
    assert program.lines == ["True True"]
