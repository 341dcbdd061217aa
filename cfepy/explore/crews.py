"""The crew that a command line asks for."""

from __future__ import annotations

from collections.abc import Callable

from cfepy.explore.campaign import Crew
from cfepy.explore.shipment import Shipment
from cfepy.explore.workers import LONGEST_S, Processes, usable_cpus
from cfepy.status import UsageError


def make_crew(
    count: int,
    jobs: int | None = None,
    cluster: str | None = None,
    shipment: Callable[[], Shipment] | None = None,
    longest_s: float = LONGEST_S,
) -> Crew:
    """Worker processes of this computer, or a cluster.

    Args:
        count: how many schedules there are at most.
        jobs: `--jobs`: processes on this computer; None for one on each CPU.
        cluster: `--cluster`: address of a dask scheduler, or local:N; None for none.
        shipment: packs the mission's files; called for a cluster only.
        longest_s: wall time in seconds that a schedule may take.

    Raises:
        UsageError: the options make no sense, or there is no such cluster.
    """
    if jobs is not None and jobs < 1:
        raise UsageError(f"{jobs} processes cannot run anything; give 1 or more", field="--jobs")
    if longest_s <= 0:
        raise UsageError(f"{longest_s:g} s are no time for a schedule; give more than 0", field="--longest")
    if cluster is None:
        return Processes(max(1, min(count, usable_cpus() if jobs is None else jobs)), longest_s)
    if jobs is not None:
        raise UsageError("says how many processes run here; with --cluster none do", field="--jobs")
    from cfepy.explore.cluster import Cluster

    return Cluster(cluster, None if shipment is None else shipment(), longest_s)
