"""What rospy does at each stage of a node's life, one line for each question; the same program runs on ROS.

Record again with a fresh master: python3 rospy_stages.py _own:=7 old:=new > rospy_stages.txt
"""

import io
import re
import sys
import threading
import time
import warnings

import rospy
from geometry_msgs.msg import Point, PointStamped
from rospy_tutorials.srv import AddTwoInts, AddTwoIntsRequest, AddTwoIntsResponse
from std_msgs.msg import ColorRGBA, Empty, Float64, Header, Int32, String, UInt32
from std_srvs.srv import Empty as EmptyService
from std_srvs.srv import SetBool, SetBoolResponse, Trigger, TriggerResponse

warnings.simplefilter("always")


def ask(label, question):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            answer = question()
            text = answer if isinstance(answer, str) else repr(answer)
        except BaseException as error:
            family = "<".join(each.__name__ for each in type(error).__mro__[:-2])
            text = f"{family}: {error}"
    said = [each.category.__name__ for each in caught if issubclass(each.category, (SyntaxWarning, UserWarning))]
    text = re.sub("0x[0-9a-f]+", "0x..", text.replace("\n", "|"))
    print(f"{label} = {text[:240]}{' ' + said[0] if said else ''}", flush=True)


def connected(publisher):
    for _ in range(500):
        if publisher.get_num_connections():
            return publisher
        time.sleep(0.01)
    return publisher


# -- before init_node ---------------------------------------------------------------------------------------------

ask("before: name", rospy.get_name)
ask("before: caller", rospy.get_caller_id)
ask("before: namespace", rospy.get_namespace)
ask("before: time", rospy.get_rostime)
ask("before: seconds", rospy.get_time)
ask("before: now", rospy.Time.now)
ask("before: spin", rospy.spin)
ask("before: shut down", rospy.is_shutdown)
ask("before: initialized", rospy.core.is_initialized)
ask("before: publish", lambda: rospy.Publisher("early", String, queue_size=1).publish("x"))
ask("before: private publisher", lambda: rospy.Publisher("~mine", String, queue_size=1).name)
ask("before: subscriber", lambda: rospy.Subscriber("early", String).resolved_name)
ask("before: parameter", lambda: rospy.get_param("/nothing", "else"))
ask("before: rate", lambda: rospy.Rate(5))
ask("before: throttled log", lambda: rospy.loginfo_throttle(1, "x"))
ask("before: service", lambda: rospy.Service("early_service", Trigger, lambda request: None))
ask("before: sleep", lambda: rospy.sleep(0.01))
ask("before: message", lambda: rospy.wait_for_message("/nothing", String, timeout=0.2))
ask("before: no name", lambda: rospy.init_node(""))
ask("before: None", lambda: rospy.init_node(None))
ask("before: name with namespace", lambda: rospy.init_node("a/b"))

rospy.init_node("stages", log_level=rospy.FATAL)

# -- names --------------------------------------------------------------------------------------------------------

ask("again: the same", lambda: rospy.init_node("stages", log_level=rospy.FATAL))
ask("names", lambda: (rospy.get_name(), rospy.get_caller_id(), rospy.get_namespace()))
ask("names: own parameter", lambda: rospy.get_param("~own"))
ask("names: arguments", lambda: rospy.myargv(["me", "a:=b", "c", "__x:=1", "-d:=e"]))
for name in ("old", "/old", "~old", "old/x", "a//b/", "/", "~"):
    ask(f"names: resolve {name}", lambda name=name: rospy.resolve_name(name))
ask("names: of another", lambda: [rospy.resolve_name(name, "/up/other") for name in ("q", "~q", "/q")])
ask("names: remapped", lambda: (rospy.remap_name("old"), rospy.names.get_mappings()))
ask("names: joined", lambda: (rospy.names.ns_join("a", "b"), rospy.core.namespace("/a/b")))
ask("names: tools", lambda: (rospy.names.scoped_name("/a/b", "/a/c/d"), rospy.names.canonicalize_name("/a//b/")))

