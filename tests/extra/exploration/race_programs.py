"""Small programs for the race detector: some race, each with its expected report; the others do not.

All of them reach the right result under the default schedule. `both` runs functions in separate threads.
"""

from __future__ import annotations

PRELUDE = """
import queue, threading, time
import rospy
from std_msgs.msg import Int32
from std_srvs.srv import Trigger, TriggerResponse
class Box:
    limit = 0
    def __init__(self):
        self.n, self.ready, self.d, self.l, self.s = 0, False, {"x": 0, "y": 0}, [0, 0], {0}
box = Box()
lock = threading.Lock()
def both(*functions):
    threads = [threading.Thread(target=each) for each in functions]
    for thread in threads: thread.start()
    for thread in threads: thread.join()
    return threads
def node():
    rospy.init_node("races")
"""

RACY: dict[str, tuple[str, str]] = {
    "update of an attribute": (
        "Box.n",
        """
def add(): box.n = box.n + 1
both(add, add)
""",
    ),
    "update in place": (
        "Box.n",
        """
def add(): box.n += 1
both(add, add)
""",
    ),
    "write and read": (
        "Box.n",
        """
def write(): box.n = 1
def read(): print(box.n)
both(write, read)
""",
    ),
    "flag by polling": (
        "Box.ready",
        """
def write(): time.sleep(0.01); box.ready = True
def read():
    while not box.ready: time.sleep(0.001)
both(write, read)
""",
    ),
    "order by sleep": (
        "Box.n",
        """
def first(): box.n = 1
def second(): time.sleep(0.1); print(box.n)
both(first, second)
""",
    ),
    "lock on one side": (
        "Box.n",
        """
def one():
    with lock: box.n += 1
def other(): box.n += 1
both(one, other)
""",
    ),
    "two locks": (
        "Box.n",
        """
another = threading.Lock()
def one():
    with lock: box.n += 1
def other():
    with another: box.n += 1
both(one, other)
""",
    ),
    "item of a dict": (
        "box.d['x']",
        """
def add(): box.d["x"] += 1
both(add, add)
""",
    ),
    "new keys while a dict is gone through": (
        "box.d",
        """
def write(): box.d["z"] = 1
def read(): print([each for each in box.d])
both(write, read)
""",
    ),
    "append and pop": (
        "box.l",
        """
def put(): box.l.append(1)
def take(): box.l.pop()
both(put, take)
""",
    ),
    "length of a list": (
        "box.l",
        """
def put(): box.l.append(1)
def look(): print(len(box.l))
both(put, look)
""",
    ),
    "item of a list": (
        "box.l[0]",
        """
def put(): box.l[0] = 3
def look(): print(box.l[0])
both(put, look)
""",
    ),
    "set": (
        "box.s",
        """
def put(): box.s.add(3)
def look(): print(3 in box.s)
both(put, look)
""",
    ),
    "alias of a container": (
        "mine or yours",
        """
def put(): mine = box.l; mine.append(1)
def look():
    yours = box.l
    for each in yours: print(each)
both(put, look)
""",
    ),
    "global variable": (
        "main.total",
        """
total = 0
def add():
    global total
    total += 1
both(add, add)
""",
    ),
    "global variable of the main program": (
        "main.stop",
        """
stop = False
def work():
    while not stop: time.sleep(0.001)
thread = threading.Thread(target=work)
thread.start()
time.sleep(0.01)
stop = True
thread.join()
""",
    ),
    "variable of a function": (
        "count.total",
        """
def count():
    total = 0
    def add():
        nonlocal total
        total += 1
    both(add, add)
    return total
count()
""",
    ),
    "attribute of a class": (
        "Box.limit",
        """
def add(): Box.limit += 1
both(add, add)
""",
    ),
    "slots": (
        "Slot.n",
        """
class Slot:
    __slots__ = ("n",)
slot = Slot()
slot.n = 0
def add(): slot.n += 1
both(add, add)
""",
    ),
    "property": (
        "Arm._n",
        """
class Arm:
    _n = 0
    @property
    def n(self): return self._n
    @n.setter
    def n(self, value): self._n = value
arm = Arm()
def add(): arm.n += 1
both(add, add)
""",
    ),
    "main program does not join": (
        "Box.n",
        """
def add(): time.sleep(0.01); box.n += 1
thread = threading.Thread(target=add)
thread.start()
time.sleep(0.1)
print(box.n)
thread.join()
""",
    ),
    "join with a timeout": (
        "Box.n",
        """
def add(): time.sleep(0.05); box.n += 1
thread = threading.Thread(target=add)
thread.start()
thread.join(0.01)
box.n += 1
thread.join()
""",
    ),
    "set before the write": (
        "Box.n",
        """
event = threading.Event()
def write(): event.set(); box.n = 1
def read(): event.wait(); time.sleep(0.01); print(box.n)
both(write, read)
""",
    ),
    "put before the write": (
        "Box.n",
        """
q = queue.Queue()
def write(): q.put(box); box.n = 1
def read(): mine = q.get(); time.sleep(0.01); print(mine.n)
both(write, read)
""",
    ),
    "check outside of the lock": (
        "Box.n",
        """
def add():
    if box.n < 2:
        with lock: box.n += 1
both(add, add)
""",
    ),
    "double-checked start": (
        "Box.ready",
        """
def start():
    if not box.ready:
        with lock:
            if not box.ready: box.ready = True
both(start, start)
""",
    ),
    "two topics": (
        "Box.n",
        """
node()
def add(message): box.n += message.data
subs = [rospy.Subscriber(each, Int32, add) for each in ("a", "b")]
pubs = [rospy.Publisher(each, Int32, queue_size=3) for each in ("a", "b")]
rospy.sleep(0.2)
for pub in pubs: pub.publish(1)
rospy.sleep(0.1)
""",
    ),
    "callback and main loop": (
        "Box.n",
        """
node()
def take(message): box.n = message.data
sub = rospy.Subscriber("a", Int32, take)
pub = rospy.Publisher("a", Int32, queue_size=3)
rospy.sleep(0.2)
pub.publish(1)
rospy.sleep(0.1)
print(box.n)
""",
    ),
    "timer and callback": (
        "Box.n",
        """
node()
def take(message): box.n = message.data
def tick(event): box.n += 1
sub = rospy.Subscriber("a", Int32, take)
pub = rospy.Publisher("a", Int32, queue_size=3)
timer = rospy.Timer(rospy.Duration(0.05), tick)
rospy.sleep(0.2)
pub.publish(1)
rospy.sleep(0.1)
timer.shutdown()
""",
    ),
    "attribute set behind the subscriber": (
        "Arm.goal",
        """
node()
def send():
    pub = rospy.Publisher("a", Int32, queue_size=3)
    rospy.sleep(0.3)
    pub.publish(1)
class Arm:
    def __init__(self):
        self.sub = rospy.Subscriber("a", Int32, self.take)
        self.goal = 0
    def take(self, message): self.goal = message.data
thread = threading.Thread(target=send)
thread.start()
arm = Arm()
rospy.sleep(0.5)
thread.join()
""",
    ),
}
"""Name of the program: what is raced for, and the program behind the prelude."""

