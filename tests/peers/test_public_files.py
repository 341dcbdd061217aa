"""As many tests of every public test file pass as on ROS."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from dev.corpus.sources import Sources
from dev.peers.__main__ import ENVIRONMENT
from dev.peers.flight import run
from dev.peers.peers import read_peers


@pytest.mark.corpus
def test_public_file(peer_name: str) -> None:
    verdict = run(read_peers().files[peer_name], Sources(Path(os.environ[ENVIRONMENT])))
    assert verdict.good, verdict.reason or "\n".join(f"{name}: {said}" for name, said in verdict.failing.items())