# -- messages -----------------------------------------------------------------------------------------------------


def bytes_of(message):
    out = io.BytesIO()
    message.serialize(out)
    return out.getvalue().hex()


ask("message: no header", lambda: bytes_of(PointStamped(None, Point())) == "00" * 40)
for label, message in (
    ("text in a number", UInt32("x")),
    ("too small", UInt32(-1)),
    ("fraction", Int32(1.5)),
    ("number in a text", String(5)),
    ("integer in a float", Float64(2)),
):
    ask(f"message: {label}", lambda message=message: bytes_of(message))
ask("message: cut off", lambda: UInt32().deserialize(b"\x01"))
ask("message: no UTF-8", lambda: ascii(String().deserialize(b"\x01\0\0\0\xff").data))

# -- topics -------------------------------------------------------------------------------------------------------


def exchange(topic, kind, messages, **options):
    """What a callback gets: message, further arguments, name of the thread."""
    got, enough = [], threading.Event()

    def take(message, *further):
        got.append((message, further, threading.current_thread().name))
        if len(got) == len(messages):
            enough.set()

    publisher, subscriber = rospy.Publisher(topic, kind, queue_size=9), rospy.Subscriber(topic, kind, take, **options)
    connected(publisher)
    for message in messages:
        publisher.publish(message)
    enough.wait(3)
    subscriber.unregister()
    publisher.unregister()
    return got


def latched():
    publisher = rospy.Publisher("latched", String, queue_size=1, latch=True)
    publisher.publish("one")
    publisher.publish("two")
    time.sleep(0.1)
    message = rospy.wait_for_message("latched", String, timeout=3)
    return message.data, message._connection_header["latching"]


def any_message():
    publisher = rospy.Publisher("any", String, queue_size=1, latch=True)
    publisher.publish("any")
    message = rospy.wait_for_message("any", rospy.AnyMsg, timeout=3)
    return type(message).__name__, message._buff.hex(), message._connection_header["type"]


def failing():
    seen = []
    publisher = rospy.Publisher("failing", String, queue_size=5)
    rospy.Subscriber("failing", String, lambda message: seen.append(message.data) or 1 / 0)
    connected(publisher).publish("1")
    publisher.publish("2")
    time.sleep(0.3)
    return seen


def together():
    seen = []
    publisher = rospy.Publisher("together", String, queue_size=5)
    for number in range(3):
        rospy.Subscriber("together", String, lambda m, n=number: seen.append((n, id(m), threading.get_ident())))
    connected(publisher).publish("x")
    time.sleep(0.3)
    order, messages, threads = zip(*seen, strict=True)
    return order, len(set(messages)), len(set(threads)), publisher.get_num_connections()


def listened():
    class Listener(rospy.SubscribeListener):
        def peer_subscribe(self, topic_name, topic_publish, peer_publish):
            seen.append(("came", topic_name))
            peer_publish(String("welcome"))

        def peer_unsubscribe(self, topic_name, num_peers):
            seen.append(("left", topic_name, num_peers))

    seen, heard = [], []
    publisher = rospy.Publisher("listened", String, subscriber_listener=Listener(), queue_size=5)
    subscriber = rospy.Subscriber("listened", String, lambda message: heard.append(message.data))
    time.sleep(0.4)
    subscriber.unregister()
    time.sleep(0.4)
    publisher.unregister()
    return seen, heard


def publisher(topic, kind=String, **options):
    return rospy.Publisher(topic, kind, **{"queue_size": 1, **options})


