"""Time mixedlm on one model; runs in the environment of ``requirements-peers.txt``.

Prints one line of JSON: version, seconds of each fit, log-likelihood of the first, and seconds of
all refits together with their number.
"""

import argparse
import json
import time
import warnings

import mixedlm
import numpy as np
import pandas as pd


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
        fit = mixedlm.lmer(arguments.formula, table, REML=True)
        seconds.append(time.perf_counter() - start)
        if sum(seconds) > arguments.limit_s:
            break
    answer = {"version": mixedlm.__version__, "seconds": seconds, "loglik": float(fit.logLik())}
    if arguments.responses:
        done, start = 0, time.perf_counter()
        for response in np.load(arguments.responses):
            fit.refit(response)
            done += 1
            if time.perf_counter() - start > arguments.limit_s:
                break
        answer |= {"refits": done, "refit_seconds": time.perf_counter() - start}
    print(json.dumps(answer))


if __name__ == "__main__":
    main()
