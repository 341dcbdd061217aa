"""The observer node beside the tested node: it records topics, and executes the stimulus with the names below.

    every(hz, topic, type, message or function of a count, n)   publish regularly
    pub(topic, type, latch, queue_size), waitsub(topic)         publish by hand
    serve(name, type, function), call(key, name, type, ...)     offer and call services; answers go to R[key]
    wait(topic, n), sleep(seconds), stop                        wait for messages, for time; set at the end
    drive(rounds, gap)                                          feed and record all that is on the graph (driving.py)
    N, T, R                                                     counts, messages as plain data, remarks
    mc(type), sc(type), conv(value)                             classes by name; a message as plain data

It is an ordinary node and also runs on ROS. Usage: observer.py FOLDER, with its scenario.json in the folder.
It writes done and result.json there, and ends when a file called end appears.
"""

import json
import os
import sys
import threading
import time
import traceback

import genpy
import roslib.message
import rospy

KEPT = 400  # messages of a topic
LONGEST = 64  # items of a sequence that are kept whole
OF_ROSCORE = ("/rosdistro", "/rosversion", "/run_id")

folder = sys.argv[1]
with open(os.path.join(folder, "scenario.json"), encoding="utf-8") as _file:
    S = json.load(_file)
N = dict.fromkeys(S["observe"], 0)
T = {topic: [] for topic in S["observe"]}
R = {}
arrivals = {topic: [] for topic in S["observe"]}
pubs = {}
stop = threading.Event()
lock = threading.Lock()
sleep = time.sleep


def conv(value):
    if isinstance(value, genpy.Message):
        return {slot: conv(getattr(value, slot)) for slot in value.__slots__}
    if isinstance(value, (genpy.Time, genpy.Duration)):
        return {"secs": value.secs, "nsecs": value.nsecs}
    if isinstance(value, bytes):
        return {"bytes": len(value), "head": value[:16].hex()}
    if isinstance(value, (list, tuple)):
        short = [conv(item) for item in value[:LONGEST]]
        return short if len(value) <= LONGEST else {"list": len(value), "head": short[:4]}
    if isinstance(value, float) and not abs(value) < float("inf"):
        return repr(value)
    return value


def mc(name):
    found = roslib.message.get_message_class(name)
    if found is None:
        raise RuntimeError("unknown message class " + name)
    return found


def sc(name):
    return roslib.message.get_service_class(name)


def record(message, topic):
    with lock:
        N[topic] += 1
        arrivals[topic].append(time.time())
        if len(T[topic]) < KEPT:
            T[topic].append(conv(message))


def pub(topic, name, latch=False, queue_size=10):
    if topic not in pubs:
        pubs[topic] = rospy.Publisher(topic, mc(name), queue_size=queue_size, latch=latch)
    return pubs[topic]


def every(hz, topic, name, what, n=None):
    publisher = pub(topic, name)

    def run():
        count = 0
        while not stop.is_set() and (n is None or count < n):
            try:
                publisher.publish(what(count) if callable(what) else what)
            except Exception as error:
                R.setdefault("errors", []).append(repr(error))
                return
            count += 1
            time.sleep(1.0 / hz)

    thread = threading.Thread(target=run)
    thread.daemon = True
    thread.start()
    return thread


def serve(name, kind, function):
    return rospy.Service(name, sc(kind), function)


def call(key, name, kind, *args, **fields):
    try:
        rospy.wait_for_service(name, timeout=6)
        answer = rospy.ServiceProxy(name, sc(kind))(*args, **fields)
        R[key] = conv(answer)
        return answer
    except Exception as error:
        R[key] = {"exception": type(error).__name__, "text": str(error)}


def watch(topic, kind):
    N.setdefault(topic, 0)
    T.setdefault(topic, [])
    arrivals.setdefault(topic, [])
    rospy.Subscriber(topic, kind, record, callback_args=topic)


def drive(rounds=5, gap=0.2):
    from driving import Drive

    done = Drive(watch, conv)
    R.update(kinds=done.kinds, services=done.services, answers=done.answers)
    done.run(rounds, gap)
    R["params"] = {name: rospy.get_param(name) for name in rospy.get_param_names() if name not in OF_ROSCORE}


def wait(topic, n=1, timeout=10):
    end = time.time() + timeout
    while N[topic] < n and time.time() < end:
        time.sleep(0.02)
    return N[topic] >= n


def waitsub(topic, timeout=8):
    end = time.time() + timeout
    while pubs[topic].get_num_connections() < 1 and time.time() < end:
        time.sleep(0.02)
    time.sleep(0.1)


def write(name, text=""):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(text)


def rate(times):
    if len(times) < 3 or times[-1] <= times[0]:
        return None
    return (len(times) - 1) / (times[-1] - times[0])


def main():
    rospy.init_node("probe", disable_signals=True, log_level=rospy.ERROR)
    subscribers = [
        rospy.Subscriber(topic, mc(name), record, callback_args=topic) for topic, name in S["observe"].items()
    ]
    end = time.time() + S["seconds"]
    try:
        exec(compile(S["stimulus"], "stimulus", "exec"), globals())
    except Exception:
        R["stimulus failed"] = traceback.format_exc()
    time.sleep(max(0.0, end - time.time()))
    write("done")
    while not os.path.exists(os.path.join(folder, "end")):
        time.sleep(0.05)
    stop.set()
    rates = {topic: rate(times) for topic, times in arrivals.items()}
    write("result.json", json.dumps({"N": N, "T": T, "R": R, "rate": rates}))
    for subscriber in subscribers:
        subscriber.unregister()
    os._exit(0)


if __name__ == "__main__":
    main()
