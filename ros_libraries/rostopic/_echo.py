"""Messages as `rostopic echo` prints them."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable, Iterable
from typing import Any

import genpy
import genpy.message
import rospy

from rostopic._fields import Filter, _str_plot, _str_plot_fields, msgevalgen

CLEAR = "\033[2J\033[;H"


class CallbackEcho:
    """Prints messages. Its `callback` is one for subscribers.

    Args:
        topic: the topic, or a field of it.
        msg_eval: returns the part of a message to print; None for all of it.
        plot: print lines of comma separated values.
        filter_fn: takes a message and returns whether to print it.
        echo_clear: clear the screen before each message.
        echo_all_topics: print messages of other topics as well.
        offset_time: print times as the time elapsed since then.
        count: stop after this many messages.
        field_filter_fn: returns the fields to print.
        fixed_numeric_width: characters of a number.
        value_transform_fn: changes a message before it is printed.
    """

    def __init__(
        self,
        topic: str,
        msg_eval: Callable[[Any], Any] | None,
        plot: bool = False,
        filter_fn: Callable[[Any], Any] | None = None,
        echo_clear: bool = False,
        echo_all_topics: bool = False,
        offset_time: bool = False,
        count: int | None = None,
        field_filter_fn: Filter | None = None,
        fixed_numeric_width: int | None = None,
        value_transform_fn: Callable[..., Any] | None = None,
    ) -> None:
        self.topic = topic.removesuffix("/") if topic else topic
        self.msg_eval = msg_eval
        self.plot = plot
        self.filter_fn = filter_fn
        self.echo_all_topics = echo_all_topics
        self.offset_time = offset_time
        self.max_count = count
        self.field_filter = field_filter_fn
        self.fixed_numeric_width = fixed_numeric_width
        self.value_transform = value_transform_fn
        self.prefix = CLEAR if echo_clear and not plot else ""
        self.suffix = "" if plot else "\n---"
        self.str_fn: Callable[..., str] = _str_plot if plot else self.custom_strify_message
        self.count = 0
        self.done = False
        self.first = True

    def custom_strify_message(
        self,
        val: Any,
        indent: str = "",
        time_offset: Any = None,
        current_time: Any = None,
        field_filter: Filter | None = None,
        type_information: str | None = None,
        fixed_numeric_width: int | None = None,
        value_transform: Callable[..., Any] | None = None,
    ) -> str:
        """Return a message as YAML."""
        if type_information and type_information.startswith("uint8["):
            val = list(val)
        if value_transform is not None:
            val = value_transform(val, type_information)
        text: str = genpy.message.strify_message(
            val,
            indent=indent,
            time_offset=time_offset,
            current_time=current_time,
            field_filter=field_filter,
            fixed_numeric_width=fixed_numeric_width,
        )
        return text

    def callback(self, data: Any, callback_args: dict[str, Any], current_time: Any = None) -> None:
        """Handle a message.

        Args:
            data: the message.
            callback_args: "topic", its topic, and "type_information", the type of the field.
            current_time: time of arrival; None for now.
        """
        if self.filter_fn is not None and not self.filter_fn(data):
            return
        if self.max_count is not None and self.count >= self.max_count:
            self.done = True
            return
        try:
            self._print(data, callback_args["topic"], callback_args.get("type_information"), current_time)
        except Exception:
            self.done = True
            traceback.print_exc()

    def _print(self, data: Any, topic: str, type_information: str | None, current_time: Any) -> None:
        evaluate = self.msg_eval
        if topic != self.topic and self.topic.startswith(topic + "/"):
            evaluate = msgevalgen(self.topic[len(topic) :])
        elif topic != self.topic and not self.echo_all_topics:
            return
        if evaluate is not None:
            data = evaluate(data)
        if data is None:
            return
        self.count += 1
        if self.plot and self.first:
            sys.stdout.write(f"%{_str_plot_fields(data, 'field', self.field_filter)}\n")
            self.first = False
        text = self.str_fn(
            data,
            time_offset=rospy.get_rostime() if self.offset_time else None,
            current_time=current_time,
            field_filter=self.field_filter,
            type_information=type_information,
            fixed_numeric_width=self.fixed_numeric_width,
            value_transform=self.value_transform,
        )
        sys.stdout.write(f"{self.prefix}{text}{self.suffix}\n")
        sys.stdout.flush()
        self.done = self.max_count is not None and self.count >= self.max_count


def create_field_filter(echo_nostr: bool, echo_noarr: bool) -> Filter:
    """Return a function that selects the fields of a message to print.

    Args:
        echo_nostr: leave texts out.
        echo_noarr: leave arrays out.
    """

    def field_filter(val: Any) -> Iterable[str]:
        for name, kind in zip(val.__slots__, val._slot_types, strict=True):
            if not (echo_noarr and "[" in kind) and not (echo_nostr and "string" in kind):
                yield name

    return field_filter


def create_value_transform(echo_nostr: bool, echo_noarr: bool) -> Callable[..., Any]:
    """Return a function that replaces texts or arrays of a message by their type and length.

    Args:
        echo_nostr: replace texts.
        echo_noarr: replace arrays.
    """

    def replaced(value: Any, kind: str) -> Any:
        if echo_noarr and "[" in kind:
            return f"<array type: {kind.rstrip('[]')}, length: {len(value)}>"
        if echo_nostr and kind in ("string", "string[]"):
            what = "array type: string, " if kind == "string[]" else "string "
            return f"<{what}length: {len(value)}>"
        return value

    def value_transform(val: Any, type_information: str | None = None) -> Any:
        if not isinstance(val, genpy.Message):
            return val if type_information is None else replaced(val, type_information)
        fields = list(zip(val.__slots__, val._slot_types, strict=True))
        values = [replaced(getattr(val, name), kind) for name, kind in fields]
        changed = [value is not getattr(val, name) for value, (name, _) in zip(values, fields, strict=True)]
        kinds = ["string" if new else kind for new, (_, kind) in zip(changed, fields, strict=True)]
        shown = type("TransformedMessage", (genpy.Message,), {"__slots__": val.__slots__[:], "_slot_types": kinds})()
        for (name, _), value in zip(fields, values, strict=True):
            setattr(shown, name, value_transform(value) if isinstance(value, genpy.Message) else value)
        return shown

    return value_transform