CLEAN: dict[str, str] = {
    "lock": """
def add():
    with lock: box.n += 1
both(add, add)
""",
    "reentrant lock": """
lock = threading.RLock()
def add():
    with lock:
        with lock: box.n += 1
both(add, add)
""",
    "join": """
def add(): box.n += 1
both(add)
print(box.n)
""",
    "start": """
box.n = 5
def look(): print(box.n)
both(look, look)
""",
    "is_alive": """
def add(): box.n += 1
thread = threading.Thread(target=add)
thread.start()
while thread.is_alive(): time.sleep(0.001)
print(box.n)
""",
    "event": """
event = threading.Event()
def write(): box.n = 1; event.set()
def read(): event.wait(); print(box.n)
both(write, read)
""",
    "event, asked": """
event = threading.Event()
def write(): time.sleep(0.01); box.n = 1; event.set()
def read():
    while not event.is_set(): time.sleep(0.001)
    print(box.n)
both(write, read)
""",
    "condition": """
cond = threading.Condition()
def write():
    with cond: box.ready = True; cond.notify()
def read():
    with cond:
        cond.wait_for(lambda: box.ready)
        box.n += 1
both(read, write)
""",
    "condition with a time": """
cond = threading.Condition(threading.Lock())
def write():
    time.sleep(0.05)
    with cond: box.ready = True; cond.notify_all()
def read():
    with cond:
        while not box.ready: cond.wait(0.01)
both(read, write)
""",
    "semaphore": """
free = threading.Semaphore(1)
def add():
    with free: box.n += 1
both(add, add)
""",
    "semaphore as a signal": """
done = threading.Semaphore(0)
def write(): box.n = 1; done.release()
def read(): done.acquire(); print(box.n)
both(write, read)
""",
    "barrier": """
barrier = threading.Barrier(2)
def one(): box.n = 1; barrier.wait(); print(box.d["x"])
def other(): box.d["x"] = 2; barrier.wait(); print(box.n)
both(one, other)
""",
    "queue": """
q = queue.Queue()
def write(): box.n = 1; q.put(box)
def read(): print(q.get().n)
both(write, read)
""",
    "bounded queue": """
q = queue.Queue(1)
def write():
    for n in range(3):
        item = Box()
        item.n = n
        q.put(item)
def read():
    for _ in range(3): print(q.get().n)
both(write, read)
""",
    "simple queue": """
q = queue.SimpleQueue()
def write(): box.n = 1; q.put(box)
def read(): print(q.get().n)
both(write, read)
""",
    "queue with join": """
q = queue.Queue()
def work():
    item = q.get()
    item.n += 1
    q.task_done()
thread = threading.Thread(target=work, daemon=True)
thread.start()
q.put(box)
q.join()
print(box.n)
""",
    "executor": """
from concurrent.futures import ThreadPoolExecutor
def add(each): each.n += 1; return each
with ThreadPoolExecutor(2) as pool:
    made = list(pool.map(add, [Box(), Box()]))
print(made[0].n + made[1].n)
""",
    "future": """
from concurrent.futures import ThreadPoolExecutor
def work(): box.n = 3; return 1
pool = ThreadPoolExecutor(1)
print(pool.submit(work).result() + box.n)
pool.shutdown()
""",
    "threading.Timer": """
box.n = 2
def tick(): box.n += 1
timer = threading.Timer(0.01, tick)
timer.start()
timer.join()
print(box.n)
""",
    "things of one's own": """
def work():
    mine = Box()
    mine.n += 1
    mine.d["x"] += 1
    mine.l.append(2)
both(work, work)
""",
    "other attributes, other items": """
def one(): box.n += 1; box.d["x"] += 1; box.l[0] = 1
def other(): box.ready = True; box.d["y"] += 1; box.l[-1] = 2
both(one, other)
""",
    "only read": """
def look(): print(box.n, box.d["x"], len(box.l), [each for each in box.s])
both(look, look)
""",
    "thread local": """
local = threading.local()
def work(): local.n = 0; local.n += 1
both(work, work)
""",
    "one topic": """
node()
def add(message): box.n += message.data
sub = rospy.Subscriber("a", Int32, add)
pub = rospy.Publisher("a", Int32, queue_size=3)
rospy.sleep(0.2)
for n in range(3): pub.publish(n)
rospy.sleep(0.1)
""",
    "message there and back": """
node()
answered = threading.Event()
def take(message): box.n += 1; back.publish(box.n)
def hear(message): box.n += 1; answered.set()
back = rospy.Publisher("b", Int32, queue_size=3)
subs = [rospy.Subscriber("a", Int32, take), rospy.Subscriber("b", Int32, hear)]
pub = rospy.Publisher("a", Int32, queue_size=3)
rospy.sleep(0.2)
box.n = 5
pub.publish(1)
answered.wait()
print(box.n)
""",
    "set before the subscriber": """
node()
class Arm:
    def __init__(self):
        self.goal = 0
        self.sub = rospy.Subscriber("a", Int32, self.take)
    def take(self, message): self.goal = message.data
arm = Arm()
pub = rospy.Publisher("a", Int32, queue_size=3)
rospy.sleep(0.2)
pub.publish(1)
rospy.sleep(0.1)
""",
    "second subscriber of a topic": """
node()
subs = [rospy.Subscriber("a", Int32, lambda message: None)]
pub = rospy.Publisher("a", Int32, queue_size=3)
rospy.sleep(0.2)
box.n = 3
subs.append(rospy.Subscriber("a", Int32, lambda message: print(box.n)))
pub.publish(1)
rospy.sleep(0.1)
""",
    "service": """
node()
def serve(request): box.n += 1; return TriggerResponse(True, str(box.n))
service = rospy.Service("go", Trigger, serve)
call = rospy.ServiceProxy("go", Trigger)
box.n = 2
print(call().message)
box.n += 1
print(call().message)
""",
    "parameter": """
node()
def work():
    while not rospy.get_param("/go", False): time.sleep(0.01)
    print(box.n)
thread = threading.Thread(target=work)
thread.start()
box.n = 3
rospy.set_param("/go", True)
thread.join()
""",
    "rospy.Timer, once": """
node()
box.n = 4
done = threading.Event()
def tick(event): box.n += 1; done.set()
timer = rospy.Timer(rospy.Duration(0.05), tick, oneshot=True)
done.wait()
print(box.n)
""",
}
"""Name of the program, and the program behind the prelude."""

