"""Bytes that were flipped, cut, doubled or lost: one clear message or a sound recording."""

import pytest

from damage import read_damaged, read_or_refuse
from recordings import FORMATS, Swim, campaign_content, write_campaign, write_run
from rovsim.measurement.recording.readers import mocap_readers


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # numbers near the largest overflow
@pytest.mark.parametrize("name", sorted(mocap_readers()))
def test_a_damaged_file_is_read_or_refused(tmp_path, name):
    folder = write_run(tmp_path, name, Swim.ned(frames=60))
    content = campaign_content(name)
    content["runs"][0]["commands"] = "none"  # times that are off would end every other check
    write_campaign(folder, content)
    target = folder / FORMATS[name]
    files = sorted(target.iterdir()) if target.is_dir() else [target]
    read_damaged(folder, files, seed=name)


@pytest.mark.parametrize("name", sorted(mocap_readers()))
@pytest.mark.parametrize("left", [0.0, 0.02, 0.5])
def test_a_cut_file_is_read_or_refused(tmp_path, name, left):
    folder = write_run(tmp_path, name, Swim.ned(frames=60))
    target = folder / FORMATS[name]
    files = sorted(target.iterdir()) if target.is_dir() else [target]
    for file in files:
        raw = file.read_bytes()
        file.write_bytes(raw[: int(left * len(raw))])
    assert not (read_or_refuse(folder) and left == 0.0)