texts = [String("a"), String("b")]
stamped = [PointStamped(), PointStamped(Header(9, rospy.Time(5), "f"), Point())]
ask("topic: data", lambda: [message.data for message, _, _ in exchange("t1", String, texts)])
ask("topic: argument", lambda: exchange("t2", String, texts, callback_args={"k": 1})[0][1])
ask("topic: argument None", lambda: exchange("t3", String, texts, callback_args=None)[0][1])
ask("topic: another object", lambda: exchange("t4", String, texts)[0][0] is texts[0])
ask("topic: another thread", lambda: exchange("t5", String, texts)[0][2] != "MainThread")
ask("topic: header", lambda: sorted(exchange("t6", String, texts)[0][0]._connection_header))
ask(
    "topic: seq",
    lambda: [(m.header.seq, m.header.stamp.to_nsec()) for m, _, _ in exchange("t7", PointStamped, stamped)],
)
ask("topic: any", any_message)
ask("topic: latched", latched)
ask("topic: failing callback", failing)
ask("topic: three callbacks", together)
ask("topic: listener", listened)
ask("topic: no queue_size", lambda: rospy.Publisher("p1", String).resolved_name)
ask("topic: values", lambda: publisher("p2", ColorRGBA).publish(1, 2, 3, 4))
ask("topic: too few values", lambda: publisher("p3", ColorRGBA).publish(1, 2))
ask("topic: values and names", lambda: publisher("p4", ColorRGBA).publish(1, a=2))
ask("topic: unknown name", lambda: publisher("p5").publish(text="x"))
ask("topic: another type", lambda: publisher("p6").publish(UInt32(1)))
ask("topic: bad value nobody gets", lambda: publisher("p7", UInt32).publish(-1))
ask("topic: nothing", lambda: publisher("p8", Empty).publish())
ask("topic: unregistered", lambda: [each for each in [publisher("p9")] if each.unregister() or each.publish("x")])
ask("topic: unregistered twice", lambda: [each.unregister() or each.unregister() for each in [publisher("p10")]])
ask("topic: no message class", lambda: publisher("p11", int))
ask("topic: no class", lambda: publisher("p12", None))
ask("topic: no name", lambda: publisher(""))
ask("topic: odd name", lambda: publisher("odd name").name)
ask("topic: two types", lambda: (publisher("p13"), publisher("p13", UInt32))[1].type)
ask("topic: class as text", lambda: rospy.Subscriber("s1", "String"))
ask("topic: queue of 0", lambda: rospy.Subscriber("s2", String, print, queue_size=0))
ask("topic: queue of text", lambda: rospy.Subscriber("s3", String, print, queue_size="a"))
ask("topic: buffer of 0", lambda: rospy.Subscriber("s4", String, print, buff_size=0))
ask(
    "topic: attributes",
    lambda: [(p.name, p.type, p.md5sum, p.reg_type) for p in [publisher("~p")]],
)
ask("topic: no message", lambda: rospy.wait_for_message("never", String, timeout=0.2))
ask("topic: no message in a Duration", lambda: rospy.wait_for_message("never", String, timeout=rospy.Duration(0.2)))
ask("topic: published", lambda: rospy.get_published_topics("/nowhere"))

# -- parameters ---------------------------------------------------------------------------------------------------

rospy.set_param("/t", {"a": 1, "b": {"c": 2.5, "d": [1, "x", True]}})
ask("parameter: tree", lambda: (rospy.get_param("/t"), rospy.get_param("/t/b/d"), rospy.has_param("/t/b")))
ask("parameter: missing", lambda: rospy.get_param("/t/zz"))
ask("parameter: defaults", lambda: (rospy.get_param("/t/zz", None), rospy.get_param("/t/zz", 0)))
ask("parameter: search", lambda: (rospy.search_param("t"), rospy.search_param("zz"), rospy.search_param("own")))
ask("parameter: private search", lambda: rospy.search_param("~own"))
ask("parameter: delete", lambda: (rospy.delete_param("/t/a"), rospy.get_param("/t")))
ask("parameter: delete again", lambda: rospy.delete_param("/t/a"))
ask("parameter: replaced", lambda: (rospy.set_param("/t", {"n": 1}), rospy.get_param("/t")))
ask("parameter: empty", lambda: (rospy.set_param("/e", {}), rospy.get_param("/e"), rospy.has_param("/e")))
ask("parameter: tuple", lambda: (rospy.set_param("/tu", (1, 2)), rospy.get_param("/tu")))
for raw in (b"ab", bytearray(b"cd")):
    ask("parameter: bytes", lambda raw=raw: (rospy.set_param("/by", raw), rospy.get_param("/by").data))
