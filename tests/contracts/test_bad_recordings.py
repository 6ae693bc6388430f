"""Every bad recording gets one message that names the file, the place in it and the remedy."""

import pytest

from recordings import (
    campaign_content,
    csv_lines,
    qtm_lines,
    write_campaign,
    write_lines,
    write_run,
)
from rovsim.apps.cli.main import main
from rovsim.core.errors import BadInput
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.quality.usability import usable_reason
from rovsim.measurement.recording import read_run

COLUMNS = 8  # index of the column line in the QTM files written here


def cell(line, column, text, separator="\t"):
    """Write `text` into one cell."""

    def edit(lines):
        cells = lines[line].split(separator)
        cells[column] = text
        return [*lines[:line], separator.join(cells), *lines[line + 1 :]]

    return edit


def replaced(old, new):
    return lambda lines: [line.replace(old, new) for line in lines]


def unseen(lines):
    return [
        line if k <= COLUMNS else "\t".join([*line.split("\t")[:2], *["0"] * 16])
        for k, line in enumerate(lines)
    ]


# format -> file -> case -> (edit, words of the message: place, finding, remedy)
QTM = {
    "empty": (lambda lines: [], ["the file is empty", "Export"]),
    "header only": (lambda lines: lines[: COLUMNS + 1], ["no frames", "Export the run again"]),
    "no column line": (
        lambda lines: lines[:COLUMNS] + lines[COLUMNS + 1 :],
        ["no line of column names", "column header included"],
    ),
    "wrong body": (
        replaced("BlueROV2", "BlueROV"),
        ["line 9", "no rigid body 'BlueROV2'", "'BlueROV'"],
    ),
    "missing column": (replaced("Rot[4]", "Extra"), ["line 9", "no column Rot[4]", "BlueROV2"]),
    "no X": (replaced("BlueROV2 X", "BlueROV2"), ["line 9", "no column X", "6D"]),
    "missing rotation": (replaced("Rot[", "Q["), ["no line of column names", "Rot[0]", "6D"]),
    "3D export": (
        replaced("DATA_INCLUDED\t6D", "DATA_INCLUDED\t3D"),
        ["DATA_INCLUDED", "3D data", "data type 6D"],
    ),
    "decimal comma": (
        cell(20, 2, "4737,035"),
        ["line 21", "'BlueROV2 X'", "decimal comma", "Export again"],
    ),
    "word": (cell(20, 3, "far"), ["line 21", "column 'Y'", "'far'", "Correct or remove"]),
    "NaN time": (cell(20, 1, "nan"), ["line 21", "column 'Time'", "'nan'", "Correct or remove"]),
    "word as time": (cell(20, 1, "soon"), ["line 21", "column 'Time'", "'soon'", "Correct"]),
    "empty time": (cell(20, 1, ""), ["line 21", "column 'Time'", "cell is empty", "Correct"]),
    "cut in the middle": (
        lambda lines: [*lines[:20], lines[20][:40], *lines[21:]],
        ["line 21", "stops before", "Export the run again"],
    ),
    "one time": (lambda lines: [*lines[:10], lines[9]], ["no frames", "Export the run again"]),
    "frequency": (replaced("FREQUENCY\t100", "FREQUENCY\tfast"), ["'fast'", "Correct"]),
}
CSV = {
    "empty": (lambda lines: [], ["the file is empty", "Export"]),
    "header only": (lambda lines: lines[:1], ["no frames", "Export the run again"]),
    "no time": (
        replaced("time_s", "stamp"),
        ["column names: no column 'time_s'", "Did you mean 'stamp'?", "name it time_s"],
    ),
    "time of pandas": (replaced("time_s", "Unnamed: 0"), ["Did you mean 'Unnamed: 0'?"]),
    "time with a unit": (replaced("time_s", "t [s]"), ["Did you mean 't [s]'?", "name it time_s"]),
    "time without a name": (replaced("time_s", ""), ["Did you mean one without a name (the 1.)?"]),
    "nothing like a time": (replaced("time_s", "when"), ["'when'", "of the times the name time_s"]),
    "no channel": (
        lambda lines: ["time_s,t1", "0,1500"],
        ["no column of a measured channel", "t1", "Name the columns"],
    ),
    "some of a quaternion": (
        replaced("roll_rad,pitch_rad,yaw_rad", "qw,qx,qy"),
        ["no column 'qz'", "qw"],
    ),
    "no unit quaternion": (
        lambda lines: [
            "time_s,x_m,y_m,z_m,qw,qx,qy,qz",
            "0,1,1,1,0,0,0,0",
            "0.1,1,1,1,1.3,0,0,0",
            "0.2,1,1,1,1.3,0,0,0",
        ],
        ["line 3, columns qw, qx, qy, qz", "length 1.3 (2 of 2 have not length 1)", "divide"],
    ),
    "nothing measured": (lambda lines: [lines[0], "0,,,,,,", "1,,,,,,"], ["no frames", "'runs'"]),
    "twice": (replaced("y_m", "x_m"), ["two columns are named 'x_m'", "Rename"]),
    "word": (cell(7, 2, "far", ","), ["line 8", "column 'y_m'", "'far'", "Correct"]),
    "NaN time": (cell(7, 0, "nan", ","), ["line 8", "column 'time_s'", "'nan'", "Correct"]),
    "infinite time": (cell(7, 0, "inf", ","), ["line 8", "column 'time_s'", "'inf'", "Correct"]),
}
MOTIVE = {
    "empty": (lambda lines: [], ["the file is empty", "Export Tracking Data"]),
    "no header": (lambda lines: lines[2:], ["line 1", "Format Version", "header information"]),
    "header only": (lambda lines: lines[:8], ["no frames", "Export the run again"]),
    "no columns": (lambda lines: lines[:3], ["no columns of a rigid body", "version 1.23"]),
    "only markers": (replaced("Rigid Body", "Marker"), ["no columns of a rigid body"]),
    "an old version": (
        lambda lines: ["Format Version,1.1,Take Name,x", "", "frameindex,1"],
        ["no columns of a rigid body (format version 1.1)"],
    ),
    "no unit quaternion": (
        lambda lines: [
            *lines[:8],
            *(",".join([*line.split(",")[:2], "0,0,1.3,0", "1,1,1,0"]) for line in lines[8:]),
        ],
        ["line 9", "a quaternion of length 1.3", "divide"],
    ),
    "local": (replaced("Global", "Local"), ["line 1", "'Local'", "Global"]),
    "wrong body": (replaced("BlueROV2", "BlueROV"), ["no rigid body 'BlueROV2'", "'BlueROV'"]),
    "inches": (replaced("Millimeters", "Inches"), ["'Inches'", "millimeters"]),
    "another order": (replaced("Quaternion", "XYZ"), ["'XYZ' with 4 columns", "Euler angles"]),
    "no time": (replaced("Time (Seconds)", "Clock"), ["line 8", "no column 'Time (Seconds)'"]),
    "word": (cell(20, 3, "far", ","), ["line 21", "'far'", "Correct"]),
}
COMMANDS = {
    "empty": (lambda lines: [], ["the file is empty", "Export"]),
    "header only": (lambda lines: lines[:1], ["no commands", "Export the commands again"]),
    "missing column": (replaced("t2", "m2"), ["no column 't2'", "Did you mean 'm2'"]),
    "word": (cell(7, 2, "stop", ","), ["line 8", "column 't2'", "'stop'", "Correct"]),
    "NaN time": (cell(7, 0, "nan", ","), ["line 8", "column 'time_s'", "'nan'", "Correct"]),
    "no time": (cell(0, 0, "stamp", ","), ["no column 'time_s'", "Did you mean 'stamp'?"]),
    "out of range": (
        cell(7, 1, "0.3", ","),
        ["line 8", "column 't1'", "0.3", "pwm", "commands.kind"],
    ),
    "percent": (
        lambda lines: [lines[0], "0,-30,0", "1,100,0"],
        ["line 2", "(-30 to 100) they may be percent", "divide them by 100"],
    ),
    "pulses less 1500": (
        lambda lines: [lines[0], "0,-300,0", "1,220,0"],
        ["line 2", "(-300 to 220)", "pulses less 1500 us: add 1500"],
    ),
    "revolutions": (
        lambda lines: [lines[0], "0,-900,0", "1,950,0"],
        ["(-900 to 950) they may be revolutions per minute", "convert"],
    ),
    "infinite": (cell(7, 1, "inf", ","), ["line 8", "column 't1'", "inf", "commands.kind"]),
    "other clock": (
        lambda lines: [lines[0], "1000.0,1500,1500", "1001.0,1500,1500"],
        ["1000 to 1001 s", "clock of the motion capture", "commands_shift_s"],
    ),
    "all empty": (
        lambda lines: [lines[0], "0,,", "1,,"],
        ["no commands (2 lines without a value)", "Export the commands again"],
    ),
}
CASES = [("qtm_tsv", "poses.tsv", case, *QTM[case]) for case in QTM]
CASES += [("csv", "poses.csv", case, *CSV[case]) for case in CSV]
CASES += [("motive_csv", "take.csv", case, *MOTIVE[case]) for case in MOTIVE]
CASES += [("csv", "commands.csv", case, *COMMANDS[case]) for case in COMMANDS]


