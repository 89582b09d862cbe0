"""The representative trial of the figures, chosen by a rule, and the strides of a trial."""

from __future__ import annotations

import pandas as pd

from swaystride.errors import DesignError

#: What names a stride, beside its trial.
STRIDE_COLUMNS = ("side", "stride", "initial_contact_s", "next_contact_s")


def representative_trial(agreement: pd.DataFrame) -> tuple[str, str]:
    """First analysed trial of the first participant that has one.

    Parameters
    ----------
    agreement : DataFrame
        Of all participants in their order, trials in their order.

    Returns
    -------
    tuple of str
        Participant and trial.

    Raises
    ------
    DesignError
        If no trial was analysed.
    """
    if agreement.empty:
        raise DesignError("no trial was analysed", expected="at least one", found="none")
    return str(agreement["participant"].iloc[0]), str(agreement["trial"].iloc[0])


def trial_rows(table: pd.DataFrame, participant: str, trial: str) -> pd.DataFrame:
    """Rows of one trial.

    Parameters
    ----------
    table : DataFrame
        With ``participant`` and ``trial``.
    participant, trial : str
    """
    own = (table["participant"] == participant) & (table["trial"] == trial)
    return table[own].reset_index(drop=True)


def trial_contacts(strides: pd.DataFrame) -> pd.DataFrame:
    """One row per counted stride of a trial, whatever was measured on it.

    Parameters
    ----------
    strides : DataFrame
        Rows of one trial: one per stride, source and feature.

    Returns
    -------
    DataFrame
        :data:`STRIDE_COLUMNS`, in the order of time.
    """
    own = strides[list(STRIDE_COLUMNS)].drop_duplicates(["side", "stride"])
    return own.sort_values(["side", "stride"]).reset_index(drop=True)
