"""Nodes in C++ with threads: one digest on both kinds of tasks, limits, and calls that end the node."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import cfepy
from cfepy import Run
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]

MANIFEST = """<package format="2"><name>busy</name><version>1.0.0</version><description>busy</description>
<maintainer email="a@b.c">a</maintainer><license>Apache-2.0</license><depend>roscpp</depend></package>
"""
NODE = """
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include <pthread.h>
#include <ros/ros.h>
#include <std_msgs/Int32.h>

static std::mutex              g_mutex;
static std::condition_variable g_changed;
static int                     g_heard = -1;

static void *wait_for_ever(void *)
{
  std::unique_lock<std::mutex> lock(g_mutex);
  std::condition_variable      never;
  never.wait(lock, [] { return false; });
  return nullptr;
}

int main(int argc, char **argv)
{
  ros::init(argc, argv, "busy");
  ros::NodeHandle node, own("~");
  const std::string what = own.param("what", std::string("work"));
  ros::Publisher    out  = node.advertise<std_msgs::Int32>("out", 10);
  ros::Subscriber   in   = node.subscribe<std_msgs::Int32>("out", 10, [](const std_msgs::Int32::ConstPtr &message) {
    const std::lock_guard<std::mutex> guard(g_mutex);
    g_heard = message->data;
    g_changed.notify_all();
  });
  pthread_t thread;
  if (what == "many")
  {
    int count = 0;
    for (; pthread_create(&thread, nullptr, wait_for_ever, nullptr) == 0; ++count)
    {
    }
    ROS_INFO("%d threads, then none", count);
    try
    {
      std::thread more([] {});
    }
    catch (const std::system_error &error)
    {
      ROS_INFO("EAGAIN %d", error.code().value() == EAGAIN);
    }
    return 0;
  }
  if (what == "cancel")
  {
    pthread_create(&thread, nullptr, wait_for_ever, nullptr);
    ros::Duration(0.1).sleep();
    pthread_cancel(thread);
  }
  if (what == "twice")
  {
    g_mutex.lock();
    g_mutex.lock();
  }
  if (what == "leave")
  {
    std::thread([] {
      ros::Duration(0.5).sleep();
      ROS_INFO("still here");
    }).detach();
    pthread_exit(nullptr);
  }
  if (what == "inner")
  {
    std::thread outer([] {
      std::thread inner([] { ROS_INFO("inner"); });
      inner.join();
      ROS_INFO("outer");
    });
    outer.join();
    return 0;
  }
  ros::AsyncSpinner spinner(2);
  spinner.start();
  std::vector<std::thread> workers;
  for (int i = 0; i < 3; ++i)
  {
    workers.emplace_back([i] {
      std::unique_lock<std::mutex> lock(g_mutex);
      while (ros::ok())
      {
        g_changed.wait_for(lock, std::chrono::milliseconds(300));
        ROS_INFO("worker %d: %d", i, g_heard);
      }
    });
  }
  ros::Rate rate(5);
  for (int i = 0; ros::ok(); ++i)
  {
    std_msgs::Int32 message;
    message.data = i;
    out.publish(message);
    rate.sleep();
  }
  for (std::thread &each : workers)
  {
    each.join();
  }
  return 0;
}
"""


@pytest.fixture
def launch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    (tmp_path / "package.xml").write_text(MANIFEST, encoding="utf-8")
    (tmp_path / "CMakeLists.txt").write_text("project(busy)\nadd_executable(busy busy.cpp)\n", encoding="utf-8")
    (tmp_path / "busy.cpp").write_text(NODE, encoding="utf-8")
    file = tmp_path / "busy.launch"
    return file


def flown(launch: Path, what: str, more: str = "", tasks: str = "greenlet") -> Run:
    node = f'<node pkg="busy" type="busy" name="busy" {more}><param name="what" value="{what}"/></node>'
    launch.write_text(f"<launch>{node}</launch>\n", encoding="utf-8")
    return cfepy.run(str(launch), seconds=4, tasks=tasks)


def said(run: Run) -> list[str]:
    return [match[1] for line in run.console if (match := re.search(r"\[ INFO\] \[[\d.]+\]: (.*)", line))]


def test_threads_run_the_same_on_both_kinds_of_tasks(launch: Path) -> None:
    runs = [flown(launch, "work", tasks=tasks) for tasks in ("thread", "greenlet")]
    assert runs[0].trace == runs[1].trace
    lines = said(runs[0])
    assert lines == said(runs[1])
    for worker in range(3):
        heard = [int(line.split()[-1]) for line in lines if line.startswith(f"worker {worker}:")]
        assert heard == sorted(heard)
        assert len(set(heard)) > 10


def test_thread_starts_a_thread(launch: Path) -> None:
    assert said(flown(launch, "inner")) == ["inner", "outer"]


def test_main_thread_that_leaves_waits_for_the_others(launch: Path) -> None:
    run = flown(launch, "leave")
    assert said(run) == ["still here"]
    assert run.now < 2


def test_threads_end_where_the_target_has_no_task_left(launch: Path) -> None:
    first, second = said(flown(launch, "many"))
    assert second == "EAGAIN 1"
    assert int(first.split()[0]) > 10


@pytest.mark.parametrize(
    ("what", "event"),
    [
        ("cancel", "pthread_cancel: a task of cFE cannot be ended from another one"),
        ("twice", "a mutex: the thread that holds it locks it again, and would wait for ever"),
    ],
)
def test_call_that_a_task_cannot_make_ends_the_node(launch: Path, what: str, event: str) -> None:
    assert any(event in each.text for each in flown(launch, what).events)
