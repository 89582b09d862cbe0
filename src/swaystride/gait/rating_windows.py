"""Sliding windows over a run, and the rating of affect that belongs to each (dissertation, §5.3.4.1)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError

Array = NDArray[np.float64]
RatingMean = Literal["time_weighted", "simple"]


@dataclass(frozen=True)
class WindowRule:
    """Windows that slide over the run.

    Parameters
    ----------
    length_s, step_s : float
        Length of a window, and how far the next one is shifted.
    """

    length_s: float
    step_s: float


#: Dissertation, §5.3.4.1.
PRINTED_WINDOWS: Final = WindowRule(60.0, 20.0)


def sliding_windows(start_s: float, stop_s: float, rule: WindowRule) -> Array:
    """Windows that lie wholly in a span.

    Parameters
    ----------
    start_s, stop_s : float
        Span, for example minute 10 to the end of the run.
    rule : WindowRule

    Returns
    -------
    ndarray, shape (n_windows, 2)
        Begin and end, in s.

    Raises
    ------
    RecordingError
        If the span holds no window.

    Examples
    --------
    >>> sliding_windows(600.0, 700.0, PRINTED_WINDOWS).tolist()
    [[600.0, 660.0], [620.0, 680.0], [640.0, 700.0]]
    """
    n_windows = int(np.floor((stop_s - start_s - rule.length_s) / rule.step_s + 1e-9)) + 1
    if n_windows < 1:
        raise RecordingError(
            "no window fits between the warm-up and the end of the run",
            expected=f"{rule.length_s:g} s at least",
            found=f"{start_s:g} to {stop_s:g} s",
        )
    begin = start_s + rule.step_s * np.arange(n_windows)
    return np.stack([begin, begin + rule.length_s], axis=1)


def window_means(
    at_s: ArrayLike, values: pd.DataFrame, windows: ArrayLike, *, least: int
) -> pd.DataFrame:
    """Mean over the strides of each window.

    Parameters
    ----------
    at_s : array_like, shape (n,)
        Time of each row of `values`, for example the begin of its stride.
    values : DataFrame
        Numeric; missing values do not count.
    windows : array_like, shape (n_windows, 2)
        Begin (included) and end (not included).
    least : int
        With fewer values the mean is missing.

    Returns
    -------
    DataFrame
        A row per window.

    Examples
    --------
    >>> values = pd.DataFrame({"x": [1.0, 3.0, 8.0]})
    >>> window_means([0.0, 1.0, 2.0], values, [[0.0, 2.0], [2.0, 4.0]], least=2)["x"].tolist()
    [2.0, nan]
    """
    at = np.asarray(at_s, dtype=np.float64)
    edges = np.asarray(windows, dtype=np.float64)
    inside = ((at >= edges[:, :1]) & (at < edges[:, 1:])).astype(np.float64)
    numbers = values.to_numpy(dtype=np.float64)
    known = np.isfinite(numbers)
    count = inside @ known.astype(np.float64)
    total = inside @ np.where(known, numbers, 0.0)
    enough = count >= max(least, 1)
    means = np.where(enough, total / np.maximum(count, 1.0), np.nan)
    return pd.DataFrame(means, columns=values.columns)


def window_ratings(
    rated_s: ArrayLike, rating: ArrayLike, windows: ArrayLike, *, known_until_s: float | None = None
) -> Array:
    """Rating of each window: the most recent one, or one given in its first half.

    A rating that changes in a window counts for it only if it does so in the first half, the middle
    included: it then holds for most of the window. So the rating that holds in the middle is taken.

    Parameters
    ----------
    rated_s, rating : array_like, shape (n_ratings,)
        Times, rising, and ratings.
    windows : array_like, shape (n_windows, 2)
        From :func:`sliding_windows`.
    known_until_s : float, optional
        Ratings after this time are lost: windows whose middle lies later have none.

    Returns
    -------
    ndarray, shape (n_windows,)
        NaN before the first rating.

    Examples
    --------
    >>> windows = sliding_windows(0.0, 120.0, PRINTED_WINDOWS)
    >>> window_ratings([0.0, 40.0], [2.0, 4.0], windows).tolist()
    [2.0, 4.0, 4.0, 4.0]
    """
    times, values = _checked(rated_s, rating)
    edges = np.asarray(windows, dtype=np.float64)
    middle = edges.mean(axis=1)
    held = np.append(np.nan, values)[np.searchsorted(times, middle, side="right")]
    if known_until_s is not None:
        held = np.where(middle > known_until_s, np.nan, held)
    return np.asarray(held)


def mean_rating(
    rated_s: ArrayLike, rating: ArrayLike, start_s: float, stop_s: float, *, mean: RatingMean
) -> float:
    """Mean rating over a span of the run.

    Parameters
    ----------
    rated_s, rating : array_like, shape (n_ratings,)
        Times, rising, and ratings.
    start_s, stop_s : float
        Span; the end of what is known of the ratings, if they are lost from some time on.
    mean : {"time_weighted", "simple"}
        Each rating weighted by how long it holds, or those given in the span counted once each. The
        print says "average" only.

    Returns
    -------
    float
        NaN if no rating holds, or none was given, in the span.

    Examples
    --------
    >>> mean_rating([0.0, 75.0], [2.0, 4.0], 0.0, 100.0, mean="time_weighted")
    2.5
    >>> mean_rating([0.0, 75.0], [2.0, 4.0], 0.0, 100.0, mean="simple")
    3.0
    """
    times, values = _checked(rated_s, rating)
    if mean == "simple":
        inside = (times >= start_s) & (times < stop_s)
        return float(values[inside].mean()) if inside.any() else float("nan")
    begin = np.clip(times, start_s, stop_s)
    weight = np.diff(np.append(begin, max(stop_s, start_s)))
    if not weight.sum() > 0.0:
        return float("nan")
    return float(weight @ values / weight.sum())


def check_ratings(
    rated_s: ArrayLike, rating: ArrayLike, *, run_s: float, lowest: float, highest: float
) -> None:
    """Refuse ratings that cannot be those of a run.

    Parameters
    ----------
    rated_s, rating : array_like, shape (n_ratings,)
        Times from the begin of the run, rising, and ratings.
    run_s : float
        Length of the run.
    lowest, highest : float
        Ends of the scale: −5 and 5 for the Feeling Scale.

    Raises
    ------
    RecordingError
        If a rating lies outside the run or the scale, is missing, or times do not rise.

    Examples
    --------
    >>> check_ratings([0.0, 900.0], [1, 2], run_s=1800.0, lowest=-5, highest=5)
    """
    times, values = _checked(rated_s, rating)
    for name, numbers, least, most in (
        ("a rating was given outside the run", times, 0.0, run_s),
        ("a rating lies outside the scale", values, lowest, highest),
    ):
        outside = (numbers < least) | (numbers > most)
        if outside.any():
            first = int(np.argmax(outside))
            raise RecordingError(
                name,
                place=f"rating {first + 1}",
                expected=f"{least:g} to {most:g}",
                found=f"{numbers[first]:g}",
            )


def _checked(rated_s: ArrayLike, rating: ArrayLike) -> tuple[Array, Array]:
    """Times and ratings, complete and in order."""
    times, values = (np.asarray(column, dtype=np.float64) for column in (rated_s, rating))
    if times.shape != values.shape or times.ndim != 1 or times.size == 0:
        raise RecordingError(
            "no ratings of affect",
            expected="as many times as ratings, one at least",
            found=f"{times.size} times, {values.size} ratings",
        )
    if not (np.isfinite(times).all() and np.isfinite(values).all()):
        raise RecordingError("a rating is missing", expected="numbers", found="NaN")
    if np.any(np.diff(times) <= 0.0):
        first = int(np.argmax(np.diff(times) <= 0.0)) + 2
        raise RecordingError(
            "the ratings are not in the order of time",
            place=f"rating {first}",
            expected=f"later than {times[first - 2]:g} s",
            found=f"{times[first - 1]:g} s",
        )
    return times, values
