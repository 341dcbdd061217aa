"""A conversion: the nodes in C++ of a launch file or of a package, each with its names, MsgIds and entry point."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from cfepy.extra.convert.build import library_includes, provided_packages
from cfepy.extra.convert.configurations import CONFIGURATION_TYPES, configuration_headers
from cfepy.extra.convert.cpp_package import CppPackage, Program
from cfepy.extra.convert.cpp_sources import SourceSet, collect, main_form, message_types
from cfepy.extra.convert.entry import NodeEntry, parameter_rows
from cfepy.extra.convert.packages import MANIFEST, program_of, read_package
from cfepy.extra.convert.source_names import NodeNames, SourceNames, names_of, texts_below
from cfepy.mission import GROUND_SERVICE, NodeGround, launch_file
from cfepy.nodes import ROSCORE_PARAMS, CppNode, RosConfig
from cfepy.status import UsageError
from rospy_shim.graph.msg_ids import MsgIds, locked
from rospy_shim.roslaunch.launch_plan import app_name, packages_near, plan_of
from rospy_shim.types.msgs import Library, OnDisk, Packages, shipped
from rospy_shim.types.msgs.packages import name_of


@dataclass(slots=True)
class ConversionTask:
    """The input of a conversion.

    Attributes:
        title: its title, such as the launch file's name.
        made_from: the launch file, or the package's folder.
        nodes: the nodes in C++.
        params: the tree of parameters.
        scripts: full names of the nodes in Python, which stay as they are.
        notes: notes of the reader of the launch file.
        launch: the launch file with its arguments; None for a package.
    """

    title: str
    made_from: Path
    nodes: list[CppNode]
    params: Mapping[str, Any]
    scripts: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    launch: tuple[Path, Mapping[str, str]] | None = None


@dataclass(slots=True)
class ConvertedNode:
    """A node with all its generated parts.

    Attributes:
        node: its entry in the launch file or the package.
        program: its sources and build settings.
        sources: all its files.
        headers: all headers that it includes, also the interface library's.
        types: message types whose headers it includes.
        configurations: texts of the headers of configurations that it includes.
        names: its topics and services.
        entry: its entry point.
    """

    node: CppNode
    program: Program
    sources: SourceSet
    headers: list[Path]
    types: list[str]
    names: NodeNames
    entry: NodeEntry
    configurations: dict[str, str] = field(default_factory=dict)

    @property
    def file(self) -> str:
        """The name of its shared object and of its target."""
        return self.node.app.lower()


@dataclass(slots=True)
class Conversion:
    """The result of a task.

    Attributes:
        task: the task.
        nodes: the converted nodes.
        refused: the reasons why other nodes were not converted, by full name.
        ids: with the MsgIds of all names.
        library: of message types.
    """

    task: ConversionTask
    nodes: list[ConvertedNode]
    refused: dict[str, str]
    ids: RosConfig
    library: Library


def task_of(words: Sequence[str], environ: Mapping[str, str]) -> ConversionTask:
    """Return the task of a command line: a launch file with its arguments, a package's folder or its name.

    Args:
        words: of the command line.
        environ: for ROS_PACKAGE_PATH.

    Raises:
        UsageError: there is none, or it has no node in C++.
    """
    folder = Path(words[0])
    if len(words) == 1 and os.path.isfile(folder / MANIFEST):
        task = _of_package(folder.resolve(), environ)
    elif len(words) == 1 and not os.path.isfile(folder) and (found := _folder_of(words[0], environ)) is not None:
        task = _of_package(found, environ)
    else:
        task = _of_launch(*launch_file(words), environ)
    if not task.nodes:
        why = "; ".join(task.notes) or "no node has C++ sources on this computer"
        raise UsageError(f"has no node that can be converted: {why}", file=task.made_from)
    return task


def _folder_of(package: str, environ: Mapping[str, str]) -> Path | None:
    folders = packages_near(Path.cwd() / package, environ, package).folders(package)
    return next((each for each in folders if os.path.isfile(each / MANIFEST)), None)


def _of_package(folder: Path, environ: Mapping[str, str]) -> ConversionTask:
    name = name_of(folder)
    package = read_package(folder, name)
    types = [*package.executables(), *package.nodelets()]
    apps = _app_names(types)
    nodes = [CppNode(apps[each], name, each, (folder,), folder / MANIFEST, env=dict(environ)) for each in types]
    return ConversionTask(name, folder, nodes, dict(ROSCORE_PARAMS))


def _app_names(names: Iterable[str]) -> dict[str, str]:
    """Return an application's name for each program."""
    found: dict[str, str] = {}
    for name in names:
        found[name] = app_name(name.rpartition("/")[2], found.values())
    return found


