"""Headers of messages: their content, and refused definitions."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.convert.build import library_includes, needs_real_boost
from cfepy.extra.convert.capacities import Capacities
from cfepy.extra.convert.cpp_sources import collect
from cfepy.extra.convert.message_headers import Profile, write_headers
from cfepy.status import UsageError
from rospy_shim.types.msgs import Library, shipped
from rospy_shim.types.msgs.definition_sources import Definition, Texts


def library(**texts: str) -> Library:
    """Return a library of the package demo."""
    return Library([Texts({f"demo/{name}": Definition(text, f"{name}.msg") for name, text in texts.items()})])


def header(folder: Path, name: str, of: Library, profile: Profile = Profile.HOST, **options: Capacities) -> str:
    """Return the header of demo/NAME."""
    write_headers([f"demo/{name}"], folder, profile, of, **options)
    return (folder / "demo" / f"{name}.h").read_text(encoding="utf-8")


def test_header_of_a_type_includes_headers_of_its_fields(tmp_path: Path) -> None:
    made = write_headers(["geometry_msgs/PoseStamped", "std_srvs/SetBool"], tmp_path, Profile.HOST, shipped())
    assert [str(path.relative_to(tmp_path)) for path in made] == [
        *(f"geometry_msgs/{name}.h" for name in ("Point", "Pose", "PoseStamped", "Quaternion")),
        "std_msgs/Header.h",
        *(f"std_srvs/SetBool{part}.h" for part in ("", "Request", "Response")),
    ]


def test_an_action_has_its_seven_messages(tmp_path: Path) -> None:
    made = write_headers(["actionlib/TestAction"], tmp_path, Profile.HOST, shipped())
    names = {path.stem for path in made if path.parent.name == "actionlib"}
    parts = ("Goal", "Result", "Feedback")
    assert names == {"TestAction", *(f"Test{part}" for part in parts), *(f"TestAction{part}" for part in parts)}


def test_current_files_are_not_rewritten(tmp_path: Path) -> None:
    made = write_headers(["nav_msgs/Odometry"], tmp_path, Profile.HOST, shipped())
    texts = [path.read_bytes() for path in made]
    made[0].write_text("changed", encoding="utf-8")
    for path in made:
        path.chmod(0o444 if path != made[0] else 0o644)
    stamps = [path.stat().st_mtime_ns for path in made[1:]]
    assert write_headers(["nav_msgs/Odometry"], tmp_path, Profile.HOST, shipped()) == made
    assert [path.read_bytes() for path in made] == texts
    assert [path.stat().st_mtime_ns for path in made[1:]] == stamps


def test_fields_have_the_types_of_gencpp(tmp_path: Path) -> None:
    of = library(All="bool a\nbyte b\nchar c\nint64 d\nfloat32[3] e\nstring[] f\ntime g\nInner[] h\n", Inner="uint8 i")
    text = header(tmp_path, "All", of)
    for line in (
        "typedef uint8_t _a_type;",
        "typedef int8_t _b_type;",
        "typedef uint8_t _c_type;",
        "typedef int64_t _d_type;",
        "typedef boost::array<float, 3> _e_type;",
        "typedef std::vector<std::string> _f_type;",
        "typedef ros::Time _g_type;",
        "typedef std::vector<::demo::Inner> _h_type;",
        "kLeast = 39;",
    ):
        assert line in text


def test_constants(tmp_path: Path) -> None:
    text = header(
        tmp_path,
        "All",
        library(
            All='uint8 DEBUG=1\nint32 LOW=-2147483648\nint64 LONG=-5\nfloat32 PI=3.5\nstring NAME=it\'s "me"\nbool ON=1'
        ),
    )
    for line in (
        "enum { DEBUG = 1u };",
        "enum { LOW = -2147483647 - 1 };",
        "static constexpr int64_t LONG = -5LL;",
        "static constexpr float PI = 3.5f;",
        r'inline static const std::string NAME{"it\'s \"me\""};'.replace(r"\'", "'"),
        "static constexpr uint8_t ON = 1;",
        '#pragma push_macro("DEBUG")\n#undef DEBUG',
        '#pragma pop_macro("DEBUG")',
    ):
        assert line in text


def test_field_named_like_a_keyword_is_refused(tmp_path: Path) -> None:
    text = header(tmp_path, "Word", library(Word="int32 new"))
    assert "_new_type new_{};" in text
    assert "next(message.new_)" in text
    assert 'field("new", message.new_)' in text


def test_capacities_of_the_strict_profile(tmp_path: Path) -> None:
    of = library(All="string a\nstring b\nfloat64[] c\nInner[] d\nstring[] e", Inner="uint8 i")
    fields = {"demo/All.b": 200, "demo/All.d": 7, "demo/All.e": 3, "demo/All.e[]": 5}
    text = header(tmp_path, "All", of, Profile.STRICT, capacities=Capacities(fields, text=20, array=30))
    for line in (
        "typedef roscfe::FixedString<20> _a_type;",
        "typedef roscfe::FixedString<200> _b_type;",
        "typedef roscfe::FixedVector<double, 30> _c_type;",
        "typedef roscfe::FixedVector<::demo::Inner, 7> _d_type;",
        "typedef roscfe::FixedVector<roscfe::FixedString<5>, 3> _e_type;",
    ):
        assert line in text


def test_an_array_of_messages_needs_a_capacity(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"missing capacity of demo/All\.d, an array of demo/Inner"):
        header(tmp_path, "All", library(All="Inner[] d", Inner="uint8 i"), Profile.STRICT)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("wrong", [0, -1, 1 << 24, True, "8"])
def test_a_capacity_is_a_number(tmp_path: Path, wrong: int) -> None:
    with pytest.raises(UsageError, match=r"demo/All\.a: a capacity must be a number"):
        header(tmp_path, "All", library(All="string a"), Profile.STRICT, capacities=Capacities({"demo/All.a": wrong}))


def test_a_type_that_is_unknown(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="unknown message type 'demo/Nothing'"):
        header(tmp_path, "Nothing", library(All="string a"))


def test_name_that_is_invalid_in_cpp_is_refused(tmp_path: Path) -> None:
    of = Library([Texts({"new/Thing": Definition("uint8 a", "Thing.msg")})])
    with pytest.raises(UsageError, match="new/Thing is not a valid name in C"):
        write_headers(["new/Thing"], tmp_path, Profile.HOST, of)


def test_definition_equals_the_connection_header(tmp_path: Path) -> None:
    of = library(All='# a "comment" \\ \u00e4\nInner d', Inner="uint8 i")
    text = header(tmp_path, "All", of)
    assert r'"# a \"comment\" \\ \303\244\n"' in text
    assert f'"{of.md5sum("demo/All")}"' in text
    assert '"MSG: demo/Inner\\n"' in text


@pytest.mark.parametrize(
    ("header", "host", "pool"),
    [
        *(("bind", False, False), ("thread/mutex", False, False), ("version", True, True), ("config", True, True)),
        *(("asio", True, True), ("thread", True, False), ("thread/barrier", False, False)),
    ],
)
def test_header_of_boost_selects_the_small_or_the_installed_boost(
    tmp_path: Path, header: str, host: bool, pool: bool
) -> None:
    source = tmp_path / "node.cpp"
    source.write_text(f"#include <boost/{header}.hpp>\n", encoding="utf-8")
    found = collect([source], library_includes())
    assert [needs_real_boost(found, profile) for profile in (Profile.HOST, Profile.POOL)] == [host, pool]
