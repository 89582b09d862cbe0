"""Whether printed correlations of attenuation agree with those of the peaks that it is made of.

Attenuation is printed as 1 − P/D, with P the peak of the proximal segment and D that of the distal one
(D§5.3.4.1). Between runs, small changes of P/D are those of P less those of D, so that a correlation r of
P/D with any scale is, to first order,

    r = (r_P − a r_D) / √(1 + a² − 2 a ρ),

with r_P and r_D the correlations of the peaks with the same scale, a the coefficient of variation of D
over that of P, and ρ the correlation of both peaks; for the attenuation it is −r. Three scales give
three equations for a and ρ. That a mean over steps of P/D is not the quotient of the means changes
little: both differ by the squares of coefficients of variation within a run.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from swaystride.studies.experience.plan import SCALES

#: Printed names of each attenuation, its proximal and its distal peak.
PEAKS: Final = {
    "Shank-to-Head Attenuation": ("Peak Head Acceleration", "Peak Tibial Acceleration"),
    "Shank-to-Pelvis Attenuation": ("Peak Pelvic Acceleration", "Peak Tibial Acceleration"),
    "Pelvis-to-Head Attenuation": ("Peak Head Acceleration", "Peak Pelvic Acceleration"),
}
#: What the printed column may hold, and the sign of its correlations against those of P/D.
READINGS: Final = {"one minus the ratio": -1.0, "ratio": 1.0}

_SPREADS: Final = np.geomspace(0.1, 10.0, 401)
_CORRELATIONS: Final = np.linspace(-0.9, 0.98, 189)


def attenuation_readings(table: pd.DataFrame) -> pd.DataFrame:
    """Fit both readings to the printed correlations of each attenuation.

    Parameters
    ----------
    table : DataFrame
        Table 5.3 or 5.4: ``measure``, ``scale``, ``r``.

    Returns
    -------
    DataFrame
        By ``measure`` and ``reading``: ``rms``, the root mean square deviation of the best fit over the
        three scales; ``spread_ratio`` (a) and ``peak_r`` (ρ) of it; and ``n_opposite``, how many
        of the three correlations have a sign that no a allows.

    Examples
    --------
    >>> rows = [("Shank-to-Pelvis Attenuation", (-0.5, 0.0, 0.5)),
    ...         ("Peak Pelvic Acceleration", (0.6, 0.1, -0.6)),
    ...         ("Peak Tibial Acceleration", (0.1, 0.1, -0.1))]
    >>> table = pd.DataFrame([(measure, scale, r) for measure, values in rows
    ...                       for scale, r in zip(SCALES, values)], columns=["measure", "scale", "r"])
    >>> found = attenuation_readings(table)
    >>> found[["reading", "n_opposite"]].values.tolist()
    [['one minus the ratio', 0], ['ratio', 0]]
    >>> bool(found["rms"][0] < 0.01 < 0.3 < found["rms"][1])
    True
    """
    r = table.set_index(["measure", "scale"])["r"].astype(float)
    rows = []
    for measure, (proximal, distal) in PEAKS.items():
        if (measure, SCALES[0]) not in r.index:
            continue
        printed, of_proximal, of_distal = (
            r.loc[[(name, scale) for scale in SCALES]].to_numpy()
            for name in (measure, proximal, distal)
        )
        a, rho = _SPREADS[:, None], _CORRELATIONS[None, :]
        size = np.sqrt(1.0 + a**2 - 2.0 * a * rho)
        ratio = (of_proximal - a[..., None] * of_distal) / size[..., None]
        signs = np.sign(of_proximal - _SPREADS[:, None] * of_distal)
        for reading, sign in READINGS.items():
            rms = np.sqrt(np.mean((sign * ratio - printed) ** 2, axis=-1))
            best = np.unravel_index(int(np.argmin(rms)), rms.shape)
            rows.append(
                {
                    "measure": measure,
                    "reading": reading,
                    "rms": float(rms[best]),
                    "spread_ratio": float(_SPREADS[best[0]]),
                    "peak_r": float(_CORRELATIONS[best[1]]),
                    "n_opposite": int(np.sum(np.all(sign * signs * printed < 0.0, axis=0))),
                }
            )
    return pd.DataFrame(rows)
