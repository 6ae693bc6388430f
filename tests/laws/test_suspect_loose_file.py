"""A file that is a little off everywhere competes with the special effects that it explains."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from rovsim.core.axes import AXES
from rovsim.diagnosis.selection.vehicle_file.loose_file import LooseFile
from rovsim.diagnosis.selection.vehicle_file.steps import suspect_loose_file
from rovsim.dynamics.effects.added_mass import AddedMass
from rovsim.dynamics.effects.constant_wrench import ConstantWrench
from rovsim.dynamics.effects.damping import LinearDamping, QuadraticDamping
from rovsim.dynamics.model import nominal
from rovsim.dynamics.vehicle import default_vehicle, load_vehicle
from rovsim.estimation.candidates import Candidate
from rovsim.estimation.file_effects import FILE_EFFECT_IDS, spread_of_file
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.least_squares import project_out
from rovsim.estimation.sensitivities import CandidateColumns

READINGS = 400
BASE = nominal(load_vehicle(default_vehicle()))
FILE = [Candidate(one, one(), AXES) for one in (LinearDamping, QuadraticDamping, AddedMass)]
SPECIAL = Candidate(ConstantWrench, ConstantWrench(), ("yaw",))


class Workspace:
    """Readings that vary linearly with each number, under white noise of unit variance."""

    noticed = True

    def __init__(self, columns, readings):
        each = iter(range(len(columns)))
        owned = [(one, tuple(next(each) for _ in one.free)) for one in (*FILE, SPECIAL)]
        names = [(one.effect.id, name) for one, _ in owned for name in one.free]
        self.readings, self.all = readings, columns
        self.by_name = dict(zip(names, columns, strict=True))
        self.penalty = 2.0 * np.log(len(columns))
        self.columns, self.first_order = SimpleNamespace(gram=self.gram), self
        blocks = [CandidateColumns(one, None, own) for one, own in owned]
        self.sensitivities = SimpleNamespace(base_model=BASE, blocks=blocks)

    def own(self, h):
        """Derivatives of the errors by what is free."""
        rows = [self.by_name[term.id, name] for term in h.terms for name in term.free]
        return np.array(rows).reshape(-1, READINGS)

    def left(self, h):
        return self.readings + h.x @ self.own(h)

    def gram(self, h):
        rows = np.vstack([self.left(h), self.own(h), self.all])
        G, own = rows @ rows.T, len(h.x)
        kept = [0, *range(1 + own, len(G))]
        return project_out(G, range(1, 1 + own))[np.ix_(kept, kept)]

    def gram_without(self, found, term):
        rest = tuple(one for one in found.hypothesis.terms if one is not term)
        return self.gram(Hypothesis(BASE, rest))

    def fit(self, h):
        x = h.x + np.linalg.lstsq(self.own(h).T, -self.left(h), rcond=None)[0]
        return SimpleNamespace(linearised=h.at(x), hypothesis=h.at(x))

    def drop(self, found, groups):
        return [
            Hypothesis(BASE, tuple(t for t in found.hypothesis.terms if t not in gone))
            for gone in groups
        ]

    def find_relevant(self, found, without):
        return [self.noticed]

    def score(self, found):
        h = found.hypothesis
        return -float(self.left(h) @ self.left(h)) - self.penalty * len(h.x)


def make(seed, off, special):
    """A workspace, and the fit of the special effect alone.

    Args:
        seed: of columns and noise.
        off: by how much each number of the file is off, of what such files are off by, which would
            show at four standard deviations.
        special: at how many the special effect does. It looks half like all of the file together.
    """
    random = np.random.default_rng(seed)
    columns = random.normal(size=(19, READINGS))
    columns /= np.linalg.norm(columns, axis=1, keepdims=True)
    alike = 4.0 * random.choice([-1.0, 1.0], 18) @ columns[:-1]
    columns[-1] += alike / np.linalg.norm(alike)
    columns[-1] /= np.linalg.norm(columns[-1])
    spread = [spread_of_file(BASE, one.effect, p) for one in FILE for p in one.term().parameters]
    columns[:-1] *= 4.0 / np.array(spread)[:, None]
    workspace = Workspace(
        columns, random.normal(size=READINGS) - off * alike - special * columns[-1]
    )
    return workspace, workspace.fit(Hypothesis(BASE, (Term(SPECIAL.start, ("yaw",)),)))


@pytest.mark.parametrize("seed", range(5))
def test_many_small_errors_of_a_file_are_sought_in_the_place_of_what_looks_like_them(seed):
    workspace, found = make(seed, off=1.0, special=0.0)
    names = {term.id for term in suspect_loose_file(workspace, found).hypothesis.terms}
    assert names == {"linear_damping", "quadratic_damping", "added_mass"}


@pytest.mark.parametrize("seed", range(5))
def test_a_file_that_is_right_is_not_suspected(seed):
    workspace, found = make(seed, off=0.0, special=8.0)
    assert suspect_loose_file(workspace, found) is found


def test_a_file_that_promises_more_than_its_fit_keeps_is_not_taken(monkeypatch):
    """All numbers of a torpedo's file promised 2,000 in place of weak fins, and gained 360."""
    workspace, found = make(0, off=1.0, special=0.0)
    true = workspace.score

    def score(one):
        return true(one) - 1e3 * any(term.id in FILE_EFFECT_IDS for term in one.hypothesis.terms)

    monkeypatch.setattr(workspace, "score", score)
    assert suspect_loose_file(workspace, found) is found


def test_a_file_whose_errors_nobody_would_notice_is_not_taken():
    workspace, found = make(0, off=1.0, special=0.0)
    workspace.noticed = False
    assert suspect_loose_file(workspace, found) is found


def test_doubt_is_the_ratio_of_two_densities_of_the_readings():
    workspace, _ = make(1, off=1.0, special=0.0)
    alone = workspace.fit(Hypothesis(BASE))
    file = LooseFile(workspace)
    spread = np.array([number.spread for number in file.numbers])
    loose = workspace.all[:-1].T * spread
    one, y = np.eye(READINGS), workspace.readings
    off = multivariate_normal(cov=one + loose @ loose.T).logpdf(y)
    right = multivariate_normal(cov=one).logpdf(y)
    assert file.measure_doubt(alone) == pytest.approx(2.0 * (off - right))