ask("parameter: letters", lambda: (rospy.set_param("/u", "\xe9"), ascii(rospy.get_param("/u"))))
ask("parameter: below a value", lambda: (rospy.set_param("/t/n/m", 2), rospy.get_param("/t")))
for label, value in (
    ("None", None),
    ("2**31", 2**31),
    ("too low", -(2**31) - 1),
    ("key", {1: 2}),
    ("object", object()),
    ("set", {1}),
):
    ask(f"parameter: {label}", lambda value=value: rospy.set_param("/bad", value))
ask(
    "parameter: limits",
    lambda: [rospy.set_param("/limit", n) or rospy.get_param("/limit") for n in (2**31 - 1, -(2**31))],
)
ask("parameter: odd name", lambda: rospy.set_param("odd name", 1))
ask("parameter: names", lambda: [name for name in rospy.get_param_names() if name in ("/t/n/m", "/e", "/tu", "/t")])

# -- services -----------------------------------------------------------------------------------------------------

rospy.Service("sum", AddTwoInts, lambda request: AddTwoIntsResponse(request.a + request.b))
add = rospy.ServiceProxy("sum", AddTwoInts)


def answer_of(name, kind, handler, *args):
    rospy.Service(name, kind, handler)
    return str(rospy.ServiceProxy(name, kind)(*args))


def wrong():
    raise rospy.ServiceException("why")


def handled_error():
    seen = []
    rospy.Service("r14", Trigger, lambda request: 1 / 0, error_handler=lambda e, *rest: seen.append(type(e).__name__))
    try:
        rospy.ServiceProxy("r14", Trigger)()
    except rospy.ServiceException:
        seen.append("and at the caller")
    return seen


def ended():
    service = rospy.Service("r15", Trigger, lambda request: TriggerResponse())
    proxy = rospy.ServiceProxy("r15", Trigger)
    proxy()
    service.shutdown()
    time.sleep(0.2)
    return proxy()


def headers():
    seen = []
    rospy.Service("r16", Trigger, lambda request: seen.append(request._connection_header) or TriggerResponse())
    answer = rospy.ServiceProxy("r16", Trigger, headers={"token": "7"})()
    return seen[0]["token"], seen[0]["callerid"], sorted(answer._connection_header)


def persistent():
    proxy = rospy.ServiceProxy("sum", AddTwoInts, persistent=True)
    found = [proxy(1, 1).sum, proxy(2, 2).sum]
    proxy.close()
    return found


ask("service: number", lambda: answer_of("r1", AddTwoInts, lambda request: request.a + request.b, 1, 2))
ask("service: list", lambda: answer_of("r2", AddTwoInts, lambda request: [3], 1, 2))
ask("service: tuple", lambda: answer_of("r3", SetBool, lambda request: (True, "ok"), True))
ask("service: dictionary", lambda: answer_of("r4", SetBool, lambda request: {"message": "d"}, True))
ask("service: response", lambda: answer_of("r5", SetBool, lambda request: SetBoolResponse(request.data, "r"), True))
ask("service: empty list", lambda: answer_of("r6", EmptyService, lambda request: []))
ask("service: None", lambda: answer_of("r7", Trigger, lambda request: None))
ask("service: None for Empty", lambda: answer_of("r8", EmptyService, lambda request: None))
ask("service: exception", lambda: answer_of("r9", Trigger, lambda request: 1 / 0))
ask("service: ServiceException", lambda: answer_of("r10", Trigger, lambda request: wrong()))
ask("service: wrong value", lambda: answer_of("r11", SetBool, lambda request: "x", True)[:60])
ask("service: wrong list", lambda: answer_of("r12", SetBool, lambda request: [True], True)[:60])
ask("service: unknown", lambda: rospy.ServiceProxy("nobody", Trigger)())
ask("service: waited for", lambda: rospy.wait_for_service("nobody", timeout=0.2))
ask("service: too few values", lambda: add(1))
ask("service: unknown name", lambda: add(z=1))
ask("service: bad value", lambda: add("x", 1))
ask("service: forms", lambda: [add(AddTwoIntsRequest(3, 4)).sum, add.call(3, 4).sum, add(a=3, b=4).sum, add(a=3).sum])
ask("service: persistent", persistent)
ask("service: offered twice", lambda: rospy.Service("sum", AddTwoInts, lambda request: None))
ask("service: no name", lambda: rospy.Service("", Trigger, print))
ask("service: another type", lambda: rospy.ServiceProxy("sum", Trigger)())
ask("service: error handler", handled_error)
ask("service: ended", ended)
ask("service: headers", headers)
ask("service: attributes", lambda: (add.resolved_name, add.service_class.__name__, add.request_class.__name__))

