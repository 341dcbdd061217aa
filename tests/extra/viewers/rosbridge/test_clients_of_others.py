"""Foreign clients with a robot that runs in real time: roslibpy, and roslibjs in a browser."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

from dev.pages.browser import Browser, find_browser
from tests.extra.viewers.robot import PATIENCE_S, robot

pytestmark = pytest.mark.slow
CLIENT = Path(__file__).with_name("roslibpy_client.py")
ROSLIBJS = "roslib@1.4.1"
NEEDS = "needs a browser and npm: install the packages chromium and npm"
CAN_BROWSE = find_browser() is not None and shutil.which("npm") is not None
IS_REQUIRED = os.environ.get("CFEPY_BROWSER") == "required" and shutil.which("npm") is not None


def test_roslibpy(tmp_path: Path) -> None:
    journal = tmp_path / "run.cfepy"
    with robot(tmp_path, "--record", str(journal), "--quiet") as port:
        client = [sys.executable, str(CLIENT), f"ws://127.0.0.1:{port}"]
        done = subprocess.run(client, capture_output=True, text=True, timeout=4 * PATIENCE_S)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == {
        "is there": True,
        "type": "std_msgs/String",
        "types": ["/numbers"],
        "services": ["/switch"],
        "fields": ["seq", "stamp", "frame_id"],
        "speed": 3,
        "made": {"a": [1, 2.5, "x"]},
        "deleted": None,
        "chatter": ["first", "ONE", "TWO"],
        "octets": "AAH/",
        "numbers": [1.5, None, -2.0],
        "switch": {"success": True, "message": "on"},
        "off": "service [/switch] responded with an error: b'error processing request: off is not possible'",
        "told": "client says: hello",
        "fibonacci": [0, 1, 1, 2, 3, 5, 8],
        "feedback": 5,
    }
    assert "ERROR" not in done.stderr
    replay = [sys.executable, "-m", "cfepy", "replay", str(journal), "--quiet"]
    again = subprocess.run(replay, capture_output=True, text=True, timeout=4 * PATIENCE_S)
    assert "the same run as" in again.stderr, again.stderr


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Path, str]]:
    """Return a folder with roslibjs and a page that loads it, and the URL at which this computer serves it."""
    folder = tmp_path_factory.mktemp("pages")
    subprocess.run(["npm", "pack", "--silent", ROSLIBJS], cwd=folder, check=True, timeout=4 * PATIENCE_S)
    (archive,) = folder.glob("*.tgz")
    shutil.unpack_archive(archive, folder)
    (folder / "page.html").write_text(
        '<link rel="icon" href="data:,"><script src="package/build/roslib.min.js"></script>', encoding="utf-8"
    )
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(_Quiet, directory=str(folder)))
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield folder, f"http://127.0.0.1:{server.server_port}/page.html"
    server.shutdown()
    server.server_close()
    thread.join()


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_: object) -> None:
        """Log nothing."""


SCRIPT = """(async () => {
  const ros = new ROSLIB.Ros({url: URL});
  await new Promise((done, failed) => {
    ros.on("connection", done);
    ros.on("close", () => failed(new Error("refused")));
  });
  const asked = (method, ...given) => new Promise((done, failed) => ros[method](...given, done, failed));
  let nodes = [];
  while (!nodes.includes("/robot")) nodes = await asked("getNodes");
  let actions = [];
  while (!actions.includes("/fibonacci")) actions = await asked("getActionServers");
  const first = (name, messageType, more = {}) => new Promise(done => {
    const topic = new ROSLIB.Topic({ros, name, messageType, ...more});
    topic.subscribe(message => { topic.unsubscribe(); done(message); });
  });
  const found = {};
  found.type = await asked("getTopicType", "/chatter");
  found.services = await asked("getServicesForType", "std_srvs/SetBool");
  found.fields = (await asked("getMessageDetails", "std_msgs/Header"))[0].fieldnames;
  const speed = new ROSLIB.Param({ros, name: "/speed"});
  found.speed = await new Promise(done => speed.get(done));
  await new Promise(done => speed.set(4, done));
  found.faster = await new Promise(done => speed.get(done));
  found.plain = await first("/chatter", "std_msgs/String");
  found.png = await first("/chatter", "std_msgs/String", {compression: "png"});
  found.numbers = (await first("/numbers", "std_msgs/Float64MultiArray")).data;
  const cbor = await first("/numbers", "std_msgs/Float64MultiArray", {compression: "cbor"});
  found.cbor = [cbor.data.constructor.name, ...cbor.data].map(String);
  found.octets = Array.from((await first("/octets", "std_msgs/UInt8MultiArray", {compression: "cbor"})).data);
  const raw = await first("/chatter", "std_msgs/String", {compression: "cbor-raw"});
  found.raw = new TextDecoder().decode(raw.bytes.slice(4));
  const heard = [];
  const chatter = new ROSLIB.Topic({ros, name: "/chatter", messageType: "std_msgs/String"});
  const enough = new Promise(done => chatter.subscribe(message => {
    heard.push(message.data);
    if (heard.length == 3) done();
  }));
  const orders = new ROSLIB.Topic({ros, name: "/orders", messageType: "std_msgs/String"});
  for (const data of ["one", "two"]) orders.publish(new ROSLIB.Message({data}));
  await enough;
  found.heard = heard;
  const service = new ROSLIB.Service({ros, name: "/switch", serviceType: "std_srvs/SetBool"});
  const called = data => new Promise((done, failed) =>
    service.callService(new ROSLIB.ServiceRequest({data}), done, failed));
  found.on = await called(true);
  found.off = await called(false).catch(String);
  const own = new ROSLIB.Service({ros, name: "/by_client", serviceType: "std_srvs/Trigger"});
  own.advertise((request, response) => {
    response.success = true;
    response.message = "hello";
    return true;
  });
  const told = first("/told", "std_msgs/String");
  new ROSLIB.Topic({ros, name: "/ask", messageType: "std_msgs/String"}).publish(new ROSLIB.Message({data: ""}));
  found.told = (await told).data;
  const client = new ROSLIB.ActionClient({
    ros, serverName: "/fibonacci", actionName: "actionlib_tutorials/FibonacciAction"});
  const goal = new ROSLIB.Goal({actionClient: client, goalMessage: {order: 5}});
  let feedback = 0;
  goal.on("feedback", () => { feedback += 1; });
  found.result = await new Promise(done => { goal.on("result", done); goal.send(); });
  found.feedback = feedback;
  ros.close();
  return found;
})()"""


@pytest.mark.skipif(not CAN_BROWSE and not IS_REQUIRED, reason=NEEDS)
def test_roslibjs_in_a_browser(tmp_path: Path, pages: tuple[Path, str]) -> None:
    _, url = pages
    with robot(tmp_path, "--quiet") as port, Browser(tmp_path / "profile") as browser:
        browser.call("Page.navigate", url=url)
        browser.evaluate(
            "new Promise(done => document.readyState == 'complete' ? done() : addEventListener('load', done))"
        )
        assert browser.evaluate(SCRIPT.replace("URL", f"'ws://127.0.0.1:{port}'")) == {
            "type": "std_msgs/String",
            "services": ["/switch"],
            "fields": ["seq", "stamp", "frame_id"],
            "speed": 3,
            "faster": 4,
            "plain": {"data": "first"},
            "png": {"data": "first"},
            "numbers": [1.5, None, -2.0],
            "cbor": ["Float64Array", "1.5", "NaN", "-2"],
            "octets": [0, 1, 255],
            "raw": "first",
            "heard": ["first", "ONE", "TWO"],
            "on": {"success": True, "message": "on"},
            "off": "service [/switch] responded with an error: b'error processing request: off is not possible'",
            "told": "client says: hello",
            "result": {"sequence": [0, 1, 1, 2, 3, 5, 8]},
            "feedback": 5,
        }
        assert browser.errors == []


@pytest.mark.skipif(not CAN_BROWSE and not IS_REQUIRED, reason=NEEDS)
def test_page_without_an_origin_needs_the_token(tmp_path: Path, pages: tuple[Path, str]) -> None:
    """A page that is a file has no origin that could be known."""
    folder, _ = pages
    connect = """new Promise(done => {
      const socket = new WebSocket(URL);
      socket.onopen = () => { socket.close(); done(true); };
      socket.onerror = () => done(false);
    })"""
    with (
        robot(tmp_path, "--quiet", "--viewer-token", "right-token") as port,
        Browser(tmp_path / "profile") as browser,
    ):
        browser.open(folder / "page.html")
        assert not browser.evaluate(connect.replace("URL", f"'ws://127.0.0.1:{port}'"))
        assert not browser.evaluate(connect.replace("URL", f"'ws://127.0.0.1:{port}/?token=wrong-token'"))
        assert browser.evaluate(connect.replace("URL", f"'ws://127.0.0.1:{port}/?token=right-token'"))
