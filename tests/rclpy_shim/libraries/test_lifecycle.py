"""Lifecycle nodes, with the results that rclpy 9.1 has."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rclpy_shim import programs

pytestmark = pytest.mark.slow
HEAD = """
from lifecycle_msgs.msg import Transition, TransitionEvent
from lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetAvailableTransitions, GetState
from rclpy.lifecycle import LifecycleNode, LifecycleState, Publisher, State, TransitionCallbackReturn
answers = {}
class Own(LifecycleNode):
    def step(self, name, state):
        print(name, state.label, state.state_id)
        answer = answers.get(name, TransitionCallbackReturn.SUCCESS)
        if answer is None:
            raise ValueError(name)
        return answer
    def on_configure(self, state):
        self.pub = self.create_lifecycle_publisher(String, "a", 10)
        return self.step("configure", state)
    def on_activate(self, state):
        super().on_activate(state)
        return self.step("activate", state)
    def on_deactivate(self, state):
        super().on_deactivate(state)
        return self.step("deactivate", state)
    def on_cleanup(self, state):
        self.destroy_publisher(self.pub)
        return self.step("cleanup", state)
    def on_shutdown(self, state):
        return self.step("shutdown", state)
    def on_error(self, state):
        return self.step("error", state)
n = Own("n")
other = rclpy.create_node("other")
executor = rclpy.executors.SingleThreadedExecutor()
executor.add_node(n)
executor.add_node(other)
def ask(kind, name, **fields):
    client = other.create_client(kind, f"/n/{name}")
    client.wait_for_service()
    future = client.call_async(kind.Request(**fields))
    executor.spin_until_future_complete(future, timeout_sec=1.0)
    return future.result()
def change(**fields):
    return ask(ChangeState, "change_state", transition=Transition(**fields)).success
def state():
    found = ask(GetState, "get_state").current_state
    return f"{found.label} {found.id}"
"""


def printed(body: str, folder: Path) -> list[str]:
    """Return the lines that a program with the functions of `HEAD` prints."""
    return programs.printed(HEAD + body, folder, seconds=8.0)


def test_transitions_call_back_and_manage_publishers(tmp_path: Path) -> None:
    lines = printed(
        """
other.create_subscription(String, "a", lambda m: print("got", m.data), 10)
def send(text):
    n.pub.publish(String(data=text))
    end = time.time() + 0.1
    while time.time() < end:
        executor.spin_once(timeout_sec=0.05)
print(state())
print(change(id=Transition.TRANSITION_CONFIGURE), state())
send("inactive")
print(n.pub.is_activated)
print(change(label="activate"), state())
time.sleep(0.2)
send("active")
print(n.trigger_deactivate(), state())
send("inactive")
print(n.trigger_cleanup(), n.trigger_shutdown(), state())
""",
        tmp_path,
    )
    assert [line for line in lines if not line.startswith("[")] == [
        "unconfigured 1",
        "configure unconfigured 1",
        "True inactive 2",
        "False",
        "activate inactive 2",
        "True active 3",
        "got active",
        "deactivate active 3",
        "TransitionCallbackReturnType.SUCCESS inactive 2",
        "cleanup inactive 2",
        "shutdown unconfigured 1",
        "TransitionCallbackReturnType.SUCCESS TransitionCallbackReturnType.SUCCESS finalized 4",
    ]


def test_transitions_fail_as_the_callbacks_say(tmp_path: Path) -> None:
    lines = printed(
        """
