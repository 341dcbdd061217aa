"""Tests in C++, with GoogleTest, of a rostest file."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.extra.convert.google_test import google_test_folder
from cfepy.status import UsageError
from dev.convert.ping import ping_package
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]


def has_google_test() -> bool:
    try:
        return google_test_folder().is_dir()
    except UsageError:
        return False


needs_google_test = pytest.mark.skipif(not has_google_test(), reason="libgtest-dev is not installed")

CMAKE = """
if(CATKIN_ENABLE_TESTING)
  find_package(rostest REQUIRED)
  add_rostest_gtest(words_test test/words.test test/words_test.cpp)
  target_link_libraries(words_test words ${catkin_LIBRARIES})
endif()
"""
TESTS = """
#include <gtest/gtest.h>
#include <ping/Beat.h>
#include <ping/words.h>
#include <ros/ros.h>

static int g_heard = 0;
static void heard(const ping::Beat &) { ++g_heard; }

TEST(Beats, areHeard)
{
  ros::NodeHandle nh;
  ros::Subscriber sub = nh.subscribe("beat", 100, heard);
  const ros::Time end = ros::Time::now() + ros::Duration(60.0);
  while (ros::Time::now() < end)
  {
    ros::Duration(0.5).sleep();
    ros::spinOnce();
  }
  EXPECT_GT(g_heard, 550);
}

TEST(Beats, haveWords)
{
  EXPECT_EQ("odd", word_of(3));
  EXPECT_STREQ("one", "two") << "said & done <so>";
  ASSERT_NEAR(1.0, 2.0, 0.5);
  FAIL() << "not reached";
}

class Held : public testing::TestWithParam<int>
{
};
TEST_P(Held, isSmall) { EXPECT_LT(GetParam(), 3); }
INSTANTIATE_TEST_SUITE_P(Some, Held, testing::Values(1, 2));
TEST(Throwing, isCaught)
{
  EXPECT_THROW(throw std::runtime_error("x"), std::runtime_error);
}
TEST(Throwing, isNotCaught) { throw std::runtime_error("it fell"); }
TEST(Throwing, DISABLED_never) { FAIL(); }

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "words_test");
  return RUN_ALL_TESTS();
}
"""
LAUNCH = """<launch>
<node pkg="ping" type="sender" name="sender"><param name="hz" value="10"/></node>
<test test-name="words" pkg="ping" type="words_test" time-limit="{limit}"/>
</launch>
"""


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    folder = ping_package(tmp_path)
    cmake = folder / "CMakeLists.txt"
    cmake.write_text(cmake.read_text(encoding="utf-8") + CMAKE, encoding="utf-8")
    (folder / "test").mkdir(exist_ok=True)
    (folder / "test/words_test.cpp").write_text(TESTS, encoding="utf-8")
    (folder / "test/words.test").write_text(LAUNCH.format(limit=90), encoding="utf-8")
    return folder


@needs_google_test
def test_result_of_each_google_test_is_reported(
    package: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    results = tmp_path / "results.xml"
    assert main(["rostest", str(package / "test/words.test"), "--results", str(results)]) == 1
    shown, told = capfd.readouterr()
    assert "left out" not in told
    lines = shown.splitlines()
    passed = [line for line in lines if line.endswith("[passed]")]
    assert passed == [
        f"[ping.words.{name}][passed]"
        for name in ("Beats/areHeard", "Throwing/isCaught", "Some/Held/isSmall/0", "Some/Held/isSmall/1")
    ]
    assert lines.count("[ping.words.Beats/haveWords][FAILURE]") == 2
    assert "    said & done <so>" in lines
    assert "not reached" not in shown
    assert "it fell" in shown
    assert [line for line in lines if line.startswith(" * ")] == [
        " * RESULT: FAIL",
        " * TESTS: 6",
        " * ERRORS: 0",
        " * FAILURES: 2",
    ]
    assert "haveWords" in results.read_text(encoding="utf-8")


@needs_google_test
def test_passed_test_and_timeout_are_reported(package: Path, capfd: pytest.CaptureFixture[str]) -> None:
    source = package / "test/words_test.cpp"
    source.write_text(
        TESTS.replace('"two"', '"one"').replace("2.0, 0.5", "1.0, 0.5").replace("FAIL() <<", "SUCCEED() <<"),
        encoding="utf-8",
    )
    source.write_text(
        source.read_text(encoding="utf-8").replace('throw std::runtime_error("it fell")', "SUCCEED()"), encoding="utf-8"
    )
    launch = package / "test/words.test"
    assert main(["rostest", str(launch), "--text"]) == 0
    shown = capfd.readouterr().out
    assert "RESULT: SUCCESS" in shown
    assert "[/words] [ RUN      ] Beats.areHeard" in shown
    launch.write_text(LAUNCH.format(limit=30), encoding="utf-8")
    assert main(["rostest", str(launch)]) == 1
    shown = capfd.readouterr().out
    assert "did not end within its 30 virtual seconds" in shown
    assert "| [ RUN      ] Beats.areHeard" in shown


def test_missing_google_test_is_reported(
    package: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("GTEST_ROOT", str(tmp_path / "nowhere"))
    assert main(["rostest", str(package / "test/words.test")]) == 1
    shown = capfd.readouterr().out
    assert "the sources of GoogleTest are not installed" in shown
    assert "apt-get install libgtest-dev" in shown
    assert os.fspath(tmp_path / "nowhere") in shown
