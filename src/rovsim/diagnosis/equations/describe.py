"""Convert a proposed law, or a force in time, into the sections of `diagnosis.json`."""

import numpy as np
from numpy import ndarray as Array

from rovsim.core.model_names import PROPOSED
from rovsim.core.rounding import rounded, rounded_or_none
from rovsim.diagnosis.equations.disturbance import ForceInTime
from rovsim.diagnosis.equations.proposal import ProposedLaw
from rovsim.diagnosis.equations.spectrum import Spectrum
from rovsim.diagnosis.fitted_values import describe_values
from rovsim.results.base import ByAxis
from rovsim.results.diagnosis import (
    LAW_FILE,
    Disturbance,
    ForceOfRun,
    ForceSpectrum,
    ProposedEquation,
    ProposedTerm,
    RivalLaw,
    StrongMoment,
)
from rovsim.results.fitted import FittedEffect, FittedValue

# s between two rows of a force in time: what the readings resolve (sudden_pushes.py).
ROW_SECONDS = 0.2


def describe_force(force: ForceInTime) -> Disturbance:
    """Describe a force in time, with a row about every `ROW_SECONDS` for each run."""
    rows = zip(force.runs, force.time, force.place, force.force, strict=True)
    return Disturbance(
        axes=force.axes,
        rms=ByAxis.of(_round_all(force.rms)),
        band_hz=(round(force.band[0], 3), round(force.band[1], 3)),
        spectrum=_describe_spectrum(force.spectrum),
        strongest=tuple(
            StrongMoment(
                run=p.run,
                time_s=round(p.time, 2),
                axis=p.axis,
                force=rounded(p.force, 4),
                place_m=_round_place(p.place),
            )
            for p in force.pushes
        ),
        runs=tuple(_describe_run(*row) for row in rows),
    )


def _describe_spectrum(spectrum: Spectrum) -> ForceSpectrum:
    """Describe a spectrum, its densities to four significant digits."""
    density = np.vectorize(lambda d: rounded(d, 4))(spectrum.density)
    return ForceSpectrum(
        frequency_hz=tuple(np.round(spectrum.frequency, 4).tolist()),
        density=tuple(map(tuple, density.tolist())),
    )


def _describe_run(run: str, time: Array, place: Array, force: Array) -> ForceOfRun:
    """Describe the force along one run: times (n,), places (n, 3) and wrenches (n, 6)."""
    stride = max(1, round(ROW_SECONDS / float(np.median(np.diff(time))))) if len(time) > 1 else 1
    return ForceOfRun(
        run=run,
        time_s=tuple(np.round(time[::stride], 2).tolist()),
        place_m=tuple(map(_round_place, place[::stride])),
        force=tuple(map(tuple, _round_all(force[::stride]).tolist())),
    )


def _round_all(values: Array) -> Array:
    """Round all values to the fourth significant digit of the largest."""
    largest = float(np.max(np.abs(values), initial=1e-12))
    return np.asarray(np.round(values, 3 - int(np.floor(np.log10(max(largest, 1e-12))))))


def describe_law(law: ProposedLaw) -> ProposedEquation:
    """Describe a proposed law, the effects beside it, and the laws tried in its place."""
    beside = [
        FittedEffect(effect=item.term.id, parameters=describe_values(item.term, item.std))
        for item in law.beside
    ]
    return ProposedEquation(
        axis=law.action.axis,
        equation=law.form.equation,
        file=LAW_FILE,
        effect=PROPOSED,
        meaning=law.form.meaning,
        parameters={
            n.name: FittedValue(
                value=rounded_or_none(n.value), std=rounded_or_none(n.std), unit=n.unit
            )
            for n in law.numbers
        },
        error_reduction=rounded_or_none(law.error_reduction),
        terms=tuple(
            ProposedTerm(on=part.on, quantities=part.quantities, size=rounded_or_none(size))
            for part, size in zip(law.form.parts, law.action.sizes, strict=True)
        ),
        beside=tuple(beside),
        rivals=tuple(RivalLaw(equation=e, deficit=rounded_or_none(d)) for e, d in law.rivals),
    )


def _round_place(place: Array) -> tuple[float, float, float]:
    """A place (3,) to the millimetre."""
    x, y, z = np.round(place, 3).tolist()
    return x, y, z
