"""Damaged files: bytes flipped, cut, doubled or lost, and what reading them may end in."""

import os
import time
import zlib
from pathlib import Path
from typing import Sequence

import numpy as np

from rovsim.core.errors import BadInput
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.quality.assessment import report_quality
from rovsim.measurement.recording import read_run
from rovsim.measurement.signals.chain import SignalSettings

COUNT = int(os.environ.get("ROVSIM_MUTATIONS", "60"))  # files of each format
LONGEST = 10.0  # s of the processor
WORDS = [b"nan", b"1e400", b"-", b",,", b"\n", b"\t", b"\xff"]
# what may happen to `n` bytes at `a` of a file
FAULTS = (
    lambda d, a, n, r: d[:a] + bytes([d[a] ^ 1 << int(r.integers(8))]) + d[a + 1 :],
    lambda d, a, n, r: d[:a] + r.bytes(1) + d[a + 1 :],
    lambda d, a, n, r: d[:a] + d[a + n :],
    lambda d, a, n, r: d[: a + n] + d[a:],
    lambda d, a, n, r: d[:a] + bytes(n) + d[a + n :],
    lambda d, a, n, r: d[:a] + r.bytes(n) + d[a + n :],
    lambda d, a, n, r: d[:a] + WORDS[int(r.integers(len(WORDS)))] + d[a + 1 :],
    lambda d, a, n, r: d[:a] if r.random() < 0.2 else d,
)


def damaged(raw: bytes, random: np.random.Generator) -> bytes:
    """The bytes with one to eight faults in them."""
    for _ in range(random.integers(1, 9)):
        at, length = int(random.integers(max(len(raw), 1))), int(random.integers(1, 64))
        if raw:
            raw = FAULTS[int(random.integers(len(FAULTS)))](raw, at, length, random)
    return raw


def check_sound(recording) -> None:
    assert np.isfinite(recording.time).all()
    assert (np.diff(recording.time) > 0).all()
    assert np.isfinite(recording.position[recording.tracked]).all()
    turns = np.linalg.norm(recording.attitude[recording.tracked], axis=1)
    np.testing.assert_allclose(turns, 1.0, atol=1e-6)
    for channel in recording.channels.values():
        assert np.isfinite(channel.time).all()
        assert (np.diff(channel.time) > 0).all()
        assert not np.isinf(channel.value).any()
    assert np.isfinite(recording.commands.value).all()


def read_or_refuse(folder: Path) -> bool:
    """Whether the damaged run could be read; anything but that or one message fails."""
    start = time.process_time()
    try:
        recording, anomalies = read_run(load_campaign(folder), "one")
        report_quality(recording, anomalies, SignalSettings().outliers)
    except BadInput as refusal:
        said = str(refusal)
    else:
        said = ""
        check_sound(recording)
    assert time.process_time() - start < LONGEST
    assert "\n" not in said
    assert len(said) < 5000
    return not said


def read_damaged(folder: Path, files: Sequence[Path], seed: str) -> None:
    """Read the run of a campaign with `COUNT` damaged versions of these files, one at a time."""
    good = {file: file.read_bytes() for file in files}
    assert read_or_refuse(folder)
    random = np.random.default_rng(zlib.crc32(seed.encode()))
    read = 0
    for _ in range(COUNT):
        file = files[int(random.integers(len(files)))]
        file.write_bytes(damaged(good[file], random))
        read += read_or_refuse(folder)
        file.write_bytes(good[file])
    assert read  # a scratch must not cost the whole recording
