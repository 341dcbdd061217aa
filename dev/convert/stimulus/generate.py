"""Generate messages from definitions with ROS's gencpp and genpy. Debian's Python runs it. Usage: generate.py JOB.json.

The job has `include` (by package, the folders with its definitions), `cpp` and `python` (the packages to generate), and
the folders `to_cpp` and `to_python`.
"""

import json
import os
import sys
from glob import glob

import genmsg.template_tools
import genpy.generate_initpy
import genpy.generator

TEMPLATES = "/usr/share/gencpp"
HEADERS = ({"msg.h.template": "@NAME@.h"}, {"srv.h.template": "@NAME@.h"})


def files(folders, ending):
    return sorted(file for folder in folders for file in glob(os.path.join(folder, "*." + ending)))


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        job = json.load(file)
    include = job["include"]
    named = [f"{package}:{folder}" for package, folders in include.items() for folder in folders]
    for package in job["cpp"]:
        to = os.path.join(job["to_cpp"], package)
        for file in files(include[package], "msg") + files(include[package], "srv"):
            genmsg.template_tools.generate_from_file(file, package, to, TEMPLATES, named, *HEADERS)
    for package in job["python"]:
        for ending, generator in (("msg", genpy.generator.MsgGenerator()), ("srv", genpy.generator.SrvGenerator())):
            found = files(include[package], ending)
            if found:
                to = os.path.join(job["to_python"], package, ending)
                os.makedirs(to, exist_ok=True)
                open(os.path.join(job["to_python"], package, "__init__.py"), "w", encoding="utf-8").close()
                if generator.generate_messages(package, found, to, include):
                    sys.exit("genpy failed for " + package)
                genpy.generate_initpy.write_modules(to)


if __name__ == "__main__":
    main()
