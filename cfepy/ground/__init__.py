"""A ground system's view of a mission: names, dictionary, topics, values, link, bags and files.

Code that works on packets, files and names of a ground system, with or without a running mission, belongs here.
Checking a run is in `cfepy.monitors`; flying one is in `cfepy.pilot`.

The names below are loaded on first use, so a run loads only the parts of this package that it needs. The central file
is `cfepy/ground/dictionary.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.ground.mission_names import DICTIONARY, ROS, ForeignDeclarations, LiveNames, kind_of, names_in, names_of
from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.ground.bag import BagReader, header_of, is_bag
    from cfepy.ground.command_trial import CommandTrial
    from cfepy.ground.dictionary import Decoded, Dictionary, dictionary_of, struct_layout, table_type, table_types
    from cfepy.ground.events import EVENT_IDS, EVENT_TYPES, DecodedEvent
    from cfepy.ground.fields import MessageDecoder, steps_of, value_at
    from cfepy.ground.json_messages import message_from_json
    from cfepy.ground.json_packets import EVENTS, PACKETS, event_json, log_schema, packet_json, packet_schema
    from cfepy.ground.layout_sources import DeclaredField, DeclaredLayout, declared_layouts
    from cfepy.ground.link import CI_PORT, TO_PORT, GroundLink
    from cfepy.ground.mcap_recorder import recorder_of
    from cfepy.ground.node import (
        GroundConsole,
        check_message_type,
        empty_mission,
        ground_node_ended,
        with_ground_node,
        with_player,
    )
    from cfepy.ground.recording import RecordingSummary, rewrite, summary_of
    from cfepy.ground.ros_side import AbsentError, RosSide, near
    from cfepy.ground.series import Samples, Series, SeriesRecorder, SeriesSet, bag_series, candidates, packet_series
    from cfepy.ground.shown_packets import (
        APPLICATIONS,
        CLOCK,
        PACKAGE,
        TOO_SHORT,
        ShownPacket,
        ShownPackets,
        definitions_of,
    )
    from cfepy.ground.survey import LOOK_S, MidRow, Survey, lock_path, lock_text, locked, spread_out, surveyed_topics
    from cfepy.ground.topics import Topic, library_of, plain, topic_id, topics_of
    from cfepy.ground.traffic_graph.drawing import graph_svg
    from cfepy.ground.traffic_graph.graph_texts import graph_dot, graph_text
    from cfepy.ground.traffic_graph.model import MissionGraph, graph_of
    from cfepy.ground.values import flat, int_of, line_of, measured_fields, number_of, packet_of, text_of, unknown_field
    from cfepy.ground.xtce import xtce_name

__all__ = [
    "APPLICATIONS",
    "CI_PORT",
    "CLOCK",
    "DICTIONARY",
    "EVENTS",
    "EVENT_IDS",
    "EVENT_TYPES",
    "LOOK_S",
    "PACKAGE",
    "PACKETS",
    "ROS",
    "TOO_SHORT",
    "TO_PORT",
    "AbsentError",
    "BagReader",
    "CommandTrial",
    "DeclaredField",
    "DeclaredLayout",
    "Decoded",
    "DecodedEvent",
    "Dictionary",
    "ForeignDeclarations",
    "GroundConsole",
    "GroundLink",
    "LiveNames",
    "MessageDecoder",
    "MidRow",
    "MissionGraph",
    "RecordingSummary",
    "RosSide",
    "Samples",
    "Series",
    "SeriesRecorder",
    "SeriesSet",
    "ShownPacket",
    "ShownPackets",
    "Survey",
    "Topic",
    "bag_series",
    "candidates",
    "check_message_type",
    "declared_layouts",
    "definitions_of",
    "dictionary_of",
    "empty_mission",
    "event_json",
    "flat",
    "graph_dot",
    "graph_of",
    "graph_svg",
    "graph_text",
    "ground_node_ended",
    "header_of",
    "int_of",
    "is_bag",
    "kind_of",
    "library_of",
    "line_of",
    "lock_path",
    "lock_text",
    "locked",
    "log_schema",
    "measured_fields",
    "message_from_json",
    "names_in",
    "names_of",
    "near",
    "number_of",
    "packet_json",
    "packet_of",
    "packet_schema",
    "packet_series",
    "plain",
    "recorder_of",
    "rewrite",
    "spread_out",
    "steps_of",
    "struct_layout",
    "summary_of",
    "surveyed_topics",
    "table_type",
    "table_types",
    "text_of",
    "topic_id",
    "topics_of",
    "unknown_field",
    "value_at",
    "with_ground_node",
    "with_player",
    "xtce_name",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".bag": (
                "BagReader",
                "header_of",
                "is_bag",
            ),
            ".command_trial": ("CommandTrial",),
            ".layout_sources": (
                "DeclaredField",
                "DeclaredLayout",
                "declared_layouts",
            ),
            ".dictionary": (
                "Decoded",
                "Dictionary",
                "dictionary_of",
                "struct_layout",
                "table_type",
                "struct_layout",
                "table_types",
            ),
            ".events": (
                "EVENT_IDS",
                "EVENT_TYPES",
                "DecodedEvent",
            ),
            ".fields": (
                "MessageDecoder",
                "steps_of",
                "value_at",
            ),
            ".traffic_graph.drawing": ("graph_svg",),
            ".traffic_graph.model": (
                "MissionGraph",
                "graph_of",
            ),
            ".traffic_graph.graph_texts": (
                "graph_dot",
                "graph_text",
            ),
            ".link": (
                "CI_PORT",
                "TO_PORT",
                "GroundLink",
            ),
            ".mcap_recorder": ("recorder_of",),
            ".node": (
                "GroundConsole",
                "check_message_type",
                "empty_mission",
                "ground_node_ended",
                "with_ground_node",
                "with_player",
            ),
            ".json_messages": ("message_from_json",),
            ".json_packets": (
                "EVENTS",
                "PACKETS",
                "event_json",
                "log_schema",
                "packet_json",
                "packet_schema",
            ),
            ".recording": (
                "RecordingSummary",
                "rewrite",
                "summary_of",
            ),
            ".ros_side": ("AbsentError", "RosSide", "near"),
            ".series": (
                "Samples",
                "Series",
                "SeriesRecorder",
                "SeriesSet",
                "bag_series",
                "packet_series",
                "candidates",
            ),
            ".shown_packets": (
                "APPLICATIONS",
                "CLOCK",
                "PACKAGE",
                "TOO_SHORT",
                "ShownPacket",
                "ShownPackets",
                "definitions_of",
            ),
            ".survey": (
                "LOOK_S",
                "MidRow",
                "Survey",
                "lock_path",
                "lock_text",
                "locked",
                "spread_out",
                "surveyed_topics",
            ),
            ".topics": (
                "Topic",
                "library_of",
                "plain",
                "topic_id",
                "topics_of",
            ),
            ".values": (
                "flat",
                "measured_fields",
                "int_of",
                "line_of",
                "number_of",
                "packet_of",
                "text_of",
                "unknown_field",
            ),
            ".xtce": ("xtce_name",),
        },
    )
