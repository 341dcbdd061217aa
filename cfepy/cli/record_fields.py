"""The fields of a record of the trace that is a packet or a message, by name, to tell two of them apart."""

from __future__ import annotations

from cfepy.mission import Mission
from cfepy.mission.dictionary import dictionary_of
from cfepy.mission.topics import library_of, plain, topics_of
from cfepy.mission.values import flat, text_of
from cfepy.status import CfeError
from cfepy.trace import UNSENT

_FIRST_MARK = 0x20  # smaller first bytes begin packets


def fields_of(record: bytes, mission: Mission) -> dict[str, str]:
    """Name and value of each field; none for a record of another kind, or of a type that is not known."""
    if record[:1] == UNSENT:
        return _of_message(record, mission)
    if not record or record[0] >= _FIRST_MARK:
        return {}
    dictionary = dictionary_of(mission.spec)
    dictionary.learn(topics_of(mission))
    try:
        decoded = dictionary.decode(record)
    except CfeError:
        return {}
    time = {} if decoded.time_s is None else {"time of the header": f"{decoded.time_s:.6f}"}
    return {"sequence": str(decoded.sequence), **time, **_texts(decoded.values)}


def _of_message(record: bytes, mission: Mission) -> dict[str, str]:
    """Of a message that nobody gets."""
    name, _, data = record[1:].partition(b"\0")
    topic = next((each for each in topics_of(mission) if each.name == name.decode()), None)
    if topic is None or not topic.type:
        return {}
    try:
        return _texts(plain(library_of(topic).message_class(topic.type)().deserialize(data)))
    except Exception:  # whatever the generated code raises for bytes that are no such message
        return {}


def _texts(values: object) -> dict[str, str]:
    return {path: text_of(value) for path, value in flat(values).items()}