@pytest.mark.parametrize(
    ("name", "file", "edit", "words"),
    [(name, file, edit, words) for name, file, _, edit, words in CASES],
    ids=[f"{file}-{case}" for _, file, case, _, _ in CASES],
)
def test_a_bad_recording_is_refused_in_words(tmp_path, name, file, edit, words):
    folder = write_run(tmp_path, name)
    lines = (folder / file).read_text().splitlines()
    write_lines(folder / file, edit(lines))
    campaign = load_campaign(folder)
    with pytest.raises(BadInput) as refusal:
        read_run(campaign, "one")
    for word in [str(folder / file), *words]:
        assert word in str(refusal.value)


def test_a_run_that_never_shows_the_body_is_one_that_cannot_be_used(tmp_path):
    folder = write_run(tmp_path)
    poses = folder / "poses.tsv"
    write_lines(poses, unseen(poses.read_text().splitlines()))
    recording, _ = read_run(load_campaign(folder), "one")
    assert usable_reason(recording) == "too short: the body was seen for 0.00 s, 2 needed"


def test_init_leaves_out_a_file_that_never_shows_the_body(tmp_path, capsys):
    folder = write_run(tmp_path / "raw")
    (folder / "campaign.yaml").unlink()
    lost = folder / "lost.tsv"
    write_lines(lost, unseen((folder / "poses.tsv").read_text().splitlines()))
    main(["init", str(folder), f"out={tmp_path / 'out'}"])
    said = " ".join(capsys.readouterr().out.split())
    assert "lost.tsv is left out: no frame in which the body was found" in said
    with pytest.raises(SystemExit):
        main(["init", str(lost), f"out={tmp_path / 'lost'}"])
    assert "no frame in which the body was found" in capsys.readouterr().err.replace("\n", " ")


