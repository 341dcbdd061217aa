"""The tree of frames, and the path through it from one frame to another (the walks of tf2::BufferCore).

Imports tf2_py only.
"""

from __future__ import annotations

from tf2_py._cache import StaticCache, TimeCache
from tf2_py._exceptions import ConnectivityException, ExtrapolationException, LookupException
from tf2_py._rotation import Rigid, Sample, compose, inverse

Cache = TimeCache | StaticCache
MAX_DEPTH = 1000  # a path as long as this means a loop
NO_FRAME = "NO_PARENT"  # tf2's name of what is no frame


class Path:
    """The path from a source frame up to a common ancestor and down to the target frame.

    `up` and `down` are the samples from source and target to the frame where they meet. `time` is the requested time,
    or the latest common one, in ns.
    """

    __slots__ = ("down", "time", "up")

    def __init__(self, time: int, up: list[Sample], down: list[Sample]) -> None:
        self.time = time
        self.up = up
        self.down = down


class Tree:
    """Frames by name, in the order of their first appearance. A frame without a parent has no cache."""

    __slots__ = ("caches",)

    def __init__(self) -> None:
        self.caches: dict[str, Cache | None] = {}

    def path(self, target: str, source: str, time: int) -> Path:
        """Return the path between two known frames.

        Args:
            target: its end.
            source: its beginning.
            time: in ns; 0 for the latest time that all frames on the path have in common.

        Raises:
            ConnectivityException: there is no path.
            ExtrapolationException: a frame on the path has no sample at that time.
            LookupException: the tree has a loop.
        """
        if source == target:
            return Path(time, [], [])
        if not time:
            time = self.latest_common_time(target, source)
        up: list[Sample] = []
        top, lost = self._climb(source, target, target, time, up)
        if top == target:
            return Path(time, up, [])
        down: list[Sample] = []
        frame, complaint = self._climb(target, source, top, time, down)
        if frame == source:
            return Path(time, [], down)
        if frame != top:
            complaint = lost if complaint is None else complaint
            if complaint is None:
                raise ConnectivityException(_no_connection(target, source))
            looking = f"when looking up transform from frame [{source}] to frame [{target}]"
            raise ExtrapolationException(f"{complaint}, {looking}")
        return Path(time, up, down)

    def transform(self, target: str, source: str, time: int) -> tuple[int, Rigid]:
        """Return the time of the path between two different frames, and the transform along it.

        Args and errors: as of `path`.
        """
        path = self.path(target, source, time)
        if not path.down:
            return path.time, compose(path.up)
        back = inverse(compose(path.down))
        if not path.up:
            return path.time, back
        return path.time, compose((("", *compose(path.up)), ("", *back)))

    def _climb(self, frame: str, wanted: str, top: str, time: int, samples: list[Sample]) -> tuple[str, str | None]:
        """Walk towards the root, collecting samples, until `wanted`, `top` or the end.

        Returns:
            the frame where it ended, and the error if that one has no sample at the time.
        """
        caches = self.caches
        while frame != wanted and frame != top:
            cache = caches.get(frame)  # none for NO_FRAME, too
            if cache is None:
                break
            sample = cache.sample(time)
            if sample is None:
                return frame, cache.complaint(time)
            samples.append(sample)
            frame = sample[0]
            if len(samples) > MAX_DEPTH:
                raise LookupException(self.loop_text())
        return frame, None

    def latest_common_time(self, target: str, source: str) -> int:
        """Return the latest time at which the path between two known frames is covered, in ns; 0 for any time.

        Raises:
            ConnectivityException: there is no path.
            LookupException: the tree has a loop.
        """
        if source == target:
            cache = self.caches[source]
            return 0 if cache is None else cache.latest()[0]
        up = self._latest_upwards(source, target)
        if up and up[-1][1] == target:
            return _earliest(up)
        down = self._latest_upwards(target, source)
        if down and down[-1][1] == source:
            return _earliest(down)
        above_source = [parent for _, parent in up]
        for at, (_, parent) in enumerate(down):
            if parent in above_source:
                return _earliest(down[: at + 1] + up[: above_source.index(parent) + 1])
        raise ConnectivityException(_no_connection(target, source))

    def _latest_upwards(self, frame: str, wanted: str) -> list[tuple[int, str]]:
        """Return the newest stamps and parents from a frame up to the root, or to `wanted` if that is met before."""
        found: list[tuple[int, str]] = []
        while frame != wanted:
            cache = self.caches[frame]
            latest = (0, "") if cache is None else cache.latest()
            frame = latest[1]
            if not frame:
                break
            found.append(latest)
            if len(found) > MAX_DEPTH:
                raise LookupException(self.loop_text())
        return found

    def chain(self, target: str, source: str, time: int) -> list[str]:
        """Return the frames on the way from source to target; none if they are equal.

        Raises:
            ConnectivityException: there is no path, or one frame is unknown.
            ExtrapolationException: a frame on the path, or above the known frame, has no sample at that time.
            LookupException: the tree has a loop, or one frame is unknown and the time is 0.
        """
        target, source = (name if name in self.caches else NO_FRAME for name in (target, source))
        if target == source:
            return []
        if NO_FRAME in (target, source) and not time:
            raise LookupException("")  # tf2 gives no reason
        path = self.path(target, source, time)
        up = [source, *(sample[0] for sample in path.up)]
        down = [target, *(sample[0] for sample in path.down)]
        whole = up[:]
        while len(up) > 1 and len(down) > 1 and up[-2] == down[-2]:
            del up[-1], down[-1]  # they met before
        # As in tf2, which does not shorten the way up of a frame directly below the one where they meet.
        return (whole if len(up) == 2 else up) + down[-2::-1]

    def loop_text(self) -> str:
        """Return the text of the error about a loop."""
        return f"The tf tree is invalid because it contains a loop.\n{self.as_string()}\n"

    def as_string(self) -> str:
        """Return a line for each frame that was given a parent."""
        named = ((name, cache.latest()[1] or NO_FRAME) for name, cache in self.caches.items() if cache is not None)
        return "".join(f"Frame {name} exists with parent {parent}.\n" for name, parent in named)


def _earliest(latest: list[tuple[int, str]]) -> int:
    """Return the earliest of the newest stamps, ignoring static ones, or 0 if all are static."""
    return min((stamp for stamp, _ in latest if stamp), default=0)


def _no_connection(target: str, source: str) -> str:
    return (
        f"Could not find a connection between '{target}' and '{source}' because they are not part of the same tree."
        "Tf has two or more unconnected trees."
    )