APP_PRELUDE = """
from cfepy.msg import header
MID = 0x0A01
class Box:
    def __init__(self): self.n = 0
box = Box()
def main(cfe):
    body(cfe)
    while cfe.es.run_loop(): cfe.os.task_delay(100)
def child(cfe, function):
    cfe.es.create_child_task("CHILD", lambda: function(cfe), 8192, 100)
def add(cfe): box.n += 1
def wait(cfe): cfe.os.task_delay(200)
"""
APPS_RACY = {
    "child": """
def body(cfe): child(cfe, add); wait(cfe); add(cfe)
""",
    "mutex on one side": """
def body(cfe):
    mutex = cfe.os.mut_sem_create("M")
    def guarded(cfe): cfe.os.mut_sem_take(mutex); add(cfe); cfe.os.mut_sem_give(mutex)
    child(cfe, guarded); wait(cfe); add(cfe)
""",
    "semaphore that was not given": """
def body(cfe):
    sem = cfe.os.bin_sem_create("S", 0)
    child(cfe, add)
    cfe.os.bin_sem_timed_wait(sem, 200)
    add(cfe)
""",
    "sent before the write": """
def body(cfe):
    pipe = cfe.sb.create_pipe(4, "P")
    cfe.sb.subscribe(MID, pipe)
    def send(cfe): cfe.sb.transmit_msg(header.init(MID, 16)); add(cfe)
    child(cfe, send)
    cfe.sb.receive_buffer(pipe)
    wait(cfe)
    add(cfe)
""",
    "timer": """
def body(cfe):
    timer = cfe.os.timer_create("T", lambda timer_id: add(cfe))
    cfe.os.timer_set(timer, 100_000, 0)
    wait(cfe)
    add(cfe)
""",
}
"""Applications whose tasks race for `Box.n`, behind their prelude."""
APPS_CLEAN = {
    "ended": """
def body(cfe):
    def work(cfe):
        add(cfe)
        while True: cfe.os.task_delay(10)
    task = cfe.es.create_child_task("CHILD", lambda: work(cfe), 8192, 100)
    wait(cfe)
    cfe.es.delete_child_task(task)
    add(cfe)
""",
    "started": """
def body(cfe): add(cfe); child(cfe, add)
""",
    "mutex": """
def body(cfe):
    mutex = cfe.os.mut_sem_create("M")
    def guarded(cfe): cfe.os.mut_sem_take(mutex); add(cfe); cfe.os.mut_sem_give(mutex)
    child(cfe, guarded); wait(cfe); guarded(cfe)
""",
    "counting semaphore": """
def body(cfe):
    sem = cfe.os.count_sem_create("S", 0)
    def work(cfe): add(cfe); cfe.os.count_sem_give(sem)
    child(cfe, work)
    cfe.os.count_sem_take(sem)
    add(cfe)
""",
    "queue": """
def body(cfe):
    queue = cfe.os.queue_create("Q", 4, 8)
    def work(cfe): add(cfe); cfe.os.queue_put(queue, b"12345678")
    child(cfe, work)
    wait(cfe)
    cfe.os.queue_get(queue)
    add(cfe)
""",
    "message": """
def body(cfe):
    pipe = cfe.sb.create_pipe(4, "P")
    cfe.sb.subscribe(MID, pipe)
    def send(cfe): add(cfe); cfe.sb.transmit_msg(header.init(MID, 16))
    child(cfe, send)
    wait(cfe)
    cfe.sb.receive_buffer(pipe)
    add(cfe)
""",
    "readers and writers": """
def body(cfe):
    lock = cfe.os.rw_lock_create("L")
    def work(cfe): cfe.os.rw_lock_write_take(lock); add(cfe); cfe.os.rw_lock_write_give(lock)
    child(cfe, work); wait(cfe)
    cfe.os.rw_lock_read_take(lock); print(box.n); cfe.os.rw_lock_read_give(lock)
""",
    "condition": """
def body(cfe):
    var = cfe.os.cond_var_create("C")
    def work(cfe): cfe.os.cond_var_lock(var); add(cfe); cfe.os.cond_var_signal(var); cfe.os.cond_var_unlock(var)
    child(cfe, work)
    cfe.os.cond_var_lock(var)
    while not box.n: cfe.os.cond_var_wait(var)
    cfe.os.cond_var_unlock(var)
""",
    "timer": """
def body(cfe):
    sem = cfe.os.bin_sem_create("S", 0)
    def tick(timer_id): add(cfe); cfe.os.bin_sem_give(sem)
    timer = cfe.os.timer_create("T", tick)
    add(cfe)
    cfe.os.timer_set(timer, 100_000, 0)
    cfe.os.bin_sem_take(sem)
    add(cfe)
""",
}
"""Applications without a race."""
