"""`MissionSpec`: what a mission is made of, whether it was read from files or made in memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from cfepy.config.versions import DEFAULT_RELEASE, RELEASES
from cfepy.es import StartupEntry
from cfepy.es import entries as read_entries
from cfepy.interpreter.cached import CachedProperty
from cfepy.mission.cpp_nodes import CppNodesConfig
from cfepy.mission.limits import MissionLimits
from cfepy.mission.loader import NODE_SYMBOL
from cfepy.mission.sweep_section import SweepConfig
from cfepy.nodes import CppNode, NodeConfig, RosConfig
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import STARTUP_BYTES
from cfepy.reading.marked_yaml import Marked


@dataclass(frozen=True, slots=True)
class CompiledConfig:
    """How compiled applications were built, and how they are flown.

    Attributes:
        omit_deprecated: with OMIT_DEPRECATED, which makes CFE_TBL_Handle_t an id instead of an int16.
        guard: give them memory that nothing can be written past, and that is not zero, to find mistakes.
    """

    omit_deprecated: bool = False
    guard: bool = False


class BuiltProgram(NamedTuple):
    """A node in C++ that was built for a mission.

    Attributes:
        name: full name of the node.
        file: the shared object.
        entry: its entry point.
        node: what a launch file says of it.
    """

    name: str
    file: Path
    entry: str
    node: CppNode

    @property
    def config(self) -> NodeConfig:
        """What is to become of it when it ends."""
        return NodeConfig(
            self.node.app,
            name=self.name.lstrip("/"),
            respawn=self.node.respawn,
            respawn_delay_ns=self.node.respawn_delay_ns,
            required=self.node.required,
        )


@dataclass(frozen=True)
class MissionSpec:
    """What a mission is made of.

    Attributes:
        name: of the mission.
        folder: shows as /cf in it.
        script: the startup script.
        mission_file: None when there is none.
        board: what it is made for: a shipped board's name or a path.
        cfe_version: the release of cFE that it flies on.
        compiled: how its compiled applications were built.
        ros: its ROS nodes, topics and parameters.
        limits: what it asks for of a platform.
        startup: the startup script of a mission that was made in memory; `script` then names what it was made from.
        notes: what its user should know before it runs.
        cpp_nodes: how its nodes in C++ are built.
        built: nodes in C++ that were built for it, by cFE name.
        demands: sections of the mission file that say what must hold of a run, as they stand there;
            `cfepy.monitors.run_rules` reads them.
        sweep: what a rate means in it, for `cfepy sweep`.
        ids: what the run gives it of `cfepy.config.platform.IDENTITIES`, in place of its own.
        beside: the missions that fly beside it: what their applications declare can be seen in this one, too.
    """

    name: str
    folder: Path
    script: Path
    mission_file: Path | None = None
    board: str = "linux"
    ros: RosConfig = field(default_factory=RosConfig)
    limits: MissionLimits = field(default_factory=MissionLimits)
    cfe_version: str = DEFAULT_RELEASE
    compiled: CompiledConfig = field(default_factory=CompiledConfig)
    cpp_nodes: CppNodesConfig = field(default_factory=CppNodesConfig)
    startup: bytes | None = None
    notes: tuple[str, ...] = ()
    built: Mapping[str, BuiltProgram] = field(default_factory=dict)
    demands: Mapping[str, Marked] = field(default_factory=dict)
    sweep: SweepConfig = field(default_factory=SweepConfig)
    ids: Mapping[str, int] = field(default_factory=dict)
    beside: tuple[MissionSpec, ...] = ()

    @property
    def startup_script(self) -> bytes:
        """The startup script's contents: its own, or those of the file `script`."""
        return read_limited(self.script, STARTUP_BYTES) if self.startup is None else self.startup

    @CachedProperty
    def entries(self) -> tuple[StartupEntry, ...]:
        """What the startup script starts, in order; read once."""
        return tuple(read_entries(self.startup_script, RELEASES[self.cfe_version].longest_entry))

    @property
    def scripts(self) -> dict[str, Path]:
        """Scripts of nodes that are not in its folder, by the virtual paths that the startup script has."""
        return {f"/cf/{app}.so": node.script for app, node in self.ros.nodes.items() if node.script is not None}

    @property
    def built_files(self) -> dict[str, Path]:
        """The shared objects of its nodes in C++, by the virtual paths that their lines name."""
        return {f"/cf/{app}.so": each.file for app, each in self.built.items()}

    @property
    def has_nodes(self) -> bool:
        """Whether its startup script starts a ROS node."""
        return bool(self.built) or any(entry.symbol == NODE_SYMBOL for entry in self.entries)
