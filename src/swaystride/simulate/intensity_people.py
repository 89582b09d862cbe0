"""Patients and therapists of the simulated intensity study: ages, bodies, experience."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import ConfigurationError

Array = NDArray[np.float64]

_MAX_DRAWS = 10_000


@dataclass(frozen=True)
class PatientGroup:
    """One group of patients as printed; SDs are divided by n − 1.

    Parameters
    ----------
    n, n_female : int
        Patients, and women among them.
    age_mean_years, age_sd_years : float
        Mean and standard deviation.
    age_range_years : tuple of float
        Youngest and oldest age that may be drawn.
    """

    n: int
    n_female: int
    age_mean_years: float
    age_sd_years: float
    age_range_years: tuple[float, float]


@dataclass(frozen=True)
class Bodies:
    """Statures and body mass indices, which the chapter does not print.

    Parameters
    ----------
    height_mean_female_m, height_mean_male_m, height_sd_m : float
        Stature.
    mass_index_mean_kg_m2, mass_index_sd_kg_m2 : float
        Body mass over squared stature.
    """

    height_mean_female_m: float
    height_mean_male_m: float
    height_sd_m: float
    mass_index_mean_kg_m2: float
    mass_index_sd_kg_m2: float


@dataclass(frozen=True)
class Therapists:
    """The therapists as printed.

    Parameters
    ----------
    n : int
        How many.
    experience_mean_years, experience_sd_years : float
        Mean and standard deviation, the latter divided by n − 1.
    """

    n: int
    experience_mean_years: float
    experience_sd_years: float


def draw_ages(group: PatientGroup, n: int, rng: np.random.Generator) -> tuple[Array, list[str]]:
    """Ages in years and sexes of `n` patients of a group.

    The printed number is drawn as a whole, with the printed mean and SD up to rounding and within
    the range; fewer patients are its first ones, further ones are drawn alone.

    Parameters
    ----------
    group : PatientGroup
        What is printed.
    n : int
        How many patients.
    rng : numpy.random.Generator
        Source of the draws.

    Returns
    -------
    ages : ndarray, shape (n,)
    sexes : list of str
        ``F`` or ``M``.

    Raises
    ------
    ConfigurationError
        If the printed mean and SD cannot be had within the range.

    Examples
    --------
    >>> group = PatientGroup(4, 2, 61.7, 25.6, (18.0, 90.0))
    >>> ages, sexes = draw_ages(group, 4, np.random.default_rng(1))
    >>> round(float(ages.mean()), 1), round(float(ages.std(ddof=1)), 1), sorted(sexes)
    (61.7, 25.6, ['F', 'F', 'M', 'M'])
    """
    female = rng.permutation(group.n) < group.n_female
    low, high = group.age_range_years
    ages = _with_moments(
        group.n, group.age_mean_years, group.age_sd_years, low, high, "age_range_years", rng
    ).tolist()
    sexes = np.where(female, "F", "M").tolist()
    while len(ages) < n:
        drawn = group.age_mean_years + group.age_sd_years * float(rng.standard_normal())
        ages.append(round(float(np.clip(drawn, low, high)), 1))
        sexes.append("F" if rng.random() < group.n_female / group.n else "M")
    return np.array(ages[:n]), sexes[:n]


def draw_bodies(bodies: Bodies, sex: str, rng: np.random.Generator) -> tuple[float, float]:
    """Stature (m) and mass (kg) of one person.

    Parameters
    ----------
    bodies : Bodies
        Distribution.
    sex : str
        ``F`` or ``M``.
    rng : numpy.random.Generator
        The person's own.
    """
    mean = bodies.height_mean_female_m if sex == "F" else bodies.height_mean_male_m
    z_height, z_mass = np.clip(rng.standard_normal(2), -2.0, 2.0).tolist()
    height = mean + bodies.height_sd_m * z_height
    index = bodies.mass_index_mean_kg_m2 + bodies.mass_index_sd_kg_m2 * z_mass
    return round(height, 2), round(index * height**2, 1)


def draw_experience(therapists: Therapists, rng: np.random.Generator) -> Array:
    """Years of experience with the printed mean and SD up to rounding, at least one.

    Parameters
    ----------
    therapists : Therapists
        What is printed.
    rng : numpy.random.Generator
        Source of the draws.
    """
    return _with_moments(
        therapists.n,
        therapists.experience_mean_years,
        therapists.experience_sd_years,
        1.0,
        50.0,
        "experience_sd_years",
        rng,
    )


def _with_moments(
    n: int,
    mean: float,
    sd: float,
    low: float,
    high: float,
    place: str,
    rng: np.random.Generator,
) -> Array:
    """Normal numbers with exactly this mean and SD, drawn anew until all are in the range."""
    for _ in range(_MAX_DRAWS):
        z = rng.standard_normal(n)
        values: Array = (mean + sd * (z - z.mean()) / z.std(ddof=1)).round(1)
        if low <= values.min() and values.max() <= high:
            return values
    raise ConfigurationError(
        "the printed mean and SD cannot be had within the range",
        place=place,
        expected=f"{low:g} to {high:g}",
        found=f"{mean:g} ± {sd:g} of {n}",
    )
