"""`MissionSpec`: the content of a mission, read from files or created in memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from cfepy.config.platform import REAL_TIME, PlatformConfig
from cfepy.config.versions import DEFAULT_RELEASE, RELEASES
from cfepy.es import NODE_SYMBOL, StartupEntry
from cfepy.es import entries as read_entries
from cfepy.interpreter.cached import CachedProperty
from cfepy.mission.cpp_nodes import CppNodesConfig
from cfepy.mission.limits import MissionLimits
from cfepy.nodes import CppNode, NodeConfig, RosConfig
from cfepy.psp import BoardProfile
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import STARTUP_BYTES
from cfepy.reading.marked_yaml import Marked
from cfepy.units import NS_PER_S, NS_PER_US

UNIX_AT_CFE_EPOCH = 315_532_800  # 1980-01-01 in seconds since 1970-01-01

if TYPE_CHECKING:
    from cfepy.mission.device_config import DeviceConfig
    from cfepy.mission.drawn_parameters import ParameterDistribution


@dataclass(frozen=True, slots=True)
class CompiledConfig:
    """How compiled applications were built, and how they are flown.

    Attributes:
        omit_deprecated: whether they were built with OMIT_DEPRECATED, which makes CFE_TBL_Handle_t an id instead of an
            int16.
        guard: whether they get guarded, nonzero memory, to find memory errors, and whether all applications are watched
            for resources that they do not give back.
    """

    omit_deprecated: bool = False
    guard: bool = False


@dataclass(frozen=True, slots=True)
class SweepConfig:
    """The section `sweep:`: the parameters that a sweep varies, and the topics that it measures.

    Attributes:
        rate: full names of parameters (with a slash) and names of launch arguments that a rate in Hz sets.
        topics: topics that then have this rate; empty for all topics of the mission.
        draw: distributions of parameters and launch arguments, by name, for a sweep that draws them.
    """

    rate: tuple[str, ...] = ()
    topics: tuple[str, ...] = ()
    draw: Mapping[str, ParameterDistribution] = field(default_factory=dict)


class BuiltProgram(NamedTuple):
    """A node in C++ that was built for a mission.

    Attributes:
        name: full name of the node.
        file: the shared object.
        entry: its entry point.
        node: its entry in a launch file.
    """

    name: str
    file: Path
    entry: str
    node: CppNode

    @property
    def config(self) -> NodeConfig:
        """The settings for its end."""
        return NodeConfig(
            self.node.app,
            name=self.name.lstrip("/"),
            respawn=self.node.respawn,
            respawn_delay_ns=self.node.respawn_delay_ns,
            required=self.node.required,
        )


@dataclass(frozen=True)
class MissionSpec:
    """The content of a mission.

    Attributes:
        name: name of the mission.
        folder: the folder that appears as /cf.
        script: the startup script.
        mission_file: None if there is none.
        board: its board: a shipped board's name or a path.
        memory: how its applications reach memory by address, one of `cfepy.psp.MEMORIES`; None for the board's way.
        cfe_version: its release of cFE.
        safe: whether it prevents hangs, leaks and ends of the process that NASA's Linux has.
        scheduling: how its tasks are scheduled, one of `cfepy.config.platform.SCHEDULINGS`.
        compiled: how its compiled applications were built.
        ros: its ROS nodes, topics and parameters.
        limits: its platform limits.
        startup: the startup script of a mission created in memory; `script` then names its source.
        notes: notes for the user before the run.
        cpp_nodes: how its nodes in C++ are built.
        built: the built nodes in C++, by cFE name.
        demands: the unread sections of the mission file with rules for a run; `cfepy.monitors.run_rules` reads them.
        sweep: the meaning of a rate, for `cfepy sweep`.
        ids: the identities of `cfepy.config.platform.IDENTITIES` that the run overrides.
        epoch_ns: date at which the computer is switched on, as Unix time in ns; None for the time of cFE's defaults.
        dictionary: files and folders that declare packets and tables of its applications, from its mission file.
        devices: the devices at ports and buses of its compiled applications, by name.
        beside: the missions that fly together with it; this one can see the declarations of their applications.
    """

    name: str
    folder: Path
    script: Path
    mission_file: Path | None = None
    board: str = "linux"
    ros: RosConfig = field(default_factory=RosConfig)
    limits: MissionLimits = field(default_factory=MissionLimits)
    cfe_version: str = DEFAULT_RELEASE
    safe: bool = False
    scheduling: str = REAL_TIME
    compiled: CompiledConfig = field(default_factory=CompiledConfig)
    cpp_nodes: CppNodesConfig = field(default_factory=CppNodesConfig)
    startup: bytes | None = None
    notes: tuple[str, ...] = ()
    built: Mapping[str, BuiltProgram] = field(default_factory=dict)
    demands: Mapping[str, Marked] = field(default_factory=dict)
    sweep: SweepConfig = field(default_factory=SweepConfig)
    ids: Mapping[str, int] = field(default_factory=dict)
    epoch_ns: int | None = None
    beside: tuple[MissionSpec, ...] = ()
    memory: str | None = None
    dictionary: tuple[Path, ...] = ()
    devices: Mapping[str, DeviceConfig] = field(default_factory=dict)

    @property
    def startup_script(self) -> bytes:
        """The content of the startup script: its own, or the file `script`."""
        return read_limited(self.script, STARTUP_BYTES) if self.startup is None else self.startup

    @CachedProperty
    def entries(self) -> tuple[StartupEntry, ...]:
        """The entries of the startup script, in order; read once."""
        return tuple(read_entries(self.startup_script, RELEASES[self.cfe_version].longest_entry))

    def config(self, board: BoardProfile) -> PlatformConfig:
        """Return the platform configuration on a board.

        Raises:
            UsageError: if the mission needs more than the board has.
        """
        limits = replace(
            self.limits.config(board, self.has_nodes, self.cfe_version),
            cfe_version=self.cfe_version,
            safe=self.safe,
            scheduling=self.scheduling,
            given=tuple(self.ids),
        )
        config = limits.with_limits(self.ids)
        if self.epoch_ns is None:
            return config
        from cfepy.mission.epoch import starting_at

        return starting_at(config, self.epoch_ns, UNIX_AT_CFE_EPOCH)

    def start_ns(self, config: PlatformConfig) -> int:
        """Return the Unix time when the computer is switched on, in ns: ROS time at virtual time 0.

        Args:
            config: the mission's configuration.
        """
        if self.epoch_ns is not None:
            return self.epoch_ns
        seconds = config.time_def_met_secs + config.time_def_stcf_secs
        seconds -= config.time_def_leaps if config.time_cfg_default_utc else 0
        micros = config.time_def_met_subs + config.time_def_stcf_subs
        return (UNIX_AT_CFE_EPOCH + seconds) * NS_PER_S + micros * NS_PER_US

    def zero_s(self, config: PlatformConfig) -> int:
        """Return the Unix time when spacecraft time is 0, in s.

        That is 1980-01-01. With an epoch, TAI is ahead of the UTC of ROS, so its 0 is earlier by the leap seconds.

        Args:
            config: the mission's configuration.
        """
        is_tai = self.epoch_ns is not None and not config.time_cfg_default_utc
        return UNIX_AT_CFE_EPOCH - (config.time_def_leaps if is_tai else 0)

    @property
    def scripts(self) -> dict[str, Path]:
        """The scripts of nodes outside its folder, by their virtual paths in the startup script."""
        return {f"/cf/{app}.so": node.script for app, node in self.ros.nodes.items() if node.script is not None}

    @property
    def built_files(self) -> dict[str, Path]:
        """The shared objects of its nodes in C++, by their virtual paths in the startup script."""
        return {f"/cf/{app}.so": each.file for app, each in self.built.items()}

    @property
    def has_nodes(self) -> bool:
        """Whether its startup script starts a ROS node."""
        return bool(self.built) or any(entry.symbol == NODE_SYMBOL for entry in self.entries)
