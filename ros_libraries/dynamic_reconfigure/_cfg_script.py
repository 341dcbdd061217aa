"""Contents of `<package>.cfg.<Name>Config`, from the package's cfg/<Name>.cfg.

The script is run as the build of a ROS package would run it, in the node that imports the module.
"""

from __future__ import annotations

import math
from typing import Any

from .encoding import extract_params
from .parameter_generator_catkin import ParameterGenerator


def contents_of(file: str, name: str) -> dict[str, Any]:
    """Run a .cfg script and return the names of the module that ROS generates from it.

    Args:
        file: the script.
        name: of the configuration, without "Config".

    Raises:
        ImportError: the script did not generate that configuration.
    """
    with open(file, encoding="utf-8") as source:
        code = compile(source.read(), file, "exec")
    ParameterGenerator.generated.pop(name, None)
    try:
        exec(code, {"__name__": "__main__", "__file__": file})
    except SystemExit:
        pass  # scripts end with exit(gen.generate(...))
    generator = ParameterGenerator.generated.get(name)
    if generator is None:
        raise ImportError(f'{file} did not call generate(..., ..., "{name}"); the last argument is the file\'s name')
    constants = {f"{name}_{each['name']}": each["value"] for each in generator.constants}
    return {**_tables(generator.group.to_dict()), **constants}


_TABLES = (("min", "min"), ("max", "max"), ("defaults", "default"), ("level", "level"), ("type", "type"))


def _tables(description: dict[str, Any]) -> dict[str, Any]:
    params = extract_params(description)
    tables: dict[str, Any] = {table: {each["name"]: each[field] for each in params} for table, field in _TABLES}
    all_level = 0
    for each in params:
        all_level |= each["level"]
    return {"inf": math.inf, "config_description": description, **tables, "all_level": all_level}