def _of_launch(file: Path, args: Mapping[str, str], environ: Mapping[str, str]) -> ConversionTask:
    plan = plan_of(file, args, environ, cwd=Path.cwd(), with_compiled=True)
    scripts = [f"/{node.name}" for node in plan.nodes.values()]
    return ConversionTask(
        file.name, file, list(plan.compiled.values()), plan.params, scripts, plan.notes, (file, dict(args))
    )


def converted(
    task: ConversionTask,
    config: RosConfig,
    judge: Callable[[Program], str] = lambda program: "",
    ground: Mapping[str, NodeGround] | None = None,
    adjust: Callable[[CppPackage], None] = lambda package: None,
) -> Conversion:
    """Convert the nodes of a task.

    Args:
        task: the task.
        config: MsgIds of a mission and its lock file.
        judge: returns why a program is not converted; an empty text if it is.
        ground: MsgIds and marks of nodes for the ground, by full name. Others get a free MsgId for their housekeeping.
        adjust: called with each package that was read, whose targets it may change.

    Raises:
        UsageError: two names have one MsgId, or there are no more.
    """
    packages = Packages(task.nodes[0].near, {**os.environ, **task.nodes[0].env})
    library = Library([OnDisk(packages)], base=shipped())
    found: list[ConvertedNode] = []
    refused: dict[str, str] = {}
    everyone = [*task.scripts, *(each.full_name for each in task.nodes)]
    for node in task.nodes:
        try:
            others = [each for each in everyone if each != node.full_name]
            made = _node(node, task, packages, library, others, adjust)
        except UsageError as error:
            refused[node.full_name] = str(error)
            continue
        if why := judge(made.program):
            refused[node.full_name] = why
        else:
            found.append(made)
    pinned = ground or {}
    labels = {each.node.full_name: f"{each.node.full_name}{GROUND_SERVICE}" for each in found}
    taken = {labels[name]: pinned[name].msg_id for name in labels if name in pinned}
    config = replace(config, locked_services={**config.locked_services, **taken})
    ids = _with_ids(config, found, labels.values())
    for each in found:
        each.entry = _with_names(each, ids)
        name = each.node.full_name
        marks = pinned[name].performance_id if name in pinned else None
        each.entry = replace(each.entry, ground=NodeGround(ids.locked_services[labels[name]], marks))
    return Conversion(task, found, refused, ids, library)


def _node(
    node: CppNode,
    task: ConversionTask,
    packages: Packages,
    library: Library,
    others: Sequence[str],
    adjust: Callable[[CppPackage], None],
) -> ConvertedNode:
    package = read_package(node.folders[0], node.package)
    adjust(package)
    program = program_of(package, node.type, packages, provided_packages())
    sources = collect(program.sources, program.includes)
    own = SourceNames(list(sources.texts.values()), texts_below(task.params, node.full_name))
    names = names_of(own.used(), node.namespace, node.full_name, node.remaps)
    names.open = own.open
    if task.params.get("use_sim_time") is True:
        names.topics["/clock"] = True
    seen = collect(program.sources, [*program.includes, *library_includes()])
    entry = NodeEntry(
        node.app,
        node.name,
        node.namespace,
        node.args,
        remaps=names.remaps,
        rows=parameter_rows(task.params, node.full_name, others),
        takes_arguments=bool(program.nodelet) or main_form(program.sources, package.folder),
        nodelet=program.nodelet,
    )
    configurations = configuration_headers(seen.missing, program)
    types = message_types(seen.missing, library) + list(CONFIGURATION_TYPES if configurations else ())
    return ConvertedNode(node, program, sources, list(seen.contents), types, names, entry, configurations)


def _with_ids(config: RosConfig, nodes: Iterable[ConvertedNode], more: Iterable[str]) -> RosConfig:
    """Return MsgIds for all names. Without locked MsgIds of a mission, each name gets a free one.

    Args:
        config: MsgIds of a mission and its lock file.
        nodes: nodes with topics and services.
        more: names that get MsgIds as services do.
    """
    topics: dict[str, bool] = {}
    services: dict[str, bool] = dict.fromkeys(more, True)
    for each in nodes:
        topics |= each.names.topics
        services |= each.names.services
    if config.topics or config.locked_topics or config.locked_services:
        ids = MsgIds(config)
        for name in topics:
            ids.of_topic(name)  # raises if two names have one MsgId
    of_topics, of_services = locked(config, topics, services)
    return replace(config, locked_topics=of_topics, locked_services=of_services)


def _with_names(node: ConvertedNode, ids: RosConfig) -> NodeEntry:
    topics: dict[str, tuple[int, bool]] = {}
    for name in sorted(node.names.topics):
        pinned = ids.topics.get(name)
        topics[name] = (ids.locked_topics[name], False) if pinned is None else (pinned.msg_id, pinned.raw)
    services = {name: ids.locked_services[name] for name in sorted(node.names.services)}
    return replace(node.entry, topics=topics, services=services)