# -- time ---------------------------------------------------------------------------------------------------------


def ticks(oneshot):
    events = []
    timer = rospy.Timer(rospy.Duration(0.05), events.append, oneshot=oneshot)
    time.sleep(0.28)
    timer.shutdown()
    time.sleep(0.1)
    count = len(events)
    time.sleep(0.2)
    first = events[0]
    return 4 <= count <= 6 or count, count == len(events), first.last_expected, first.last_real, first.last_duration


def dying_timer():
    calls, hook = [], threading.excepthook
    threading.excepthook = lambda args: None
    timer = rospy.Timer(rospy.Duration(0.03), lambda event: calls.append(1) or 1 / 0)
    time.sleep(0.2)
    threading.excepthook = hook
    return len(calls), timer.is_alive()


def late_rate():
    rate, begin, seen = rospy.Rate(20), time.time(), []
    for number in range(4):
        if number == 1:
            time.sleep(0.25)
        rate.sleep()
        seen.append(round((time.time() - begin) / 0.05))
    return seen


ask("time: timer", lambda: ticks(False))
ask("time: once", lambda: ticks(True))
ask("time: dying timer", dying_timer)
ask("time: daemon", lambda: [(each.daemon, each.shutdown()) for each in [rospy.Timer(rospy.Duration(1), print)]])
ask("time: rate of 0", lambda: rospy.Rate(0))
ask("time: rates", lambda: [rospy.Rate(hz).sleep_dur.to_nsec() for hz in (2.5, -1)])
ask("time: late rate", late_rate)
ask("time: remaining", lambda: type(rospy.Rate(1).remaining()).__name__)
ask("time: sleeps", lambda: (rospy.sleep(-1), rospy.sleep(rospy.Duration(0.01)), rospy.sleep(0)))
ask("time: sleep of text", lambda: rospy.sleep("a"))

# -- the end ------------------------------------------------------------------------------------------------------

order = []
ask("end: no function", lambda: rospy.on_shutdown(5))
rospy.on_shutdown(lambda: order.append(("client", rospy.is_shutdown(), rospy.core.is_shutdown_requested())))
rospy.on_shutdown(lambda: 1 / 0)
rospy.on_shutdown(lambda: order.append("another"))
rospy.core.add_preshutdown_hook(lambda reason: order.append(("before", reason, rospy.is_shutdown())))
rospy.core.add_shutdown_hook(lambda reason: order.append(("after", reason, rospy.is_shutdown())))
stderr, sys.stderr = sys.stderr, io.StringIO()
rospy.signal_shutdown("the reason")
sys.stderr = stderr
late = []
ask("end: order", lambda: order)
ask("end: flags", lambda: (rospy.is_shutdown(), rospy.core.is_shutdown_requested()))
ask("end: calls", lambda: (rospy.spin(), rospy.sleep(0.01), rospy.Rate(100).sleep()))
ask("end: publish", lambda: publisher("gone").publish("x"))
ask("end: message", lambda: rospy.wait_for_message("gone", String, timeout=1))
ask("end: late hook", lambda: (rospy.on_shutdown(lambda: late.append(1)), late))
ask("end: time goes on", lambda: rospy.Time.now() > rospy.Time(0))
