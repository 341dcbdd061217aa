"""Run by a Python that has real ROS's genpy: makes classes of many types, and encodes and decodes values of them.

It reads one JSON object and prints one. It uses the public API of genpy and genmsg only. Making the classes of a type
writes and imports a file, so a type with several others as fields stands for them.
"""

from __future__ import annotations

import importlib
import json
import sys
from typing import Any

from genpy_messages import build, encoded  # beside this script

genmsg = importlib.import_module("genmsg")
generate_dynamic = importlib.import_module("genpy.dynamic").generate_dynamic
msg_loader = importlib.import_module("genmsg.msg_loader")
compute_md5 = importlib.import_module("genmsg.gentools").compute_md5

ALL = "everything/All"
LINE = "=" * 80


def classes_of(names: list[str], texts: dict[str, str]) -> dict[str, Any]:
    fields = "\n".join(f"{name} field{number}" for number, name in enumerate(names))
    parts = [f"\n{LINE}\nMSG: {name}\n{texts[name]}" for name in names]
    made: dict[str, Any] = generate_dynamic(ALL, fields + "".join(parts))
    return made


def service_md5sums(texts: dict[str, str], services: dict[str, str]) -> dict[str, str]:
    context = genmsg.MsgContext.create_default()
    for name, text in texts.items():
        context.register(name, msg_loader.load_msg_from_string(context, text, name))
    found = {}
    for name, text in services.items():
        found[name] = compute_md5(context, msg_loader.load_srv_from_string(context, text, name))
    return found


def answer(cls: Any, message: Any) -> dict[str, str]:
    octets = encoded(message)
    again = cls()
    again.deserialize(bytes.fromhex(octets))
    return {"hex": octets, "again": encoded(again), "text": str(message)}


def main() -> None:
    request = json.load(sys.stdin)
    answers, md5sums = {}, {}
    for names in request["groups"]:
        classes = classes_of(names, request["texts"])
        for name in names:
            values = [build(classes, name, value) for value in request["values"].get(name, ())]
            answers[name] = [answer(classes[name], value) for value in values]
            md5sums[name] = classes[name]._md5sum
    services = service_md5sums(request["texts"], request["services"])
    json.dump({"answers": answers, "md5sums": md5sums, "services": services}, sys.stdout)


main()
