"""New campaign: what the workbench says of recordings that nobody has described."""

import numpy as np

from rovsim.apps.workbench.new_campaign import TOPIC_TITLES, tell_unanswered
from rovsim.intake.guesses import list_guesses
from rovsim.intake.proposal import ANSWER, CampaignProposal, OpenQuestion
from rovsim.intake.survey.timing import RowTiming

NO_LOG = "guess: no log of commands was among the files"
RUNS = [{"id": "run_1", "control": "3dof"}, {"id": "run_2", "control": "6dof"}]


def test_a_guess_says_which_run_it_is_of_and_what_a_key_means():
    content = {"vehicle": ANSWER, "mocap": {"velocity": "mean"}, "runs": RUNS}
    comments = {
        "runs.0": ("poses: 60 s", "guess: 3dof, by how much its commands turn it", NO_LOG),
        "runs.1": ("guess: 6dof, by how much its commands turn it", NO_LOG),
        "runs": ("guess: kept for the test is none",),
        "mocap.velocity": ("guess: a line's velocity is the mean up to the next line",),
    }
    assert list_guesses(CampaignProposal(content, comments), TOPIC_TITLES) == [
        "Runs: kept for the test is none",
        "Velocities: mean; a line's velocity is the mean up to the next line",
        "Run run_1: 3dof, by how much its commands turn it",
        "Runs run_1 and run_2: no log of commands was among the files",
        "Run run_2: 6dof, by how much its commands turn it",
    ]


def test_all_that_is_not_answered_yet_is_named_as_on_the_screen():
    places = ("vehicle", "mocap.world_axes", "mocap.body_axes")
    questions = [OpenQuestion(place, "which?", ()) for place in places]
    told = tell_unanswered(questions, {"vehicle": " ", "mocap.world_axes": "ned"})
    assert told.startswith("No answer yet: Vehicle and Axes of the rigid body.")
    assert tell_unanswered(questions, dict.fromkeys(places, "x")) == ""


def test_one_gap_is_a_gap():
    time = np.delete(np.arange(0.0, 10.0, 0.1), [50, 51])
    assert str(RowTiming.of(time)) == "98 rows, 9.9 s at 10 Hz, a gap of 0.30 s"