def test_a_single_command_holds_however_early_it_was_logged(tmp_path):
    folder = write_run(tmp_path)
    log = folder / "commands.csv"
    names, *lines = log.read_text().splitlines()
    columns = lines[0].split(",")[1:]
    write_lines(log, [names, ",".join(["-5", *columns])])
    recording, _ = read_run(load_campaign(folder), "one")
    assert recording.commands.time.tolist() == [-5.0]


@pytest.mark.parametrize(
    ("section", "name", "words"),
    [
        ("mocap", "qtm_tvs", ["mocap.format", "not known", "Did you mean 'qtm_tsv'"]),
        ("commands", "rosbag", ["commands.format", "not known", "Did you mean 'rosbag2'"]),
    ],
)
def test_a_format_without_reader_is_refused_in_words(tmp_path, section, name, words):
    folder = write_run(tmp_path)
    content = campaign_content()
    content[section]["format"] = name
    campaign = load_campaign(write_campaign(folder, content))
    with pytest.raises(BadInput) as refusal:
        read_run(campaign, "one")
    for word in [str(folder / "campaign.yaml"), *words]:
        assert word in str(refusal.value)


def test_the_builders_write_good_files(tmp_path):
    # otherwise every refusal above could have another cause
    for name in ("qtm_tsv", "csv"):
        recording, _ = read_run(load_campaign(write_run(tmp_path / name, name)), "one")
        assert recording.tracked.all()


def test_the_column_line_is_where_the_cases_say():
    from recordings import Swim

    assert "Rot[0]" in qtm_lines(Swim.ned(2))[COLUMNS]
    assert csv_lines(Swim.ned(2))[0].startswith("time_s")
