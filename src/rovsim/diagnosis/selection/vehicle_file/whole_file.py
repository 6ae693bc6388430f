"""All of a loose vehicle file, fitted together with what was selected."""

from dataclasses import replace
from typing import Callable, Sequence

import numpy as np
from numpy import ndarray as Array

from rovsim.dynamics.effects.base import Effect, Parameter
from rovsim.dynamics.effects.thrusters import ThrusterGain, name_gains
from rovsim.dynamics.model import Model
from rovsim.estimation.file_effects import (
    FILE_EFFECTS,
    GAIN_RELATIVE_STD,
    GAIN_SCALE,
    MIN_LOOSE_EFFECTS,
    ONE_GAIN,
    has_loose_file,
    mark_gain,
    spread_of_file,
)
from rovsim.estimation.fit import Fit, find_covariance, fit_noise_only
from rovsim.estimation.levenberg_marquardt import levenberg_marquardt
from rovsim.estimation.observer.filter_bank import FilterBank
from rovsim.estimation.observer.hypothesis import Hypothesis, Term
from rovsim.estimation.observer.noise import Noise
from rovsim.estimation.prior import Prior

# How far a file may be off in a parameter of an effect of a base model, in its scales.
SpreadOf = Callable[[Model, type[Effect], Parameter], float]


def fit_whole_file(selected: Hypothesis, bank: FilterBank, noise: Noise) -> Fit | None:
    """All that the file states, fitted; None where it is not loose, or such a model diverges."""
    if not has_loose_file(selected):
        return None
    hypothesis = free_rest(selected)
    prior = make_file_prior(selected, hypothesis)
    linearised = levenberg_marquardt(hypothesis, bank, noise, prior)
    return fit_noise_only(linearised, bank, noise, prior) if linearised.is_finite else None


def sharpen_covariance(whole: Fit, selected: Hypothesis, bank: FilterBank) -> Fit:
    """Such a fit with the covariance by central differences: the common scale is hardly known.

    Args:
        whole: all of the file, fitted.
        selected: what was selected, as it was fitted.
        bank: that it was fitted with.
    """
    linearised = bank.linearise_centrally(whole.hypothesis)
    if not linearised.is_finite:
        return whole
    prior = make_file_prior(selected, whole.hypothesis)
    covariance = find_covariance(linearised, bank, whole.noise, prior)
    return replace(whole, linearised=linearised, covariance=covariance)


def measure_misfit(whole: Fit, selected: Hypothesis) -> float:
    """Minus twice the log likelihood of such a fit, and of what is known of files; no constant.

    Args:
        whole: all of the file, fitted.
        selected: what was selected, as it was fitted.
    """
    x = whole.hypothesis.x
    return make_file_prior(selected, free_rest(selected)).cost(x) - whole.two_log_likelihood


def make_file_prior(selected: Hypothesis, freed: Hypothesis) -> Prior:
    """Of numbers that were not selected, what such files are off by; of a selected gain as well."""
    new, gain = mark_new(selected, freed), mark_gain(freed)
    std = np.full(len(new), np.inf)
    std[gain] = GAIN_RELATIVE_STD / GAIN_SCALE
    std[new] = list_spreads(selected, freed)
    return Prior(np.where(gain, freed.absence, freed.x), std, gain & ~new)


def mark_new(selected: Hypothesis, freed: Hypothesis) -> Array:
    """Which parameters (k,) of the one are not selected."""
    names = set(selected.parameter_names)
    return np.array([name not in names for name in freed.parameter_names], bool)


def free_rest(h: Hypothesis, effects: Sequence[type[Effect]] = FILE_EFFECTS) -> Hypothesis:
    """With all free that the file states; each thruster's own gain where several differ."""
    names = set(h.parameter_names)
    for effect in (cls.on(h.base.vehicle) for cls in effects):
        parameters = tuple(k for k in _list_stated(effect, h) if f"{effect.id}.{k}" not in names)
        if parameters:
            h = h.with_term(Term(effect(), parameters))
    return h


def _list_stated(effect: type[Effect], h: Hypothesis) -> Sequence[str]:
    if effect.id != ThrusterGain.id:
        return [p.name for p in effect.parameters if p.fitted]
    gains = name_gains(h.base.vehicle.thruster_count)
    selected = sum(f"{ThrusterGain.id}.{name}" in h.parameter_names for name in gains)
    return (*ONE_GAIN, *gains) if selected >= MIN_LOOSE_EFFECTS else ONE_GAIN


def list_spreads(h: Hypothesis, freed: Hypothesis, spread_of: SpreadOf = spread_of_file) -> Array:
    """How far the file may be off (n,) in each parameter that only `freed` has, scaled."""
    parameters = [(type(t.effect), p) for t in freed.terms for p in t.parameters]
    pairs = zip(freed.parameter_names, parameters, strict=True)
    new = [parameter for name, parameter in pairs if name not in h.parameter_names]
    return np.array([spread_of(h.base, *parameter) for parameter in new])
