"""Small programs that leave their results in `out`, for tests of the transformation of node code."""

from __future__ import annotations

PROGRAMS = {
    "attributes": """
class Arm:
    limit = 3
    count = 0
    __private = 1
    def __init__(self):
        self.position = 0.0
        self.goal, self.other = 1, [2]
        self.__secret = 5
    def move(self):
        self.position += self.goal * 0.5
        self.position = self.position + self.__secret + self.__private
        Arm.count += 1
        self.count -= 1
        del self.goal
        return self.position, self.limit
arm = Arm()
out.append(arm.move())
out.append((Arm.count, arm.count, hasattr(arm, "goal"), sorted(vars(arm))))
""",
    "order of evaluation": """
def say(text, value=None):
    out.append(text)
    return value
class Thing:
    pass
def run():
    thing = Thing()
    say("a", thing).x = say("b", 1)
    say("c", thing).x += say("d", 2)
    items = {}
    say("e", items)[say("f", "k")] = say("g", 3)
    say("h", items)[say("i", "k")] += say("j", 4)
    say("k", []).append(say("l", say("m")))
    say("n", items).get(say("o", "k"), say("p"))
    out.append((thing.x, items))
    x, thing.y, items[say("q", 0)] = say("r", (1, 2, 3))
    first = second = thing.z = items[say("s", "z")] = say("t", 9)
    out.append((x, thing.y, items, first, second))
run()
""",
    "short circuit": """
class Box:
    def __init__(self): self.full = []
    def get(self, what): out.append(what); return self.full
box = Box()
def run():
    if box.full and box.get(1)[0]: out.append("never")
    if not box.full or box.get(2): out.append("yes")
    out.append(1 if box.full else 2)
    while not box.full: box.full.append(3)
    out.append(0 in box.full or 3 in box.full)
    out.append(1 < len(box.full) < box.get(4)[0])
run()
""",
    "closures": """
def counter():
    count = 0
    names = []
    def add(by=1):
        nonlocal count
        count += by
        names.append(count)
        return count
    def peek():
        return count, [count for _ in range(2)], (lambda: count + 1)()
    return add, peek, names
add, peek, names = counter()
add(); add(3)
out.append((peek(), names))
def loop():
    made = []
    for n in range(3):
        made.append(lambda: n)
    return [each() for each in made]
out.append(loop())
def late():
    def use(): return later
    try: use()
    except NameError as error: out.append(str(error))
    later = 1
    later = 2
    return use()
out.append(late())
""",
    "globals": """
total = 0
total = total + 1
flag = True
flag = not flag
def add(n):
    global total, made
    total += n
    made = total
    return total
def both():
    global a, b
    a, *b = 1, 2, 3
    for made_here in b: pass
    return a, b
add(2); add(3)
out.append((total, made, flag, both()))
def walrus():
    global seen
    if (seen := len(out)) > 0: return seen, [seen := n for n in range(3)], seen
out.append(walrus())
def gone():
    global seen
    del seen
gone()
try: seen
except NameError as error: out.append(str(error))
""",
    "unbound": """
def f():
    if False: x = 1
    g = lambda: x
    x += 1
f()
""",
    "no attribute": """
class A: pass
def f(a):
    return (a
        .missing)
f(A())
""",
    "no key": """
class A:
    def __init__(self): self.d = {}
    def go(self):
        out.append(1)
        return self.d[
            "x"]
A().go()
""",
    "unhashable": """
def f(d, k):
    d[k] = 1
f({}, [])
""",
    "no index": """
def f(d):
    return d[-3] if d[-1] else None
out.append(f([1, 2, 0]))
f([1])
""",
    "containers": """
import collections
class Box:
    def __init__(self):
        self.d = collections.defaultdict(list)
        self.q = collections.deque([1, 2, 3], maxlen=3)
        self.s = {1, 2}
        self.l = [3, 1, 2]
    def go(self):
        self.d["a"].append(1)
        self.d["b"] += [2]
        self.q.append(4); self.q.rotate(1); self.q.popleft()
        self.s.add(3); self.s.discard(1); self.s |= {9}
        self.l.sort(key=lambda n: -n); self.l.insert(0, 7); self.l[1:3] = [0]; self.l[-1] += 1
        self.l.extend([n for n in self.l if n in self.s])
        del self.l[0], self.d["b"]
        a, *b = self.l
        return dict(self.d), list(self.q), sorted(self.s), self.l, max(*self.l), a, b
out.append(Box().go())
""",
    "iteration": """
class Box:
    def __init__(self): self.d = {"a": 1, "b": 2}
    def go(self):
        for key, value in self.d.items():
            out.append((key, value))
        else:
            out.append("else")
        for key in self.d:
            if key == "a": continue
            break
        else:
            out.append("never")
        out.append([k + str(v) for k in self.d for v in self.d.values() if v > 1])
        out.append({v: k for k, v in self.d.items()})
        for key in self.d:
            self.d[key + "x"] = 0
Box().go()
""",
    "slots and properties": """
class Point:
    __slots__ = ("x", "_y")
    def __init__(self): self.x, self._y = 1, 2
    @property
    def y(self):
        out.append("get")
        return self._y
    @y.setter
    def y(self, value):
        out.append("set")
        self._y = value
    @staticmethod
    def make(): return Point()
    @classmethod
    def also(cls): return cls()
p = Point.make()
def go():
    p.y += 3
    p.x, p.y = p.y, p.x
    return p.x, p.y, Point.also().x
out.append(go())
try: p.z = 1
except AttributeError as error: out.append(str(error))
""",
    "dynamic attributes": """
class Odd:
    def __getattr__(self, name):
        out.append("get " + name)
        if name == "none": raise AttributeError(name)
        return 1
    def __setattr__(self, name, value):
        out.append("set " + name)
        object.__setattr__(self, name, value)
    def __delattr__(self, name):
        out.append("del " + name)
def go(odd):
    odd.a += odd.b
    del odd.a
    out.append(getattr(odd, "none", 5))
    setattr(odd, "c", 3)
    return odd.a, odd.none
go(Odd())
""",
    "inheritance": """
class A:
    def __init__(self, n): self.n = n
    def f(self): return self.n
class B(A):
    def __init__(self):
        super().__init__(1)
        self.m = 2
    def f(self):
        return super().f() + self.m, super(B, self).n if hasattr(super(), "n") else None, __class__.__name__
out.append(B().f())
""",
    "generators": """
class G:
    def __init__(self): self.n = 0
    def items(self):
        while self.n < 3:
            self.n += yield self.n
    def whole(self):
        yield from self.items()
g = G()
made = g.whole()
out.append(next(made))
for n in (1, 1): out.append(made.send(n))
try: made.send(1)
except StopIteration: out.append("end")
""",
    "with and try": """
class Lock:
    def __init__(self): self.held = 0
    def __enter__(self): self.held += 1; return self
    def __exit__(self, *what): self.held -= 1; out.append(what[0]); return True
class User:
    def __init__(self): self.lock, self.at = Lock(), None
    def go(self):
        with self.lock as self.at, Lock() as other:
            out.append((self.at.held, other.held))
            raise ValueError(self.at.held)
        try:
            self.nothing
        except AttributeError as error:
            self.at = str(error)
        finally:
            out.append(self.at)
User().go()
""",
    "match": """
class Kind:
    RED = 1
    def __init__(self, x): self.x = x
def what(value):
    match value:
        case Kind.RED: return "red"
        case Kind(x=1 | 2) as found if found.x > 1: return "two", found.x
        case [first, *rest]: return first, rest
        case {"a": a, **others}: return a, others
        case _: return None
out.append([what(each) for each in (1, Kind(1), Kind(2), [1, 2, 3], {"a": 1, "b": 2}, "x")])
""",
    "docstrings": '''
"""of the module"""
class A:
    """of a class"""
    x: int = 3
    y: "list[int]"
    def f(self, n: int = 1) -> str:
        """of a function"""
        value: int = n
        self.z: int = value
        self.w: int
        return f"{self.z=} {self.x!r:>3}"
out.append((__doc__, A.__doc__, A.f.__doc__, A().f(), A.f.__annotations__, A.__annotations__))
''',
    "decorators": """
def twice(function):
    calls = 0
    def call(*args, **options):
        nonlocal calls
        calls += 1
        return function(*args, **options), calls
    return call
class A:
    n = 2
    @twice
    def f(self, *, k=n): return self.n * k
out.append((A().f(k=3), A().f()))
""",
    "numbers and slices": """
class M:
    def __getitem__(self, key): return key
    def __setitem__(self, key, value): out.append((key, value))
def go(m, l):
    m[1:2, 0] = m[..., ::2]
    l[0], l[-1] = l[-1], l[0]
    l[1:] += [8]
    return m[1, "a"], m[-1], l, [*l[:2]], {**{"a": l}}
out.append(go(M(), [1, 2, 3]))
""",
    "recursion": """
class Tree:
    def __init__(self, depth):
        self.below = {}
        self.count = 1
        for n in range(2 if depth else 0):
            self.below[n] = Tree(depth - 1)
            self.count += self.below[n].add()
    def add(self):
        self.count += 0
        return self.count
out.append(Tree(4).count)
""",
    "locals": """
def f(a, b=2):
    c = a
    return sorted(locals()), sorted(globals().keys() & {"f", "out"})
out.append(f(1))
class A:
    def __del__(self): out.append("gone")
def g():
    a = A()
    a.x = [a.__class__]
    a.x.append(1)
g()
out.append("after")
""",
    "coroutines": """
import asyncio
class Box:
    def __init__(self): self.n, self.l = 0, [1, 2]
    async def each(self):
        for n in self.l:
            await asyncio.sleep(0)
            yield n
    async def __aenter__(self): self.n += 1; return self
    async def __aexit__(self, *what): self.n += 10
    async def add(self, by=1):
        self.n += await self.later(by)
        async for n in self.each(): self.l[0] += n
        async with self as same: out.append(same.n)
        return self.n, [n async for n in self.each()], self.l
    async def later(self, value): return value
box = Box()
async def main(): out.append(await asyncio.gather(box.add(2), box.later(3)))
asyncio.run(main())
out.append((box.n, box.l))
""",
    "imports": """
from __future__ import annotations
import math, os.path as path
from collections import OrderedDict as Order
def f(x: Nothing) -> AlsoNothing:
    import heapq
    heap = [3, 1]
    heapq.heapify(heap)
    heapq.heappush(heap, 0)
    order = Order(a=1)
    order.move_to_end("a")
    return math.floor(2.5), path.basename("/a/b"), heap, list(order), f.__annotations__
out.append(f(1))
""",
}
