"""What the names of files say: how runs are called, and which files belong together."""

import re
from typing import Sequence

from rovsim.core.names import is_name

# Words that say what a file holds, and not which run it is of.
ROLES = (
    "6d|6dof_?export|poses?|mocap|motion|track(ing)?|qtm|qualisys|motive|optitrack|take|vicon|export|"
    "commands?|cmds?|pwms?|rc|rcout|thrusters?|thrust|servos?|inputs?|control_?inputs?|actuation|"
    "setpoints?|log|data|raw"
)
# Words that say which sensor a file is of.
SENSORS = (
    "depth|pressure|baro(meter)?|imu|gyro(scope)?|accel(erometer)?|ahrs|attitude|att|euler|angles?|"
    "orientation|heading|compass|dvl|velocity|velocities|vel|speed|usbl|gps|position|pos|nav|ekf|odom|"
    "odometry|battery|voltage|bat|sensors?"
)
ROLE_PATTERN = re.compile(rf"(^|[_\-\s.]+)({ROLES})(?=$|[_\-\s.]+)", re.IGNORECASE)
# A number may follow at the end: `depth1` and `pwm1` are of run 1.
SENSOR_PATTERN = re.compile(rf"(^|[_\-\s.]+)({ROLES}|{SENSORS})(?=$|[_\-\s.]+|\d+$)", re.IGNORECASE)


def run_key(stem: str) -> str:
    """Return a file's stem without the words for its role, to compare names by.

    Separators become hyphens, and letters are folded to lower case.
    """
    return re.sub(r"[\s_\-.]+", "-", _without_role(stem)).strip("-").casefold()


def sensor_key(stem: str) -> str:
    """As `run_key`, also without the words for a sensor."""
    return re.sub(r"[\s_\-.]+", "-", without_sensor(stem)).strip("-").casefold()


def without_sensor(stem: str) -> str:
    """Remove from a file's stem the words for its role and for its sensor."""
    return _without(SENSOR_PATTERN, stem)


def run_ids(stems: Sequence[str]) -> list[str]:
    """Name each run by its file's stem, without words for its role and a leading `run`.

    Where such names are empty or not all different, more of the stem is kept; if that does not
    help, the runs are numbered.
    """
    for make in (_short, lambda stem: _without_role(stem) or stem, lambda stem: stem):
        ids = [_safe(make(stem)) for stem in stems]
        if all(ids) and len({i.casefold() for i in ids}) == len(ids):
            return ids
    return [f"run-{k}" for k in range(1, len(stems) + 1)]


def _without_role(stem: str) -> str:
    return _without(ROLE_PATTERN, stem)


def _without(words: re.Pattern[str], stem: str) -> str:
    name = stem
    while (shorter := words.sub("", name)) != name:
        name = shorter
    return name.strip(" _-.")


def _short(stem: str) -> str:
    return re.sub(r"^run[_\-\s]*(?=.)", "", _without_role(stem), flags=re.IGNORECASE)


def _safe(name: str) -> str:
    """Make a name that can be part of a file name, as campaign.yaml demands; may be empty."""
    text = "".join(c if is_name(c) else "-" for c in name)
    return re.sub(r'[/\\:*?"<>|{}]', "-", text).strip().lstrip(".-~ ")[:80].strip()


def campaign_name(folder: str) -> str:
    """Name a campaign after its folder."""
    return _safe(folder) or "campaign"


def find_control(name: str) -> str | None:
    """Return `3dof` or `6dof` where a name holds one of them; None where it holds none or both."""
    controls = {word.lower() for word in re.findall(r"[36]dof", name, re.IGNORECASE)}
    return controls.pop() if len(controls) == 1 else None