print(change(id=Transition.TRANSITION_ACTIVATE), state())
print(change(id=77), change(label="nothing"), state())
answers["configure"] = TransitionCallbackReturn.FAILURE
print(change(id=Transition.TRANSITION_CONFIGURE), state())
answers["configure"] = None
print(change(id=Transition.TRANSITION_CONFIGURE), state())
answers["configure"] = TransitionCallbackReturn.SUCCESS
answers["activate"] = TransitionCallbackReturn.ERROR
answers["error"] = TransitionCallbackReturn.FAILURE
print(n.trigger_configure(), n.trigger_activate(), state())
attempt(n.trigger_shutdown)
print(n.trigger_configure())
""",
        tmp_path,
    )
    assert [line for line in lines if not line.startswith("[")] == [
        "False unconfigured 1",
        "False False unconfigured 1",
        "configure unconfigured 1",
        "False unconfigured 1",
        "configure unconfigured 1",
        "error unconfigured 1",
        "False unconfigured 1",
        "configure unconfigured 1",
        "activate inactive 2",
        "error inactive 2",
        "TransitionCallbackReturnType.SUCCESS TransitionCallbackReturnType.ERROR finalized 4",
        "RCLError | Shutdown transtion not possible",
        "TransitionCallbackReturnType.ERROR",
    ]


def test_services_and_topic_show_the_state_machine(tmp_path: Path) -> None:
    lines = printed(
        """
def show(m):
    print("event", m.transition.id, m.transition.label, m.start_state.label, m.goal_state.label, m.timestamp > 0)
other.create_subscription(TransitionEvent, "/n/transition_event", show, 10)
time.sleep(0.2)
print([(each.id, each.label) for each in ask(GetAvailableStates, "get_available_states").available_states])
def transitions(name):
    found = ask(GetAvailableTransitions, name).available_transitions
    return [(t.transition.id, t.transition.label, t.start_state.label, t.goal_state.label) for t in found]
print(transitions("get_available_transitions"))
change(id=Transition.TRANSITION_CONFIGURE)
end = time.time() + 0.2
while time.time() < end:
    executor.spin_once(timeout_sec=0.05)
print(transitions("get_available_transitions"))
for each in transitions("get_transition_graph"):
    print(*each)
names = [name for name, _ in n.get_service_names_and_types() if name.startswith("/n/")]
print(sorted(name for name in names if "_p" not in name and "_type_" not in name))
""",
        tmp_path,
    )
    assert lines[:7] == [
        "[(0, 'unknown'), (1, 'unconfigured'), (2, 'inactive'), (3, 'active'), (4, 'finalized'), (10, 'configuring'), "
        "(11, 'cleaningup'), (12, 'shuttingdown'), (13, 'activating'), (14, 'deactivating'), (15, 'errorprocessing')]",
        "[(1, 'configure', 'unconfigured', 'configuring'), (5, 'shutdown', 'unconfigured', 'shuttingdown')]",
        "configure unconfigured 1",
        "event 0  unconfigured configuring False",
        "event 0  configuring inactive False",
        "[(2, 'cleanup', 'inactive', 'cleaningup'), (3, 'activate', 'inactive', 'activating'), "
        "(6, 'shutdown', 'inactive', 'shuttingdown')]",
        "1 configure unconfigured configuring",
    ]
    assert [line.replace(" transition_", " ") for line in lines[7:-1]] == [
        "10 success configuring inactive",
        "11 failure configuring unconfigured",
        "12 error configuring errorprocessing",
        "2 cleanup inactive cleaningup",
        "20 success cleaningup unconfigured",
        "21 failure cleaningup inactive",
        "22 error cleaningup errorprocessing",
        "3 activate inactive activating",
        "30 success activating active",
        "31 failure activating inactive",
        "32 error activating errorprocessing",
        "4 deactivate active deactivating",
        "40 success deactivating inactive",
        "41 failure deactivating active",
        "42 error deactivating errorprocessing",
        "5 shutdown unconfigured shuttingdown",
        "6 shutdown inactive shuttingdown",
        "7 shutdown active shuttingdown",
        "50 success shuttingdown finalized",
        "51 failure shuttingdown finalized",
        "52 error shuttingdown errorprocessing",
        "60 success errorprocessing unconfigured",
        "61 failure errorprocessing finalized",
        "62 error errorprocessing finalized",
    ]
    names = ("change_state", "get_available_states", "get_available_transitions", "get_state", "get_transition_graph")
    assert lines[-1] == str([f"/n/{name}" for name in names])
