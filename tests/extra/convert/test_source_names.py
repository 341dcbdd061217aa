"""Names of topics and services in sources of C++, resolved as ROS does."""

from __future__ import annotations

import pytest

from cfepy.extra.convert.source_names import SourceNames, names_of, without_comments

NAMESPACE, NODE = "/arm", "/arm/driver"


def found(text: str, *remaps: tuple[str, str], **values: str) -> tuple[dict[str, bool], dict[str, bool]]:
    names = names_of(SourceNames([without_comments(text)], values).used(), NAMESPACE, NODE, remaps)
    return names.topics, names.services


@pytest.mark.parametrize(
    ("text", "topics"),
    [
        ('ros::NodeHandle n; n.advertise<std_msgs::String>("chatter", 1000);', {"/arm/chatter": True}),
        (
            '// n.advertise<A>("no", 1);\nros::NodeHandle n; /* n.subscribe("no") */ n.subscribe("/a", 1, cb);',
            {"/a": True},
        ),
        ('ros::NodeHandle p("~"); p.advertise<A>("state", 1);', {"/arm/driver/state": True}),
        ('ros::NodeHandle n; ros::NodeHandle p("~"); n.subscribe<A>("in", 1, cb);', {"/arm/in": True}),
        ('ros::NodeHandle n; ros::NodeHandle m(n, "sub"); m.subscribe("in", 1, cb);', {"/arm/sub/in": True}),
        ('F(ros::NodeHandle nh) { nh.advertise<A>("x", 1); } ros::NodeHandle p("~");', {"/arm/driver/x": True}),
        ('n.subscribe(topic, 1, cb); std::string topic = "scan";', {"/arm/scan": False}),
        ('p.param<std::string>("topic", t, "scan"); n.subscribe(t, 1, cb);', {"/arm/scan": False}),
        ("#include <tf/transform_listener.h>\n", {"/tf": True, "/tf_static": True}),
        ('message_filters::Subscriber<A> sub(nh, "imu", 1);', {"/arm/imu": True}),
        ('ros::SubscribeOptions o = ros::SubscribeOptions::create<A>("c", 1, cb, v, q);', {"/arm/c": True}),
        ('s = "n.advertise(\\"x\\")";', {}),
        ('class A { A() : p_("~") { p_.advertise<B>("x", 1); } ros::NodeHandle p_; };', {"/arm/driver/x": True}),
        (
            'ros::NodeHandle n, p("~"); p.advertise<A>("x", 1); n.advertise<A>("y", 1);',
            {"/arm/driver/x": True, "/arm/y": True},
        ),
        (
            'A::A(ros::NodeHandle n) : n_(n) { n_.advertise<B>("x", 1); } ros::NodeHandle n_; ros::NodeHandle q("~");',
            {"/arm/driver/x": True},
        ),
        ('p_ = ros::NodeHandle("~"); p_.advertise<A>("x", 1); ros::NodeHandle p_;', {"/arm/driver/x": True}),
    ],
)
def test_topics(text: str, topics: dict[str, bool]) -> None:
    assert found(text)[0] == topics


def test_services_and_actions() -> None:
    text = 'n.advertiseService("add", add); ros::service::waitForService("/other"); ros::service::exists("e", true);'
    assert found(text)[1] == {"/arm/add": True, "/other": True, "/arm/e": True}
    assert set(found('actionlib::SimpleActionClient<A> ac("do", true);')[0]) == {
        f"/arm/do/{topic}" for topic in ("goal", "cancel", "status", "feedback", "result")
    }


def test_parameters_of_the_launch_file_and_remaps() -> None:
    text = 'p.param<std::string>("topic", t, "scan"); n.subscribe(t, 1, cb);'
    assert found(text, topic="laser")[0] == {"/arm/laser": False}
    assert found('n.subscribe("in", 1, cb);', ("in", "/out"), ("~x", "y"))[0] == {"/out": True}


def test_computed_names_are_reported() -> None:
    names = SourceNames(["n.advertise<A>(make_name(3), 1); n.subscribe(ops);"], {})
    assert names.used() == []
    assert names.open == ["advertise(make_name(3))"]
