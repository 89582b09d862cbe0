"""Time MixedLM of statsmodels on one model with random intercepts.

Several grouping factors become variance components within one group that holds all rows. Prints
one line of JSON as ``peers_mixedlm.py`` does.
"""

import argparse
import json
import re
import time
import warnings

import numpy as np
import pandas as pd
import statsmodels
from statsmodels.regression.mixed_linear_model import MixedLM


def model(formula: str, table: pd.DataFrame) -> MixedLM:
    """Translate a formula with terms ``(1|a:b)`` into a model of statsmodels.

    Parameters
    ----------
    formula : str
    table : pandas.DataFrame
    """
    groups = re.findall(r"\(1\s*\|\s*([^)]+)\)", formula)
    fixed = re.sub(r"\+?\s*\(1\s*\|[^)]+\)", "", formula).strip()
    if len(groups) == 1 and ":" not in groups[0]:
        return MixedLM.from_formula(fixed, table, groups=groups[0])
    columns = {}
    for name in groups:
        label = name.replace(":", "_by_")
        table = table.assign(**{label: table[name.split(":")].astype(str).agg("|".join, axis=1)})
        columns[label] = f"0 + C({label})"
    table = table.assign(everything=1)
    return MixedLM.from_formula(
        fixed, table, groups="everything", re_formula="0", vc_formula=columns
    )


def main() -> None:
    """Fit, refit, print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("table")
    parser.add_argument("formula")
    parser.add_argument("--repeats", type=int, required=True)
    parser.add_argument("--responses", help="array of new outcomes, one per row (.npy)")
    parser.add_argument(
        "--limit-s", type=float, required=True, help="stop repeating after this time"
    )
    arguments = parser.parse_args()
    warnings.simplefilter("ignore")
    table = pd.read_csv(arguments.table)
    seconds = []
    for _ in range(arguments.repeats):
        start = time.perf_counter()
        fit = model(arguments.formula, table).fit(reml=True)
        seconds.append(time.perf_counter() - start)
        if sum(seconds) > arguments.limit_s:
            break
    answer = {"version": statsmodels.__version__, "seconds": seconds, "loglik": float(fit.llf)}
    if arguments.responses:
        outcome = arguments.formula.split("~")[0].strip()
        done, start = 0, time.perf_counter()
        for response in np.load(arguments.responses):
            model(arguments.formula, table.assign(**{outcome: response})).fit(reml=True)
            done += 1
            if time.perf_counter() - start > arguments.limit_s:
                break
        answer |= {"refits": done, "refit_seconds": time.perf_counter() - start}
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
